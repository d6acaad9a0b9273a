//! Gains and filters for a machine: the best rejection of what is slow, at margins that are kept at every place and with every load.
//!
//! For a shape of the servo the velocity gain goes as high as the limits allow; the shape is changed a number at a time until nothing more is won.
//! Position gain and corner of the integral go with the velocity gain, so that a slower servo is the same with time stretched, and small
//! gains are safe.
//!
//! | file | idea |
//! |---|---|
//! | `servo` | the servo of a pivot as a frequency response |
//! | `plant` | what the servos see |
//! | `margins` | sensitivity and stability of the three loops together |

mod margins;
mod plant;
mod servo;

pub use margins::{BEYOND, Gains, Margins, REJECTION_HZ, margins, sensitivity};
pub use plant::{Plant, angle_by_volts, grid};
pub use servo::{Lead, Notch, PivotGains};

use crate::drive_model::Electrical;
use crate::record::Timing;
use std::f64::consts::TAU;

/// What must be kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest singular value of the sensitivity.
    pub ms: f64,
    /// Largest peak of the loop beyond its crossover.
    pub resonance_peak: f64,
    /// Share of the velocity gain that would just keep them.
    pub share: f64,
}

impl Limits {
    /// Ms of 1.9, -6 dB at resonances, all of the gain.
    pub const USUAL: Self = Self {
        ms: 1.9,
        resonance_peak: 0.5,
        share: 1.0,
    };
}

/// Gains, and what they are predicted to give at the worst place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuned {
    /// The gains.
    pub gains: Gains,
    /// Worst of all places and loads.
    pub margins: Margins,
}

/// Why there are no gains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TuningError {
    /// No plants.
    #[error("no plant to tune for: give at least the one in the middle of the disk")]
    NoPlant,
    /// Not even small gains keep the limits.
    #[error("not even small gains keep the limits: look at the model's resonances and their damping")]
    NotEvenSmall,
}

/// Ranges of the parameters, and where the search starts.
const VELOCITY: [f64; 2] = [0.2, 500.0];
const POSITION: [f64; 2] = [1.0, 2_000.0];
const CORNER: [f64; 2] = [1.0, 2_000.0];
const LEAD_TO_HZ: f64 = 3_000.0;
/// Halvings of a step of the velocity gain; rounds over the shape, and the step of the first, as a logarithm.
const HALVINGS: usize = 9;
const ROUNDS: usize = 7;
const FIRST_STEP: f64 = 0.4;

/// Position gain and corner of the integral over the corner of the velocity loop, and two notches as frequency, width over frequency, gain.
type Shape = [f64; 8];

/// Gains for plants at several places and with several loads. `resonances_hz`: where the first two notches are tried, from the model
/// in the middle of the disk ([`crate::chain::Chain::resonances_hz`]). `scheduled_inertia_kg_m2`: what the gains are for, or 0.
///
/// # Errors
/// [`TuningError`].
pub fn tune(
    plants: &[Plant],
    electrical: &[Electrical; 3],
    resonances_hz: &[f64],
    scheduled_inertia_kg_m2: f64,
    timing: &Timing,
    limits: &Limits,
) -> Result<Tuned, TuningError> {
    if plants.is_empty() {
        return Err(TuningError::NoPlant);
    }
    let search = Search {
        plants,
        electrical,
        scheduled_inertia_kg_m2,
        tick_s: timing.tick_s,
        limits,
    };
    let best = starts(resonances_hz)
        .into_iter()
        .filter_map(|shape| search.best_velocity(&shape).map(|found| (found.margins.rejection, shape)))
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let (mut rejection, mut shape) = best.ok_or(TuningError::NotEvenSmall)?;
    let mut step = FIRST_STEP;
    for _ in 0..ROUNDS {
        let before = rejection;
        for k in 0..shape.len() {
            for sign in [1.0, -1.0] {
                let mut next = shape;
                // A notch's place is known better than a gain.
                let share = if k == 2 || k == 5 { 0.25 } else { 1.0 };
                next[k] *= f64::exp(sign * step * share);
                if let Some(found) = search.best_velocity(&next)
                    && found.margins.rejection < rejection
                {
                    (rejection, shape) = (found.margins.rejection, next);
                    break;
                }
            }
        }
        if rejection > 0.97 * before {
            step *= 0.5;
        }
    }
    let found = search.best_velocity(&shape).ok_or(TuningError::NotEvenSmall)?;
    let mut gains = found.gains;
    gains.pivots = gains.pivots.map(|pivot| pivot.scaled(limits.share));
    let margins = search.margins(&gains);
    Ok(Tuned { gains, margins })
}

