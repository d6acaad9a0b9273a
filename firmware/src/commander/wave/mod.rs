//! Waveforms: tables of curves, and generators that send an axis through one of them.
//!
//! The generators are those of the axes; Z, U and V stay at 0 and take no table. Values are targets, mm and deg, in the
//! frames in force. A calculated segment is stored as what it is calculated from, however long it is: only points given
//! one by one take memory, of which all tables share [`WAVE_POINTS`].
//!
//! | file | idea |
//! |---|---|
//! | `waveforms` | tables and generators |
//! | `shape` | curves |
//! | `generator_run` | tables as samples of a motion |
//! | `change` | what can be changed |
//! | `error` | what can not be done |

mod change;
mod error;
mod generator_run;
mod shape;
mod waveforms;

pub use change::{LINE_POINTS, WaveChange, WavePoints};
pub use error::WaveError;
pub use generator_run::GeneratorRun;
pub use shape::{Curve, Shape};
pub use waveforms::{
    Generator, Join, MAX_TABLE_POINTS, WAVE_POINTS, WAVE_SEGMENTS, WAVE_TABLES, Waveforms,
};
