//! What queries ask of the stage.

use super::super::axis::{Axis, AxisSet, AxisValues};
use super::super::reach::furthest;
use super::super::request::Quantity;
use super::super::target::{Coordinates, coordinates, measured, position, replaced, travel};
use super::{Flight, Stage};
use crate::link::Mode;

impl Stage {
    /// The value that the query of `quantity` answers, mm and deg or 0 and 1.
    pub fn value(&self, quantity: Quantity, axis: Axis) -> f64 {
        let index = axis.index();
        let servo = matches!(self.mode(), Mode::Holding | Mode::Moving);
        let referenced = self.snapshot.as_ref().is_some_and(|s| s.referenced);
        match quantity {
            Quantity::Position => self.measured()[index],
            Quantity::Target => self.target[index],
            Quantity::OnTarget => flag(self.is_settled() || axis.component().is_none()),
            Quantity::Servo => flag(servo),
            Quantity::Referenced => flag(referenced),
            // Adding 0 turns -0 into 0.
            Quantity::Lowest => -travel(axis, &self.geometry) + 0.0,
            Quantity::Highest => travel(axis, &self.geometry),
            Quantity::SoftLowest => self.soft.lowest[index],
            Quantity::SoftHighest => self.soft.highest[index],
            Quantity::SoftActive => flag(self.soft.active[index]),
            Quantity::LimitSwitch | Quantity::ReferenceSwitch => 0.0,
        }
    }

    /// Whether `MOV` would take this target, once referenced and with the servo on.
    pub fn is_reachable(&self, values: &AxisValues) -> bool {
        let target = replaced(&self.target, values);
        self.soft.allow(&target) && position(&target, &self.geometry).is_ok()
    }

    /// The furthest target in this direction from the last one; `None` when it is no direction.
    pub fn reach(&self, values: &AxisValues) -> Option<Coordinates> {
        let direction = values.map(|value| value.unwrap_or(0.0));
        furthest(&self.target, &direction, &self.soft, &self.geometry)
    }

    /// Measured pose. Without a reference there is none: 0. With pivots that are no pose (a fault) the setpoint stands for it.
    pub fn measured(&self) -> Coordinates {
        let Some(snapshot) = self.snapshot.as_ref().filter(|s| s.referenced) else {
            return Coordinates::default();
        };
        measured(&snapshot.pivots, &self.geometry)
            .unwrap_or_else(|| coordinates(&snapshot.setpoint, &self.geometry))
    }

    /// The axes that move or have not settled yet.
    pub fn moving(&self) -> AxisSet {
        match (self.is_moving(), self.moving.is_empty()) {
            (false, _) => AxisSet::EMPTY,
            (true, true) => AxisSet::MOVABLE,
            (true, false) => self.moving,
        }
    }

    /// Whether referencing is under way, for whichever connection.
    pub fn is_referencing(&self) -> bool {
        matches!(self.flight, Some(Flight::Reference)) || self.tick() < self.reference_until
    }

    /// The fault that is latched makes every motion an error.
    pub fn is_faulted(&self) -> bool {
        self.mode() == Mode::Fault
    }

    pub const fn velocity_mm_s(&self) -> f64 {
        self.limits.speed_mm_s
    }

    pub(super) fn mode(&self) -> Mode {
        self.snapshot.as_ref().map_or(Mode::Off, |s| s.mode)
    }

    fn is_settled(&self) -> bool {
        !self.is_moving() && self.mode() == Mode::Holding
    }

    pub(super) fn is_moving(&self) -> bool {
        let settled = self.snapshot.as_ref().is_some_and(|s| s.settled);
        self.is_referencing()
            || self.motion_is_due()
            || match self.mode() {
                Mode::Off | Mode::Fault => false,
                Mode::Holding => !settled,
                Mode::Moving => true,
            }
    }

    /// A motion is wanted or in flight that the snapshot does not show yet.
    pub(super) const fn motion_is_due(&self) -> bool {
        self.move_wanted.is_some() || matches!(self.flight, Some(Flight::Move(_)))
    }
}

fn flag(set: bool) -> f64 {
    if set { 1.0 } else { 0.0 }
}
