//! Inertias, springs and dampers, from the responses of the angles to the currents.
//!
//! Torque is current times motor constant, so neither winding nor bridge matters here. The model is the chain of motors, rings and platform
//! ([`crate::chain`]) in the middle of the disk, where turning does not change it; it follows all nine responses at all lines at once.
//!
//! Play in the gears gives way where it is crossed, by the same angle whatever the torque: it adds to what the transmission's springs give way, the
//! more the weaker the excitation is. So there are two, and the machine is told without its play: as it answers where something bears on
//! the gears.
//!
//! Carriages that stick hold the platform along their guides, the more the weaker the excitation is: by how much is found too.
//!
//! Neither play nor friction is a spring, and what the model leaves out is not the same at all frequencies: a per cent below the resonances, a
//! third beside them. So lines count by what the fit leaves of them and of their neighbours: it is repeated with that (iteratively
//! reweighted least squares, Holland and Welsch 1977). Otherwise what is left at resonances, which no number mends, bends the inertias.
//!
//! What cannot be told apart at one place: rings and platform below the guides' resonance. In the middle only `J + m R^2 / 1.5` and `J + I / 3` are
//! seen there, J being a motor and its ring; far out the rings move other shares of mass and inertia, so that all three follow. Motor and
//! ring follow apart by the two resonances only. So the guess counts too, as one that may be off by [`Guess::SPREAD`]; what is
//! hardly better than the guess shows in its deviation.

use super::{DriveError, Electrical};
use crate::chain::{Chain, Load, Place, Uncertainty};
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

/// Lines in the middle of the disk, those of an excitation that is weaker, and some far out.
#[derive(Clone, Copy, Debug)]
pub struct Responses<'a> {
    /// Of the excitation.
    pub lines: &'a [Line],
    /// Of the weaker one.
    pub weaker: &'a [Line],
    /// How many times as strong the first is.
    pub times: f64,
    /// Of an excitation as strong as the first, far out.
    pub far: &'a [Line],
    /// Where that was.
    pub far_place: &'a Place,
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
    /// What a model leaves of the responses in the middle to which all lines are alike, besides their noise, over them: root of the mean square over
    /// lines and entries.
    pub residual: f64,
    /// Standard deviation of a motor and its ring together, over itself: the sum is known better than either.
    pub drive_inertia_deviation: f64,
}

impl Mechanical {
    /// How far springs and dampers may be off: by so many standard deviations each, and by what no deviation tells, since what the model leaves out is
    /// the same at all lines. Gains are for all four at once off the bad way ([`Chain::as_it_may_be`]), which lies at twice as many.
    #[must_use]
    pub fn uncertainty(&self) -> Uncertainty {
        let off = |k: usize, besides: f64| SURE * self.deviations[k] + besides;
        Uncertainty {
            stiffness: off(2, SPRINGS_OFF),
            damping: off(3, DAMPERS_OFF),
            guide_stiffness: off(5, SPRINGS_OFF),
            guide_damping: off(6, DAMPERS_OFF),
        }
    }
}

/// See [`Mechanical::uncertainty`].
const SURE: f64 = 2.0;
const SPRINGS_OFF: f64 = 0.015;
const DAMPERS_OFF: f64 = 0.08;

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

/// Of mass and inertia among [`NAMES`].
pub const MASS: usize = 9;
/// See [`MASS`].
pub const LOAD_INERTIA: usize = 10;

/// What play gives way under the excitation, over the transmission's springs, and what it damps, over its dampers: as likely as not.
const PLAY_GIVES: f64 = 0.2;
const PLAY_DAMPS: f64 = 1.0;
/// What sticking carriages hold of a platform that moves less, over what they hold of one that moves more, as a logarithm: as likely as not.
const STICKS_MORE: f64 = 1.0;
/// What the model leaves out, over a response, before that is known: little where all moves as one, and more by the frequency and the weaker the
/// excitation is, since play is no spring.
const MODEL_ERROR: f64 = 0.01;
const GROWS_FROM_HZ: f64 = 300.0;
/// Then by what is left: the median of lines so near by their logarithm, not less than this; a line of so many times as much counts half.
const NEAR: f64 = 0.25;
const LEAST_ERROR: f64 = 0.001;
const HALF_AT: f64 = 2.0;
const REPEATED: usize = 4;
/// More of what is left is no fit.
const MOST_RESIDUAL: f64 = 0.3;
/// Starts: shares of the guessed stiffnesses of transmission and guides.
const TRANSMISSIONS: [f64; 6] = [0.15, 0.25, 0.45, 0.8, 1.3, 1.9];
const GUIDES: [f64; 4] = [0.25, 0.45, 0.75, 1.1];
/// Starts that are followed to their end, and steps of each.
const FOLLOWED: usize = 8;
const STEPS: usize = 60;

