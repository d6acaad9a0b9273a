//! The tick as a whole: referenced, then led from target to target, every pivot where it should be but for a little.
//! Now and then a frame is missing.

use super::SUPPLY_COUNTS;
use super::frames::frames;
use crate::bench::Bench;
use crate::table::CallResult;
use firmware::control::config::Config;
use firmware::control::{Inputs, State, tick};
use firmware::drivers::biss::RawFrame;
use firmware::mode::Mode;
use firmware::motion::{
    AxisState, Constraints, Effort, Plan, RotationCentre, plan_line, plan_retarget,
};
use firmware::number::Fixed;
use firmware::queues::{Command, CommandQueues, Queues, TickQueues};
use firmware::recorder::{RawSignal, RecordSetup, RunningHash, Sample, TickObserver};
use firmware_cost::random::Random;
use firmware_cost::states::{ground, position};
use kinematics::{Angle, Pose, inverse};

/// Of the pivots while nothing moves them.
const AT_START: Pose<Fixed> = Pose {
    x: Fixed::from_f64(0.1),
    y: Fixed::from_f64(-0.2),
    theta: Angle::DEG_30,
};
/// Ticks before the encoders are referenced: they take some to be ready.
const REFERENCED: u64 = 10;
/// And when its bridges are awake: no command is taken before.
const AWAKE: u64 = 60;
/// A tick in so many is given a new target while a plan is under way, or has a frame missing.
const RETARGETS: u64 = 500;
const MISSES: u64 = 300;
/// By how much the brake resistor draws the supply down, ADC counts.
const RESISTOR_COUNTS: u16 = 18;
/// Ticks from planning to the change of plans.
const AHEAD: u64 = 5;

/// A point to turn about, off the platform's own.
const OFF_CENTRE: [f64; 2] = [0.3, -0.2];
/// What is recorded at every tick.
const RECORDED: [RawSignal; 8] = [
    RawSignal::Centre(0),
    RawSignal::Centre(1),
    RawSignal::Theta,
    RawSignal::Pivot(0),
    RawSignal::Pivot(1),
    RawSignal::Pivot(2),
    RawSignal::PivotError(0),
    RawSignal::PivotError(1),
];

/// Counts the tick: about the platform's centre, about another point, and while signals are recorded.
pub fn run(bench: &mut Bench, config: &Config) {
    // Once, and far too large for the stack.
    let Some(queues) = cortex_m::singleton!(: Queues = Queues::new()) else {
        return;
    };
    let other = RotationCentre::new(OFF_CENTRE).unwrap_or_default();
    for (name, centre, records) in [
        ("tick as a whole", RotationCentre::PLATFORM, false),
        ("tick as a whole, centre of rotation", other, false),
        ("tick as a whole, recording 8 signals", other, true),
    ] {
        led(bench, config, queues, name, centre, records);
    }
}

#[inline(never)]
fn led(
    bench: &mut Bench,
    config: &Config,
    queues: &mut Queues,
    name: &'static str,
    centre: RotationCentre,
    records: bool,
) {
    let (tick_queues, mut panel) = queues.split();
    // What the last loop has left.
    let _ = panel.snapshot();
    let mut control = Control {
        config: config.clone(),
        state: State::new(),
        queues: tick_queues,
        recorder: Recorder::default(),
        panel,
        plan: Plan::default(),
        start: [AxisState::default(); 3],
        centre,
        records,
        sent: 0,
        brakes: false,
        ground: Constraints {
            rotation_centre: centre.point(),
            ..*ground()
        },
        ticks: 0,
    };
    bench.part_with(
        name,
        Bench::SHORT * Bench::SHORT,
        &mut control,
        Control::inputs,
        |control, inputs| {
            let Control {
                config,
                state,
                queues,
                recorder,
                brakes,
                ..
            } = control;
            let outputs = tick(config, state, inputs, queues, recorder);
            *brakes = outputs.brake_resistor;
            outputs
        },
        // Off, or at fault: a tick that drives no motor.
        |_, outputs| CallResult {
            refused: !outputs.awake,
            ticks: 0,
        },
    );
}

