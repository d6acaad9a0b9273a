//! A snapshot for the command side.

use super::encoder::Encoder;
use super::loop_counters::LoopCounters;
use super::snapshot::{ServoReport, Snapshot};
use super::state::State;
use super::tick_queues::TickQueues;
use crate::drivers::bridge::Duty;
use crate::motion::Position;
use crate::recorder::ServoSample;
use kinematics::Angle;

impl State {
    /// Sends a snapshot to the command side, if there is room.
    #[inline(never)]
    pub(super) fn send_snapshot(
        &mut self,
        queues: &mut TickQueues<'_>,
        setpoint: &Position,
        pivots: &[Angle; 3],
        target: &[Angle; 3],
        duty: [Duty; 3],
    ) {
        if queues.has_snapshot_room() {
            // There is room: only this side fills the queue.
            let snapshot = self.snapshot(setpoint, pivots, target, duty);
            let _ = queues.snapshots.enqueue(snapshot);
            self.loop_counters = LoopCounters::default();
            self.reported_servo = if self.reported_servo < 2 {
                self.reported_servo + 1
            } else {
                0
            };
        }
    }

    #[inline]
    fn snapshot(
        &self,
        setpoint: &Position,
        pivots: &[Angle; 3],
        target: &[Angle; 3],
        duty: [Duty; 3],
    ) -> Snapshot {
        let (plan, plan_tick) = self.motion.progress();
        Snapshot {
            tick: self.tick,
            mode: self.mode,
            fault: self.fault,
            stop_ended_by: self.stop_ended_by,
            referenced: self.referenced,
            encoder_faults: self.encoders.each_ref().map(Encoder::unusable),
            encoder_warnings: self.encoders.each_ref().map(Encoder::warning),
            bridged_frames: self.encoders.each_ref().map(Encoder::bridged_frames),
            slipped: self.encoders.each_ref().map(Encoder::slipped),
            pivots: *pivots,
            // A difference that does not fit is a fault, and then the target is what is measured.
            pivot_errors: [0, 1, 2].map(|i| (pivots[i] - target[i]).units() as i32),
            motor_heat: (self.pivot_watches.each_ref()).map(|watch| watch.mean_square_current),
            resistor_drop_v: self.brake_resistor.test.drop_v(),
            duty,
            setpoint: *setpoint,
            centre: self.motion.centre(),
            plan,
            plan_tick,
            settled: self.settling.settled() && self.servo_on(),
            commands: self.commands,
            refused: self.refused,
            peak_following_error_rad: self.settling.peak_error_rad(),
            excitation: self.excitation.report(self.mode),
            loop_counters: self.loop_counters,
            servo: self.servo_report(),
        }
    }

    /// The servo of this pivot, for the recorders.
    #[inline]
    pub(super) fn servo_sample(&self, pivot: usize) -> Option<ServoSample> {
        let servo = self.servo.get(pivot)?;
        Some(ServoSample {
            pivot: pivot as u8,
            weights: servo.learnt().weights,
            integral_v: servo.integral_volts(),
            current_knees: servo.current_knees(),
        })
    }

    #[inline]
    fn servo_report(&self) -> ServoReport {
        let pivot = self.reported_servo;
        (self.servo.get(pivot)).map_or(ServoReport::default(), |servo| ServoReport {
            pivot,
            learnt: *servo.learnt(),
            integral_v: servo.integral_volts(),
            current_knees: servo.current_knees(),
        })
    }
}
