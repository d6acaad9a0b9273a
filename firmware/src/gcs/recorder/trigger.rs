//! What can begin a record.
//!
//! Numbers under 100 are those that this family of controllers gives the same things; own ones begin there.

use core::fmt;

/// The trigger of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Trigger {
    /// Nothing but `STE`.
    #[default]
    Never,
    /// Every command that moves, each of which makes a new record once the last one is complete.
    EveryMove,
    /// The next command that moves; the trigger is [`Never`](Self::Never) afterwards.
    NextMove,
    /// At once.
    Now,
    /// The table's signal crosses a value, in the signal's unit.
    Crosses {
        /// The value.
        value: f64,
        /// From below to at or above it, or the other way.
        rising: bool,
    },
    /// A fault.
    Fault,
}

/// Numbers and texts, as `HDR?` lists them.
pub(super) const TRIGGERS: &[(u16, &str)] = &[
    (0, "none; STE triggers whatever is set here"),
    (1, "every command that moves"),
    (2, "next command that moves, 0 afterwards"),
    (4, "at once"),
    (
        100,
        "signal of the table rises to <value>; not options 2, 3, 210 of axes",
    ),
    (
        101,
        "signal of the table falls below <value>; not options 2, 3, 210 of axes",
    ),
    (102, "fault"),
];

impl Trigger {
    /// The trigger of a number; most need no value.
    pub(super) const fn new(number: u16, value: f64) -> Option<Self> {
        Some(match number {
            0 => Self::Never,
            1 => Self::EveryMove,
            2 => Self::NextMove,
            4 => Self::Now,
            100 | 101 => Self::Crosses {
                value,
                rising: number == 100,
            },
            102 => Self::Fault,
            _ => return None,
        })
    }

    /// Whether commands that move trigger it.
    pub(super) const fn is_by_command(self) -> bool {
        matches!(self, Self::EveryMove | Self::NextMove)
    }

    const fn number(self) -> u16 {
        match self {
            Self::Never => 0,
            Self::EveryMove => 1,
            Self::NextMove => 2,
            Self::Now => 4,
            Self::Crosses { rising: true, .. } => 100,
            Self::Crosses { rising: false, .. } => 101,
            Self::Fault => 102,
        }
    }
}

/// Number and value, as `DRT?` answers.
impl fmt::Display for Trigger {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = match self {
            Self::Crosses { value, .. } => *value,
            _ => 0.0,
        };
        write!(f, "{} {value}", self.number())
    }
}
