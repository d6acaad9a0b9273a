//! The table of commands. Parsing, `HLP?` and dispatch all read it: what is not here does not exist.

use super::arguments::{axis_identifiers, joysticks};
use super::calibration::{CalibrationAction, parse as calibration};
use super::excitation::parse as excitation;
use super::frames::parse as frames;
use super::iterative_learning::parse as learning;
use super::macros::{MacroRequest, parse as macros};
use super::ownership::parse as ownership;
use super::parameter::parse as parameter;
use super::recorder::parse as recorder;
use super::request::{Action, Property, Query, Request};
use super::streaming;
use super::syntax::{Entry, Syntax, ask, byte, entry, own, read};
use super::variables::parse as variables;
use super::wave::{WaveQuery, parse as wave};
use crate::commander::Quantity;
use crate::commander::axis::AxisSet;
use crate::commander::frames::FrameKind;

/// The query of variables, which conditions can ask too.
pub(super) const VARIABLE_QUERY: &str = "VAR?";

/// Every command there is, in the order of `HLP?`. A static: a constant would stand in the image once for each use.
pub(super) static COMMANDS: &[Entry] = &[
    byte(
        "#3",
        3,
        Request::Quantity(Quantity::Position, AxisSet::ALL),
        "get real position",
    ),
    byte("#4", 4, Request::Query(Query::Status), "get status"),
    byte("#5", 5, Request::Query(Query::Moving), "get motion status"),
    byte(
        "#6",
        6,
        Request::Query(Query::Changed),
        "get axes whose position has changed since it was asked for",
    ),
    byte("#7", 7, Request::Query(Query::Ready), "is controller ready"),
    byte(
        "#8",
        8,
        Request::Macro(MacroRequest::IsRunning),
        "is a macro running",
    ),
    byte(
        "#9",
        9,
        Request::Waveforms(WaveQuery::Mask),
        "get wave generator status",
    ),
    byte("#24", 24, Request::Act(Action::Stop), "stop all axes"),
    ask("*IDN?", Query::Identity, "get device identification"),
    own(
        "ADD",
        variables::add,
        "<variable> <number> <number> set variable to the sum",
    ),
    entry(
        "APP",
        Syntax::Number(Action::Approach),
        "<um> arrive at targets from one side, each carriage moving by so much",
    ),
    ask(
        "APP?",
        Query::Approach,
        "get by how much carriages move on the last way to a target",
    ),
    own(
        "CAL BEG",
        calibration::begin,
        "<serial> <date> [<C>] begin a calibration of this machine",
    ),
    entry(
        "CAL DEL",
        Syntax::Plain(Request::Act(Action::Calibrate(CalibrationAction::Forget))),
        "forget the calibration",
    ),
    own(
        "CAL END",
        calibration::end,
        "<checksum> compute with the calibration that was begun, and keep it",
    ),
    entry(
        "CAL OFF",
        Syntax::Plain(Request::Act(Action::Calibrate(CalibrationAction::Switch(
            false,
        )))),
        "compute as if the machine were as drawn",
    ),
    entry(
        "CAL ON",
        Syntax::Plain(Request::Act(Action::Calibrate(CalibrationAction::Switch(
            true,
        )))),
        "compute with the calibration again",
    ),
    ask(
        "CAL POS?",
        Query::PositionAsDrawn,
        "get real position without the calibration",
    ),
    own(
        "CAL SET",
        calibration::set,
        "<pivot> <first> {<number>} set numbers of the calibration that was begun",
    ),
    ask("CAL?", Query::Calibration, "get which calibration there is"),
    own(
        "CCL",
        parameter::level,
        "<level> [<password>] set command level",
    ),
    ask("CCL?", Query::Level, "get command level"),
    entry(
        "CMS",
        Syntax::Number(Action::Commission),
        "<0|1> set whether the machine is commissioned",
    ),
    ask(
        "CMS?",
        Query::Commissioned,
        "get whether the machine is commissioned",
    ),
    entry(
        "CST?",
        Syntax::Property(Property::Stage),
        "[{<axis>}] get stage type",
    ),
    ask("CSV?", Query::Syntax, "get syntax version"),
    entry(
        "DEL",
        Syntax::Number(Action::Delay),
        "<milliseconds> delay what follows on this connection",
    ),
    own(
        "DRC",
        recorder::set_channels,
        "{<table> <source> <option>} set what is recorded",
    ),
    own(
        "DRC?",
        recorder::channels,
        "[{<table>}] get what is recorded",
    ),
    own(
        "DRL?",
        recorder::lengths,
        "[{<table>}] get number of recorded points",
    ),
    own(
        "DRR?",
        recorder::data,
        "[<first> <points> [{<table>}]] get recorded points",
    ),
    own(
        "DRT",
        recorder::set_triggers,
        "{<table> <trigger> <value>} set trigger and arm",
    ),
    own("DRT?", recorder::triggers, "[{<table>}] get trigger"),
    ask("ERR?", Query::Error, "get and clear error number"),
    ask(
        "EVT?",
        Query::Events,
        "get what has happened: number, tick, event",
    ),
    own(
        "EXC RAMP",
        excitation::ramp,
        "<pivot> <V> <ms> [<mrad> [<A>]] put a voltage that rises from 0 on a motor, until a pivot has gone so far or the motor carries so much",
    ),
    own(
        "EXC RING",
        excitation::ring,
        "<pivot> <mrad> <mrad/s> <ms> [<A>] hold every ring by itself and move one, until its motor carries so much",
    ),
    own(
        "EXC SINES",
        excitation::sines,
        "<pivot> <V> <ms> <lowest> <highest> <lines> put a multisine of harmonics of 4096 ticks on a motor",
    ),
    own(
        "EXC STEP",
        excitation::step,
        "<pivot> <V> <ms> [<mrad> [<A>]] put a voltage on a motor",
    ),
    ask("EXC?", Query::Excitation, "get what came of the excitation"),
    entry(
        "FLC",
        Syntax::Plain(Request::Act(Action::Acknowledge)),
        "acknowledge the latched fault",
    ),
    own(
        "FLR?",
        recorder::fault_record,
        "get the fault record: the ticks before the last fault, and after",
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
    own("HDR?", recorder::help, "get options of the recorder"),
    entry(
        "HBT",
        Syntax::Number(Action::Heartbeat),
        "<milliseconds> stop when this connection is not heard for longer; 0: never",
    ),
    ask("HBT?", Query::Heartbeat, "get longest silence of the host"),
    read(
        "HIN?",
        Quantity::HandControl,
        "[{<axis>}] get whether a hand control drives an axis",
    ),
    entry(
        "HLT",
        Syntax::Axes(Action::Halt),
        "[{<axis>}] halt smoothly",
    ),
    ask("HLP?", Query::Help, "get list of commands"),
    ask("HPA?", Query::ParameterHelp, "get list of parameters"),
    own(
        "ILC FORGET",
        learning::forget,
        "[<move>] forget what was learnt of it",
    ),
    own("ILC FREEZE", learning::freeze, "<move> learn no more of it"),
    own(
        "ILC KEEP",
        learning::keep,
        "<move> keep what was learnt of it over a restart",
    ),
    own(
        "ILC LEARN",
        learning::learn,
        "<move> learn the next move from rest, and each time it is repeated",
    ),
    ask(
        "ILC?",
        Query::RepeatedMoves,
        "get what was learnt of repeated moves",
    ),
    entry(
        "JOG",
        Syntax::Values(Action::Jog),
        "{<axis> <velocity>} move at constant velocity",
    ),
    read(
        "JOG?",
        Quantity::Jog,
        "[{<axis>}] get constant velocity of axes",
    ),
    own(
        "JON?",
        joysticks,
        "[{<joystick>}] get whether a joystick is on",
    ),
    entry(
        "JRC",
        Syntax::Condition {
            after_lines: true,
            action: Action::Jump,
        },
        "<lines> <query> <operator> <value> jump in the macro on condition",
    ),
    entry(
        "JTM",
        Syntax::Number(Action::JogTime),
        "<milliseconds> end a JOG of this connection so long after its last one; 0: with the connection",
    ),
    ask(
        "JTM?",
        Query::JogTime,
        "get how long a JOG of this connection lasts",
    ),
    own("KEN", frames::enable, "<name> enable frame"),
    own(
        "KEN?",
        frames::enabled,
        "[<name>] get types of enabled frames",
    ),
    own(
        "KET?",
        frames::types,
        "[<type>] get enabled frames of types",
    ),
    own("KLN", frames::link, "<child> <parent> link frame to parent"),
    own("KLN?", frames::chains, "[<name>] get parents of frames"),
    own(
        "KLS?",
        frames::list,
        "[<name> [<item> [<axis>]]] get properties of frames",
    ),
    own(
        "KLT?",
        frames::totals,
        "[<name> [<end>]] get where the chain of a frame lies",
    ),
    own("KRM", frames::remove, "<name> remove frame"),
    own(
        "KSD",
        |scanner| frames::define(FrameKind::Directed, scanner),
        "<name> {<axis> <value>} define directed frame",
    ),
    own(
        "KSF",
        frames::here,
        "<name> define frame at the current position",
    ),
    own(
        "KST",
        |scanner| frames::define(FrameKind::Tool, scanner),
        "<name> {<axis> <value>} define tool frame",
    ),
    own(
        "KSW",
        |scanner| frames::define(FrameKind::Work, scanner),
        "<name> {<axis> <value>} define work frame",
    ),
    read(
        "LIM?",
        Quantity::LimitSwitch,
        "[{<axis>}] get whether there are limit switches",
    ),
    entry(
        "LST",
        Syntax::Plain(Request::Act(Action::RestartStatistics)),
        "start loop statistics again",
    ),
    ask(
        "LST?",
        Query::Statistics,
        "get loop statistics, and the peak following error since they were last asked for",
    ),
    own(
        "MAC BEG",
        macros::begin,
        "<macro> record the lines that follow",
    ),
    own("MAC DEL", macros::delete, "<macro> forget it"),
    entry(
        "MAC END",
        Syntax::Plain(Request::Macro(MacroRequest::End)),
        "keep what was recorded",
    ),
    entry(
        "MAC ERR?",
        Syntax::Plain(Request::Macro(MacroRequest::Error)),
        "get what went wrong in the last one",
    ),
    entry(
        "MAC FREE?",
        Syntax::Plain(Request::Macro(MacroRequest::Free)),
        "get bytes left",
    ),
    own(
        "MAC NSTART",
        macros::start_times,
        "<macro> <times> [<argument> [<argument>]] run it repeatedly",
    ),
    own(
        "MAC START",
        macros::start,
        "<macro> [<argument> [<argument>]] run it",
    ),
    own("MAC STOP", macros::stop, "[<macro>] stop it"),
    own("MAC?", macros::list, "[<macro>] get macros or lines of one"),
    entry(
        "MEX",
        Syntax::Condition {
            after_lines: false,
            action: |_, condition| Action::Leave(condition),
        },
        "<query> <operator> <value> end the macro on condition",
    ),
    ask(
        "MON?",
        Query::Monitor,
        "get pose and pivots in the base frame, and what was lowest and highest since last asked",
    ),
    entry(
        "MOV",
        Syntax::Values(Action::Move),
        "{<axis> <position>} set target position",
    ),
    read("MOV?", Quantity::Target, "[{<axis>}] get target position"),
    entry(
        "MRT",
        Syntax::Values(Action::MoveInTool),
        "{<axis> <distance>} set target relative to the last target, along the axes of the tool",
    ),
    entry(
        "MRW",
        Syntax::Values(Action::MoveRelative),
        "{<axis> <distance>} set target relative to the last target, along the axes of the work frame",
    ),
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
    own(
        "OWN",
        ownership::own,
        "<0|1> [<name>] be the only connection that may command the stage",
    ),
    ask(
        "OWN?",
        Query::Ownership,
        "get who owns the stage, and who commanded last",
    ),
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
        Syntax::Property(Property::Unit),
        "[{<axis>}] get unit of position",
    ),
    entry(
        "RBT",
        Syntax::Plain(Request::Act(Action::Restart)),
        "restart the controller",
    ),
    entry(
        "RCV",
        Syntax::Number(Action::Recover),
        "<0|1> drive a stage that is out of its reach slowly back in, as long as this connection lives",
    ),
    ask(
        "RCV?",
        Query::Recovery,
        "get whether the stage is being driven back into its reach",
    ),
    entry(
        "RMC?",
        Syntax::Plain(Request::Macro(MacroRequest::Running)),
        "get running macros",
    ),
    own(
        "RPA",
        parameter::recall,
        "[{<item> <parameter>}] get parameters back as they are kept",
    ),
    own("RTR", recorder::set_rate, "<ticks> set ticks a point"),
    own("RTR?", recorder::rate, "get ticks a point"),
    own("SAI?", axis_identifiers, "[ALL] get axis identifiers"),
    own(
        "SCT",
        streaming::cycle_time,
        "T <milliseconds> set time between streamed targets",
    ),
    own(
        "SCT?",
        streaming::cycle_time_query,
        "[T] get time between streamed targets",
    ),
    own(
        "SPA",
        parameter::set,
        "{<item> <parameter> <value>} set parameter",
    ),
    own(
        "SPA?",
        parameter::query,
        "[{<item> <parameter>}] get parameter",
    ),
    own(
        "SPI",
        frames::rotation_centre,
        "{<R|S|T> <position>} set centre of rotation",
    ),
    own(
        "SPI?",
        frames::rotation_centre_query,
        "[{<R|S|T>}] get centre of rotation",
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
        "STE",
        Syntax::Values(Action::Step),
        "{<axis> <distance>} make a step and record it",
    ),
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
    own(
        "TMP",
        calibration::temperature,
        "<C> [<ppm/K>] tell the machine's temperature, and how much it grows",
    ),
    ask(
        "TMP?",
        Query::Temperature,
        "get what is told of the machine's temperature",
    ),
    read("TMX?", Quantity::Highest, "[{<axis>}] get highest position"),
    own("TNR?", recorder::count, "get number of record tables"),
    ask("TPC?", Query::PiezoChannels, "get number of piezo channels"),
    entry(
        "TRA?",
        Syntax::QueryValues(Request::FurthestTarget),
        "{<axis> <direction>} get the furthest target in this direction",
    ),
    read(
        "TRS?",
        Quantity::ReferenceSwitch,
        "[{<axis>}] get whether there are reference switches",
    ),
    ask(
        "TST?",
        Query::SelfTest,
        "get what the board reads about itself",
    ),
    own("TWG?", wave::count, "get number of wave generators"),
    own(
        "VAR",
        variables::set,
        "<variable> [<value>] set or forget variable",
    ),
    own(
        VARIABLE_QUERY,
        variables::query,
        "[{<variable>}] get variable",
    ),
    entry(
        "VEL",
        Syntax::Values(Action::AxisVelocity),
        "{<axis> <velocity>} set velocity of axes",
    ),
    read(
        "VEL?",
        Quantity::Velocity,
        "[{<axis>}] get velocity of axes",
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
        Syntax::QueryValues(Request::Reachable),
        "{<axis> <position>} get whether a target can be moved to",
    ),
    entry(
        "WAC",
        Syntax::Condition {
            after_lines: false,
            action: |_, condition| Action::Wait(condition),
        },
        "<query> <axis> <operator> <value> wait for condition",
    ),
    own(
        "WAV",
        wave::define,
        "<table> <X|&|+> <PNT|LIN|RAMP|SIN_P> {<value>} define segment of a wave table",
    ),
    own(
        "WAV?",
        wave::lengths,
        "[{<table> 1}] get length of wave tables",
    ),
    own("WCL", wave::clear, "{<table>} clear wave tables"),
    own(
        "WGC",
        wave::cycles,
        "{<generator> <cycles>} set cycles of wave generators",
    ),
    own(
        "WGC?",
        |scanner| wave::generators(WaveQuery::Cycles, scanner),
        "[{<generator>}] get cycles of wave generators",
    ),
    own(
        "WGO",
        wave::go,
        "{<generator> <0|1>} stop or start wave generators",
    ),
    own(
        "WGO?",
        |scanner| wave::generators(WaveQuery::Running, scanner),
        "[{<generator>}] get whether wave generators run",
    ),
    own(
        "WPA",
        parameter::store,
        "<password> [{<item> <parameter>}] keep parameters over a restart",
    ),
    own(
        "WSL",
        wave::select,
        "{<generator> <table>} connect wave tables to generators",
    ),
    own(
        "WSL?",
        |scanner| wave::generators(WaveQuery::Tables, scanner),
        "[{<generator>}] get wave tables of generators",
    ),
    own(
        "WTR",
        wave::rate,
        "{<generator> <ticks> <interpolation>} set ticks a point for all wave generators",
    ),
    own(
        "WTR?",
        |scanner| wave::generators(WaveQuery::Rates, scanner),
        "[{<generator>}] get ticks a point of wave generators",
    ),
];

