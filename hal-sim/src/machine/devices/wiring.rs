//! Which plug is in which socket: bridges to motors, encoders to ports.

use super::bridge::BridgeState;
use crate::machine::plant::AXES;
use serde::{Deserialize, Serialize};

/// How the three motors and encoders are wired to the controller. Rings, bridges and ports are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WiringParameters {
    /// The bridge that drives each ring.
    pub bridge_of_ring: [u8; AXES],
    /// Whether the leads of each ring's motor are exchanged.
    pub leads_exchanged: [bool; AXES],
    /// The port that each ring's encoder is at.
    pub port_of_ring: [u8; AXES],
}

impl WiringParameters {
    /// As they belong.
    pub const REFERENCE: Self = Self {
        bridge_of_ring: [0, 1, 2],
        leads_exchanged: [false; AXES],
        port_of_ring: [0, 1, 2],
    };

    /// What the bridges' pins are for the motors of the rings: a motor whose leads are exchanged turns the other way.
    #[must_use]
    pub fn at_rings(&self, bridges: [BridgeState; AXES]) -> [BridgeState; AXES] {
        [0, 1, 2].map(|ring| {
            let bridge = bridges[self.bridge_of(ring)];
            BridgeState {
                forward: bridge.forward != self.leads_exchanged[ring],
                ..bridge
            }
        })
    }

    /// Currents of the rings' motors as the bridges' sensors see them.
    #[must_use]
    pub fn at_bridges(&self, rings_a: [f64; AXES]) -> [f64; AXES] {
        let mut bridges_a = [0.0; AXES];
        for (ring, current_a) in rings_a.into_iter().enumerate() {
            let sign = if self.leads_exchanged[ring] {
                -1.0
            } else {
                1.0
            };
            bridges_a[self.bridge_of(ring)] = sign * current_a;
        }
        bridges_a
    }

    /// The bridge that drives a ring.
    #[must_use]
    pub const fn bridge_of(&self, ring: usize) -> usize {
        place(self.bridge_of_ring[ring])
    }

    /// The ring whose encoder is at a port.
    #[must_use]
    pub fn ring_at_port(&self, port: usize) -> usize {
        let found = self.port_of_ring.iter().position(|&at| place(at) == port);
        found.unwrap_or(port)
    }

    /// The ring whose motor a bridge drives.
    #[must_use]
    pub fn ring_of_bridge(&self, bridge: usize) -> usize {
        let found = self
            .bridge_of_ring
            .iter()
            .position(|&by| place(by) == bridge);
        found.unwrap_or(bridge)
    }
}

/// What a file may have is 0 to 2.
const fn place(number: u8) -> usize {
    (number as usize) % AXES
}

#[cfg(test)]
mod tests {
    use super::*;

    const MIXED: WiringParameters = WiringParameters {
        bridge_of_ring: [2, 0, 1],
        leads_exchanged: [false, true, false],
        port_of_ring: [1, 2, 0],
    };

    #[test]
    fn plugs_go_where_they_are_said_to() {
        let bridge = |pulse: f64| BridgeState {
            pulse,
            forward: true,
            awake: true,
            fault: false,
        };
        let rings = MIXED.at_rings([bridge(0.1), bridge(0.2), bridge(0.3)]);
        assert_eq!(rings.map(|ring| ring.pulse), [0.3, 0.1, 0.2]);
        assert_eq!(rings.map(|ring| ring.forward), [true, false, true]);
        assert_eq!(MIXED.at_bridges([1.0, 2.0, 3.0]), [-2.0, 3.0, 1.0]);
        assert_eq!([0, 1, 2].map(|port| MIXED.ring_at_port(port)), [2, 0, 1]);
        assert_eq!(
            [0, 1, 2].map(|bridge| MIXED.ring_of_bridge(bridge)),
            [1, 2, 0]
        );
        assert_eq!([0, 1, 2].map(|ring| MIXED.bridge_of(ring)), [2, 0, 1]);
    }

    #[test]
    fn as_they_belong_nothing_changes() {
        let wiring = WiringParameters::REFERENCE;
        assert_eq!(wiring.at_bridges([1.0, -2.0, 3.0]), [1.0, -2.0, 3.0]);
        assert_eq!([0, 1, 2].map(|port| wiring.ring_at_port(port)), [0, 1, 2]);
    }
}
