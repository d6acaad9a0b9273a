//! From a line to a [`Request`], or to what is wrong with it and where.

use super::arguments::{ParseError, axes, axis, end, number, values};
use super::error::ErrorCode;
use super::macros::parse::jump;
use super::request::{Condition, Operand, Operator, Request};
use super::scan::{Scanner, Word};
use super::syntax::{Entry, Syntax};
use super::table::{VARIABLE_QUERY, find, has_keywords};
use super::variables::parse::variable;
use crate::commander::axis::AxisSet;

/// Understands a line (without its LF). Pure: no state of the controller is looked at, so whether the command can be
/// carried out is another question.
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
        Syntax::Own(parse) => parse(&mut scanner)?,
        Syntax::Quantity(quantity) => Request::Quantity(quantity, axes(&mut scanner)?),
        Syntax::Property(property) => Request::Property(property, axes(&mut scanner)?),
        Syntax::QueryValues(request) => request(values(&mut scanner)?),
        Syntax::Axes(action) => Request::Act(action(axes(&mut scanner)?)),
        Syntax::Values(action) => Request::Act(action(values(&mut scanner)?)),
        Syntax::Number(action) => Request::Act(action(number(scanner.next())?)),
        Syntax::Condition {
            after_lines,
            action,
        } => {
            let lines = if after_lines { jump(&mut scanner)? } else { 0 };
            Request::Act(action(lines, condition(&mut scanner)?))
        }
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
    let entry = find(word.text, b"");
    match entry.map(|entry| (entry.name, &entry.syntax)) {
        Some((_, Syntax::Quantity(quantity))) => {
            let axis = axis(scanner.next(), &mut AxisSet::default())?;
            Ok(Operand::Axis(*quantity, axis))
        }
        Some((VARIABLE_QUERY, _)) => Ok(Operand::Variable(variable(scanner)?)),
        _ => Err(word.error(
            ErrorCode::OutOfRange,
            "a query of an axis or a variable, such as ONT?",
        )),
    }
}
