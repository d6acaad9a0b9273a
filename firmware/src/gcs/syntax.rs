//! A command of the table: its name, what follows it, and what the whole asks for.

use super::arguments::ParseError;
use super::request::{Action, Condition, Property, Query, Request};
use super::scan::Scanner;
use crate::commander::Quantity;
use crate::commander::axis::{AxisSet, AxisValues};

/// A command of the table.
pub(super) struct Entry {
    /// As `HLP?` lists it.
    pub name: &'static str,
    /// What follows the name, and what the whole then asks for.
    pub syntax: Syntax,
    /// Its parameters and its meaning, for `HLP?`.
    pub help: &'static str,
}

/// What follows a command's name.
pub(super) enum Syntax {
    /// Not a line at all: this byte alone.
    Byte(u8, Request),
    /// Nothing.
    Plain(Request),
    /// As this function understands it.
    Own(fn(&mut Scanner<'_>) -> Result<Request, ParseError>),
    /// Axes; none stands for all.
    Quantity(Quantity),
    /// Axes; none stands for all.
    Axes(fn(AxisSet) -> Action),
    /// Axes; none stands for all.
    Property(Property),
    /// Pairs of axis and number.
    Values(fn(AxisValues) -> Action),
    /// Pairs of axis and number.
    QueryValues(fn(AxisValues) -> Request),
    /// A number.
    Number(fn(f64) -> Action),
    /// Perhaps a number of lines (else the function gets 0), then query, axis, operator, number. The query is read with the table
    /// itself, so no function of it could.
    Condition {
        /// Whether a number of lines comes first.
        after_lines: bool,
        /// What that asks for.
        action: fn(i32, Condition) -> Action,
    },
}

/// A command whose syntax serves others too.
pub(super) const fn entry(name: &'static str, syntax: Syntax, help: &'static str) -> Entry {
    Entry { name, syntax, help }
}

/// A question about the controller as a whole.
pub(super) const fn ask(name: &'static str, query: Query, help: &'static str) -> Entry {
    entry(name, Syntax::Plain(Request::Query(query)), help)
}

/// A question about axes.
pub(super) const fn read(name: &'static str, quantity: Quantity, help: &'static str) -> Entry {
    entry(name, Syntax::Quantity(quantity), help)
}

/// A command that reads what follows by itself.
pub(super) const fn own(
    name: &'static str,
    parse: fn(&mut Scanner<'_>) -> Result<Request, ParseError>,
    help: &'static str,
) -> Entry {
    entry(name, Syntax::Own(parse), help)
}

/// A single byte.
pub(super) const fn byte(
    name: &'static str,
    byte: u8,
    request: Request,
    help: &'static str,
) -> Entry {
    entry(name, Syntax::Byte(byte, request), help)
}
