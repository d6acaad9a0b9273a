//! What one drive's currents tell.
//!
//! The servo learns from the measured current what its motor constant at the ring is more than the model has it (`control::servo`): x. With
//! a motor constant that is off by dK, a current sensor by b and a winding of resistance R it comes to `x = dK - R b / rate`: dK is
//! the same both ways of turning, b is not.
//!
//! With x learnt, the model's current is the measured one in the mean of a way, the sensor's offset with it, which two ways of turning take out. What
//! accelerates a pivot brakes it too: over a way that ends as fast as it began nothing of that is left in the mean, and the torque that is left is
//! friction's.

use crate::control::ServoReport;
use crate::control::units::UNITS_PER_RAD;
use crate::parameters::Parameters;
use kinematics::Angle;

/// Rate from which on a current tells of the motor constant, rad/s: below, friction and resistance decide what flows.
const LEAST_RATE_RAD_S: f32 = 1.0;
/// How long it has to turn one way like that before the servo has learnt it, s: three times its time constant at that rate.
const LEARNT_AFTER_S: f32 = 0.06;
/// Time each way that a finding is made of, s.
const FOUND_AFTER_S: f32 = 0.5;
/// What has been seen one way for longer than this, s, is forgotten by halves.
const LONGEST_S: f32 = 10.0;
/// Longest time from one look to the next, s: in a longer one it may have turned back and again.
const LONGEST_LOOK_S: f32 = 0.05;

/// What a drive is found to be, as `LST?` tells it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DriveCondition {
    /// Motor constant over the parameter's.
    pub motor_constant_ratio: f32,
    /// What the current sensor reads more than flows, A.
    pub current_offset_a: f32,
    /// Friction besides that of the parameters, at the ring, N m.
    pub more_friction_n_m: f32,
}

/// What has been seen of a drive since the last finding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct DriveWatch {
    /// The lower half of the tick of the last look, and where it was then, 2^-32 turns.
    last: Option<(u32, u32)>,
    /// How long it has turned one way without a pause, s; negative the other way.
    turned_s: f32,
    forward: OneWay,
    backward: OneWay,
}

/// Sums over the time in which it turns one way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct OneWay {
    all: Sums,
    /// Where the servo has learnt.
    learnt: Sums,
}

/// Time, s; way, rad; and what goes with one of them: the model's current, knees s, or the motor constant's excess, V s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Sums {
    seconds: f32,
    way_rad: f32,
    value: f32,
}

impl DriveWatch {
    /// Looks at its pivot once more, while the servo drives it; what has been seen forward and backward, once that is enough.
    pub fn look(
        &mut self,
        tick: u64,
        angle: Angle,
        servo: &ServoReport,
        rate_hz: f32,
    ) -> Option<[OneWay; 2]> {
        let tick = tick as u32;
        let fraction = angle.fraction();
        let (last_tick, last_fraction) = self.last.replace((tick, fraction))?;
        // No f64 and no division of 64 bits: snapshots come every fourth tick.
        let seconds = tick.wrapping_sub(last_tick) as f32 / rate_hz;
        if seconds > LONGEST_LOOK_S {
            *self = Self::default();
            return None;
        }
        // In so short a time it is less than half a turn.
        let way = fraction.wrapping_sub(last_fraction) as i32;
        let way_rad = way as f32 * (1.0 / UNITS_PER_RAD) as f32;
        let turns = way_rad.abs() > LEAST_RATE_RAD_S * seconds;
        if !turns || self.turned_s * way_rad < 0.0 {
            // Only at the end of a way: in its middle, what has accelerated it would be taken for friction.
            self.turned_s = 0.0;
            return self.seen();
        }
        self.turned_s += seconds.copysign(way_rad);
        let way = if way_rad > 0.0 {
            &mut self.forward
        } else {
            &mut self.backward
        };
        (way.all).add(seconds, way_rad, servo.current_knees * seconds);
        if self.turned_s.abs() > LEARNT_AFTER_S {
            let excess = servo.learnt.motor_constant_excess;
            way.learnt.add(seconds, way_rad, excess * way_rad);
        }
        None
    }

    /// What has been seen, if it is enough; begins anew.
    fn seen(&mut self) -> Option<[OneWay; 2]> {
        let ways = [self.forward, self.backward];
        let is_enough = ways.iter().all(|way| way.learnt.seconds > FOUND_AFTER_S);
        is_enough.then(|| {
            (self.forward, self.backward) = Default::default();
            ways
        })
    }
}

