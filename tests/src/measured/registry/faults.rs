//! Faults, lost encoders, power cuts.

use crate::measured::{Group, Kind, Section};

pub(super) const SECTIONS: &[Section] = &[
    Section {
        name: "reactions",
        title: "Each reaction's way and turn to rest",
        group: Group::Faults,
        about: "The worst machine on this power stage: 5 kg that the controller is told of, half of the reference stage's friction at the \
                rings and none else, windings 100 K hot, masses a fifth more and motors a fifth weaker (\"weak\") or the other way round \
                (\"strong\"). Less load, cold windings and more friction leave more to brake with; they are not run. In motion at the \
                largest speed along chords of the disk, at the largest rotation that the pivots follow, and at both. Way of the \
                platform's centre, its turn and the time from the tick in which the fault begins until no pivot turns faster than \
                0.01 rad/s, worst of all motions. The same table stands in FAULTS.md.",
        command: "cargo bench -p tests --bench reactions",
        short: None,
        kind: Kind::Deterministic,
        seconds: 20,
        without: &[],
    },
    Section {
        name: "lost-encoder",
        title: "An encoder lost in motion",
        group: Group::Faults,
        about: "The other two and the model bring the stage to rest on its path: how far the platform is off it at most (`off`, mm and \
                deg), how far from the disk's centre it gets, and the ticks until it rests, over random moves at random ticks, for a \
                plant as modelled and one 20 % off.",
        command: "CASES=150 cargo test --release -p tests --test lost_encoder -- --nocapture",
        short: Some("cargo test --release -p tests --test lost_encoder -- --nocapture"),
        kind: Kind::Deterministic,
        seconds: 12,
        without: &[],
    },
    Section {
        name: "two-encoders",
        title: "Two encoders lost",
        group: Group::Faults,
        about: "A second encoder lost in the stop that the first one caused: how far the platform is off its setpoint at most until it \
                rests.",
        command: "CASES=300 cargo test --release -p tests --test second_fault two_lost -- --nocapture",
        short: Some("cargo test --release -p tests --test second_fault two_lost -- --nocapture"),
        kind: Kind::Deterministic,
        seconds: 12,
        without: &[],
    },
    Section {
        name: "campaign",
        title: "The campaign of faults",
        group: Group::Faults,
        about: "A fault at a random tick of a random motion (moves, jogs, waves, streams, in frames, while it is being referenced, while a motor is excited, with the servo \
                off and on, in a stop, after a fault that was acknowledged), on machines drawn as a workshop builds them, with every imperfection, whose \
                controllers were told their numbers, gains and notches for their resonances and a motion that their motors bear; and as many runs without. Wrong is: a fault \
                that is not latched in time, before what it names has passed its threshold in the machine itself, or under another name \
                or pivot; a second one in the stop that is not told; an alarm without a fault; outputs that are cut late; a stage that \
                goes on further, turns more, leaves its path by more, presses a guide further into its end or hits an end harder than \
                1.2 times what its masses, motors, currents and the time to find the fault allow. Latency counts from the tick in which \
                the effect passes its threshold, as the simulator sees it. Way, turn and blows are those from when the reaction had to \
                begin to rest; a blow is that of a carriage against its neighbour or the end of its guide. The second table is of runs \
                in which nothing was detected: the controller's inputs differ from those of the sound run by less than other noise makes \
                them differ; or by less than those of the same machine on another day (as warm as it may be, a quarter more or less friction, \
                another 2 % of supply, magnets 3 % off, sensors within what they are good for; one of eight such days); or as they would if somebody \
                pushed the sound machine with 50 N at a pivot at most (voltage, current and rate of each drive go together as on those days: three \
                encoders and three currents are explained by three forces), so that nobody could have known; or by more, without passing a \
                threshold; and how far the platform was off its path by then. `tripivot faults --only SEED` runs one of the seeds again.",
        // With findings, which are told, its exit code is 1.
        command: "cargo run --release -- faults --runs 10000 || test $? = 1",
        short: Some("cargo run --release -- faults --runs 200 || test $? = 1"),
        kind: Kind::Deterministic,
        seconds: 1_800,
        without: &[],
    },
    Section {
        name: "drive-changes",
        title: "Drives that change",
        group: Group::Faults,
        about: "What condition monitoring tells of a drive that is no more what its parameters say, and when. Machines as a workshop builds \
                them, with every imperfection, whose controllers were told their numbers, on another day (windings up to 60 K warmer, friction a quarter more \
                or less, magnets 3 % and supply 2 % off): random moves all over the disk at 50 to 200 mm/s; after 6 s something changes, at \
                pivot 2, in a tenth of a second, and is waited for for 30 s. Faults are those that came before anything was told; \
                what else was told of a drive is counted. Of the supply's sensor any motor tells.",
        command: "MACHINES=24 cargo bench -p tests --bench drive_changes",
        short: Some("MACHINES=2 cargo bench -p tests --bench drive_changes"),
        kind: Kind::Deterministic,
        seconds: 1_000,
        without: &[],
    },
    Section {
        name: "upsets",
        title: "Bits that flip in the chip's RAM",
        group: Group::Faults,
        about: "One bit of a word of a part of the memory, in a random tick of standing or moving, on the emulated chip. Nothing: the pins \
                have done what they do without it, for 75 ms. Harmless: they have not, but the platform was within a micrometre of \
                where it should be. Not told: it was further off, or the command side does not answer, and there was neither a fault nor a \
                restart. The loop's code and its tables are not among the parts: they are compared with their copy in flash; nor is the command side's memory. \
                `cargo chip-upsets --only PART:SEED` runs one of them again.",
        command: "cargo chip-upsets --runs 60",
        short: Some("cargo chip-upsets --runs 12"),
        kind: Kind::Compiled,
        seconds: 220,
        without: &[],
    },
    Section {
        name: "power-cuts",
        title: "Power cuts while settings are written",
        group: Group::Faults,
        about: "A random sequence of changes, the power cut at every step of writing each: what is found afterwards is all of the old \
                settings or all of the new ones, never anything else.",
        command: "CHANGES=1500 cargo test --release -p firmware --test store_power_cut -- --nocapture",
        short: Some("cargo test --release -p firmware --test store_power_cut -- --nocapture"),
        kind: Kind::Deterministic,
        seconds: 15,
        without: &[],
    },
];
