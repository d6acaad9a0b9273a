//! Faults: what can go wrong in the loop (`kind`), what is done about it and why (`description`), and what is kept of
//! it.

mod description;
mod kind;

pub use description::{FAULT_DESCRIPTIONS, FaultDescription};
pub use kind::{FaultKind, Reaction};

use core::fmt;

/// A latched fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fault {
    /// What.
    pub kind: FaultKind,
    /// The pivot it concerns, 0 to 2, where it concerns one.
    pub pivot: Option<u8>,
    /// The tick it was detected at.
    pub tick: u64,
    /// Measured value, in the unit its kind says; 0 where there is none.
    pub value: f32,
    /// The limit that `value` passed; 0 where there is none.
    pub limit: f32,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.kind.text())?;
        if let Some(pivot) = self.pivot {
            write!(f, ", pivot {}", pivot + 1)?;
        }
        if !self.kind.unit().is_empty() {
            let unit = self.kind.unit();
            write!(
                f,
                ": {:e} {unit}, limit {:e} {unit}",
                self.value, self.limit
            )?;
        }
        write!(f, ", at tick {}", self.tick)
    }
}
