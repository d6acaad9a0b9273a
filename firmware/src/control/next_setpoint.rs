//! The setpoint of the next tick, computed in this one after its duties are written.
//!
//! A setpoint is known ahead: it hangs on the plan and on no measurement. Only what does hang on one, from the encoders'
//! frames to the duties, has a deadline. A command is taken where the next setpoint is computed, so that it acts with the
//! tick after the one that takes it; and so does the stop that answers a fault.
//! The servos' feedforward hangs on the setpoint alone, and is computed here too.

use super::config::Config;
use super::inspection::INSPECTION_PERIOD_TICKS;
use super::pivot_setpoints::{PivotSetpoints, pivot_setpoints, pose};
use super::servo::{PivotServo, PivotSetpoint};
use super::state::State;
use crate::fault::FaultKind;
use crate::iterative_learning::TrialTable;
use crate::mode::Mode;
use crate::motion::{PlanReceiver, Setpoint};
use kinematics::Angle;

/// The turn of no pivot.
const NOBODY: usize = 3;

impl State {
    /// One tick on: the setpoint that the next tick follows, and what a trial adds in it. One that can not be followed is
    /// a fault, and nothing drives.
    #[inline(never)]
    pub(super) fn prepare_next(
        &mut self,
        config: &Config,
        plans: PlanReceiver<'_>,
        table: TrialTable<'_>,
    ) {
        let point = self.advance_motion(config, plans);
        self.advance_trial(config, table);
        let platform = self.motion.centre().platform_setpoint(&point);
        self.next.point = point;
        self.next.platform = platform;
        self.next.moving = self.motion.is_moving();
        if !(self.servo_on()
            && self.is_in_disk(config, &platform.position)
            && self.find_pivots(config, &platform))
        {
            self.next.pivots = None;
        }
    }

    fn advance_motion(&mut self, config: &Config, plans: PlanReceiver<'_>) -> Setpoint {
        let motion = &mut self.motion;
        if self.mode == Mode::Stopping {
            motion.advance_fault_stop(&config.fault_stop, plans);
            return motion.fault_stop_setpoint(&config.scale);
        }
        // With the servo off there is nothing under way.
        if matches!(self.mode, Mode::Holding | Mode::Moving) {
            motion.advance(plans);
        }
        motion.setpoint(&config.scale)
    }

    /// The pivots' setpoints, where they are kept, and the servos' voltages for them; not where nothing may follow them.
    fn find_pivots(&mut self, config: &Config, platform: &Setpoint) -> bool {
        let wanted =
            (self.next.pivots).get_or_insert_with(|| PivotSetpoints::at_rest([Angle::ZERO; 3]));
        let found = if self.calibrated.is_on {
            pose(&platform.position).and_then(|pose| {
                self.calibrated.follow_from(&pose);
                let motion = (&platform.twist, &platform.acceleration);
                (self.calibrated).pivot_setpoints(config, &pose, motion, wanted, None)
            })
        } else {
            pivot_setpoints(config, platform, wanted)
        };
        if found.is_none() {
            self.raise_fault(FaultKind::ImpossibleSetpoint, None, 0.0, 0.0);
            return false;
        }
        // Of the pivot that is inspected in the next tick.
        let i = self.inspection_slot;
        if let (Some(&length), Some(rate), Some(acceleration)) = (
            wanted.lengths.get(i),
            wanted.motion.rates.get(i),
            wanted.motion.accelerations.get(i),
        ) {
            self.next.slowly = rate.abs() < config.limits.slow_rate
                && acceleration.abs() < config.limits.slow_acceleration;
            if !self.is_in_guide_range(config, i, length) {
                return false;
            }
        }
        if let Some(wanted) = &mut self.next.pivots {
            // A tick has no time for both: guides and gears take turns, round by round.
            let [guide, gear] = if (self.tick as u32 / INSPECTION_PERIOD_TICKS).is_multiple_of(2) {
                [i, NOBODY]
            } else {
                [NOBODY, i]
            };
            if let Some(told) = &config.guides {
                self.guides
                    .make_up(told, config.limits.rate_hz, wanted, guide);
            }
            feed_forward(&mut self.servo, config, wanted, gear);
        }
        true
    }
}

/// The servos' voltages for these setpoints; `turn` is the pivot that has its turn.
#[inline(never)]
pub(super) fn feed_forward(
    servos: &mut [PivotServo; 3],
    config: &Config,
    wanted: &PivotSetpoints,
    turn: usize,
) {
    for (i, (servo, config)) in (servos.iter_mut().zip(&config.servo.pivots)).enumerate() {
        let setpoint = PivotSetpoint {
            rate: wanted.motion.rates[i],
            acceleration: wanted.motion.accelerations[i],
            platform_torque: wanted.torques[i],
            angle: wanted.angles[i],
            has_turn: i == turn,
        };
        servo.feed_forward(config, &setpoint);
    }
}
