//! Moves, planned and carried out.

use crate::measured::{Group, Kind, Section};

pub(super) const SECTIONS: &[Section] = &[
    Section {
        name: "lines",
        title: "Straight moves beside the optimum",
        group: Group::Motion,
        about: "Duration of random moves over a numerical lower bound under all limits: x and y over the disk, theta up to a \
                turn, one in five up to three turns, half of them of any size from 0.1 mm up, one in four about another centre of \
                rotation. And the largest share of each limit at any tick of any of them.",
        command: "LINES=1000 cargo test --release -p firmware --test motion_optimum lines_keep -- --nocapture",
        short: Some(
            "cargo test --release -p firmware --test motion_optimum lines_keep -- --nocapture",
        ),
        kind: Kind::Deterministic,
        seconds: 5,
        without: &[],
    },
    Section {
        name: "retargets",
        title: "New targets in motion, beside rsruckig",
        group: Group::Motion,
        about: "A new target at a random tick of a random line, at which the stage ends at rest. rsruckig knows no limits along a \
                path: it is given the square within the circle of the path's limits, which is what it could be used for here, and \
                the square around it, which is a lower bound. It does not know the pivots' limits either: they are out of the way \
                first, then in force. \"After a stop\" are those that are reached sooner, or only, by stopping first.",
        command: "cargo test --release -p firmware --test motion_reference new_targets -- --nocapture",
        short: None,
        kind: Kind::Deterministic,
        seconds: 1,
        without: &[],
    },
    Section {
        name: "retarget",
        title: "New targets in motion, by what is left for them",
        group: Group::Motion,
        about: "Duration of the way to a new target over rsruckig's within the square, a stop and a line from there counted in where the \
                stage has to stop first: out of lines, early ones, for corrections of the target, out of stops, jogs and other retargets, \
                about other centres of rotation. Then the swing of the speed when a target that goes along a straight path is renewed \
                every 20 ms. Every plan is walked tick by tick against the exact limits. \"Refused\" are targets to which no straight \
                line leads from where the stage has stopped; \"too slow\" is rsruckig where the square is too slow for the path.",
        command: "CHECK=1 STATES=10000 cargo bench -p firmware-cost --bench retarget",
        short: Some("CHECK=1 cargo bench -p firmware-cost --bench retarget"),
        kind: Kind::Deterministic,
        seconds: 150,
        without: &[],
    },
    Section {
        name: "limits",
        title: "Every tick of random scripts",
        group: Group::Motion,
        about: "Random GCS scripts of targets, velocities, stops, streams and waveforms at any instants, through the command side and \
                the arithmetic of the tick: scripts with a tick over a limit of speed, acceleration, jerk, pivots or workspace.",
        command: "SCRIPTS=10000 cargo test --release -p firmware --test gcs_limits -- --nocapture --test-threads 1",
        short: Some(
            "cargo test --release -p firmware --test gcs_limits -- --nocapture --test-threads 1",
        ),
        kind: Kind::Deterministic,
        seconds: 180,
        without: &[],
    },
    Section {
        name: "jogs",
        title: "Velocities in motion that need a stop first",
        group: Group::Motion,
        about: "A random velocity commanded at a random tick of a line, or of another velocity: how many can not be reached from there \
                without stopping.",
        command: "cargo test --release -p firmware --test motion_jog another_velocity -- --nocapture",
        short: None,
        kind: Kind::Deterministic,
        seconds: 1,
        without: &[],
    },
    Section {
        name: "streams",
        title: "Streamed paths",
        group: Group::Motion,
        about: "A circle, a spiral and a scan raster given as targets in equal times: the setpoint's largest error against the ideal \
                path, and how much later it is.",
        command: "cargo test --release -p firmware --test motion_stream sampled -- --nocapture",
        short: None,
        kind: Kind::Deterministic,
        seconds: 1,
        without: &[],
    },
    Section {
        name: "settle",
        title: "Move and settle, and at rest",
        group: Group::Motion,
        about: "200 random moves of 1 mm and more on the simulated stage, as the controller comes and told the machine's numbers by parameters: \
                time from the command until every pivot stays within +-2 encoder LSB, after the \
                profile and as a multiple of it, and the share of moves within 1.1 of it. By each reading, where one that is noise counts, and \
                by the mean of a millisecond, as the controller judges it. Then the stage at rest, half a second at a \
                time: what moves, and how the motors' duty does.",
        command: "cargo bench --bench settle",
        short: None,
        kind: Kind::Deterministic,
        seconds: 170,
        without: &[],
    },
    Section {
        name: "rest",
        title: "At rest for ten minutes",
        group: Group::Motion,
        about: "Machines off the controller's model, with and without a load that it does not know of, with little and with much backlash, \
                with good and with noisy encoders: moved by 22 mm, and looked at from a second after the move on.",
        command: "SECONDS=600 cargo bench -p hal-sim --bench rest",
        short: Some("cargo bench -p hal-sim --bench rest"),
        kind: Kind::Deterministic,
        seconds: 3_000,
        without: &[],
    },
    Section {
        name: "told",
        title: "The demonstration on machines that the controller is told of",
        group: Group::Motion,
        about: "As the controller comes; told the machine's numbers by parameters; told its motors' ripple besides; both also with firmer \
                gains: a tenth more velocity gain, and an integral gain of 500 1/s times that in place of 350.",
        command: "cargo bench -p hal-sim --bench told",
        short: None,
        kind: Kind::Deterministic,
        seconds: 75,
        without: &[],
    },
    Section {
        name: "unknown-told",
        title: "The demonstration on machines as workshops build them",
        group: Group::Motion,
        about: "Machines drawn at random ([PLANT.md](PLANT.md#a-machine-of-ones-own)), whose controllers are told all that is true of them: wiring, zeros, \
                masses, friction, stiffness, errors, and gains that a search finds with the loops' mathematics. True pose against commanded pose.",
        command: "SEEDS=50 cargo bench -p hal-sim --bench unknown_told",
        short: Some("cargo bench -p hal-sim --bench unknown_told"),
        kind: Kind::Deterministic,
        seconds: 300,
        without: &[],
    },
    Section {
        name: "sensitivity",
        title: "What each imperfection decides",
        group: Group::Motion,
        about: "The demonstration on the reference stage, and with one imperfection less at a time, of which its controller is not told then.",
        command: "cargo run --release -- sensitivity",
        short: None,
        kind: Kind::Deterministic,
        seconds: 90,
        without: &[],
    },
    Section {
        name: "sensitivity-kind",
        title: "What each imperfection decides on a kind machine",
        group: Group::Motion,
        about: "The demonstration on the kind machine as modelled, with one imperfection more or less at a time, of which its controller knows nothing.",
        command: "cargo run --release -- sensitivity --kind",
        short: None,
        kind: Kind::Deterministic,
        seconds: 50,
        without: &[],
    },
    Section {
        name: "loop",
        title: "The loop, measured on the simulated machine",
        group: Group::Motion,
        about: "A sine added to an encoder's reading while the stage turns slowly, and a push of 1 N m on a ring at rest. Then Ms of each \
                pivot in the middle and near the rim, with and without a load, and the largest singular value of the matrix from all \
                three encoders to all three errors: the body couples the loops.",
        command: "cargo bench -p hal-sim --bench loop",
        short: None,
        kind: Kind::Deterministic,
        seconds: 150,
        without: &[],
    },
    Section {
        name: "repeated",
        title: "Moves that are repeated",
        group: Group::Motion,
        about: "Iterative learning (`ILC`) of 40 random moves: following error of the pivots over a move and 5 ms after it, without a table and \
                after five trials, and the worst of all trials beside that without a table. The last column is the worst of the same move \
                beside its first when it is repeated as often without a table: from time to time it hardly changes, what the servos \
                learn moves it on. Where a trial is worse than the first, it is because of the table.",
        command: "cargo bench -p tests --bench repeated_moves",
        short: None,
        kind: Kind::Deterministic,
        seconds: 150,
        without: &[],
    },
];
