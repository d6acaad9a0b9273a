//! Inertias, springs and dampers, from the responses of the angles to the currents.
//!
//! Torque is current times motor constant, so neither winding nor bridge matters here. The model is the chain of motors, rings and platform
//! ([`crate::chain`]) in the middle of the disk, where turning does not change it; it follows all nine responses at all lines at once.
//!
//! Play in the gears gives way where it is crossed, by the same angle whatever the torque: it adds to what the transmission's springs give way, the
//! more the weaker the excitation is. So there are two, and the machine is told without its play: as it answers where something bears on
//! the gears.
//!
//! What cannot be told apart at one place: rings and platform below the guides' resonance. There only `J + m R^2 / 1.5` and `J + I / 3` are
//! seen, J being a motor and its ring; mass, inertia and J follow apart as far as the platform stays behind above it. Motor and
//! ring follow apart by the two resonances only. So the guess counts too, as one that may be off by [`Guess::SPREAD`]; what is
//! hardly better than the guess shows in its deviation.

use super::{DriveError, Electrical};
use crate::chain::{Chain, Load, Place};
use crate::frequency_response::Line;
use crate::least_squares::{Minimum, minimise};
use nalgebra::{Complex, DVector, Matrix3};

/// What is thought of the machine before anything is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guess(pub Chain);

impl Guess {
    /// The reference stage with half of the heaviest load: what is thought of every machine.
    pub const STAGE: Self = Self(Chain {
        motor_inertia: 0.012,
        ring_inertia: 0.008,
        stiffness: 7.46e5,
        damping: 3.2,
        viscous: 0.05,
        guide_stiffness: 3e5,
        guide_damping: 1.7,
        along_stiffness: 1000.0,
        along_damping: 0.8,
        load: Load {
            mass: 0.05,
            inertia: 0.025,
            moment: [0.0; 2],
        },
    });
    /// How far it may be off, as a logarithm: a factor of two either way is likely.
    pub const SPREAD: f64 = 0.7;
}

/// Lines in the middle of the disk, and those of an excitation that is weaker.
#[derive(Clone, Copy, Debug)]
pub struct Responses<'a> {
    /// Of the excitation.
    pub lines: &'a [Line],
    /// Of the weaker one.
    pub weaker: &'a [Line],
    /// How many times as strong the first is.
    pub times: f64,
}

/// The mechanics as found.
#[derive(Clone, Debug, PartialEq)]
pub struct Mechanical {
    /// Numbers, without play.
    pub chain: Chain,
    /// The same as they answered to the excitation: softer by its play.
    pub excited: Chain,
    /// Standard deviations, over themselves, in the order of [`NAMES`]; those of the last two are in kg m^2.
    pub deviations: Vec<f64>,
    /// What is left of the responses, over them: root of the mean square over lines and entries.
    pub residual: f64,
    /// Standard deviation of a motor and its ring together, over itself: the sum is known better than either.
    pub drive_inertia_deviation: f64,
}

/// What is fitted, in this order.
pub const NAMES: [&str; 13] = [
    "motor inertia",
    "ring inertia",
    "transmission stiffness",
    "transmission damping",
    "viscous friction",
    "guide stiffness",
    "guide damping",
    "stiffness along a guide",
    "damping along a guide",
    "mass",
    "inertia",
    "moment x",
    "moment y",
];

/// What play gives way under the excitation, over the transmission's springs, and what it damps, over its dampers: as likely as not.
const PLAY_GIVES: f64 = 0.2;
const PLAY_DAMPS: f64 = 1.0;
/// What the model leaves out, over a response: little where all moves as one, and more by the frequency and the weaker the excitation, since play
/// is no spring.
const MODEL_ERROR: f64 = 0.01;
const GROWS_FROM_HZ: f64 = 300.0;
/// More of what is left is no fit.
const MOST_RESIDUAL: f64 = 0.3;
/// Starts: shares of the guessed stiffnesses of transmission and guides.
const TRANSMISSIONS: [f64; 6] = [0.15, 0.25, 0.45, 0.8, 1.3, 1.9];
const GUIDES: [f64; 4] = [0.25, 0.45, 0.75, 1.1];
/// Starts that are followed to their end, and steps of each.
const FOLLOWED: usize = 8;
const STEPS: usize = 60;

