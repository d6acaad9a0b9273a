//! How far a loop of three pivots is from the edge: sensitivity of all three together, stability by Nyquist's criterion.
//!
//! `S = 1 / (1 + L)`, L the 3x3 loop; its largest singular value says what becomes of the worst direction of an error. The loop is
//! stable if `det(1 + L) (1 - 1/z)^6`, which has no poles outside, does not go round 0: L has an integrator in each plant and one in
//! each servo.

use super::plant::Plant;
use super::servo::{At, PivotGains, Servo};
use firmware::parameters::Parameters;
use nalgebra::{Complex, Matrix3};
use std::f64::consts::TAU;

/// Gains of the three pivots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    /// Of each pivot.
    pub pivots: [PivotGains; 3],
    /// Inertia that velocity and integral gain are for, kg m^2 (parameter 0x54500306); 0: the same gains everywhere.
    pub scheduled_inertia_kg_m2: f64,
}

/// Ms that loops may have, measured or predicted.
pub const MOST_MS: f64 = 2.0;
/// What gains are lowered by where they ask too much, and how often at most.
const LESS: f64 = 0.92;
const MOST_LESS: usize = 20;
/// What rest leaves of gains with a velocity gain of 40 V s/rad; of lower ones more, so that the loop at rest is the same.
const REST: f64 = 0.1;
const REST_VELOCITY_V_S_RAD: f64 = 40.0;

/// What rest leaves of gains with this velocity gain (parameter 0x54500308).
#[must_use]
pub fn rest_stiffness(velocity_v_s_rad: f64) -> f64 {
    (REST * REST_VELOCITY_V_S_RAD / velocity_v_s_rad).clamp(REST, 1.0)
}

impl Gains {
    /// Those of a controller's parameters.
    #[must_use]
    pub fn of(parameters: &Parameters) -> Self {
        let servo = &parameters.servo;
        Self {
            pivots: [0, 1, 2].map(|i| PivotGains {
                gains: servo.gains[i],
                filters: servo.filters[i],
            }),
            scheduled_inertia_kg_m2: servo.scheduled_inertia_kg_m2,
        }
    }

    /// Parameters with them.
    #[must_use]
    pub fn applied_to(&self, parameters: &Parameters) -> Parameters {
        let mut applied = parameters.clone();
        let servo = &mut applied.servo;
        for (i, pivot) in self.pivots.iter().enumerate() {
            servo.gains[i] = pivot.gains;
            servo.filters[i] = pivot.filters;
        }
        servo.scheduled_inertia_kg_m2 = self.scheduled_inertia_kg_m2;
        applied
    }

    /// The lowest velocity gain of a pivot, V s/rad.
    #[must_use]
    pub fn least_velocity_v_s_rad(&self) -> f64 {
        (self.pivots.iter())
            .map(|pivot| pivot.gains.velocity_v_s_rad)
            .fold(f64::INFINITY, f64::min)
    }

    /// The worst margins on all plants; `None` where there is no plant.
    #[must_use]
    pub fn at_worst(&self, plants: &[Plant]) -> Option<Margins> {
        self.on_each(plants.iter().map(|plant| (plant, Enough::NOTHING)))
            .reduce(Margins::worse)
    }

    /// Margins on each plant, exact only beyond what is enough there.
    pub(super) fn on_each<'a>(
        &self,
        plants: impl Iterator<Item = (&'a Plant, Enough)>,
    ) -> impl Iterator<Item = Margins> {
        let mut servos: Option<Servos<'_>> = None;
        plants.map(move |(plant, enough)| {
            // Plants of a model have the same frequencies.
            let same = servos.take().filter(|servos| servos.are_for(plant));
            let servos = servos.insert(same.unwrap_or_else(|| Servos::new(plant, self)));
            servos.margins(plant, &enough)
        })
    }

    /// The fastest of slower and slower gains that is stable and keeps Ms on all plants, and the worst margins; `None` where none does.
    #[must_use]
    pub fn slowed_until_sound(&self, plants: &[Plant], most_ms: f64) -> Option<(Self, Margins)> {
        let mut gains = *self;
        for _ in 0..MOST_LESS {
            let all = gains.at_worst(plants)?;
            if all.are_sound(most_ms) {
                return Some((gains, all));
            }
            gains = gains.slowed(LESS);
        }
        None
    }

    /// A servo that is slower, the same with time stretched: velocity and position gain by the factor, the integral gain by its square.
    #[must_use]
    pub fn slowed(&self, by: f64) -> Self {
        Self {
            pivots: self.pivots.map(|mut pivot| {
                pivot.gains.velocity_v_s_rad *= by;
                pivot.gains.position_1_s *= by;
                pivot.gains.integral_v_rad *= by * by;
                pivot
            }),
            ..*self
        }
    }
}

