//! Whether a plan keeps to the workspace and to the limits that couple the axes, at every tick.
//!
//! A plan is looked at in stretches. Between the two ends of one, a quantity rises above the greater of its ends by no more
//! than an eighth of the square of the duration times its second derivative: for position that is the acceleration, for
//! velocity the jerk (acceleration is greatest at an end). The pivots' rates and accelerations are first bounded for any
//! orientation; where that is not enough they are computed at both ends, and rise by what the products of velocity,
//! acceleration and jerk can make of them in between. A stretch that fails is taken in shorter ones.
//!
//! | checked | for |
//! |---|---|
//! | speed, acceleration, jerk | translation along the path and rotation; not of a stop, which has its own |
//! | rate and acceleration of each pivot | the platform's motion about the centre of rotation |
//! | disk | the platform's centre, and where a stop from here would end |
//! | bounds | x, y and theta of the moved point, and where a stop from here would end |

pub(crate) mod instant;
pub(crate) mod line_in_disk;
pub(crate) mod magnitudes;
pub(crate) mod pivot_bounds;
pub(crate) mod platform;
pub(crate) mod sample;
pub(crate) mod target;
pub(crate) mod workspace;

#[cfg(test)]
mod tests;

use super::brake::Brake;
use super::constraints::Constraints;
use super::plan::axis_state::AxisState;
use super::plan::units::TickLimits;
use super::plan::{MAX_PIECES, Piece};
use crate::motion::check::magnitudes::Sizes;
use crate::motion::check::pivot_bounds::Bound;
use crate::motion::check::platform::greatest;
use crate::motion::check::sample::{Arc, Sample};
use crate::motion::check::workspace::{Braking, Reach};
use crate::number::float::{FloatMinMax, hypot, ticks_to_f32, truncate};
use crate::number::sqrt_f32;
use heapless::Vec;

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
    /// With which a stop brakes, and the same for a bound of its way.
    stop: TickLimits,
    braking: Braking,
}

/// What a plan breaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Broken {
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
    /// Disk or bounds, in a stop from an instant on the way.
    NoStop,
    /// Nothing yet: not all has been looked at.
    Unseen,
}

impl Broken {
    fn is_of_pivots(&self) -> bool {
        matches!(self, Self::Rate(_) | Self::Acceleration(_))
    }

    /// This, or what was seen of the same before, when that was worse.
    fn or_worse(self, before: Option<Self>) -> Self {
        match (self, before) {
            (Self::Speed(now), Some(Self::Speed(over))) => Self::Speed(now.fmax(over)),
            (Self::Force(now), Some(Self::Force(over))) => Self::Force(now.fmax(over)),
            (Self::Rate(now), Some(Self::Rate(over))) => Self::Rate(now.fmax(over)),
            (Self::Acceleration(now), Some(Self::Acceleration(over))) => {
                Self::Acceleration(now.fmax(over))
            }
            _ => self,
        }
    }
}

/// Slack of single precision.
const SLACK: f32 = 1.0 + 1e-4;
/// Stretches that may be looked at, failed ones included, before the next failure counts.
const MOST_LOOKS: usize = 60;
/// Stretches in the first slice.
const SLICE: usize = 16;
/// What has to have been seen, ticks, for the rest to be left for later.
pub(super) const LEAST_SEEN: u64 = 100;
/// Pieces up to this many ticks have no middle to glance at.
const SHORT: u64 = 200;
/// A stretch is not cut shorter than this many ticks: what happens in 0.2 ms is less than the slack.
const SHORTEST: u64 = 4;

