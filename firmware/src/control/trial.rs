//! Trials of iterative learning in the tick.

use super::config::Config;
use super::servo::PivotServoConfig;
use super::state::State;
use crate::iterative_learning::{ServoStep, TrialTable};
use crate::mode::Mode;
use kinematics::Angle;

impl State {
    /// Goes a tick on with the table that belongs to the motion, if one does. What a table holds when it ends goes over to the integrals.
    #[inline]
    pub(super) fn advance_trial(&mut self, config: &Config, table: TrialTable<'_>) {
        let follows = matches!(self.mode, Mode::Holding | Mode::Moving);
        let motion = follows.then(|| self.motion.progress());
        let left = (self.trial).advance(table, config.limits.rate_hz, motion);
        if let Some(left) = left {
            for ((servo, config), volts) in
                (self.servo.iter_mut().zip(&config.servo.pivots)).zip(left)
            {
                servo.take_over(config, volts);
            }
        }
    }

    /// Keeps what the servos have done in this tick of a trial.
    #[inline]
    pub(super) fn record_trial(
        &mut self,
        config: &Config,
        table: TrialTable<'_>,
        pivots: &[Angle; 3],
    ) {
        let Some(wanted) = &self.next.pivots else {
            return;
        };
        if !self.trial.is_under_way() {
            return;
        }
        let target = &wanted.angles;
        let steps = [0, 1, 2].map(|i| ServoStep {
            error: (pivots[i] - target[i]).units() as i32,
            feedback: self.servo[i].feedback_volts(),
            integral: self.servo[i].integral_volts(),
        });
        let inverse = (config.servo.pivots.each_ref()).map(PivotServoConfig::inverse_plant);
        self.trial.record(table, &inverse, &steps);
    }
}
