//! What is a board's own: the images of both boards boot, answer on their serial lines, and move the stage; their lamps are on the pins
//! that `firmware/PINS.md` says. Needs `cargo stage` and `cargo stage-nucleo` first, then `cargo chip-test`.

use hal_sim::machine::devices::{Stage, StageParameters};
use image::chip::{Action, Bench, BoardKind, Period, elf_file};
use std::ops::ControlFlow::{Break, Continue};
use std::path::PathBuf;
use std::sync::mpsc;

/// A board: its image, what it is to the emulator, its name, its three lamps (output register of the port, bit), and whether its clock
/// comes from outside, past the oscillator.
struct Known {
    image: &'static str,
    kind: BoardKind,
    name: &'static str,
    lamps: [(u64, u32); 3],
    bypassed: bool,
}

const OUTPUTS_B: u64 = 0x4002_0414;
const OUTPUTS_E: u64 = 0x4002_1014;
const RCC_CR: u64 = 0x4002_3800;
const HSE_BYPASSED: u32 = 1 << 18;

const BOARDS: [Known; 2] = [
    Known {
        image: "stage",
        kind: BoardKind::REFERENCE,
        name: "BOARD=reference board, STM32F427",
        lamps: [(OUTPUTS_E, 0), (OUTPUTS_E, 1), (OUTPUTS_E, 2)],
        bypassed: false,
    },
    Known {
        image: "stage-nucleo",
        kind: BoardKind::NUCLEO,
        name: "BOARD=NUCLEO-F429ZI, STM32F429",
        lamps: [(OUTPUTS_B, 0), (OUTPUTS_B, 7), (OUTPUTS_B, 14)],
        bypassed: true,
    },
];

fn image(name: &str) -> PathBuf {
    elf_file::built(name)
        .unwrap_or_else(|| panic!("the image {name}: build it with `cargo {name}`"))
}

fn is_high(period: &mut Period<'_>, (register, bit): (u64, u32)) -> bool {
    period
        .register(register)
        .is_some_and(|word| word >> bit & 1 != 0)
}

/// What one run has shown.
#[derive(Default)]
struct Seen {
    unasked: Vec<u8>,
    answers: String,
    /// The status lamp, in steps of 0.1 s: servo off, holding, fault.
    status: [String; 3],
    /// The other two then.
    others: [[bool; 2]; 3],
    bypassed: bool,
    pose: [f64; 3],
}

/// Ticks of a step of the status lamp's pattern, and in which steps it is looked at: servo off, holding, fault.
const STEP: u64 = 2_000;
const LOOKS: [std::ops::Range<u64>; 3] = [0..3, 6..10, 16..22];

fn run(board: &Known) -> Seen {
    let stage = Stage::new(&StageParameters::REFERENCE);
    let bench = Bench::load(&image(board.image), stage).expect("an image with its symbols");
    let (send, receive) = mpsc::channel();
    let mut seen = Seen::default();
    let lamps = board.lamps;
    let outcome = bench
        .on(board.kind)
        .run(move |period| {
            let tick = period.tick;
            // In the middle of a step.
            if tick % STEP == STEP / 2 {
                let [lit, drive, fault] = lamps.map(|lamp| is_high(period, lamp));
                for (look, steps) in LOOKS.iter().enumerate() {
                    if steps.contains(&(tick / STEP)) {
                        seen.status[look].push(if lit { '1' } else { '0' });
                        seen.others[look] = [drive, fault];
                    }
                }
            }
            match tick {
                // A start is told to who asks: a client that opened the line before would take it for an answer.
                6_000 => {
                    seen.unasked = period.received();
                    let control = period.register(RCC_CR);
                    seen.bypassed = control.is_some_and(|control| control & HSE_BYPASSED != 0);
                    period.send(b"*IDN?\nEVT?\nTST?\n");
                }
                7_000 => period.send(b"FRF X\nMOV X 2 W 3\n"),
                21_000 => {
                    seen.pose = period.stage.plant.pose();
                    let at = period.tick_at_ns();
                    period.at(at, Action::EmergencyStop(true));
                }
                44_000 => {
                    seen.answers = String::from_utf8_lossy(&period.received()).into_owned();
                    send.send(std::mem::take(&mut seen))
                        .expect("the test waits");
                    return Break(());
                }
                _ => {}
            }
            Continue(())
        })
        .expect("a run");
    assert_eq!(outcome.gaps, Vec::<String>::new(), "{}", board.image);
    assert!(outcome.resets.is_empty(), "{:?}", outcome.resets);
    receive.recv().expect("the last period")
}

#[test]
fn every_board_boots_answers_and_moves_and_shows_it() {
    for board in &BOARDS {
        let seen = run(board);
        println!("{}: {}", board.image, seen.answers);
        assert_eq!(seen.unasked, b"", "nothing is sent unasked");
        for told in ["Tripivot, XYT-1", board.name, "1 0 start by power on"] {
            assert!(seen.answers.contains(told), "{told}: {}", seen.answers);
        }
        assert_eq!(seen.bypassed, board.bypassed);
        // One flash; lit half the time; three flashes.
        assert_eq!(seen.status, ["100", "1100", "101010"], "{}", board.image);
        assert_eq!(seen.others, [[false, false], [true, false], [false, true]]);
        let [x_m, _, theta_rad] = seen.pose;
        assert!((x_m - 0.002).abs() < 1e-6, "{x_m}");
        assert!(
            (theta_rad - 3.0_f64.to_radians()).abs() < 1e-5,
            "{theta_rad}"
        );
    }
}
