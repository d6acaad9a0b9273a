//! The tables as they are printed.

use super::goal::goal;
use super::part::Part;
use super::size::{Bytes, Sizes};
use std::fmt::Write;

/// Cycles of a control period at 168 MHz.
const PERIOD_CYCLES: f64 = 8_400.0;
/// Cycles of a millisecond.
const MS_CYCLES: f64 = 168_000.0;
/// Cycles an instruction: none lost; straight floating-point code; with the flash's wait states, at the most.
const CYCLES: [f64; 3] = [1.0, 1.2, 1.68];

/// The parts, a row each.
pub fn print(parts: &[Part]) -> String {
    let width = parts.iter().map(|part| part.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    let head = [
        "calls", "refused", "mean", "worst", "goal", "at 1.0", "at 1.2", "at 1.68", "call", "ticks",
    ];
    let _ = write!(text, "{:width$}", "instructions");
    for column in head {
        let _ = write!(text, "{column:>11}");
    }
    text.push('\n');
    for part in parts {
        let _ = write!(text, "{:width$}", part.name);
        let goal = goal(&part.name);
        let refused = some(part.refused);
        let mean = format!("{:.1}", part.mean);
        let goal = goal.map_or_else(String::new, |goal| goal.to_string());
        let [one, two, three] = CYCLES.map(|cycles| share(part.worst, cycles));
        let ticks = some(part.worst_ticks);
        for value in [
            part.calls.to_string(),
            refused,
            mean,
            part.worst.to_string(),
            goal,
            one,
            two,
            three,
            part.worst_call.to_string(),
            ticks,
        ] {
            let _ = write!(text, "{value:>11}");
        }
        text.push('\n');
    }
    text
}

/// A number that is left out when it is zero.
fn some(number: impl Into<u64>) -> String {
    match number.into() {
        0 => String::new(),
        number => number.to_string(),
    }
}

/// Share of the control period, or ms where it is longer.
fn share(instructions: u32, cycles_each: f64) -> String {
    let cycles = f64::from(instructions) * cycles_each;
    if f64::from(instructions) * CYCLES[2] <= PERIOD_CYCLES {
        format!("{:.1} %", 100.0 * cycles / PERIOD_CYCLES)
    } else {
        format!("{:.2} ms", cycles / MS_CYCLES)
    }
}

/// Code of the motion generator, at most.
const GENERATOR_GOAL: u64 = 48 * 1024;

/// Flash and RAM by part, the largest first.
pub fn print_sizes(sizes: &Sizes) -> String {
    let mut parts: Vec<_> = sizes.parts.iter().collect();
    parts
        .sort_by_key(|(name, bytes)| (std::cmp::Reverse(bytes.flash + bytes.ram), (*name).clone()));
    let width = parts.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let mut text = String::new();
    let mut row = |name: &str, flash: &str, ram: &str| {
        let _ = writeln!(text, "{name:width$}{flash:>11}{ram:>11}");
    };
    row("bytes of stage", "flash", "RAM");
    for (name, bytes) in parts {
        row(name, &some(bytes.flash), &some(bytes.ram));
    }
    let Bytes { flash, ram } = sizes.total;
    row("all", &some(flash), &some(ram));
    let generator = sizes.generator();
    let _ = writeln!(
        text,
        "motion generator {generator} bytes, goal {GENERATOR_GOAL}; the stack has memory of its own"
    );
    let _ = writeln!(text, "built by {}", sizes.compiler);
    text
}
