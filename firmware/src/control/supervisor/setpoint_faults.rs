//! Faults that the setpoint shows: out of the disk, or out of a guide's range.

use crate::control::State;
use crate::control::config::Config;
use crate::fault::FaultKind;
use crate::motion::Position;
use crate::number::sqrt_f32;

/// By how much a way back into the disk may go out again: what rounding does.
const BACK: f32 = 1e-4;

impl State {
    /// Notes where the servo is switched on: outside the disk that is no fault as long as it goes no further out.
    pub(in crate::control) fn start_at(&mut self, platform: &Position) {
        self.reach_square = square(platform) + BACK;
    }

    /// Whether the platform's centre is in its disk, or on its way back into it.
    #[inline]
    pub(in crate::control) fn is_in_disk(&mut self, config: &Config, platform: &Position) -> bool {
        let now = square(platform);
        let most = config.limits.reach_square;
        if now <= most {
            self.reach_square = most;
            return true;
        }
        self.is_on_way_back(now, most)
    }

    #[cold]
    fn is_on_way_back(&mut self, now: f32, most: f32) -> bool {
        if now <= self.reach_square {
            self.reach_square = self.reach_square.min(now + BACK);
            return true;
        }
        let (value, limit) = (sqrt_f32(now), sqrt_f32(most));
        self.fail(FaultKind::WorkspaceLeft, None, value, limit);
        false
    }

    /// Whether a pivot at `rho` along its guide is in that guide's range. Outside the disk it need not be: there the way back counts.
    #[inline]
    pub(in crate::control) fn is_in_range(
        &mut self,
        config: &Config,
        pivot: usize,
        rho: f32,
    ) -> bool {
        let [least, most] = config.limits.guide;
        let within = rho >= least && rho <= most;
        if !within && self.reach_square <= config.limits.reach_square {
            let limit = if rho < least { least } else { most };
            self.fail(FaultKind::GuideRange, Some(pivot), rho, limit);
            return false;
        }
        true
    }
}

/// Square of the distance from the track's centre, track radii.
#[inline]
fn square(platform: &Position) -> f32 {
    // 2^-24 track radii are fine enough, and half of an i64 is converted in one instruction.
    const RADII: f32 = 1.0 / 16_777_216.0;
    let [x, y] = [platform[0], platform[1]].map(|part| (part >> 8) as i32 as f32 * RADII);
    x * x + y * y
}
