//! Theta is exact at any number of turns: ten thousand of them in odd steps and back, tick by tick, and jogging
//! besides.

mod motion_bench;

use firmware::motion::{
    AxisState, Constraints, LoneFollower, Plan, PlanStart, Position, RotationCentre, plan_jog,
    plan_line,
};
use firmware::number::Fixed;
use kinematics::{Angle, Pose, inverse};
use motion_bench::*;

const TURN: i64 = 1 << 32;
const TURNS: i64 = 10_000;
const ENCODER_BITS: u32 = 26;

/// As fast as the integers allow, so that twenty thousand turns are eleven million ticks and not four hundred million.
fn fast() -> Constraints {
    let mut constraints = CONSTRAINTS;
    let limits = &mut constraints.limits;
    limits.turn_speed_deg_s = 36.0 * 360.0;
    limits.turn_acceleration_deg_s2 = 36.0 * 7_200.0;
    limits.turn_jerk_deg_s3 = 36.0 * 720_000.0;
    limits.pivot_rate_rad_s = 1e3;
    limits.pivot_acceleration_rad_s2 = 1e6;
    constraints.rotation_centre = RotationCentre::new([0.1, -0.2]).expect("near").point();
    constraints
}

/// The setpoint's motion, tick by tick.
struct Stage {
    motion: LoneFollower<'static>,
    constraints: Constraints,
    id: u32,
}

impl Stage {
    fn new() -> Self {
        let constraints = fast();
        let mut motion = follower();
        motion
            .set_centre(RotationCentre::new(constraints.rotation_centre).expect("near"))
            .expect("at rest");
        motion.rest_at(at(7.0, -5.0, 33.0 / 360.0));
        Self {
            motion,
            constraints,
            id: 0,
        }
    }

    fn follow(&mut self, plan: &Plan, ticks: u64) {
        self.motion
            .accept(plan)
            .expect("starts where the motion is");
        for _ in 0..ticks {
            let before = self.motion.position()[2];
            self.motion.advance();
            let step = self.motion.position()[2] - before;
            assert!(step.abs() < TURN / 500, "a step of {step} units");
        }
    }

    fn go(&mut self, theta: i64) {
        self.id += 1;
        let from = self.motion.position();
        let to = [from[0], from[1], theta];
        let plan = plan_line(self.id, from, to, &self.constraints).expect("inside");
        self.follow(&plan, plan.ticks());
        assert_eq!(
            (self.motion.position(), self.motion.is_moving()),
            (to, false)
        );
    }

    /// Jogs for a while and stops.
    fn jog(&mut self, deg_s: f64, ticks: u64) {
        let axes = self.motion.position().map(AxisState::at_rest);
        let start = PlanStart::Rest(self.motion.position());
        let jog = plan_jog(
            self.id + 1,
            start,
            &axes,
            &[0.0, 0.0, deg_s],
            &self.constraints,
        );
        let jog = jog.expect("room");
        self.follow(&jog, ticks);
        let state = jog.state_after(&axes, ticks);
        let splice = PlanStart::Splice {
            plan: jog.id,
            tick: ticks,
        };
        self.id += 2;
        let stop = plan_jog(self.id, splice, &state, &[0.0; 3], &self.constraints).expect("a stop");
        self.follow(&stop, stop.ticks());
        assert!(!self.motion.is_moving());
    }

    fn pivots(&self) -> [Angle; 3] {
        let at: Position = self.motion.centre().to_platform(&self.motion.position());
        let pose = Pose {
            x: Fixed::from_position(at[0]).expect("inside"),
            y: Fixed::from_position(at[1]).expect("inside"),
            theta: Angle::from_units(at[2]),
        };
        inverse(&pose).expect("inside").pivots
    }

    fn counts(&self) -> [u32; 3] {
        self.pivots().map(|pivot| pivot.counts(ENCODER_BITS))
    }
}

#[test]
fn ten_thousand_turns_and_back_are_the_same_counts() {
    let mut stage = Stage::new();
    let (start, pivots, counts) = (stage.motion.position()[2], stage.pivots(), stage.counts());
    let mut random = 20_260_214_u64;
    for end in [TURNS, 0, -TURNS, 0] {
        let end = start + end * TURN;
        loop {
            random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            // Up to 256 turns, and a fraction that no encoder could show.
            let step = (random >> 24) as i64 | 1;
            let left = end - stage.motion.position()[2];
            if left.abs() <= step {
                break;
            }
            if random & 7 == 0 && left.abs() > 400 * TURN {
                stage.jog(left.signum() as f64 * 11_000.0, 20_000);
            } else {
                stage.go(stage.motion.position()[2] + left.signum() * step);
            }
        }
        stage.go(end);
        assert_eq!(stage.counts(), counts);
        let turns = Angle::from_units(end - start);
        assert_eq!(stage.pivots(), pivots.map(|pivot| pivot + turns));
    }
}

#[test]
fn at_the_largest_count_of_turns_nothing_steps() {
    let mut stage = Stage::new();
    let counts = stage.counts();
    let start = stage.motion.position();
    let most = 1_000_000_000 * TURN;
    let far = [start[0], start[1], start[2] + most - 2_000 * TURN];
    stage.motion.rest_at(far);
    assert_eq!(stage.counts(), counts);
    // Up to the last turn, with a jog and a line.
    stage.jog(12_000.0, 400_000);
    stage.go(most);
    stage.jog(-11_111.1, 100_000);
    stage.go(far[2]);
    assert_eq!(stage.counts(), counts);
}
