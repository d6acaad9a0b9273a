//! What is carried, from the torques of the rings over a tour.
//!
//! Along the tour every ring's torque is linear in what is sought:
//!
//! ```text
//! T (1 - g) = J p'' + Jm A (sin(n p + a))'' + Tc z + b p' + T0 + J^-T (M q'' + forces of the turning moment + (F z_rho + d z_rho' + c rho') drho/dq + k q)
//! ```
//!
//! g is how much more a torque is than it is told, beside the mean of all three: of current sensors and motor constants. A mean that is free would make all
//! torques nothing; a ring that all others are told beside would have what is left over made small at theirs. A is what an uneven gear moves its motor by, of
//! inertia Jm, n times a turn.
//!
//! z are the contacts that rub, -1 to 1. Instants at which a ring stands or creeps do not count: there friction is none of these. Of rings z is the sign of the
//! rate, then; of carriages, which turn back while all rings go on, it is that but for a way of presliding after each reversal (Dahl's). A sign alone would be
//! early there, and what it is early by is like an inertia. What a contact damps while it builds up, d, is early as well, and makes up for a presliding that
//! is not as it was told (LuGre's model: Canudas de Wit, Olsson, Astrom and Lischinsky, "A New Model for Control of Systems with Friction", 1995, equation 3).
//!
//! M is made of mass, inertia and first moment of platform and payload; F and c are the friction along the guides, k the cables' stiffness, p the ring angles,
//! q the pose. Angles give the pose by the direct kinematics ([`kinematics::direct()`]); all signals are smoothed alike before anything is
//! derived, so that what smoothing takes from one side it takes from the other.
//!
//! In the middle of the disk the inertia of the rings and that of what they carry cannot be told apart; a tour has to go out.

use kinematics::{Pose, Twist, direct, inverse, jacobian, jacobian_inverse};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use std::f64::consts::TAU;

/// A tour as it was recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Tour {
    /// Between samples, s.
    pub step_s: f64,
    /// Angles of the pivots with their zeros set, rad.
    pub angle_rad: [Vec<f64>; 3],
    /// Torques of the motors at the rings, N m: current times motor constant.
    pub torque_n_m: [Vec<f64>; 3],
}

/// How a tour is evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaluation {
    /// Track radius, m.
    pub track_radius_m: f64,
    /// Length of the window with which all signals are smoothed, s.
    pub smoothing_s: f64,
    /// Turns of a motor in a turn of its ring.
    pub gear_ratio: f64,
    /// Presliding of carriages on their guides, track radii.
    pub presliding: f64,
}

/// What is carried, as found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Platform {
    /// Mass of platform and payload, kg.
    pub mass_kg: f64,
    /// Their inertia about the platform's centre, kg m^2.
    pub inertia_kg_m2: f64,
    /// Mass times its centre, along the platform's axes, kg m.
    pub moment_kg_m: [f64; 2],
    /// A motor and its ring, kg m^2.
    pub drive_inertia: f64,
    /// Friction of a ring with its motor, N m and N m s/rad: mean of the three.
    pub friction: [f64; 2],
    /// Friction of the carriages along their guides.
    pub carriages: Carriages,
    /// Standard deviations of mass, inertia, moments and drive inertia, in units of theirs.
    pub deviations: [f64; 5],
    /// What is left of the torques, over them.
    pub residual: f64,
    /// Condition of the equations, every unknown counted in its own size: what noise and what the model leaves out may grow by.
    pub condition: f64,
}

/// Friction of a carriage along its guide, the mean of three.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Carriages {
    /// Coulomb's, N.
    pub coulomb_n: f64,
    /// Its standard deviation, N.
    pub deviation_n: f64,
    /// What grows with the rate, N s/m.
    pub viscous_n_s_m: f64,
}

/// Why nothing follows from a tour.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PlatformError {
    /// Signals of different lengths, or fewer than a window.
    #[error(
        "the tour's angles and torques are not as long as each other, or shorter than a few windows of smoothing"
    )]
    Lengths,
    /// No pose.
    #[error(
        "the angles at sample {sample} are none of the mechanism: set the encoders' zeros first"
    )]
    NoPose {
        /// Which.
        sample: usize,
    },
    /// A tour that does not show it.
    #[error(
        "condition {condition:.0}: the tour does not tell the unknowns apart; go further out and shake along x, y and theta by turns"
    )]
    Condition {
        /// As computed.
        condition: f64,
    },
    /// A torque that is not what it is told.
    #[error(
        "the torque of pivot {pivot} is {percent} % off what it is told, beside the mean of all"
    )]
    Gain {
        /// Counted from 1.
        pivot: usize,
        /// Of the torque.
        percent: i32,
    },
    /// Torques of something else.
    #[error(
        "{percent} % of the torques are left over: wrong zeros, wrong motor constants, or something rubs"
    )]
    Residual {
        /// Of the torques.
        percent: u32,
    },
}

