//! The commander through its own interface: requests in values, errors in its own words, no line of any language.

#[path = "gcs_bench/axes.rs"]
mod axes;
#[path = "gcs_bench/fake_tick.rs"]
mod fake_tick;

use fake_tick::{DWELL, FakeTick};
use firmware::commander::axis::{Axis, AxisValues, Coordinates};
use firmware::commander::frames::{FrameChange, FrameError, FrameName};
use firmware::commander::wave::{Curve, Join, Shape, WaveChange, WaveError};
use firmware::commander::{CommandError, Commander, Quantity, Referencing, SoftLimitChange};
use firmware::fault::FaultKind;
use firmware::mode::Mode;
use firmware::motion::Stop;
use firmware::parameters::Parameters;
use firmware::queues::{CommandQueues, Queues};

/// Largest change of velocity in a tick: an urgent stop brakes as hard as a pivot can, 300 rad/s^2 at 20 kHz, in rad/s.
const SMOOTH: f32 = 1.5e-2;

/// A commander in front of a tick.
struct Bench {
    commander: Commander,
    queues: CommandQueues<'static>,
    tick: FakeTick<'static>,
}

impl Bench {
    fn with(parameters: &Parameters) -> Self {
        let (tick, queues) = Box::leak(Box::new(Queues::new())).split();
        let mut bench = Self {
            commander: Commander::new(parameters),
            queues,
            tick: FakeTick::new(tick, parameters),
        };
        bench.run(2);
        bench
    }

    fn new() -> Self {
        Self::with(&Parameters::REFERENCE)
    }

    /// Referenced at the origin, settled.
    fn ready() -> Self {
        Self::new().referenced()
    }

    fn referenced(mut self) -> Self {
        assert_eq!(self.reference(), Referencing::Done);
        self.run(2 * DWELL);
        self.tick.log.clear();
        self
    }

    /// What a caller does in a tick.
    fn run(&mut self, ticks: u64) {
        for _ in 0..ticks {
            self.tick.run();
            if let Some(snapshot) = self.queues.snapshot() {
                self.commander.update(snapshot);
            }
            self.commander.advance_pending(&mut self.queues);
        }
    }

    fn reference(&mut self) -> Referencing {
        assert_eq!(self.commander.begin_referencing(&mut self.queues), Ok(true));
        for _ in 0..1_000 {
            match self.commander.poll_referencing(&mut self.queues) {
                Referencing::Waiting => self.run(1),
                end => return end,
            }
        }
        Referencing::Waiting
    }

    fn move_to(&mut self, values: &[(Axis, f64)]) -> Result<(), CommandError> {
        self.commander.move_to(&named(values), &mut self.queues)
    }

    fn jog(&mut self, values: &[(Axis, f64)]) -> Result<(), CommandError> {
        self.commander.jog(&named(values), &mut self.queues)
    }

    fn stop(&mut self, stop: Stop) {
        self.commander.stop(stop, &mut self.queues);
    }

    fn run_to_rest(&mut self) {
        for _ in 0..1_000_000 {
            self.run(1);
            if !self.commander.is_motion_commanded() {
                return;
            }
        }
        panic!("never at rest");
    }

    fn position(&self) -> Coordinates {
        self.commander.measured()
    }

    fn value(&self, quantity: Quantity, axis: Axis) -> f64 {
        self.commander.value(quantity, axis)
    }

    #[track_caller]
    fn assert_at(&self, target: [f64; 3]) {
        let at = self.position();
        for (axis, target) in [Axis::X, Axis::Y, Axis::W].into_iter().zip(target) {
            let off = at[axis.index()] - target;
            assert!(off.abs() < 1e-6, "{axis:?} is {off} off");
        }
    }
}

fn named(values: &[(Axis, f64)]) -> AxisValues {
    let mut all = AxisValues::default();
    for (axis, value) in values {
        all[axis.index()] = Some(*value);
    }
    all
}

#[test]
fn referencing_gives_the_pose_that_the_encoders_tell() {
    let mut bench = Bench::new();
    bench.tick.place(3.0, -4.0, 30.0);
    bench.run(2);
    assert_eq!(bench.value(Quantity::Referenced, Axis::X), 0.0);
    assert_eq!(
        bench.move_to(&[(Axis::X, 1.0)]),
        Err(CommandError::NotReady)
    );
    assert_eq!(bench.reference(), Referencing::Done);
    bench.run(2);
    assert_eq!(bench.tick.log, ["reference"]);
    assert_eq!(bench.value(Quantity::Referenced, Axis::X), 1.0);
    bench.assert_at([3.0, -4.0, 30.0]);
    // Once is enough.
    let again = bench.commander.begin_referencing(&mut bench.queues);
    assert_eq!(again, Ok(false));
}

