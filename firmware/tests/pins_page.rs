//! `PINS.md` is what the boards' lists of pins say, from which the images are made too, and no pin of one is in use twice.
//! `UPDATE=1 cargo test -p firmware --test pins_page` writes it.

mod written_page;

use std::fmt::Write;

/// A pin: its place in the list, its name, its signal, what hangs on it.
type Use = (&'static str, &'static str, &'static str, &'static str);

struct Board {
    name: &'static str,
    clock: &'static str,
    uses: &'static [Use],
}

/// The images have a macro of the same name: `src/bin/stage/pin_list.rs`.
macro_rules! board {
    (
        name: $name:literal,
        clock: $clock:ident,
        serial: $serial:ident,
        alternate: { $($AType:ident $aname:ident: $Apin:ident $aport:ident.$afield:ident as $module:ident::$Signal:ident, $atext:literal;)* }
        plain: { $($PType:ident $pname:ident: $Ppin:ident $pport:ident.$pfield:ident, $ptext:literal;)* }
        analog: { $($NType:ident $nname:ident: $Npin:ident $nport:ident.$nfield:ident, $ntext:literal;)* }
    ) => {
        pub const BOARD: super::Board = super::Board {
            name: $name,
            clock: stringify!($clock),
            uses: &[
                $((stringify!($aname), stringify!($Apin), concat!(stringify!($module), " ", stringify!($Signal)), $atext),)*
                $((stringify!($pname), stringify!($Ppin), "", $ptext),)*
                $((stringify!($nname), stringify!($Npin), "ADC1", $ntext),)*
            ],
        };
    };
}

#[path = "../src/bin/stage/board_pins/nucleo.rs"]
mod nucleo;
#[path = "../src/bin/stage/board_pins/reference.rs"]
mod reference;

/// What every chip of the family has there.
const CHIP: [(&str, &str); 8] = [
    ("PA13", "debugger, SWDIO"),
    ("PA14", "debugger, SWCLK"),
    ("PB2", "BOOT1, to ground"),
    ("PB3", "debugger, trace"),
    ("PC14", "crystal for time of day"),
    ("PC15", "crystal for time of day"),
    ("PH0", "clock, in"),
    ("PH1", "clock, out"),
];

/// What NUCLEO-F429ZI uses itself (ST's user manual UM1974, by board support packages that quote it).
const NUCLEO_OWN: [(&str, &str); 22] = [
    ("PA1", "Ethernet, RMII reference clock"),
    ("PA2", "Ethernet, MDIO"),
    ("PA7", "Ethernet, RMII CRS_DV"),
    ("PB13", "Ethernet, RMII TXD1"),
    ("PC1", "Ethernet, MDC"),
    ("PC4", "Ethernet, RMII RXD0"),
    ("PC5", "Ethernet, RMII RXD1"),
    ("PG11", "Ethernet, RMII TX_EN"),
    ("PG13", "Ethernet, RMII TXD0"),
    ("PA8", "USB, SOF"),
    ("PA9", "USB, VBUS"),
    ("PA10", "USB, ID"),
    ("PA11", "USB, D-"),
    ("PA12", "USB, D+"),
    ("PG6", "USB, power switch"),
    ("PG7", "USB, overcurrent"),
    ("PB0", "LD1, green"),
    ("PB7", "LD2, blue"),
    ("PB14", "LD3, red"),
    ("PC13", "button"),
    ("PD8", "ST-LINK's serial port"),
    ("PD9", "ST-LINK's serial port"),
];

/// What of it the controller means to use: lamps, serial port; and the pin that early silicon wants low, for which nothing is plugged
/// into the USB connector of the chip.
const SHARED: [(&str, &str); 6] = [
    ("status_lamp", "PB0"),
    ("drive_lamp", "PB7"),
    ("fault_lamp", "PB14"),
    ("serial_transmit", "PD8"),
    ("serial_receive", "PD9"),
    ("held", "PA12"),
];

