//! What the tick is used for, one use after the other on the emulated chip, and the instructions of its ticks in each.

use super::follow::{FollowedTick, Step};
use super::{Bench, ChipError, Period, bench, circle, elf_file};
use crate::cycles::{Bus, Program};
use addr2line::Loader;
use firmware::calibration::{CalibrationText, MachineCalibration};
use hal_sim::machine::devices::{Stage, StageParameters};
use kinematics::COEFFICIENTS;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::ops::ControlFlow::{Break, Continue};
use std::ops::Range;
use std::path::Path;
use std::sync::{Arc, mpsc};

/// What a tick has to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Use {
    /// The servo is off.
    Off,
    /// The stage is held where it is.
    Holding,
    /// It moves.
    Moving,
    /// It takes a plan.
    PlanTaken,
    /// It follows targets that come every millisecond; most are plans to be taken.
    Streaming,
    /// It takes the order to record.
    RecordOrder,
    /// It moves, and eight signals are recorded.
    Recording,
    /// It takes a plan then.
    PlanTakenRecording,
    /// The stage is held where it is, with a calibration of which every number is something.
    HoldingCalibrated,
    /// It moves with it.
    MovingCalibrated,
    /// It takes a plan then.
    PlanTakenCalibrated,
    /// The servo is off, and the pose is followed.
    OffCalibrated,
    /// It is switched on then, without and with all that shapes a loop.
    SwitchedOnCalibrated,
    /// With the calibration and all that shapes a loop, as below, it takes settings.
    SettingsTakenShaped,
    /// It moves with it, and all is on that shapes a loop or learns: of each pivot two notches, the lead, two sines of ripple and the
    /// gear's error, friction and give of the guides, three sines of the encoder's error within a period, and gains that go by the inertia.
    MovingShaped,
    /// It takes a plan then.
    PlanTakenShaped,
    /// The same with a table of iterative learning, in whose place the servos do not learn.
    MovingShapedTrial,
}

impl Use {
    /// All of them.
    pub const ALL: [Self; 17] = [
        Self::Off,
        Self::Holding,
        Self::Moving,
        Self::PlanTaken,
        Self::Streaming,
        Self::RecordOrder,
        Self::Recording,
        Self::PlanTakenRecording,
        Self::HoldingCalibrated,
        Self::MovingCalibrated,
        Self::PlanTakenCalibrated,
        Self::OffCalibrated,
        Self::SwitchedOnCalibrated,
        Self::SettingsTakenShaped,
        Self::MovingShaped,
        Self::PlanTakenShaped,
        Self::MovingShapedTrial,
    ];

    /// In words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Off => "servo off",
            Self::Holding => "holding",
            Self::Moving => "moving",
            Self::PlanTaken => "takes a plan",
            Self::Streaming => "MOV stream at 1 kHz",
            Self::RecordOrder => "order to record",
            Self::Recording => "moving, eight signals recorded",
            Self::PlanTakenRecording => "the same, takes a plan",
            Self::HoldingCalibrated => "holding, calibrated",
            Self::MovingCalibrated => "moving, calibrated",
            Self::PlanTakenCalibrated => "calibrated, takes a plan",
            Self::OffCalibrated => "servo off, calibrated",
            Self::SwitchedOnCalibrated => "calibrated, switched on",
            Self::SettingsTakenShaped => "all that shapes a loop, takes settings",
            Self::MovingShaped => "moving, calibrated, all that shapes a loop",
            Self::PlanTakenShaped => "all that shapes a loop, takes a plan",
            Self::MovingShapedTrial => "all that shapes a loop, a repeated move",
        }
    }
}

impl fmt::Display for Use {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.words())
    }
}

/// A tick and what it was used for.
#[derive(Clone, Debug)]
pub struct UsedTick {
    /// Its number from the start.
    pub tick: u64,
    /// What for.
    pub used: Use,
    /// Its instructions.
    pub steps: Vec<Step>,
    /// So many of them until its duties are written.
    pub until_duties: usize,
}

impl UsedTick {
    /// The instructions that have a deadline.
    #[must_use]
    pub fn until_duties(&self) -> &[Step] {
        self.steps.get(..self.until_duties).unwrap_or(&self.steps)
    }
}

