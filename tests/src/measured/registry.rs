//! The sections of the page.

use super::{Group, Kind, Section};

/// Lines of a run that are not figures of the stage: the script's queries and their answers, the folder, the host's speed; and the
/// run's conditions, which the section's command and words say, the program's commit among them.
const BESIDES: &[&str] = &[
    "?",
    "=",
    "trace and report in",
    "times real time",
    "conditions",
    "  program ",
    "  machine ",
    "  seed ",
    "  mismatch ",
    "  payload ",
    "  imperfections ",
    "  settings ",
];

/// All of them; those of a chapter in the page's order.
pub const SECTIONS: &[Section] = &[
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
                another 2 % of supply, magnets 3 % off, sensors within what they are good for), so that nobody could have known; or by more, without passing a \
                threshold; and how far the platform was off its path by then. `tripivot faults --only SEED` runs one of the seeds again.",
        // With findings, which are told, its exit code is 1.
        command: "cargo run --release -- faults --runs 10000 || test $? = 1",
        short: Some("cargo run --release -- faults --runs 200 || test $? = 1"),
        kind: Kind::Deterministic,
        seconds: 1_200,
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
