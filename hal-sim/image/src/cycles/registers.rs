//! Sets of registers of the core and of its floating-point unit.

/// A set of registers: the core's 16, then the 32 single ones of the floating-point unit. A double one is two of these.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Registers(u64);

const SINGLE: u32 = 16;

impl Registers {
    /// A register of the core, `r0` to `r15`.
    #[must_use]
    pub const fn core(number: u32) -> Self {
        Self(1 << number)
    }

    /// A single register of the floating-point unit, `s0` to `s31`.
    #[must_use]
    pub const fn single(number: u32) -> Self {
        Self(1 << (SINGLE + number))
    }

    /// A double one, `d0` to `d15`.
    #[must_use]
    pub const fn double(number: u32) -> Self {
        Self(3 << (SINGLE + 2 * number))
    }

    /// All of both.
    #[must_use]
    pub const fn with(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether any is in both.
    #[must_use]
    pub const fn meets(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// How many words they hold.
    #[must_use]
    pub const fn words(self) -> u32 {
        self.0.count_ones()
    }

    /// Whether any is one of the floating-point unit.
    #[must_use]
    pub const fn has_float(self) -> bool {
        self.0 >> SINGLE != 0
    }
}
