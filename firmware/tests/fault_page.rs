//! `FAULTS.md` is what the supervisor's tables say. `UPDATE=1 cargo test -p firmware --test fault_page` writes it.

mod written_page;

use firmware::control::{LEAST_RESISTOR_DROP_V, MODES, Outcome, TRANSITIONS};
use firmware::drivers::power_stage::{BRIDGE, BUS};
use firmware::fault::{FAULT_DESCRIPTIONS, Fault, FaultKind, Reaction};
use firmware::gcs::{ErrorCode, PARAMETERS};
use firmware::mode::Mode;
use firmware::parameters::Parameters;
use std::fmt::Write;

const HEAD: &str = "# Faults

Written by `UPDATE=1 cargo test -p firmware --test fault_page` from the tables that the controller has
(`firmware/src/control/supervisor/transitions.rs`, `firmware/src/fault/description.rs`); edit those, not this.

A fault is latched with its kind, pivot, tick and values. `FLT?` tells it in words, `EVT?` when it came, `ERR?` its number on every
connection, once; from then on every motion is refused with 1024 until `FLC` acknowledges it. A second fault that ends a controlled
stop is told besides; the first stays latched.

## States and events

Off lets the motors coast; holding, moving and stopping drive them, and so does an excitation (`EXC`), which needs neither a reference
nor a commissioned machine and brakes at its end; a fault brakes them, or lets them coast where its reaction is
that. `refused`: the command is counted as refused, nothing changes. `if ready`: the encoders answer and are referenced, or the plan
starts where the motion is, or the fault that is acknowledged is not one that only a restart takes away; refused if not.

";

const BETWEEN: &str = "
## Reactions

- **stop**: the plan under way is followed slower and slower, on its path, at rest after the time of parameter 0x5450050F; then the
  bridges brake. An encoder that is lost is replaced by its pivot's setpoint: feedforward and what the servo has learnt drive that
  pivot, the other two stay under control. At rest already, the bridges brake at once. Whatever goes wrong on the way brakes: a
  second encoder that is lost leaves no pose to control, so the stop ends in the tick in which that is found, and both are told.
  A stream or a waveform is followed as far as it has been sent, and then ends as a stream does that dries up: beside its curve.
- **brake**: the bridges short the windings. A pivot of the reference drive slows down with a time constant of some 8 ms
  (computed). The bridge bears the current, 15 A from 10 rad/s: it trips at 32 A. Nothing comes back to the supply.
- **coast**: the sleep pins open the bridges.

How far the worst machine goes and turns, and for how long, from the tick in which the fault begins until no pivot turns faster than
0.01 rad/s: 5 kg on the platform, half of the reference stage's friction at the rings and none else, windings 100 K hot, masses a fifth more and motors a
fifth weaker or the other way round, at the largest speed and rotation; each figure with the motion in which it is worst. A stop lasts as
long as its currents ask for with that load. A stage that coasts is stopped by the ends of its guides
and its bumpers. `KEEP=1 cargo bench -p tests --bench reactions` measures it again; `tests/tests/reactions.rs` holds it.

";

const AFTER_REACTIONS: &str = "
An encoder that was lost is ready for `FRF` with four good frames in a row, where its pivot is slower than 2.5 rad/s; until then `FRF`
answers 45. A stage that coasts faster than that could not be held.

How far one or two lost encoders let the platform be off its path: see [MEASURED.md](../hal-sim/MEASURED.md).

## Kinds

";

const TAIL: &str = "
## What is no latched fault

| what | what happens |
|---|---|
| an encoder's warning bit, in two good frames in a row | an event (`EVT?`) when it begins and when it ends; the position is good |
| a motor constant more than 10 % off its parameter, a current sensor that reads more than 0.3 A besides what flows, friction of more than 1.5 N m over what the parameters of drive and guides say, in two findings in a row while the servo turns the pivot faster than 1 rad/s | an event (`EVT?`) when it begins and when it is half of the way back; a start begins anew. `LST?` tells what was found last (`DRIVE1=`) |
| a following error whose rate jumps within 0.2 ms by what no servo makes (400 rad/s^2), five times within 10 s at a pivot while the servo is on: a coupling that is loose knocks like that when its motor's torque turns, and so does what strikes the platform; not behind bridged frames | an event (`EVT?`) with their number, time and the hardest, every 10 s at most |
| no host heard for longer than `HBT` or parameter 0x54500510 allow: one of the connections that have sent `HBT`, or, for the parameter, none at all | the stop of `STP`, error 10, an event: a stage that stands under its servo is safer than one whose motors are off |
| the command queue is full | the command is refused whole with error 1005, nothing moves; the loop never waits |
| a restart by a watchdog, a panic, a processor fault, a dip of the supply or a crystal that stops | the outputs are cut first, whatever hangs: the tick feeds a window watchdog that cuts them half a millisecond after the last one. Found at the next start: `FLT?` tells it, and `EVT?` the place in the program with it; the motors are off and the reference is gone |
| a bit of the RAM that does not hold both its values, found at each start before anything uses it | the chip does not go on: its pins are as the reset has left them, which is no motor driven; the lamps stay as they are and nobody answers. A debugger finds it at `tripivot_ram_fault`, with the word's address in r0 |
| the board at its start: brown-out level, boot bank, silicon, flash size, an image without a checksum | an event (`EVT?`) |
";

fn word(mode: Mode) -> &'static str {
    match mode {
        Mode::Off => "off",
        Mode::Holding => "holding",
        Mode::Moving => "moving",
        Mode::Stopping => "stopping",
        Mode::Fault => "fault",
        Mode::Exciting => "exciting",
    }
}

