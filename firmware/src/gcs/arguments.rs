//! What follows a command's name, word by word: what every command's parser is made of.

use super::error::ErrorCode;
use super::request::{Query, Request};
use super::scan::{Scanner, Word};
use super::text::Text;
use crate::commander::axis::{Axis, AxisSet, AxisValues};
use core::fmt;

/// What is wrong with a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ParseError {
    /// The number that `ERR?` will answer.
    pub code: ErrorCode,
    /// Where, in bytes from the start of the line, counted from 1.
    pub column: usize,
    /// What should stand there.
    pub expected: &'static str,
}

impl fmt::Display for ParseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "column {}: expected {} (error {})",
            self.column,
            self.expected,
            self.code.number()
        )
    }
}

impl core::error::Error for ParseError {}

impl Word<'_> {
    pub(super) const fn error(&self, code: ErrorCode, expected: &'static str) -> ParseError {
        ParseError {
            code,
            column: self.column,
            expected,
        }
    }
}

pub(super) fn end(scanner: &mut Scanner<'_>) -> Result<(), ParseError> {
    let extra = scanner.next();
    if extra.text.is_empty() {
        return Ok(());
    }
    Err(extra.error(ErrorCode::ParameterCount, "the end of the line"))
}

/// The axes named up to the end of the line; all when none is.
pub(super) fn axes(scanner: &mut Scanner<'_>) -> Result<AxisSet, ParseError> {
    let mut set = AxisSet::EMPTY;
    while !scanner.is_at_end() {
        axis(scanner.next(), &mut set)?;
    }
    Ok(if set.is_empty() { AxisSet::ALL } else { set })
}

/// Pairs of axis and number up to the end of the line, at least one.
pub(super) fn values(scanner: &mut Scanner<'_>) -> Result<AxisValues, ParseError> {
    let mut named = AxisSet::EMPTY;
    let mut values = AxisValues::default();
    loop {
        let axis = axis(scanner.next(), &mut named)?;
        values[axis.index()] = Some(number(scanner.next())?);
        if scanner.is_at_end() {
            return Ok(values);
        }
    }
}

/// One axis, which `named` must not hold yet.
pub(super) fn axis(word: Word<'_>, named: &mut AxisSet) -> Result<Axis, ParseError> {
    if word.text.is_empty() {
        return Err(word.error(ErrorCode::ParameterCount, "an axis"));
    }
    let axis = Axis::named(word.text)
        .ok_or_else(|| word.error(ErrorCode::InvalidAxis, "an axis: X, Y, Z, U, V or W"))?;
    if !named.insert(axis) {
        return Err(word.error(ErrorCode::AxisTwice, "an axis that has not been named yet"));
    }
    Ok(axis)
}

pub(super) fn number(word: Word<'_>) -> Result<f64, ParseError> {
    if word.text.is_empty() {
        return Err(word.error(ErrorCode::ParameterCount, "a number"));
    }
    // `parse` knows "inf" and "nan" too, and makes an infinity of what is too large: neither is a position.
    core::str::from_utf8(word.text)
        .ok()
        .and_then(|text| text.parse::<f64>().ok())
        .filter(|value| value.is_finite())
        // Adding 0 turns -0 into 0.
        .map(|value| value + 0.0)
        .ok_or_else(|| word.error(ErrorCode::InvalidNumber, "a number"))
}

/// `SAI?`: nothing or `ALL`.
pub(super) fn axis_identifiers(scanner: &mut Scanner<'_>) -> Result<Request, ParseError> {
    let word = scanner.next();
    if word.text.is_empty() || word.text.eq_ignore_ascii_case(b"ALL") {
        return Ok(Request::Query(Query::Axes));
    }
    Err(word.error(ErrorCode::ParameterCount, "ALL or the end of the line"))
}

/// Numbers of joysticks that may be asked for.
const JOYSTICKS: f64 = 8.0;

/// `JON?`: joysticks by their numbers; none stands for the first.
pub(super) fn joysticks(scanner: &mut Scanner<'_>) -> Result<Request, ParseError> {
    let mut named = 0_u8;
    while !scanner.is_at_end() {
        let number = whole(scanner.next(), 1.0, JOYSTICKS)?;
        named |= 1 << (number as u8 - 1);
    }
    Ok(Request::Query(Query::Joysticks(named.max(1))))
}

/// A value, if one follows.
pub(super) fn optional_text(scanner: &mut Scanner<'_>) -> Result<Option<Text>, ParseError> {
    let word = scanner.word();
    if word.text.is_empty() {
        return Ok(None);
    }
    let text = Text::new(word.text);
    text.map(Some).ok_or_else(|| {
        word.error(
            ErrorCode::OutOfRange,
            "a value of 32 printable characters at most",
        )
    })
}

/// A whole number of a range.
pub(super) fn whole(word: Word<'_>, lowest: f64, highest: f64) -> Result<f64, ParseError> {
    let value = number(word)?;
    if libm::rint(value) == value && (lowest..=highest).contains(&value) {
        return Ok(value);
    }
    Err(word.error(ErrorCode::OutOfRange, "a whole number"))
}

/// A word that has to be there.
pub(super) fn required<'a>(
    scanner: &mut Scanner<'a>,
    expected: &'static str,
) -> Result<Word<'a>, ParseError> {
    let word = scanner.word();
    if word.text.is_empty() {
        return Err(word.error(ErrorCode::ParameterCount, expected));
    }
    Ok(word)
}