impl Envelope {
    /// The envelope of an ordinary motion, or of the state at the start where that lies outside: it may have been planned
    /// with other limits, and can only be left.
    pub fn new(ground: &Constraints, stop: TickLimits, start: &[AxisState; 3]) -> Self {
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
                limit[0].fmax(hypot(now[0], now[1])),
                limit[1].fmax(now[2].abs()),
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
            braking: Braking::new(&stop, hz),
        };
        Self {
            own: Some(own),
            ..Self::of_stop(ground)
        }
    }

    /// The envelope of a stop: pivots, disk and bounds.
    pub fn of_stop(ground: &Constraints) -> Self {
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

    /// Writes pieces as they are looked at, from `start`; where they lead to. A plan's nudge does not show in them.
    pub fn legs(
        &self,
        pieces: &[Piece],
        start: &[AxisState; 3],
        legs: &mut Legs,
    ) -> [AxisState; 3] {
        let mut axes = *start;
        legs.clear();
        for piece in pieces {
            let arc = Arc::new(&axes, piece, self.hz);
            // Room for all pieces of a plan.
            let _ = legs.push(Leg {
                jerk: [hypot(arc.jerk[0], arc.jerk[1]), arc.jerk[2].abs()],
                arc,
                rooms: self.reach.rooms(&axes),
                ticks: piece.ticks,
            });
            piece.advance(&mut axes, piece.ticks, &[0; 3]);
        }
        axes
    }

    /// Whether these stay inside, from what `looks` have seen of them before.
    pub fn check(&self, legs: &[Leg], looks: &mut Looks) -> Result<(), Broken> {
        let (mut worst, mut glanced) = (None, false);
        let mut before = looks.seen;
        for leg in legs {
            if before >= leg.ticks {
                before -= leg.ticks;
                continue;
            }
            self.check_jerk(leg)?;
            let (mut done, mut ticks) = (core::mem::take(&mut before), leg.ticks);
            let [mut first, mut second] = [Look::default(); 2];
            let (mut from, mut to) = (&mut first, &mut second);
            self.look(&leg.arc, done, from);
            while done < leg.ticks {
                ticks = ticks.min(leg.ticks - done);
                looks.take()?;
                self.look(&leg.arc, done + ticks, to);
                match self.stretch(leg, [from, to], ticks_to_f32(ticks) / self.hz) {
                    Ok(longer) => {
                        core::mem::swap(&mut from, &mut to);
                        done += ticks;
                        looks.seen += ticks;
                        ticks = truncate(ticks_to_f32(ticks) * longer) as u64;
                    }
                    // In shorter stretches the same instant would be met.
                    Err((Broken::NoStop, _)) => return Err(Broken::Reach),
                    Err((broken, shorter)) => {
                        if broken.is_of_pivots() && !glanced {
                            looks.leave_for_later()?;
                            // Where a limit is passed indeed, a glance tells by how much.
                            self.glance(legs)?;
                            glanced = true;
                        }
                        // Stretches close in on where a limit is met; how far it is passed was seen before.
                        worst = Some(broken.or_worse(worst));
                        if ticks <= SHORTEST || looks.left == 0 {
                            return worst.map_or(Ok(()), Err);
                        }
                        ticks = truncate(ticks_to_f32(ticks) * shorter) as u64;
                    }
                }
                ticks = ticks.max(SHORTEST);
            }
        }
        Ok(())
    }

    fn look(&self, arc: &Arc, ticks: u64, look: &mut Look) {
        let sample = arc.at(ticks_to_f32(ticks) / self.hz);
        let [x, y] = arc.place(&sample);
        let far = hypot(x, y);
        let Sample { v, a, .. } = sample;
        *look = Look {
            far,
            out: if self.reach.arm > 0.0 {
                self.reach.distance(arc, &sample)
            } else {
                far
            },
            v: [hypot(v[0], v[1]), v[2].abs()],
            a: [hypot(a[0], a[1]), a[2].abs()],
            sample,
            pivots: None,
        };
    }

    /// What the pivots do at the ends and in the middle of the pieces; in short ones the ends tell enough.
    fn glance(&self, legs: &[Leg]) -> Result<(), Broken> {
        let [mut rate, mut acceleration] = [0.0_f32; 2];
        for Leg { arc, ticks, .. } in legs {
            let seconds = ticks_to_f32(*ticks) / self.hz;
            let spots = [seconds, seconds / 2.0];
            for &t in &spots[..1 + usize::from(*ticks > SHORT)] {
                let [rates, accelerations] = arc.platform(&arc.at(t), self.reach.centre).pivots();
                rate = rate.fmax(greatest(&rates));
                acceleration = acceleration.fmax(greatest(&accelerations));
            }
        }
        let [rate_limit, acceleration_limit] = self.pivots;
        within(acceleration / acceleration_limit, Broken::Acceleration)?;
        within(rate / rate_limit, Broken::Rate)
    }

    fn check_jerk(&self, leg: &Leg) -> Result<(), Broken> {
        let Some(own) = &self.own else { return Ok(()) };
        let [way, turn] = leg.jerk;
        within((way / own.jerk[0]).fmax(turn / own.jerk[1]), Broken::Force)
    }

    /// By how much the next stretch may be longer than this; or what is broken, and by how much shorter a stretch to try.
    fn stretch(&self, leg: &Leg, [from, to]: [&mut Look; 2], t: f32) -> Result<f32, (Broken, f32)> {
        const HALF: f32 = 0.5;
        let sizes = Sizes::new(leg.jerk, from, to, t);
        let moving = sizes.at_arm(self.reach.arm);
        let radius = self
            .path(leg, [from, to], t, [&sizes, &moving])
            .map_err(|broken| (broken, HALF))?;
        self.check_pivots(&leg.arc, [from, to], t, &moving, radius)
    }

    /// All but the pivots; the greatest distance of the platform's centre from the track's.
    fn path(
        &self,
        leg: &Leg,
        [from, to]: [&Look; 2],
        t: f32,
        [sizes, moving]: [&Sizes; 2],
    ) -> Result<f32, Broken> {
        if let Some(own) = &self.own {
            let [v, turn] = sizes.v;
            within((v / own.speed[0]).fmax(turn / own.speed[1]), Broken::Speed)?;
            let [a, spin] = sizes.a;
            within(
                (a / own.acceleration[0]).fmax(spin / own.acceleration[1]),
                Broken::Force,
            )?;
        }
        let eighth = t * t / 8.0;
        let rise = sizes.a.map(|a| a * eighth);
        (self.reach).check_way(&leg.rooms, &from.sample, &to.sample, rise)?;
        let furthest = from.out.fmax(to.out) + moving.a[0] * eighth;
        let radius = self.reach.inside(furthest)?;
        if let Some(own) = &self.own {
            self.check_stop(leg, to, own)?;
        }
        Ok(radius)
    }

    /// A stop from here.
    fn check_stop(&self, leg: &Leg, at: &Look, own: &Own) -> Result<(), Broken> {
        if self.reach.far_inside(&leg.rooms, at, &own.braking) {
            return Ok(());
        }
        let brake = Brake::in_seconds(&at.sample, &own.stop, self.hz);
        (self.reach)
            .check_stop(&leg.arc, &leg.rooms, &at.sample, &brake, self.hz)
            .map_err(|_| Broken::NoStop)
    }

    fn check_pivots(
        &self,
        arc: &Arc,
        ends: [&mut Look; 2],
        t: f32,
        moving: &Sizes,
        radius: f32,
    ) -> Result<f32, (Broken, f32)> {
        const ALL: f32 = 4.0;
        const ROUNDS: usize = 3;
        let bound = Bound::new(radius);
        let [rate, acceleration] = moving.pivots(&bound);
        let [rate_limit, acceleration_limit] = self.pivots;
        if rate <= rate_limit && acceleration <= acceleration_limit {
            return Ok(ALL);
        }
        let [mut rates, mut accelerations] = [0.0_f32; 2];
        for end in ends {
            let [rate, acceleration] = end.pivots(arc, self.reach.centre);
            rates = rates.fmax(rate);
            accelerations = accelerations.fmax(acceleration);
        }
        // The bounds hold for any orientation; what is sure of this one bounds its own rise in turn.
        let mut most = [rate, acceleration];
        for _ in 0..ROUNDS {
            let rises = moving.rises(most, &bound, t);
            most = [
                most[0].fmin(rates + rises[0]),
                most[1].fmin(accelerations + rises[1]),
            ];
        }
        let once = rise_within(rates, most[0], rate_limit, Broken::Rate)?;
        let twice = rise_within(
            accelerations,
            most[1],
            acceleration_limit,
            Broken::Acceleration,
        )?;
        Ok(once.fmin(twice).fmin(ALL))
    }
}

