//! A plan in words and numbers.

use core::ops::RangeInclusive;

use calibration::{Instrument, Noise, Plan};
use kinematics::Geometry;
use serde::Serialize;

use super::line::{Line, URAD_PER_RAD, nm};

/// Poses that a plan may have.
pub const POSES: RangeInclusive<usize> = 12..=3000;
/// Noise that an instrument may have, m and rad: from an atom to 1 mm, or from 0.1 nrad to 1 mrad.
pub const NOISES: RangeInclusive<f64> = 1e-10..=1e-3;
/// Length over which theta is measured, m, unless its noise is told: two beams of an interferometer.
const BASE_M: f64 = 0.05;

/// Of an instrument that measures a length so well, m, and an angle, rad.
#[must_use]
pub fn noise(length_m: f64, angle_rad: Option<f64>) -> Noise {
    let radius_m = Geometry::REFERENCE.radius_mm * 1e-3;
    Noise {
        length: length_m / radius_m,
        angle_rad: angle_rad.unwrap_or(length_m / BASE_M),
        encoder_rad: Noise::ENCODER_RAD,
    }
}

/// What a plan is told as.
#[derive(Clone, Debug, Serialize)]
pub struct PlanTold {
    /// The instrument.
    pub kit: &'static str,
    /// Noise of a length.
    pub noise_nm: f64,
    /// Noise of an angle.
    pub noise_urad: f64,
    /// How many.
    pub poses: usize,
    /// What is expected of x and y together, rms.
    pub expected_xy_nm: f64,
    /// The same where it is worst.
    pub expected_worst_xy_nm: f64,
    /// Where that is: x, y (mm), theta (deg).
    pub worst_pose: [f64; 3],
    /// What is expected of theta, rms.
    pub expected_theta_urad: f64,
    /// Freedoms that are whoever's who measures: frames, scale.
    pub yours_to_choose: Vec<String>,
    /// What the instrument does not see.
    pub not_identifiable: Vec<String>,
    /// The same, without a name.
    pub more_not_identifiable: usize,
    /// Numbers of which the poses tell less than a workshop's tolerances do.
    pub held_by_tolerances: usize,
    /// All numbers.
    pub numbers: usize,
}

impl PlanTold {
    /// Of this plan.
    #[must_use]
    pub fn new(instrument: &Instrument, plan: &Plan) -> Self {
        let named = |is_choice: bool| {
            let freedoms = plan.freedoms.named.iter();
            let wanted = freedoms.filter(|freedom| freedom.is_choice() == is_choice);
            wanted.map(ToString::to_string).collect::<Vec<_>>()
        };
        let accuracy = &plan.accuracy;
        Self {
            kit: instrument.kit.name(),
            noise_nm: nm(instrument.noise.length),
            noise_urad: instrument.noise.angle_rad * URAD_PER_RAD,
            poses: plan.stops.len(),
            expected_xy_nm: nm(accuracy.place_rms),
            expected_worst_xy_nm: nm(accuracy.worst_place_rms),
            worst_pose: in_mm_deg(accuracy.worst_pose),
            expected_theta_urad: accuracy.turn_rms_rad * URAD_PER_RAD,
            yours_to_choose: named(true),
            not_identifiable: named(false),
            more_not_identifiable: plan.freedoms.unnamed(),
            held_by_tolerances: plan.held_by_priors.saturating_sub(plan.freedoms.count),
            numbers: instrument.unknowns(),
        }
    }

    /// In words.
    #[must_use]
    pub fn lines(&self) -> Vec<Line> {
        let [x, y, theta] = self.worst_pose;
        let mut lost = self.not_identifiable.clone();
        if self.more_not_identifiable > 0 {
            lost.push(format!(
                "{} more directions of the machine's numbers",
                self.more_not_identifiable
            ));
        }
        let listed = |list: &[String]| match list {
            [] => "nothing".to_owned(),
            list => list.join("; "),
        };
        [
        Line::new(
            "instrument",
            format!(
                "{}, {} poses, {:.1} nm and {:.3} urad",
                self.kit, self.poses, self.noise_nm, self.noise_urad
            ),
        ),
        Line::new(
            "expected, x and y",
            format!(
                "{:.1} nm rms; {:.1} nm rms where it is worst, at {x:.1} {y:.1} mm {theta:.1} deg",
                self.expected_xy_nm, self.expected_worst_xy_nm
            ),
        ),
        Line::new(
            "expected, theta",
            format!("{:.3} urad rms", self.expected_theta_urad),
        ),
        Line::new("yours to choose", listed(&self.yours_to_choose)),
        Line::new("not identifiable", listed(&lost)),
        Line::new(
            "held by tolerances",
            match self.held_by_tolerances {
                0 => format!("none of {} numbers", self.numbers),
                held => format!(
                    "{held} of {} numbers: too few poses or too much noise to tell more than a workshop keeps",
                    self.numbers
                ),
            },
        ),
    ]
    .into()
    }
}

fn in_mm_deg([x, y, theta_rad]: [f64; 3]) -> [f64; 3] {
    let radius_mm = Geometry::REFERENCE.radius_mm;
    [x * radius_mm, y * radius_mm, theta_rad.to_degrees()]
}
