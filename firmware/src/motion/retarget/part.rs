//! What a line moves: translation and rotation, planned apart or as one.

use crate::motion::speeds::Speeds;

/// Translation, rotation, or both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Part {
    Translation,
    Rotation,
    Whole,
}

impl Part {
    /// Whether the sizes of a sum of two vectors are within a limit.
    #[inline]
    pub fn is_within(self, a: &[f32; 3], way: &[f32; 3], rate: f32, limit: &Speeds) -> bool {
        let [x, y, theta] = [0, 1, 2].map(|i| a[i] + way[i] * rate);
        let translation = x * x + y * y <= limit.linear * limit.linear;
        let rotation = theta.abs() <= limit.angular;
        match self {
            Self::Translation => translation,
            Self::Rotation => rotation,
            Self::Whole => translation && rotation,
        }
    }

    /// One vector in what is of this part, the other in what is not.
    pub fn select<T>(
        self,
        [x, y, theta]: [T; 3],
        [other_x, other_y, other_theta]: [T; 3],
    ) -> [T; 3] {
        match self {
            Self::Translation => [x, y, other_theta],
            Self::Rotation => [other_x, other_y, theta],
            Self::Whole => [x, y, theta],
        }
    }
}