#[test]
fn encoders_that_do_not_answer_are_given_up() {
    let mut bench = Bench::new();
    bench.tick.now.encoder_faults[1] = Some(FaultKind::EncoderSilent);
    bench.run(2);
    let failed = Referencing::Failed(CommandError::ReferencingFailed);
    assert_eq!(bench.reference(), failed);
    assert!(bench.tick.log.is_empty());
}

#[test]
fn a_move_comes_to_rest_at_its_target() {
    let mut bench = Bench::ready();
    assert_eq!(
        bench.move_to(&[(Axis::X, 12.0), (Axis::Y, -7.5), (Axis::W, 400.0)]),
        Ok(())
    );
    assert!(bench.commander.is_motion_pending());
    assert_eq!(bench.value(Quantity::Target, Axis::X), 12.0);
    bench.run(100);
    assert_eq!(bench.tick.now.mode, Mode::Moving);
    bench.run_to_rest();
    assert_eq!(bench.tick.log, ["move"]);
    bench.assert_at([12.0, -7.5, 400.0]);
    let mut relative = AxisValues::default();
    relative[Axis::Y.index()] = Some(2.5);
    let moved = bench.commander.move_by(&relative, &mut bench.queues);
    assert_eq!(moved, Ok(()));
    bench.run_to_rest();
    bench.assert_at([12.0, -5.0, 400.0]);
    assert_eq!(bench.commander.take_late_error(), None);
}

#[test]
fn another_target_in_motion_is_taken_without_a_stop() {
    let mut bench = Bench::ready();
    bench.move_to(&[(Axis::X, 60.0)]).unwrap();
    bench.run(3_000);
    assert_eq!(bench.move_to(&[(Axis::X, 70.0), (Axis::Y, 8.0)]), Ok(()));
    bench.run(100);
    // The line, a stop, and the way that takes the stop's place before it begins.
    assert_eq!(bench.tick.log, ["move", "move", "move"]);
    bench.run_to_rest();
    bench.assert_at([70.0, 8.0, 0.0]);
    assert!(bench.tick.worst_jump < SMOOTH, "{}", bench.tick.worst_jump);
}

#[test]
fn a_plan_that_comes_too_late_is_made_anew() {
    let mut bench = Bench::ready();
    bench.move_to(&[(Axis::X, 60.0)]).unwrap();
    bench.run(3_000);
    // The tick goes on while the command side does something else: further than a plan looks ahead.
    for _ in 0..60 {
        bench.tick.run();
    }
    assert_eq!(bench.move_to(&[(Axis::X, 70.0), (Axis::Y, 8.0)]), Ok(()));
    bench.run_to_rest();
    // The stop that comes too late, one that does not, and the way that takes its place.
    assert_eq!(bench.tick.log, ["move", "refused", "move", "move"]);
    bench.assert_at([70.0, 8.0, 0.0]);
    assert!(bench.tick.worst_jump < SMOOTH, "{}", bench.tick.worst_jump);
    assert_eq!(bench.commander.take_late_error(), None);
}

#[test]
fn a_target_behind_is_reached_after_a_stop() {
    let mut bench = Bench::ready();
    bench.move_to(&[(Axis::X, 60.0)]).unwrap();
    bench.run(3_000);
    let left = bench.position()[Axis::X.index()];
    assert_eq!(
        bench.move_to(&[(Axis::X, left), (Axis::Y, 30.0), (Axis::W, 180.0)]),
        Ok(())
    );
    bench.run_to_rest();
    bench.assert_at([left, 30.0, 180.0]);
    assert!(bench.tick.worst_jump < SMOOTH, "{}", bench.tick.worst_jump);
    assert_eq!(bench.commander.take_late_error(), None);
}

#[test]
fn a_stop_in_motion_rests_where_it_says() {
    for stop in [Stop::Smooth, Stop::Urgent] {
        let mut bench = Bench::ready();
        bench.move_to(&[(Axis::X, 60.0)]).unwrap();
        bench.run(3_000);
        bench.stop(stop);
        bench.run_to_rest();
        bench.run(2);
        assert_eq!(bench.tick.now.mode, Mode::Holding);
        let at = bench.position()[Axis::X.index()];
        assert!((1.0..59.0).contains(&at), "{at}");
        assert!((bench.value(Quantity::Target, Axis::X) - at).abs() < 1e-6);
        // And goes on from there.
        bench.move_to(&[(Axis::X, 0.0)]).unwrap();
        bench.run_to_rest();
        bench.assert_at([0.0, 0.0, 0.0]);
    }
}