/// Shapes to start from: notches at each pair of resonances, or where they may have moved to at another place.
fn starts(resonances_hz: &[f64]) -> Vec<Shape> {
    let mut places: Vec<f64> = Vec::new();
    for &hz in resonances_hz {
        if places.iter().all(|place| (hz / place).ln().abs() > 0.08) {
            places.push(hz);
        }
    }
    let mut starts = Vec::new();
    for (k, &first) in places.iter().enumerate() {
        for &second in places.iter().skip(k) {
            let spread = if first == second { 1.09 } else { 1.0 };
            for (position, corner) in [(0.25, 0.2), (0.4, 0.4)] {
                starts.push([position, corner, first / spread, 0.4, 0.2, second * spread, 0.4, 0.2]);
            }
        }
    }
    starts
}

struct Search<'a> {
    plants: &'a [Plant],
    electrical: &'a [Electrical; 3],
    scheduled_inertia_kg_m2: f64,
    tick_s: f64,
    limits: &'a Limits,
}

impl Search<'_> {
    fn gains(&self, shape: &Shape, velocity: f64) -> Gains {
        let [position, corner, f1, w1, g1, f2, w2, g2] = *shape;
        let notch = |hz: f64, width: f64, gain: f64| Notch {
            frequency_hz: hz.clamp(10.0, 9_000.0),
            width_hz: (hz * width.min(2.0)).clamp(1.0, 9_000.0),
            gain: gain.clamp(0.02, 1.0),
        };
        let volts_per_torque = |drive: &Electrical| drive.resistance_ohm / drive.motor_constant;
        let first = volts_per_torque(&self.electrical[0]);
        let inertia = match self.scheduled_inertia_kg_m2 {
            scheduled if scheduled > 0.0 => scheduled,
            _ => self.plants[0].inertia[0],
        };
        let velocity_1_s = velocity / (first * inertia);
        let pivots = self.electrical.map(|drive| {
            // A motor that takes more volts for its torque gets more.
            let velocity_v_s_rad = velocity * volts_per_torque(&drive) / first;
            PivotGains {
                velocity_v_s_rad,
                position_1_s: (position * velocity_1_s).clamp(POSITION[0], POSITION[1]),
                integral_v_rad: velocity_v_s_rad * (corner * velocity_1_s).clamp(CORNER[0], CORNER[1]),
                notches: [notch(f1, w1, g1), notch(f2, w2, g2)],
                lead: Lead {
                    from_hz: drive.resistance_ohm / drive.inductance_h / TAU,
                    to_hz: LEAD_TO_HZ,
                },
            }
        });
        Gains {
            pivots,
            scheduled_inertia_kg_m2: self.scheduled_inertia_kg_m2,
        }
    }

    fn margins(&self, gains: &Gains) -> Margins {
        let mut all = self.plants.iter().map(|plant| margins(plant, gains, self.tick_s));
        let first = all.next().unwrap_or_else(|| unreachable!("there is a plant"));
        all.fold(first, Margins::worse)
    }

    fn keeps(&self, margins: &Margins) -> bool {
        margins.is_stable && margins.ms <= self.limits.ms && margins.resonance_peak <= self.limits.resonance_peak
    }

    /// The largest velocity gain that keeps the limits.
    fn best_velocity(&self, shape: &Shape) -> Option<Tuned> {
        let [mut low, mut high] = VELOCITY.map(f64::ln);
        let mut best = None;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let gains = self.gains(shape, middle.exp());
            let margins = self.margins(&gains);
            if self.keeps(&margins) {
                low = middle;
                best = Some(Tuned { gains, margins });
            } else {
                high = middle;
            }
        }
        best
    }
}