/// A larger condition is refused.
pub const MOST_CONDITION: f64 = 100.0;
/// More that is left is refused.
pub const MOST_RESIDUAL: f64 = 0.25;
/// A torque that is more off what it is told is refused: current sensors are within some percent.
pub const MOST_GAIN: f64 = 0.1;
const UNKNOWNS: usize = 26;
/// Inertia of a motor and its ring.
const DRIVE: usize = 4;
/// Friction along a guide times the track's radius: N m, and N m s.
const GUIDE: usize = 11;
const GUIDE_VISCOUS: usize = 16;
/// How much more the torques are than they are told: cosine and sine parts over the three.
const GAINS: usize = 17;
/// The first of the uneven gears': cosine and sine of the first ring's, then of the next.
const GEARS: usize = 19;
/// What a contact of a carriage damps while it builds up, N m s.
const CONTACT_DAMPING: usize = 25;

/// What is carried, by linear least squares: of one tour, or of several with the same load.
///
/// # Errors
/// [`PlatformError`].
pub fn platform(tours: &[Tour], how: &Evaluation) -> Result<Platform, PlatformError> {
    let fit = fit(tours, how)?;
    if !(fit.condition <= MOST_CONDITION) {
        return Err(PlatformError::Condition {
            condition: fit.condition,
        });
    }
    let residual = (fit.left.norm_squared() / fit.torques_squared).sqrt();
    if !(residual <= MOST_RESIDUAL) {
        return Err(PlatformError::Residual {
            percent: (100.0 * residual) as u32,
        });
    }
    let (numbers, deviations, radius) = (fit.numbers, fit.deviations, how.track_radius_m);
    let gains = of_three([numbers[GAINS], numbers[GAINS + 1]]);
    if let Some(pivot) = gains.iter().position(|gain| !(gain.abs() <= MOST_GAIN)) {
        return Err(PlatformError::Gain {
            pivot: pivot + 1,
            percent: (100.0 * gains[pivot]) as i32,
        });
    }
    Ok(Platform {
        mass_kg: numbers[0] / (radius * radius),
        inertia_kg_m2: numbers[1],
        moment_kg_m: [numbers[2] / radius, numbers[3] / radius],
        drive_inertia: numbers[DRIVE],
        friction: [
            numbers[5..8].iter().sum::<f64>() / 3.0,
            numbers[8..11].iter().sum::<f64>() / 3.0,
        ],
        carriages: Carriages {
            coulomb_n: numbers[GUIDE] / radius,
            deviation_n: deviations[GUIDE] / radius,
            viscous_n_s_m: numbers[GUIDE_VISCOUS] / (radius * radius),
        },
        deviations: [
            deviations[0] / (radius * radius),
            deviations[1],
            deviations[2] / radius,
            deviations[3] / radius,
            deviations[DRIVE],
        ],
        residual,
        condition: fit.condition,
    })
}

/// Two numbers for three pivots, whose mean is 0.
pub(crate) fn of_three([cosine, sine]: [f64; 2]) -> [f64; 3] {
    [0.0, 1.0, 2.0].map(|pivot| {
        let (sin, cos) = (pivot * TAU / 3.0).sin_cos();
        cosine * cos + sine * sin
    })
}

/// The solution of the linear equations.
pub(crate) struct Fit {
    numbers: [f64; UNKNOWNS],
    deviations: [f64; UNKNOWNS],
    /// Torques that are left over, N m: of all rings at an instant, then of the next.
    pub left: DVector<f64>,
    /// Sum of the squares of the torques.
    torques_squared: f64,
    condition: f64,
}

/// Every ring turns as fast where friction is Coulomb's and viscous: below it sticks, creeps and breaks away. Rings of the reference stage slide from 0.005 on.
const LEAST_RATE_RAD_S: f64 = 0.3;
/// Rows that err as much as one that errs by itself: neighbours are smoothed with the same window.
const ALIKE: f64 = 4.0;

