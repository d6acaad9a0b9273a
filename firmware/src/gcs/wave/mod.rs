//! Waveforms in the language.
//!
//! | command | meaning |
//! |---|---|
//! | `WAV` | a segment of a table: calculated (`LIN`, `RAMP`, `SIN_P`) or point by point (`PNT`); `X` begins the table anew, `&` appends, `+` adds to what is there |
//! | `WCL`, `WAV?` | clears a table, its length |
//! | `WSL`, `WGC`, `WTR` | table of a generator, cycles (0: without end), ticks a point |
//! | `WGO` | starts (1) and stops (0) generators |
//!
//! Generators 1 to 6 are the axes X to W. Tables and generators themselves are those of [`crate::commander::wave`].
//!
//! | file | idea |
//! |---|---|
//! | `parse` | what lines mean |
//! | `request` | what queries ask for |
//! | `replies` | what queries answer |

pub(super) mod parse;
mod replies;
mod request;

pub(super) use replies::reply_waves;
pub use request::WaveQuery;
