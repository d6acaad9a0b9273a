//! Pivots that are no pose, and setpoints that no pivots can follow.

use firmware::fault::FaultKind;
use firmware::mode::Mode;
use firmware::motion::{Constraints, Plan, plan_line};
use firmware::parameters::{Parameters, Supervision};
use firmware::queues::{Command, CommandQueues, QueueFull, Queues, Snapshot};
use hal_sim::front::Host;
use hal_sim::machine::devices::StageParameters;
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

/// The zero of encoder 1 off by a quarter turn: every angle is a good one, and together they are a pose 9 mm out of the disk.
#[test]
fn a_pose_out_of_reach_is_no_reference_and_is_told() {
    let mut stage = StageParameters::REFERENCE;
    stage.encoders[0].zero_counts += HALF_TURN_COUNTS / 2;
    let mut bench = Bench::new(&stage);
    assert_eq!(bench.error_after("FRF"), "4003");
    let events = bench.say("EVT?\n");
    assert!(events.contains("Y 89.3 W 26.6, out of reach"), "{events}");
    assert_eq!((bench.mode(), bench.outputs.awake), (Mode::Off, false));
    assert_eq!(bench.error_after("SVO X 1\nMOV X 1"), "5");
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

/// The reference, but for the margin of the disk.
fn with_disk_margin(disk_margin_mm: f64) -> Parameters {
    Parameters {
        supervision: Supervision {
            disk_margin_mm,
            ..Parameters::REFERENCE.supervision
        },
        ..Parameters::REFERENCE
    }
}

/// A line of `way_mm` along x, which may go further than any planner would.
fn line(parameters: &Parameters, at: &Snapshot, way_mm: f64) -> Plan {
    let from = at.setpoint;
    let half = [(way_mm / 200.0 * 4_294_967_296.0) as i64, 0, 0];
    let mut plan = plan_line(
        at.plan + 1,
        [0; 3],
        half,
        &Constraints::new(parameters.limits, parameters.geometry),
    )
    .expect("inside the disk");
    for piece in &mut plan.pieces {
        piece.jerk = piece.jerk.map(|jerk| 2 * jerk);
    }
    plan.nudge = plan.nudge.map(|nudge| 2 * nudge);
    plan.start = firmware::motion::PlanStart::Rest(from);
    plan.end = [from[0] + 2 * half[0], from[1], from[2]];
    plan
}

fn fault_of_a_line_to(end_mm: f64, theta_deg: f64, parameters: &Parameters) -> Option<FaultKind> {
    fault_of_lines(&[0.0, end_mm], theta_deg, parameters)
}

/// What comes of lines along x from the first of these places to the others, one after the other.
fn fault_of_lines(places_mm: &[f64], theta_deg: f64, parameters: &Parameters) -> Option<FaultKind> {
    let mut host = Host::new(&StageParameters::REFERENCE, parameters);
    let start_m = places_mm[0] / 1e3;
    (host.stage).set_pose_at_rest([start_m, 0.0, theta_deg.to_radians()]);
    let mut queues = Queues::new();
    let (mut tick_queues, mut commands) = queues.split();
    for _ in 0..10 {
        host.tick(&mut tick_queues, &mut ());
    }
    commands.send(Command::Reference).expect("room");
    let mut at = None;
    // Commands wait until the bridges are awake and the leads tested.
    for _ in 0..80 {
        host.tick(&mut tick_queues, &mut ());
        at = commands.snapshot().or(at);
    }
    let at = at.expect("a snapshot");
    assert_eq!(at.mode, Mode::Holding);
    let mut now = Some(at);
    let mut ways = places_mm.windows(2).map(|ends| ends[1] - ends[0]);
    for _ in 0..20_000 {
        if let Some(at) = now.as_ref().filter(|now| now.mode == Mode::Holding)
            && let Some(way_mm) = ways.next()
        {
            let plan = line(parameters, at, way_mm);
            commands.send_plan(&plan).expect("room");
            now = None;
        }
        let outputs = host.tick(&mut tick_queues, &mut ());
        now = commands.snapshot().or(now);
        if let Some(fault) = host.fault()
            && let Some(told) = now.as_ref().filter(|now| now.fault.is_some())
        {
            assert_eq!(
                told.tick,
                fault.tick + 1,
                "{fault}: the tick that should have followed it"
            );
            assert!(outputs.awake, "{fault}: it brakes");
            assert!(outputs.duty.iter().all(|duty| duty.0 == 0), "{fault}");
            assert_eq!(told.mode, Mode::Fault, "{fault}: at once");
            return Some(fault.kind);
        }
    }
    None
}

#[test]
fn a_setpoint_beyond_the_track_is_a_fault() {
    let fault = fault_of_a_line_to(130.0, 0.0, &lenient());
    assert_eq!(fault, Some(FaultKind::ImpossibleSetpoint));
    // The twin ends inside the mechanics.
    assert_eq!(fault_of_a_line_to(82.0, 0.0, &lenient()), None);
}

#[test]
fn a_setpoint_out_of_the_disk_is_a_fault() {
    let parameters = Parameters::REFERENCE;
    let fault = |end_mm| fault_of_a_line_to(end_mm, 0.0, &parameters);
    assert_eq!(fault(80.6), Some(FaultKind::WorkspaceLeft));
    assert_eq!(fault(80.4), None);
}

#[test]
fn a_setpoint_out_of_a_guide_is_a_fault() {
    // Guide 3 points along -x: it is the first to reach its end.
    let fault = |end_mm| fault_of_a_line_to(end_mm, -30.0, &with_disk_margin(3.0));
    assert_eq!(fault(80.6), Some(FaultKind::GuideRange));
    assert_eq!(fault(80.4), None);
}

/// The nearer end: guide 1 points along x.
#[test]
fn a_setpoint_out_of_a_guides_start_is_a_fault() {
    let fault = |end_mm| fault_of_a_line_to(end_mm, 30.0, &with_disk_margin(3.0));
    assert_eq!(fault(80.6), Some(FaultKind::GuideRange));
    assert_eq!(fault(80.4), None);
}

#[test]
fn the_way_back_into_the_disk_leads_only_inwards() {
    let parameters = Parameters::REFERENCE;
    let fault = |places_mm: &[f64]| fault_of_lines(places_mm, 0.0, &parameters);
    assert_eq!(fault(&[82.0, 81.0]), None);
    assert_eq!(fault(&[82.0, 81.0, 70.0]), None);
    assert_eq!(fault(&[82.0, 83.0]), Some(FaultKind::WorkspaceLeft));
    assert_eq!(fault(&[82.0, 81.0, 81.8]), Some(FaultKind::WorkspaceLeft));
    assert_eq!(fault(&[82.0, 70.0, 81.8]), Some(FaultKind::WorkspaceLeft));
}

/// A gain that no float holds: the servo's sums are no numbers from the first tick on.
#[test]
fn what_is_not_a_number_is_a_fault_and_never_a_duty() {
    for (velocity_v_s_rad, fault) in [(1e300, Some(FaultKind::NotFinite)), (40.0, None)] {
        let mut parameters = Parameters::REFERENCE;
        parameters.servo.gains[0].velocity_v_s_rad = velocity_v_s_rad;
        let mut host = Host::new(&StageParameters::REFERENCE, &parameters);
        let mut queues = Queues::new();
        let (mut tick_queues, mut commands) = queues.split();
        for _ in 0..10 {
            host.tick(&mut tick_queues, &mut ());
        }
        commands.send(Command::Reference).expect("room");
        let mut last = None;
        for tick in 0..600 {
            let outputs = host.tick(&mut tick_queues, &mut ());
            let largest = outputs.duty.iter().map(|duty| duty.0.abs()).max();
            // Leads are tested with 4 V, and the dead time; what that has stirred up is gone in 10 ms.
            let most = if tick < 300 { 400 } else { 57 };
            assert!(largest <= Some(most), "{tick}: {largest:?}");
            last = commands
                .snapshot()
                .map(|now| (now.mode, outputs.awake))
                .or(last);
        }
        assert_eq!(host.fault().map(|fault| fault.kind), fault);
        let mode = if fault.is_some() {
            Mode::Fault
        } else {
            Mode::Holding
        };
        assert_eq!(last, Some((mode, true)), "it brakes");
    }
}

/// Sends something, or nothing.
type Sends<'a> = &'a dyn Fn(&mut CommandQueues<'_>) -> Result<(), QueueFull>;

/// The tick refuses by itself what the command side would not send: nobody can go round it.
#[test]
fn in_a_fault_the_tick_takes_nothing_but_the_acknowledgement() {
    let parameters = Parameters::REFERENCE;
    let mut host = Host::new(&StageParameters::REFERENCE, &parameters);
    let mut queues = Queues::new();
    let (mut tick_queues, mut commands) = queues.split();
    let mut after = |host: &mut Host, sends: Sends<'_>| {
        sends(&mut commands).expect("room");
        let mut last = None;
        for _ in 0..10 {
            host.tick(&mut tick_queues, &mut ());
            last = commands.snapshot().or(last);
        }
        last.expect("a snapshot")
    };
    after(&mut host, &|_| Ok(()));
    let holding = after(&mut host, &|queues| queues.send(Command::Reference));
    assert_eq!(holding.mode, Mode::Holding);
    host.emergency_stop = true;
    after(&mut host, &|_| Ok(()));
    host.emergency_stop = false;
    let plan = line(&parameters, &holding, 10.0);
    let all: [(&str, Sends<'_>); 4] = [
        ("servo on", &|queues| queues.send(Command::Servo(true))),
        ("reference", &|queues| queues.send(Command::Reference)),
        ("move", &|queues| queues.send_plan(&plan)),
        ("servo off", &|queues| queues.send(Command::Servo(false))),
    ];
    for (name, sends) in all {
        let now = after(&mut host, sends);
        assert_eq!(now.mode, Mode::Fault, "{name}");
        assert_eq!(now.setpoint, holding.setpoint, "{name}");
    }
    let now = after(&mut host, &|queues| queues.send(Command::Acknowledge));
    assert_eq!((now.mode, now.fault, now.refused), (Mode::Off, None, 4));
}
