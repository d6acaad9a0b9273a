//! What lines about repeated moves mean.

use super::request::LearnAction;
use crate::gcs::arguments::{ParseError, required};
use crate::gcs::error::ErrorCode;
use crate::gcs::request::{Action, Request};
use crate::gcs::scan::Scanner;
use crate::gcs::text::Name;

type Parsed = Result<Request, ParseError>;

/// `ILC LEARN`: a name.
pub(in crate::gcs) fn learn(scanner: &mut Scanner<'_>) -> Parsed {
    act(LearnAction::Learn(name(scanner)?))
}

/// `ILC FREEZE`: a name.
pub(in crate::gcs) fn freeze(scanner: &mut Scanner<'_>) -> Parsed {
    act(LearnAction::Freeze(name(scanner)?))
}

/// `ILC KEEP`: a name.
pub(in crate::gcs) fn keep(scanner: &mut Scanner<'_>) -> Parsed {
    act(LearnAction::Keep(name(scanner)?))
}

/// `ILC FORGET`: a name or nothing.
pub(in crate::gcs) fn forget(scanner: &mut Scanner<'_>) -> Parsed {
    let name = if scanner.is_at_end() {
        None
    } else {
        Some(name(scanner)?)
    };
    act(LearnAction::Forget(name))
}

fn act(action: LearnAction) -> Parsed {
    Ok(Request::Act(Action::Repeat(action)))
}

fn name(scanner: &mut Scanner<'_>) -> Result<Name, ParseError> {
    let word = required(scanner, "a name")?;
    Name::named(word.text).ok_or_else(|| word.error(ErrorCode::InvalidIdentifier, "a name"))
}