/// Of one tour, or of several with the same load.
pub(crate) fn fit(tours: &[Tour], how: &Evaluation) -> Result<Fit, PlatformError> {
    let (mut rows, mut right) = (Vec::new(), Vec::new());
    for tour in tours {
        add_rows(tour, how, &mut rows, &mut right)?;
    }
    let right = DVector::from_vec(right);
    let matrix = DMatrix::from_fn(rows.len(), UNKNOWNS, |row, k| rows[row][k]);
    let sizes: Vec<f64> = matrix
        .column_iter()
        .map(|column| column.norm().max(1e-12))
        .collect();
    let scaled = DMatrix::from_fn(matrix.nrows(), UNKNOWNS, |row, k| {
        matrix[(row, k)] / sizes[k]
    });
    let normal = scaled.tr_mul(&scaled);
    let eigen = normal.symmetric_eigenvalues();
    let condition = (eigen.max() / eigen.min().max(1e-300)).sqrt();
    let inverse = normal
        .try_inverse()
        .ok_or(PlatformError::Condition { condition })?;
    let solved = &inverse * scaled.tr_mul(&right);
    let left = &scaled * &solved - &right;
    let variance = left.norm_squared() / right.len() as f64 * ALIKE;
    Ok(Fit {
        numbers: std::array::from_fn(|k| solved[k] / sizes[k]),
        deviations: std::array::from_fn(|k| (inverse[(k, k)] * variance).sqrt() / sizes[k]),
        left,
        torques_squared: right.norm_squared(),
        condition,
    })
}

/// Adds the equations of all instants, and their right sides.
fn add_rows(
    tour: &Tour,
    how: &Evaluation,
    rows: &mut Vec<[f64; UNKNOWNS]>,
    right: &mut Vec<f64>,
) -> Result<(), PlatformError> {
    let samples = tour.angle_rad[0].len();
    let window = ((how.smoothing_s / tour.step_s).round() as usize).max(2);
    let mut all = tour.angle_rad.iter().chain(&tour.torque_n_m);
    if all.any(|signal| signal.len() != samples) || samples < 4 * window {
        return Err(PlatformError::Lengths);
    }
    let torques = [0, 1, 2].map(|i| smoothed(&tour.torque_n_m[i], window));
    let raw = poses(tour)?;
    let carriages = carriages(&raw, how.presliding).map(|contact| smoothed(&contact, window));
    let least_way_rad = LEAST_RATE_RAD_S * window as f64 * tour.step_s;
    let part = |k: usize| smoothed(&raw.iter().map(|pose| pose[k]).collect::<Vec<_>>(), window);
    let (x, y, theta) = (part(0), part(1), part(2));
    let poses: Vec<_> = (0..x.len())
        .map(|k| Vector3::new(x[k], y[k], theta[k]))
        .collect();
    let gears = gears(tour, how.gear_ratio).map(|wave| smoothed(&wave, window));
    // Neighbours tell the same.
    for at in (1..poses.len() - 1).step_by((window / 4).max(1)) {
        let ways = [0, 1, 2].map(|i| tour.angle_rad[i][at + window] - tour.angle_rad[i][at]);
        if ways.iter().any(|way| !(way.abs() > least_way_rad)) {
            continue;
        }
        let rubs = Rubs {
            rings: ways.map(f64::signum),
            carriages: [0, 1, 2].map(|i| carriages[i][at]),
            carriage_rates: carriages
                .each_ref()
                .map(|contact| (contact[at + 1] - contact[at - 1]) / (2.0 * tour.step_s)),
        };
        let mut matrix = equations(&poses[at - 1..=at + 1], &rubs, tour.step_s)
            .ok_or(PlatformError::NoPose { sample: at })?;
        for (i, row) in matrix.iter_mut().enumerate() {
            row[GAINS] = torques[i][at] * of_three([1.0, 0.0])[i];
            row[GAINS + 1] = torques[i][at] * of_three([0.0, 1.0])[i];
        }
        for (k, wave) in gears.iter().enumerate() {
            let bend = wave[at + 1] - 2.0 * wave[at] + wave[at - 1];
            matrix[k / 2][GEARS + k] = bend / (tour.step_s * tour.step_s);
        }
        rows.extend(matrix);
        right.extend([0, 1, 2].map(|i| torques[i][at]));
    }
    Ok(())
}

/// Cosine and sine of each motor's angle, but for where it started.
fn gears(tour: &Tour, ratio: f64) -> [Vec<f64>; 6] {
    std::array::from_fn(|k| {
        let wave = if k % 2 == 0 { f64::cos } else { f64::sin };
        let angles = tour.angle_rad[k / 2].iter();
        angles.map(|angle| wave(ratio * angle)).collect()
    })
}

/// Means under a Hann window, of as many values.
fn smoothed(values: &[f64], window: usize) -> Vec<f64> {
    let weights: Vec<f64> = (0..=window)
        .map(|k| 1.0 - (TAU * (k as f64 + 0.5) / (window + 1) as f64).cos())
        .collect();
    let sum: f64 = weights.iter().sum();
    values
        .windows(window + 1)
        .map(|part| {
            part.iter()
                .zip(&weights)
                .map(|(value, weight)| value * weight)
                .sum::<f64>()
                / sum
        })
        .collect()
}