#[test]
fn an_urgent_stop_is_the_shorter_one() {
    let ends = [Stop::Smooth, Stop::Urgent].map(|stop| {
        let mut bench = Bench::ready();
        bench.move_to(&[(Axis::X, 60.0)]).unwrap();
        bench.run(3_000);
        bench.stop(stop);
        bench.run_to_rest();
        bench.position()[Axis::X.index()]
    });
    assert!(ends[1] < ends[0], "{ends:?}");
}

#[test]
fn what_is_refused_changes_nothing() {
    let mut bench = Bench::ready();
    let out = bench.move_to(&[(Axis::X, 99.0)]);
    assert!(matches!(out, Err(CommandError::Refused(_))), "{out:?}");
    let frozen = Err(CommandError::FrozenAxis(Axis::Z));
    assert_eq!(bench.move_to(&[(Axis::X, 1.0), (Axis::Z, 1.0)]), frozen);
    assert_eq!(bench.jog(&[(Axis::Z, 1.0)]), frozen);
    let far = bench.move_to(&[(Axis::W, 4e6)]);
    assert_eq!(far, Err(CommandError::OutsideTravel));
    let fast = bench.jog(&[(Axis::X, 1e9)]);
    let axis = Some(Axis::X);
    assert_eq!(fast, Err(CommandError::VelocityOutOfRange { axis }));
    let low = SoftLimitChange::Lowest(named(&[(Axis::X, 1.0)]));
    let crossed = bench.commander.set_soft_limits(&low);
    assert_eq!(crossed, Err(CommandError::SoftLimitsInvalid));
    let high = SoftLimitChange::Highest(named(&[(Axis::X, 5.0)]));
    assert_eq!(bench.commander.set_soft_limits(&high), Ok(()));
    let outside = bench.move_to(&[(Axis::X, 6.0)]);
    assert_eq!(outside, Err(CommandError::OutsideSoftLimits));
    let unknown = FrameName::new(b"MINE").unwrap();
    let enabled = bench
        .commander
        .change_frames(&FrameChange::Enable(unknown), &mut bench.queues);
    assert_eq!(enabled, Err(FrameError::Unknown(unknown).into()));
    bench.run(10);
    assert!(bench.tick.log.is_empty());
    assert_eq!(bench.value(Quantity::Target, Axis::X), 0.0);
}

#[test]
fn a_fault_ends_what_was_asked() {
    let mut bench = Bench::ready();
    bench.move_to(&[(Axis::X, 60.0)]).unwrap();
    bench.run(3_000);
    bench.tick.fail(FaultKind::FollowingError, Some(0));
    bench.run(2);
    assert!(!bench.commander.is_motion_commanded());
    assert_eq!(bench.move_to(&[(Axis::X, 0.0)]), Err(CommandError::Faulted));
    assert_eq!(bench.commander.acknowledge_fault(&mut bench.queues), Ok(()));
    bench.run(2);
    assert_eq!(
        bench.move_to(&[(Axis::X, 0.0)]),
        Err(CommandError::NotReady)
    );
}

#[test]
fn a_jog_keeps_its_velocity_until_another_one() {
    let mut bench = Bench::ready();
    assert_eq!(bench.jog(&[(Axis::X, 10.0)]), Ok(()));
    bench.run(6_000);
    let first = bench.position()[Axis::X.index()];
    bench.run(2_000);
    let moved = bench.position()[Axis::X.index()] - first;
    // A tenth of a second at 20 kHz.
    assert!((moved - 1.0).abs() < 1e-3, "{moved}");
    assert_eq!(bench.value(Quantity::Jog, Axis::X), 10.0);
    assert_eq!(bench.jog(&[(Axis::X, 0.0)]), Ok(()));
    bench.run_to_rest();
    bench.run(2);
    let at = bench.position()[Axis::X.index()];
    assert!((bench.value(Quantity::Target, Axis::X) - at).abs() < 1e-6);
    assert_eq!(bench.value(Quantity::Jog, Axis::X), 0.0);
    assert!(bench.tick.worst_jump < SMOOTH, "{}", bench.tick.worst_jump);
}

fn streamed() -> Parameters {
    let mut parameters = Parameters::REFERENCE;
    parameters.targets.streamed = true;
    parameters
}

