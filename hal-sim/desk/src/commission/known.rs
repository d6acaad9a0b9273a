//! What is known of the machine so far.

use super::bench::Bench;
use super::id::{self, AXES};
use super::measured_loop::MeasuredLoop;
use super::sines::Excited;
use crate::record::RecordError;
use commissioning::drive_model::DriveModel;
use commissioning::friction::MotorConstant;
use commissioning::platform::Platform;

/// What the steps have found; each uses what those before it did.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Known {
    /// Whether the encoder at each port counts down when the platform turns left.
    pub reversed_at_port: [bool; AXES],
    /// Whether the pivots of ports 1, 2, 3 follow each other to the left.
    pub ports_follow_left: bool,
    /// The encoder port of each bridge's pivot, counted from 0.
    pub port_of_bridge: [usize; AXES],
    /// Whether a positive voltage of each bridge turns its pivot to the right.
    pub reversed_at_bridge: [bool; AXES],
    /// Encoder ports of pivots 1, 2, 3, counted from 0.
    pub ports: [usize; AXES],
    /// Bridges of pivots 1, 2, 3, counted from 0.
    pub bridges: [usize; AXES],
    /// Windings of the pivots' motors: ohm, H.
    pub windings: [[f64; 2]; AXES],
    /// Motor constants of the pivots' motors, at their rings.
    pub motor_constants: [MotorConstant; AXES],
    /// Whether drives are known from before, and only the load is another.
    pub is_loaded_anew: bool,
    /// What may stand on the platform besides what is on it, at most, kg.
    pub also_carries_kg: f64,
    /// Drives, rings and platform.
    pub model: Option<DriveModel>,
    /// What is carried, as the moves of `forces` tell it.
    pub platform: Option<Platform>,
    /// What was recorded for it in the middle.
    pub excited: Option<Excited>,
    /// Loops as measured, with the gains in force.
    pub loops: Vec<MeasuredLoop>,
}

impl Known {
    /// Torque at the ring for each ampere of a pivot's motor, N m/A.
    pub(super) fn motor_constant(&self, pivot: usize) -> f64 {
        let [resistance_ohm, _] = self.windings[pivot];
        self.motor_constants[pivot].with(resistance_ohm)
    }

    /// What a controller has been told by an earlier commissioning.
    pub(super) fn of_controller(bench: &mut Bench<'_>) -> Result<Self, RecordError> {
        let mut known = Self {
            ports: Self::order(bench.parameter(id::ENCODER_ORDER)?),
            bridges: Self::order(bench.parameter(id::BRIDGE_ORDER)?),
            ..Self::default()
        };
        known.ports_follow_left = known.ports[1] == (known.ports[0] + 1) % AXES;
        for pivot in 0..AXES {
            let (port, bridge) = (known.ports[pivot], known.bridges[pivot]);
            let number = pivot as u32;
            known.port_of_bridge[bridge] = port;
            known.reversed_at_port[port] = bench.parameter(id::ENCODER_REVERSED + number)? != 0.0;
            known.reversed_at_bridge[bridge] = bench.parameter(id::MOTOR_REVERSED + number)? != 0.0;
            known.windings[pivot] = [
                bench.parameter(id::of(id::RESISTANCE, pivot))?,
                bench.parameter(id::of(id::INDUCTANCE, pivot))?,
            ];
            known.motor_constants[pivot] = MotorConstant::known(
                bench.parameter(id::of(id::TORQUE_CONSTANT, pivot))?
                    * bench.parameter(id::of(id::GEAR_RATIO, pivot))?,
            );
        }
        Ok(known)
    }

    /// An order of connectors from its digits: 231 is the second, the third, the first.
    fn order(digits: f64) -> [usize; AXES] {
        [100.0, 10.0, 1.0].map(|place| ((digits / place) as usize % 10).clamp(1, AXES) - 1)
    }

    /// Digits of an order, as the parameters have them.
    pub(super) fn digits(order: &[usize; AXES]) -> f64 {
        order.iter().fold(0.0, |digits, connector| {
            10.0 * digits + *connector as f64 + 1.0
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_order_is_that_of_its_digits() {
        for order in [[0, 1, 2], [1, 2, 0], [2, 1, 0]] {
            assert_eq!(Known::order(Known::digits(&order)), order);
        }
        // Nothing that a parameter could not be makes an index that is none.
        assert_eq!(Known::order(907.0), [2, 0, 2]);
    }
}
