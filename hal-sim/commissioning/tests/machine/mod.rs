//! A simulated machine under voltages, as a controller's excitation gives them: no controller, no kinematics. A weak servo on each
//! ring's own encoder turns the rings and keeps them together.
#![allow(dead_code)] // Each test file uses its part.

use commissioning::frequency_response::Run;
use commissioning::record::{Record, Timing};
use firmware::control::excitation::{Multisine, PERIOD_TICKS, line_harmonics};
use hal_sim::machine::devices::{
    BridgeState, COUNTS_PER_TURN, MAX_DUTY, Stage, StageParameters, WiringParameters,
};
use std::f64::consts::TAU;

pub mod steady;
pub mod truth;

pub const TIMING: Timing = Timing::STAGE;
pub const PERIOD: usize = PERIOD_TICKS as usize;
const VOLTS_PER_COUNT: f64 = 3.3 / 4096.0;

/// The machine of a seed, with plugs and directions as an earlier step has put them right.
pub fn unknown(seed: u64) -> StageParameters {
    sorted(hal_sim::machine::unknown(seed))
}

pub fn sorted(mut machine: StageParameters) -> StageParameters {
    machine.wiring = WiringParameters::REFERENCE;
    for encoder in &mut machine.encoders {
        encoder.reversed = false;
    }
    machine
}

/// What the weak servo wants of a ring.
#[derive(Clone, Copy)]
pub struct Want {
    pub angle_rad: f64,
    pub rate_rad_s: f64,
}

pub struct Machine {
    pub stage: Stage,
    counts: [u32; 3],
    pub angle_rad: [f64; 3],
    last_rad: [f64; 3],
    offset_a: [f64; 3],
    pub supply_v: f64,
    residue: [f64; 3],
    pub current_a: [f64; 3],
    /// V s/rad, V/rad.
    pub gains: [f64; 2],
}

impl Machine {
    pub fn at(parameters: &StageParameters, pose: [f64; 3]) -> Self {
        let mut stage = Stage::new(parameters);
        stage.set_pose_at_rest(pose);
        let counts = [0, 1, 2].map(|i| stage.encoders[i].position());
        let mut machine = Self {
            stage,
            counts,
            angle_rad: [0.0; 3],
            last_rad: [0.0; 3],
            offset_a: [0.0; 3],
            supply_v: 48.0,
            residue: [0.0; 3],
            current_a: [0.0; 3],
            gains: [2.0, 60.0],
        };
        // Offsets of the currents at rest, as the first step of commissioning has them.
        let mut sum = [0.0; 3];
        for _ in 0..2_000 {
            machine.tick([0.0; 3]);
            sum = [0, 1, 2].map(|i| sum[i] + machine.current_a[i] / 2e3);
        }
        machine.offset_a = sum;
        machine
    }

    /// One tick: volts that are wanted, those that are given.
    pub fn tick(&mut self, volts: [f64; 3]) -> [f64; 3] {
        let (currents, supply) = self.stage.analog();
        self.supply_v += 0.01 * (f64::from(supply) * VOLTS_PER_COUNT * 20.0 - self.supply_v);
        self.last_rad = self.angle_rad;
        for (i, counts) in currents.into_iter().enumerate() {
            self.current_a[i] =
                (f64::from(counts) - 2048.0) * VOLTS_PER_COUNT / 0.2 - self.offset_a[i];
            let position = self.stage.encoders[i].position();
            let half = COUNTS_PER_TURN / 2;
            let step = (position.wrapping_sub(self.counts[i]).wrapping_add(half)
                & (COUNTS_PER_TURN - 1)) as i32
                - half as i32;
            self.counts[i] = position;
            self.angle_rad[i] += f64::from(step) * TAU / f64::from(COUNTS_PER_TURN);
        }
        let full = f64::from(MAX_DUTY);
        let mut given = [0.0; 3];
        let pins = [0, 1, 2].map(|i| {
            let wanted = volts[i] / self.supply_v * full + self.residue[i];
            let counts = wanted.round().clamp(-full, full);
            self.residue[i] = wanted - counts;
            given[i] = counts / full * self.supply_v;
            BridgeState {
                pulse: counts.abs() / full,
                forward: counts > 0.0,
                awake: true,
                fault: false,
            }
        });
        self.stage.advance_period(pins);
        given
    }

