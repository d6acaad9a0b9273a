//! What the drives bear of a motion: whether the limits of the pivots and the duration of a fault's stop ask of a motor for more than its
//! largest current, or than the supply can give, and which do not.
//!
//! A plan keeps every pivot within its limits of rate w and acceleration a, in an urgent stop too, and whichever point is moved. So a
//! pivot's motor gives at most
//!
//! ```text
//! T = a (J + sum_j |A_ij|) + B + Tc + b w        A = J^-T M J^-1, M the mass matrix of platform and payload
//! K i = T                                        i up to a share of the current limit
//! R i + K w = V                                  R of a hot winding, V what the bridge puts out at most at the nominal supply
//! ```
//!
//! with J the ring's inertia, Tc and b its friction, and B what the platform's speed asks for where no pivot is accelerated. The controlled
//! stop of a fault (`motion/plan/fault_stop`) lets the plan's time run at a rate r that falls to 0 within its duration: `r^2` of the plan's
//! own acceleration, and the speed times `r'`. It may take all of the current limit, and friction and back-EMF help it.
//!
//! All are looked up at places on the edge of the disk, where each of them is most. The platform's speed is its limit, and less where the
//! pivots' rate is in the way; a point far from its centre that is moved in its stead can make it faster: that is left to the reserve.
//!
//! In single precision: whatever is set is looked at on what the tick leaves of the core, which has no double precision, and the watchdog
//! does not wait for long.

use super::config::MAX_DUTY;
use super::inertia::unit_motion;
use super::platform_torque::{Body, friction_torques, platform_torques};
use crate::motion::Limits;
use crate::number;
use crate::parameters::{Drive, Parameters, PowerStage};
use kinematics::{Acceleration, Guide, Twist, guides_along_axes, pivot_motion_in_platform_axes};

/// Share of a motor's largest current that plans may ask for: the rest is the feedback's. On a machine that is known that has ripple
/// to make up for, and what friction varies.
const PLANNED: f64 = 0.95;
/// Resistance of a hot winding over that of a cold one: copper that is 100 K warmer.
const HOT: f64 = 1.4;
/// Places on the edge of the disk, 15 deg apart: between two nothing is more by 2 %.
const PLACES: u16 = 24;
/// Cosine and sine of the angle from one to the next.
const PLACE_STEP: [f32; 2] = [0.965_925_8, 0.258_819_05];
/// Directions that the platform may move in while it turns: the other way round asks for the same.
const DIRECTIONS: u16 = 8;
/// Cosine and sine of the angle from one to the next, 45 deg.
const DIRECTION_STEP: [f32; 2] = [core::f32::consts::FRAC_1_SQRT_2; 2];
/// Instants of a fault's stop, as parts of it, from this one on to its middle: later both parts fall.
const INSTANTS: u16 = 10;
/// What proposals keep off their bounds, for the roundings of single precision.
const ROUNDING: f64 = 1e-4;

/// Limits of motion that the drives bear: those of the parameters where they do, or else the nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BorneLimits {
    /// Rate of a pivot.
    pub rate_rad_s: f64,
    /// Acceleration of a pivot with that rate. Not positive where friction alone takes all that a motor has.
    pub acceleration_rad_s2: f64,
    /// Duration of a fault's controlled stop with both.
    pub stop_s: f64,
}

impl BorneLimits {
    /// Of parameters. What they have and the drives bear is left as it is.
    #[must_use]
    pub fn new(parameters: &Parameters) -> Self {
        let asked = Self::of(parameters);
        let demands = Demands::new(parameters, asked.rate_rad_s);
        let within = |acceleration: f64| asked.acceleration_rad_s2 <= acceleration;
        let borne = if within(demands.acceleration(asked.rate_rad_s)) {
            asked
        } else {
            let rate_rad_s = asked.rate_rad_s.min(full_current_rate(parameters));
            let most = Demands::new(parameters, rate_rad_s).acceleration(rate_rad_s);
            Self {
                rate_rad_s,
                acceleration_rad_s2: asked.acceleration_rad_s2.min(most * (1.0 - ROUNDING)),
                stop_s: asked.stop_s,
            }
        };
        let least_s = Demands::new(parameters, borne.rate_rad_s).stop_s(borne.acceleration_rad_s2);
        let stop_s = if asked.stop_s >= least_s {
            asked.stop_s
        } else {
            least_s * (1.0 + ROUNDING)
        };
        Self { stop_s, ..borne }
    }

