//! What goes over the chip's pins while it runs the demonstration, for another emulator that gives it the same and has to get the
//! same: `tests/unicorn`.
//!
//! A text file of lines of words. Times are whole ns from the start of the timers (the store that sets `TIM1_CR1.CEN`).
//!
//! | line | meaning |
//! |---|---|
//! | `memory` address bytes | what the flash holds at the start besides the image, hexadecimal; where nothing is said, `FF` |
//! | `byte` time value | a byte to the command interface: when its start bit began; in hexadecimal |
//! | `pins` time duty phase sleep | what the bridges see at that time: counts of the three PWM pulses of the period under way, or `-` while the outputs are cut; the levels of the three phase pins, and of the three sleep pins |
//! | `sent` time bytes | what the command interface has sent since the line before of that kind, hexadecimal, or `-` |
//! | `inputs` time frames counts | what is handed over at that time: the three encoders' frames, hexadecimal; counts of the three currents and of the supply |
//!
//! `pins`, `sent` and `inputs` come once a control period in this order, shortly before the latch; the bytes that went out before
//! stand before them.

use super::{Bench, ChipError, Period, elf_file};
use hal_sim::machine::devices::{Stage, StageParameters};
use hal_sim::rig::client::{Client, Event};
use hal_sim::rig::script::Script;
use std::fmt::Write;
use std::ops::ControlFlow::{Break, Continue};
use std::sync::mpsc;

/// Periods before the first line.
const WARM_UP: u64 = 20;
/// Where settings lie.
const SETTINGS: std::ops::Range<u64> = 0x0810_0000..0x0811_0000;
const ERASED: u32 = u32::MAX;

/// The first ticks of the demonstration on the image in the target folder.
///
/// # Errors
/// When there was no run that counts.
pub fn pins(ticks: u64) -> Result<String, ChipError> {
    let path = elf_file::find().ok_or(ChipError::NoImage)?;
    let no_bench = |error| ChipError::Bench(path.clone(), error);
    let script = Script::demonstration().map_err(ChipError::Script)?;
    let mut client = Client::new(&script);
    let mut text = String::new();
    let stage = Stage::new(&StageParameters::REFERENCE);
    let (tell, told) = mpsc::channel();
    let run = Bench::load(&path, stage)
        .map_err(no_bench)?
        .run(move |period| {
            if period.tick == 0 {
                memory(period, &mut text);
            }
            let received = exchange(period, &mut text);
            if period.tick >= WARM_UP {
                let moving = period.tick > 0 && period.pins.iter().any(|bridge| bridge.awake);
                let (bytes, event) = client.poll(&received, moving);
                period.send(&bytes);
                if let Some(Event::Stuck(_) | Event::Refused(..)) = event {
                    return Break(());
                }
            }
            if period.tick < ticks {
                return Continue(());
            }
            // Nobody is left to be told when the other side is gone.
            let _ = tell.send(std::mem::take(&mut text));
            Break(())
        });
    let outcome = run.map_err(no_bench)?;
    if !outcome.gaps.is_empty() {
        return Err(ChipError::Gaps(outcome.gaps));
    }
    told.recv().map_err(|_| ChipError::Lost)
}

fn memory(period: &mut Period<'_>, text: &mut String) {
    for at in SETTINGS.step_by(4) {
        let word = period.word(at).unwrap_or(ERASED);
        if word != ERASED {
            line(
                text,
                format_args!("memory {at:08X} {}", hex(&word.to_le_bytes())),
            );
        }
    }
}

/// One control period; what the command interface has sent.
fn exchange(period: &mut Period<'_>, text: &mut String) -> Vec<u8> {
    let started_at = period.started_at_ns();
    let now = period.at_ns() - started_at;
    for (at, byte) in period.sent() {
        line(text, format_args!("byte {} {byte:02X}", at - started_at));
    }
    let duty = period.duty().map_or_else(
        || "-".to_owned(),
        |[first, second, third]| format!("{first},{second},{third}"),
    );
    let levels = |of: fn(&hal_sim::machine::devices::BridgeState) -> bool| -> String {
        (period.pins.iter())
            .map(|bridge| if of(bridge) { '1' } else { '0' })
            .collect()
    };
    let (phase, sleep) = (levels(|it| it.forward), levels(|it| it.awake));
    line(text, format_args!("pins {now} {duty} {phase} {sleep}"));
    let received = period.received();
    let sent = if received.is_empty() {
        "-".to_owned()
    } else {
        hex(&received)
    };
    line(text, format_args!("sent {now} {sent}"));
    let frames = period.stage.frames().map(|frame| hex(&frame)).join(",");
    let ([first, second, third], supply) = period.stage.analog();
    line(
        text,
        format_args!("inputs {now} {frames} {first},{second},{third},{supply}"),
    );
    received
}

fn line(text: &mut String, words: std::fmt::Arguments<'_>) {
    // A string takes everything.
    let _ = writeln!(text, "{words}");
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02X}")).collect()
}
