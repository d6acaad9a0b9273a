//! What the machine really does in a run, and when an effect passes its threshold: judged from the plant, not from what
//! the controller believes.

use core::f64::consts::TAU;

use firmware::control::SubdivisionTable;
use firmware::parameters::{EncoderMounting, Parameters};
use kinematics::{Pose, direct, inverse};

use crate::machine::devices::biss::COUNTS_PER_TURN;
use crate::machine::plant::{AXES, Plant};

/// 2^-32 turns or track radii in one.
const UNITS: f64 = 4_294_967_296.0;

/// How far a guide is pressed into its end stop, mm; 0 where none is.
#[must_use]
pub fn overrun_mm(plant: &Plant) -> f64 {
    let [inner_m, outer_m] = plant.parameters().guide_range_m;
    (plant.rhos_m().into_iter())
        .map(|rho_m| (inner_m - rho_m).max(rho_m - outer_m))
        .fold(0.0, f64::max)
        * 1e3
}

/// Where the platform's centre is by the true angles of its rings, mm, on a machine that is built as drawn: what the geometry of this
/// one is off the drawing is nothing that a fault does.
#[must_use]
pub fn place_mm(plant: &Plant) -> [f64; 2] {
    let radius_mm = plant.parameters().track_radius_m * 1e3;
    match direct::<f64>(&plant.pivots_rad()) {
        Ok(pose) => [pose.x * radius_mm, pose.y * radius_mm],
        // Torn out of its guides: its true place is far enough off.
        Err(_) => {
            let [x_m, y_m, _] = plant.pose();
            [x_m * 1e3, y_m * 1e3]
        }
    }
}

/// Largest rate of a pivot, rad/s.
#[must_use]
pub fn fastest_rad_s(plant: &Plant) -> f64 {
    plant
        .pivot_rates_rad_s()
        .map(f64::abs)
        .into_iter()
        .fold(0.0, f64::max)
}

/// Angles of the pivots' setpoints, turns: of a pose in the controller's integers. Whole turns are left out.
#[must_use]
pub fn setpoint_turns(setpoint: [i64; 3]) -> [f64; AXES] {
    let [x, y, theta] = setpoint.map(|units| units as f64 / UNITS);
    let pose = Pose {
        x,
        y,
        theta: theta.fract() * TAU,
    };
    inverse(&pose).map_or([f64::NAN; AXES], |inverse| {
        inverse.pivots.map(|rad| rad / TAU)
    })
}

/// What the controller takes from an encoder's readings: the error within a period of the scale that it was told.
pub struct Subdivided(SubdivisionTable);

/// Binary places of a reading behind its counts.
const PLACES: u32 = u32::BITS - COUNTS_PER_TURN.ilog2();

impl Subdivided {
    /// Of all encoders.
    #[must_use]
    pub fn all(parameters: &Parameters) -> [Self; AXES] {
        [0, 1, 2].map(|i| Self(SubdivisionTable::new(&parameters.subdivision[i])))
    }

    /// A reading without it, to the nearest count.
    #[must_use]
    pub fn corrected(&self, counts: u32) -> u32 {
        let reading = self.0.corrected(counts << PLACES);
        reading.wrapping_add(1 << (PLACES - 1)) >> PLACES
    }
}

/// Least cosine of a pivot's angle to its guide on the disk.
const LEAST_COSINE: f64 = 0.6;

/// The most that the controller lets a pivot lead its setpoint by, since its guide gives way, rad: to the platform at the largest acceleration of a pivot
/// and to the friction of the other two.
#[must_use]
pub fn most_lead_rad(parameters: &Parameters) -> f64 {
    let (guides, platform) = (&parameters.guides, &parameters.platform);
    if guides.stiffness_n_um == 0.0 {
        return 0.0;
    }
    let radius_m = parameters.geometry.radius_mm * 1e-3;
    let acceleration_m_s2 = parameters.limits.pivot_acceleration_rad_s2 * radius_m;
    let force_n =
        (platform.mass_kg + platform.payload_kg) * acceleration_m_s2 + 2.0 * guides.coulomb_n;
    force_n / (guides.stiffness_n_um * 1e6 * radius_m * LEAST_COSINE)
}

/// Distances of what the controller takes the encoders to show from the setpoints of their pivots, rad.
#[must_use]
pub fn shown_errors_rad(
    counts: &[u32; AXES],
    parameters: &Parameters,
    setpoint: [i64; 3],
) -> [f64; AXES] {
    let wanted = setpoint_turns(setpoint);
    [0, 1, 2].map(|i| {
        let shown = shown_turns(&parameters.encoders[i], counts[i]);
        let off = shown - wanted[i];
        (off - off.round()).abs() * TAU
    })
}

fn shown_turns(setup: &EncoderMounting, counts: u32) -> f64 {
    let turned = counts.wrapping_sub(setup.zero_counts) % COUNTS_PER_TURN;
    let turns = f64::from(turned) / f64::from(COUNTS_PER_TURN);
    if setup.reversed { -turns } else { turns }
}

/// Places of a path, and how far others lie from it, mm.
#[derive(Clone, Debug, Default)]
pub struct Path(Vec<[f64; 2]>);

impl Path {
    /// The path goes on to here.
    pub fn go(&mut self, place: [f64; 2]) {
        if self.0.last() != Some(&place) {
            self.0.push(place);
        }
    }

    /// Distance from the nearest point of the path.
    #[must_use]
    pub fn distance(&self, place: [f64; 2]) -> f64 {
        let from = |point: [f64; 2]| (place[0] - point[0]).hypot(place[1] - point[1]);
        let alone = self.0.first().map_or(0.0, |&point| from(point));
        (self.0.windows(2)).fold(alone, |nearest, ends| {
            let (a, b) = (ends[0], ends[1]);
            let along = [b[0] - a[0], b[1] - a[1]];
            let length = along[0] * along[0] + along[1] * along[1];
            let part = ((place[0] - a[0]) * along[0] + (place[1] - a[1]) * along[1]) / length;
            let part = part.clamp(0.0, 1.0);
            nearest.min(from([a[0] + part * along[0], a[1] + part * along[1]]))
        })
    }

    /// Its length.
    #[must_use]
    pub fn length(&self) -> f64 {
        (self.0.windows(2))
            .map(|ends| (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1]))
            .fold(0.0, |sum, length| sum + length)
    }
}
