//! The table of commands. Parsing, `HLP?` and dispatch all read it: what is not here does not exist.

use super::axis::{AxisSet, AxisValues};
use super::request::{Action, Condition, Quantity, Query, Request};

/// A command.
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
    /// Nothing or `ALL`.
    All(Request),
    /// Axes; none stands for all.
    Read(Quantity),
    /// Axes; none stands for all.
    Axes(fn(AxisSet) -> Action),
    /// Pairs of axis and number.
    Values(fn(AxisValues) -> Action),
    /// A number.
    Number(fn(f64) -> Action),
    /// Query, axis, operator, number.
    Condition(fn(Condition) -> Action),
}

const fn entry(name: &'static str, syntax: Syntax, help: &'static str) -> Entry {
    Entry { name, syntax, help }
}

const fn ask(name: &'static str, query: Query, help: &'static str) -> Entry {
    entry(name, Syntax::Plain(Request::Ask(query)), help)
}

const fn read(name: &'static str, quantity: Quantity, help: &'static str) -> Entry {
    entry(name, Syntax::Read(quantity), help)
}

const fn byte(name: &'static str, byte: u8, request: Request, help: &'static str) -> Entry {
    entry(name, Syntax::Byte(byte, request), help)
}

/// Every command there is, in the order of `HLP?`.
pub(super) const COMMANDS: &[Entry] = &[
    byte(
        "#3",
        3,
        Request::Read(Quantity::Position, AxisSet::ALL),
        "get real position",
    ),
    byte("#4", 4, Request::Ask(Query::Status), "get status"),
    byte("#5", 5, Request::Ask(Query::Moving), "get motion status"),
    byte("#7", 7, Request::Ask(Query::Ready), "is controller ready"),
    byte("#24", 24, Request::Act(Action::Stop), "stop all axes"),
    ask("*IDN?", Query::Identity, "get device identification"),
    ask("CSV?", Query::Syntax, "get syntax version"),
    entry(
        "DEL",
        Syntax::Number(Action::Delay),
        "<milliseconds> delay what follows on this connection",
    ),
    ask("ERR?", Query::Error, "get and clear error number"),
    entry(
        "FLC",
        Syntax::Plain(Request::Act(Action::Acknowledge)),
        "acknowledge the latched fault",
    ),
    ask("FLT?", Query::Fault, "get the latched fault in words"),
    entry(
        "FRF",
        Syntax::Axes(Action::Reference),
        "[{<axis>}] reference",
    ),
    read(
        "FRF?",
        Quantity::Referenced,
        "[{<axis>}] get referencing result",
    ),
    entry(
        "HLT",
        Syntax::Axes(Action::Halt),
        "[{<axis>}] halt smoothly",
    ),
    ask("HLP?", Query::Help, "get list of commands"),
    entry(
        "MOV",
        Syntax::Values(Action::Move),
        "{<axis> <position>} set target position",
    ),
    read("MOV?", Quantity::Target, "[{<axis>}] get target position"),
    entry(
        "MVR",
        Syntax::Values(Action::MoveRelative),
        "{<axis> <distance>} set target relative to the last target",
    ),
    read("ONT?", Quantity::OnTarget, "[{<axis>}] get on-target state"),
    read("POS?", Quantity::Position, "[{<axis>}] get real position"),
    entry(
        "SAI?",
        Syntax::All(Request::Ask(Query::Axes)),
        "[ALL] get axis identifiers",
    ),
    ask("SSN?", Query::Serial, "get serial number"),
    entry(
        "STP",
        Syntax::Plain(Request::Act(Action::Stop)),
        "stop all axes",
    ),
    entry(
        "SVO",
        Syntax::Values(Action::Servo),
        "{<axis> <0|1>} set servo mode",
    ),
    read("SVO?", Quantity::Servo, "[{<axis>}] get servo mode"),
    read("TMN?", Quantity::Lowest, "[{<axis>}] get lowest position"),
    read("TMX?", Quantity::Highest, "[{<axis>}] get highest position"),
    ask("VER?", Query::Version, "get firmware version"),
    entry(
        "VLS",
        Syntax::Number(Action::Velocity),
        "<velocity> set system velocity",
    ),
    ask("VLS?", Query::Velocity, "get system velocity"),
    entry(
        "WAC",
        Syntax::Condition(Action::Wait),
        "<query> <axis> <operator> <value> wait for condition",
    ),
];

/// The line command of this name, in either case.
pub(super) fn find(name: &[u8]) -> Option<&'static Entry> {
    COMMANDS.iter().find(|entry| {
        !matches!(entry.syntax, Syntax::Byte(..))
            && entry.name.as_bytes().eq_ignore_ascii_case(name)
    })
}

/// What the single byte asks for.
pub(super) fn find_byte(byte: u8) -> Option<Request> {
    COMMANDS.iter().find_map(|entry| match entry.syntax {
        Syntax::Byte(own, request) if own == byte => Some(request),
        _ => None,
    })
}