/// How a motion is looked at.
pub(super) struct Looks {
    left: usize,
    /// Stretches until the rest is left for later.
    slice: usize,
    /// Ticks from the start on that have been found inside.
    pub seen: u64,
}

impl Looks {
    /// At all of it, at once.
    pub const ALL: Self = Self {
        left: MOST_LOOKS,
        slice: usize::MAX,
        seen: 0,
    };

    /// At the start of it.
    pub const SLICE: Self = Self {
        slice: SLICE,
        ..Self::ALL
    };

    /// At the rest of it.
    pub const fn after(seen: u64) -> Self {
        Self { seen, ..Self::ALL }
    }

    fn take(&mut self) -> Result<(), Broken> {
        if self.slice == 0 {
            return Err(Broken::Unseen);
        }
        self.slice = self.slice.saturating_sub(1);
        self.left = self.left.saturating_sub(1);
        Ok(())
    }

    fn leave_for_later(&self) -> Result<(), Broken> {
        if self.slice <= SLICE && self.seen >= LEAST_SEEN {
            Err(Broken::Unseen)
        } else {
            Ok(())
        }
    }
}

/// A piece as it is looked at.
pub(super) struct Leg {
    arc: Arc,
    /// Of translation and of rotation.
    jerk: [f32; 2],
    /// How far each axis may go from its start.
    rooms: [[f32; 2]; 3],
    ticks: u64,
}

