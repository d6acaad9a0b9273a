//! Move and settle, and how quiet the stage is at rest, as tables: `cargo bench -p hal-sim --bench settle`.
//!
//! Random moves of 1 mm and more over the whole disk, theta with them, on the simulated stage with all calibrated imperfections,
//! friction with presliding and stiction among them. Times are counted from the tick that takes the command: to the profile's end,
//! to where every pivot comes to stay within the window of +-2 encoder LSB, and to where the controller says so, a dwell later.

use firmware::control::SubdivisionTable;
use firmware::motion::{Constraints, Position, plan_line};
use firmware::parameters::Parameters;
use firmware::queues::{Command, CommandQueues, Queues, Snapshot, TickQueues};
use hal_sim::front::Host;
use hal_sim::machine::devices::StageParameters;
use hal_sim::rig::Told;
use hal_sim::rig::observer::TickRecord;
use hal_sim::rig::run::{RunOptions, controller_parameters, stage_parameters};

const MOVES: usize = 200;
const UNIT: f64 = 4_294_967_296.0;
const UNITS_PER_LSB: f64 = 64.0;
/// Ticks after a move in which the stage has to have settled.
const PATIENCE: u64 = 4_000;
/// Ticks at rest that are looked at after every tenth move: half a second, begun half a second after settling.
const REST: u64 = 10_000;

/// A machine so far off the reference, and what the controller knows of it.
#[derive(Clone, Copy)]
struct Case {
    /// Without most of what a workshop leaves in a machine.
    is_kind: bool,
    mismatch_percent: f64,
    payload_kg: f64,
    told: Told,
}

const CASES: [Case; 14] = {
    use Told::{Everything, Machine, MachineAndRipple, Nothing, Reference};
    [
        Case::unkind(0.0, Reference),
        Case::unkind(5.0, Everything),
        Case::new(0.0, 0.0, Nothing),
        Case::new(20.0, 0.0, Nothing),
        Case::new(0.0, 0.0, Machine),
        Case::new(20.0, 0.0, Machine),
        Case::new(-20.0, 0.0, Machine),
        Case::new(35.0, 0.0, Machine),
        Case::new(20.0, 5.0, Machine),
        Case::new(35.0, 5.0, Machine),
        Case::new(20.0, 0.0, MachineAndRipple),
        Case::new(-20.0, 0.0, MachineAndRipple),
        Case::new(35.0, 0.0, MachineAndRipple),
        Case::new(35.0, 5.0, MachineAndRipple),
    ]
};

impl Case {
    const fn new(mismatch_percent: f64, payload_kg: f64, told: Told) -> Self {
        Self {
            is_kind: true,
            mismatch_percent,
            payload_kg,
            told,
        }
    }

    const fn unkind(payload_kg: f64, told: Told) -> Self {
        Self {
            is_kind: false,
            ..Self::new(0.0, payload_kg, told)
        }
    }

    fn words(&self) -> String {
        let machine = if self.is_kind {
            format!("kind, {} % off", self.mismatch_percent)
        } else {
            "reference stage".to_owned()
        };
        format!("{machine} | {} | {}", self.payload_kg, self.told)
    }

    fn stage_and_controller(&self) -> (StageParameters, Parameters) {
        let options = RunOptions {
            mismatch_percent: self.mismatch_percent,
            payload_kg: self.payload_kg,
            told: self.told,
            ..if self.is_kind {
                RunOptions::default()
            } else {
                RunOptions::reference()
            }
        };
        (stage_parameters(&options), controller_parameters(&options))
    }
}

fn main() {
    println!(
        "| plant | load, kg | told | settling, ms after the profile: median / 90 % / 99 % / worst | of the profile: median / 90 % / 99 % / worst | within 10 % | settled told within 10 % |"
    );
    println!("|---|---|---|---|---|---|---|");
    let quiet: Vec<_> = CASES.iter().map(moves).collect();
    println!();
    println!(
        "| plant at rest | load, kg | told | true position, nm rms | theta, nrad rms | pivots, LSB rms / peak | duty, % rms about its mean |"
    );
    println!("|---|---|---|---|---|---|---|");
    for (case, rest) in CASES.iter().zip(quiet) {
        rest.print(case);
    }
}

/// Random numbers: a linear congruence, of which the upper bits count.
struct Random(u64);

impl Random {
    fn within(&mut self, low: f64, high: f64) -> f64 {
        self.0 = (self.0)
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((self.0 >> 11) as f64 / (1_u64 << 53) as f64)
    }

    /// A target at least 1 mm and up to the whole disk away, theta up to half a turn.
    fn target(&mut self, from: &Position) -> Position {
        loop {
            let way_mm = 10_f64.powf(self.within(0.0, 2.2));
            let direction = self.within(0.0, core::f64::consts::TAU);
            let turns = self.within(-0.5, 0.5) * way_mm / 100.0;
            let part = |mm: f64| (mm / 100.0 * UNIT) as i64;
            let to = [
                from[0] + part(way_mm * direction.cos()),
                from[1] + part(way_mm * direction.sin()),
                from[2] + (turns * UNIT) as i64,
            ];
            if (to[0] as f64).hypot(to[1] as f64) < 0.799 * UNIT {
                return to;
            }
        }
    }
}

/// A stage under its controller.
struct Bench<'a> {
    host: Host,
    tick_queues: TickQueues<'a>,
    commands: CommandQueues<'a>,
    record: TickRecord,
    last: Snapshot,
}