struct Measured<'a> {
    hz: f64,
    place: &'a Place,
    /// What play gives way and damps, over what it does under the excitation.
    play: f64,
    response: Matrix3<Complex<f64>>,
    /// By the scatter from period to period.
    noise: Matrix3<f64>,
    /// With what the model leaves out.
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
    let centre = Place::centre();
    let of = |lines: &[Line], place, play: f64| -> Vec<Measured<'_>> {
        (lines.iter().filter(|line| line.hz <= to_hz))
            .map(|line| by_torque(line, drives, (place, play)))
            .collect()
    };
    let mut measured = of(responses.lines, &centre, 1.0);
    let in_the_middle = measured.len();
    measured.extend(of(responses.weaker, &centre, responses.times));
    measured.extend(of(responses.far, responses.far_place, 1.0));
    let prior = to_unknowns(&guess.0);
    // The lines in the middle alone say what springs there are: all at once may end where none of them is followed.
    let alone = |unknowns: &DVector<f64>| residuals(unknowns, &prior, &measured[..in_the_middle]);
    let mut starts: Vec<_> = (TRANSMISSIONS.iter())
        .flat_map(|&k| GUIDES.map(|g| start(&guess.0, k, g, &measured)))
        .map(|start| (alone(&start).norm_squared(), start))
        .collect();
    starts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let all = |unknowns: &DVector<f64>| residuals(unknowns, &prior, &measured);
    let best = (starts.iter().take(FOLLOWED))
        .filter_map(|(_, start)| minimise(start, STEPS, alone))
        .min_by(|a, b| a.cost.total_cmp(&b.cost))
        .and_then(|minimum| minimise(&minimum.at, STEPS, all));
    let mut minimum = best.ok_or(DriveError::NoFit { percent: 100 })?;
    let residual = left(&minimum.at, &measured[..in_the_middle]);
    if residual > MOST_RESIDUAL {
        return Err(DriveError::NoFit {
            percent: (100.0 * residual) as u32,
        });
    }
    for _ in 0..REPEATED {
        weigh(&mut measured, &minimum.at);
        let again = |unknowns: &DVector<f64>| residuals(unknowns, &prior, &measured);
        minimum = minimise(&minimum.at, STEPS, again).unwrap_or(minimum);
    }
    Ok(from_minimum(&minimum, measured.len(), residual))
}

fn by_torque<'a>(
    line: &Line,
    drives: &[Electrical; 3],
    (place, play): (&'a Place, f64),
) -> Measured<'a> {
    let (mut response, mut noise) = (line.angle_by_current(), line.angle_by_current_deviation());
    for (i, drive) in drives.iter().enumerate() {
        response.column_mut(i).scale_mut(1.0 / drive.motor_constant);
        noise.column_mut(i).scale_mut(1.0 / drive.motor_constant);
    }
    let share = play * MODEL_ERROR * (1.0 + (line.hz / GROWS_FROM_HZ).powi(2)).sqrt();
    let mut measured = Measured {
        hz: line.hz,
        place,
        play,
        response,
        noise,
        deviation: noise,
    };
    measured.leave_out(share);
    measured
}

impl Measured<'_> {
    /// The model leaves out such a share of the response.
    fn leave_out(&mut self, share: f64) {
        let size = self.response.norm() / 3.0;
        let entries = self.noise.iter().zip(self.response.iter());
        for (deviation, (noise, response)) in self.deviation.iter_mut().zip(entries) {
            *deviation = noise.hypot(share * response.norm().hypot(size));
        }
    }

    /// What a model leaves of the response, over it.
    fn left(&self, unknowns: &DVector<f64>) -> f64 {
        let model = answering(unknowns, self.play).compliance(self.hz, self.place);
        (self.response - model.ring).norm() / self.response.norm()
    }

    /// Whether a line of the same excitation is so near that it says what the model leaves out here.
    fn is_near(&self, other: &Self) -> bool {
        self.play == other.play
            && std::ptr::eq(self.place, other.place)
            && (self.hz / other.hz).ln().abs() < NEAR
    }
}

