//! What can be recorded: record options, their sources, and of what words of the tick each is worked out.
//!
//! Numbers under 200 are those that this family of controllers gives the same things; own ones begin there.

use crate::commander::axis::Axis;
use crate::recorder::{MAX_ROW_WORDS, RECORDER_TABLES, RawSignal};
use core::fmt;
use heapless::Vec;

/// Where a signal comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignalSource {
    /// `0`: the controller as a whole.
    Controller,
    /// `1` to `3`: a pivot, counted from 0 here.
    Pivot(u8),
    /// An axis.
    Axis(Axis),
}

/// What a table records.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Channel {
    /// The record option.
    pub option: u16,
    /// Where from.
    pub source: SignalSource,
    pub(super) signal: Signal,
}

/// How the value of a channel comes about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Signal {
    /// A frozen axis.
    Zero,
    /// A word.
    Word(RawSignal),
    /// Of the measured pose, which is worked out from the measured pivots here: that is too dear for the tick.
    Measured(u8),
    /// The same by the drawing, whatever the calibration says.
    MeasuredAsDrawn(u8),
    /// Measured pose minus its setpoint.
    Error(u8),
    /// Time since the trigger, which the row tells.
    Time,
}

/// A record option.
pub(super) struct RecordOption {
    pub number: u16,
    /// What it is, in a few words.
    pub name: &'static str,
    /// Of what, and its unit.
    pub detail: &'static str,
    signal: fn(SignalSource) -> Option<Signal>,
}

/// Nothing is recorded.
pub(super) const OPTION_OFF: u16 = 0;

/// Every option that records something.
#[rustfmt::skip]
pub(super) const OPTIONS: &[RecordOption] = &[
    option(1, "commanded position", " of axis or pivot, mm or deg", |source| match source {
        SignalSource::Axis(axis) => Some(of_axis(axis, |i| Signal::Word(setpoint(i)))),
        SignalSource::Pivot(i) => Some(Signal::Word(RawSignal::PivotSetpoint(i))),
        SignalSource::Controller => None,
    }),
    option(2, "real position", " of axis or pivot, mm or deg", |source| match source {
        SignalSource::Axis(axis) => Some(of_axis(axis, Signal::Measured)),
        SignalSource::Pivot(i) => Some(Signal::Word(RawSignal::Pivot(i))),
        SignalSource::Controller => None,
    }),
    option(3, "position error", " of axis or pivot, real minus commanded, mm or deg", |source| match source {
        SignalSource::Axis(axis) => Some(of_axis(axis, Signal::Error)),
        SignalSource::Pivot(i) => Some(Signal::Word(RawSignal::PivotError(i))),
        SignalSource::Controller => None,
    }),
    option(8, "time since the trigger", ", s", |source| of_controller(source, Signal::Time)),
    option(70, "commanded velocity", " of axis or pivot, mm/s or deg/s", |source| match source {
        SignalSource::Axis(axis) => Some(of_axis(axis, |i| Signal::Word(RawSignal::Velocity(i)))),
        SignalSource::Pivot(i) => Some(Signal::Word(RawSignal::PivotRate(i))),
        SignalSource::Controller => None,
    }),
    option(71, "commanded acceleration", " of axis, mm/s^2 or deg/s^2", |source| match source {
        SignalSource::Axis(axis) => Some(of_axis(axis, |i| Signal::Word(RawSignal::Acceleration(i)))),
        _ => None,
    }),
    option(73, "motor output", " of pivot, duty from -1 to 1", |source| of_pivot(source, RawSignal::Duty)),
    option(200, "motor current", " of pivot, A", |source| of_pivot(source, RawSignal::Current)),
    option(201, "supply", ", V", |source| of_controller(source, Signal::Word(RawSignal::Supply))),
    option(202, "state", ": 0 off, 1 holding, 2 moving, 3 fault, 4 stopping at a fault, 5 excited", |source| of_controller(source, Signal::Word(RawSignal::Mode))),
    option(203, "fault", ": kind of the latched one, 0 for none", |source| of_controller(source, Signal::Word(RawSignal::Fault))),
    option(204, "cost of the tick before", ", processor cycles", |source| of_controller(source, Signal::Word(RawSignal::Cost))),
    option(205, "integral", " of pivot, what its feedback has collected, V", |source| of_pivot(source, RawSignal::Integral)),
    option(206, "model current", " of pivot, its motor's by the model, A", |source| of_pivot(source, RawSignal::ModelCurrent)),
    option(207, "learnt of the rate", " of pivot, besides the model's, V s/rad", |source| of_pivot(source, RawSignal::LearntRate)),
    option(208, "learnt of the torque", " of pivot, besides the model's, V/(N m)", |source| of_pivot(source, RawSignal::LearntTorque)),
    option(209, "learnt of friction", " of pivot, besides the model's, V", |source| of_pivot(source, RawSignal::LearntFriction)),
    option(210, "real position without the calibration", " of axis, mm or deg", |source| match source {
        SignalSource::Axis(axis) => Some(of_axis(axis, Signal::MeasuredAsDrawn)),
        _ => None,
    }),
];

const fn option(
    number: u16,
    name: &'static str,
    detail: &'static str,
    signal: fn(SignalSource) -> Option<Signal>,
) -> RecordOption {
    RecordOption {
        number,
        name,
        detail,
        signal,
    }
}

fn of_axis(axis: Axis, signal: fn(u8) -> Signal) -> Signal {
    axis.component().map_or(Signal::Zero, |i| signal(i as u8))
}

