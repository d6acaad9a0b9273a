//! Faults that the setpoint shows: out of the disk, or out of a guide's range.

use crate::control::config::Config;
use crate::control::state::State;
use crate::fault::FaultKind;
use crate::motion::Position;
use crate::number::sqrt_f32;

/// By how much the square of the distance (in track radii) may grow on a return into the disk: what rounding does.
const RETURN_TOLERANCE: f32 = 1e-4;

impl State {
    /// Takes the limit from where the servo is switched on: outside the disk that is no fault as long as it goes no
    /// further out.
    pub(in crate::control) fn set_radius_limit_from(&mut self, platform: &Position) {
        self.max_radius_squared = radius_squared(platform) + RETURN_TOLERANCE;
    }

    /// Whether the platform's centre is in its disk, or returning into it.
    #[inline]
    pub(in crate::control) fn is_in_disk(&mut self, config: &Config, platform: &Position) -> bool {
        let now = radius_squared(platform);
        let most = config.limits.max_radius_squared;
        if now <= most {
            self.max_radius_squared = most;
            return true;
        }
        self.is_returning_to_disk(now, most)
    }

    #[cold]
    fn is_returning_to_disk(&mut self, now: f32, most: f32) -> bool {
        if now <= self.max_radius_squared {
            self.max_radius_squared = self.max_radius_squared.min(now + RETURN_TOLERANCE);
            return true;
        }
        let (value, limit) = (sqrt_f32(now), sqrt_f32(most));
        self.raise_fault(FaultKind::WorkspaceLeft, None, value, limit);
        false
    }

    /// Whether a pivot at `rho` along its guide is in that guide's range. Outside the disk it need not be: there the
    /// return into the disk counts.
    #[inline]
    pub(in crate::control) fn is_in_guide_range(
        &mut self,
        config: &Config,
        pivot: usize,
        rho: f32,
    ) -> bool {
        let margin = self.calibrated.margins.guide;
        let [least, most] = config.limits.guide_range;
        let (least, most) = (least - margin, most + margin);
        let within = rho >= least && rho <= most;
        if !within && self.max_radius_squared <= config.limits.max_radius_squared {
            let limit = if rho < least { least } else { most };
            self.raise_fault(FaultKind::GuideRange, Some(pivot), rho, limit);
            return false;
        }
        true
    }
}

/// Square of the distance from the track's centre, track radii.
#[inline]
fn radius_squared(platform: &Position) -> f32 {
    // 2^-24 track radii are fine enough, and half of an i64 is converted in one instruction.
    const RADII: f32 = 1.0 / 16_777_216.0;
    let [x, y] = [platform[0], platform[1]].map(|part| (part >> 8) as i32 as f32 * RADII);
    x * x + y * y
}