const HEAD: &str = "# Pins

Written by `UPDATE=1 cargo test -p firmware --test pins_page` from the lists that the images are built from
(`firmware/src/bin/stage/board_pins/`); edit those, not this. That a pin has the signal of its line, the compiler says: the HAL's types take
no other, and the channels of the converter come from there too. The test says that no pin is used twice, and none that the board has
a use of its own for.

";

fn own(pin: &str, of_board: &[(&str, &'static str)]) -> Option<&'static str> {
    (CHIP.iter().map(|(it, what)| (*it, *what)))
        .chain(of_board.iter().copied())
        .find(|(it, _)| *it == pin)
        .map(|(_, what)| what)
}

/// Pins that are used twice, or that the board uses itself.
fn collisions(
    uses: &[Use],
    of_board: &[(&str, &'static str)],
    shared: &[(&str, &str)],
) -> Vec<String> {
    let mut found = Vec::new();
    for (at, (name, pin, ..)) in uses.iter().enumerate() {
        for (other, ..) in uses[..at].iter().filter(|(_, it, ..)| it == pin) {
            found.push(format!("{pin}: {other} and {name}"));
        }
        if let Some(what) = own(pin, of_board)
            && !shared.contains(&(*name, *pin))
        {
            found.push(format!("{pin}: {name} and {what}"));
        }
    }
    found
}

#[test]
fn the_page_is_what_the_lists_say() {
    let boards = [&reference::BOARD, &nucleo::BOARD];
    let mut page = HEAD.to_owned();
    page.push_str("| |");
    for board in boards {
        write!(page, " {} | signal |", board.name).unwrap();
    }
    page.push_str("\n|---|---|---|---|---|\n");
    let [first, second] = boards.map(|board| board.uses);
    assert_eq!(first.len(), second.len());
    for ((name, pin, signal, text), (other, other_pin, other_signal, other_text)) in
        first.iter().zip(second)
    {
        assert_eq!(
            (name, text),
            (other, other_text),
            "in the same order, with the same words"
        );
        let (signal, other_signal) = (signal.to_uppercase(), other_signal.to_uppercase());
        writeln!(
            page,
            "| {text} | {pin} | {signal} | {other_pin} | {other_signal} |"
        )
        .unwrap();
    }
    let clocks = boards.map(|board| match board.clock {
        "Crystal" => "PH0, PH1 | crystal",
        "Bypassed" => "PH0 | the ST-LINK's clock",
        other => panic!("{other}"),
    });
    writeln!(page, "| clock, 8 MHz | {} | {} |", clocks[0], clocks[1]).unwrap();
    page.push_str("| debugger, log (defmt over RTT) | PA13, PA14 | SWD | PA13, PA14 | ST-LINK on the board |\n");
    page.push_str("\n## What NUCLEO-F429ZI uses itself\n\n| pin | the board's use | the controller's |\n|---|---|---|\n");
    for (pin, what) in NUCLEO_OWN {
        let ours = SHARED.iter().find(|(_, it)| *it == pin);
        let ours = ours.map_or("", |(name, _)| name).replace('_', " ");
        writeln!(page, "| {pin} | {what} | {ours} |").unwrap();
    }
    written_page::hold("PINS.md", &page);
}

#[test]
fn no_pin_is_used_twice_and_none_that_the_board_has_a_use_for() {
    assert_eq!(collisions(reference::BOARD.uses, &[], &[]), [""; 0]);
    assert_eq!(
        collisions(nucleo::BOARD.uses, &NUCLEO_OWN, &SHARED),
        [""; 0]
    );
    // The reference board's list does not fit there, and says where: the check is one.
    let found = collisions(reference::BOARD.uses, &NUCLEO_OWN, &SHARED);
    for pin in ["PB13", "PB14", "PA9", "PA10", "PD8", "PD9", "PC1"] {
        assert!(
            found.iter().any(|it| it.starts_with(pin)),
            "{pin}: {found:?}"
        );
    }
}