fn of_pivot(source: SignalSource, word: fn(u8) -> RawSignal) -> Option<Signal> {
    match source {
        SignalSource::Pivot(i) => Some(Signal::Word(word(i))),
        _ => None,
    }
}

fn of_controller(source: SignalSource, signal: Signal) -> Option<Signal> {
    (source == SignalSource::Controller).then_some(signal)
}

/// What the tables record before they are told.
pub(super) const DEFAULT_CHANNELS: [Channel; RECORDER_TABLES] = [
    commanded_channel(Axis::X, RawSignal::Centre(0)),
    measured_channel(Axis::X, 0),
    commanded_channel(Axis::Y, RawSignal::Centre(1)),
    measured_channel(Axis::Y, 1),
    commanded_channel(Axis::W, RawSignal::Theta),
    measured_channel(Axis::W, 2),
    Channel {
        option: 73,
        source: SignalSource::Pivot(0),
        signal: Signal::Word(RawSignal::Duty(0)),
    },
    Channel {
        option: 202,
        source: SignalSource::Controller,
        signal: Signal::Word(RawSignal::Mode),
    },
];

const fn commanded_channel(axis: Axis, word: RawSignal) -> Channel {
    Channel {
        option: 1,
        source: SignalSource::Axis(axis),
        signal: Signal::Word(word),
    }
}

const fn measured_channel(axis: Axis, component: u8) -> Channel {
    Channel {
        option: 2,
        source: SignalSource::Axis(axis),
        signal: Signal::Measured(component),
    }
}

pub(super) const PIVOTS: [RawSignal; 3] = [
    RawSignal::Pivot(0),
    RawSignal::Pivot(1),
    RawSignal::Pivot(2),
];

impl SignalSource {
    /// The source of a name, in either case.
    pub(super) fn named(name: &[u8]) -> Option<Self> {
        match name {
            b"0" => Some(Self::Controller),
            [digit @ b'1'..=b'3'] => Some(Self::Pivot(digit - b'1')),
            name => Axis::named(name).map(Self::Axis),
        }
    }
}

impl fmt::Display for SignalSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Controller => f.write_str("0"),
            Self::Pivot(i) => write!(f, "{}", i + 1),
            Self::Axis(axis) => write!(f, "{}", axis.letter()),
        }
    }
}

impl Channel {
    /// An option of a source; `None` when there is no such option, or not of this source.
    pub(super) fn new(option: u16, source: SignalSource) -> Option<Self> {
        let known = OPTIONS.iter().find(|known| known.number == option)?;
        Some(Self {
            option,
            source,
            signal: (known.signal)(source)?,
        })
    }

    /// The word whose crossing of a value can trigger; none where the value is worked out after the tick.
    pub(super) fn trigger_word(self) -> Option<RawSignal> {
        match self.signal {
            Signal::Word(word) => Some(word),
            _ => None,
        }
    }

    fn words(self) -> impl Iterator<Item = RawSignal> {
        let (own, pivots) = match self.signal {
            Signal::Zero | Signal::Time => (None, false),
            Signal::Word(word) => (Some(word), false),
            Signal::Measured(_) | Signal::MeasuredAsDrawn(_) => (None, true),
            Signal::Error(i) => (Some(setpoint(i)), true),
        };
        let pivots = PIVOTS.into_iter().filter(move |_| pivots);
        own.into_iter().chain(pivots)
    }

    fn unit(self) -> &'static str {
        let of_axis = |mm: &'static str, deg: &'static str| match self.source {
            SignalSource::Axis(axis) if axis.unit() == "mm" => mm,
            _ => deg,
        };
        match self.option {
            1..=3 | 210 => of_axis("mm", "deg"),
            8 => "s",
            70 => of_axis("mm/s", "deg/s"),
            71 => of_axis("mm/s^2", "deg/s^2"),
            200 | 206 => "A",
            201 | 205 | 209 => "V",
            204 => "cycles",
            207 => "V s/rad",
            208 => "V/(N m)",
            _ => "",
        }
    }

    /// Whether its values are whole numbers.
    pub(super) const fn is_whole(self) -> bool {
        matches!(
            self.signal,
            Signal::Word(RawSignal::Mode | RawSignal::Fault | RawSignal::Cost)
        )
    }
}

/// What it is and its unit, for the head of `DRR?`: a text without `=`.
impl fmt::Display for Channel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let known = OPTIONS.iter().find(|known| known.number == self.option);
        f.write_str(known.map_or("", |known| known.name))?;
        match self.source {
            SignalSource::Controller => {}
            SignalSource::Pivot(i) => write!(f, " of pivot {}", i + 1)?,
            SignalSource::Axis(axis) => write!(f, " of {}", axis.letter())?,
        }
        match self.unit() {
            "" => Ok(()),
            unit => write!(f, ", {unit}"),
        }
    }
}

/// The setpoint of a component of the pose.
pub(super) const fn setpoint(component: u8) -> RawSignal {
    match component {
        2 => RawSignal::Theta,
        i => RawSignal::Centre(i),
    }
}

/// The words of a row from which all channels can be worked out, each once.
pub(super) fn words(
    channels: &[Option<Channel>; RECORDER_TABLES],
) -> Vec<RawSignal, MAX_ROW_WORDS> {
    let mut words = Vec::new();
    for word in channels
        .iter()
        .flatten()
        .flat_map(|channel| channel.words())
    {
        if !words.contains(&word) {
            // There is room: the three errors of the pose, the worst, need six words for three tables.
            let _ = words.push(word);
        }
    }
    words
}