/// The pieces of a plan.
pub(super) type Legs = Vec<Leg, MAX_PIECES>;

/// One end of a stretch.
#[derive(Clone, Copy, Default)]
pub(super) struct Look {
    pub sample: Sample,
    /// Velocity of translation and of rotation.
    pub v: [f32; 2],
    /// Their acceleration.
    pub a: [f32; 2],
    /// Distance of the moved point from the track's centre.
    pub far: f32,
    /// Distance of the platform's centre from it.
    out: f32,
    /// The greatest rate and acceleration of a pivot, once they have been asked for.
    pivots: Option<[f32; 2]>,
}

impl Look {
    fn pivots(&mut self, arc: &Arc, centre: [f32; 2]) -> [f32; 2] {
        *self.pivots.get_or_insert_with(|| {
            let pivots = arc.platform(&self.sample, centre).pivots();
            pivots.map(|three| greatest(&three))
        })
    }
}

/// The same for a value at the ends of a stretch that may rise in between; what is told is what is sure. A rise goes with the
/// square of the time: how much longer a stretch may be than this one, or how much shorter it has to be.
fn rise_within(
    value: f32,
    most: f32,
    limit: f32,
    broken: fn(f32) -> Broken,
) -> Result<f32, (Broken, f32)> {
    /// What is used of that, because the value changes too.
    const PART: f32 = 0.75;
    let room = limit * SLACK - value;
    let rise = most - value;
    if rise <= room {
        return Ok(PART * sqrt_f32(room / rise.fmax(f32::MIN_POSITIVE)));
    }
    let shorter = PART * sqrt_f32(room.fmax(0.0) / rise);
    Err((
        broken((value / limit).fmax(1.0)),
        shorter.clamp(1.0 / 16.0, 0.7),
    ))
}

/// The part of a limit that is used is not over one.
fn within(part: f32, broken: fn(f32) -> Broken) -> Result<(), Broken> {
    if part <= SLACK {
        Ok(())
    } else {
        Err(broken(part))
    }
}
