//! The simulated stage on a tour of the disk.

use super::BESIDES;
use crate::measured::{Group, Kind, Section};

pub(super) const SECTIONS: &[Section] = &[
    Section {
        name: "demonstration",
        title: "The demonstration",
        group: Group::Demonstration,
        about: "A machine as a workshop builds it, every imperfection on, whose controller has the settings that `tripivot commission` found for it, and \
                a calibration, zeros with it, in which nothing was measured wrong.",
        command: "cargo run --release",
        short: None,
        kind: Kind::Deterministic,
        seconds: 3,
        without: BESIDES,
    },
    Section {
        name: "kind",
        title: "The demonstration on a kind machine",
        group: Group::Demonstration,
        about: "No friction and no give in the guides, no errors of geometry, gears and encoders, an ideal supply; but the plant is 20 % off the \
                controller's model of it: heavier, with more friction and weaker motors.",
        command: "cargo run --release -- --kind",
        short: None,
        kind: Kind::Deterministic,
        seconds: 2,
        without: BESIDES,
    },
    Section {
        name: "as-modelled",
        title: "The demonstration on a plant as modelled",
        group: Group::Demonstration,
        about: "The kind machine, its numbers being those of the controller's model.",
        command: "cargo run --release -- --kind --mismatch 0",
        short: None,
        kind: Kind::Deterministic,
        seconds: 2,
        without: BESIDES,
    },
    Section {
        name: "payload",
        title: "The demonstration with an unknown payload",
        group: Group::Demonstration,
        about: "5 kg on the platform that the controller knows nothing of, on the kind machine that is 20 % off.",
        command: "cargo run --release -- --kind --payload 5",
        short: None,
        kind: Kind::Deterministic,
        seconds: 2,
        without: BESIDES,
    },
];
