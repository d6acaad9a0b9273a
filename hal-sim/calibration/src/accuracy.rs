//! What is left of the machine's errors after a fit: from the uncertainty of the numbers to that of commanded poses.

use nalgebra::DMatrix;

use crate::frames::take_out;
use crate::least_squares::Factor;
use crate::position::{position, readings_rad};
use crate::spread::over_disk;
use crate::{MACHINE_NUMBERS, Machine};

/// Poses over disk and orientations that stand for all.
const POSES: usize = 250;
/// Radius of the disk, track radii.
pub const DISK: f64 = 0.8;

/// One standard deviation of commanded poses, with the best frames and scale.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Accuracy {
    /// Root mean square of the place's error over the disk and all orientations, track radii.
    pub place_rms: f64,
    /// Root mean square of theta's error, rad.
    pub turn_rms_rad: f64,
    /// The place's error where it is largest, track radii.
    pub worst_place_rms: f64,
    /// That pose: x, y (track radii), theta (rad).
    pub worst_pose: [f64; 3],
}

impl Accuracy {
    /// From the factor of a fit in which the unknowns have these sizes. `None` where the factor has lost a number.
    #[must_use]
    pub fn new(machine: &Machine, factor: &Factor, sizes: &[f64]) -> Option<Self> {
        let poses: Vec<[f64; 3]> = over_disk(DISK).take(POSES).collect();
        let variances = variances(machine, factor, sizes, &poses)?;
        let (mut place, mut turn, mut worst) = (0.0, 0.0, (0.0, [0.0; 3]));
        for (&pose, [here, turn_here]) in poses.iter().zip(variances) {
            place += here;
            turn += turn_here;
            if here > worst.0 {
                worst = (here, pose);
            }
        }
        let mean = 1.0 / POSES as f64;
        Some(Self {
            place_rms: (place * mean).sqrt(),
            turn_rms_rad: (turn * mean).sqrt(),
            worst_place_rms: worst.0.sqrt(),
            worst_pose: worst.1,
        })
    }
}

/// Variances of commanded poses, with the best frames and scale of all of them: of the place (track radii) and of theta (rad). `None` where the
/// factor has lost a number, or a pose is out of reach.
#[must_use]
pub fn variances(
    machine: &Machine,
    factor: &Factor,
    sizes: &[f64],
    poses: &[[f64; 3]],
) -> Option<Vec<[f64; 2]>> {
    let by_unknowns = by_unknowns(machine, factor.root.ncols(), sizes, poses)?;
    let spread = factor.spread(&by_unknowns.transpose())?;
    let variance = |row: usize| spread.column(row).norm_squared();
    let of_pose = |at: usize| [variance(at) + variance(at + 1), variance(at + 2)];
    Some((0..poses.len()).map(|pose| of_pose(3 * pose)).collect())
}

/// Errors of commanded poses, with the best frames and scale of all of them, by each unknown of a fit in its size: three rows a pose (track
/// radii, rad). `None` where a pose is out of reach.
#[must_use]
pub fn by_unknowns(
    machine: &Machine,
    unknowns: usize,
    sizes: &[f64],
    poses: &[[f64; 3]],
) -> Option<DMatrix<f64>> {
    let mut by_unknowns = DMatrix::zeros(3 * poses.len(), unknowns);
    for (pose, at) in poses.iter().zip((0..).step_by(3)) {
        let readings_rad = readings_rad(machine, pose).ok()?;
        let by_numbers = position(machine, &readings_rad).ok()?.by_numbers;
        for (column, size) in (0..MACHINE_NUMBERS).zip(sizes) {
            let by = by_numbers.column(column) * *size;
            by_unknowns
                .fixed_view_mut::<3, 1>(at, column)
                .copy_from(&by);
        }
    }
    take_out(&mut by_unknowns, poses);
    Some(by_unknowns)
}