/// The loop, and what leads it.
struct Control<'a> {
    config: Config,
    state: State,
    queues: TickQueues<'a>,
    recorder: Recorder,
    panel: CommandQueues<'a>,
    /// The plan under way, or on its way to the tick, and where it starts.
    plan: Plan,
    start: [AxisState; 3],
    centre: RotationCentre,
    records: bool,
    /// Commands sent.
    sent: u32,
    /// The last tick has the brake resistor on, which draws the supply down.
    brakes: bool,
    ground: Constraints,
    ticks: u64,
}

/// The image's recorder, and the last sample.
#[derive(Default)]
struct Recorder {
    hash: RunningHash,
    last: Option<Sample>,
}

impl TickObserver for Recorder {
    #[inline]
    fn observe(&mut self, sample: &Sample) {
        self.hash.observe(sample);
        self.last = Some(sample.clone());
    }
}

impl Control<'_> {
    /// The next tick's inputs; leads the loop on by its command queue.
    fn inputs(&mut self, random: &mut Random) -> Inputs {
        self.ticks += 1;
        let mut pivots = inverse(&AT_START).map_or([Angle::ZERO; 3], |inverse| inverse.pivots);
        if self.ticks == REFERENCED {
            // The queue is empty.
            let _ = self.panel.send(Command::Reference);
            self.sent = 1;
        } else if self.ticks == AWAKE {
            let _ = self.panel.send(Command::Centre(self.centre));
            self.sent = 2;
        } else if let Some(sample) = self.recorder.last.take() {
            if matches!(sample.mode, Mode::Holding | Mode::Moving) {
                pivots = reached(&sample, random);
            }
            if self.ticks > AWAKE {
                self.lead(&sample, random);
            }
        }
        let mut frames = frames(&pivots);
        if self.ticks > REFERENCED && random.once_in(MISSES) {
            frames[random.up_to(3) as usize - 1] = RawFrame::MISSING;
        }
        Inputs {
            frames,
            bridge_fault: [false; 3],
            emergency_stop: false,
            current_counts: [100; 3],
            supply_counts: SUPPLY_COUNTS - RESISTOR_COUNTS * u16::from(self.brakes),
            tick_cycles: 0,
            program_damaged: false,
            late: false,
        }
    }

    /// Begins another record.
    fn record(&mut self) {
        if self.records {
            let setup = RecordSetup {
                number: self.plan.id,
                signals: RECORDED.into_iter().collect(),
                every: 1,
                rows: (self.panel.recorder.capacity() / RECORDED.len()) as u32,
                now: true,
                ..RecordSetup::default()
            };
            // The tick takes an order as soon as it comes.
            let _ = self.panel.recorder.start(&setup);
        }
    }

    /// A line from where the stage rests, or now and then another target in motion.
    fn lead(&mut self, sample: &Sample, random: &mut Random) {
        let Some(snapshot) = self.panel.snapshot() else {
            return;
        };
        // One is on its way yet.
        if snapshot.commands != self.sent {
            return;
        }
        let from = sample.reference_point.position;
        let to = self.centre.from_platform(&position(random));
        let id = self.plan.id + 1;
        let planned = match sample.mode {
            Mode::Holding => {
                self.record();
                let start = from.map(AxisState::at_rest);
                plan_line(id, from, to, &self.ground).ok().zip(Some(start))
            }
            Mode::Moving if snapshot.plan == self.plan.id && random.once_in(RETARGETS) => {
                let (plan, at) = (&self.plan, snapshot.plan_tick + AHEAD);
                let next = plan_retarget(id, plan, &self.start, at, to, &self.ground, Effort::ALL);
                next.ok()
                    .map(|next| (next, plan.state_after(&self.start, at)))
            }
            _ => None,
        };
        if let Some((plan, start)) = planned {
            self.start = start;
            self.plan = plan.clone();
            // The tick has emptied the queue, or nearly.
            let _ = self.panel.send_plan(&plan);
            self.sent += 1;
        }
    }
}

/// Where the pivots are when they have followed the sample, a few counts off.
fn reached(sample: &Sample, random: &mut Random) -> [Angle; 3] {
    const UNITS_PER_RAD_TICK: f32 = 4_294_967_296.0 / core::f32::consts::TAU / 20_000.0;
    let mut pivots = sample.pivot_setpoints;
    for (pivot, rate) in pivots.iter_mut().zip(sample.pivot_rates) {
        let way = (rate * UNITS_PER_RAD_TICK) as i64 + random.within(-500.0, 500.0) as i64;
        *pivot += Angle::from_units(way);
    }
    pivots
}
