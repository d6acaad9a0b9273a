//! States of a plan against exact kinematics: workspace, limits and pivots, in double precision.

use super::{AXIS_UNIT, CONSTRAINTS, UNIT, corners};
use firmware::motion::plan::axis_state::TickIncrement;
use firmware::motion::{AxisState, Constraints, Plan};
use kinematics::{Acceleration, Pose, Twist, inverse, pivot_motion};
use std::f64::consts::TAU;

/// Whether the integers end a plan at rest by themselves, where it says: what is dropped there is less than a unit of
/// position and a speed under 2 nm/s.
pub fn ends_at_rest(plan: &Plan, end: &[AxisState; 3]) -> bool {
    end.iter().zip(&plan.end).all(|(axis, &place)| {
        let off = axis.position - (i128::from(place) << 40);
        (-(1_i128 << 36)..1 << 41).contains(&off)
            && axis.velocity.unsigned_abs() < 1 << 32
            && axis.acceleration.unsigned_abs() < 1 << 24
    })
}

/// Pose and motion of a platform whose point `centre` is at a place and has these velocities and accelerations: track
/// radii, rad.
pub fn platform(
    [x, y, theta]: [f64; 3],
    v: [f64; 3],
    a: [f64; 3],
    [p, q]: [f64; 2],
) -> (Pose<f64>, Twist<f64>, Acceleration<f64>) {
    let (sin, cos) = theta.sin_cos();
    let arm = [p * cos - q * sin, p * sin + q * cos];
    let pose = Pose {
        x: x - arm[0],
        y: y - arm[1],
        theta,
    };
    let twist = Twist {
        x: v[0] + v[2] * arm[1],
        y: v[1] - v[2] * arm[0],
        theta: v[2],
    };
    let acceleration = Acceleration {
        x: a[0] + a[2] * arm[1] + v[2] * v[2] * arm[0],
        y: a[1] - a[2] * arm[0] + v[2] * v[2] * arm[1],
        theta: a[2],
    };
    (pose, twist, acceleration)
}

/// Largest part of its limit that anything reaches; the disk and the bounds as what is beyond them, track radii or
/// turns.
#[derive(Clone, Copy, Debug, Default)]
pub struct Worst {
    pub speed: f64,
    pub acceleration: f64,
    pub jerk: f64,
    pub pivot_rate: f64,
    pub pivot_acceleration: f64,
    pub outside: f64,
    pub out_of_bounds: f64,
}

impl Worst {
    /// Takes another state.
    pub fn look(&mut self, axes: &[AxisState; 3], constraints: &Constraints) {
        let limits = &constraints.limits;
        let (mm, hz) = (constraints.geometry.radius_mm, limits.rate_hz);
        let rate = |i: usize| axes[i].velocity as f64 / AXIS_UNIT * hz;
        let force = |i: usize| axes[i].acceleration as f64 / AXIS_UNIT * hz * hz;
        let at = [0, 1].map(|i| axes[i].position as f64 / AXIS_UNIT);
        // Whole turns change nothing.
        let theta = (axes[2].position >> 40) as i32 as f64 / UNIT * TAU;
        let (v, a) = (
            [rate(0), rate(1), rate(2) * TAU],
            [force(0), force(1), force(2) * TAU],
        );
        let share = |value: f64, limit: f64, worst: &mut f64| *worst = worst.max(value / limit);
        share(v[0].hypot(v[1]) * mm, limits.speed_mm_s, &mut self.speed);
        share(
            v[2].abs().to_degrees(),
            limits.turn_speed_deg_s,
            &mut self.speed,
        );
        share(
            a[0].hypot(a[1]) * mm,
            limits.acceleration_mm_s2,
            &mut self.acceleration,
        );
        share(
            a[2].abs().to_degrees(),
            limits.turn_acceleration_deg_s2,
            &mut self.acceleration,
        );

        let (pose, twist, acceleration) =
            platform([at[0], at[1], theta], v, a, constraints.rotation_centre);
        self.outside = self
            .outside
            .max(pose.x.hypot(pose.y) - constraints.geometry.usable_radius());
        let guides = inverse(&pose).expect("inside the track").guides;
        let pivots = pivot_motion(&guides, &twist, &acceleration);
        for i in 0..3 {
            share(
                pivots.rates[i].abs(),
                limits.pivot_rate_rad_s,
                &mut self.pivot_rate,
            );
            share(
                pivots.accelerations[i].abs(),
                limits.pivot_acceleration_rad_s2,
                &mut self.pivot_acceleration,
            );
        }
        for (axis, &[low, high]) in axes.iter().zip(&constraints.bounds) {
            let here = axis.rounded();
            let beyond = low.saturating_sub(here).max(here.saturating_sub(high));
            self.out_of_bounds = self.out_of_bounds.max(beyond as f64 / UNIT);
        }
    }

    /// Of one state.
    pub fn of(axes: &[AxisState; 3], constraints: &Constraints) -> Self {
        let mut worst = Self::default();
        worst.look(axes, constraints);
        worst
    }

    fn look_at_jerk(&mut self, jerk: &[i64; 3], constraints: &Constraints) {
        let limits = &constraints.limits;
        let jerk = jerk.map(|jerk| jerk as f64 / AXIS_UNIT * limits.rate_hz.powi(3));
        let path = jerk[0].hypot(jerk[1]) * constraints.geometry.radius_mm / limits.jerk_mm_s3;
        let turn = jerk[2].abs() * 360.0 / limits.turn_jerk_deg_s3;
        self.jerk = self.jerk.max(path).max(turn);
    }

