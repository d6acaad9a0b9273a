//! Ticks of each use through the model, and what they come to.

use super::core::{Core, Cycles, Ran};
use super::instruction::Instruction;
use super::program::Program;
use super::setting::Setting;
use crate::chip::{Step, Use, Used, UsedTick};
use std::collections::HashMap;

/// Cycles of the ticks of one use in one setting.
#[derive(Clone, Debug)]
pub struct Row {
    /// What the ticks were used for.
    pub used: Use,
    /// Whether the data cache was off, as while settings are written.
    pub writing: bool,
    /// Until the duties are written, in ascending order.
    pub cycles: Vec<u64>,
    /// All that the longest tick does.
    pub whole: u64,
    /// Until the duties are written, of all together.
    pub sum: Cycles,
    /// Instructions until then of all together.
    pub instructions: u64,
}

impl Row {
    /// Mean, cycles.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.sum.all() as f64 / self.cycles.len().max(1) as f64
    }

    /// What a share of the ticks stays within.
    #[must_use]
    pub fn quantile(&self, share: f64) -> u64 {
        let last = self.cycles.len().saturating_sub(1);
        let at = (share * last as f64).ceil() as usize;
        self.cycles.get(at).copied().unwrap_or(0)
    }

    /// The worst.
    #[must_use]
    pub fn worst(&self) -> u64 {
        self.quantile(1.0)
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> String {
        if self.writing {
            format!("{}, settings written", self.used)
        } else {
            self.used.to_string()
        }
    }
}

/// One setting, all uses.
#[derive(Clone, Debug)]
pub struct Tally {
    /// The setting.
    pub setting: Setting,
    /// Uses in their order, those while settings are written last.
    pub rows: Vec<Row>,
    /// What instructions cost together, by address, in ticks of the stage in motion.
    pub places: HashMap<u64, Cycles>,
}

/// Uses that may go on while settings are written: the rest is refused then, or takes one tick in many thousands.
const WHILE_WRITING: [Use; 2] = [Use::Holding, Use::Moving];

impl Tally {
    /// Takes the ticks of all uses through the model.
    #[must_use]
    pub fn of(used: &Used, setting: Setting) -> Self {
        let mut places = HashMap::new();
        let mut rows: Vec<Row> = Vec::new();
        for (writing, uses) in [(false, &Use::ALL[..]), (true, &WHILE_WRITING[..])] {
            let setting = if writing { setting.writing() } else { setting };
            for doing in uses {
                let ticks = used.ticks.iter().filter(|tick| tick.used == *doing);
                let noted = (*doing == Use::Moving && !writing).then_some(&mut places);
                rows.push(row(ticks, setting, (*doing, writing), noted));
            }
        }
        Self {
            setting,
            rows,
            places,
        }
    }
}

fn row<'a>(
    ticks: impl Iterator<Item = &'a UsedTick>,
    setting: Setting,
    (doing, writing): (Use, bool),
    mut places: Option<&mut HashMap<u64, Cycles>>,
) -> Row {
    let mut core = Core::new(setting);
    let mut row = Row {
        used: doing,
        writing,
        cycles: Vec::new(),
        whole: 0,
        sum: Cycles::default(),
        instructions: 0,
    };
    for tick in ticks {
        let (mut until_duties, mut done) = (Cycles::default(), 0);
        let whole = core.run(ran(&tick.program, &tick.steps), |at, cycles| {
            done += 1;
            if done > tick.until_duties {
                return;
            }
            until_duties.add(cycles);
            if let Some(places) = &mut places {
                places.entry(at).or_default().add(cycles);
            }
        });
        until_duties.entry += core.entry();
        row.cycles.push(until_duties.all());
        row.whole = row.whole.max(whole.all());
        row.sum.add(&until_duties);
        row.instructions += tick.until_duties as u64;
    }
    row.cycles.sort_unstable();
    row
}

/// Cycles of all of a tick's instructions by themselves, one behind the other, as the scheduling model that it is compared with has
/// them: without a memory, and with one cycle for each load or store. ARM's table has two for a load by itself, and one more for each
/// word of those that move several: what that comes to is told beside.
#[must_use]
pub fn modelled_by_schedule(tick: &UsedTick) -> [u64; 2] {
    let mut core = Core::new(Setting::WITHOUT_WAIT_STATES);
    let mut transfers = 0;
    let cycles = core.run(ran(&tick.program, &tick.steps), |at, cycles| {
        if tick.program.at(at).is_some_and(Instruction::is_transfer) {
            transfers += cycles.table - 1;
        }
    });
    [cycles.table + cycles.float - transfers, transfers]
}

/// The steps of a tick as the model takes them.
fn ran<'a>(program: &'a Program, steps: &'a [Step]) -> impl Iterator<Item = Ran<'a>> {
    steps.iter().filter_map(|step| {
        let instruction = program.at(step.at)?;
        Some(Ran {
            at: step.at,
            instruction,
            bus: step.bus,
        })
    })
}
