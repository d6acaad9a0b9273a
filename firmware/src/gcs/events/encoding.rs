//! Events as words, for the retained memory: number, tick (two), what, three of its own, and the check.

use super::board_notice::BoardNotice;
use super::crash::{CRASH_FILE_BYTES, Crash, CrashCause};
use super::event::{Event, START_CAUSES};
use crate::fault::{FAULT_DESCRIPTIONS, Fault};
use crate::gcs::condition::{DriveQuantity, Knocks};

/// Stands for no pivot, and for a cause that has no number.
const NONE: u8 = 0xFF;

/// The words of an event; the last is for the check.
pub(super) fn words(number: u32, tick: u64, event: &Event) -> [u32; 8] {
    let (code, small, [a, b, c]) = parts(event);
    let what = u32::from_be_bytes([code, small[0], small[1], 0]);
    [number, tick as u32, (tick >> 32) as u32, what, a, b, c, 0]
}

/// Kind of event, two bytes and three words.
fn parts(event: &Event) -> (u8, [u8; 2], [u32; 3]) {
    let number = |value: f64| [value.to_bits() as u32, (value.to_bits() >> 32) as u32];
    let bare = |code| (code, [0; 2], [0; 3]);
    match event {
        Event::Start(cause) => {
            let known = |cause: &&str| START_CAUSES.iter().position(|known| known == cause);
            let place = cause.as_ref().and_then(known);
            (0, [place.map_or(NONE, |place| place as u8), 0], [0; 3])
        }
        Event::Fault(fault) => {
            let small = [fault.kind as u8, fault.pivot.unwrap_or(NONE)];
            (1, small, [fault.value.to_bits(), fault.limit.to_bits(), 0])
        }
        Event::Acknowledged => bare(2),
        Event::Referenced => bare(3),
        Event::ReferenceLost => bare(4),
        Event::ServoOn => bare(5),
        Event::ServoOff => bare(6),
        Event::ParameterSet(id, value) => {
            let [low, high] = number(*value);
            (7, [0; 2], [*id, low, high])
        }
        Event::Stop => bare(8),
        Event::Halt => bare(9),
        Event::Refused(count) => (10, [0; 2], [*count, 0, 0]),
        Event::HostSilent(ms) => {
            let [low, high] = number(*ms);
            (11, [0; 2], [0, low, high])
        }
        Event::Warning(pivot, warns) => (12, [*pivot, u8::from(*warns)], [0; 3]),
        Event::Stored => bare(13),
        Event::StoreFailed(number) => (14, [0; 2], [u32::from(*number), 0, 0]),
        Event::Recalled => bare(15),
        Event::UnknownParameters(count) => (16, [0; 2], [u32::from(*count), 0, 0]),
        Event::ServoBeforeReference => bare(17),
        Event::SupervisionLoosened(count) => (19, [0; 2], [u32::from(*count), 0, 0]),
        Event::Crashed(Crash::Panic { file, line }) => (24, line.to_be_bytes(), file_words(*file)),
        Event::Crashed(Crash::Exception {
            cause,
            program_counter,
            link,
            status,
        }) => (25, [*cause as u8, 0], [*program_counter, *link, *status]),
        Event::Crashed(Crash::NoAccess(address)) => (26, [0; 2], [*address, 0, 0]),
        Event::Crashed(Crash::State { stack, hard_fault }) => {
            (40, [0; 2], [*stack, *hard_fault, 0])
        }
        Event::BoardNotice(notice) => (27, [*notice as u8, 0], [0; 3]),
        Event::PoseOutside(pose) => (18, [0; 2], pose.map(f32::to_bits)),
        Event::Recovery(pose) => (20, [0; 2], pose.map(f32::to_bits)),
        Event::UnusableParameter(id, value) => {
            let [low, high] = number(*value);
            (23, [0; 2], [*id, low, high])
        }
        Event::LimitsNotBorne(limits) => (30, [0; 2], limits.map(f32::to_bits)),
        Event::Recovered => bare(21),
        Event::RecoveryGivenUp => bare(22),
        Event::FramesBridged(pivot, count) => (28, [*pivot, 0], [u32::from(*count), 0, 0]),
        Event::Drive(pivot, quantity, is_off, value) => {
            let what = *quantity as u8;
            (32, [*pivot, what], [value.to_bits(), u32::from(*is_off), 0])
        }
        Event::Knocks(Knocks {
            pivot,
            count,
            seconds,
            hardest_rad_s2,
        }) => {
            let count = u32::from(*count);
            let words = [count, seconds.to_bits(), hardest_rad_s2.to_bits()];
            (33, [*pivot, 0], words)
        }
        Event::EncoderStepped(pivot, step_rad) => (31, [*pivot, 0], [step_rad.to_bits(), 0, 0]),
        Event::CalibratedTemperature(is_off, over_k) => {
            (29, [u8::from(*is_off), 0], [over_k.to_bits(), 0, 0])
        }
    }
}

