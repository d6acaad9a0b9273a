//! Understanding the lines about macros and variables.

use super::MacroRequest;
use crate::gcs::error::ErrorCode;
use crate::gcs::parse::{ParseError, number};
use crate::gcs::scan::{Scanner, Word};
use crate::gcs::text::{Name, Text};
use crate::gcs::variables::{MAX_NAMED_VARIABLES, VariableRequest};

/// What follows a command about macros or variables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::gcs) enum MacroSyntax {
    /// A name.
    Begin,
    /// A name.
    Delete,
    /// A name and two arguments at most.
    Start,
    /// A name, a number and two arguments at most.
    StartTimes,
    /// A name or nothing.
    Stop,
    /// A name or nothing.
    List,
}

/// The rest of a line about macros.
pub(in crate::gcs) fn macro_request(
    syntax: MacroSyntax,
    scanner: &mut Scanner<'_>,
) -> Result<MacroRequest, ParseError> {
    Ok(match syntax {
        MacroSyntax::Begin => MacroRequest::Begin(macro_name(scanner)?),
        MacroSyntax::Delete => MacroRequest::Delete(macro_name(scanner)?),
        MacroSyntax::Start => MacroRequest::Start(macro_name(scanner)?, 1, arguments(scanner)?),
        MacroSyntax::StartTimes => {
            let (name, times) = (macro_name(scanner)?, scanner.word());
            let count = whole(times, 1.0, f64::from(u32::MAX))?;
            MacroRequest::Start(name, count as u32, arguments(scanner)?)
        }
        MacroSyntax::Stop => MacroRequest::Stop(optional_name(scanner)?),
        MacroSyntax::List => MacroRequest::List(optional_name(scanner)?),
    })
}

/// What follows `VAR`: a name and, unless it is to be forgotten, a value.
pub(in crate::gcs) fn set(scanner: &mut Scanner<'_>) -> Result<VariableRequest, ParseError> {
    let name = variable(scanner)?;
    Ok(VariableRequest::Set(name, optional_text(scanner)?))
}

/// What follows `ADD`: a name and two numbers.
pub(in crate::gcs) fn add(scanner: &mut Scanner<'_>) -> Result<VariableRequest, ParseError> {
    let name = variable(scanner)?;
    let (a, b) = (number(scanner.word())?, number(scanner.word())?);
    Ok(VariableRequest::Add(name, a, b))
}

/// What follows `VAR?`: names.
pub(in crate::gcs) fn tell(scanner: &mut Scanner<'_>) -> Result<VariableRequest, ParseError> {
    let mut names = [None; MAX_NAMED_VARIABLES];
    for place in &mut names {
        if scanner.is_at_end() {
            break;
        }
        *place = Some(variable(scanner)?);
    }
    Ok(VariableRequest::Query(names))
}

/// What follows `JRC`, before its condition: how many lines to go.
pub(in crate::gcs) fn jump(scanner: &mut Scanner<'_>) -> Result<i32, ParseError> {
    let most = f64::from(i32::MAX);
    Ok(whole(scanner.word(), -most, most)? as i32)
}

/// The name of a variable: a digit, or what starts with none.
pub(in crate::gcs) fn variable(scanner: &mut Scanner<'_>) -> Result<Name, ParseError> {
    let word = required(scanner, "a variable's name")?;
    let starts_well = |name: &Name| {
        name.digit().is_some() || name.as_bytes().first().is_some_and(|b| !b.is_ascii_digit())
    };
    Name::named(word.text)
        .filter(starts_well)
        .ok_or_else(|| word.error(ErrorCode::InvalidIdentifier, "a variable's name"))
}

fn macro_name(scanner: &mut Scanner<'_>) -> Result<Name, ParseError> {
    let word = required(scanner, "a macro's name")?;
    Name::named(word.text).ok_or_else(|| word.error(ErrorCode::MacroName, "a macro's name"))
}

fn optional_name(scanner: &mut Scanner<'_>) -> Result<Option<Name>, ParseError> {
    if scanner.is_at_end() {
        return Ok(None);
    }
    macro_name(scanner).map(Some)
}

fn arguments(scanner: &mut Scanner<'_>) -> Result<[Option<Text>; 2], ParseError> {
    Ok([optional_text(scanner)?, optional_text(scanner)?])
}

fn optional_text(scanner: &mut Scanner<'_>) -> Result<Option<Text>, ParseError> {
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

fn whole(word: Word<'_>, lowest: f64, highest: f64) -> Result<f64, ParseError> {
    let value = number(word)?;
    if libm::rint(value) == value && (lowest..=highest).contains(&value) {
        return Ok(value);
    }
    Err(word.error(ErrorCode::OutOfRange, "a whole number"))
}

fn required<'a>(scanner: &mut Scanner<'a>, expected: &'static str) -> Result<Word<'a>, ParseError> {
    let word = scanner.word();
    if word.text.is_empty() {
        return Err(word.error(ErrorCode::ParameterCount, expected));
    }
    Ok(word)
}
