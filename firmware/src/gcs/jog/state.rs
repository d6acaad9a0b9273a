//! Owner and end of the velocity of each axis.

use crate::commander::axis::{Axis, AxisValues};
use crate::gcs::connection_number::ConnectionNumber;

/// The velocity of an axis, as one connection has commanded it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct OwnedJog {
    connection: ConnectionNumber,
    /// The tick at which it ends; `None`: with its connection.
    end_tick: Option<u64>,
}

/// Whose constant velocities are in force.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::gcs) struct Jogs {
    axes: [Option<OwnedJog>; 6],
}

impl Jogs {
    /// A connection, or a macro (`None`), has commanded these velocities.
    pub fn note(
        &mut self,
        values: &AxisValues,
        connection: Option<ConnectionNumber>,
        end_tick: Option<u64>,
    ) {
        for (owned, value) in self.axes.iter_mut().zip(values) {
            if let Some(value) = value {
                *owned = connection
                    .filter(|_| *value != 0.0)
                    .map(|connection| OwnedJog {
                        connection,
                        end_tick,
                    });
            }
        }
    }

    /// The velocities of a connection that are in force end at this tick; `None`: with the connection.
    pub fn set_end(&mut self, connection: Option<ConnectionNumber>, end_tick: Option<u64>) {
        for owned in self.axes.iter_mut().flatten() {
            if Some(owned.connection) == connection {
                owned.end_tick = end_tick;
            }
        }
    }

    /// A connection has ended: so do its velocities.
    pub fn connection_ended(&mut self, number: ConnectionNumber) {
        for owned in self.axes.iter_mut().flatten() {
            if owned.connection == number {
                owned.end_tick = Some(0);
            }
        }
    }

    /// Velocities of 0 for the axes whose end has come, if there are any.
    pub fn ended(&self, tick: u64) -> Option<AxisValues> {
        let is_over = |owned: &OwnedJog| owned.end_tick.is_some_and(|end| tick >= end);
        let values = self.axes.map(|owned| owned.filter(is_over).map(|_| 0.0));
        values.iter().any(Option::is_some).then_some(values)
    }

    /// These axes belong to nobody any more.
    pub fn forget(&mut self, axes: impl Fn(Axis) -> bool) {
        for axis in Axis::ALL {
            if axes(axis) {
                self.axes[axis.index()] = None;
            }
        }
    }
}
