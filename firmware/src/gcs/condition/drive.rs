//! What one drive's currents tell.
//!
//! The servo learns from the measured current what its motor constant at the ring is more than the model has it (`control::servo`): x. With
//! a motor constant that is off by dK, a current sensor by b and a winding of resistance R it comes to `x = dK - R b / rate`: dK is
//! the same both ways of turning, b is not.
//!
//! The current of the servo's model is as large as the measured one where it goes with the rate. What accelerates a pivot brakes it too: over
//! a way that ends as fast as it began nothing of that is left in its mean, and the torque that is left is friction's.

use crate::control::ServoReport;
use crate::control::units::UNITS_PER_RAD;
use crate::parameters::Drive;
use kinematics::Angle;

/// Rate from which on a current tells of the motor constant, rad/s: below, friction and resistance decide what flows.
const LEAST_RATE_RAD_S: f32 = 1.0;
/// How long it has to turn one way like that before the servo has learnt it, s: three times its time constant at that rate.
const LEARNT_AFTER_S: f32 = 0.06;
/// Time each way that a finding is made of, s.
const FOUND_AFTER_S: f32 = 0.5;
/// Longest time from one look to the next, s: in a longer one it may have turned back and again.
const LONGEST_LOOK_S: f32 = 0.02;

/// What a drive is found to be, in the order of [`DriveQuantity`](super::watch::DriveQuantity).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DriveCondition {
    /// Motor constant over the parameter's.
    pub motor_constant_ratio: f32,
    /// What the current sensor reads more than flows, A.
    pub current_offset_a: f32,
    /// Friction besides the parameters', at the ring, N m: the guides' is among it.
    pub more_friction_n_m: f32,
}

/// What has been seen of a drive since the last finding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct DriveWatch {
    last: Option<(u64, Angle)>,
    /// How long it has turned one way without a pause, s; negative the other way.
    turned_s: f32,
    forward: OneWay,
    backward: OneWay,
}

/// Sums over the time in which it turns one way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct OneWay {
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
    /// Looks at its pivot once more; whether enough has been seen for a finding.
    pub fn look(&mut self, tick: u64, angle: Angle, servo: &ServoReport, period_s: f32) -> bool {
        let Some((last_tick, last_angle)) = self.last.replace((tick, angle)) else {
            return false;
        };
        let seconds = tick.wrapping_sub(last_tick) as f32 * period_s;
        let way_rad = ((angle - last_angle).units() as f64 / UNITS_PER_RAD) as f32;
        let turns = way_rad.abs() > LEAST_RATE_RAD_S * seconds;
        if !turns || seconds > LONGEST_LOOK_S || self.turned_s * way_rad < 0.0 {
            // Nothing is found in the middle of a way: what has accelerated it would be taken for friction.
            self.turned_s = 0.0;
            let ways = [&self.forward, &self.backward];
            return ways.iter().all(|way| way.learnt.seconds > FOUND_AFTER_S);
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
        false
    }

    /// What it is found to be; begins anew.
    pub fn find(&mut self, drive: &Drive) -> DriveCondition {
        let forward = core::mem::take(&mut self.forward);
        let backward = core::mem::take(&mut self.backward);
        let [rate, volts] = forward.learnt.means();
        let [back_rate, back_volts] = backward.learnt.means();
        let excess = (volts - back_volts) / (rate - back_rate);
        let modelled = (drive.torque_constant_n_m_a * drive.gear_ratio) as f32;
        // Half of what the ways are apart.
        let [mean_rate, mean_knees] = {
            let (forward, backward) = (forward.all.means(), backward.all.means());
            [0, 1].map(|i| 0.5 * (forward[i] - backward[i]))
        };
        let torque_n_m = (modelled + excess) * mean_knees * drive.dead_time_knee_a as f32;
        let known_n_m = drive.coulomb_n_m as f32 + drive.viscous_n_m_s as f32 * mean_rate;
        DriveCondition {
            motor_constant_ratio: 1.0 + excess / modelled,
            current_offset_a: (excess * rate - volts) / drive.resistance_ohm as f32,
            more_friction_n_m: torque_n_m - known_n_m,
        }
    }
}

impl Sums {
    fn add(&mut self, seconds: f32, way_rad: f32, value: f32) {
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
    use crate::parameters::Parameters;

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
        fn found(&self, rates_rad_s: [f32; 2], drive: &Drive) -> Option<DriveCondition> {
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
                if watch.look(look * LOOK, angle, &servo, PERIOD_S) {
                    return Some(watch.find(drive));
                }
            }
            None
        }
    }

    #[test]
    fn what_is_wrong_is_found_and_nothing_else() {
        let drive = &Parameters::REFERENCE.drives[0];
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
            let found = machine.found([5.0, -3.0], drive).expect("it turns enough");
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
        let drive = &Parameters::REFERENCE.drives[0];
        let machine = Machine {
            motor_constant_ratio: 0.5,
            current_offset_a: 1.0,
            more_friction_n_m: 5.0,
        };
        assert_eq!(machine.found([0.99, -0.99], drive), None);
        assert_eq!(machine.found([5.0, 5.0], drive), None);
        assert_eq!(machine.found([5.0, -0.99], drive), None);
    }
}
