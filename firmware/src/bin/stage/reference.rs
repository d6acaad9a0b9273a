//! `stage`: the controller on the reference board.
#![no_std]
#![no_main]

// First: the list of pins is written in it.
#[macro_use]
mod pin_list;

mod analog;
mod board;
mod clocks;
mod crash;
mod debug;
mod dma;
mod encoders;
mod fault_handlers;
mod flash;
mod identity;
mod latch;
mod latch_timing;
mod loop_memory;
mod marks;
mod oscillator;
mod panic;
mod program_watch;
mod pwm;
mod ram_test;
mod reset_cause;
mod restart;
mod retained_memory;
mod samples;
mod self_check;
mod self_test;
mod serial;
#[path = "main.rs"]
mod tasks;
mod tick_timing;
mod timeline;
mod trace;
mod watchdog;
mod word_copy;

#[path = "board_pins/reference.rs"]
mod pins;

use defmt_rtt as _;