/// Ticks of every use, and the program that they are of.
#[derive(Debug)]
pub struct Used {
    /// The instructions of the tick.
    pub program: Arc<Program>,
    /// In the order in which they ran.
    pub ticks: Vec<UsedTick>,
}

impl Used {
    /// An instruction that has loaded from flash, if there was one.
    #[must_use]
    pub fn flash_read(&self) -> Option<u64> {
        let mut steps = self.ticks.iter().flat_map(|tick| &tick.steps);
        let found = steps.find(|step| matches!(step.bus, Bus::Flash(_)));
        found.map(|step| step.at)
    }
}

/// A stretch of ticks that are followed.
struct Stretch {
    ticks: Range<u64>,
    used: Use,
    /// What those are used for that take a command.
    taken: Option<Use>,
}

/// From a line to the tick that takes the order in it, at most.
const ORDER_TICKS: u64 = 40;

/// Lines, and the tick before which they are sent.
const LINES: [(u64, &[u8]); 26] = [
    (150, b"FRF X\n"),
    (1_000, b"MOV X 40 Y 20 W 90\n"),
    (4_000, b"MOV X -30 Y 35 W -90\n"),
    (15_000, b"SPA 1 0x19001900 1\nSCT T 1\n"),
    (19_000, b"ERR?\n"),
    // The stream has dried up, as it has to be.
    (20_000, b"ERR?\nSPA 1 0x19001900 0\n"),
    (
        20_100,
        b"RTR 1\nDRC 1 X 1 2 X 2 3 X 3 4 Y 1 5 Y 2 6 W 1 7 1 73 8 0 204\n",
    ),
    (20_200, b"DRT 0 2 0\n"),
    (20_300, b"DRT 0 4 0\n"),
    (20_500, b"DRT 0 2 0\nMOV X 40 Y 20 W 90\n"),
    // In the middle of the recorded move.
    (21_200, b"MOV X 10 Y 40 W 0\n"),
    // A calibration is for a serial number, and is taken with the servo off.
    (SERIAL_ASKED, b"SVO X 0\nCCL 1 ADVANCED\nSSN?\n"),
    // It is in force; the emulated flash keeps nothing.
    (31_500, b"ERR?\n"),
    (REFERENCED_AGAIN, b"FRF X\n"),
    (34_000, b"MOV X 40 Y 20 W 90\n"),
    // The encoders' errors are told with the servo off, the rest while the stage rests: numbers that do no harm to this machine.
    (42_700, b"SVO X 0\nSPA 1 0x54500E00 2048 1 0x54500E01 9\n"),
    (42_800, b"SPA 1 0x54500E03 9 1 0x54500E05 9\n"),
    (42_900, b"FRF X\n"),
    (
        43_500,
        b"SPA 1 0x54500706 0.1 1 0x54500708 20 1 0x54500709 500\n",
    ),
    (
        43_600,
        b"SPA 1 0x54500340 1425 1 0x54500341 450 1 0x54500342 0.3\n",
    ),
    (
        43_700,
        b"SPA 1 0x54500343 1680 1 0x54500344 450 1 0x54500345 0.3\n",
    ),
    (
        43_800,
        b"SPA 1 0x54500346 477 1 0x54500347 3000 1 0x54500306 0.04\n",
    ),
    (
        43_900,
        b"SPA 1 0x54500A00 1300 1 0x54500A01 2e-3 1 0x54500A03 2600 1 0x54500A04 1e-3\n",
    ),
    (
        SETTINGS_TAKEN,
        b"SPA 1 0x54500A0C 2 1 0x54500A0D 30\nERR?\n",
    ),
    (SHAPED, b"MOV X 10 Y 40 W 0\n"),
    (REPEATED, b"ILC LEARN A\nMOV X 40 Y 20 W 90\nERR?\n"),
];
/// What they are answered with, but for the serial number: no more is refused than stands beside them.
const ANSWERS: [&str; 5] = ["0", "220", "4001", "0", "0"];
/// The last of these lines: its settings are taken while the others are in force.
const SETTINGS_TAKEN: u64 = 44_000;
const SHAPED: u64 = 45_000;
const REPEATED: u64 = 53_000;
const SERIAL_ASKED: u64 = 25_000;
const REFERENCED_AGAIN: u64 = 32_000;
/// With the calibration the servo is switched off and on again at rest, each time a tick later: ticks take turns in what they do besides.
/// Then once more, with all that shapes a loop.
const SWITCHED: [Range<u64>; 2] = [41_400..42_600, 44_400..44_880];
const SWITCHED_EVERY: u64 = 240;
/// From off to on.
const SWITCHED_AFTER: u64 = 30;
/// The calibration's lines, and how far they are apart. Its last one keeps the command side busy for some thousand ticks.
const CALIBRATION_SENT: u64 = 26_000;
const CALIBRATION_EVERY: u64 = 60;
/// Each of its numbers: track radii and rad. What they are is nothing to a tick.
const OFF_BY: f32 = 1e-5;
/// Numbers in a line.
const LINE_NUMBERS: usize = 8;
/// Streamed targets: one every 20 ticks on a circle that begins and ends where the stage is, from rest to rest.
const STREAM: Range<u64> = 15_200..19_200;
const STREAM_EVERY: u64 = 20;
const STREAM_START: [f64; 2] = [-30.0, 35.0];
const END: u64 = 54_000;