struct Measured {
    hz: f64,
    /// What play gives way and damps, over what it does under the excitation.
    play: f64,
    response: Matrix3<Complex<f64>>,
    deviation: Matrix3<f64>,
}

/// The mechanics, from lines up to `to_hz`.
///
/// # Errors
/// [`DriveError::NoFit`].
pub fn mechanical(
    responses: &Responses<'_>,
    drives: &[Electrical; 3],
    guess: &Guess,
    to_hz: f64,
) -> Result<Mechanical, DriveError> {
    let place = Place::centre();
    let of = |lines: &[Line], play: f64| -> Vec<Measured> {
        (lines.iter().filter(|line| line.hz <= to_hz))
            .map(|line| by_torque(line, drives, play))
            .collect()
    };
    let mut measured = of(responses.lines, 1.0);
    measured.extend(of(responses.weaker, responses.times));
    let prior = to_unknowns(&guess.0);
    let residuals = |unknowns: &DVector<f64>| residuals(unknowns, &prior, &measured, &place);
    let mut starts: Vec<_> = (TRANSMISSIONS.iter())
        .flat_map(|&k| GUIDES.map(|g| start(&guess.0, k, g, &measured)))
        .map(|start| (residuals(&start).norm_squared(), start))
        .collect();
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let best = (starts.iter().take(FOLLOWED))
        .filter_map(|(_, start)| minimise(start, STEPS, residuals))
        .min_by(|a, b| a.cost.total_cmp(&b.cost));
    let minimum = best.ok_or(DriveError::NoFit { percent: 100 })?;
    let found = from_minimum(&minimum, &measured, &place);
    if found.residual > MOST_RESIDUAL {
        return Err(DriveError::NoFit {
            percent: (100.0 * found.residual) as u32,
        });
    }
    Ok(found)
}

fn by_torque(line: &Line, drives: &[Electrical; 3], play: f64) -> Measured {
    let (mut response, mut deviation) =
        (line.angle_by_current(), line.angle_by_current_deviation());
    for (i, drive) in drives.iter().enumerate() {
        response.column_mut(i).scale_mut(1.0 / drive.motor_constant);
        deviation
            .column_mut(i)
            .scale_mut(1.0 / drive.motor_constant);
    }
    let size = response.norm() / 3.0;
    let share = play * MODEL_ERROR * (1.0 + (line.hz / GROWS_FROM_HZ).powi(2)).sqrt();
    for (deviation, response) in deviation.iter_mut().zip(response.iter()) {
        let left_out = share * response.norm().hypot(size);
        *deviation = deviation.hypot(left_out);
    }
    Measured {
        hz: line.hz,
        play,
        response,
        deviation,
    }
}

/// A guess with other springs, and with an inertia that fits what the lowest lines show.
fn start(guess: &Chain, transmission: f64, guide: f64, measured: &[Measured]) -> DVector<f64> {
    let mut chain = *guess;
    chain.stiffness *= transmission;
    chain.damping *= transmission.sqrt();
    chain.guide_stiffness *= guide;
    chain.guide_damping *= guide.sqrt();
    let place = Place::centre();
    let low = measured
        .iter()
        .find(|line| line.hz > 60.0)
        .or(measured.first());
    if let Some(line) = low {
        let share = (chain.compliance(line.hz, &place).ring[(0, 0)] / line.response[(0, 0)]).norm();
        for inertia in [
            &mut chain.motor_inertia,
            &mut chain.ring_inertia,
            &mut chain.load.mass,
            &mut chain.load.inertia,
        ] {
            *inertia *= share;
        }
    }
    to_unknowns(&chain)
}

/// What the moments are counted in, kg m^2.
const MOMENT: f64 = 0.01;