/// What the drive of a pivot is found to be, from what was seen of it.
pub(super) fn find(
    [forward, backward]: [OneWay; 2],
    parameters: &Parameters,
    pivot: usize,
) -> DriveCondition {
    let drive = &parameters.drives[pivot];
    let [rate, volts] = forward.learnt.means();
    let [back_rate, back_volts] = backward.learnt.means();
    let excess = (volts - back_volts) / (rate - back_rate);
    let modelled = (drive.torque_constant_n_m_a * drive.gear_ratio) as f32;
    // Half of what the ways are apart.
    let (forward, backward) = (forward.all.means(), backward.all.means());
    let [mean_rate, mean_knees] = [0, 1].map(|i| 0.5 * (forward[i] - backward[i]));
    let torque_n_m = (modelled + excess) * mean_knees * drive.dead_time_knee_a as f32;
    // Carriages are about as fast on their guides as pivots on the track, one with another.
    let guides_n_m = parameters.guides.coulomb_n * parameters.geometry.radius_mm * 1e-3;
    let known_n_m =
        (drive.coulomb_n_m + guides_n_m) as f32 + drive.viscous_n_m_s as f32 * mean_rate;
    DriveCondition {
        motor_constant_ratio: 1.0 + excess / modelled,
        current_offset_a: (excess * rate - volts) / drive.resistance_ohm as f32,
        more_friction_n_m: torque_n_m - known_n_m,
    }
}

impl Sums {
    fn add(&mut self, seconds: f32, way_rad: f32, value: f32) {
        if self.seconds > LONGEST_S {
            *self = Self {
                seconds: 0.5 * self.seconds,
                way_rad: 0.5 * self.way_rad,
                value: 0.5 * self.value,
            };
        }
        self.seconds += seconds;
        self.way_rad += way_rad;
        self.value += value;
    }

    /// Of the rate and of the value.
    fn means(&self) -> [f32; 2] {
        [self.way_rad, self.value].map(|sum| sum / self.seconds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::servo::Learnt;

    const PERIOD_S: f32 = 50e-6;
    /// Ticks from one look to the next.
    const LOOK: u64 = 3;

    /// A drive that is so, as the servo comes to know it.
    struct Machine {
        motor_constant_ratio: f32,
        current_offset_a: f32,
        more_friction_n_m: f32,
    }

    impl Machine {
        /// Turns to and fro between these rates, as fast at first as at last, until something is found.
        fn found(&self, rates_rad_s: [f32; 2]) -> Option<DriveCondition> {
            let parameters = &Parameters::REFERENCE;
            let drive = &parameters.drives[0];
            let modelled = (drive.torque_constant_n_m_a * drive.gear_ratio) as f32;
            let motor_constant = modelled * self.motor_constant_ratio;
            let mut watch = DriveWatch::default();
            let mut angle = Angle::default();
            for look in 0..40_000_u64 {
                // 0.3 s each way, from rest to rest, faster one way than the other.
                let phase = core::f32::consts::PI / 2_000.0 * (look % 2_000) as f32;
                let way = (look / 2_000 % 2) as usize;
                let rate = rates_rad_s[way] * libm::sinf(phase);
                let acceleration_torque_n_m = 4.0 * libm::cosf(phase) * rates_rad_s[way].signum();
                let step_rad = f64::from(rate * PERIOD_S) * LOOK as f64;
                angle += Angle::from_radians(step_rad).expect("small");
                let friction_n_m = self.more_friction_n_m
                    + drive.coulomb_n_m as f32
                    + drive.viscous_n_m_s as f32 * rate.abs();
                let torque_n_m = acceleration_torque_n_m + friction_n_m.copysign(rate);
                let current_a = torque_n_m / motor_constant;
                let offset_v = drive.resistance_ohm as f32 * self.current_offset_a;
                let excess = motor_constant - modelled - offset_v / rate;
                let servo = ServoReport {
                    learnt: Learnt {
                        motor_constant_excess: if rate == 0.0 { 0.0 } else { excess },
                        ..Learnt::default()
                    },
                    current_knees: current_a / drive.dead_time_knee_a as f32,
                    ..ServoReport::default()
                };
                if let Some(ways) = watch.look(look * LOOK, angle, &servo, 1.0 / PERIOD_S) {
                    return Some(find(ways, parameters, 0));
                }
            }
            None
        }
    }

    #[test]
    fn what_is_wrong_is_found_and_nothing_else() {
        for (motor_constant_ratio, current_offset_a, more_friction_n_m) in [
            (1.0, 0.0, 0.0),
            (0.8, 0.0, 0.0),
            (1.0, 0.5, 0.0),
            (1.0, 0.0, 3.0),
            (1.1, -0.4, 1.0),
        ] {
            let machine = Machine {
                motor_constant_ratio,
                current_offset_a,
                more_friction_n_m,
            };
            let found = machine.found([5.0, -3.0]).expect("it turns enough");
            let off = [
                found.motor_constant_ratio - motor_constant_ratio,
                found.current_offset_a - current_offset_a,
                found.more_friction_n_m - more_friction_n_m,
            ];
            assert!(
                off[0].abs() < 0.002 && off[1].abs() < 0.01 && off[2].abs() < 0.02,
                "{found:?}, {off:?} off"
            );
        }
    }

    #[test]
    fn nothing_is_said_of_a_pivot_that_turns_slowly_or_one_way() {
        let machine = Machine {
            motor_constant_ratio: 0.5,
            current_offset_a: 1.0,
            more_friction_n_m: 5.0,
        };
        assert_eq!(machine.found([0.99, -0.99]), None);
        assert_eq!(machine.found([5.0, 5.0]), None);
        assert_eq!(machine.found([5.0, -0.99]), None);
    }
}
