//! Encoder angles of a pose and the pose of encoder angles, on a machine of given numbers, by Newton's method on [`crate::model`].

use core::f64::consts::TAU;

use kinematics::direct;
use nalgebra::{Matrix3, SMatrix, Vector3};

use crate::model::{Contact, GUIDES_RAD, Ring};
use crate::{MACHINE_NUMBERS, Machine};

/// Newton's steps: from a drawn machine's answer, some 1e-3 off, three reach the last bits.
const MAX_STEPS: usize = 20;
/// The last step, over the size of the angle: what rounding leaves.
const SMALL_STEP: f64 = 1e-14;
/// A pivot that leaves its guide so little for its ring's angle has no grip on it.
const LEAST_GRIP: f64 = 0.05;

/// No pose has these encoder angles, or no encoder angles that pose.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("a pivot cannot be on its guide there")]
pub struct OutOfReach;

/// A pose, and how it moves.
#[derive(Clone, Copy, Debug)]
pub struct Position {
    /// x, y (track radii), theta (rad, multi-turn).
    pub pose: [f64; 3],
    /// Derivatives by the machine's numbers at given encoder angles.
    pub by_numbers: SMatrix<f64, 3, MACHINE_NUMBERS>,
    /// Derivatives by the encoder angles.
    pub by_readings: Matrix3<f64>,
    /// The rings, and the pivots against their guides.
    pub rings: [Ring; 3],
    /// See `rings`.
    pub contacts: [Contact; 3],
}

/// Encoder angles, rad, multi-turn with theta, that bring a machine to a pose.
///
/// # Errors
/// [`OutOfReach`]: a pivot does not reach its guide.
pub fn readings_rad(machine: &Machine, pose: &[f64; 3]) -> Result<[f64; 3], OutOfReach> {
    let mut readings_rad = [0.0; 3];
    for (guide, (reading_rad, pivot)) in readings_rad.iter_mut().zip(machine).enumerate() {
        // With the pivot straight out on its guide, Newton's steps cannot pass over to the other side of the track.
        let mut ring = Ring::at(pivot, pose[2] + GUIDES_RAD[guide]);
        let mut is_there = false;
        for _ in 0..MAX_STEPS {
            let contact = Contact::new(guide, pivot, &ring, pose);
            let grip = contact.by_angle(&ring);
            if !(grip > LEAST_GRIP) {
                return Err(OutOfReach);
            }
            let step_rad = -contact.gap / grip;
            ring = Ring::at(pivot, ring.angle_rad + step_rad);
            if step_rad.abs() <= SMALL_STEP * (1.0 + ring.angle_rad.abs()) {
                is_there = true;
                break;
            }
        }
        if !is_there {
            return Err(OutOfReach);
        }
        *reading_rad = ring.reading_rad(pivot);
    }
    Ok(readings_rad)
}

/// The pose that a machine takes at encoder angles, rad.
///
/// # Errors
/// [`OutOfReach`]: there is none near that of the machine as drawn.
pub fn pose(machine: &Machine, readings_rad: &[f64; 3]) -> Result<[f64; 3], OutOfReach> {
    Ok(solve(machine, readings_rad)?.0)
}

/// The pose that a machine takes at encoder angles, rad, with derivatives.
///
/// # Errors
/// As [`pose`].
pub fn position(machine: &Machine, readings_rad: &[f64; 3]) -> Result<Position, OutOfReach> {
    let (pose, rings, contacts, by_gaps) = solve(machine, readings_rad)?;
    let mut by_numbers = SMatrix::<f64, 3, MACHINE_NUMBERS>::zeros();
    let mut by_readings = Matrix3::zeros();
    for (guide, (contact, ring)) in contacts.iter().zip(&rings).enumerate() {
        let by_gap = by_gaps.column(guide);
        for (number, gap) in contact.by_numbers(ring).into_iter().enumerate() {
            let column = guide * kinematics::COEFFICIENTS + number;
            by_numbers.set_column(column, &(by_gap * -gap));
        }
        by_readings.set_column(guide, &(by_gap * -contact.by_reading(ring)));
    }
    Ok(Position {
        pose,
        by_numbers,
        by_readings,
        rings,
        contacts,
    })
}

type Solved = ([f64; 3], [Ring; 3], [Contact; 3], Matrix3<f64>);

/// The pose with rings and contacts there, and its derivatives by the gaps.
fn solve(machine: &Machine, readings_rad: &[f64; 3]) -> Result<Solved, OutOfReach> {
    let rings = [0, 1, 2].map(|i| Ring::read(&machine[i], readings_rad[i]));
    let start = direct::<f64>(&rings.map(|ring| ring.angle_rad)).map_err(|_| OutOfReach)?;
    let mut pose = Vector3::new(start.x, start.y, start.theta);
    for _ in 0..MAX_STEPS {
        let here = pose.into();
        let contacts = [0, 1, 2].map(|i| Contact::new(i, &machine[i], &rings[i], &here));
        let by_pose = contacts.map(|contact| contact.by_pose().into());
        let by_gaps = Matrix3::from_columns(&by_pose)
            .transpose()
            .try_inverse()
            .ok_or(OutOfReach)?;
        let step = by_gaps * Vector3::from(contacts.map(|contact| contact.gap));
        pose -= step;
        if !pose.iter().all(|number| number.is_finite()) {
            return Err(OutOfReach);
        }
        if step.amax() <= SMALL_STEP * (1.0 + pose.amax()) {
            return Ok((pose.into(), rings, contacts, by_gaps));
        }
    }
    Err(OutOfReach)
}

/// An angle less its whole turns.
pub(crate) fn within_half_turn(angle_rad: f64) -> f64 {
    angle_rad - TAU * (angle_rad / TAU).round()
}
