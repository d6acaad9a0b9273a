//! Random positions and motions of the reference stage.

use crate::random::Random;
use core::hint::black_box;
use firmware::motion::{
    AxisState, Constraints, Effort, Plan, PlanStart, Position, RetargetError, Stop, plan_line,
    plan_retarget, plan_stop,
};
use firmware::number::Fixed;
use firmware::parameters::Parameters;
use kinematics::{Acceleration, Angle, Geometry, Pose, Twist};

static GROUND: Constraints = Constraints::new(Parameters::REFERENCE.limits, Geometry::REFERENCE);

/// What plans keep to: settings, as far as the compiler knows. With constants it would make other code of the planners.
pub fn ground() -> &'static Constraints {
    black_box(&GROUND)
}

const UNIT: f64 = 4_294_967_296.0;
/// A distance to the usable disk's rim, so that rounding does not leave it.
const INSIDE: f64 = 0.9999;
/// Turns to either side, for most positions and for one in sixteen.
const TURNS: f64 = 2.0;
const MANY_TURNS: f64 = 10_000.0;

/// Anywhere in the usable disk.
pub fn position(random: &mut Random) -> Position {
    let most = ground().geometry.usable_radius() * INSIDE;
    let (sin, cos) = libm::sincos(random.within(0.0, core::f64::consts::TAU));
    // The root makes the disk evenly full; a draw in four lies on the rim.
    let radius = if random.once_in(4) {
        most
    } else {
        most * libm::sqrt(random.within(0.0, 1.0))
    };
    let turns = if random.once_in(16) {
        MANY_TURNS
    } else {
        TURNS
    };
    let turns = random.within(-turns, turns);
    [radius * cos, radius * sin, turns].map(|value| (value * UNIT) as i64)
}

/// A way of any size, from units to the whole disk; one in four leaves theta alone.
pub fn way(random: &mut Random) -> (Position, Position) {
    let (from, mut to) = (position(random), position(random));
    if !random.once_in(3) {
        let share = libm::exp2(random.within(-24.0, 0.0));
        for (to, from) in to.iter_mut().zip(from) {
            *to = from + ((*to - from) as f64 * share) as i64;
        }
    }
    if random.once_in(4) {
        to[2] = from[2];
    }
    (from, to)
}

/// A pose of the stage and how it moves.
pub type Moved = (Pose<Fixed>, Twist<f32>, Acceleration<f32>);

/// Anywhere, in motion within the limits.
pub fn moved(random: &mut Random) -> Moved {
    let limits = &ground().limits;
    let mm = ground().geometry.radius_mm;
    let mut rate = |most: f64| random.within(-most, most) as f32;
    let speed = limits.speed_mm_s / mm;
    let turning = limits.turn_speed_deg_s.to_radians();
    let twist = Twist {
        x: rate(speed),
        y: rate(speed),
        theta: rate(turning),
    };
    let force = limits.acceleration_mm_s2 / mm;
    let turning = limits.turn_acceleration_deg_s2.to_radians();
    let acceleration = Acceleration {
        x: rate(force),
        y: rate(force),
        theta: rate(turning),
    };
    (pose(random), twist, acceleration)
}

/// A pose in the usable disk.
pub fn pose(random: &mut Random) -> Pose<Fixed> {
    let [x, y, theta] = position(random);
    // Every position is inside the range of the numbers.
    let [x, y] = [x, y].map(|units| Fixed::from_position(units).unwrap_or_default());
    Pose {
        x,
        y,
        theta: Angle::from_units(theta),
    }
}

/// A plan under way.
pub struct Moving {
    /// The plan.
    pub plan: Plan,
    /// The axes at its start.
    pub start: [AxisState; 3],
    /// Tick at which it is left.
    pub at: u64,
}

impl Moving {
    /// Somewhere on a straight line, or, one time in two, on a way that was taken from one.
    pub fn new(random: &mut Random) -> Self {
        let line = Self::on_a_line(random);
        if random.once_in(2) {
            return line;
        }
        let to = position(random);
        match plan_retarget(
            2,
            &line.plan,
            &line.start,
            line.at,
            to,
            ground(),
            Effort::ALL,
        ) {
            Ok(plan) => Self {
                start: line.state(),
                at: random.up_to(plan.ticks() - 1),
                plan,
            },
            Err(_) => line,
        }
    }

    /// To a new target.
    ///
    /// # Errors
    /// As those of [`plan_retarget`].
    pub fn retargeted(&self, to: Position, effort: Effort) -> Result<Plan, RetargetError> {
        plan_retarget(3, &self.plan, &self.start, self.at, to, ground(), effort)
    }

    /// To a stop.
    pub fn stopped(&self, stop: Stop) -> Option<Plan> {
        plan_stop(3, &self.plan, &self.start, self.at, ground(), stop)
    }

    /// The axes where it is left.
    pub fn state(&self) -> [AxisState; 3] {
        self.plan.state_after(&self.start, self.at)
    }

    /// The plan as if it began at rest, and where: following it takes the same.
    pub fn begun_at_rest(self) -> (Plan, Position) {
        let from = self.start.map(|axis| axis.rounded());
        let start = PlanStart::Rest(from);
        (Plan { start, ..self.plan }, from)
    }

    fn on_a_line(random: &mut Random) -> Self {
        loop {
            let (from, to) = way(random);
            match plan_line(1, from, to, ground()) {
                Ok(plan) if plan.ticks() > 1 => {
                    return Self {
                        start: from.map(AxisState::at_rest),
                        at: random.up_to(plan.ticks() - 1),
                        plan,
                    };
                }
                _ => {}
            }
        }
    }
}
