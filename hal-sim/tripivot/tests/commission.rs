//! `tripivot commission` on machines as workshops build them: those that are sound are brought up, the others refused where it shows.

use hal_sim::machine::devices::StageParameters;
use hal_sim::machine::unknown;
use std::path::PathBuf;
use std::process::{Command, Output};

/// Currents are as their meters have them, some per mille off.
const MOST_FRICTION_ERROR: f64 = 0.03;

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("tripivot-{name}-{}", std::process::id()));
    // A folder that is not there need not go.
    let _ = std::fs::remove_dir_all(&folder);
    folder
}

fn commission(name: &str, arguments: &[&str]) -> (Output, PathBuf) {
    let folder = folder(name);
    let output = Command::new(env!("CARGO_BIN_EXE_tripivot"))
        .arg("commission")
        .args(arguments)
        .arg("--out")
        .arg(&folder)
        .output()
        .expect("the program runs");
    (output, folder)
}

fn text(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("text")
}

/// The numbers in a line of what is told, behind its colon.
fn numbers<'a>(text: &'a str, name: &str) -> impl Iterator<Item = f64> + 'a {
    let line = text.lines().find(|line| line.contains(name));
    let line = line.unwrap_or_else(|| panic!("no {name} in\n{text}"));
    let behind = line.rsplit_once(name).map_or("", |(_, behind)| behind);
    (behind.split([' ', ',', ':'])).filter_map(|word| word.parse().ok())
}

/// Ports and bridges of pivots 1, 2 and 3: pivot 1 is bridge 1's ring, the others follow it to the left.
fn pivots(machine: &StageParameters) -> [[u8; 3]; 2] {
    let wiring = machine.wiring;
    let first = (0..3).find(|ring| wiring.bridge_of_ring[*ring] == 0);
    let rings = [0, 1, 2].map(|pivot| (first.expect("one") + pivot) % 3);
    [wiring.port_of_ring, wiring.bridge_of_ring].map(|all| rings.map(|ring| all[ring] + 1))
}

/// The rings to the left of each other, as their ports follow, and the port of the ring that a bridge drives.
fn wiring(machine: &StageParameters) -> ([u8; 3], [u8; 3]) {
    let wiring = machine.wiring;
    let mut of_bridge = [0; 3];
    for ring in 0..3 {
        of_bridge[usize::from(wiring.bridge_of_ring[ring])] = wiring.port_of_ring[ring] + 1;
    }
    (wiring.port_of_ring.map(|port| port + 1), of_bridge)
}

