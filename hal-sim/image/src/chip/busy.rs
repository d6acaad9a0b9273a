//! All that a chip of few instructions a second has to do at once: streams of targets, eight signals recorded in every tick, new
//! targets in motion, settings stored with the servo on. Wait states and long instructions are in the rate: so many are executed in
//! a second of 168 million cycles.

use super::{Bench, ChipError, Period, circle, elf_file};
use hal_sim::machine::devices::{Stage, StageParameters};
use std::num::NonZeroU64;
use std::ops::ControlFlow::{Break, Continue};
use std::ops::Range;
use std::sync::mpsc;

/// How busy it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BusyOptions {
    /// What the chip executes.
    pub instructions_per_second: NonZeroU64,
    /// Ticks from one streamed target to the next: alone, and while eight signals are recorded.
    pub stream_ticks: [u64; 2],
}

const fn at(millions: u64, stream_ticks: [u64; 2]) -> BusyOptions {
    let rate = NonZeroU64::new(millions * 1_000_000);
    BusyOptions {
        instructions_per_second: rate.expect("some"),
        stream_ticks,
    }
}

/// Chips of 1.6 to 1.9 cycles an instruction, with the streams that they follow, and with faster ones.
pub const BUSY_CHIPS: [BusyOptions; 5] = [
    at(105, [20, 40]),
    at(93, [40, 80]),
    at(88, [80, 160]),
    at(93, [20, 20]),
    at(88, [20, 20]),
];

/// What has come of it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Busy {
    /// Ticks that were late, by `LST?`.
    pub late: u64,
    /// Commands that the tick has refused because they came too late: plans for the most part.
    pub refused: u64,
    /// When the last tick's duties were written after its event, ns, at the latest.
    pub latest_end_ns: u64,
    /// Of either stream, what `ERR?` said while it was sent, in order, that was not 0.
    pub stream_errors: [Vec<String>; 2],
    /// The same of all the rest.
    pub errors: Vec<String>,
    /// What `FLT?` said at the end.
    pub fault: String,
    /// How often the chip started again.
    pub resets: usize,
}

/// When the streams are sent, and when what comes before and behind them.
const STREAMS: [Range<u64>; 2] = [800..5_600, 8_000..12_800];
/// At the end of a stream its last target comes again: it ends at rest. So many ticks.
const AT_REST: u64 = 800;
/// How often the stream's errors are asked for, in targets, and the recorder is started again, in ticks.
const ASKED_EVERY: u64 = 8;
const RECORD_EVERY: u64 = 1_200;
/// Behind a stream, when nothing of it is under way any more.
const AFTER: u64 = 1_600;
const NEW_TARGETS: [(u64, &[u8]); 5] = [
    (15_000, b"MOV X 40 Y 20 W 90\n"),
    (15_700, b"MOV X -30 Y 35 W -90\n"),
    (16_400, b"MOV X 0 Y -50 W 0\n"),
    (17_100, b"MOV X 10 Y 10 W 20\n"),
    (17_800, b"MOV X 0 Y 0 W 0\n"),
];
const ERRORS_ASKED: u64 = 28_000;
const STORED: u64 = 29_000;
/// It takes a fourth of a second.
const ASKED_LAST: u64 = 38_000;
const END: u64 = 39_000;

/// What is asked, in the order of the answers.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Asked {
    Stream(usize),
    Rest,
}

/// Runs all of it on a chip with the image in the target folder.
///
/// # Errors
/// When there was no run that counts.
pub fn busy(options: &BusyOptions) -> Result<Busy, ChipError> {
    let path = elf_file::find().ok_or(ChipError::NoImage)?;
    let no_bench = |error| ChipError::Bench(path.clone(), error);
    let stage = Stage::new(&StageParameters::REFERENCE);
    let bench = Bench::load(&path, stage).map_err(no_bench)?;
    let mut run = Run {
        stream_ticks: options.stream_ticks,
        asked: Vec::new(),
        received: Vec::new(),
    };
    let (tell, told) = mpsc::channel();
    let outcome = (bench.at_rate(options.instructions_per_second)).run(move |period| {
        // After a reset nothing that was meant for this run is sent any more.
        if period.resets.is_empty() {
            run.send(period);
        }
        run.received.extend(period.received());
        if period.tick < END && period.resets.len() < 2 {
            return Continue(());
        }
        // Nobody is left to be told when the other side is gone.
        let _ = tell.send(run.seen());
        Break(())
    });
    let outcome = outcome.map_err(no_bench)?;
    if !outcome.gaps.is_empty() {
        return Err(ChipError::Gaps(outcome.gaps));
    }
    Ok(Busy {
        latest_end_ns: outcome.cost.latest_end_ns,
        resets: outcome.resets.len(),
        ..told.recv().map_err(|_| ChipError::Lost)?
    })
}