    /// One tick with the weak servo: what is recorded.
    pub fn servo_tick(&mut self, wants: [Want; 3], more_v: [f64; 3], record: Option<&mut Record>) {
        let [velocity, position] = self.gains;
        let volts = [0, 1, 2].map(|i| {
            let rate = (self.angle_rad[i] - self.last_rad[i]) / TIMING.tick_s;
            let want = wants[i];
            more_v[i]
                + 3.0 * want.rate_rad_s
                + velocity * (want.rate_rad_s - rate)
                + position * (want.angle_rad - self.angle_rad[i])
        });
        let given = self.tick(volts);
        if let Some(record) = record {
            for (i, signals) in record.pivots.iter_mut().enumerate() {
                signals.volts.push(given[i]);
                signals.current_a.push(self.current_a[i]);
                signals.angle_rad.push(self.angle_rad[i]);
            }
        }
        if let Some(broken) = self.stage.plant.broken() {
            panic!("{broken:?}");
        }
    }
}

/// What is excited, and how.
#[derive(Clone, Copy)]
pub struct Plan {
    pub pose: [f64; 3],
    pub rate_rad_s: f64,
    pub rms_v: f64,
    pub periods: usize,
    pub to_hz: f64,
}

pub const PLAN: Plan = Plan {
    pose: [0.0; 3],
    rate_rad_s: 2.0,
    rms_v: 3.0,
    periods: 4,
    to_hz: 3_000.0,
};

/// How many times as strong an excitation is as the weaker one.
pub const WEAKER: f64 = 2.5;

pub struct Excited {
    pub runs: Vec<Run>,
    pub machine: Machine,
    /// How warm the windings were halfway, K.
    pub warmer_k: [f64; 3],
}

/// Runs of an excitation: the controller has 16 sines at a time.
pub const RUNS: u32 = 4;

/// Harmonics of a run, as `EXC SINES` is told them: those of one lie between those of the others.
pub fn harmonics(run: u32, to_hz: f64) -> Vec<usize> {
    let highest = (to_hz * PERIOD as f64 * TIMING.tick_s).round() as u32;
    let harmonics = line_harmonics(6 + run, highest - 40 * (RUNS - 1 - run), 14);
    harmonics
        .iter()
        .map(|harmonic| *harmonic as usize)
        .collect()
}

/// A period of what the controller makes of them, with so many volts rms.
pub fn period_v(harmonics: &[usize], rms_v: f64) -> Vec<f64> {
    let harmonics: Vec<u32> = harmonics.iter().map(|harmonic| *harmonic as u32).collect();
    let period = |peak_v: f64| {
        let mut sines = Multisine::new(&harmonics, peak_v);
        let volts: Vec<f64> = (0..PERIOD).map(|_| f64::from(sines.next_volts())).collect();
        volts
    };
    let square: f64 = period(1.0).iter().map(|volts| volts * volts).sum();
    period(rms_v / (square / PERIOD as f64).sqrt())
}

/// The records of a plan, on a machine that turns without end.
pub fn excite(parameters: &StageParameters, plan: &Plan) -> Excited {
    let mut machine = Machine::at(parameters, plan.pose);
    let mut phase_rad = machine.angle_rad[0];
    let start = machine.angle_rad;
    let mut rate = 0.0;
    let mut turn = |machine: &mut Machine, more_v: [f64; 3], record: Option<&mut Record>| {
        rate += (plan.rate_rad_s - rate) * 2e-3;
        phase_rad += rate * TIMING.tick_s;
        let wants = [0, 1, 2].map(|i| Want {
            angle_rad: start[i] + phase_rad,
            rate_rad_s: rate,
        });
        machine.servo_tick(wants, more_v, record);
    };
    for _ in 0..10_000 {
        turn(&mut machine, [0.0; 3], None);
    }
    let before_k = machine.stage.plant.windings_warmer_k();
    let runs = (0..RUNS)
        .map(|run| {
            let bins = harmonics(run, plan.to_hz);
            let volts = period_v(&bins, plan.rms_v);
            let experiments = [0, 1, 2].map(|drive| {
                let mut record = Record {
                    first_tick: PERIOD,
                    ..Record::default()
                };
                for tick in 0..(1 + plan.periods) * PERIOD {
                    let mut more_v = [0.0; 3];
                    more_v[drive] = volts[tick % PERIOD];
                    let kept = (tick >= PERIOD).then_some(&mut record);
                    turn(&mut machine, more_v, kept);
                }
                vec![record]
            });
            Run {
                period_ticks: PERIOD,
                ticks_per_row: 1,
                bins,
                experiments,
            }
        })
        .collect();
    let after_k = machine.stage.plant.windings_warmer_k();
    let warmer_k = [0, 1, 2].map(|i| 0.5 * (before_k[i] + after_k[i]));
    Excited {
        runs,
        machine,
        warmer_k,
    }
}