    /// What the parameters have, borne or not.
    const fn of(parameters: &Parameters) -> Self {
        Self {
            rate_rad_s: parameters.limits.pivot_rate_rad_s,
            acceleration_rad_s2: parameters.limits.pivot_acceleration_rad_s2,
            stop_s: parameters.supervision.stop_s,
        }
    }

    /// By how much what the parameters have is over what they bear; 1 where it is not.
    #[must_use]
    pub fn excess(&self, parameters: &Parameters) -> f64 {
        let asked = Self::of(parameters);
        if self.acceleration_rad_s2 <= 0.0 {
            return f64::INFINITY;
        }
        (asked.rate_rad_s / self.rate_rad_s)
            .max(asked.acceleration_rad_s2 / self.acceleration_rad_s2)
            .max(self.stop_s / asked.stop_s)
    }

    /// Parameters with these limits.
    #[must_use]
    pub fn applied_to(&self, parameters: &Parameters) -> Parameters {
        let mut applied = parameters.clone();
        applied.limits.pivot_rate_rad_s = self.rate_rad_s;
        applied.limits.pivot_acceleration_rad_s2 = self.acceleration_rad_s2;
        applied.supervision.stop_s = self.stop_s;
        applied
    }
}

/// The largest rate of a pivot at which its motor can still be given all of the current that is planned with, and the largest acceleration with which that
/// current is enough at a rate of at most that, whatever the limits of the parameters are.
#[must_use]
pub fn largest_limits(parameters: &Parameters) -> [f64; 2] {
    let rate = full_current_rate(parameters);
    let used = rate.min(parameters.limits.pivot_rate_rad_s);
    let most = Demands::new(parameters, used).acceleration(used);
    [rate, most * (1.0 - ROUNDING)]
}

/// Whether both ask the same of the drives.
#[must_use]
pub fn ask_the_same(a: &Parameters, b: &Parameters) -> bool {
    let limits = |limits: &Limits| {
        [
            limits.speed_mm_s,
            limits.turn_speed_deg_s,
            limits.pivot_rate_rad_s,
            limits.pivot_acceleration_rad_s2,
        ]
    };
    limits(&a.limits) == limits(&b.limits)
        && a.supervision.stop_s == b.supervision.stop_s
        && a.platform == b.platform
        && a.guides == b.guides
        && a.power == b.power
        && a.drives == b.drives
        && a.geometry == b.geometry
}

/// See [`largest_limits`].
fn full_current_rate(parameters: &Parameters) -> f64 {
    let power = &parameters.power;
    (parameters.drives.iter())
        .map(|drive| {
            let current_a = PLANNED * power.current_limit_a;
            (bridge_v(power) - HOT * drive.resistance_ohm * current_a) / motor_constant(drive)
        })
        .fold(f64::MAX, f64::min)
}

/// What a bridge puts out at most.
fn bridge_v(power: &PowerStage) -> f64 {
    (power.supply_v * MAX_DUTY).min(power.voltage_limit_v)
}

/// At the ring, N m/A and V s/rad.
fn motor_constant(drive: &Drive) -> f64 {
    drive.torque_constant_n_m_a * drive.gear_ratio
}

/// What motion asks of the drives at a rate of the pivots.
struct Demands<'a> {
    parameters: &'a Parameters,
    body: Body,
    radius: f32,
    rate: f32,
    /// Largest speed of the platform's centre and of rotation, track radii and rad.
    speed: [f32; 2],
    /// Friction of a carriage at the largest speed, times the track's radius, N m.
    friction: f32,
}

/// What it asks of a pivot at a place.
#[derive(Clone, Copy, Default)]
struct Demand {
    /// Torque for each rad/s^2 of all pivots.
    inertia: f32,
    /// Torque of the platform's speed alone.
    speed: f32,
    /// Torque, times s, that takes the speed away.
    momentum: f32,
    /// Torque against the friction of the carriages, whichever way they go.
    friction: f32,
}

impl<'a> Demands<'a> {
    fn new(parameters: &'a Parameters, rate_rad_s: f64) -> Self {
        let Parameters { limits, guides, .. } = parameters;
        let radius_m = parameters.geometry.radius_mm * 1e-3;
        // A pivot may go as fast along its guide as it goes on the track, and the platform the other way.
        let along_m_s = limits.speed_mm_s * 1e-3 + rate_rad_s * radius_m;
        Self {
            parameters,
            body: Body::new(parameters),
            radius: parameters.geometry.usable_radius() as f32,
            rate: rate_rad_s as f32,
            speed: [
                (limits.speed_mm_s / parameters.geometry.radius_mm) as f32,
                limits.turn_speed_deg_s.to_radians() as f32,
            ],
            friction: ((guides.coulomb_n + guides.viscous_n_s_m * along_m_s) * radius_m) as f32,
        }
    }

