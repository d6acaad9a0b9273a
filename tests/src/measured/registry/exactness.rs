//! Numbers against better ones.

use crate::measured::{Group, Kind, Section};

pub(super) const SECTIONS: &[Section] = &[
    Section {
        name: "vectors",
        title: "Kinematics beside 50 digits",
        group: Group::Exactness,
        about: "Largest error against vectors of 50 digits: pivots (rad), guides' lengths (track radii), dexterity, centre (track radii), \
                theta (rad).",
        command: "cargo test --release -p kinematics --test vectors -- --nocapture --test-threads 1",
        short: None,
        kind: Kind::Deterministic,
        seconds: 1,
        without: &[],
    },
    Section {
        name: "fixed-point",
        title: "Fixed point beside f64 and 57 digits",
        group: Group::Exactness,
        about: "The loop's pivot setpoints, also with a centre of rotation up to a track radius away, and its measured pose, against f64 \
                at the same inputs over a grid of the disk, theta within +-10,000 turns; and random poses of these against 57 digits. A \
                quarter of an encoder LSB is 2 pi / 2^28 rad.",
        command: "cargo test --release -p firmware --test exactness --test fifty_digits -- --nocapture --test-threads 1",
        short: None,
        kind: Kind::Deterministic,
        seconds: 1,
        without: &["seed "],
    },
    Section {
        name: "functions",
        title: "Elementary functions of the loop",
        group: Group::Exactness,
        about: "Largest error against f64 over all of their 2^32 arguments; `cargo test` takes each 1,009th. Of the last ones and the square \
                root it is how often they are not exact.",
        command: "INPUTS=all cargo test --release -p firmware --test all_inputs -- --nocapture --test-threads 1",
        short: Some(
            "cargo test --release -p firmware --test all_inputs -- --nocapture --test-threads 1",
        ),
        kind: Kind::Deterministic,
        seconds: 800,
        without: &[" %"],
    },
    Section {
        name: "calibration",
        title: "Machines that are measured and fitted",
        group: Group::Exactness,
        about: "Machines drawn from seeds, some 85 um and 620 urad off with the best frames, measured by simulated instruments and fitted \
                with `tripivot calibrate`'s library: what is left between true poses of the plant and poses asked for with the fitted numbers, \
                over the whole disk and all orientations, beside what was predicted. At planned poses (chosen for what they add) and at poses \
                spread evenly. `camera2` is a plate of unknown marks under a camera at two places, `xy` one target, `ends` nothing but the \
                guides' ends. Encoders have 30 nrad of noise. By chance alone is what fits come to that are just as good as their covariances \
                say, drawn 200 times for as many machines: the median, and what 95 % of them stay within.",
        command: "MACHINES=50 cargo bench -p hal-sim --bench calibration",
        short: Some("cargo bench -p hal-sim --bench calibration"),
        kind: Kind::Deterministic,
        seconds: 240,
        without: &["slowest fit"],
    },
    Section {
        name: "calibration-unkind",
        title: "Machines that do not repeat, measured and fitted",
        group: Group::Exactness,
        about: "The same at planned poses, of machines that do not repeat: first of guides of 50 N/um that lose motion under 1 N of friction, then of \
                guides, scales and balls as `--unknown` draws them. The fit finds this beside the instrument's noise. True poses are reached from \
                any side, so what is not repeated is in all figures but those predicted before the measurement; verified over predicted has it \
                in both. As it repeats is what the same fits would leave without it: the best that arriving from one side, or knowing the \
                friction, could come to.",
        command: "for kind in reference workshop; do echo \"$kind:\"; UNKIND=$kind MACHINES=50 cargo bench -p hal-sim --bench calibration; done",
        short: Some(
            "for kind in reference workshop; do echo \"$kind:\"; UNKIND=$kind cargo bench -p hal-sim --bench calibration; done",
        ),
        kind: Kind::Deterministic,
        seconds: 260,
        without: &["slowest fit"],
    },
    Section {
        name: "calibration-dynamic",
        title: "Machines that calibrate themselves",
        group: Group::Exactness,
        about: "Three unknown machines, each commissioned first, in full dynamics: sent by its controller, with a plate that nobody has measured \
                under a camera at two places (300 visits, 50 nm), fitted, verified at fresh poses. At last what only a simulator knows: true poses \
                against commanded ones, as drawn and calibrated. What the machine does not repeat is in all of it.",
        command: "set -o pipefail; for seed in 1 2 3; do echo \"machine $seed:\"; cargo run --release -- calibrate demo --unknown $seed --out \
                  target/demo-$seed | grep -E '^(verified|x and y|theta|verdict|true)'; done",
        short: Some(
            "set -o pipefail; cargo run --release -- calibrate demo --unknown 1 --out target/demo-1 | grep -E '^(verified|x and y|theta|verdict|true)'",
        ),
        kind: Kind::Deterministic,
        seconds: 600,
        without: &[],
    },
    Section {
        name: "calibration-ends",
        title: "Machines that touch their guides' ends",
        group: Group::Exactness,
        about: "Three unknown machines in full dynamics, with no jig and no instrument: commissioned with zeros from where the guides end, then each \
                driven against those ends at 200 planned poses, fitted and told. Verified with an interferometer (50 nm, 1 urad), which a user without one \
                has not; the scale, of which angles tell nothing, is taken out.",
        command: "set -eo pipefail; t='cargo run --release --quiet --'; for seed in 1 2 3; do echo \"machine $seed:\"; d=target/ends-$seed; rm -rf \
                  $d; on=\"--unknown $seed --settings $d/settings.flash\"; $t commission --unknown $seed --without-jig --out $d | grep -E -A3 \
                  '^(ends|commissioned)'; $t calibrate measure $on --kit ends --noise 2um --poses 200 --out $d/measured.csv >$d/measured.txt; $t calibrate fit \
                  $d/measured.csv --noise 2um --serial SIM --out $d/fit.toml | grep -E '^(chi|expected)'; $t calibrate apply $d/fit.toml --measured \
                  $d/measured.csv $on >$d/applied.txt; $t calibrate verify $d/fit.toml --kit xyt --noise 50nm --noise-theta 1urad $on | grep -E '^(x and \
                  y|theta|scale|verdict)'; done",
        short: None,
        kind: Kind::Deterministic,
        seconds: 900,
        without: &[],
    },
];
