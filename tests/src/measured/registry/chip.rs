//! The image on the emulated chip.

use super::BESIDES;
use crate::measured::{Group, Kind, Section};

pub(super) const SECTIONS: &[Section] = &[
    Section {
        name: "chip",
        title: "The demonstration on the chip",
        group: Group::Chip,
        about: "The image, unmodified, beside the host: every tick compared to the bit, and what a tick costs. Wherever the figures of the \
                chip and of the host differ, plans have landed at other ticks.",
        command: "cargo chip",
        short: None,
        kind: Kind::Compiled,
        seconds: 40,
        without: BESIDES,
    },
    Section {
        name: "chip-ticks",
        title: "Motion from a seed on the chip",
        group: Group::Chip,
        about: "A kind machine: new targets in motion, jogs, streams, waves, stops, an encoder that breaks, faults acknowledged: chip and host compared at \
                every tick, and what ticks cost by what they do.",
        command: "cargo chip --kind --ticks 2000000",
        short: Some("cargo chip --kind --ticks 100000"),
        kind: Kind::Compiled,
        seconds: 300,
        without: &[],
    },
    Section {
        name: "chip-calibrated",
        title: "Motion from a seed on the chip, calibrated",
        group: Group::Chip,
        about: "The same of the reference stage with its calibration and all else in force that it is told: corrected setpoints, and the pose that is followed while the \
                servo is off.",
        command: "cargo chip --ticks 1000000",
        short: Some("cargo chip --ticks 50000"),
        kind: Kind::Compiled,
        seconds: 200,
        without: &[],
    },
    Section {
        name: "cost",
        title: "What the parts cost",
        group: Group::Chip,
        about: "Instructions of each part of the library over random states, with shares of the control period (or ms) at 1.0, 1.2 and \
                1.68 cycles an instruction; code and memory by part; the deepest stack. \
                [figures.csv](../firmware/figures.csv) keeps these figures: the command fails when one has grown by more than 3 %. Goals \
                that are not reached stand beside what is.",
        command: "cargo cost --check",
        short: None,
        kind: Kind::Compiled,
        seconds: 60,
        without: &["s of wall clock"],
    },
    Section {
        name: "cost-motion",
        title: "What planning costs at the worst",
        group: Group::Chip,
        about: "The same of the planners alone, over many more states.",
        command: "cargo cost --states 10000 --only motion",
        short: Some("cargo cost --states 1000 --only motion"),
        kind: Kind::Compiled,
        seconds: 300,
        without: &["s of wall clock"],
    },
    Section {
        name: "tick",
        title: "Where the instructions of a tick go",
        group: Group::Chip,
        about: "One tick in motion by the functions that its instructions come from, and an estimate of its cycles by `llvm-mca` where that \
                is installed.",
        command: "cargo chip-tick --by function",
        short: None,
        kind: Kind::Compiled,
        seconds: 5,
        without: &[],
    },
    Section {
        name: "cycles",
        title: "What a tick takes in cycles",
        group: Group::Chip,
        about: "Each tick's instructions, as the emulated chip ran them, through a model of the Cortex-M4F (ARM's table, loads that overlap, \
                results waited for, jumps, slow buses, entry), of RAM at address 0, which the loop's code comes from without a wait unless data \
                of the same block are in its way, and of ST's flash accelerator, which nothing of the loop comes through any more. What \
                the manuals leave open is guessed three times. Modelled, not measured: it may be some 6 % off, and what DMA takes of the \
                RAM is not in it. \
                [cycle-limits.csv](../firmware/cycle-limits.csv) keeps the nominal worst of each use and what it may be at most: \
                `--check` fails where one is over, a tick has loaded from flash, or the model without a memory is more than 2 % off \
                `llvm-mca`'s, both with one cycle for each load and store: ARM's table has more. No tick, with all that it does after its \
                duties, may be longer than a period, pessimistically.",
        command: "cargo chip-cycles",
        short: Some("cargo chip-cycles --ticks 100"),
        kind: Kind::Compiled,
        seconds: 60,
        without: &[],
    },
    Section {
        name: "load",
        title: "The tick under load",
        group: Group::Chip,
        about: "When the tick starts after its timer event while the serial line is full in both directions and records are read out. Then \
                chips that execute few instructions a second, with all at once that a controller has to do: two streams, one of them while \
                eight signals are recorded in every tick, new targets in motion, settings stored with the servo on. Each with streams that it \
                can follow, and two with faster ones, which end there and are told: the first error that was. 220: targets did not come in time; \
                others followed from it.",
        command: "cargo chip-load",
        short: None,
        kind: Kind::Compiled,
        seconds: 80,
        without: &[],
    },
    Section {
        name: "image-check",
        title: "Proofs on the image, and its sizes",
        group: Group::Chip,
        about: "The image is taken apart, instruction by instruction: from the handlers of the control loop no path leads to the panic \
                machinery, a trap, a call through a pointer, a recursion or arithmetic in f64, nor to code in flash, and none of their code makes \
                an address of the flash. The deepest stack counts both levels of interrupts on top of everything below.",
        command: "cargo image-check",
        short: None,
        kind: Kind::Compiled,
        seconds: 2,
        without: &[],
    },
];
