//! One simulated stage in front of the firmware: on the host, through embedded-hal, and of an emulated STM32F427.

mod assets;
#[cfg(feature = "chip")]
pub mod chip;
pub mod cli;
pub mod client;
#[cfg(feature = "chip")]
pub mod cost;
pub mod devices;
pub mod exercise;
pub mod faults;
pub mod host;
pub mod observer;
pub mod plant;
#[cfg(feature = "chip")]
pub mod proof;
#[cfg(unix)]
pub mod record;
pub mod report;
pub mod run;
pub mod script;
#[cfg(unix)]
pub mod serve;
#[cfg(unix)]
pub mod settings;
#[cfg(unix)]
pub mod web;
