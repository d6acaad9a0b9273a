//! From a line to a [`Request`], or to what is wrong with it and where.

use super::error::ErrorCode;
use super::macros;
use super::parameter::{Address, Addresses, Item, LEVEL_PASSWORD, Parameter, Settings};
use super::persistence::STORE_PASSWORD;
use super::request::{Action, Condition, Operand, Operator, Query, Request};
use super::scan::{Scanner, Word};
use super::table::{Entry, Syntax, find, has_keywords};
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

/// Understands a line (without its LF). Pure: no state of the controller is looked at, so whether the command can be carried
/// out is another question.
///
/// # Errors
/// [`ParseError`] for the first word from the left that does not fit.
pub fn parse(line: &[u8]) -> Result<Request, ParseError> {
    let mut scanner = Scanner::new(line);
    let name = scanner.word();
    if name.text.is_empty() {
        return Ok(Request::Nothing);
    }
    let entry = match find(name.text, b"") {
        Some(entry) => entry,
        None => two_words(&name, scanner.word())?,
    };
    let request = match entry.syntax {
        // `find` finds no such entry.
        Syntax::Byte(_, request) | Syntax::Plain(request) => request,
        Syntax::All(request) => {
            all(&mut scanner)?;
            request
        }
        Syntax::Own(parse) => parse(&mut scanner)?,
        Syntax::Quantity(quantity) => Request::Quantity(quantity, axes(&mut scanner)?),
        Syntax::Property(property) => Request::Property(property, axes(&mut scanner)?),
        Syntax::QueryValues(request) => request(values(&mut scanner)?),
        Syntax::Parameters => Request::Parameters(addresses(&mut scanner)?),
        Syntax::Settings(action) => Request::Act(action(settings(&mut scanner)?)),
        Syntax::Macro(syntax) => Request::Macro(macros::macro_request(syntax, &mut scanner)?),
        Syntax::SetVariable => Request::Variables(macros::set(&mut scanner)?),
        Syntax::AddVariable => Request::Variables(macros::add(&mut scanner)?),
        Syntax::Variables => Request::Variables(macros::tell(&mut scanner)?),
        Syntax::Jump => {
            let by = macros::jump(&mut scanner)?;
            Request::Act(Action::Jump(by, condition(&mut scanner)?))
        }
        Syntax::Level => Request::Act(level(&mut scanner)?),
        Syntax::Axes(action) => Request::Act(action(axes(&mut scanner)?)),
        Syntax::Values(action) => Request::Act(action(values(&mut scanner)?)),
        Syntax::Number(action) => Request::Act(action(number(scanner.next())?)),
        Syntax::Condition(action) => Request::Act(action(condition(&mut scanner)?)),
    };
    end(&mut scanner)?;
    Ok(request)
}

/// The command of a name and a keyword.
fn two_words(name: &Word<'_>, keyword: Word<'_>) -> Result<&'static Entry, ParseError> {
    if let Some(entry) = find(name.text, keyword.text) {
        return Ok(entry);
    }
    if !has_keywords(name.text) {
        return Err(name.error(ErrorCode::UnknownCommand, "a command of those HLP? lists"));
    }
    let code = if keyword.text.is_empty() {
        ErrorCode::ParameterCount
    } else {
        ErrorCode::MacroParameter
    };
    Err(keyword.error(code, "a keyword, as HLP? lists them"))
}

impl Word<'_> {
    pub(super) const fn error(&self, code: ErrorCode, expected: &'static str) -> ParseError {
        ParseError {
            code,
            column: self.column,
            expected,
        }
    }
}

fn end(scanner: &mut Scanner<'_>) -> Result<(), ParseError> {
    let extra = scanner.next();
    if extra.text.is_empty() {
        return Ok(());
    }
    Err(extra.error(ErrorCode::ParameterCount, "the end of the line"))
}

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

fn all(scanner: &mut Scanner<'_>) -> Result<(), ParseError> {
    let word = scanner.next();
    if word.text.is_empty() || word.text.eq_ignore_ascii_case(b"ALL") {
        return Ok(());
    }
    Err(word.error(ErrorCode::ParameterCount, "ALL or the end of the line"))
}

/// The axes named up to the end of the line; all when none is.
fn axes(scanner: &mut Scanner<'_>) -> Result<AxisSet, ParseError> {
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
pub(super) fn keep(scanner: &mut Scanner<'_>) -> Result<Request, ParseError> {
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
pub(super) fn recall(scanner: &mut Scanner<'_>) -> Result<Request, ParseError> {
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
fn level(scanner: &mut Scanner<'_>) -> Result<Action, ParseError> {
    let level = number(scanner.next())?;
    let password = scanner.word();
    Ok(Action::Level(
        level,
        password.text.eq_ignore_ascii_case(LEVEL_PASSWORD),
    ))
}

/// Decimal, or hexadecimal after 0x.
fn parameter_id(text: &[u8]) -> Option<u32> {
    let text = core::str::from_utf8(text).ok()?;
    match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) => u32::from_str_radix(digits, 16).ok(),
        None => text.parse().ok(),
    }
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

fn condition(scanner: &mut Scanner<'_>) -> Result<Condition, ParseError> {
    let left = operand(scanner)?;
    let operator = scanner.next();
    if operator.text.is_empty() {
        return Err(operator.error(ErrorCode::ParameterCount, "an operator"));
    }
    Ok(Condition {
        left,
        operator: Operator::named(operator.text)
            .ok_or_else(|| operator.error(ErrorCode::Syntax, "an operator: = != < <= > >="))?,
        value: number(scanner.next())?,
    })
}

fn operand(scanner: &mut Scanner<'_>) -> Result<Operand, ParseError> {
    let word = scanner.next();
    if word.text.is_empty() {
        return Err(word.error(ErrorCode::ParameterCount, "a query"));
    }
    match find(word.text, b"").map(|entry| &entry.syntax) {
        Some(Syntax::Quantity(quantity)) => {
            let axis = axis(scanner.next(), &mut AxisSet::default())?;
            Ok(Operand::Axis(*quantity, axis))
        }
        Some(Syntax::Variables) => Ok(Operand::Variable(macros::variable(scanner)?)),
        _ => Err(word.error(
            ErrorCode::OutOfRange,
            "a query of an axis or a variable, such as ONT?",
        )),
    }
}