    /// The largest acceleration that is borne.
    fn acceleration(&self, rate_rad_s: f64) -> f64 {
        let Parameters { power, drives, .. } = self.parameters;
        let torques = [0, 1, 2].map(|pivot: usize| {
            let drive = &drives[pivot];
            let constant = motor_constant(drive);
            let volts = bridge_v(power) - constant * rate_rad_s;
            let current_a =
                (PLANNED * power.current_limit_a).min(volts / (HOT * drive.resistance_ohm));
            (constant * current_a - drive.coulomb_n_m - drive.viscous_n_m_s * rate_rad_s) as f32
        });
        let mut least = f32::MAX;
        self.for_each(|pivot, demand| {
            least = least.min((torques[pivot] - demand.speed - demand.friction) / demand.inertia);
        });
        least.into()
    }

    /// The shortest duration of a fault's stop that is borne with this acceleration.
    fn stop_s(&self, acceleration_rad_s2: f64) -> f64 {
        let Parameters { power, drives, .. } = self.parameters;
        let torques = [0, 1, 2]
            .map(|pivot: usize| (motor_constant(&drives[pivot]) * power.current_limit_a) as f32);
        let acceleration = acceleration_rad_s2 as f32;
        let mut longest = 0.0_f32;
        self.for_each(|pivot, demand| {
            let planned = acceleration * demand.inertia + demand.speed;
            for instant in 1..=INSTANTS {
                let u = 0.5 * f32::from(instant) / f32::from(INSTANTS);
                let rate = 1.0 - u * u * (3.0 - 2.0 * u);
                let change = 6.0 * u * (1.0 - u);
                let left = torques[pivot] - planned * rate * rate;
                if left > 0.0 {
                    longest = longest.max(change * demand.momentum / left);
                } else {
                    longest = f32::MAX;
                }
            }
        });
        longest.into()
    }

    /// Goes through all pivots at all places.
    fn for_each(&self, mut look: impl FnMut(usize, &Demand)) {
        let mut place = [self.radius, 0.0];
        for _ in 0..PLACES {
            // The usable disk lies inside the track.
            if let Some(guides) = guides_along_axes(place[0], place[1], number::sqrt_f32) {
                let demands = self.at(&guides);
                for (pivot, demand) in demands.iter().enumerate() {
                    look(pivot, demand);
                }
            }
            place = turned(place, PLACE_STEP);
        }
    }

    fn at(&self, guides: &[Guide<f32>; 3]) -> [Demand; 3] {
        let mut demands = [Demand::default(); 3];
        let (lengths, cosines) = (
            [guides[0].rho(), guides[1].rho(), guides[2].rho()],
            [guides[0].cosine, guides[1].cosine, guides[2].cosine],
        );
        let columns = [0, 1, 2].map(|pivot| unit_motion(&lengths, &cosines, pivot));
        for (pivot, demand) in demands.iter_mut().enumerate() {
            demand.inertia = self.ring_inertia(pivot);
        }
        for column in &columns {
            let torques = self.torques(guides, &Twist::default(), column);
            for (demand, torque) in demands.iter_mut().zip(torques) {
                demand.inertia += torque.abs();
            }
        }
        if self.friction > 0.0 {
            self.add_friction(&lengths, &cosines, &mut demands);
        }
        let mut direction = [self.speed[0], 0.0];
        for _ in 0..DIRECTIONS {
            self.add_speed(guides, &columns, direction, &mut demands);
            direction = turned(direction, DIRECTION_STEP);
        }
        demands
    }

    /// What the carriages' friction asks for, each in the direction that costs a pivot most.
    fn add_friction(&self, lengths: &[f32; 3], cosines: &[f32; 3], demands: &mut [Demand; 3]) {
        for guide in 0..3 {
            let mut friction = [0.0; 3];
            friction[guide] = self.friction;
            let [_, torques] = friction_torques(&friction, lengths, cosines);
            for (demand, torque) in demands.iter_mut().zip(torques) {
                demand.friction += torque.abs();
            }
        }
    }

