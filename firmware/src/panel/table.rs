//! The table of commands. Parsing, `HLP?` and dispatch all read it: what is not here does not exist.

use super::axis::{AxisSet, AxisValues};
use super::parameter::Settings;
use super::request::{Action, Condition, Property, Quantity, Query, Request};

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
    /// Axes; none stands for all.
    Tell(Property),
    /// Pairs of axis and number.
    Values(fn(AxisValues) -> Action),
    /// Pairs of axis and number.
    AskValues(fn(AxisValues) -> Request),
    /// Pairs of item and parameter; none stands for all.
    Parameters,
    /// Triples of item, parameter and number.
    Settings(fn(Settings) -> Action),
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
    ask("CCL?", Query::Level, "get command level"),
    entry(
        "CST?",
        Syntax::Tell(Property::Stage),
        "[{<axis>}] get stage type",
    ),
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
    ask("HPA?", Query::ParameterHelp, "get list of parameters"),
    read(
        "LIM?",
        Quantity::LimitSwitch,
        "[{<axis>}] get whether there are limit switches",
    ),
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
    entry(
        "NLM",
        Syntax::Values(Action::SoftLowest),
        "{<axis> <position>} set lowest position of the soft limits",
    ),
    read(
        "NLM?",
        Quantity::SoftLowest,
        "[{<axis>}] get lowest position of the soft limits",
    ),
    read("ONT?", Quantity::OnTarget, "[{<axis>}] get on-target state"),
    entry(
        "PLM",
        Syntax::Values(Action::SoftHighest),
        "{<axis> <position>} set highest position of the soft limits",
    ),
    read(
        "PLM?",
        Quantity::SoftHighest,
        "[{<axis>}] get highest position of the soft limits",
    ),
    read("POS?", Quantity::Position, "[{<axis>}] get real position"),
    entry(
        "PUN?",
        Syntax::Tell(Property::Unit),
        "[{<axis>}] get unit of position",
    ),
    entry(
        "SAI?",
        Syntax::All(Request::Ask(Query::Axes)),
        "[ALL] get axis identifiers",
    ),
    entry(
        "SPA",
        Syntax::Settings(Action::Set),
        "{<item> <parameter> <value>} set parameter",
    ),
    entry(
        "SPA?",
        Syntax::Parameters,
        "[{<item> <parameter>}] get parameter",
    ),
    entry(
        "SSL",
        Syntax::Values(Action::SoftActive),
        "{<axis> <0|1>} set whether soft limits count",
    ),
    read(
        "SSL?",
        Quantity::SoftActive,
        "[{<axis>}] get whether soft limits count",
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
    entry(
        "TRA?",
        Syntax::AskValues(Request::Reach),
        "{<axis> <direction>} get the furthest target in this direction",
    ),
    read(
        "TRS?",
        Quantity::ReferenceSwitch,
        "[{<axis>}] get whether there are reference switches",
    ),
    ask("VER?", Query::Version, "get firmware version"),
    entry(
        "VLS",
        Syntax::Number(Action::Velocity),
        "<velocity> set system velocity",
    ),
    ask("VLS?", Query::Velocity, "get system velocity"),
    entry(
        "VMO?",
        Syntax::AskValues(Request::Reachable),
        "{<axis> <position>} get whether a target can be moved to",
    ),
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
