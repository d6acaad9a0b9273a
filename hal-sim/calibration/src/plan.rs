//! Poses to measure at, chosen one by one out of many: the next is always the one that adds most to what is known (D-optimal), and what
//! will come out of it is said before anything moves.
//!
//! With the covariance S of the unknowns and the rows J of a candidate, over the noise, that is the largest `det(1 + J S J^T)`; after it
//! `S -= S J^T (1 + J S J^T)^-1 J S`. S itself is never made: `J S` is kept for every candidate.

use core::f64::consts::TAU;

use kinematics::{Pose, inverse};
use nalgebra::{DMatrix, Matrix3};

use crate::DRAWN;
use crate::accuracy::{Accuracy, DISK};
use crate::descent::{put_rows, put_scale};
use crate::freedom::Freedoms;
use crate::kit::{Instrument, Kit};
use crate::least_squares::{Factor, Problem};
use crate::model::GUIDES_RAD;
use crate::position::readings_rad;
use crate::spread::{in_cube, over_disk};
use crate::visit::{Rows, Seen, Visit};

/// Candidates, but at least twice as many as are chosen.
const CANDIDATES: usize = 700;

/// What is to be done at a pose.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum At {
    /// Read the instrument there.
    Pose,
    /// Bring a mark under a place of the camera.
    Mark {
        /// Which mark, from 0.
        mark: usize,
        /// Which place of the camera, from 0.
        camera: usize,
    },
    /// Drive a pivot against an end of its guide.
    End {
        /// Which of the instrument's ends, from 0.
        end: usize,
    },
}

/// Guides end outside the disk: there carriages are still 20.7 deg apart.
const TOUCHING_DISK: f64 = 0.88;
/// So far the other guides keep from their ends, track radii.
pub(crate) const CLEAR_OF_ENDS: core::ops::Range<f64> = 0.18..1.82;

/// So far from the disk's rim a mark is looked for: it is not where it was drawn, nor is the camera, and the stage follows.
const FOUND_WITHIN: f64 = 0.015;

/// One pose to go to.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Stop {
    /// x, y (track radii), theta (rad).
    pub pose: [f64; 3],
    /// What is to be done there.
    pub at: At,
}

/// What to measure, and what will come out.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The poses, the most telling first.
    pub stops: Vec<Stop>,
    /// What will be left of the machine's errors.
    pub accuracy: Accuracy,
    /// What the instrument cannot tell, however many poses there are.
    pub freedoms: Freedoms,
    /// How many numbers the measurement will say less of than what is known before.
    pub held_by_priors: usize,
}

/// Chooses poses for an instrument. `None` if the numbers of the instrument are not finite.
#[must_use]
pub fn plan(instrument: &Instrument, poses: usize) -> Option<Plan> {
    let sizes = instrument.sizes();
    let all: Vec<(Stop, Rows)> = (stops(instrument, 0, CANDIDATES.max(2 * poses)).into_iter())
        .filter_map(|stop| Some((stop, rows(instrument, &stop)?)))
        .collect();
    let candidates: Vec<&Rows> = all.iter().map(|(_, rows)| rows).collect();
    let chosen = choose(&candidates, &sizes, poses);
    let factor = factor(instrument, chosen.iter().map(|&at| candidates[at]), &sizes);
    let rows: Vec<Rows> = all.iter().map(|(_, rows)| rows.clone()).collect();
    // With a prior of 1 beside it, a singular value of the data below 1 comes out below the root of 2.
    let values = factor.root.singular_values();
    Some(Plan {
        stops: chosen.iter().map(|&at| all[at].0).collect(),
        accuracy: Accuracy::new(&DRAWN, &factor, &sizes)?,
        freedoms: Freedoms::new(instrument, &rows, &sizes),
        held_by_priors: values.iter().filter(|&&value| value * value < 2.0).count(),
    })
}

/// Poses all over the disk, for cameras such as bring a mark under it, for gauges a ball between them, for ends such as touch one; from this one of an endless sequence on.
#[must_use]
pub fn stops(instrument: &Instrument, first: usize, count: usize) -> Vec<Stop> {
    // Half of all marks and orientations bring the platform out of the disk: so many tries are plenty.
    let tries = (first..first + 20 * count).map(in_cube);
    match instrument.kit {
        Kit::Xyt | Kit::Xy | Kit::Theta => (over_disk(DISK).skip(first).take(count))
            .map(|pose| Stop { pose, at: At::Pose })
            .collect(),
        Kit::Camera | Kit::Camera2 | Kit::Balls => (tries
            .filter_map(|share| under_camera(instrument, share)))
        .take(count)
        .collect(),
        Kit::Ends => (tries.filter_map(|share| against_end(instrument, share)))
            .take(count)
            .collect(),
    }
}

/// A share of a list's length as a place in it.
fn pick(share: f64, count: usize) -> usize {
    ((share * count as f64) as usize).min(count.saturating_sub(1))
}