    /// What the largest speed in a direction, with the largest rotation, asks for.
    #[inline(never)]
    fn add_speed(
        &self,
        guides: &[Guide<f32>; 3],
        columns: &[[f32; 3]; 3],
        [x, y]: [f32; 2],
        demands: &mut [Demand; 3],
    ) {
        let rest = Acceleration::default();
        let twist = |share: f32| Twist {
            x: x * share,
            y: y * share,
            theta: self.speed[1] * share,
        };
        let full = pivot_motion_in_platform_axes(guides, &twist(1.0), &rest).rates;
        let fastest = full
            .iter()
            .fold(self.rate, |most, rate| most.max(rate.abs()));
        let twist = twist(self.rate / fastest);
        let motion = pivot_motion_in_platform_axes(guides, &twist, &rest);
        // The platform's acceleration with which no pivot is accelerated.
        let mut against = [0.0_f32; 3];
        for (column, acceleration) in columns.iter().zip(motion.accelerations) {
            for (sum, part) in against.iter_mut().zip(column) {
                *sum -= acceleration * part;
            }
        }
        let speed = self.torques(guides, &twist, &against);
        let velocity = [twist.x, twist.y, twist.theta];
        let momentum = self.torques(guides, &Twist::default(), &velocity);
        for (pivot, demand) in demands.iter_mut().enumerate() {
            let of_ring = self.ring_inertia(pivot) * motion.rates[pivot];
            demand.speed = demand.speed.max(speed[pivot].abs());
            demand.momentum = demand.momentum.max((momentum[pivot] + of_ring).abs());
        }
    }

    fn torques(&self, guides: &[Guide<f32>; 3], twist: &Twist<f32>, a: &[f32; 3]) -> [f32; 3] {
        let [x, y, theta] = *a;
        platform_torques(&self.body, guides, twist, &Acceleration { x, y, theta })
    }

    fn ring_inertia(&self, pivot: usize) -> f32 {
        self.parameters.drives[pivot].inertia_kg_m2 as f32
    }
}

fn turned([x, y]: [f32; 2], [cos, sin]: [f32; 2]) -> [f32; 2] {
    [x * cos - y * sin, y * cos + x * sin]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the reference stage comes with its motors bear, with little left; from rest, by hand, the largest acceleration of all
    /// pivots takes 5.7 A of 0.06 x 50 N m/A.
    #[test]
    fn the_reference_stage_bears_its_limits() {
        let parameters = Parameters::REFERENCE;
        let borne = BorneLimits::new(&parameters);
        let [rate, acceleration] = largest_limits(&parameters);
        let stop_s = Demands::new(&parameters, 10.0).stop_s(300.0);
        println!("{borne:?} of {rate} rad/s, {acceleration} rad/s^2, {stop_s} s");
        assert_eq!(borne, BorneLimits::of(&parameters));
        assert_eq!(borne.excess(&parameters), 1.0);
        assert!((rate - (48.0 * 0.98 - 1.4 * 2.1 * 5.7) / 3.0).abs() < 1e-9);
        assert!((300.0..315.0).contains(&acceleration));
        assert!((0.025..0.04).contains(&stop_s));
    }

    /// As GCS.md has them.
    #[test]
    fn a_payload_takes_from_the_acceleration() {
        for (kg, acceleration) in [(0.0, 300.0), (1.0, 261.0), (2.0, 222.0), (5.0, 150.0)] {
            let mut parameters = Parameters::REFERENCE;
            parameters.platform.payload_kg = kg;
            let borne = BorneLimits::new(&parameters);
            assert!(
                (borne.acceleration_rad_s2 - acceleration).abs() < 1.0,
                "{borne:?}"
            );
            assert_eq!([borne.rate_rad_s, borne.stop_s], [10.0, 0.06]);
        }
    }

    /// 1 N a carriage on 100 mm, where each of the three costs a pivot most.
    #[test]
    fn friction_of_the_guides_takes_from_the_acceleration() {
        let mut parameters = Parameters::REFERENCE;
        let without = BorneLimits::new(&Parameters::REFERENCE).acceleration_rad_s2;
        let most = largest_limits(&parameters)[1];
        parameters.guides.coulomb_n = 1.0;
        let with = largest_limits(&parameters)[1];
        println!("{without} {most} {with}");
        assert!(!ask_the_same(&parameters, &Parameters::REFERENCE));
        assert!((0.97..0.99).contains(&(with / most)), "{with} of {most}");
        parameters.guides.coulomb_n = 1_000.0;
        assert!(BorneLimits::new(&parameters).acceleration_rad_s2 <= 0.0);
    }
}
