//! Translation and rotation, which are planned apart.

use crate::motion::speeds::Speeds;

/// Translation or rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Part {
    Translation,
    Rotation,
}

impl Part {
    /// The sizes of a sum of two vectors are within a limit.
    #[inline]
    pub fn is_within(self, a: &[f32; 3], way: &[f32; 3], rate: f32, limit: &Speeds) -> bool {
        match self {
            Self::Translation => {
                let (x, y) = (a[0] + way[0] * rate, a[1] + way[1] * rate);
                x * x + y * y <= limit.linear * limit.linear
            }
            Self::Rotation => (a[2] + way[2] * rate).abs() <= limit.angular,
        }
    }

    /// Of a way, what is of this part.
    pub fn only(self, [x, y, theta]: [f32; 3]) -> [f32; 3] {
        match self {
            Self::Translation => [x, y, 0.0],
            Self::Rotation => [0.0, 0.0, theta],
        }
    }
}
