//! `tripivot`: the command line, and what it puts together for that.

pub mod cli;
pub mod simulated;
