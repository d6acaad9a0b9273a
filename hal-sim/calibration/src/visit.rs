//! One measured pose, and what the model says of it: up to three rows of the least-squares problem.

use kinematics::COEFFICIENTS;
use nalgebra::{Matrix3, Rotation2, SMatrix, Vector2, Vector3};

use crate::kit::{Instrument, Noise};
use crate::position::{OutOfReach, Position, position, readings_rad, within_half_turn};
use crate::{DRAWN, MACHINE_NUMBERS, Machine};

/// What an instrument has seen.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Seen {
    /// x, y (track radii) and theta (rad, any turn).
    Pose([f64; 3]),
    /// x and y of a target, track radii.
    Place([f64; 2]),
    /// theta, rad, any turn.
    Turn(f64),
    /// A mark under a camera, and how far it is off the cross-hair, track radii in the base frame's axes.
    Mark {
        /// Which mark, from 0.
        mark: usize,
        /// Which place of the camera, from 0.
        camera: usize,
        /// The mark's place less the camera's.
        off: [f64; 2],
    },
    /// A pivot at an end of its guide; nothing was measured but that they touch.
    End {
        /// Which of the instrument's ends, from 0.
        end: usize,
    },
}

impl Seen {
    /// The numbers that were measured.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        match self {
            Self::Pose(values) => values,
            Self::Place(values) | Self::Mark { off: values, .. } => values,
            Self::Turn(value) => core::slice::from_ref(value),
            Self::End { .. } => &[],
        }
    }
}

/// One measured pose.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Visit {
    /// Readings of the encoders, rad.
    pub readings_rad: [f64; 3],
    /// What was seen there.
    pub seen: Seen,
}

impl Visit {
    /// What was seen where a controller was sent to a pose (track radii, rad): a visit of the machine as drawn, which goes where it is sent.
    ///
    /// # Errors
    /// [`OutOfReach`]: a pivot does not reach its guide.
    pub fn commanded(pose: &[f64; 3], seen: Seen) -> Result<Self, OutOfReach> {
        let readings_rad = readings_rad(&DRAWN, pose)?;
        Ok(Self { readings_rad, seen })
    }
}

/// What was seen on one visit less what the model says, over the noise, with derivatives of what the model says. In x, y, theta.
#[derive(Clone, Debug)]
pub struct Rows {
    /// Which of the three were seen.
    pub seen: &'static [usize],
    /// Seen less said, in standard deviations.
    pub misses: Vector3<f64>,
    /// Standard deviations: the instrument's, and what the encoders' make of it here; track radii and rad.
    pub noise: Vector3<f64>,
    /// What a rad at every encoder, each for itself, makes of what is said.
    pub by_encoders: Vector3<f64>,
    /// Derivatives of what is said by the machine's numbers, over the noise.
    by_machine: SMatrix<f64, 3, MACHINE_NUMBERS>,
    /// Derivatives by the instrument's unknowns, over the noise: which, and by it.
    by_instrument: Vec<(usize, Vector3<f64>)>,
}

impl Rows {
    /// What the model of a machine and of an instrument's unknowns says of a visit.
    ///
    /// # Errors
    /// [`OutOfReach`]: the model has no pose at these readings.
    pub fn new(
        instrument: &Instrument,
        machine: &Machine,
        unknowns: &[f64],
        visit: &Visit,
    ) -> Result<Self, OutOfReach> {
        let position = position(machine, &visit.readings_rad)?;
        let (said, by_pose, by_instrument) = match visit.seen {
            Seen::Mark { mark, camera, .. } => mark_under_camera(
                &position.pose,
                unknowns,
                instrument.mark_at(mark),
                instrument.camera_at(camera),
            ),
            Seen::End { end } => at_end(
                &position,
                unknowns,
                instrument.guide_of(end),
                instrument.end_at(end),
            ),
            _ => aligned(&position.pose, unknowns),
        };
        let (seen, values): (&[usize], _) = match visit.seen {
            Seen::Pose(values) => (&[0, 1, 2], values),
            Seen::Place([x, y]) | Seen::Mark { off: [x, y], .. } => (&[0, 1], [x, y, said.z]),
            Seen::Turn(theta) => (&[2], [said.x, said.y, theta]),
            Seen::End { .. } => (&[0], [0.0, said.y, said.z]),
        };
        let mut misses = Vector3::from(values) - said;
        misses.z = within_half_turn(misses.z);
        let by_pose = Matrix3::from_columns(&by_pose);
        let mut by_readings = by_pose * position.by_readings;
        if let Seen::End { end } = visit.seen {
            // A pivot that goes on also stands elsewhere on its guide where the platform stays.
            let guide = instrument.guide_of(end);
            let by_zero = position.contacts[guide].rho_by_numbers(&position.rings[guide])[0];
            by_readings[(0, guide)] -= by_zero;
        }
        let by_encoders = Vector3::from_fn(|row, _| by_readings.row(row).norm());
        let noise = instrument_noise(&instrument.noise).zip_map(&by_encoders, |own, by| {
            own.hypot(instrument.noise.encoder_rad * by)
        });
        let scaled = |column: Vector3<f64>| column.component_div(&noise);
        let by_pose = Matrix3::from_columns(&[0, 1, 2].map(|k| scaled(by_pose.column(k).into())));
        let mut by_machine = by_pose * position.by_numbers;
        if let Seen::End { end } = visit.seen {
            // The place on a guide changes with its pivot's numbers also where the platform stays.
            let guide = instrument.guide_of(end);
            let by_numbers = position.contacts[guide].rho_by_numbers(&position.rings[guide]);
            for (by, number) in by_numbers.into_iter().zip(guide * COEFFICIENTS..) {
                by_machine[(0, number)] += by / noise.x;
            }
        }
        Ok(Self {
            seen,
            misses: scaled(misses),
            noise,
            by_encoders,
            by_machine,
            by_instrument: (by_instrument.into_iter())
                .map(|(unknown, column)| (unknown, scaled(column)))
                .collect(),
        })
    }