/// Targets of a stream: out and back on a smooth curve, every 10 ms.
fn streamed_x(k: u32) -> f64 {
    1.0 - (f64::from(k) * core::f64::consts::TAU / 100.0).cos()
}

#[test]
fn streamed_targets_are_followed() {
    let mut bench = Bench::with(&streamed()).referenced();
    // The last target comes again and again: the stream is at rest when it ends.
    for k in (0..=100).chain([100; 10]) {
        assert_eq!(bench.move_to(&[(Axis::X, streamed_x(k))]), Ok(()), "{k}");
        bench.run(200);
    }
    bench.run_to_rest();
    bench.assert_at([0.0, 0.0, 0.0]);
    assert!(bench.tick.log.len() > 50, "{:?}", bench.tick.log);
    assert!(bench.tick.worst_jump < SMOOTH, "{}", bench.tick.worst_jump);
    assert_eq!(bench.commander.take_late_error(), None);
}

/// A stop at rest is over at once: what begins before the next snapshot is not stopped by it.
#[test]
fn a_stop_at_rest_does_not_stop_the_stream_after_it() {
    let mut bench = Bench::with(&streamed()).referenced();
    bench.move_to(&[(Axis::X, 0.0)]).unwrap();
    bench.stop(Stop::Smooth);
    for k in 0..20 {
        bench.move_to(&[(Axis::X, streamed_x(k))]).unwrap();
    }
    bench.commander.advance_pending(&mut bench.queues);
    bench.run(200);
    for k in (20..=100).chain([100; 10]) {
        assert_eq!(bench.move_to(&[(Axis::X, streamed_x(k))]), Ok(()), "{k}");
        bench.run(200);
    }
    bench.run_to_rest();
    bench.assert_at([0.0, 0.0, 0.0]);
    assert_eq!(bench.commander.take_late_error(), None);
}

#[test]
fn a_stream_that_ends_in_motion_comes_to_rest_and_says_so() {
    let mut bench = Bench::with(&streamed()).referenced();
    for k in 0..=25 {
        assert_eq!(bench.move_to(&[(Axis::X, streamed_x(k))]), Ok(()));
        bench.run(200);
    }
    assert_eq!(bench.jog(&[(Axis::X, 1.0)]), Err(CommandError::Streaming));
    bench.run_to_rest();
    let late = bench.commander.take_late_error();
    assert_eq!(late, Some(CommandError::StreamDry));
    assert_eq!(bench.commander.take_late_error(), None, "told once");
    let at = bench.position()[Axis::X.index()];
    assert!(at > 0.5 && (at - streamed_x(25)).abs() > 1e-3, "{at}");
}

#[test]
fn a_waveform_begins_where_its_table_does() {
    let mut bench = Bench::ready();
    let start = |bench: &mut Bench, on: bool| {
        let mut switch = [None; 6];
        switch[Axis::X.index()] = Some(on);
        (bench.commander).change_waves(&WaveChange::Switch(switch), &mut bench.queues)
    };
    let none = Err(WaveError::NoTable(Axis::X).into());
    assert_eq!(start(&mut bench, true), none);
    let curve = Curve {
        amplitude: 2.0,
        offset: 5.0,
        length: 500,
        start: 0,
    };
    let define = WaveChange::Define {
        table: 0,
        join: Join::Anew,
        length: 500,
        shape: Shape::Sine { curve, centre: 250 },
    };
    let mut tables = [None; 6];
    tables[Axis::X.index()] = Some(1);
    let mut cycles = [None; 6];
    cycles[Axis::X.index()] = Some(2);
    for change in [
        define,
        WaveChange::Select(tables),
        WaveChange::Cycles(cycles),
    ] {
        assert_eq!(
            bench.commander.change_waves(&change, &mut bench.queues),
            Ok(())
        );
    }
    assert_eq!(start(&mut bench, true), Ok(()));
    let running = bench.commander.running_generators();
    assert!(running[Axis::X.index()]);
    assert_eq!(
        bench.move_to(&[(Axis::X, 0.0)]),
        Err(CommandError::GeneratorsRunning)
    );
    let mut highest = 0.0f64;
    for _ in 0..40_000 {
        bench.run(1);
        highest = highest.max(bench.position()[Axis::X.index()]);
    }
    assert_eq!(bench.commander.running_generators(), [false; 6]);
    assert!((highest - 7.0).abs() < 1e-2, "{highest}");
    // The last point of the table is one before the curve's end.
    let last = 6.0 - (core::f64::consts::PI / 250.0).cos();
    bench.assert_at([last, 0.0, 0.0]);
    assert_eq!(bench.commander.take_late_error(), None);
}
