//! A centre of rotation beside the platform's centre: the machine turns about that point.

use firmware::mode::Mode;
use firmware::motion::{Constraints, RotationCentre, plan_line};
use firmware::parameters::Parameters;
use firmware::queues::{Command, Queues, Snapshot};
use firmware::recorder::Sample;
use hal_sim::front::Host;
use hal_sim::machine::devices::StageParameters;
use hal_sim::rig::observer::TickRecord;

const TURN: f64 = 4_294_967_296.0;
const RADIUS_MM: f64 = 100.0;

/// A host, its queues, and the last tick.
struct Run {
    host: Host,
    queues: Queues,
    record: TickRecord,
}

impl Run {
    fn ticks(&mut self, command: Option<Command>, ticks: u32) -> Snapshot {
        let (mut tick_queues, mut commands) = self.queues.split();
        if let Some(command) = command {
            commands.send(command).expect("room");
        }
        let mut last = None;
        for _ in 0..ticks {
            self.host.tick(&mut tick_queues, &mut self.record);
            last = commands.snapshot().or(last);
        }
        last.expect("a snapshot")
    }

    fn sample(&self) -> &Sample {
        self.record.sample.as_ref().expect("a tick has run")
    }

    /// Where the plant has a point of the platform in the mean over a tenth of a second: at rest the servo goes to and fro by some nm.
    fn mean_point(&mut self, point: [f64; 2]) -> [f64; 2] {
        const TIMES: u32 = 500;
        let mut mean = [0.0; 2];
        for _ in 0..TIMES {
            self.ticks(None, 4);
            let now = self.true_point(point);
            mean = [0, 1].map(|i| mean[i] + now[i] / f64::from(TIMES));
        }
        mean
    }

    /// Where the plant has a point of the platform, mm.
    fn true_point(&self, point: [f64; 2]) -> [f64; 2] {
        let [x, y, theta] = self.host.stage.plant.pose();
        let (sin, cos) = theta.sin_cos();
        let [a, b] = point.map(|radii| radii * RADIUS_MM);
        [x * 1e3 + a * cos - b * sin, y * 1e3 + a * sin + b * cos]
    }
}

#[test]
fn the_machine_turns_about_the_chosen_point() {
    let parameters = Parameters::REFERENCE;
    let mut run = Run {
        host: Host::new(&StageParameters::REFERENCE, &parameters),
        queues: Queues::new(),
        record: TickRecord::default(),
    };
    run.ticks(None, 10);
    let point = [0.25, -0.1];
    let centre = RotationCentre::new(point).expect("near enough");

    // Off, the point is taken, and told where it is once the stage holds.
    let off = run.ticks(Some(Command::Centre(centre)), 10);
    assert_eq!((off.mode, off.centre, off.refused), (Mode::Off, centre, 0));
    let held = run.ticks(Some(Command::Reference), 2_000);
    assert_eq!((held.mode, held.refused), (Mode::Holding, 0));
    let pivots = run.sample().pivot_setpoints;
    let there = run.mean_point(point);
    for (units, there) in held.setpoint.into_iter().zip(there) {
        let told_mm = units as f64 / TURN * RADIUS_MM;
        assert!((told_mm - there).abs() < 3.2e-7, "{told_mm} {there}");
    }

    // Holding, another point moves nothing; and back.
    let other = run.ticks(Some(Command::Centre(RotationCentre::PLATFORM)), 10);
    assert_ne!(other.setpoint, held.setpoint);
    assert_eq!(run.sample().pivot_setpoints, pivots);
    let back = run.ticks(Some(Command::Centre(centre)), 10);
    assert_eq!(back.setpoint, held.setpoint);
    assert_eq!(run.sample().pivot_setpoints, pivots);

    // Two thirds of a turn: the point stays where it is, the platform's centre goes round it.
    let ground = Constraints {
        rotation_centre: centre.point(),
        ..Constraints::new(parameters.limits, parameters.geometry)
    };
    let mut to = held.setpoint;
    to[2] += (TURN * 2.0 / 3.0) as i64;
    let plan = plan_line(1, held.setpoint, to, &ground).expect("inside the disk");
    let ticks = plan.ticks();
    let command = run.queues.split().1.hand_over(&plan).expect("a slot");
    run.ticks(Some(command), 10);
    let mut worst_um = 0.0_f64;
    let mut furthest_mm = 0.0_f64;
    for tick in 0..ticks {
        let refused = (tick == 100).then_some(Command::Centre(RotationCentre::PLATFORM));
        // There is a snapshot in four ticks.
        let now = run.ticks(refused, 4);
        assert_eq!(now.centre, centre, "in motion the point stays");
        assert_eq!(run.host.fault(), None);
        let [x, y] = run.true_point(point);
        worst_um = worst_um.max((x - there[0]).hypot(y - there[1]) * 1e3);
        let [x, y, _] = run.host.stage.plant.pose();
        furthest_mm = furthest_mm.max(x.hypot(y) * 1e3);
        if now.mode == Mode::Holding {
            assert_eq!((now.setpoint, now.refused), (to, 1));
            break;
        }
    }
    println!("the point strayed {worst_um} um");
    assert!(worst_um < 0.135, "{worst_um} um");
    assert!(furthest_mm > 53.8, "the platform's centre went round");
    assert_eq!(run.sample().reference_point.position, to);
    assert_eq!(run.sample().setpoint.position, centre.to_platform(&to));
}