fn to_unknowns(chain: &Chain) -> DVector<f64> {
    let Chain {
        motor_inertia,
        ring_inertia,
        stiffness,
        damping,
        viscous,
        guide_stiffness,
        guide_damping,
        along_stiffness,
        along_damping,
        load,
    } = *chain;
    let positive = [
        motor_inertia,
        ring_inertia,
        stiffness,
        damping,
        viscous,
        guide_stiffness,
        guide_damping,
        along_stiffness,
        along_damping,
        load.mass,
        load.inertia,
    ];
    DVector::from_iterator(
        15,
        positive
            .map(f64::ln)
            .into_iter()
            .chain(load.moment.map(|moment| moment / MOMENT))
            .chain([0.0; 2]),
    )
}

fn from_unknowns(unknowns: &DVector<f64>) -> Chain {
    let at = |k: usize| unknowns[k].exp();
    Chain {
        motor_inertia: at(0),
        ring_inertia: at(1),
        stiffness: at(2),
        damping: at(3),
        viscous: at(4),
        guide_stiffness: at(5),
        guide_damping: at(6),
        along_stiffness: at(7),
        along_damping: at(8),
        load: Load {
            mass: at(9),
            inertia: at(10),
            moment: [unknowns[11] * MOMENT, unknowns[12] * MOMENT],
        },
    }
}

/// What play gives way and damps under the excitation, over what the transmission does.
fn play(unknowns: &DVector<f64>) -> [f64; 2] {
    [PLAY_GIVES * unknowns[13], PLAY_DAMPS * unknowns[14]].map(|more| f64::max(0.0, more))
}

fn excited(chain: &Chain, play: [f64; 2], times: f64) -> Chain {
    let [gives, damps] = play.map(|more| times * more);
    chain.with_play(gives, damps)
}

fn residuals(
    unknowns: &DVector<f64>,
    prior: &DVector<f64>,
    measured: &[Measured],
    place: &Place,
) -> DVector<f64> {
    let chain = from_unknowns(unknowns);
    let mut all = Vec::with_capacity(18 * measured.len() + unknowns.len());
    for line in measured {
        let excited = excited(&chain, play(unknowns), line.play);
        let model = excited.compliance(line.hz, place).ring;
        for k in 0..9 {
            let off = (line.response[k] - model[k]) / line.deviation[k];
            all.extend([off.re, off.im]);
        }
    }
    all.extend((0..11).map(|k| (unknowns[k] - prior[k]) / Guess::SPREAD));
    all.extend([11, 12, 13, 14].map(|k| unknowns[k]));
    DVector::from_vec(all)
}

fn from_minimum(minimum: &Minimum, measured: &[Measured], place: &Place) -> Mechanical {
    let (chain, play) = (from_unknowns(&minimum.at), play(&minimum.at));
    let excited = excited(&chain, play, 1.0);
    let of_excited = || measured.iter().filter(|line| line.play <= 1.0);
    let left: f64 = of_excited()
        .map(|line| {
            let off = line.response - excited.compliance(line.hz, place).ring;
            off.norm_squared() / line.response.norm_squared()
        })
        .sum();
    // Residuals are larger than what deviations say by what the model does not know.
    let grown = (minimum.cost / (18.0 * measured.len() as f64)).max(1.0);
    let covariance = &minimum.covariance * grown;
    let variance = |k: usize| covariance[(k, k)].max(0.0);
    let [motor, ring] = [chain.motor_inertia, chain.ring_inertia];
    let sum = motor * motor * variance(0)
        + ring * ring * variance(1)
        + 2.0 * motor * ring * covariance[(0, 1)];
    Mechanical {
        chain,
        excited,
        deviations: (0..13)
            .map(|k| variance(k).sqrt() * if k < 11 { 1.0 } else { MOMENT })
            .collect(),
        residual: f64::sqrt(left / of_excited().count() as f64),
        drive_inertia_deviation: sum.max(0.0).sqrt() / (motor + ring),
    }
}
