//! From lines to what they ask of tables and generators.

use crate::commander::wave::{Curve, Join, MAX_TABLE_POINTS, Shape, TABLES};
use crate::gcs::error::ErrorCode;
use crate::gcs::parse::{ParseError, number};
use crate::gcs::request::{Action, Request};
use crate::gcs::scan::{Scanner, Word};
use heapless::Vec;

/// Points that one line can give.
pub const LINE_POINTS: usize = 32;

/// Points of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WavePoints {
    values: [f64; LINE_POINTS],
    count: u8,
}

impl WavePoints {
    /// The points.
    pub fn values(&self) -> &[f64] {
        let count = usize::from(self.count).min(LINE_POINTS);
        &self.values[..count]
    }
}

/// What is to be done with tables and generators. Tables are counted from 0, generators are the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
// A line's points are by far the largest; there is no heap to box them in.
#[allow(clippy::large_enum_variant)]
pub enum WaveChange {
    /// `WAV`, calculated.
    Define {
        /// Which.
        table: u8,
        /// How it joins.
        join: Join,
        /// Points of the segment.
        length: u32,
        /// Its curve.
        shape: Shape,
    },
    /// `WAV PNT`
    Points {
        /// Which.
        table: u8,
        /// How it joins.
        join: Join,
        /// The values.
        points: WavePoints,
    },
    /// `WCL`: a flag for each table.
    Clear([bool; TABLES]),
    /// `WSL`: a table (from 1, 0: none) for each generator.
    Select([Option<u32>; 6]),
    /// `WGC`: cycles of each generator.
    Cycles([Option<u32>; 6]),
    /// `WTR`: ticks of a point.
    Rate(u32),
    /// `WGO`: 1 starts, 0 stops.
    Go([Option<u32>; 6]),
}

/// A question about tables and generators: a flag for each that was named, none stands for all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaveQuery {
    /// `WAV?`
    Lengths([bool; TABLES]),
    /// `TWG?`
    Generators,
    /// `#9`: mask of those that run, hexadecimal.
    Mask,
    /// `WSL?`
    Tables([bool; 6]),
    /// `WGC?`
    Cycles([bool; 6]),
    /// `WTR?`
    Rates([bool; 6]),
    /// `WGO?`
    Running([bool; 6]),
}

/// What follows the name of a command about waveforms.
type Parsed = Result<Request, ParseError>;

/// `WAV`: table, how it joins, type, and what the type takes.
pub fn define(scanner: &mut Scanner<'_>) -> Parsed {
    let table = place::<TABLES>(scanner)? as u8;
    let word = scanner.word();
    let join = match word.text {
        b"X" | b"x" => Join::Anew,
        b"&" => Join::Append,
        b"+" => Join::Add,
        b"" => return Err(word.error(ErrorCode::ParameterCount, "X, & or +")),
        _ => return Err(word.error(ErrorCode::OutOfRange, "X, & or +")),
    };
    let word = scanner.word();
    let is = |name: &[u8]| word.text.eq_ignore_ascii_case(name);
    if is(b"PNT") {
        let points = points(scanner)?;
        return act(WaveChange::Points {
            table,
            join,
            points,
        });
    }
    let (line, ramp, sine) = (is(b"LIN"), is(b"RAMP"), is(b"SIN_P"));
    if !(line || ramp || sine) {
        return Err(word.error(ErrorCode::OutOfRange, "PNT, LIN, RAMP or SIN_P"));
    }
    let length = whole(scanner)?;
    let (amplitude, offset) = (number(scanner.word())?, number(scanner.word())?);
    let curve = Curve {
        amplitude,
        offset,
        length: whole(scanner)?,
        start: whole(scanner)?,
    };
    let shape = if sine {
        Shape::Sine {
            curve,
            centre: whole(scanner)?,
        }
    } else {
        let speed_points = whole(scanner)?;
        if line {
            Shape::Line {
                curve,
                speed_points,
            }
        } else {
            Shape::Ramp {
                curve,
                speed_points,
                centre: whole(scanner)?,
            }
        }
    };
    act(WaveChange::Define {
        table,
        join,
        length,
        shape,
    })
}

