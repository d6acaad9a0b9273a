//! Whether a plan keeps to the workspace and to the limits that couple the axes, at every tick.
//!
//! A plan is looked at in stretches. Between the two ends of one, a quantity rises above the greater of its ends by no more
//! than an eighth of the square of the duration times its second derivative: for position that is the acceleration, for
//! velocity the jerk (acceleration is greatest at an end). The pivots' rates and accelerations are first bounded for any
//! orientation; where that is not enough they are computed at both ends, and rise by what the products of velocity,
//! acceleration and jerk can make of them in between. A stretch that fails is halved, a few times.
//!
//! | checked | for |
//! |---|---|
//! | speed, acceleration, jerk | translation along the path and rotation; not of a stop, which has its own |
//! | rate and acceleration of each pivot | the platform's motion about the centre of rotation |
//! | disk | the platform's centre, and where a stop from here would end |
//! | bounds | x, y and theta of the moved point, and where a stop from here would end |

use super::axis::Axis;
use super::brake::Brake;
use super::float::{float, hypot};
use super::ground::Ground;
use super::plan::{Piece, Plan};
use super::platform::greatest;
use super::reach::Reach;
use super::sample::{Arc, Sample};
use super::sizes::Sizes;
use super::swing::Bound;
use super::units::UnitLimits;

/// What a plan is held against.
pub(super) struct Envelope {
    /// Of translation, track radii per second (squared, cubed), and of rotation, rad; none for a stop.
    own: Option<Own>,
    /// Rate and acceleration, rad/s and rad/s^2.
    pivots: [f32; 2],
    reach: Reach,
    hz: f32,
}

/// Limits of translation and rotation.
struct Own {
    speed: [f32; 2],
    acceleration: [f32; 2],
    jerk: [f32; 2],
    /// With which a stop brakes.
    stop: UnitLimits,
}

/// What a plan breaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Broken {
    /// Disk or bounds, on the way or in a stop.
    Reach,
    /// Speed, by this factor.
    Speed(f32),
    /// Acceleration or jerk, by this factor.
    Force(f32),
    /// The pivots' rate, by this factor.
    Rate(f32),
    /// The pivots' acceleration, by this factor.
    Acceleration(f32),
}

impl Broken {
    /// This, or what was seen of the same before, when that was worse.
    fn or_worse(self, before: Option<Self>) -> Self {
        match (self, before) {
            (Self::Speed(now), Some(Self::Speed(over))) => Self::Speed(now.max(over)),
            (Self::Force(now), Some(Self::Force(over))) => Self::Force(now.max(over)),
            (Self::Rate(now), Some(Self::Rate(over))) => Self::Rate(now.max(over)),
            (Self::Acceleration(now), Some(Self::Acceleration(over))) => {
                Self::Acceleration(now.max(over))
            }
            _ => self,
        }
    }
}

/// Slack of single precision.
const SLACK: f32 = 1.0 + 1e-4;
/// Stretches that may be looked at, failed ones included.
const MOST_STRETCHES: usize = 160;
/// A stretch is not cut shorter than this many ticks: what happens in 0.2 ms is less than the slack.
const SHORTEST: u64 = 4;

impl Envelope {
    /// The envelope of an ordinary motion, or of the state at the start where that lies outside: it may have been planned
    /// with other limits, and can only be left.
    pub fn new(ground: &Ground, stop: UnitLimits, start: &[Axis; 3]) -> Self {
        let limits = &ground.limits;
        let mm = ground.geometry.radius_mm as f32;
        let pair = |translation: f64, rotation_deg: f64| {
            [
                translation as f32 / mm,
                rotation_deg as f32 * (core::f32::consts::PI / 180.0),
            ]
        };
        let hz = limits.rate_hz as f32;
        let Sample { v, a, .. } = Arc::new(start, &Piece::default(), hz).start;
        let wider = |limit: [f32; 2], now: [f32; 3]| {
            [
                limit[0].max(hypot(now[0], now[1])),
                limit[1].max(now[2].abs()),
            ]
        };
        let own = Own {
            speed: wider(pair(limits.speed_mm_s, limits.turn_speed_deg_s), v),
            acceleration: wider(
                pair(limits.acceleration_mm_s2, limits.turn_acceleration_deg_s2),
                a,
            ),
            jerk: pair(limits.jerk_mm_s3, limits.turn_jerk_deg_s3),
            stop,
        };
        Self {
            own: Some(own),
            ..Self::of_stop(ground)
        }
    }

    /// The envelope of a stop: pivots, disk and bounds.
    pub fn of_stop(ground: &Ground) -> Self {
        let limits = &ground.limits;
        Self {
            own: None,
            pivots: [
                limits.pivot_rate_rad_s as f32,
                limits.pivot_acceleration_rad_s2 as f32,
            ],
            reach: Reach::new(ground),
            hz: limits.rate_hz as f32,
        }
    }

