//! `OWN`

use crate::gcs::arguments::{ParseError, number};
use crate::gcs::error::ErrorCode;
use crate::gcs::request::{Action, Request};
use crate::gcs::scan::Scanner;
use crate::gcs::text::Name;

/// 0 or 1, and perhaps a name by which others are told who owns.
pub(in crate::gcs) fn own(scanner: &mut Scanner<'_>) -> Result<Request, ParseError> {
    let wanted = scanner.next();
    let name = scanner.word();
    let name_given = (!name.text.is_empty())
        .then(|| {
            Name::named(name.text).ok_or_else(|| name.error(ErrorCode::InvalidIdentifier, "a name"))
        })
        .transpose()?;
    let value = number(wanted)?;
    Ok(Request::Act(Action::Own(value, name_given)))
}
