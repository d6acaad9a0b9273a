//! Waveforms in the language: what lines about them mean, and what queries answer.

pub(crate) mod parse;
pub(crate) mod replies;