impl Bench<'_> {
    fn tick(&mut self) {
        self.host.tick(&mut self.tick_queues, &mut self.record);
        if let Some(snapshot) = self.commands.snapshot() {
            self.last = snapshot;
        }
        assert_eq!(self.host.fault(), None);
    }

    fn run(&mut self, ticks: u64) {
        for _ in 0..ticks {
            self.tick();
        }
    }

    fn send(&mut self, command: Command) {
        assert!(self.commands.send(command).is_ok(), "room");
    }

    /// Following errors of the pivots, LSB.
    fn errors(&self) -> [f64; 3] {
        let sample = self.record.sample.as_ref().expect("a tick has run");
        [0, 1, 2]
            .map(|i| (sample.pivots[i] - sample.pivot_setpoints[i]).units() as f64 / UNITS_PER_LSB)
    }
}

/// What is seen of a stage at rest.
#[derive(Default)]
struct Rest {
    /// Variances of the position (m^2) and theta (rad^2), and the mean square of the pivots' errors; sums.
    way: f64,
    turn: f64,
    pivots: f64,
    peak: f64,
    duty: f64,
    times: f64,
}

impl Rest {
    fn look(&mut self, bench: &mut Bench<'_>, pwm_counts: f64) {
        let mut poses = Vec::new();
        let mut duties = Vec::new();
        let mut square = 0.0;
        for _ in 0..REST {
            bench.tick();
            poses.push(bench.host.stage.plant.pose());
            let sample = bench.record.sample.as_ref().expect("a tick has run");
            duties.push(sample.duty.map(|duty| f64::from(duty.0) / pwm_counts));
            for error in bench.errors() {
                square += error * error / 3.0;
                self.peak = self.peak.max(error.abs());
            }
        }
        let spread = |values: &[[f64; 3]], i: usize| {
            let mean = values.iter().map(|v| v[i]).sum::<f64>() / values.len() as f64;
            values.iter().map(|v| (v[i] - mean).powi(2)).sum::<f64>() / values.len() as f64
        };
        self.way += spread(&poses, 0) + spread(&poses, 1);
        self.turn += spread(&poses, 2);
        self.pivots += square / REST as f64;
        self.duty += (0..3).map(|i| spread(&duties, i)).sum::<f64>() / 3.0;
        self.times += 1.0;
    }

    fn print(&self, case: &Case) {
        let rms = |sum: f64| (sum / self.times).sqrt();
        println!(
            "| {} | {:.2} | {:.1} | {:.2} / {:.1} | {:.3} |",
            case.words(),
            rms(self.way) * 1e9,
            rms(self.turn) * 1e9,
            rms(self.pivots),
            self.peak,
            rms(self.duty) * 100.0
        );
    }
}

/// Moves of a machine.
fn moves(case: &Case) -> Rest {
    let (stage, parameters) = case.stage_and_controller();
    let ground = Constraints::new(parameters.limits, parameters.geometry);
    let mut queues = Queues::new();
    let (tick_queues, commands) = queues.split();
    let mut bench = Bench {
        host: Host::new(&stage, &parameters),
        tick_queues,
        commands,
        record: TickRecord::default(),
        last: Snapshot::default(),
    };
    bench.run(20);
    let tables = (parameters.subdivision.each_ref()).map(SubdivisionTable::new);
    bench.send(Command::Subdivide(tables));
    bench.run(20);
    bench.send(Command::Reference);
    bench.run(4_000);
    let mut random = Random(20_260_214);
    let mut rest = Rest::default();
    let (mut inside, mut told, mut after_ms) = (Vec::new(), Vec::new(), Vec::new());
    for number in 0..MOVES {
        let from = bench.last.setpoint;
        let to = random.target(&from);
        let plan = plan_line(number as u32 + 1, from, to, &ground).expect("inside the disk");
        let profile = plan.ticks();
        assert!(bench.commands.send_plan(&plan).is_ok(), "room");
        let (mut since, mut settled) = (None, None);
        for tick in 1..=profile + PATIENCE {
            bench.tick();
            let window = parameters.window.counts + 0.5;
            if bench.errors().iter().any(|error| error.abs() > window) {
                since = None;
            } else if tick >= profile && since.is_none() {
                since = Some(tick);
            }
            if tick > profile && bench.last.settled && settled.is_none() {
                settled = Some(tick);
            }
        }
        let share = |ticks: u64| ticks as f64 / profile as f64;
        // Never is a share that no bound allows.
        inside.push(since.map_or(f64::INFINITY, share));
        told.push(settled.map_or(f64::INFINITY, share));
        let ticks_a_ms = parameters.limits.rate_hz / 1e3;
        after_ms.push(since.map_or(f64::INFINITY, |at| (at - profile) as f64 / ticks_a_ms));
        if number % 10 == 9 {
            bench.run(REST);
            rest.look(&mut bench, f64::from(parameters.power.pwm_counts));
        }
    }
    print(case, inside, &told, after_ms);
    rest
}

fn print(case: &Case, mut inside: Vec<f64>, told: &[f64], mut after_ms: Vec<f64>) {
    inside.sort_by(f64::total_cmp);
    after_ms.sort_by(f64::total_cmp);
    let at = |values: &[f64], part: f64| values[((values.len() - 1) as f64 * part) as usize];
    let within = |values: &[f64]| {
        values.iter().filter(|&&share| share <= 1.1).count() as f64 / values.len() as f64 * 100.0
    };
    let [ms, share] = [(&after_ms, 1), (&inside, 3)].map(|(values, digits)| {
        [0.5, 0.9, 0.99, 1.0]
            .map(|part| format!("{:.digits$}", at(values, part)))
            .join(" / ")
    });
    println!(
        "| {} | {ms} | {share} | {:.1} % | {:.1} % |",
        case.words(),
        within(&inside),
        within(told)
    );
}
