//! Whoever looks at the page changes nothing of the control loop.

use desk::web::questions;
use firmware::gcs::Session;
use firmware::recorder::RunningHash;
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::rig::run::{RunOptions, controller_parameters, stage_parameters};
use hal_sim::rig::{ControllerMemory, Rig};

/// Ticks between two looks: 60 times a second.
const LOOK_EVERY: u64 = 333;
/// Ticks of a run: half a second.
const TICKS: u64 = 10_000;
/// Lines of a client, and the ticks after which it sends them.
const DRIVEN: &[(u64, &str)] = &[
    (0, "FRF"),
    (1_000, "MOV X 30 Y -20 W 45"),
    (2_500, "MOV X -10 W -60"),
    (7_000, "JOG W 90"),
    (9_000, "STP"),
];

/// Running hash over state, setpoints, measured pivots and duties of every tick of a driven stage, and how many bytes
/// were answered to those who look, each of whom sends `lines`.
fn run(viewers: usize, lines: &str) -> (RunningHash, usize) {
    let options = RunOptions::default();
    let parameters = controller_parameters(&options);
    let mut memory = ControllerMemory::new();
    let (stage, flash) = (stage_parameters(&options), SettingsFlash::in_memory());
    let mut rig = Rig::simulated(&mut memory, &stage, &parameters, flash);
    let mut client = Session::new();
    let mut looking: Vec<_> = (0..viewers).map(|_| Session::new()).collect();
    let (mut hash, mut replies, mut seen) = (RunningHash::default(), Vec::new(), Vec::new());
    for tick in 0..TICKS {
        rig.tick(&mut hash);
        for (_, line) in DRIVEN.iter().filter(|(at, _)| *at == tick) {
            client.receive(format!("{line}\n").as_bytes());
        }
        // Those who look are served first, so that whatever they could hold up they would.
        for (number, session) in (0..).zip(&mut looking) {
            if (tick + number) % LOOK_EVERY == 0 {
                assert_eq!(session.receive(lines.as_bytes()), lines.len(), "no room");
            }
            rig.service(session, &mut seen).expect("a vector");
        }
        rig.service(&mut client, &mut replies).expect("a vector");
    }
    assert_eq!(rig.front.fault(), None);
    (hash, seen.len())
}

#[test]
fn who_looks_changes_no_bit_of_any_tick() {
    let questions: String = questions().flat_map(|line| [line, "\n"]).collect();
    let (alone, _) = run(0, "");
    for viewers in [1, 4] {
        let (watched, bytes) = run(viewers, &questions);
        assert_eq!(watched, alone, "{viewers} viewers");
        let looks = viewers * (TICKS / LOOK_EVERY) as usize;
        assert!(bytes > 500 * looks, "{bytes} bytes for {looks} looks");
    }
    // A hand on it would be noticed.
    let (pushed, _) = run(1, "VLS 100\n");
    assert_ne!(pushed, alone);
}