    /// Derivatives of what is said, over the noise, by all unknowns times their sizes: calls `put` with column and rows for each
    /// column that is not zero.
    pub fn for_columns(&self, sizes: &[f64], mut put: impl FnMut(usize, Vector3<f64>)) {
        for (column, rows) in self.by_machine.column_iter().enumerate() {
            put(column, rows * sizes[column]);
        }
        for &(unknown, rows) in &self.by_instrument {
            let column = MACHINE_NUMBERS + unknown;
            put(column, rows * sizes[column]);
        }
    }
}

/// The instrument's own standard deviations of x, y and theta.
pub(crate) fn instrument_noise(noise: &Noise) -> Vector3<f64> {
    Vector3::new(noise.length, noise.length, noise.angle_rad)
}

/// What is said, its derivatives by the pose, and those by the instrument's unknowns.
type Said = (Vector3<f64>, [Vector3<f64>; 3], Vec<(usize, Vector3<f64>)>);

/// The platform's target in the instrument's axes: `R(-b) (C + R(theta) t - o)` and `theta + tau - b`, with the instrument's origin o
/// and angle b, the target's place t and angle tau.
fn aligned(pose: &[f64; 3], unknowns: &[f64]) -> Said {
    let [x, y, theta] = *pose;
    let list = |i: usize| unknowns.get(i).copied().unwrap_or(0.0);
    let (origin, angle) = (Vector2::new(list(0), list(1)), list(2));
    let (target, target_angle) = (Vector2::new(list(3), list(4)), list(5));
    let back = Rotation2::new(-angle);
    let arm = Rotation2::new(theta) * target;
    let place = back * (Vector2::new(x, y) + arm - origin);
    let said = Vector3::new(place.x, place.y, theta + target_angle - angle);
    let column = |v: Vector2<f64>, turn: f64| Vector3::new(v.x, v.y, turn);
    let axis = |i: usize| Vector2::ith(i, 1.0);
    let by_pose = [
        column(back * axis(0), 0.0),
        column(back * axis(1), 0.0),
        column(back * left_of(arm), 1.0),
    ];
    let turned = Rotation2::new(theta - angle);
    let by_instrument = vec![
        (0, column(-(back * axis(0)), 0.0)),
        (1, column(-(back * axis(1)), 0.0)),
        (2, column(-left_of(place), -1.0)),
        (3, column(turned * axis(0), 0.0)),
        (4, column(turned * axis(1), 0.0)),
        (5, column(Vector2::zeros(), 1.0)),
    ];
    (said, by_pose, by_instrument)
}

/// A mark's place less the camera's: `C + R(theta) q - k`.
fn mark_under_camera(pose: &[f64; 3], unknowns: &[f64], mark: usize, camera: usize) -> Said {
    let [x, y, theta] = *pose;
    let pair = |at: usize| match unknowns.get(at..at + 2) {
        Some(&[x, y]) => Vector2::new(x, y),
        _ => Vector2::zeros(),
    };
    let turn = Rotation2::new(theta);
    let arm = turn * pair(mark);
    let off = Vector2::new(x, y) + arm - pair(camera);
    let column = |v: Vector2<f64>| Vector3::new(v.x, v.y, 0.0);
    let axis = |i: usize| Vector2::ith(i, 1.0);
    let by_pose = [column(axis(0)), column(axis(1)), column(left_of(arm))];
    let by_instrument = vec![
        (camera, column(-axis(0))),
        (camera + 1, column(-axis(1))),
        (mark, column(turn * axis(0))),
        (mark + 1, column(turn * axis(1))),
    ];
    (column(off), by_pose, by_instrument)
}

/// The place on a guide less that of its end.
fn at_end(position: &Position, unknowns: &[f64], guide: usize, end: usize) -> Said {
    let contact = &position.contacts[guide];
    let place = unknowns.get(end).copied().unwrap_or(0.0);
    let first = |value: f64| Vector3::new(value, 0.0, 0.0);
    (
        first(contact.rho - place),
        contact.rho_by_pose().map(first),
        vec![(end, first(-1.0))],
    )
}

/// A quarter turn to the left.
fn left_of(v: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(-v.y, v.x)
}
