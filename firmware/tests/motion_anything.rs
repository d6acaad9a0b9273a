//! Anything after anything: targets, constant velocities and stops, each at any tick of the one before, about any point
//! of the platform, within bounds of x, y and theta, with strong and weak drives. Every tick keeps limits, workspace
//! and continuity.

mod motion_bench;

use firmware::motion::{
    AxisState, Constraints, Effort, Plan, PlanStart, Position, RetargetError, RotationCentre,
    Setpoint, SetpointScale, Stop, plan_jog, plan_line, plan_retarget, plan_stop,
};
use motion_bench::constraints::{Velocity, any_constraints, rest, velocities};
use motion_bench::exact::{Worst, ends_at_rest};
use motion_bench::*;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use std::cell::Cell;

#[derive(Clone, Copy, Debug)]
enum Command {
    /// Where the platform's centre is to be.
    Target(Position),
    Velocity(Velocity),
    Stop(Stop),
}

impl Command {
    fn kind(&self) -> usize {
        match self {
            Self::Target(_) => 0,
            Self::Velocity(_) => 1,
            Self::Stop(_) => 2,
        }
    }
}

/// What to do, and which part of what it leads to is left to happen: of two seconds at most.
fn commands() -> impl Strategy<Value = Vec<(Command, f64)>> {
    let one = prop_oneof![
        4 => positions(0.3).prop_map(Command::Target),
        2 => velocities().prop_map(Command::Velocity),
        1 => Just(Command::Stop(Stop::Smooth)),
        1 => Just(Command::Stop(Stop::Urgent)),
    ];
    prop::collection::vec((one, 0.0..1.0_f64), 2..7)
}

/// Ticks of a piece that are looked at.
const MOST: u64 = 20_000;

/// A motion under way.
struct Course {
    plan: Plan,
    from: [AxisState; 3],
    constraints: Constraints,
}

impl Course {
    /// At rest.
    fn resting(from: [AxisState; 3], constraints: Constraints) -> Self {
        let at = from.map(|axis| axis.rounded());
        let plan = plan_line(1, at, at, &constraints).expect("where it is");
        Self {
            plan,
            from,
            constraints,
        }
    }

    /// The plan for a command that comes at a tick, `None` where there is none or a stop has to come first.
    fn plan(&self, command: &Command, at: u64) -> Option<Plan> {
        let (id, constraints) = (self.plan.id + 1, &self.constraints);
        let (state, moving) = (
            self.plan.state_after(&self.from, at),
            at < self.plan.ticks(),
        );
        let here = state.map(|axis| axis.rounded());
        match *command {
            Command::Target(platform) => {
                let to = RotationCentre::new(constraints.rotation_centre)?.from_platform(&platform);
                if moving {
                    plan_retarget(id, &self.plan, &self.from, at, to, constraints, Effort::ALL).ok()
                } else {
                    plan_line(id, here, to, constraints).ok()
                }
            }
            Command::Velocity(velocity) => {
                let start = if moving {
                    let plan = self.plan.id;
                    PlanStart::Splice { plan, tick: at }
                } else {
                    PlanStart::Rest(here)
                };
                match plan_jog(id, start, &state, &velocity, constraints) {
                    Err(RetargetError::NeedsStop) if !moving => panic!("at rest"),
                    plan => plan.ok(),
                }
            }
            Command::Stop(how) => plan_stop(id, &self.plan, &self.from, at, constraints, how),
        }
    }

    /// Holds a plan that leaves this one against the law.
    fn check(
        &self,
        command: &Command,
        next: &Plan,
        start: &[AxisState; 3],
    ) -> Result<(), TestCaseError> {
        let mut worst = Worst::default();
        let end = worst.walk_ends(next, start, &self.constraints, MOST);
        let before = Worst::of(start, &self.constraints);
        let worst = match command {
            Command::Stop(_) => worst.of_a_stop(&self.constraints),
            _ => worst.left_with(&before, &self.constraints),
        };
        prop_assert!(
            worst.is_kept_but_for_a_thousandth(),
            "{command:?} {worst:?}\nfrom {before:?} {start:?}\n{next:?}\non {:?}",
            self.constraints
        );
        prop_assert!(ends_at_rest(next, &end), "{command:?} {end:?} {next:?}");
        Ok(())
    }
}

/// Whether the tick's own setpoints do more than go on from tick to tick: position by the velocity, velocity by the
/// acceleration.
fn is_stepped(before: &Setpoint, now: &Setpoint, constraints: &Constraints) -> bool {
    let hz = constraints.limits.rate_hz;
    let unit = [1.0, 1.0, 1.0 / std::f64::consts::TAU];
    let rates = |p: &Setpoint| [p.twist.x, p.twist.y, p.twist.theta].map(f64::from);
    let forces = |p: &Setpoint| {
        let a = p.acceleration;
        [a.x, a.y, a.theta].map(f64::from)
    };
    let ([v, w], [a, b]) = ([before, now].map(rates), [before, now].map(forces));
    (0..3).any(|i| {
        let way = (now.position[i] - before.position[i]) as f64 / UNIT / unit[i];
        // Positions are whole units; rates have 24 bits, velocities end at 1e-7 rad/s.
        let step = way - (v[i] + w[i]) / 2.0 / hz;
        let change = w[i] - v[i] - (a[i] + b[i]) / 2.0 / hz;
        step.abs() > 2.0 / UNIT / unit[i] + 1e-6 * v[i].abs().max(w[i].abs()) / hz + 1e-9
            || change.abs() > 1e-6 * v[i].abs().max(w[i].abs()) + 3e-7
    })
}

#[test]
fn limits_workspace_and_continuity_are_kept() {
    // Plans made at rest and in motion, by command.
    let made = Cell::new([[0; 2]; 3]);
    let all = (positions(0.3), any_constraints(), commands());
    let result = TestRunner::new(settings(400)).run(&all, |(platform, constraints, all)| {
        let from = rest(platform, &constraints);
        prop_assume!(from.is_some());
        let mut course = Course::resting(from.unwrap(), constraints);
        let scale = SetpointScale::new(constraints.limits.rate_hz);
        let mut motion = follower();
        motion.rest_at(course.plan.end);
        let mut at = 0;
        let mut seen = motion.setpoint(&scale);
        for (command, part) in all {
            let next = course.plan(&command, at);
            if let Some(next) = next.filter(|next| next.ticks() > 0) {
                let start = course.plan.state_after(&course.from, at);
                course.check(&command, &next, &start)?;
                let mut counts = made.get();
                counts[command.kind()][usize::from(motion.is_moving())] += 1;
                made.set(counts);
                prop_assert_eq!(motion.accept(&next), Ok(()));
                course = Course {
                    plan: next,
                    from: start,
                    constraints,
                };
                at = 0;
            }
            // A motion of years is left after two seconds; a plan is taken with the next tick.
            let left = course.plan.ticks().saturating_sub(at).min(40_000);
            for _ in 0..=(left as f64 * part * 1.2) as u64 {
                motion.advance();
                let now = motion.setpoint(&scale);
                prop_assert!(
                    !is_stepped(&seen, &now, &constraints),
                    "{seen:?} {now:?} {command:?}"
                );
                seen = now;
                at += 1;
            }
        }
        Ok(())
    });
    println!("targets, velocities, stops, at rest and in motion: {made:?}");
    result.unwrap();
    let [targets, velocities, stops] = made.get();
    assert!(targets[1] > 50 && velocities[1] > 30 && stops[1] > 80);
}