/// So many ticks of each use, at least; of those that take a command, as many as there are.
fn stretches(ticks: u64) -> Vec<Stretch> {
    let stretch = |from: u64, ticks: u64, used, taken| Stretch {
        ticks: from..from + ticks,
        used,
        taken,
    };
    let quarter = ticks.div_ceil(4);
    let switched_on = |from, ticks| {
        stretch(
            from,
            ticks,
            Use::OffCalibrated,
            Some(Use::SwitchedOnCalibrated),
        )
    };
    let plan = Some(Use::PlanTaken);
    let mut stretches = vec![
        stretch(60, ticks.min(80), Use::Off, None),
        stretch(600, ticks, Use::Holding, None),
        stretch(1_000, quarter.max(300), Use::Moving, plan),
        stretch(2_000, quarter, Use::Moving, plan),
        stretch(4_000, quarter.max(400), Use::Moving, plan),
        stretch(5_000, quarter, Use::Moving, plan),
        stretch(17_000, ticks, Use::Streaming, None),
        stretch(20_200, ORDER_TICKS, Use::RecordOrder, None),
        stretch(20_300, ORDER_TICKS, Use::RecordOrder, None),
        stretch(
            20_500,
            ticks.max(300),
            Use::Recording,
            Some(Use::PlanTakenRecording),
        ),
        stretch(21_200, 400, Use::Recording, Some(Use::PlanTakenRecording)),
        switched_on(REFERENCED_AGAIN, 250),
        stretch(33_000, ticks.min(900), Use::HoldingCalibrated, None),
        stretch(
            34_000,
            ticks.clamp(300, 900),
            Use::MovingCalibrated,
            Some(Use::PlanTakenCalibrated),
        ),
        stretch(
            SETTINGS_TAKEN,
            300,
            Use::SettingsTakenShaped,
            Some(Use::SettingsTakenShaped),
        ),
        stretch(
            SHAPED,
            ticks.clamp(300, 900),
            Use::MovingShaped,
            Some(Use::PlanTakenShaped),
        ),
        stretch(
            REPEATED,
            ticks.clamp(300, 900),
            Use::MovingShapedTrial,
            Some(Use::PlanTakenShaped),
        ),
    ];
    let rounds = SWITCHED
        .into_iter()
        .flat_map(|range| range.step_by(SWITCHED_EVERY as usize));
    let ticks = SWITCHED_EVERY - SWITCHED_AFTER;
    stretches.extend(rounds.map(|from| switched_on(from + SWITCHED_AFTER, ticks)));
    stretches
}

