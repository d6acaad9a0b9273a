//! `cargo chip-load`: when the tick starts under full load, and what a slow chip gets done.

use std::num::NonZeroU64;
use std::process::ExitCode;

use super::arguments::ChipLoad;
use super::error::CliError;
use crate::chip::{BUSY_CHIPS, Busy, BusyOptions, busy, load};

/// Instructions in a second: one a cycle, and with what wait states and long instructions may cost at the most.
const RATES: [NonZeroU64; 2] = [
    NonZeroU64::new(168_000_000).unwrap(),
    NonZeroU64::new(100_000_000).unwrap(),
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
        "\nall at once: streams, eight signals recorded in every tick, new targets, settings stored with the servo on"
    );
    println!(
        "{:>10} {:>9} {:>9} {:>7} {:>8} {:>10} {:>10} {:>7}  fault",
        "", "stream", "recorded", "late", "refused", "stream", "recorded", "end"
    );
    println!(
        "{:>10} {:>9} {:>9} {:>7} {:>8} {:>10} {:>10} {:>7}",
        "M/s", "ms", "ms", "ticks", "plans", "", "", "us"
    );
    for options in &BUSY_CHIPS {
        print_busy(options, &busy(options)?);
    }
    Ok(ExitCode::SUCCESS)
}

fn print_busy(options: &BusyOptions, seen: &Busy) {
    let [stream_ms, recorded_ms] = options.stream_ticks.map(|ticks| ticks as f64 / 20.0);
    let [stream, recorded] = (seen.stream_errors.each_ref()).map(|errors| match &errors[..] {
        [] => "taken".to_owned(),
        [first, ..] => format!("ends: {first}"),
    });
    println!(
        "{:>10} {stream_ms:>9} {recorded_ms:>9} {:>7} {:>8} {stream:>10} {recorded:>10} {:>7.1}  {}",
        options.instructions_per_second.get() / 1_000_000,
        seen.late,
        seen.refused,
        seen.latest_end_ns as f64 * 1e-3,
        seen.fault
    );
}
