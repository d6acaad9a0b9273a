//! What the host takes.

use crate::measured::{Group, Kind, Section};

pub(super) const SECTIONS: &[Section] = &[
    Section {
        name: "speed",
        title: "Speed of the simulation",
        group: Group::Host,
        about: "A control period of the plant, of the stage and of the controller alone, and the demonstration as a whole.",
        command: "cargo bench -p hal-sim --bench speed",
        short: None,
        kind: Kind::HostTime,
        seconds: 20,
        without: &[],
    },
    Section {
        name: "imperfection-cost",
        title: "What each imperfection costs",
        group: Group::Host,
        about: "How many times real time a run of two moves is, on one core, for a kind machine, with one imperfection more or less at a time, and \
                with all. The machines take turns; medians of nine rounds, of the ratios to the kind one's run in the same round too. Goal: at least \
                4 times real time with all.",
        command: "cargo bench -p hal-sim --bench cost",
        short: None,
        kind: Kind::HostTime,
        seconds: 50,
        without: &[],
    },
    Section {
        name: "calibration-fit",
        title: "Fits of a calibration",
        group: Group::Host,
        about: "A fit of 600 visits spread evenly, outliers looked for and covariance told, by instrument: rows of the measurement, and numbers \
                that are fitted to them.",
        command: "cargo bench -p hal-sim --bench fit",
        short: None,
        kind: Kind::HostTime,
        seconds: 20,
        without: &[],
    },
    Section {
        name: "planning",
        title: "Planning beside rsruckig",
        group: Group::Host,
        about: "Time of rsruckig over ours, in one run: a straight line from rest; a new target in motion with all slices, looked at along its \
                whole way for disk and pivots, which rsruckig does not do; a streamed target; the next setpoint.",
        command: "cargo bench -p firmware-cost --bench planning",
        short: None,
        kind: Kind::HostTime,
        seconds: 30,
        without: &[],
    },
    Section {
        name: "kinematics",
        title: "Kinematics beside nalgebra",
        group: Group::Host,
        about: "The same equations written with nalgebra as it comes, which takes sine and arcsine from the C library; here they are the crate \
                `libm`'s, the same everywhere. Alone is one call after the other, batch is independent ones.",
        command: "cargo bench -p kinematics --bench speed",
        short: None,
        kind: Kind::HostTime,
        seconds: 30,
        without: &[],
    },
    Section {
        name: "viewers",
        title: "Viewers of the page",
        group: Group::Host,
        about: "`tripivot serve` in real time beside viewers of its page: how late ticks are, and how many pictures a second the slowest \
                viewer gets.",
        command: "cargo bench --bench viewers",
        short: None,
        kind: Kind::HostTime,
        seconds: 45,
        without: &[],
    },
    Section {
        name: "soak",
        title: "Everybody at once",
        group: Group::Host,
        about: "`tripivot serve` under 20 clients and a page that ask 50 times a second and move the stage, beside four floods, dying pages and \
                readers that hardly read: how long answers take. Nothing is lost or refused, and the memory of the process does not grow.",
        command: "SECONDS=600 cargo bench -p tripivot --bench soak",
        short: Some("cargo bench -p tripivot --bench soak"),
        kind: Kind::HostTime,
        seconds: 620,
        without: &[],
    },
    Section {
        name: "clients",
        title: "Clients that ask without pause",
        group: Group::Host,
        about: "Clients that ask `tripivot serve` for the position as fast as they can, beside moves. No reply is lost.",
        command: "cargo test --release --test serve load -- --nocapture",
        short: None,
        kind: Kind::HostTime,
        seconds: 10,
        without: &[],
    },
];