/// What a loop is like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margins {
    /// Whether it is stable; true where that is not known ([`Plant::is_complete`]).
    pub is_stable: bool,
    /// Largest singular value of S over all frequencies.
    pub ms: f64,
    /// Where.
    pub ms_hz: f64,
    /// Largest singular value of S at [`REJECTION_HZ`]; NaN where that is not known.
    pub rejection: f64,
    /// Highest frequency at which the loop of a pivot, with the others closed, has a gain of 1 (`|1/S_ii - 1|`); of the slowest pivot.
    pub crossover_hz: f64,
    /// Largest peak of L beyond [`BEYOND`] times the crossover, as a singular value: resonances. 0 where L only falls.
    pub resonance_peak: f64,
}

/// Where rejection is measured.
pub const REJECTION_HZ: f64 = 30.0;
/// Resonances are sought from so many crossovers on.
pub const BEYOND: f64 = 1.5;

/// What becomes of a voltage that is added to the servos', at each frequency: `1 / (1 + C P)`, what [`crate::closed_loop`] measures. With servos
/// that are not the same it is not that of an angle, `1 / (1 + P C)`, which margins are of.
#[must_use]
pub fn sensitivity(plant: &Plant, gains: &Gains) -> Vec<Matrix3<Complex<f64>>> {
    let nothing = Matrix3::repeat(Complex::new(f64::NAN, f64::NAN));
    let servos = Servos::new(plant, gains);
    (plant.response.iter().zip(servos.at(plant)))
        .map(|(response, servos)| {
            let l = Matrix3::from_diagonal(&servos.into()) * response;
            (Matrix3::identity() + l).try_inverse().unwrap_or(nothing)
        })
        .collect()
}

/// Margins up to which it is enough to know that they are no larger: singular values take most of a search's time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Enough {
    pub ms: f64,
    pub resonance_peak: f64,
}

impl Enough {
    const NOTHING: Self = Self {
        ms: 0.0,
        resonance_peak: 0.0,
    };
}

/// The servos of the three pivots, with the gains as they are told, at a plant's frequencies.
struct Servos<'a> {
    at: &'a [At],
    responses: Vec<[Complex<f64>; 3]>,
    scheduled_inertia_kg_m2: f64,
}

impl<'a> Servos<'a> {
    fn new(plant: &'a Plant, gains: &Gains) -> Self {
        let servos = (gains.pivots.each_ref()).map(|pivot| Servo::new(pivot, plant.tick_s));
        let response = |at: &At| servos.each_ref().map(|servo| servo.response(at));
        Self {
            at: &plant.at,
            responses: plant.at.iter().map(response).collect(),
            scheduled_inertia_kg_m2: gains.scheduled_inertia_kg_m2,
        }
    }

    fn are_for(&self, plant: &Plant) -> bool {
        self.at == plant.at
    }

    /// With gains as they are scheduled for what the pivots move there.
    fn at(&self, plant: &Plant) -> impl Iterator<Item = [Complex<f64>; 3]> {
        let scheduled = self.scheduled_inertia_kg_m2;
        let shares = (plant.inertia).map(|inertia| {
            if scheduled > 0.0 {
                inertia / scheduled
            } else {
                1.0
            }
        });
        (self.responses.iter()).map(move |at| [0, 1, 2].map(|i| at[i] * shares[i]))
    }

    /// The loops `P C` at each frequency.
    fn loops(&self, plant: &Plant) -> Vec<Matrix3<Complex<f64>>> {
        (plant.response.iter().zip(self.at(plant)))
            .map(|(response, servos)| Matrix3::from_fn(|i, j| response[(i, j)] * servos[j]))
            .collect()
    }

    fn margins(&self, plant: &Plant, enough: &Enough) -> Margins {
        let mut found = Margins {
            is_stable: true,
            ms: enough.ms,
            ms_hz: 0.0,
            rejection: f64::NAN,
            crossover_hz: f64::INFINITY,
            resonance_peak: enough.resonance_peak,
        };
        let loops = self.loops(plant);
        let (mut last, mut rounds, mut is_known) = (Complex::from(1.0), 0, true);
        let mut crossovers = [0.0; 3];
        for ((&hz, l), at) in plant.hz.iter().zip(&loops).zip(&plant.at) {
            let difference = Matrix3::identity() + l;
            let (determinant, adjugate) = determinant_and_adjugate(&difference);
            let now = determinant * at.without_integrators;
            rounds += crossing(last, now);
            is_known &= now.is_finite();
            last = now;
            let is_first_there =
                plant.is_complete && found.rejection.is_nan() && hz >= REJECTION_HZ;
            // The two larger singular values of three have a product of at most a quarter of all their squares' sum squared.
            let sum = difference.norm_squared();
            let is_enough = sum * sum <= 4.0 * found.ms.powi(2) * determinant.norm_sqr();
            if is_first_there || !is_enough {
                let size = 1.0 / least_singular(&difference);
                if !(size <= found.ms) {
                    (found.ms, found.ms_hz) = (size, hz);
                }
                if is_first_there {
                    found.rejection = size;
                }
            }
            for (i, crossover) in crossovers.iter_mut().enumerate() {
                if (determinant - adjugate[i]).norm_sqr() >= adjugate[i].norm_sqr() {
                    *crossover = hz;
                }
            }
        }
        found.crossover_hz = crossovers.into_iter().fold(f64::INFINITY, f64::min);
        found.is_stable = !plant.is_complete || (is_known && rounds == 0);
        let beyond = (plant.hz.iter()).position(|hz| *hz > BEYOND * found.crossover_hz);
        let first = beyond.unwrap_or(loops.len()).max(1);
        let sizes: Vec<f64> = (loops.iter().skip(first - 1))
            .map(|l| {
                if l.norm() > enough.resonance_peak {
                    largest_singular(l)
                } else {
                    0.0
                }
            })
            .collect();
        for beside in sizes.windows(3) {
            if beside[1] > beside[0] && beside[1] > beside[2] {
                found.resonance_peak = found.resonance_peak.max(beside[1]);
            }
        }
        found
    }
}

