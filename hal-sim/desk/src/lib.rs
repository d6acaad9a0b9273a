//! What an operator uses in front of a controller, be it a simulated one or a board: nothing here knows a machine.
//!
//! | module | idea |
//! |---|---|
//! | [`line`] | questions and answers to a controller, over TCP or a serial line |
//! | `serve` | a controller in this process, for clients over TCP and a pseudo-terminal |
//! | `web` | the page, in front of any controller |
//! | `record` | a record of a controller's data recorder |
//! | `board` | the tests to be repeated on every board |
//! | `commission` | from an unknown machine to one that moves |
//! | `calibrate` | a built machine is measured, and its calibration given to its controller |
//! | `settings` | a controller's settings to a file and back |
//! | [`date`] | today's date |
//! | [`error_words`] | error numbers in words |
//! | `reference` | the parameters of the reference stage |
//! | `assets` | the files of the page, embedded in the program |

mod assets;
pub mod board;
pub mod calibrate;
pub mod commission;
pub mod date;
pub mod error_words;
pub mod line;
pub mod record;
mod reference;
pub mod serve;
pub mod settings;
pub mod web;
