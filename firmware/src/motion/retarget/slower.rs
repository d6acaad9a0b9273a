//! By how much speeds and accelerations of a transition are lower than their limits, and why.

use crate::motion::check::Violation;
use crate::number::sqrt_f32;

/// Parts of the limits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slower {
    /// Speed of translation.
    pub path: f32,
    /// Speed of all.
    pub speed: f32,
    /// Acceleration of all.
    pub force: f32,
}

impl Slower {
    /// Everything as fast as allowed.
    pub const NOT: Self = Self {
        path: 1.0,
        speed: 1.0,
        force: 1.0,
    };

    /// By what was broken, and a little for what changes with it.
    pub fn by(&mut self, broken: &Violation) {
        const MORE: f32 = 0.97;
        match broken {
            Violation::Speed(over) => self.path *= MORE / over,
            Violation::Acceleration(over) => self.force *= MORE / over,
            Violation::PivotRate(over) => self.speed *= MORE / over,
            Violation::PivotAcceleration(over) => {
                self.force *= MORE / over;
                self.speed *= sqrt_f32(MORE / over);
            }
            Violation::Workspace | Violation::NoRoomToStop | Violation::Unchecked => {}
        }
    }
}