/// The margins of a loop at one place.
#[must_use]
pub fn margins(plant: &Plant, gains: &Gains) -> Margins {
    Servos::new(plant, gains).margins(plant, &Enough::NOTHING)
}

impl Margins {
    /// Whether the loop is stable and keeps Ms.
    #[must_use]
    pub fn are_sound(&self, most_ms: f64) -> bool {
        self.is_stable && self.ms <= most_ms
    }

    /// The worse of each.
    #[must_use]
    pub fn worse(self, other: Self) -> Self {
        let (ms, ms_hz) = if other.ms > self.ms {
            (other.ms, other.ms_hz)
        } else {
            (self.ms, self.ms_hz)
        };
        Self {
            is_stable: self.is_stable && other.is_stable,
            ms,
            ms_hz,
            rejection: self.rejection.max(other.rejection),
            crossover_hz: self.crossover_hz.min(other.crossover_hz),
            resonance_peak: self.resonance_peak.max(other.resonance_peak),
        }
    }
}

/// The largest singular value: what becomes of the worst direction.
#[must_use]
pub fn worst_direction(m: &Matrix3<Complex<f64>>) -> f64 {
    largest_singular(m)
}

/// Whether the way from one number to the next, the shorter one about 0, goes over the negative real axis: 1 counterclockwise, -1 clockwise, else 0.
/// Their sum says how often a curve that begins at 1 goes round 0.
fn crossing(from: Complex<f64>, to: Complex<f64>) -> i32 {
    let turns_left = from.re * to.im > from.im * to.re;
    match (from.im < 0.0, to.im < 0.0) {
        (false, true) if turns_left => 1,
        (true, false) if !turns_left => -1,
        _ => 0,
    }
}

/// Determinant, and the diagonal of the adjugate: their quotients are the diagonal of the inverse.
fn determinant_and_adjugate(m: &Matrix3<Complex<f64>>) -> (Complex<f64>, [Complex<f64>; 3]) {
    let minor = |i: usize, j: usize| m[(i, i)] * m[(j, j)] - m[(i, j)] * m[(j, i)];
    (m.determinant(), [minor(1, 2), minor(0, 2), minor(0, 1)])
}

fn least_singular(m: &Matrix3<Complex<f64>>) -> f64 {
    singular_squares(m)[2].max(0.0).sqrt()
}

fn largest_singular(m: &Matrix3<Complex<f64>>) -> f64 {
    singular_squares(m)[0].max(0.0).sqrt()
}

/// Eigenvalues of `m* m`, the largest first: of a Hermitian matrix of three in closed form (Smith, Communications of the ACM 4(4), 1961).
fn singular_squares(m: &Matrix3<Complex<f64>>) -> [f64; 3] {
    let columns = [0, 1, 2].map(|j| m.column(j));
    let squares = columns.map(|column| column.norm_squared());
    let [a, b, c] = [(0, 1), (0, 2), (1, 2)].map(|(i, j)| columns[i].dotc(&columns[j]));
    let mean = squares.iter().sum::<f64>() / 3.0;
    let along = squares.map(|square| square - mean);
    let beside = [a, b, c].map(|product| product.norm_sqr());
    let spread = ((along.iter().map(|x| x * x).sum::<f64>() + 2.0 * beside.iter().sum::<f64>())
        / 6.0)
        .sqrt();
    if !(spread > 1e-14 * mean) {
        return [mean; 3];
    }
    let determinant = along.iter().product::<f64>() + 2.0 * (a * c * b.conj()).re
        - along[0] * beside[2]
        - along[1] * beside[1]
        - along[2] * beside[0];
    let third = (0.5 * determinant / spread.powi(3)).clamp(-1.0, 1.0).acos() / 3.0;
    let [most, least] = [third, third + TAU / 3.0].map(|angle| mean + 2.0 * spread * angle.cos());
    [most, 3.0 * mean - most - least, least]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn singular_values_are_those_of_a_decomposition() {
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        for _ in 0..200 {
            let m = Matrix3::from_fn(|_, _| Complex::new(random(), random()));
            let expected = m.singular_values();
            assert!((largest_singular(&m) - expected.max()).abs() < 1e-9);
            assert!(
                (least_singular(&m) - expected.min()).abs() < 1e-7,
                "{} {}",
                least_singular(&m),
                expected.min()
            );
        }
    }
}
