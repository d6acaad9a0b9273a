//! What the lines about variables mean.

use super::request::{MAX_NAMED_VARIABLES, VariableRequest};
use crate::gcs::arguments::{ParseError, number, optional_text, required};
use crate::gcs::error::ErrorCode;
use crate::gcs::request::Request;
use crate::gcs::scan::Scanner;
use crate::gcs::text::Name;

/// `VAR`: a name and, unless it is to be forgotten, a value.
pub(in crate::gcs) fn set(scanner: &mut Scanner<'_>) -> Result<Request, ParseError> {
    let name = variable(scanner)?;
    let value = optional_text(scanner)?;
    Ok(Request::Variables(VariableRequest::Set(name, value)))
}

/// `ADD`: a name and two numbers.
pub(in crate::gcs) fn add(scanner: &mut Scanner<'_>) -> Result<Request, ParseError> {
    let name = variable(scanner)?;
    let (a, b) = (number(scanner.word())?, number(scanner.word())?);
    Ok(Request::Variables(VariableRequest::Add(name, a, b)))
}

/// `VAR?`: names, or none for all.
pub(in crate::gcs) fn query(scanner: &mut Scanner<'_>) -> Result<Request, ParseError> {
    let mut names = [None; MAX_NAMED_VARIABLES];
    for place in &mut names {
        if scanner.is_at_end() {
            break;
        }
        *place = Some(variable(scanner)?);
    }
    Ok(Request::Variables(VariableRequest::Query(names)))
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