/// The first point's number, how many there are, and all of them.
fn points(scanner: &mut Scanner<'_>) -> Result<WavePoints, ParseError> {
    // Where the segment goes is what `X`, `&` and `+` say; clients count on in lines that append.
    whole(scanner)?;
    let column = scanner.peek_word();
    let count = whole(scanner)?;
    let mut values: Vec<f64, LINE_POINTS> = Vec::new();
    while !scanner.is_at_end() {
        let word = scanner.word();
        let full = word.error(ErrorCode::ParameterCount, "32 points at most in a line");
        values.push(number(word)?).map_err(|_| full)?;
    }
    if values.is_empty() || values.len() != count as usize {
        return Err(column.error(ErrorCode::ParameterCount, "how many points follow"));
    }
    let mut points = WavePoints {
        values: [0.0; LINE_POINTS],
        count: values.len() as u8,
    };
    for (point, value) in points.values.iter_mut().zip(&values) {
        *point = *value;
    }
    Ok(points)
}

/// `WCL`
pub fn clear(scanner: &mut Scanner<'_>) -> Parsed {
    let mut wanted = [false; TABLES];
    loop {
        wanted[place::<TABLES>(scanner)?] = true;
        if scanner.is_at_end() {
            return act(WaveChange::Clear(wanted));
        }
    }
}

/// `WSL`
pub fn select(scanner: &mut Scanner<'_>) -> Parsed {
    let tables = pairs(scanner, TABLES as u32)?;
    act(WaveChange::Select(tables))
}

/// `WGC`
pub fn cycles(scanner: &mut Scanner<'_>) -> Parsed {
    let cycles = pairs(scanner, MAX_TABLE_POINTS)?;
    act(WaveChange::Cycles(cycles))
}

/// `WGO`
pub fn go(scanner: &mut Scanner<'_>) -> Parsed {
    let modes = pairs(scanner, 1)?;
    act(WaveChange::Go(modes))
}

/// `WTR`: triples of generator (0: all, as any of them does), ticks a point and interpolation, which is what it is.
pub fn rate(scanner: &mut Scanner<'_>) -> Parsed {
    let mut ticks;
    loop {
        within(scanner, 0, 6)?;
        ticks = whole(scanner)?;
        within(scanner, 0, 1)?;
        if scanner.is_at_end() {
            return act(WaveChange::Rate(ticks));
        }
    }
}

/// `WAV?`: pairs of table and 1, which asks for the length.
pub fn lengths(scanner: &mut Scanner<'_>) -> Parsed {
    let mut named = [false; TABLES];
    while !scanner.is_at_end() {
        named[place::<TABLES>(scanner)?] = true;
        within(scanner, 1, 1)?;
    }
    ask(WaveQuery::Lengths(named))
}

/// `TWG?`
pub fn count(_: &mut Scanner<'_>) -> Parsed {
    ask(WaveQuery::Generators)
}

/// `WSL?`, `WGC?`, `WTR?`, `WGO?`
pub fn generators(query: fn([bool; 6]) -> WaveQuery, scanner: &mut Scanner<'_>) -> Parsed {
    let mut named = [false; 6];
    while !scanner.is_at_end() {
        named[place::<6>(scanner)?] = true;
    }
    ask(query(named))
}

fn act(action: WaveChange) -> Parsed {
    Ok(Request::Act(Action::Wave(action)))
}

fn ask(query: WaveQuery) -> Parsed {
    Ok(Request::Waveforms(query))
}

/// Pairs of generator and a number up to `most`, at least one.
fn pairs(scanner: &mut Scanner<'_>, most: u32) -> Result<[Option<u32>; 6], ParseError> {
    let mut values = [None; 6];
    loop {
        let word = scanner.peek_word();
        let place = place::<6>(scanner)?;
        if values[place].is_some() {
            return Err(word.error(
                ErrorCode::AxisTwice,
                "a generator that has not been named yet",
            ));
        }
        values[place] = Some(within(scanner, 0, most)?);
        if scanner.is_at_end() {
            return Ok(values);
        }
    }
}

/// Something counted from 1 to `COUNT`, counted from 0.
fn place<const COUNT: usize>(scanner: &mut Scanner<'_>) -> Result<usize, ParseError> {
    let number = within(scanner, 1, COUNT as u32)?;
    Ok(number as usize - 1)
}

fn whole(scanner: &mut Scanner<'_>) -> Result<u32, ParseError> {
    within(scanner, 0, MAX_TABLE_POINTS)
}

/// A whole number of a range.
fn within(scanner: &mut Scanner<'_>, least: u32, most: u32) -> Result<u32, ParseError> {
    let word: Word<'_> = scanner.word();
    let value = number(word)?;
    if !(f64::from(least)..=f64::from(most)).contains(&value) || value != libm::trunc(value) {
        return Err(word.error(ErrorCode::OutOfRange, "a whole number that is there"));
    }
    Ok(value as u32)
}
