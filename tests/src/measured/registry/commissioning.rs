//! Machines that nobody knows, brought up.

use crate::measured::{Group, Kind, Section};

pub(super) const SECTIONS: &[Section] = &[
    Section {
        name: "commission",
        title: "Machines that nobody knows, commissioned",
        group: Group::Commissioning,
        about: "Machines drawn from seeds, brought up by `tripivot commission` with a simulated person beside them; their plugs are in as they \
                belong, so that the campaign after it may have them. What was found against what is true, by the meters of the machine, and what their \
                loops are with the gains that were found, as measured and on the true plant, whose gears have no play and whose windings are as warm as they \
                were when the gains were sought; the best that gains can do there knows that plant. Limits are those that are aimed at; at the end how long each \
                step took. Begun again, it goes on where it was left.",
        command: "export SETTINGS=$PWD/target/commissioned RESULTS=$PWD/target/commissioned-$(git rev-parse --short HEAD).jsonl; \
                  bench='cargo bench -p tripivot --bench commission'; $bench --no-run; for part in 1-24 25-48; do SEEDS=$part $bench >/dev/null & done; \
                  wait; TABLE=1 SEEDS=1-48 $bench",
        short: Some("cargo bench -p tripivot --bench commission"),
        kind: Kind::Deterministic,
        seconds: 1_800,
        without: &[],
    },
    Section {
        name: "commissioned-settling",
        title: "Commissioned machines settle",
        group: Group::Commissioning,
        about: "The demonstration on the machines of the table before, as their commissionings have left them in `target/commissioned`, and with the \
                gains that are best on their true plants, all else the same; windings begin cold. A stage has settled once its centre stays within \
                0.1 um: at the encoders of its setpoint, in truth of where it comes to stand. What the true pose may take: two periods of the \
                platform on its guides, and 6 ms.",
        command: "SETTINGS=$PWD/target/commissioned cargo bench -p hal-sim --bench commissioned",
        short: None,
        kind: Kind::Deterministic,
        seconds: 400,
        without: &[],
    },
    Section {
        name: "commissioned-kind",
        title: "Kind machines, commissioned",
        group: Group::Commissioning,
        about: "Machines without friction and give in their guides and without errors of gears and encoders, so far off the drawing and with such a load \
                20 mm off the centre, brought up by `tripivot commission`: the demonstration, then random moves of 1 mm and more over the whole disk with \
                half a second at rest after every tenth. A move has settled when every pivot stays within +-2 encoder LSB. What is aimed at: 0.03 um rms \
                and 0.15 peak, settling 4 ms in the mean and 7 at worst (with 5 kg 0.05 and 1.2; 4 and 7), and 97 % of the moves within 1.1 of their \
                profiles.",
        command: "cargo bench -p tripivot --bench kind",
        short: None,
        kind: Kind::Deterministic,
        seconds: 290,
        without: &[],
    },
    Section {
        name: "campaign-commissioned",
        title: "The campaign of faults on commissioned machines",
        group: Group::Commissioning,
        about: "[The campaign](#the-campaign-of-faults) on the machines [of the table above](#machines-that-nobody-knows-commissioned), with the settings that its commissionings have left \
                in `target/commissioned`, in place of what a builder would tell the controller.",
        // With findings, which are told, its exit code is 1.
        command: "cargo run --release -- faults --runs 1000 --commissioned target/commissioned || test $? = 1",
        short: None,
        kind: Kind::Deterministic,
        seconds: 130,
        without: &[],
    },
];
