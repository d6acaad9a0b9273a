//! From the board's connectors to the pivots, and back: so that no plug has to be moved for a pivot to be what it is called.

use crate::drivers::biss::RawFrame;
use crate::drivers::bridge::Duty;
use crate::parameters::{ConnectorOrder, Wiring};

/// Which connector is which pivot's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WiringConfig {
    encoders: ConnectorOrder,
    bridges: ConnectorOrder,
    /// The pivot of each bridge.
    pivots: ConnectorOrder,
    /// 1, or -1 where a positive voltage turns the ring to smaller angles.
    directions: [i16; 3],
    /// Kept, since the tick asks each time.
    is_straight: bool,
}

impl WiringConfig {
    /// As the parameters have it; straight, where they have no order.
    pub fn new(wiring: &Wiring) -> Self {
        let order = |digits: u16| {
            ConnectorOrder::from_digits(f64::from(digits)).unwrap_or(ConnectorOrder::STRAIGHT)
        };
        let [encoders, bridges] = [wiring.encoder_order, wiring.bridge_order].map(order);
        Self {
            is_straight: encoders == ConnectorOrder::STRAIGHT
                && bridges == ConnectorOrder::STRAIGHT
                && wiring.motors_reversed == [false; 3],
            encoders,
            bridges,
            pivots: bridges.inverse(),
            directions: wiring.motors_reversed.map(|it| if it { -1 } else { 1 }),
        }
    }

    /// Whether an encoder's port is the same pivot's to both.
    pub fn has_same_encoders(&self, other: &Self) -> bool {
        self.encoders == other.encoders
    }

    /// Everything is where it is called: what the ports have is the pivots'.
    #[inline]
    pub fn is_straight(&self) -> bool {
        self.is_straight
    }

    /// The pivots' frames and currents: positive ones turn a ring to larger angles.
    #[cold]
    #[inline(never)]
    pub fn of_pivots(
        &self,
        frames: &[RawFrame; 3],
        current_counts: &[i16; 3],
    ) -> ([RawFrame; 3], [i16; 3]) {
        let [one, two, three] = self.bridges.of_pivots(current_counts);
        let [a, b, c] = self.directions;
        (
            self.encoders.of_pivots(frames),
            [one * a, two * b, three * c],
        )
    }

    /// What the encoders' ports have, pivot by pivot.
    pub fn of_encoders<T: Copy>(&self, of_ports: &[T; 3]) -> [T; 3] {
        self.encoders.of_pivots(of_ports)
    }

    /// The pivots' bridges' fault pins.
    pub fn bridge_faults(&self, of_bridges: &[bool; 3]) -> [bool; 3] {
        self.bridges.of_pivots(of_bridges)
    }

    /// The bridges' duties.
    #[inline]
    pub fn duties(&self, of_pivots: [Duty; 3]) -> [Duty; 3] {
        if self.is_straight {
            of_pivots
        } else {
            self.of_bridges(of_pivots)
        }
    }

    #[cold]
    #[inline(never)]
    fn of_bridges(&self, [one, two, three]: [Duty; 3]) -> [Duty; 3] {
        let [a, b, c] = self.directions;
        (self.pivots).of_pivots(&[Duty(one.0 * a), Duty(two.0 * b), Duty(three.0 * c)])
    }
}