fn states(page: &mut String) {
    let heads: Vec<&str> = MODES.into_iter().map(word).collect();
    writeln!(page, "| event | {} |", heads.join(" | ")).unwrap();
    writeln!(page, "|---|{}", "---|".repeat(MODES.len())).unwrap();
    for (event, outcomes) in TRANSITIONS {
        let cells = outcomes.map(|outcome| match outcome {
            Outcome::To(mode) => word(mode).to_owned(),
            Outcome::If(mode) => format!("{} if ready", word(mode)),
            Outcome::Refused => "refused".to_owned(),
            Outcome::Nothing => String::new(),
        });
        let mut name = String::new();
        for letter in format!("{event:?}").chars() {
            if letter.is_uppercase() && !name.is_empty() {
                name.push(' ');
            }
            name.extend(letter.to_lowercase());
        }
        writeln!(page, "| {name} | {} |", cells.join(" | ")).unwrap();
    }
}

fn kinds(page: &mut String) {
    *page +=
        "| kind | found by | thresholds | reaction | why | error |\n|---|---|---|---|---|---|\n";
    for about in FAULT_DESCRIPTIONS {
        let thresholds: Vec<String> = (about.thresholds.iter())
            .map(|id| {
                let parameter = PARAMETERS.iter().find(|parameter| parameter.id == *id);
                let parameter = parameter.unwrap_or_else(|| panic!("no parameter 0x{id:X}"));
                let value = parameter.number(&Parameters::REFERENCE).expect("a number");
                let value = (value * 1e9).round() / 1e9;
                format!("0x{id:X} ({value} {})", parameter.unit).replace(" )", ")")
            })
            .collect();
        let reaction = match about.kind.reaction() {
            Reaction::Stop => "stop",
            Reaction::Brake => "brake",
            Reaction::Coast => "coast",
        };
        writeln!(
            page,
            "| {} | {} | {} | {reaction} | {} | {} |",
            about.kind.text(),
            about.detection,
            thresholds.join(", "),
            about.reason,
            ErrorCode::of(about.kind).number(),
        )
        .unwrap();
    }
}

/// Way, turn and time to rest of each reaction.
fn reactions(page: &mut String) {
    *page += "| reaction | way, mm | turn, deg | time, ms |\n|---|---|---|---|\n";
    for row in include_str!("../reactions.csv").lines().skip(1) {
        let mut cells = row.split(',');
        write!(page, "| {} |", cells.next().expect("a reaction")).unwrap();
        while let (Some(value), Some(motion)) = (cells.next(), cells.next()) {
            write!(page, " {value} ({motion}) |").unwrap();
        }
        page.push('\n');
    }
}

fn page() -> String {
    let mut page = HEAD.to_owned();
    states(&mut page);
    page += BETWEEN;
    reactions(&mut page);
    page += AFTER_REACTIONS;
    kinds(&mut page);
    page += TAIL;
    page
}

#[test]
fn page_is_up_to_date() {
    written_page::hold("FAULTS.md", &page());
}

/// Every kind is told about, once, where its number says; and told with its unit where it has values.
#[test]
fn every_kind_has_its_line() {
    for (number, about) in FAULT_DESCRIPTIONS.iter().enumerate() {
        assert_eq!(about.kind as usize, number);
        let fault = Fault {
            kind: about.kind,
            pivot: Some(1),
            tick: 7,
            value: 2.0,
            limit: 1.0,
        };
        let text = fault.to_string();
        assert!(text.starts_with(about.kind.text()) && text.ends_with(", at tick 7"));
        assert_eq!(text.contains("limit"), !about.kind.unit().is_empty());
    }
}

/// What the words say of the power stage is what its table has.
#[test]
fn words_have_the_figures_of_the_power_stage() {
    let words = |kind: FaultKind| {
        let mut all = FAULT_DESCRIPTIONS.iter();
        all.find(|one| one.kind == kind)
            .map(|one| (one.detection, one.reason))
    };
    let (detection, reason) = words(FaultKind::SupplyHigh).unwrap();
    assert!(detection.contains(&format!("over {} V", BUS.too_high_v)));
    assert!(detection.contains(&format!("from {} V", BUS.resistor_on_v)));
    let [_, most_v] = BRIDGE.supply_v;
    assert!(reason.contains(&format!("{most_v} V, {} V", BRIDGE.absolute_supply_v)));
    let (detection, reason) = words(FaultKind::BrakeResistorHot).unwrap();
    let watts = (BUS.resistor_on_v.powi(2) / BUS.resistor_ohm).round();
    let figures = format!(
        "({} ohm: {watts} W at {} V) less the {} W",
        BUS.resistor_ohm, BUS.resistor_on_v, BUS.resistor_w
    );
    assert!(detection.contains(&figures) && detection.contains(&format!("{} J", BUS.resistor_j)));
    assert!(reason.contains(&format!("{} V", BUS.resistor_on_v)));
    let (detection, reason) = words(FaultKind::SupplyRises).unwrap();
    assert!(detection.contains(&format!("at {} V", BUS.resistor_on_v)));
    assert!(reason.contains(&format!("under {} V", BUS.too_high_v)));
    let (detection, _) = words(FaultKind::BrakeResistorDead).unwrap();
    assert!(detection.contains(&format!("by {:.0} mV", LEAST_RESISTOR_DROP_V * 1e3)));
    assert!(detection.contains(&format!("over {} V", BUS.resistor_on_v)));
}