/// Has the image in the target folder used in every way, and so many ticks of each followed.
///
/// # Errors
/// When there was no run that counts.
pub fn uses(ticks: u64) -> Result<Used, ChipError> {
    let path = elf_file::find().ok_or(ChipError::NoImage)?;
    let no_bench = |error| ChipError::Bench(path.clone(), error);
    let program = Program::read(&path, bench::TICK_BEGIN);
    let program = Arc::new(program.map_err(|error| ChipError::Proof(path.clone(), error))?);
    let takes_command = takes_command(&path, &program)?;
    let stage = Stage::new(&StageParameters::REFERENCE);
    let mut run = Run {
        program: Arc::clone(&program),
        stretches: stretches(ticks),
        takes_command,
        following: false,
        switched_on_in: None,
        received: Vec::new(),
        serial: String::new(),
        calibration: Vec::new(),
        ticks: Vec::new(),
    };
    let (tell, told) = mpsc::channel();
    let outcome = Bench::load(&path, stage)
        .map_err(no_bench)?
        .run(move |period| {
            if run.period(period).is_none() {
                return Break(());
            }
            if period.tick < END {
                return Continue(());
            }
            // Nobody is left to be told when the other side is gone.
            let _ = tell.send((std::mem::take(&mut run.ticks), run.answers()));
            Break(())
        });
    let outcome = outcome.map_err(no_bench)?;
    if !outcome.gaps.is_empty() {
        return Err(ChipError::Gaps(outcome.gaps));
    }
    let (mut ticks, answers) = told.recv().map_err(|_| ChipError::Lost)?;
    if answers != ANSWERS {
        return Err(ChipError::Answers(answers, ANSWERS.join(" ")));
    }
    keep_orders(&mut ticks);
    Ok(Used { program, ticks })
}

/// Where a tick handles a command: the instructions of the firmware's own function for it, wherever the compiler has put them. When the
/// trace tells of a command depends on when it is written.
fn takes_command(path: &Path, program: &Program) -> Result<BTreeSet<u64>, ChipError> {
    let lines =
        Loader::new(path).map_err(|error| ChipError::Lines(path.into(), error.to_string()))?;
    let is_in = |at: u64| {
        let mut frames = lines.find_frames(at).ok()?;
        while let Ok(Some(frame)) = frames.next() {
            let name = frame
                .function
                .and_then(|it| it.demangle().ok().map(Cow::into_owned));
            if name.is_some_and(|name| name.ends_with(HANDLE_COMMAND)) {
                return Some(at);
            }
        }
        None
    };
    let places: BTreeSet<u64> = program.addresses().filter_map(is_in).collect();
    (!places.is_empty())
        .then_some(places)
        .ok_or_else(|| ChipError::Lines(path.into(), format!("no function {HANDLE_COMMAND}")))
}

/// The function's name, or the end of it.
const HANDLE_COMMAND: &str = "handle_command";

/// Of the ticks in which an order to record may come, those that take it: the longest of each stretch, by far.
fn keep_orders(ticks: &mut Vec<UsedTick>) {
    let mut longest: BTreeMap<u64, (usize, u64)> = BTreeMap::new();
    for tick in ticks.iter().filter(|tick| tick.used == Use::RecordOrder) {
        let longest = longest.entry(tick.tick / 100).or_default();
        *longest = (*longest).max((tick.until_duties, tick.tick));
    }
    let taken: BTreeSet<u64> = longest.into_values().map(|(_, tick)| tick).collect();
    ticks.retain(|tick| tick.used != Use::RecordOrder || taken.contains(&tick.tick));
}

struct Run {
    program: Arc<Program>,
    stretches: Vec<Stretch>,
    /// Instructions by one of which a tick is known to take a command.
    takes_command: BTreeSet<u64>,
    following: bool,
    /// The stretch in which the servo was switched on, by where it begins.
    switched_on_in: Option<u64>,
    /// What has been answered.
    received: Vec<u8>,
    serial: String,
    /// Lines, the next one last.
    calibration: Vec<String>,
    ticks: Vec<UsedTick>,
}

impl Run {
    /// One control period; `None` where the ticks can not be followed.
    fn period(&mut self, period: &mut Period<'_>) -> Option<()> {
        // A chip that starts again counts from nothing, and would be sent the same lines for ever.
        if !period.resets.is_empty() {
            return None;
        }
        if self.following {
            for followed in period.followed()? {
                self.keep(followed);
            }
        }
        send(period);
        self.calibrate(period);
        let follow = self
            .stretches
            .iter()
            .any(|it| it.ticks.contains(&period.tick) && !self.is_over(it));
        if follow != self.following {
            self.following = follow;
            period
                .follow(follow.then_some(&self.program))
                .then_some(())?;
        }
        Some(())
    }