/// The line command of this name, in either case; `keyword` is the second word of those that have two.
pub(super) fn find(name: &[u8], keyword: &[u8]) -> Option<&'static Entry> {
    let length = match keyword {
        [] => name.len(),
        _ => name.len() + 1 + keyword.len(),
    };
    COMMANDS.iter().find(|entry| {
        // By length first: it is looked for with every line that comes, and most have another.
        entry.name.len() == length && is_named(entry, name, keyword)
    })
}

fn is_named(entry: &Entry, name: &[u8], keyword: &[u8]) -> bool {
    let (first, second) = entry.name.split_once(' ').unwrap_or((entry.name, ""));
    !matches!(entry.syntax, Syntax::Byte(..))
        && first.as_bytes().eq_ignore_ascii_case(name)
        && second.as_bytes().eq_ignore_ascii_case(keyword)
}

/// Whether there are commands of two words that start with this one.
pub(super) fn has_keywords(name: &[u8]) -> bool {
    COMMANDS.iter().any(|entry| {
        let parts = entry.name.as_bytes().split_at_checked(name.len());
        parts.is_some_and(|(first, rest)| {
            rest.first() == Some(&b' ') && first.eq_ignore_ascii_case(name)
        })
    })
}

/// What the single byte asks for.
pub(super) fn find_byte(byte: u8) -> Option<Request> {
    COMMANDS.iter().find_map(|entry| match entry.syntax {
        Syntax::Byte(own, request) if own == byte => Some(request),
        _ => None,
    })
}
