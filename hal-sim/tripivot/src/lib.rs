//! `tripivot`: the command line, and what it puts together for that.
//!
//! | module | idea |
//! |---|---|
//! | [`cli`] | the command line: arguments, answers, exit codes |
//! | [`simulated`] | the simulated stage as a controller that the desk serves |

pub mod cli;
pub mod simulated;