struct Run {
    stream_ticks: [u64; 2],
    asked: Vec<Asked>,
    received: Vec<u8>,
}

impl Run {
    fn send(&mut self, period: &mut Period<'_>) {
        let tick = period.tick;
        match tick {
            20 => period.send(b"FRF X\n"),
            600 => period.send(b"SPA 1 0x19001900 1\n"),
            6_800 | 14_000 => self.ask(period, Asked::Rest),
            7_000 => {
                period.send(b"RTR 1\nDRC 1 X 1 2 X 2 3 X 3 4 Y 1 5 Y 2 6 W 1 7 1 73 8 0 204\n")
            }
            14_100 => period.send(b"SPA 1 0x19001900 0\nDRT 0 4 0\n"),
            ERRORS_ASKED => self.ask(period, Asked::Rest),
            STORED => period.send(b"WPA 100\nWPA 100\n"),
            ASKED_LAST => {
                self.ask(period, Asked::Rest);
                period.send(b"LST?\nFLT?\n");
            }
            _ => {}
        }
        for (at, line) in NEW_TARGETS {
            if tick == at {
                period.send(line);
            }
        }
        for (number, sent) in STREAMS.into_iter().enumerate() {
            self.stream(period, number, &sent);
        }
    }

    fn ask(&mut self, period: &mut Period<'_>, asked: Asked) {
        self.asked.push(asked);
        period.send(b"ERR?\n");
    }

    /// Targets on a circle that begins and ends where the stage is, from rest to rest.
    fn stream(&mut self, period: &mut Period<'_>, number: usize, sent: &Range<u64>) {
        let (tick, every) = (period.tick, self.stream_ticks[number]);
        if tick + 100 == sent.start {
            period.send(format!("SCT T {}\n", every as f64 / 20.0).as_bytes());
        }
        let is_recorded = number == 1 && (sent.start..sent.end + AFTER).contains(&tick);
        if is_recorded && tick.is_multiple_of(RECORD_EVERY) {
            period.send(b"DRT 0 4 0\n");
        }
        if !sent.contains(&tick) || !(tick - sent.start).is_multiple_of(every) {
            return;
        }
        let length = (sent.end - sent.start - AT_REST) as f64;
        let done = ((tick - sent.start) as f64 / length).min(1.0);
        let [x, y] = circle::offset_mm(done);
        period.send(format!("MOV X {x:.6} Y {y:.6}\n").as_bytes());
        if ((tick - sent.start) / every).is_multiple_of(ASKED_EVERY) {
            self.ask(period, Asked::Stream(number));
        }
    }

    /// What the answers tell.
    fn seen(&self) -> Busy {
        let text = String::from_utf8_lossy(&self.received);
        let lines = || text.lines().map(str::trim).filter(|line| !line.is_empty());
        let value = |name: &str| {
            let mut found = lines().filter_map(|line| line.strip_prefix(name)?.parse().ok());
            found.next().unwrap_or(u64::MAX)
        };
        let mut seen = Busy {
            late: value("LATE="),
            refused: value("REFUSED="),
            fault: lines().next_back().unwrap_or_default().to_owned(),
            ..Busy::default()
        };
        // The first answers are those to `ERR?`, as many as were asked for.
        for (asked, answer) in self.asked.iter().zip(lines()) {
            let errors = match asked {
                Asked::Stream(number) => &mut seen.stream_errors[*number],
                Asked::Rest => &mut seen.errors,
            };
            if answer != "0" {
                errors.push(answer.to_owned());
            }
        }
        seen
    }
}
