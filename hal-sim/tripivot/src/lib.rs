//! `tripivot`: the command line, and what it puts together for that.
//!
//! | module | idea |
//! |---|---|
//! | [`attended`] | a simulated machine with a simulated person beside it, for what commissions one |
//! | [`cli`] | the command line: arguments, answers, exit codes |
//! | [`person`] | a simulated person beside a simulated machine |
//! | [`simulated`] | the simulated stage as a controller that the desk serves |

pub mod attended;
pub mod cli;
pub mod person;
pub mod simulated;
