//! What is known of the machine so far.

use super::measured_loop::MeasuredLoop;
use super::sines::Excited;
use commissioning::drive_model::DriveModel;

/// Pivots, encoder ports, bridges.
pub(super) const AXES: usize = 3;

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
    /// Back-EMF of the pivots' motors for each rad/s of their rings, V s/rad.
    pub motor_constants: [f64; AXES],
    /// Drives, rings and platform.
    pub model: Option<DriveModel>,
    /// What was recorded in the middle for it.
    pub centre: Option<Excited>,
    /// Loops as measured, with the gains in force.
    pub loops: Vec<MeasuredLoop>,
}

impl Known {
    /// Digits of an order, as the parameters have them.
    pub(super) fn digits(order: &[usize; AXES]) -> f64 {
        order.iter().fold(0.0, |digits, connector| {
            10.0 * digits + *connector as f64 + 1.0
        })
    }
}
