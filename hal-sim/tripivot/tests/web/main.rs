//! The page as browsers and others meet it.
//!
//! | file | idea |
//! |---|---|
//! | `bench` | a served page in a thread of the test, and viewers of it |
//! | `access` | who may look and who may drive |
//! | `viewers` | what viewers are told, and how many there may be |
//! | `owners` | whose commands count, and what ends with a page |
//! | `stops` | nothing that was asked for before a stop follows it |
//! | `sequences` | scripts that run in the server |
//! | `commissioning` | commissioning and tuning that run there |
#![cfg(unix)]

mod access;
mod bench;
mod commissioning;
mod owners;
mod sequences;
mod stops;
mod viewers;
