//! The following error of the pivots: measured minus setpoint.

use super::input_faults::LATE_RECOVERY_TICKS;
use crate::control::config::Config;
use crate::control::state::State;
use crate::control::units::UNITS_PER_RAD;
use crate::fault::FaultKind;
use kinematics::Angle;

impl State {
    /// Measured minus setpoint, 2^-32 turns, and the largest of the three by its size, if that is allowed.
    #[inline]
    pub(in crate::control) fn following_errors(
        &mut self,
        config: &Config,
        pivots: &[Angle; 3],
        target: &[Angle; 3],
    ) -> Option<([i32; 3], u32)> {
        let errors = [0, 1, 2].map(|i| (pivots[i] - target[i]).units());
        let small = errors.map(|error| error as i32);
        let (mut worst, mut beyond) = (0, 0);
        for i in 0..3 {
            worst = small[i].unsigned_abs().max(worst);
            // Nothing but copies of the sign above 32 bits.
            beyond |= (errors[i] >> 32) as i32 ^ small[i] >> 31;
        }
        // What any rate allows, as a rule; else each is checked by its own rate.
        let least = config.limits.following_error.unsigned_abs();
        if (beyond != 0 || worst > least) && !self.is_following_allowed(config, pivots) {
            return None;
        }
        Some((small, worst))
    }

    /// Whether errors are allowed at these rates.
    #[cold]
    fn is_following_allowed(&mut self, config: &Config, pivots: &[Angle; 3]) -> bool {
        let Some(wanted) = self.next.pivots.clone() else {
            return true;
        };
        // A tick that does not come leaves the setpoint behind the pivots, by what they go in it.
        let late_ticks = self.lateness.div_ceil(LATE_RECOVERY_TICKS) as f32;
        let late_lag = late_ticks / config.limits.rate_hz * UNITS_PER_RAD as f32;
        let pivots = pivots.iter().zip(&wanted.angles);
        for (i, ((&pivot, &target), rate)) in pivots.zip(&wanted.motion.rates).enumerate() {
            let error = (pivot - target).units();
            let lag = config.limits.following_error_per_rate + late_lag;
            let more = (rate.abs() * lag) as i32;
            let most = config.limits.following_error.saturating_add(more);
            if error.unsigned_abs() > u64::from(most.unsigned_abs()) {
                const RAD: f32 = (1.0 / UNITS_PER_RAD) as f32;
                let (value, limit) = (error as f32 * RAD, most as f32 * RAD);
                self.raise_fault(FaultKind::FollowingError, Some(i), value, limit);
                return false;
            }
        }
        true
    }
}
