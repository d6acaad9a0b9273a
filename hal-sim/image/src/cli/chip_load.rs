//! `cargo chip-load`: when the tick starts under full load, and whether deadlines are kept with all that a tick is used for.

use std::num::NonZeroU64;
use std::process::ExitCode;

use super::arguments::ChipLoad;
use super::error::CliError;
use crate::chip::{busy, load};

/// Instructions in a second: one a cycle, and with what wait states and long instructions may cost at the most.
const RATES: [NonZeroU64; 2] = [
    NonZeroU64::new(168_000_000).unwrap(),
    NonZeroU64::new(100_000_000).unwrap(),
];

/// What it has to bear: one over the cycles that an instruction takes on silicon, pessimistically, and five percent less.
const BUSY_RATES: [NonZeroU64; 2] = [
    NonZeroU64::new(93_000_000).unwrap(),
    NonZeroU64::new(88_000_000).unwrap(),
];

pub(super) fn run(arguments: &ChipLoad) -> Result<ExitCode, CliError> {
    println!("start of the tick after its timer event, line full in both directions");
    for rate in RATES {
        let load = load(arguments.ticks, rate)?;
        let (first, last) = load.cost.start_ns.unwrap_or_default();
        println!("\n{} million instructions a second", rate.get() / 1_000_000);
        println!("{:>10}  ticks", load.cost.ticks);
        println!("{first:>10}  ns, earliest start");
        println!("{last:>10}  ns, latest start");
        println!("{:>10}  ns of jitter", last - first);
        println!("{:>10}  instructions, worst tick", load.cost.worst);
        println!("{:>10}  ns, latest end", load.cost.latest_end_ns);
        println!("{:>10}  bytes to the chip", load.bytes[0]);
        println!("{:>10}  bytes from it", load.bytes[1]);
        println!("{:>10}  parameters refused in motion", load.refused);
        println!("{:>10}  bytes of stack used", load.stack);
    }
    println!(
        "\neight signals recorded in every tick, a stream at 1 kHz, moves and new targets, settings written with the servo on"
    );
    for rate in BUSY_RATES {
        let busy = busy(rate)?;
        let (cost, told) = (busy.cost, busy.told);
        println!("\n{} million instructions a second", rate.get() / 1_000_000);
        println!("{:>10}  ticks", cost.ticks);
        println!("{:>10}  ns, latest end of duties", cost.latest_end_ns);
        println!("{:>10}  late ticks", told.late);
        println!(
            "{:>10}  cycles from whole frames to their tick, at least",
            told.frame_margin
        );
        println!("{:>10}  commands taken", busy.commands);
        println!("{:>10}  commands refused", told.refused);
        println!("{:>10}  points recorded last", told.points);
        println!("fault: {}", told.fault);
    }
    Ok(ExitCode::SUCCESS)
}
