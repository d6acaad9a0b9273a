//! When ticks, latches and the stops of the emulator come, ns.

/// Control period.
pub const PERIOD_NS: u64 = 50_000;
/// From the start of the timers to the first tick.
pub const FIRST_TICK_NS: u64 = 50_000;
/// From latch to tick.
pub const LATCH_NS: u64 = 15_000;
/// The stop comes before the latch by so much, so that no instruction of the latch runs before it.
pub const EARLY_NS: u64 = 1_000;
