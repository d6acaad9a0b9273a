//! What FAULTS.md says of way, turn and time to rest is what comes of the motions that are worst.

use tests::reactions::{Motion, ToRest, Trouble, to_rest};

/// One reaction a test: they run side by side.
fn is_as_kept(trouble: Trouble) {
    let kept = include_str!("../../firmware/reactions.csv");
    let row = kept
        .lines()
        .find(|line| line.split(',').next() == Some(trouble.reaction()));
    let cells: Vec<&str> = row.expect("a row").split(',').skip(1).collect();
    let values: [fn(&ToRest) -> f64; 3] =
        [|rest| rest.way_mm, |rest| rest.turn_deg, |rest| rest.ms];
    for (pair, value) in cells.chunks(2).zip(values) {
        let kept: f64 = pair[0].parse().expect("a number");
        let motion = Motion::all()
            .into_iter()
            .find(|motion| motion.words() == pair[1]);
        let measured = value(&to_rest(trouble, motion.expect("a motion")));
        println!("{}: {measured:.2}, kept {kept}", trouble.reaction());
        assert!(
            (measured / kept - 1.0).abs() < 0.1,
            "{trouble:?} {pair:?}: {measured}"
        );
    }
}

#[test]
fn a_stop_is_as_kept() {
    is_as_kept(Trouble::Late);
}

#[test]
fn a_brake_is_as_kept() {
    is_as_kept(Trouble::Supply);
}

#[test]
fn coasting_is_as_kept() {
    is_as_kept(Trouble::Bridge);
}

#[test]
fn an_emergency_stop_is_as_kept() {
    is_as_kept(Trouble::EmergencyStop);
}
