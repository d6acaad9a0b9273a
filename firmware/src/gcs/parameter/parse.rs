//! What the lines about parameters mean.

use super::address::{Address, Addresses, Item, Settings};
use super::descriptor::Parameter;
use super::passwords::{LEVEL_PASSWORD, STORE_PASSWORD};
use crate::commander::axis::Axis;
use crate::gcs::arguments::{ParseError, number};
use crate::gcs::error::ErrorCode;
use crate::gcs::request::{Action, Request};
use crate::gcs::scan::{Scanner, Word};

/// `SPA?`: pairs of item and parameter; none stands for all.
pub(in crate::gcs) fn query(scanner: &mut Scanner<'_>) -> Result<Request, ParseError> {
    Ok(Request::Parameters(addresses(scanner)?))
}

/// `SPA`: triples of item, parameter and number.
pub(in crate::gcs) fn set(scanner: &mut Scanner<'_>) -> Result<Request, ParseError> {
    Ok(Request::Act(Action::Set(settings(scanner)?)))
}

/// Pairs of item and parameter up to the end of the line.
fn addresses(scanner: &mut Scanner<'_>) -> Result<Addresses, ParseError> {
    let mut addresses = Addresses::default();
    for place in &mut addresses {
        if scanner.is_at_end() {
            break;
        }
        *place = Some(address(scanner)?.0);
    }
    Ok(addresses)
}

/// The password of `WPA`, and pairs of item and parameter that can be set; none stands for all.
pub(in crate::gcs) fn store(scanner: &mut Scanner<'_>) -> Result<Request, ParseError> {
    let password = scanner.word();
    if password.text.is_empty() {
        return Err(password.error(ErrorCode::ParameterCount, "a password"));
    }
    if password.text != STORE_PASSWORD {
        return Err(password.error(ErrorCode::Password, "the password"));
    }
    Ok(Request::Act(Action::Store(addresses(scanner)?)))
}

/// Pairs of item and parameter; none stands for all.
pub(in crate::gcs) fn recall(scanner: &mut Scanner<'_>) -> Result<Request, ParseError> {
    Ok(Request::Act(Action::Recall(addresses(scanner)?)))
}

/// Triples of item, parameter and number up to the end of the line, at least one.
fn settings(scanner: &mut Scanner<'_>) -> Result<Settings, ParseError> {
    let mut settings = Settings::default();
    for place in &mut settings {
        let (address, id) = address(scanner)?;
        if Parameter::find(address.id).is_some_and(Parameter::is_read_only) {
            return Err(id.error(ErrorCode::ReadOnly, "a parameter that can be set"));
        }
        *place = Some((address, number(scanner.next())?));
        if scanner.is_at_end() {
            break;
        }
    }
    Ok(settings)
}

/// An item and a parameter that it has; the parameter's word besides.
fn address<'a>(scanner: &mut Scanner<'a>) -> Result<(Address, Word<'a>), ParseError> {
    let word = scanner.word();
    if word.text.is_empty() {
        return Err(word.error(ErrorCode::ParameterCount, "an item: 1 or an axis"));
    }
    let item = match word.text {
        b"1" => Some(Item::System),
        name => Axis::named(name).map(Item::Axis),
    };
    let item = item.ok_or_else(|| word.error(ErrorCode::InvalidAxis, "an item: 1 or an axis"))?;
    let id = scanner.word();
    if id.text.is_empty() {
        return Err(id.error(ErrorCode::ParameterCount, "a parameter's number"));
    }
    let number = parameter_id(id.text)
        .ok_or_else(|| id.error(ErrorCode::InvalidNumber, "a parameter's number"))?;
    let parameter = Parameter::find(number).ok_or_else(|| {
        id.error(
            ErrorCode::UnknownParameter,
            "a parameter of those HPA? lists",
        )
    })?;
    if !parameter.belongs_to(item) {
        return Err(word.error(ErrorCode::InvalidAxis, "an axis"));
    }
    Ok((Address { item, id: number }, id))
}

/// A level and perhaps a password, of which only whether it is right goes further.
pub(in crate::gcs) fn level(scanner: &mut Scanner<'_>) -> Result<Request, ParseError> {
    let level = number(scanner.next())?;
    let password = scanner.word();
    let is_right = password.text.eq_ignore_ascii_case(LEVEL_PASSWORD);
    Ok(Request::Act(Action::Level(level, is_right)))
}

/// Decimal, or hexadecimal after 0x.
fn parameter_id(text: &[u8]) -> Option<u32> {
    let text = core::str::from_utf8(text).ok()?;
    match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) => u32::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
}
