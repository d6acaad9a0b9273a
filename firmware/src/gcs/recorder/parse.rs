//! Understanding the lines about the recorder.

use super::channel::{Channel, OPTION_OFF, SignalSource};
use super::trigger::Trigger;
use super::{RecordAction, RecordQuery, TableList};
use crate::gcs::arguments::{ParseError, number};
use crate::gcs::error::ErrorCode;
use crate::gcs::request::{Action, Request};
use crate::gcs::scan::{Scanner, Word};
use crate::recorder::RECORDER_TABLES;

type Parsed = Result<Request, ParseError>;

const A_TABLE: &str = "a table, 1 to 8";

/// `DRC?`
pub(in crate::gcs) fn channels(scanner: &mut Scanner<'_>) -> Parsed {
    Ok(Request::Record(RecordQuery::Channels(tables(scanner)?)))
}

/// `DRT?`
pub(in crate::gcs) fn triggers(scanner: &mut Scanner<'_>) -> Parsed {
    Ok(Request::Record(RecordQuery::Triggers(tables(scanner)?)))
}

/// `DRL?`
pub(in crate::gcs) fn lengths(scanner: &mut Scanner<'_>) -> Parsed {
    Ok(Request::Record(RecordQuery::Lengths(tables(scanner)?)))
}

/// `RTR?`
pub(in crate::gcs) fn rate(_: &mut Scanner<'_>) -> Parsed {
    Ok(Request::Record(RecordQuery::Rate))
}

/// `HDR?`
pub(in crate::gcs) fn help(_: &mut Scanner<'_>) -> Parsed {
    Ok(Request::Record(RecordQuery::Help))
}

/// `TNR?`
pub(in crate::gcs) fn count(_: &mut Scanner<'_>) -> Parsed {
    Ok(Request::Record(RecordQuery::Count))
}

/// `FLR?`
pub(in crate::gcs) fn fault_record(_: &mut Scanner<'_>) -> Parsed {
    Ok(Request::Record(RecordQuery::FaultRecord))
}

/// `DRR?`: first row and number of rows, then tables; all of each that is not named.
pub(in crate::gcs) fn data(scanner: &mut Scanner<'_>) -> Parsed {
    if scanner.is_at_end() {
        return Ok(Request::Record(RecordQuery::Data(
            None,
            TableList::default(),
        )));
    }
    let most = f64::from(u32::MAX);
    let first = whole(scanner.next(), 1.0, most, ErrorCode::OutOfRange)?;
    let rows = whole(scanner.next(), 1.0, most, ErrorCode::OutOfRange)?;
    let span = Some([first as u32, rows as u32]);
    Ok(Request::Record(RecordQuery::Data(span, tables(scanner)?)))
}

/// `RTR`
pub(in crate::gcs) fn set_rate(scanner: &mut Scanner<'_>) -> Parsed {
    let ticks = number(scanner.next())?;
    Ok(Request::Act(Action::Record(RecordAction::Rate(ticks))))
}

/// `DRC`: triples of table, source and option.
pub(in crate::gcs) fn set_channels(scanner: &mut Scanner<'_>) -> Parsed {
    let mut changes = [None; RECORDER_TABLES];
    for change in &mut changes {
        let table = table(scanner.next())?;
        let source = scanner.next();
        if source.text.is_empty() {
            return Err(source.error(ErrorCode::ParameterCount, "a source"));
        }
        let from = SignalSource::named(source.text)
            .ok_or_else(|| source.error(ErrorCode::InvalidAxis, "a source: 0 to 3 or an axis"))?;
        let option = scanner.next();
        let what = whole(option, 0.0, 65_535.0, ErrorCode::UnknownOption)? as u16;
        let channel = match what {
            OPTION_OFF => None,
            _ => Some(Channel::new(what, from).ok_or_else(|| {
                option.error(
                    ErrorCode::UnknownOption,
                    "an option of this source, of those HDR? lists",
                )
            })?),
        };
        *change = Some((table, channel));
        if scanner.is_at_end() {
            break;
        }
    }
    Ok(Request::Act(Action::Record(RecordAction::Channels(
        changes,
    ))))
}

/// `DRT`: triples of table (0 for all), trigger and value; the value may be left out at the end.
pub(in crate::gcs) fn set_triggers(scanner: &mut Scanner<'_>) -> Parsed {
    let mut changes = [None; RECORDER_TABLES];
    for place in 0..RECORDER_TABLES {
        let word = scanner.next();
        let table = whole(word, 0.0, RECORDER_TABLES as f64, ErrorCode::NoSuchTable)? as u8;
        let which = scanner.next();
        let kind = whole(which, 0.0, 65_535.0, ErrorCode::OutOfRange)? as u16;
        let value = if scanner.is_at_end() {
            0.0
        } else {
            number(scanner.next())?
        };
        let trigger = Trigger::new(kind, value)
            .ok_or_else(|| which.error(ErrorCode::OutOfRange, "a trigger of those HDR? lists"))?;
        match table {
            0 => changes = core::array::from_fn(|table| Some((table as u8, trigger))),
            table => changes[place] = Some((table - 1, trigger)),
        }
        if scanner.is_at_end() {
            break;
        }
        if table == 0 {
            let more = scanner.next();
            return Err(more.error(ErrorCode::ParameterCount, "the end of the line"));
        }
    }
    Ok(Request::Act(Action::Record(RecordAction::Triggers(
        changes,
    ))))
}

/// The tables named up to the end of the line.
fn tables(scanner: &mut Scanner<'_>) -> Result<TableList, ParseError> {
    let mut named = [0; RECORDER_TABLES];
    let mut count = 0;
    while count < RECORDER_TABLES && !scanner.is_at_end() {
        named[count] = table(scanner.next())?;
        count += 1;
    }
    Ok(TableList::of(named.into_iter().take(count)))
}

/// A table, counted from 0.
fn table(word: Word<'_>) -> Result<u8, ParseError> {
    Ok(whole(word, 1.0, RECORDER_TABLES as f64, ErrorCode::NoSuchTable)? as u8 - 1)
}

/// A whole number from `least` to `most`; `outside` is the error of another one.
fn whole(word: Word<'_>, least: f64, most: f64, outside: ErrorCode) -> Result<f64, ParseError> {
    let value = number(word)?;
    if libm::trunc(value) != value {
        return Err(word.error(ErrorCode::InvalidNumber, "a whole number"));
    }
    if !(least..=most).contains(&value) {
        let expected = match outside {
            ErrorCode::NoSuchTable => A_TABLE,
            ErrorCode::UnknownOption => "an option of those HDR? lists",
            _ => "a number in range",
        };
        return Err(word.error(outside, expected));
    }
    Ok(value)
}
