//! When the encoders latch: not quite together, and by how much not is known.

/// Cycles of the core's clock.
const CORE_HZ: f64 = 168e6;

/// How much later than the encoder at the first port that of each port latches, s.
///
/// Three stores in a row let the ports of the reference board go, one on the fast and two on the slow peripheral bus; each waits until
/// the one before is through: ten cycles over the slow bus, nominally, by the model of `cargo chip-cycles`, whose guesses span 7 to 13.
/// At 10 rad/s that is 6 and 11 counts of 26 bits, which the tick takes off by rate; what is left, where the guess is wrong,
/// is 2 and 4 counts there. To be replaced by what a scope shows between the encoders' clocks.
pub const LATCH_OFFSET_S: [f64; 3] = [0.0, 10.0 / CORE_HZ, 20.0 / CORE_HZ];