/// Poses: x and y in track radii, theta.
fn poses(tour: &Tour) -> Result<Vec<Vector3<f64>>, PlatformError> {
    (0..tour.angle_rad[0].len())
        .map(|sample| {
            let angles = [0, 1, 2].map(|i| tour.angle_rad[i][sample]);
            let pose = direct::<f64>(&angles).map_err(|_| PlatformError::NoPose { sample })?;
            Ok(Vector3::new(pose.x, pose.y, pose.theta))
        })
        .collect()
}

/// What rubs, -1 to 1.
struct Rubs {
    rings: [f64; 3],
    carriages: [f64; 3],
    /// By time, 1/s.
    carriage_rates: [f64; 3],
}

/// Contacts of the three carriages, -1 to 1: `dz/ds = 1 - z sign(ds)` by the way s over the presliding.
fn carriages(poses: &[Vector3<f64>], presliding: f64) -> [Vec<f64>; 3] {
    let rhos: Vec<[f64; 3]> = (poses.iter())
        .map(|pose| {
            let found = inverse(&Pose {
                x: pose.x,
                y: pose.y,
                theta: pose.z,
            });
            found.map_or([0.0; 3], |found| found.guides.map(|guide| guide.rho()))
        })
        .collect();
    std::array::from_fn(|i| {
        let mut contact = 0.0;
        let mut all = vec![0.0];
        for pair in rhos.windows(2) {
            let way = (pair[1][i] - pair[0][i]) / presliding;
            contact = (contact + way) / (1.0 + way.abs());
            all.push(contact);
        }
        all
    })
}

/// Coefficients of all unknowns but those of torques and gears for each ring's torque at the middle of three poses.
fn equations(poses: &[Vector3<f64>], rubs: &Rubs, step_s: f64) -> Option<[[f64; UNKNOWNS]; 3]> {
    let [before, now, after] = [poses[0], poses[1], poses[2]];
    let twist = (after - before) / (2.0 * step_s);
    let acceleration = (after - 2.0 * now + before) / (step_s * step_s);
    let guides = inverse(&Pose {
        x: now.x,
        y: now.y,
        theta: now.z,
    })
    .ok()?
    .guides;
    let rates = jacobian(&guides) * twist;
    let accelerations = kinematics::pivot_accelerations(
        &guides,
        &Twist {
            x: twist.x,
            y: twist.y,
            theta: twist.z,
        },
        &kinematics::Acceleration {
            x: acceleration.x,
            y: acceleration.y,
            theta: acceleration.z,
        },
    );
    let to_rings: Matrix3<f64> = jacobian_inverse(&guides).transpose();
    let (sin, cos) = now.z.sin_cos();
    let (a, turning) = (acceleration, twist.z * twist.z);
    // A moment along the base's x or y: M q'' and the centrifugal force of it.
    let along_x = Vector3::new(-turning, a.z, a.y);
    let along_y = Vector3::new(-a.z, -turning, -a.x);
    let [mut rubbing, mut damping, mut sliding] = [Vector3::zeros(); 3];
    for (i, guide) in guides.iter().enumerate() {
        let offset_by_pose = Vector3::new(-guide.sin, guide.cos, -guide.projection);
        let by_pose = -(offset_by_pose * (guide.offset / guide.cosine))
            - Vector3::new(guide.cos, guide.sin, guide.offset);
        rubbing += by_pose * rubs.carriages[i];
        damping += by_pose * rubs.carriage_rates[i];
        sliding += by_pose * by_pose.dot(&twist);
    }
    let columns = [
        to_rings * Vector3::new(a.x, a.y, 0.0),
        to_rings * Vector3::new(0.0, 0.0, a.z),
        to_rings * (along_x * cos + along_y * sin),
        to_rings * (along_y * cos - along_x * sin),
        Vector3::from(accelerations),
    ];
    let [guide, contact_damping, cable, guide_viscous] = [
        to_rings * rubbing,
        to_rings * damping,
        to_rings * Vector3::new(now.x, now.y, 0.0),
        to_rings * sliding,
    ];
    let mut rows = [[0.0; UNKNOWNS]; 3];
    for (i, row) in rows.iter_mut().enumerate() {
        for (k, column) in columns.iter().enumerate() {
            row[k] = column[i];
        }
        row[5 + i] = rubs.rings[i];
        row[8 + i] = rates[i];
        row[GUIDE] = guide[i];
        row[CONTACT_DAMPING] = contact_damping[i];
        row[12] = cable[i];
        row[13 + i] = 1.0;
        row[GUIDE_VISCOUS] = guide_viscous[i];
    }
    Some(rows)
}
