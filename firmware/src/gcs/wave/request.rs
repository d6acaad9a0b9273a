//! What queries about waveforms ask for.

use crate::commander::wave::WAVE_TABLES;

/// A question about tables and generators: a flag for each that was named, none stands for all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaveQuery {
    /// `WAV?`
    Lengths([bool; WAVE_TABLES]),
    /// `TWG?`
    Generators,
    /// `#9`: mask of those that run, hexadecimal.
    Mask,
    /// `WSL?`
    Tables([bool; 6]),
    /// `WGC?`
    Cycles([bool; 6]),
    /// `WTR?`
    Rates([bool; 6]),
    /// `WGO?`
    Running([bool; 6]),
}
