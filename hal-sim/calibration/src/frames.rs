//! Errors of poses without what only the choice of frames and of scale makes: those are the user's to choose.
//!
//! A machine whose base is turned and moved, whose platform frame is another, and which is larger by a share, brings the pose (C, theta)
//! to `b + (1 + s) R(beta) (C + R(theta) t)` and `theta + beta + tau`. theta's mean error is tau's, so beta shows in places alone.

use nalgebra::{DMatrix, Matrix2x6, Rotation2, SVector, Vector2};

use crate::position::within_half_turn;

/// One error of a pose: what was asked for and where the machine went.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Pair {
    /// x, y (track radii), theta (rad).
    pub asked: [f64; 3],
    /// The same.
    pub reached: [f64; 3],
}

/// Errors of many poses with the best frames and scale.
#[derive(Clone, Debug)]
pub struct Left {
    /// Errors of the places, track radii.
    pub places: Vec<Vector2<f64>>,
    /// Errors of theta, rad.
    pub turns_rad: Vec<f64>,
}

/// Sizes of such errors.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Size {
    /// Root mean square of the places' errors' lengths, track radii.
    pub place_rms: f64,
    /// The longest.
    pub place_max: f64,
    /// Root mean square of theta's errors, rad.
    pub turn_rms_rad: f64,
}

impl Left {
    /// Their sizes.
    #[must_use]
    pub fn size(&self) -> Size {
        let squares = || self.places.iter().map(Vector2::norm_squared);
        let turns = self.turns_rad.iter().map(|turn| turn * turn);
        let count = self.places.len() as f64;
        Size {
            place_rms: (squares().sum::<f64>() / count).sqrt(),
            place_max: squares().fold(0.0, f64::max).sqrt(),
            turn_rms_rad: (turns.sum::<f64>() / count).sqrt(),
        }
    }
}

/// Derivatives of a place by b, beta, t and s, at frames that are all 0.
fn by_frames(pose: &[f64; 3]) -> Matrix2x6<f64> {
    let [x, y, theta] = *pose;
    let (sin, cos) = theta.sin_cos();
    Matrix2x6::new(
        1.0, 0.0, -y, cos, -sin, x, //
        0.0, 1.0, x, sin, cos, y,
    )
}

/// Takes the best frames and scale out of errors of any size.
#[must_use]
pub fn without_frames(pairs: &[Pair]) -> Left {
    // The slopes are those at frames of 0, so each step leaves the share that the frames are off: 2e-2 to the last bit.
    const STEPS: usize = 10;
    let turns: Vec<f64> = (pairs.iter())
        .map(|pair| within_half_turn(pair.reached[2] - pair.asked[2]))
        .collect();
    let mean = turns.iter().sum::<f64>() / turns.len() as f64;
    let mut frames = SVector::<f64, 6>::zeros();
    let mut places = Vec::new();
    for _ in 0..STEPS {
        places = (pairs.iter())
            .map(|pair| Vector2::new(pair.reached[0], pair.reached[1]) - moved(&frames, pair))
            .collect();
        let (mut square, mut right) = (nalgebra::SMatrix::<f64, 6, 6>::zeros(), SVector::zeros());
        for (pair, place) in pairs.iter().zip(&places) {
            let by = by_frames(&pair.asked);
            square += by.transpose() * by;
            right += by.transpose() * place;
        }
        // Poses of one orientation do not tell b from t: the shortest step then.
        let least = 1e-9 * pairs.len() as f64;
        frames += (square.pseudo_inverse(least)).map_or_else(|_| SVector::zeros(), |by| by * right);
    }
    Left {
        places,
        turns_rad: turns.iter().map(|turn| turn - mean).collect(),
    }
}

/// Where frames and scale bring a pose.
fn moved(frames: &SVector<f64, 6>, pair: &Pair) -> Vector2<f64> {
    let [x, y, theta] = pair.asked;
    let base = Vector2::new(frames[0], frames[1]);
    let target = Rotation2::new(theta) * Vector2::new(frames[3], frames[4]);
    base + (1.0 + frames[5]) * (Rotation2::new(frames[2]) * (Vector2::new(x, y) + target))
}

/// Takes frames and scale out of every column of small errors of poses, three rows (x, y, theta) a pose.
pub fn take_out(errors: &mut DMatrix<f64>, poses: &[[f64; 3]]) {
    let mut basis = DMatrix::zeros(errors.nrows(), 7);
    for (pose, at) in poses.iter().zip((0..).step_by(3)) {
        basis
            .fixed_view_mut::<2, 6>(at, 0)
            .copy_from(&by_frames(pose));
        basis[(at + 2, 6)] = 1.0;
    }
    let directions = basis.qr().q();
    let shares = directions.tr_mul(errors);
    errors.gemm(-1.0, &directions, &shares, 1.0);
}
