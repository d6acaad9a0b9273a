//! Pivots that are no pose, and setpoints that no pivots can follow.

use firmware::fault::FaultKind;
use firmware::link::{Command, Link, Mode};
use firmware::motion::{Ground, Plan, plan_line};
use firmware::parameters::{Parameters, Supervision};
use hal_sim::devices::StageParameters;
use hal_sim::host::Host;
use tests::Bench;

const HALF_TURN_COUNTS: u32 = 1 << 25;

/// A stage whose first encoder is mounted the wrong way round: to the controller, pivot 1 stands on the far side.
#[test]
fn pivots_that_are_no_pose_cannot_be_referenced() {
    let mut stage = StageParameters::REFERENCE;
    stage.encoders[0].zero_counts ^= HALF_TURN_COUNTS;
    let mut bench = Bench::new(&stage);
    assert_eq!(bench.error_after("FRF"), "45");
    bench.run(100);
    assert_eq!((bench.mode(), bench.outputs.awake), (Mode::Off, false));
    // The twin is every other test: mounted as the parameters say.
}

/// A referenced host that does not mind how far a pivot is from its setpoint, nor how far out that is.
fn lenient() -> Parameters {
    Parameters {
        supervision: Supervision {
            following_error_rad: 3.0,
            disk_margin_mm: 100.0,
            guide_margin: 1.0,
            ..Parameters::REFERENCE.supervision
        },
        ..Parameters::REFERENCE
    }
}

/// A line along x to `end_mm`, further than any planner would go.
fn line(parameters: &Parameters, from: [i64; 3], end_mm: f64) -> Plan {
    let half = [(end_mm / 200.0 * 4_294_967_296.0) as i64, 0, 0];
    let mut plan = plan_line(
        1,
        [0; 3],
        half,
        &Ground::new(parameters.limits, parameters.geometry),
    )
    .expect("inside the disk");
    for piece in &mut plan.pieces {
        piece.jerk = piece.jerk.map(|jerk| 2 * jerk);
    }
    plan.nudge = plan.nudge.map(|nudge| 2 * nudge);
    plan.start = firmware::motion::Start::Rest(from);
    plan.end = [from[0] + 2 * half[0], from[1], from[2]];
    plan
}

fn fault_of_a_line_to(end_mm: f64) -> Option<FaultKind> {
    let parameters = lenient();
    let mut host = Host::new(&StageParameters::REFERENCE, &parameters);
    let mut link = Link::new();
    let (mut tick_link, mut commands) = link.split();
    for _ in 0..10 {
        host.tick(&mut tick_link, &mut ());
    }
    commands.send(Command::Reference).expect("room");
    let mut at = None;
    for _ in 0..10 {
        host.tick(&mut tick_link, &mut ());
        at = commands.snapshot();
    }
    let at = at.expect("a snapshot");
    assert_eq!(at.mode, Mode::Holding);
    commands
        .send(Command::Move(line(&parameters, at.setpoint, end_mm)))
        .expect("room");
    for _ in 0..20_000 {
        host.tick(&mut tick_link, &mut ());
    }
    host.fault().map(|fault| fault.kind)
}

#[test]
fn a_setpoint_beyond_the_track_is_a_fault() {
    assert_eq!(
        fault_of_a_line_to(130.0),
        Some(FaultKind::ImpossibleSetpoint)
    );
    // The twin ends inside the mechanics.
    assert_eq!(fault_of_a_line_to(82.0), None);
}

/// The tick refuses by itself what the command side would not send: nobody can go round it.
#[test]
fn in_a_fault_the_tick_takes_nothing_but_the_acknowledgement() {
    let parameters = Parameters::REFERENCE;
    let mut host = Host::new(&StageParameters::REFERENCE, &parameters);
    let mut link = Link::new();
    let (mut tick_link, mut commands) = link.split();
    let mut after = |host: &mut Host, command: Option<Command>| {
        if let Some(command) = command {
            commands.send(command).expect("room");
        }
        let mut last = None;
        for _ in 0..10 {
            host.tick(&mut tick_link, &mut ());
            last = commands.snapshot().or(last);
        }
        last.expect("a snapshot")
    };
    after(&mut host, None);
    let holding = after(&mut host, Some(Command::Reference));
    assert_eq!(holding.mode, Mode::Holding);
    host.emergency_stop = true;
    after(&mut host, None);
    host.emergency_stop = false;
    let plan = line(&parameters, holding.setpoint, 10.0);
    for command in [
        Command::Servo(true),
        Command::Reference,
        Command::Move(plan),
        Command::Servo(false),
    ] {
        let now = after(&mut host, Some(command.clone()));
        assert_eq!(now.mode, Mode::Fault, "{command:?}");
        assert_eq!(now.setpoint, holding.setpoint, "{command:?}");
    }
    let now = after(&mut host, Some(Command::Acknowledge));
    assert_eq!((now.mode, now.fault, now.refused), (Mode::Off, None, 4));
}