    /// Whether `plan`, from `start`, stays inside.
    pub fn check(&self, plan: &Plan, start: &[Axis; 3]) -> Result<(), Broken> {
        let mut axes = *start;
        let (mut looked, mut worst) = (0, None);
        for piece in &plan.pieces {
            let arc = Arc::new(&axes, piece, self.hz);
            let rooms = self.reach.rooms(&axes);
            self.check_jerk(&arc)?;
            let (mut done, mut ticks) = (0, piece.ticks);
            let mut from = arc.start;
            while done < piece.ticks {
                ticks = ticks.min(piece.ticks - done);
                let to = arc.at(float(done + ticks) / self.hz);
                looked += 1;
                match self.stretch(&arc, &rooms, [&from, &to], float(ticks) / self.hz) {
                    Ok(()) => {
                        from = to;
                        done += ticks;
                        ticks *= 2;
                    }
                    Err(broken) => {
                        // Stretches close in on where a limit is met; how far it is passed was seen before.
                        worst = Some(broken.or_worse(worst));
                        if ticks <= SHORTEST || looked > MOST_STRETCHES {
                            return worst.map_or(Ok(()), Err);
                        }
                        ticks = ticks.div_ceil(2);
                    }
                }
            }
            axes = [0, 1, 2].map(|i| axes[i].after(piece.ticks, piece.jerk[i], plan.nudge[i]));
        }
        Ok(())
    }

    fn check_jerk(&self, arc: &Arc) -> Result<(), Broken> {
        let Some(own) = &self.own else { return Ok(()) };
        let [x, y, theta] = arc.jerk;
        within(
            (hypot(x, y) / own.jerk[0]).max(theta.abs() / own.jerk[1]),
            Broken::Force,
        )
    }

    fn stretch(
        &self,
        arc: &Arc,
        rooms: &[[f32; 2]; 3],
        [from, to]: [&Sample; 2],
        t: f32,
    ) -> Result<(), Broken> {
        let sizes = Sizes::new(arc, from, to, t);
        if let Some(own) = &self.own {
            let [v, turn] = sizes.v;
            within((v / own.speed[0]).max(turn / own.speed[1]), Broken::Speed)?;
            let [a, spin] = sizes.a;
            within(
                (a / own.acceleration[0]).max(spin / own.acceleration[1]),
                Broken::Force,
            )?;
        }
        let rise = [sizes.a[0] * t * t / 8.0, sizes.a[1] * t * t / 8.0];
        self.reach.check_way(rooms, from, to, rise)?;
        let radius = self.reach.radius(arc, from, to, &sizes, t)?;
        if let Some(own) = &self.own {
            self.check_stop(arc, rooms, to, &own.stop)?;
        }
        self.check_pivots(arc, [from, to], t, &sizes, radius)
    }

    /// A stop from here.
    fn check_stop(
        &self,
        arc: &Arc,
        rooms: &[[f32; 2]; 3],
        at: &Sample,
        limits: &UnitLimits,
    ) -> Result<(), Broken> {
        if self.reach.far_inside(arc, rooms, at, limits, self.hz) {
            return Ok(());
        }
        let brake = Brake::in_seconds(at, limits, self.hz);
        self.reach.check_stop(arc, rooms, at, &brake, self.hz)
    }

    fn check_pivots(
        &self,
        arc: &Arc,
        ends: [&Sample; 2],
        t: f32,
        sizes: &Sizes,
        radius: f32,
    ) -> Result<(), Broken> {
        let bound = Bound::new(radius);
        let moving = sizes.at_arm(self.reach.arm);
        let [rate, acceleration] = moving.pivots(&bound);
        let [rate_limit, acceleration_limit] = self.pivots;
        if rate <= rate_limit && acceleration <= acceleration_limit {
            return Ok(());
        }
        let [mut rates, mut accelerations] = [0.0_f32; 2];
        for end in ends {
            let [rate, acceleration] = arc.platform(end, self.reach.centre).pivots();
            rates = rates.max(greatest(&rate));
            accelerations = accelerations.max(greatest(&acceleration));
        }
        let rises = moving.rises(rate, acceleration, &bound, t);
        rise_within(rates, rises[0], rate_limit, Broken::Rate)?;
        rise_within(
            accelerations,
            rises[1],
            acceleration_limit,
            Broken::Acceleration,
        )
    }
}

/// The same for a value at the ends of a stretch that may rise in between; what is told is what is sure.
fn rise_within(value: f32, rise: f32, limit: f32, broken: fn(f32) -> Broken) -> Result<(), Broken> {
    if value + rise <= limit * SLACK {
        Ok(())
    } else {
        Err(broken((value / limit).max(1.0)))
    }
}

/// The part of a limit that is used is not over one.
fn within(part: f32, broken: fn(f32) -> Broken) -> Result<(), Broken> {
    if part <= SLACK {
        Ok(())
    } else {
        Err(broken(part))
    }
}
