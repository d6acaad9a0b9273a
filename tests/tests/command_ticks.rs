//! The ticks in which commands are taken and told of. All that a calibrated stage's tick does has to end within its period, and nothing but
//! this keeps curves, a command and a snapshot out of one tick.

use firmware::control::CalibrationInForce;
use firmware::parameters::Parameters;
use firmware::queues::{Command, Queues, Snapshot};
use hal_sim::front::Host;
use hal_sim::machine::devices::StageParameters;
use hal_sim::rig::observer::TickRecord;
use hal_sim::rig::{built_stage, calibration_told};
use kinematics::Geometry;

/// A tick, and what was seen of it.
struct Tick {
    took_command: bool,
    snapshot: Option<Snapshot>,
}

/// Ticks with a command always waiting, the servo off, after the calibration is in force.
fn ticks(calibrated: bool, count: usize) -> Vec<Tick> {
    let stage = built_stage(&StageParameters::REFERENCE);
    let mut queues = Queues::new();
    let (mut tick_queues, mut commands) = queues.split();
    let mut host = Host::new(&stage, &Parameters::REFERENCE);
    let mut record = TickRecord::default();
    let mut tick = |command: Option<Command>| {
        if let Some(command) = command {
            // Full: there is one that waits.
            let _ = commands.send(command);
        }
        host.tick(&mut tick_queues, &mut record);
        let told = record.sample.as_ref().expect("a tick has run").commands;
        (told, commands.snapshot())
    };
    if calibrated {
        let told = calibration_told(&stage);
        let (calibration, margins) = told.for_tick(&Geometry::REFERENCE).expect("a machine");
        tick(Some(Command::Calibrate(CalibrationInForce {
            is_on: true,
            calibration,
            margins,
        })));
    }
    for _ in 0..20 {
        tick(None);
    }
    let seen: Vec<_> = (0..=count)
        .map(|_| tick(Some(Command::Acknowledge)))
        .collect();
    // A sample tells of the commands that the ticks before it took.
    (seen.windows(2))
        .map(|pair| Tick {
            took_command: pair[1].0 != pair[0].0,
            snapshot: pair[0].1.clone(),
        })
        .collect()
}

#[test]
fn with_a_calibration_commands_and_snapshots_take_turns_in_the_fourth_tick() {
    let ticks = ticks(true, 400);
    let busy: Vec<usize> = (0..ticks.len())
        .filter(|i| ticks[*i].took_command || ticks[*i].snapshot.is_some())
        .collect();
    assert!(
        busy.windows(2).all(|pair| pair[1] - pair[0] == 4),
        "{busy:?}"
    );
    assert_eq!(busy.len(), 100);
    let mut taken = None;
    for tick in busy.iter().map(|i| &ticks[*i]) {
        assert!(tick.took_command != tick.snapshot.is_some(), "{busy:?}");
        if let Some(snapshot) = &tick.snapshot {
            // Each tells of one more.
            assert!(taken.is_none_or(|taken| snapshot.commands == taken + 1));
            taken = Some(snapshot.commands);
        }
    }
}

#[test]
fn without_one_every_tick_takes_a_command_and_tells_of_the_last_one() {
    for (i, tick) in ticks(false, 400).iter().enumerate().skip(4) {
        assert!(tick.took_command && tick.snapshot.is_some(), "{i}");
    }
}
