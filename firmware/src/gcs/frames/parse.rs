//! From lines to what they ask of the frames.

use super::keyword::{KINDS, keyword};
use super::request::{FrameQuery, ListItem};
use crate::commander::axis::{AxisSet, AxisValues};
use crate::commander::frames::{FrameChange, FrameKind, FrameName};
use crate::gcs::arguments::{ParseError, axis, number, values};
use crate::gcs::error::ErrorCode;
use crate::gcs::request::{Action, Request};
use crate::gcs::scan::Scanner;

/// What follows the name of a command about frames.
type Parsed = Result<Request, ParseError>;

const A_NAME: &str = "a frame's name: a letter, then letters, digits or _, 16 at most";

/// `KSD`, `KST` or `KSW`: a name, then pairs of axis and number; an axis that is not named is 0.
pub fn define(kind: FrameKind, scanner: &mut Scanner<'_>) -> Parsed {
    let name = name(scanner)?;
    let values = if scanner.is_at_end() {
        AxisValues::default()
    } else {
        values(scanner)?
    };
    act(FrameChange::Define(kind, name, values))
}

/// `KSF`
pub fn here(scanner: &mut Scanner<'_>) -> Parsed {
    act(FrameChange::Here(name(scanner)?))
}

/// `KLN`
pub fn link(scanner: &mut Scanner<'_>) -> Parsed {
    act(FrameChange::Link(name(scanner)?, name(scanner)?))
}

/// `KEN`
pub fn enable(scanner: &mut Scanner<'_>) -> Parsed {
    act(FrameChange::Enable(name(scanner)?))
}

/// `KRM`
pub fn remove(scanner: &mut Scanner<'_>) -> Parsed {
    act(FrameChange::Remove(name(scanner)?))
}

/// `SPI`: pairs of R, S or T and number.
pub fn rotation_centre(scanner: &mut Scanner<'_>) -> Parsed {
    let mut wanted = [None; 3];
    loop {
        let (place, word) = centre_axis(scanner)?;
        if wanted[place].is_some() {
            return Err(word);
        }
        wanted[place] = Some(number(scanner.next())?);
        if scanner.is_at_end() {
            return act(FrameChange::RotationCentre(wanted));
        }
    }
}

/// `SPI?`
pub fn rotation_centre_query(scanner: &mut Scanner<'_>) -> Parsed {
    let mut named = [false; 3];
    while !scanner.is_at_end() {
        let (place, word) = centre_axis(scanner)?;
        if named[place] {
            return Err(word);
        }
        named[place] = true;
    }
    ask(FrameQuery::RotationCentre(named))
}

/// `KEN?`
pub fn enabled(scanner: &mut Scanner<'_>) -> Parsed {
    ask(FrameQuery::Enabled(name_or_none(scanner)?))
}

/// `KLN?`
pub fn chains(scanner: &mut Scanner<'_>) -> Parsed {
    ask(FrameQuery::Chains(name_or_none(scanner)?))
}

/// `KLT?`
pub fn totals(scanner: &mut Scanner<'_>) -> Parsed {
    let start = name_or_none(scanner)?;
    ask(FrameQuery::Totals(start, name_or_none(scanner)?))
}

/// `KET?`
pub fn types(scanner: &mut Scanner<'_>) -> Parsed {
    let word = scanner.word();
    let kind = KINDS
        .into_iter()
        .find(|&kind| keyword(kind).as_bytes().eq_ignore_ascii_case(word.text));
    if kind.is_none() && !word.text.is_empty() {
        return Err(word.error(ErrorCode::OutOfRange, "a type: KSD, KSF, KST or KSW"));
    }
    ask(FrameQuery::Types(kind))
}

/// `KLS?`
pub fn list(scanner: &mut Scanner<'_>) -> Parsed {
    let name = name_or_none(scanner)?;
    let item = if scanner.is_at_end() {
        None
    } else {
        Some(list_item(scanner)?)
    };
    ask(FrameQuery::List(name, item))
}

fn list_item(scanner: &mut Scanner<'_>) -> Result<ListItem, ParseError> {
    let word = scanner.word();
    let is = |name: &str| word.text.eq_ignore_ascii_case(name.as_bytes());
    if is("TYPE") {
        Ok(ListItem::Type)
    } else if is("PARENT") {
        Ok(ListItem::Parent)
    } else if is("ENABLED") {
        Ok(ListItem::Enabled)
    } else if is("POS") {
        let axis = if scanner.is_at_end() {
            None
        } else {
            Some(axis(scanner.next(), &mut AxisSet::default())?)
        };
        Ok(ListItem::Position(axis))
    } else {
        Err(word.error(
            ErrorCode::OutOfRange,
            "an item: TYPE, PARENT, ENABLED or POS",
        ))
    }
}

fn act(action: FrameChange) -> Parsed {
    Ok(Request::Act(Action::Frame(action)))
}

fn ask(query: FrameQuery) -> Parsed {
    Ok(Request::Frames(query))
}

fn name(scanner: &mut Scanner<'_>) -> Result<FrameName, ParseError> {
    let word = scanner.word();
    if word.text.is_empty() {
        return Err(word.error(ErrorCode::ParameterCount, A_NAME));
    }
    FrameName::new(word.text).ok_or_else(|| word.error(ErrorCode::OutOfRange, A_NAME))
}

fn name_or_none(scanner: &mut Scanner<'_>) -> Result<Option<FrameName>, ParseError> {
    if scanner.is_at_end() {
        return Ok(None);
    }
    name(scanner).map(Some)
}

/// The place of R, S or T, and the error should it have been named before.
fn centre_axis(scanner: &mut Scanner<'_>) -> Result<(usize, ParseError), ParseError> {
    let word = scanner.next();
    let place = match word.text {
        b"R" | b"r" => 0,
        b"S" | b"s" => 1,
        b"T" | b"t" => 2,
        b"" => return Err(word.error(ErrorCode::ParameterCount, "R, S or T")),
        _ => return Err(word.error(ErrorCode::InvalidAxis, "R, S or T")),
    };
    Ok((
        place,
        word.error(
            ErrorCode::AxisTwice,
            "a coordinate that has not been named yet",
        ),
    ))
}
