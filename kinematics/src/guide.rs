//! One linear guide as the pose sets it: what position, rates and Jacobian share.

use core::ops::Sub;

/// A guide's line relative to the track. Lengths are in track radii.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub struct Guide<T> {
    /// cos theta_i of the guide's outward direction.
    pub cos: T,
    /// sin theta_i of the guide's outward direction.
    pub sin: T,
    /// d_i: signed distance from the track's centre to the guide's line, equal to sin(phi_i - theta_i).
    pub offset: T,
    /// c_i = cos(phi_i - theta_i) = sqrt(1 - d_i^2), positive.
    pub cosine: T,
    /// q_i: projection of the platform's centre on the guide's direction.
    pub projection: T,
}

impl<T: Copy + Sub<Output = T>> Guide<T> {
    /// rho_i: distance from the platform's centre to the pivot along the guide; positive while the centre is inside
    /// the track.
    pub fn rho(&self) -> T {
        self.cosine - self.projection
    }
}

impl<T> Guide<T> {
    /// The same guide in another number type: positions may be solved in one type and rates in another.
    pub fn map<U>(self, cast: impl Fn(T) -> U) -> Guide<U> {
        Guide {
            cos: cast(self.cos),
            sin: cast(self.sin),
            offset: cast(self.offset),
            cosine: cast(self.cosine),
            projection: cast(self.projection),
        }
    }
}
