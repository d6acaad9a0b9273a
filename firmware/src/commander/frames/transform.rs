//! Planar transforms: a frame's origin and orientation, seen from another frame.

/// Where a frame lies in another one: its origin, and by how much it is turned.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Transform {
    /// x of the origin, mm.
    pub x_mm: f64,
    /// y of the origin, mm.
    pub y_mm: f64,
    /// Orientation, multi-turn, deg.
    pub w_deg: f64,
}

impl Transform {
    /// A frame that is the other one.
    pub const IDENTITY: Self = Self {
        x_mm: 0.0,
        y_mm: 0.0,
        w_deg: 0.0,
    };

    /// Moved to `point` (mm), not turned.
    pub const fn to(point: [f64; 2]) -> Self {
        Self {
            x_mm: point[0],
            y_mm: point[1],
            w_deg: 0.0,
        }
    }

    /// The origin, mm.
    pub const fn origin(&self) -> [f64; 2] {
        [self.x_mm, self.y_mm]
    }

    /// What lies at `inner` in this frame, seen from where this frame is seen from.
    pub fn then(&self, inner: &Self) -> Self {
        let [x, y] = self.turned(inner.origin());
        Self {
            x_mm: self.x_mm + x,
            y_mm: self.y_mm + y,
            w_deg: self.w_deg + inner.w_deg,
        }
    }

    /// The other frame, seen from this one.
    pub fn inverse(&self) -> Self {
        let back = Self {
            w_deg: -self.w_deg,
            ..Self::IDENTITY
        };
        let [x, y] = back.turned(self.origin());
        Self {
            // Adding 0 turns -0 into 0.
            x_mm: -x + 0.0,
            y_mm: -y + 0.0,
            w_deg: -self.w_deg + 0.0,
        }
    }

    /// A direction in this frame (mm or mm/s), in the axes of the other one.
    pub fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [cos, sin] = cos_sin(self.w_deg);
        [cos * x - sin * y, sin * x + cos * y]
    }
}

/// Cosine and sine, exact at whole quarters of a turn: a frame that is turned by one of them only swaps its axes.
fn cos_sin(deg: f64) -> [f64; 2] {
    match libm::fmod(deg, 360.0) {
        0.0 => [1.0, 0.0],
        90.0 | -270.0 => [0.0, 1.0],
        180.0 | -180.0 => [-1.0, 0.0],
        270.0 | -90.0 => [0.0, -1.0],
        within => {
            let (sin, cos) = libm::sincos(within.to_radians());
            [cos, sin]
        }
    }
}