/// A mark under a place of the camera, inside the disk.
fn under_camera(instrument: &Instrument, [mark, camera, turn]: [f64; 3]) -> Option<Stop> {
    let mark = pick(mark, instrument.marks.len());
    let camera = pick(camera, instrument.cameras.len());
    let theta = (turn - 0.5) * TAU;
    let (sin, cos) = theta.sin_cos();
    let [x, y] = *instrument.marks.get(mark)?;
    let [camera_x, camera_y] = *instrument.cameras.get(camera)?;
    let pose = [
        camera_x - (cos * x - sin * y),
        camera_y - (sin * x + cos * y),
        theta,
    ];
    let at = At::Mark { mark, camera };
    (pose[0].hypot(pose[1]) < DISK - FOUND_WITHIN).then_some(Stop { pose, at })
}

/// A pivot at an end of its guide and the others not: `C = P - rho u`, and the guide stands at an angle to the pivot's radius that
/// leaves C in the disk that is touched from, `|C|^2 = 1 + rho^2 - 2 rho cos(angle)`.
fn against_end(instrument: &Instrument, [end, lean, turn]: [f64; 3]) -> Option<Stop> {
    let end = pick(end, instrument.ends.len());
    let &(guide, rho) = instrument.ends.get(end)?;
    let theta = (turn - 0.5) * TAU;
    let direction = theta + GUIDES_RAD.get(guide)?;
    let (sin, cos) = direction.sin_cos();
    let most_lean_rad = ((1.0 + rho * rho - TOUCHING_DISK.powi(2)) / (2.0 * rho)).acos();
    let (ring_sin, ring_cos) = (direction + (2.0 * lean - 1.0) * most_lean_rad).sin_cos();
    let pose = [ring_cos - rho * cos, ring_sin - rho * sin, theta];
    let [x, y, _] = pose;
    let drawn = inverse::<f64>(&Pose { x, y, theta }).ok()?;
    let others = drawn.guides.iter().enumerate();
    let is_clear = (others.filter(|&(other, _)| other != guide))
        .all(|(_, other)| CLEAR_OF_ENDS.contains(&other.rho()));
    let at = At::End { end };
    (x.hypot(y) < TOUCHING_DISK && is_clear).then_some(Stop { pose, at })
}

/// Rows of a stop on the machine as drawn.
fn rows(instrument: &Instrument, stop: &Stop) -> Option<Rows> {
    let seen = match (stop.at, instrument.kit) {
        (At::Mark { mark, camera }, _) => Seen::Mark {
            mark,
            camera,
            off: [0.0; 2],
        },
        (At::End { end }, _) => Seen::End { end },
        (At::Pose, Kit::Xy) => Seen::Place([0.0; 2]),
        (At::Pose, Kit::Theta) => Seen::Turn(0.0),
        (At::Pose, _) => Seen::Pose(stop.pose),
    };
    let visit = Visit {
        readings_rad: readings_rad(&DRAWN, &stop.pose).ok()?,
        seen,
    };
    Rows::new(instrument, &DRAWN, &instrument.guess(), &visit).ok()
}

/// The factor of chosen rows with what is known before.
fn factor<'a>(
    instrument: &Instrument,
    rows: impl Iterator<Item = &'a Rows>,
    sizes: &[f64],
) -> Factor {
    let mut problem = Problem::new(&nalgebra::DVector::zeros(sizes.len()));
    for rows in rows {
        put_rows(&mut problem, rows, sizes, 1.0);
    }
    put_scale(&mut problem, instrument, &instrument.guess(), sizes);
    problem.factor()
}

/// Places in the list of the best candidates, the best first.
fn choose(candidates: &[&Rows], sizes: &[f64], count: usize) -> Vec<usize> {
    // Three columns a candidate: its rows J, and J S.
    let mut derivatives = DMatrix::zeros(sizes.len(), 3 * candidates.len());
    for (at, rows) in candidates.iter().enumerate() {
        for &row in rows.seen {
            rows.for_columns(sizes, |unknown, values| {
                derivatives[(unknown, 3 * at + row)] = values[row];
            });
        }
    }
    let mut weighed = derivatives.clone();
    let mut gains: Vec<Matrix3<f64>> = (0..candidates.len())
        .map(|at| {
            let rows = derivatives.fixed_columns::<3>(3 * at);
            Matrix3::identity() + rows.tr_mul(&rows)
        })
        .collect();
    let mut chosen: Vec<usize> = Vec::new();
    let mut is_free = vec![true; candidates.len()];
    while chosen.len() < count {
        let free = (0..candidates.len()).filter(|&at| is_free[at]);
        let best =
            free.max_by(|&a, &b| f64::total_cmp(&gains[a].determinant(), &gains[b].determinant()));
        let Some(best) = best else { break };
        let Some(inverse) = gains[best].try_inverse() else {
            break;
        };
        is_free[best] = false;
        chosen.push(best);
        let taken = weighed.fixed_columns::<3>(3 * best).into_owned();
        let shared = derivatives.fixed_columns::<3>(3 * best).tr_mul(&weighed);
        for (at, gain) in gains.iter_mut().enumerate() {
            let here = shared.fixed_columns::<3>(3 * at);
            *gain -= here.tr_mul(&(inverse * here));
        }
        weighed.gemm(-1.0, &taken, &(inverse * shared), 1.0);
    }
    chosen
}
