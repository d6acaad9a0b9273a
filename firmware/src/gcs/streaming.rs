//! `SCT`: the time between streamed targets.

use super::arguments::{ParseError, number};
use super::error::ErrorCode;
use super::request::{Action, Query, Request};
use super::scan::Scanner;

/// `SCT`: T and ms.
pub(super) fn cycle_time(scanner: &mut Scanner<'_>) -> Result<Request, ParseError> {
    let word = scanner.next();
    if word.text.is_empty() {
        return Err(word.error(ErrorCode::ParameterCount, "T"));
    }
    if !word.text.eq_ignore_ascii_case(b"T") {
        return Err(word.error(ErrorCode::OutOfRange, "T"));
    }
    Ok(Request::Act(Action::CycleTime(number(scanner.next())?)))
}

/// `SCT?`: nothing or T.
pub(super) fn cycle_time_query(scanner: &mut Scanner<'_>) -> Result<Request, ParseError> {
    if !scanner.is_at_end() {
        let word = scanner.next();
        if !word.text.eq_ignore_ascii_case(b"T") {
            return Err(word.error(ErrorCode::OutOfRange, "T"));
        }
    }
    Ok(Request::Query(Query::CycleTime))
}
