//! `cost`: calls functions of the library on random arguments and counts what each call takes. `cargo cost` runs it
//! on the emulated chip and prints the table.
//!
//! # What is counted
//!
//! One call at a time, with the processor's cycle counter, reading it not included. The emulator gives every
//! instruction two counts, so the counts are instructions, exact to one or two. Arguments are made outside of what is
//! counted; what comes back is counted until it lies in memory. The library is compiled as in the image `stage` (same
//! profile), but what the compiler inlines where can differ: the tick as it is flashed is counted by `cargo chip`.
//!
//! # What is not
//!
//! Cycles: no wait states of the flash, no stalls, no divider that takes 14 cycles. On a board the same image counts
//! them, and a debugger reads [`table::COST`]. No interrupt is on, so nothing is counted but the call.
//!
//! # Arguments
//!
//! Call k of every part draws its arguments from a generator seeded with the run's seed and k alone. So the first calls
//! of a long run are those of a short one, and the worst call can be had again by its number.
#![no_std]
#![no_main]

mod bench;
mod failure;
mod meter;
mod order;
mod parts;
mod table;

use bench::Bench;
use cortex_m::Peripherals;
use cortex_m_rt::entry;
use meter::Meter;
use order::Order;
use table::COST;

#[entry]
fn main() -> ! {
    let order = Order::read();
    if let Some(mut core) = Peripherals::take() {
        let meter = Meter::new(&mut core.DCB, &mut core.DWT);
        let mut bench = Bench::new(order, meter);
        parts::known::run(&mut bench);
        parts::motion::run(&mut bench);
        parts::motion::run_stream(&mut bench);
        parts::following::run(&mut bench);
        parts::kinematics::run(&mut bench);
        parts::control::run(&mut bench);
    }
    COST.end();
    loop {
        cortex_m::asm::wfi();
    }
}