    /// Where the servo is switched on, what comes after is of no use.
    fn is_over(&self, stretch: &Stretch) -> bool {
        self.switched_on_in == Some(stretch.ticks.start)
    }

    /// Keeps a tick of one of the stretches, with what it was used for.
    fn keep(&mut self, followed: FollowedTick) {
        let tick = followed.tick;
        let mut stretches = self.stretches.iter();
        let Some(stretch) = stretches.find(|it| it.ticks.contains(&tick) && !self.is_over(it))
        else {
            return;
        };
        let mut steps = followed.steps.iter();
        let takes = steps.any(|step| self.takes_command.contains(&step.at));
        let taken = stretch.taken.filter(|_| takes);
        let used = taken.unwrap_or(stretch.used);
        // Where the stage rests meanwhile it does what it does when it moves.
        if used == Use::SettingsTakenShaped && !takes {
            return;
        }
        if used == Use::SwitchedOnCalibrated {
            self.switched_on_in = Some(stretch.ticks.start);
        }
        self.ticks.push(UsedTick {
            tick,
            used,
            steps: followed.steps,
            until_duties: followed.until_duties,
        });
    }

    /// What was answered, line by line, but for the serial number once that is known.
    fn answers(&self) -> Vec<String> {
        let text = String::from_utf8_lossy(&self.received);
        let lines = text.lines().map(str::trim);
        (lines.filter(|line| !line.is_empty() && *line != self.serial))
            .map(str::to_owned)
            .collect()
    }

    fn calibrate(&mut self, period: &mut Period<'_>) {
        self.received.extend(period.received());
        if period.tick == CALIBRATION_SENT {
            self.serial = self.answers().pop().unwrap_or_default();
            self.calibration = calibration(&self.serial);
        }
        if period.tick.is_multiple_of(CALIBRATION_EVERY)
            && let Some(line) = self.calibration.pop()
        {
            period.send(line.as_bytes());
        }
    }
}

/// The lines of a calibration of the machine of this serial number, the first one last.
fn calibration(serial: &str) -> Vec<String> {
    const DATE: &str = "2026-01-01";
    // As long as a text can be.
    let text = |text: &str| CalibrationText::try_from(text).unwrap_or_default();
    let machine = MachineCalibration {
        serial: text(serial),
        date: text(DATE),
        temperature_c: None,
        numbers: [[OFF_BY; COEFFICIENTS]; 3],
        is_on: true,
    };
    let mut lines = vec![format!("CAL END {}\n", machine.checksum())];
    let numbers = format!(" {OFF_BY:e}").repeat(LINE_NUMBERS);
    for pivot in 1..=3 {
        let places = (1..=COEFFICIENTS).step_by(LINE_NUMBERS);
        lines.extend(places.map(|place| format!("CAL SET {pivot} {place}{numbers}\n")));
    }
    lines.push(format!("CAL BEG {serial} {DATE}\n"));
    lines
}

fn send(period: &mut Period<'_>) {
    for (at, line) in LINES {
        if period.tick == at {
            period.send(line);
        }
    }
    if let Some(range) = SWITCHED.iter().find(|it| it.contains(&period.tick)) {
        let done = period.tick - range.start;
        let (round, at) = (done / SWITCHED_EVERY, done % SWITCHED_EVERY);
        if at == 0 {
            period.send(b"SVO X 0\n");
        } else if at == SWITCHED_AFTER + round {
            period.send(b"SVO X 1\n");
        }
    }
    if STREAM.contains(&period.tick) && period.tick.is_multiple_of(STREAM_EVERY) {
        let done = (period.tick - STREAM.start) as f64 / (STREAM.end - STREAM.start) as f64;
        let [start_x, start_y] = STREAM_START;
        let [x, y] = circle::offset_mm(done);
        let (x, y) = (start_x + x, start_y + y);
        period.send(format!("MOV X {x:.6} Y {y:.6}\n").as_bytes());
    }
}
