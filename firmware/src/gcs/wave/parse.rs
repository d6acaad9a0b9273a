//! From lines to what they ask of tables and generators.

use super::request::WaveQuery;
use crate::commander::wave::{
    Curve, Join, LINE_POINTS, MAX_TABLE_POINTS, Shape, WAVE_TABLES, WaveChange, WavePoints,
};
use crate::gcs::arguments::{ParseError, number};
use crate::gcs::error::ErrorCode;
use crate::gcs::request::{Action, Request};
use crate::gcs::scan::{Scanner, Word};
use heapless::Vec;

/// What follows the name of a command about waveforms.
type Parsed = Result<Request, ParseError>;

/// `WAV`: table, how it joins, type, and what the type takes.
pub fn define(scanner: &mut Scanner<'_>) -> Parsed {
    let table = place::<WAVE_TABLES>(scanner)? as u8;
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
    // They fit, as the values did.
    WavePoints::new(&values)
        .ok_or(column.error(ErrorCode::ParameterCount, "how many points follow"))
}

/// `WCL`
pub fn clear(scanner: &mut Scanner<'_>) -> Parsed {
    let mut wanted = [false; WAVE_TABLES];
    loop {
        wanted[place::<WAVE_TABLES>(scanner)?] = true;
        if scanner.is_at_end() {
            return act(WaveChange::Clear(wanted));
        }
    }
}

/// `WSL`
pub fn select(scanner: &mut Scanner<'_>) -> Parsed {
    let tables = pairs(scanner, WAVE_TABLES as u32)?;
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
    act(WaveChange::Switch(
        modes.map(|mode| mode.map(|mode| mode == 1)),
    ))
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
    let mut named = [false; WAVE_TABLES];
    while !scanner.is_at_end() {
        named[place::<WAVE_TABLES>(scanner)?] = true;
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
