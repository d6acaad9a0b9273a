//! What the lines about macros mean.

use super::request::MacroRequest;
use crate::gcs::arguments::{ParseError, optional_text, required, whole};
use crate::gcs::error::ErrorCode;
use crate::gcs::request::Request;
use crate::gcs::scan::Scanner;
use crate::gcs::text::{Name, Text};

type Parsed = Result<Request, ParseError>;

/// `MAC BEG`: a name.
pub(in crate::gcs) fn begin(scanner: &mut Scanner<'_>) -> Parsed {
    Ok(Request::Macro(MacroRequest::Begin(macro_name(scanner)?)))
}

/// `MAC DEL`: a name.
pub(in crate::gcs) fn delete(scanner: &mut Scanner<'_>) -> Parsed {
    Ok(Request::Macro(MacroRequest::Delete(macro_name(scanner)?)))
}

/// `MAC START`: a name and two arguments at most.
pub(in crate::gcs) fn start(scanner: &mut Scanner<'_>) -> Parsed {
    let name = macro_name(scanner)?;
    let arguments = arguments(scanner)?;
    Ok(Request::Macro(MacroRequest::Start(name, 1, arguments)))
}

/// `MAC NSTART`: a name, a number and two arguments at most.
pub(in crate::gcs) fn start_times(scanner: &mut Scanner<'_>) -> Parsed {
    let (name, times) = (macro_name(scanner)?, scanner.word());
    let count = whole(times, 1.0, f64::from(u32::MAX))? as u32;
    let arguments = arguments(scanner)?;
    Ok(Request::Macro(MacroRequest::Start(name, count, arguments)))
}

/// `MAC STOP`: a name or nothing.
pub(in crate::gcs) fn stop(scanner: &mut Scanner<'_>) -> Parsed {
    Ok(Request::Macro(MacroRequest::Stop(optional_name(scanner)?)))
}

/// `MAC?`: a name or nothing.
pub(in crate::gcs) fn list(scanner: &mut Scanner<'_>) -> Parsed {
    Ok(Request::Macro(MacroRequest::List(optional_name(scanner)?)))
}

/// What follows `JRC`, before its condition: how many lines to go.
pub(in crate::gcs) fn jump(scanner: &mut Scanner<'_>) -> Result<i32, ParseError> {
    let most = f64::from(i32::MAX);
    Ok(whole(scanner.word(), -most, most)? as i32)
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