/// Tick and event of words whose check was right; `None` for what another firmware has written.
pub(super) fn event(words: &[u32; 8]) -> Option<(u64, Event)> {
    let [_, low, high, what, a, b, c, _] = *words;
    let tick = u64::from(high) << 32 | u64::from(low);
    let [code, first, second, _] = what.to_be_bytes();
    let number = f64::from_bits(u64::from(c) << 32 | u64::from(b));
    let event = match code {
        0 => Event::Start(START_CAUSES.get(usize::from(first)).copied()),
        1 => Event::Fault(Fault {
            kind: FAULT_DESCRIPTIONS.get(usize::from(first))?.kind,
            pivot: (second != NONE).then_some(second),
            tick,
            value: f32::from_bits(a),
            limit: f32::from_bits(b),
        }),
        2 => Event::Acknowledged,
        3 => Event::Referenced,
        4 => Event::ReferenceLost,
        5 => Event::ServoOn,
        6 => Event::ServoOff,
        7 => Event::ParameterSet(a, number),
        8 => Event::Stop,
        9 => Event::Halt,
        10 => Event::Refused(a),
        11 => Event::HostSilent(number),
        12 => Event::Warning(first, second != 0),
        13 => Event::Stored,
        14 => Event::StoreFailed(a as u16),
        15 => Event::Recalled,
        16 => Event::UnknownParameters(a as u16),
        17 => Event::ServoBeforeReference,
        19 => Event::SupervisionLoosened(a as u16),
        24 => Event::Crashed(Crash::Panic {
            file: file_bytes([a, b, c]),
            line: u16::from_be_bytes([first, second]),
        }),
        25 => Event::Crashed(Crash::Exception {
            cause: *CrashCause::ALL.get(usize::from(first))?,
            program_counter: a,
            link: b,
            status: c,
        }),
        26 => Event::Crashed(Crash::NoAccess(a)),
        40 => Event::Crashed(Crash::State {
            stack: a,
            hard_fault: b,
        }),
        27 => Event::BoardNotice(*BoardNotice::ALL.get(usize::from(first))?),
        18 => Event::PoseOutside([a, b, c].map(f32::from_bits)),
        20 => Event::Recovery([a, b, c].map(f32::from_bits)),
        23 => Event::UnusableParameter(a, number),
        30 => Event::LimitsNotBorne([a, b, c].map(f32::from_bits)),
        21 => Event::Recovered,
        22 => Event::RecoveryGivenUp,
        28 => Event::FramesBridged(first, a as u16),
        31 => Event::EncoderStepped(first, f32::from_bits(a)),
        33 => Event::Knocks(Knocks {
            pivot: first,
            count: a as u16,
            seconds: f32::from_bits(b),
            hardest_rad_s2: f32::from_bits(c),
        }),
        29 => Event::CalibratedTemperature(first != 0, f32::from_bits(a)),
        32 => {
            let quantity = *DriveQuantity::ALL.get(usize::from(second))?;
            Event::Drive(first, quantity, b != 0, f32::from_bits(a))
        }
        _ => return None,
    };
    Some((tick, event))
}

fn file_words(file: [u8; CRASH_FILE_BYTES]) -> [u32; 3] {
    core::array::from_fn(|i| {
        u32::from_be_bytes([
            file[4 * i],
            file[4 * i + 1],
            file[4 * i + 2],
            file[4 * i + 3],
        ])
    })
}

fn file_bytes(words: [u32; 3]) -> [u8; CRASH_FILE_BYTES] {
    core::array::from_fn(|i| words[i / 4].to_be_bytes()[i % 4])
}
