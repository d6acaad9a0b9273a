//! Random moves over the whole disk and what is seen of them from outside: how soon the stage settles, and how quiet it is between them.

use firmware::control::SubdivisionTable;
use firmware::control::config::Config;
use firmware::motion::{Constraints, Position, plan_line};
use firmware::parameters::Parameters;
use firmware::queues::{Command, CommandQueues, Queues, Snapshot, TickQueues};
use hal_sim::front::Host;
use hal_sim::machine::devices::StageParameters;
use hal_sim::rig::observer::TickRecord;

const MOVES: usize = 200;
const UNIT: f64 = 4_294_967_296.0;
const UNITS_PER_LSB: f64 = 64.0;
/// Ticks after a move in which the stage has to have settled.
const PATIENCE: u64 = 4_000;
/// Ticks at rest that are looked at after every tenth move: half a second, begun half a second after settling.
const REST: u64 = 10_000;

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
pub struct Rest {
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

    /// Spread of the true position, nm rms, and of theta, nrad rms; pivots' errors, LSB rms and the largest; spread of the duty, %.
    pub fn cells(&self) -> String {
        let rms = |sum: f64| (sum / self.times).sqrt();
        format!(
            "{:.2} | {:.1} | {:.2} / {:.1} | {:.3}",
            rms(self.way) * 1e9,
            rms(self.turn) * 1e9,
            rms(self.pivots),
            self.peak,
            rms(self.duty) * 100.0
        )
    }
}

/// Since when something stays inside its window.
#[derive(Default)]
struct Inside(Option<u64>);

impl Inside {
    /// Looks at errors at a tick of a move whose profile is that long.
    fn look(&mut self, [tick, profile]: [u64; 2], errors: &[f64; 3], window: f64) {
        if errors.iter().any(|error| error.abs() > window) {
            self.0 = None;
        } else if tick >= profile {
            self.0.get_or_insert(tick);
        }
    }
}

/// The mean of the last errors, over what the controller takes it over.
struct Mean {
    last: Vec<[f64; 3]>,
    at: usize,
}

impl Mean {
    fn over(ticks: usize) -> Self {
        let last = vec![[0.0; 3]; ticks];
        Self { last, at: 0 }
    }

    fn with(&mut self, errors: [f64; 3]) -> [f64; 3] {
        self.last[self.at] = errors;
        self.at = (self.at + 1) % self.last.len();
        let sum_of = |i: usize| self.last.iter().map(|errors| errors[i]).sum::<f64>();
        [0, 1, 2].map(|i| sum_of(i) / self.last.len() as f64)
    }
}

/// What moves and rests between them come to.
pub struct Moves {
    /// From the profile's end to inside the window, ms, by every reading and by the mean of those that the controller takes it of; to the first and to
    /// where the controller says so, as shares of the profile. All sorted.
    after_ms: Vec<f64>,
    by_mean_ms: Vec<f64>,
    inside: Vec<f64>,
    told: Vec<f64>,
    /// What is seen between them.
    pub rest: Rest,
}

impl Moves {
    /// Settling after the profile, ms, by readings and by their mean, and as a share of the profile: median, 90 %, 99 % and worst each.
    pub fn settling(&self) -> String {
        let spread = |values: &[f64], digits: usize| {
            [0.5, 0.9, 0.99, 1.0]
                .map(|part| {
                    let at = ((values.len() - 1) as f64 * part) as usize;
                    format!("{:.digits$}", values[at])
                })
                .join(" / ")
        };
        [
            spread(&self.after_ms, 1),
            spread(&self.by_mean_ms, 1),
            spread(&self.inside, 3),
        ]
        .join(" | ")
    }

    /// Share of the moves that have settled within 1.1 of their profiles.
    pub fn within_a_tenth(&self) -> f64 {
        share_within(&self.inside)
    }

    /// The same as the controller tells it.
    pub fn told_within_a_tenth(&self) -> f64 {
        share_within(&self.told)
    }
}

fn share_within(values: &[f64]) -> f64 {
    values.iter().filter(|&&share| share <= 1.1).count() as f64 / values.len() as f64
}

/// Moves of a machine under this controller.
pub fn of(stage: &StageParameters, parameters: &Parameters) -> Moves {
    let ground = Constraints::new(parameters.limits, parameters.geometry);
    let mut queues = Queues::new();
    let (tick_queues, commands) = queues.split();
    let mut bench = Bench {
        host: Host::new(stage, parameters),
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
    let (mut inside, mut told) = (Vec::new(), Vec::new());
    let (mut after_ms, mut by_mean_ms) = (Vec::new(), Vec::new());
    let window = parameters.window.counts + 0.5;
    let mut mean = Mean::over(Config::new(parameters).limits.mean_ticks);
    for number in 0..MOVES {
        let from = bench.last.setpoint;
        let to = random.target(&from);
        let plan = plan_line(number as u32 + 1, from, to, &ground).expect("inside the disk");
        let profile = plan.ticks();
        assert!(bench.commands.send_plan(&plan).is_ok(), "room");
        let (mut since, mut mean_since, mut settled) = (Inside::default(), Inside::default(), None);
        for tick in 1..=profile + PATIENCE {
            bench.tick();
            let errors = bench.errors();
            since.look([tick, profile], &errors, window);
            mean_since.look([tick, profile], &mean.with(errors), window);
            if tick > profile && bench.last.settled && settled.is_none() {
                settled = Some(tick);
            }
        }
        let share = |ticks: u64| ticks as f64 / profile as f64;
        // Never is a share that no bound allows.
        inside.push(since.0.map_or(f64::INFINITY, share));
        told.push(settled.map_or(f64::INFINITY, share));
        let ticks_a_ms = parameters.limits.rate_hz / 1e3;
        for (all, Inside(since)) in [(&mut after_ms, since), (&mut by_mean_ms, mean_since)] {
            all.push(since.map_or(f64::INFINITY, |at| (at - profile) as f64 / ticks_a_ms));
        }
        if number % 10 == 9 {
            bench.run(REST);
            rest.look(&mut bench, f64::from(parameters.power.pwm_counts));
        }
    }
    for values in [&mut inside, &mut told, &mut after_ms, &mut by_mean_ms] {
        values.sort_by(f64::total_cmp);
    }
    Moves {
        after_ms,
        by_mean_ms,
        inside,
        told,
        rest,
    }
}