/// Lines count by what a fit leaves of them.
fn weigh(measured: &mut [Measured<'_>], unknowns: &DVector<f64>) {
    let left: Vec<f64> = measured.iter().map(|line| line.left(unknowns)).collect();
    let shares: Vec<f64> = (measured.iter().zip(&left))
        .map(|(line, own)| {
            let all = measured.iter().zip(&left);
            let mut near: Vec<f64> = all
                .filter(|(other, _)| line.is_near(other))
                .map(|(_, left)| *left)
                .collect();
            near.sort_by(f64::total_cmp);
            let median = near[near.len() / 2].max(LEAST_ERROR);
            median.hypot(own / HALF_AT)
        })
        .collect();
    for (line, share) in measured.iter_mut().zip(shares) {
        line.leave_out(share);
    }
}

/// A guess with other springs, and with an inertia that fits what the lowest lines show.
fn start(guess: &Chain, transmission: f64, guide: f64, measured: &[Measured<'_>]) -> DVector<f64> {
    let mut chain = *guess;
    chain.stiffness *= transmission;
    chain.damping *= transmission.sqrt();
    chain.guide_stiffness *= guide;
    chain.guide_damping *= guide.sqrt();
    let low = measured
        .iter()
        .find(|line| line.hz > 60.0)
        .or(measured.first());
    if let Some(line) = low {
        let share =
            (chain.compliance(line.hz, line.place).ring[(0, 0)] / line.response[(0, 0)]).norm();
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

/// [`NAMES`], what play gives way and damps, and how much more carriages hold while little moves.
const UNKNOWNS: usize = 16;
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
        UNKNOWNS,
        positive
            .map(f64::ln)
            .into_iter()
            .chain(load.moment.map(|moment| moment / MOMENT))
            .chain([0.0; 3]),
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

/// The chain as it answers to an excitation of which play gives way `play` times as much as of the first.
fn answering(unknowns: &DVector<f64>, play: f64) -> Chain {
    let more = |k: usize, likely: f64| play * f64::max(0.0, likely * unknowns[k]);
    let mut chain = from_unknowns(unknowns).with_play(more(13, PLAY_GIVES), more(14, PLAY_DAMPS));
    if play > 1.0 {
        let sticks = (STICKS_MORE * unknowns[15]).exp();
        chain.along_stiffness *= sticks;
        chain.along_damping *= sticks;
    }
    chain
}

fn residuals(
    unknowns: &DVector<f64>,
    prior: &DVector<f64>,
    measured: &[Measured<'_>],
) -> DVector<f64> {
    let mut all = Vec::with_capacity(18 * measured.len() + unknowns.len());
    for line in measured {
        let model = (answering(unknowns, line.play).compliance(line.hz, line.place)).ring;
        for k in 0..9 {
            let off = (line.response[k] - model[k]) / line.deviation[k];
            all.extend([off.re, off.im]);
        }
    }
    all.extend((0..11).map(|k| (unknowns[k] - prior[k]) / Guess::SPREAD));
    all.extend((11..UNKNOWNS).map(|k| unknowns[k]));
    DVector::from_vec(all)
}

/// What a model leaves of all responses besides their noise, over them: root of the mean square.
fn left(unknowns: &DVector<f64>, measured: &[Measured<'_>]) -> f64 {
    let squares = measured.iter().map(|line| {
        let noise = line.noise.norm() / line.response.norm();
        f64::max(0.0, line.left(unknowns).powi(2) - noise.powi(2))
    });
    f64::sqrt(squares.sum::<f64>() / measured.len() as f64)
}

fn from_minimum(minimum: &Minimum, lines: usize, residual: f64) -> Mechanical {
    let (chain, excited) = (from_unknowns(&minimum.at), answering(&minimum.at, 1.0));
    // Residuals are larger than what deviations say by what the model does not know.
    let grown = (minimum.cost / (18.0 * lines as f64)).max(1.0);
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
        residual,
        drive_inertia_deviation: sum.max(0.0).sqrt() / (motor + ring),
    }
}
