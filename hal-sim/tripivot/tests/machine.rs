//! A machine of one's own on the command line.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn tripivot(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tripivot"))
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap()
}

#[test]
fn a_machine_is_printed_changed_and_run() {
    let folder = folder("own-machine");
    fs::write(folder.join("step.gcs"), "FRF\nMOV X 1\nWAC ONT? X = 1\n").unwrap();
    let printed = tripivot(&folder, &["machine"]).stdout;
    let text = String::from_utf8(printed).unwrap();
    assert!(text.contains("platform_mass_kg = 3.0"), "{text}");
    // The reference stage has every imperfection, a kind one has not.
    assert!(!text.contains("guide_friction = false"), "{text}");
    let kind = String::from_utf8(tripivot(&folder, &["machine", "--kind"]).stdout).unwrap();
    assert!(kind.contains("guide_friction = false"), "{kind}");
    fs::write(
        folder.join("own.toml"),
        text.replace("platform_mass_kg = 3.0", "platform_mass_kg = 4.5"),
    )
    .unwrap();
    let run = |arguments: &[&str]| {
        let all = [&["run", "step.gcs", "--json", "--quiet"], arguments].concat();
        let output = tripivot(&folder, &all);
        assert!(output.status.success(), "{output:?}");
        serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap()
    };
    let as_modelled = run(&[]);
    let own = run(&["--machine", "own.toml"]);
    let set = run(&["--set", "plant.platform_mass_kg=4.5"]);
    // The heavier platform makes another error; told by a file or by itself it is the same, and no mismatch comes on top.
    assert_ne!(as_modelled["following_error"], own["following_error"]);
    assert_eq!(own["following_error"], set["following_error"]);
    assert_eq!(own["conditions"]["mismatch_percent"], 0.0);
    let name = |run: &serde_json::Value| run["conditions"]["machine"].as_str().unwrap().to_owned();
    assert_eq!(
        name(&own),
        "simulated machine of own.toml, controller on the host"
    );
    assert_eq!(
        name(&set),
        "simulated reference stage with plant.platform_mass_kg=4.5, controller on the host"
    );
}

/// Every number is another one's, and nobody has told the controller: it refuses to drive.
#[test]
fn an_unknown_machine_is_not_driven() {
    let folder = folder("unknown-machine");
    fs::write(folder.join("step.gcs"), "FRF\nMOV X 1\n").unwrap();
    let printed = |seed: &str| tripivot(&folder, &["machine", "--unknown", seed]).stdout;
    assert_ne!(printed("1"), printed("2"));
    fs::write(folder.join("first.toml"), printed("1")).unwrap();
    assert_eq!(
        tripivot(&folder, &["machine", "--machine", "first.toml"]).stdout,
        printed("1")
    );
    let run = tripivot(&folder, &["run", "step.gcs", "--unknown", "1", "--quiet"]);
    assert_eq!(run.status.code(), Some(1), "{run:?}");
    let said = String::from_utf8(run.stderr).unwrap();
    assert!(said.contains("4005"), "{said}");
    // Told all of it, wires and zeros among it, it drives.
    let run = tripivot(
        &folder,
        &["run", "step.gcs", "--unknown", "1", "--told", "--quiet"],
    );
    assert_eq!(run.status.code(), Some(0), "{run:?}");
    let both = tripivot(
        &folder,
        &["machine", "--unknown", "1", "--machine", "first.toml"],
    );
    assert_eq!(both.status.code(), Some(2));
}

#[test]
fn a_wrong_machine_is_refused_by_name() {
    let folder = folder("wrong-machine");
    fs::write(folder.join("wrong.toml"), "[plant]\nplatform_mass = 3\n").unwrap();
    for (arguments, words) in [
        (
            &["machine", "--machine", "wrong.toml"][..],
            "wrong.toml: plant.platform_mass: no such number of a machine; did you mean platform_mass_kg?",
        ),
        (
            &["--set", "encoders.0.noise_rad=1"],
            "--set: encoders.0.noise_rad = 1: must be from 0 to 0.0001",
        ),
        (
            &["machine", "--machine", "none.toml"],
            "cannot read none.toml: ",
        ),
    ] {
        let output = tripivot(&folder, arguments);
        assert_eq!(output.status.code(), Some(2));
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(error.contains(words), "{error}");
    }
}