    /// Of a plan within the usual constraints, looked at where its pieces meet and in their middles only.
    pub fn of_corners(plan: &Plan, start: [AxisState; 3]) -> Self {
        let mut worst = Self::default();
        for axes in corners(plan, start) {
            worst.look(&axes, &CONSTRAINTS);
        }
        for piece in &plan.pieces {
            worst.look_at_jerk(&piece.jerk, &CONSTRAINTS);
        }
        worst
    }

    /// Takes every tick of a plan from `start`; the state at its end, as the integers give it.
    pub fn walk(
        &mut self,
        plan: &Plan,
        start: &[AxisState; 3],
        constraints: &Constraints,
    ) -> [AxisState; 3] {
        self.walk_ends(plan, start, constraints, u64::MAX)
    }

    /// The same, of a piece longer than `most` ticks only so many: half of them at its start, half at its end.
    pub fn walk_ends(
        &mut self,
        plan: &Plan,
        start: &[AxisState; 3],
        constraints: &Constraints,
        most: u64,
    ) -> [AxisState; 3] {
        let mut axes = *start;
        self.look(&axes, constraints);
        for piece in &plan.pieces {
            self.look_at_jerk(&piece.jerk, constraints);
            let skipped = piece.ticks.saturating_sub(most);
            for tick in 0..piece.ticks - skipped {
                for (i, axis) in axes.iter_mut().enumerate() {
                    if skipped > 0 && tick == most / 2 {
                        *axis = axis.after(skipped, piece.jerk[i], plan.nudge[i]);
                    }
                    axis.advance(&TickIncrement::new(piece.jerk[i], plan.nudge[i]));
                }
                self.look(&axes, constraints);
            }
        }
        axes
    }

    /// Of a stop, which has no limits but the pivots' and the jerk that an urgent one is granted.
    pub fn of_a_stop(mut self, constraints: &Constraints) -> Self {
        self.speed = 0.0;
        self.acceleration = 0.0;
        self.jerk /= constraints.limits.stop_factor.powi(2);
        self
    }

    /// Of a plan that was left with `before`: what an urgent stop has left over a limit can only be left.
    pub fn left_with(mut self, before: &Self, constraints: &Constraints) -> Self {
        let within = |share: f64, before: f64| if share <= before { 0.0 } else { share };
        self.speed = within(self.speed, before.speed);
        self.acceleration = within(self.acceleration, before.acceleration);
        // Out of an urgent stop with its jerk: with the ordinary one the stage would be pushed back.
        if before.acceleration > 1.0 + 1e-4 {
            self.jerk /= constraints.limits.stop_factor.powi(2);
        }
        self
    }

    /// Parts of the limits: speed, acceleration, jerk, the pivots' rate and acceleration.
    pub fn shares(&self) -> [f64; 5] {
        [
            self.speed,
            self.acceleration,
            self.jerk,
            self.pivot_rate,
            self.pivot_acceleration,
        ]
    }

    /// Whether everything is kept, to within roundings.
    pub fn is_kept(&self) -> bool {
        const SLACK: f64 = 1.0 + 1e-6;
        self.shares().iter().all(|&share| share <= SLACK)
            && self.outside <= 1e-8
            && self.out_of_bounds == 0.0
    }

    /// Whether everything is kept as plans in motion have to: speed, acceleration and jerk to 1e-4, pivots to 1e-3, the
    /// disk to 0.1 um.
    pub fn is_kept_but_for_a_thousandth(&self) -> bool {
        const OWN: f64 = 1.0 + 2e-4;
        const PIVOTS: f64 = 1.0 + 1e-3;
        [self.speed, self.acceleration, self.jerk]
            .iter()
            .all(|&share| share <= OWN)
            && self.pivot_rate.max(self.pivot_acceleration) <= PIVOTS
            && self.is_inside()
    }

    /// Whether disk and bounds are kept, the disk to 0.1 um on the reference stage, the bounds to 0.05 um.
    pub fn is_inside(&self) -> bool {
        self.outside <= 1e-6 && self.out_of_bounds <= 5e-7
    }

    /// Whether everything but the jerk is kept, to a thousandth: what streamed targets are granted.
    pub fn is_kept_but_for_jerk(&self) -> bool {
        const SLACK: f64 = 1.0 + 2e-3;
        let shares = [
            self.speed,
            self.acceleration,
            self.pivot_rate,
            self.pivot_acceleration,
        ];
        shares.iter().all(|&share| share <= SLACK)
            && self.outside <= 1e-6
            && self.out_of_bounds == 0.0
    }

    /// The worse of both, thing by thing.
    pub fn max(self, other: Self) -> Self {
        Self {
            speed: self.speed.max(other.speed),
            acceleration: self.acceleration.max(other.acceleration),
            jerk: self.jerk.max(other.jerk),
            pivot_rate: self.pivot_rate.max(other.pivot_rate),
            pivot_acceleration: self.pivot_acceleration.max(other.pivot_acceleration),
            outside: self.outside.max(other.outside),
            out_of_bounds: self.out_of_bounds.max(other.out_of_bounds),
        }
    }
}