#[test]
fn sound_machines_are_brought_up() {
    for seed in [1, 8, 19] {
        let machine = unknown(seed);
        let (output, folder) =
            commission(&format!("sound-{seed}"), &["--unknown", &seed.to_string()]);
        let told = text(&output);
        assert_eq!(output.status.code(), Some(0), "{told}");
        let (left, of_bridge) = wiring(&machine);
        let follows = [[1, 2, 3], [2, 3, 1], [3, 1, 2]].contains(&left);
        assert_eq!(
            told.contains("follow each other as 1, 2, 3"),
            follows,
            "{seed}\n{told}"
        );
        assert!(
            told.contains(&format!("each bridge its own ring: ports {of_bridge:?}")),
            "{told}"
        );
        let [ports, bridges] = pivots(&machine);
        let said = format!(
            "pivots 1, 2, 3, to the left of each other: ports {ports:?}, bridges {bridges:?}"
        );
        assert!(told.contains(&said), "{said}\n{told}");
        for bridge in 1..=3_u8 {
            let ring = machine
                .wiring
                .bridge_of_ring
                .iter()
                .position(|at| at + 1 == bridge);
            let turned = machine.wiring.leads_exchanged[ring.expect("one")];
            let way = if turned { "right" } else { "left" };
            let said = format!(
                "bridge {bridge}: moves the ring of port {}, {way} for",
                of_bridge[usize::from(bridge) - 1]
            );
            assert!(told.contains(&said), "{said}\n{told}");
        }
        let plant = &machine.plant;
        let constant = plant.torque_constant_n_m_a * plant.gear_ratio * machine.analog.supply_gain;
        let friction = plant.ring_friction.coulomb + plant.motor_friction.coulomb;
        for pivot in 1..=3 {
            let found = numbers(&told, &format!("motor of pivot {pivot}"))
                .next()
                .expect("a number");
            println!(
                "{seed}: motor constant {:+.2} %",
                100.0 * (found / constant - 1.0)
            );
            assert!((found / constant - 1.0).abs() < 0.02);
        }
        let found = numbers(&told, "mean of three").next().expect("a number");
        println!(
            "{seed}: friction {:+.1} %",
            100.0 * (found / friction - 1.0)
        );
        assert!((found / friction - 1.0).abs() < MOST_FRICTION_ERROR);
        assert!(folder.join("settings.flash").exists());
        let report = std::fs::read_to_string(folder.join("report.html")).expect("a report");
        assert!(report.contains(">commissioned<") && report.contains("</html>"));
        // Its settings run the machine.
        let script = folder.join("turn.gcs");
        std::fs::write(
            &script,
            "FRF\nWAC ONT? W = 1\nMOV X 20 W 90\nWAC ONT? W = 1\n",
        )
        .expect("written");
        let ran = Command::new(env!("CARGO_BIN_EXE_tripivot"))
            .arg("run")
            .arg(&script)
            .args(["--quiet", "--unknown", &seed.to_string(), "--settings"])
            .arg(folder.join("settings.flash"))
            .arg("--out")
            .arg(folder.join("run"))
            .output()
            .expect("it runs");
        // Encoders of 200 nrad never stay within two counts, which is what a run calls settled.
        let told = String::from_utf8_lossy(&ran.stderr);
        let noisy = told.contains("never settled");
        assert!(ran.status.code() == Some(0) || noisy, "{told}");
        let _ = std::fs::remove_dir_all(&folder);
    }
}

#[test]
fn machines_with_a_defect_are_refused_where_it_shows() {
    for (name, set, step, says) in [
        ("supply", "plant.supply_v=40", "wiring", "supply: 39"),
        (
            "jammed",
            "plant.ring_friction.coulomb=4.9",
            "hand",
            "no quarter of a turn",
        ),
        (
            "motor",
            "plant.torque_constant_n_m_a=0.002",
            "nudges",
            "bridge 1 moves nothing",
        ),
        (
            "winding",
            "plant.resistance_ohm=4.6",
            "windings",
            "not within a factor of two",
        ),
    ] {
        let (output, folder) = commission(name, &["--unknown", "1", "--set", set]);
        let told = text(&output);
        assert_eq!(output.status.code(), Some(1), "{name}\n{told}");
        let mut steps = told.lines().filter(|line| line.ends_with(" s)"));
        let last = steps.next_back().expect("a step");
        assert!(last.starts_with(&format!("{step}: ")), "{name}: {last}");
        assert!(told.contains(says), "{name}\n{told}");
        assert!(told.contains("what to do: ") && told.contains("not commissioned in"));
        // What was kept is in force again.
        assert!(!told.contains("not in force again"), "{told}");
        let report = std::fs::read_to_string(folder.join("report.html")).expect("a report");
        assert!(report.contains(">not commissioned<") && report.contains("What to do: "));
        let _ = std::fs::remove_dir_all(&folder);
    }
}

#[test]
fn the_steps_are_listed_without_a_machine() {
    let (output, folder) = commission("list", &["--list"]);
    let told = text(&output);
    assert_eq!(output.status.code(), Some(0));
    for step in ["wiring", "hand", "nudges", "windings", "zeros", "keep"] {
        assert!(told.lines().any(|line| line.starts_with(step)), "{told}");
    }
    assert!(!folder.exists());
}
