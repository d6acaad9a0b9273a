#![forbid(unsafe_code)]
//! From records of an unknown machine to its numbers and to gains: the mathematics of commissioning, without a controller, a language or a
//! machine.

pub mod chain;
pub mod drive_model;
pub mod frequency_response;
pub mod friction;
mod least_squares;
pub mod multisine;
pub mod platform;
pub mod record;
mod spectrum;
pub mod tuning;
pub mod winding;
