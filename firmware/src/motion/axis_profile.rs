//! The fastest jerk-limited motion of one axis from any velocity and acceleration over a given distance to rest.
//!
//! ```text
//! a   A|     ______                         The state is first braken into the limits, should it lie outside (segments 1
//!      |    /      \                        and 2 below). Then the fastest stop from it, over the distance d_stop, divides
//!   a0 |---/        \                       all targets in two: one short of it is the mirror image of one beyond. For a
//!     0|-------------\________              target beyond, d > d_stop, the distance grows with one number, and that is
//!      |                      \       /     solved for:
//!   -A |                       \_____/
//!       3  4   5         6    7   8   9     A  the highest acceleration a1 < 0, when the brake is only released in part
//!                                           B  the highest speed, when it is reached for an instant
//! v    |       _______________              C  the duration of segment 6 at the highest speed allowed
//!      | __---                -__
//!      |                         -_         In A there is no 4, 5 and 6, and 7 sets out from a1.
//! ```
//!
//! All is scaled to a jerk of 1. Reaching speed `v1` at zero acceleration from speed `v`, acceleration `a`, is a part of the
//! same motion from zero acceleration, begun a time `a` earlier at `v_s = v - a^2 / 2`, a distance `p_s = -a (v - a^2 / 3)`
//! away. With `T(u) = 2 sqrt(u)` for `u <= A^2`, else `u / A + A`, the time in which speed changes by `u`, it takes
//! `T(v1 - v_s) - a` over `p_s + (v_s + v1) / 2 T(v1 - v_s)`. It begins with positive jerk as long as `v1 >= v_z = v + a |a| / 2`,
//! the speed to which releasing the acceleration at once leads; otherwise its mirror image holds.
//!
//! - B: `d(v1) = p_s + (v_s + v1) / 2 T(v1 - v_s) + v1 / 2 T(v1)`, for `v1 >= max(v_z, 0)`. Over `s = sqrt(v1 - v_s)` it grows
//!   and is convex: Newton's method from above converges from any start.
//! - A: only from `a < 0`, `v_z > 0`. With `q = -a1` and `w = v_z + q^2`, the brake being virtually begun from speed `w`,
//!   `d(q) = -a (v_z + a^2 / 6) + w / 2 T(w) - q (2 v_z + q^2)`, falling from B's least at 0 to `d_stop` at `-a`.
//!
//! A longer duration is had by a lower speed in segment 6. Where there is none (near full braking the distance left is too
//! short for an even lower speed) the axis arrives early and waits: its target is at rest, so no other axis ever has to wait
//! for it, and the shortest duration of several axes is that of the slowest.
//!
//! Accepted are all finite states and distances and all finite positive limits; see [`Unusable`]. A start over a limit comes
//! below it at full jerk and, over the speed limit, full acceleration, and meets the speed limit with zero acceleration.

/// Limits of one axis, the same both ways, in any consistent units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisLimits {
    /// Speed.
    pub velocity: f64,
    /// Acceleration.
    pub acceleration: f64,
    /// Jerk.
    pub jerk: f64,
}

/// What an axis is to do, in the units of its limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    /// Way to the target, where it is to be at rest.
    pub distance: f64,
    /// Velocity now.
    pub velocity: f64,
    /// Acceleration now.
    pub acceleration: f64,
}

/// Why there is no profile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unusable {
    /// A limit is not a finite positive number.
    Limits,
    /// The state or the distance is not finite, or so large that the duration is not.
    Task,
}

/// Segments of a profile, some of no duration.
pub const SEGMENTS: usize = 9;

/// A profile: nine segments of constant jerk, of which the first two only bring a start over a limit below it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisProfile {
    /// Durations of the segments.
    pub durations: [f64; SEGMENTS],
    /// Their jerks: plus or minus the limit, or zero.
    pub jerks: [f64; SEGMENTS],
    /// Whether the brake is only released in part: segment 7 then sets out from another acceleration than zero.
    pub released_in_part: bool,
}

impl AxisProfile {
    /// The fastest profile.
    pub fn fastest(task: &Task, limits: &AxisLimits) -> Result<Self, Unusable> {
        let (start, scaled) = Start::new(task, limits)?;
        let main = start.fastest(&scaled);
        start.profile(&main, limits.jerk)
    }

    /// The profile that arrives after `duration`, or the fastest where there is none. It never arrives later, unless the
    /// fastest does.
    pub fn lasting(task: &Task, limits: &AxisLimits, duration: f64) -> Result<Self, Unusable> {
        let (start, scaled) = Start::new(task, limits)?;
        let fastest = start.fastest(&scaled);
        let main = start
            .slower(&fastest, duration - start.braked(), &scaled)
            .unwrap_or(fastest);
        start.profile(&main, limits.jerk)
    }

    /// Whole duration.
    pub fn duration(&self) -> f64 {
        self.durations.iter().sum()
    }
}

/// The signed distance of the fastest stop from a state within the limits of acceleration; that of `task` does not count.
pub fn stop_distance(task: &Task, limits: &AxisLimits) -> f64 {
    let state = State {
        d: 0.0,
        v: task.velocity / limits.jerk,
        a: task.acceleration / limits.jerk,
    };
    state.stop(limits.acceleration / limits.jerk) * limits.jerk
}

/// Durations of the three segments of the fastest stop from a state within the limit of acceleration: to the peak, at it,
/// and back to zero.
pub fn stop_durations(task: &Task, limits: &AxisLimits) -> [f64; 3] {
    let state = State {
        d: 0.0,
        v: task.velocity / limits.jerk,
        a: task.acceleration / limits.jerk,
    };
    let sign = if state.released() > 0.0 { -1.0 } else { 1.0 };
    let state = state.mirrored(sign);
    let (v_s, _) = state.virtual_start();
    let (peak, hold) = peak((-v_s).max(0.0), limits.acceleration / limits.jerk);
    [(peak - state.a).max(0.0), hold, peak]
}

/// Limits over jerk: that of acceleration is a time.
struct Scaled {
    v: f64,
    a: f64,
}

/// State over jerk, and the way that is left.
#[derive(Clone, Copy)]
struct State {
    d: f64,
    v: f64,
    a: f64,
}

/// Where the main part starts: within the limits, and mirrored so that the target lies beyond the fastest stop.
struct Start {
    state: State,
    /// Jerk sign of the first segment, durations of the first two.
    brake: (f64, [f64; 2]),
    /// The mirror: 1 or -1.
    sign: f64,
}

/// The main part: seven segments, and the sign of the jerk in the first.
#[derive(Clone, Copy)]
struct Main {
    t: [f64; 7],
    first: f64,
    /// Speed in segment 6.
    top: f64,
    released_in_part: bool,
}

/// The time in which speed changes by `u` from zero acceleration to zero acceleration.
fn ramp(u: f64, most: f64) -> f64 {
    if u <= most * most {
        2.0 * libm::sqrt(u)
    } else {
        u / most + most
    }
}

/// Peak and duration of the peak in such a change.
fn peak(u: f64, most: f64) -> (f64, f64) {
    if u <= most * most {
        (libm::sqrt(u), 0.0)
    } else {
        (most, u / most - most)
    }
}

impl State {
    fn run(&mut self, t: f64, jerk: f64) {
        self.d -= t * (self.v + t * (self.a / 2.0 + jerk * t / 6.0));
        self.v += t * (self.a + jerk * t / 2.0);
        self.a += jerk * t;
    }

    /// Speed once the acceleration is released.
    fn released(&self) -> f64 {
        self.v + self.a * self.a.abs() / 2.0
    }

    fn mirrored(&self, sign: f64) -> Self {
        Self {
            d: self.d * sign,
            v: self.v * sign,
            a: self.a * sign,
        }
    }

    /// Virtual start of a ramp upwards: its speed, and its distance.
    fn virtual_start(&self) -> (f64, f64) {
        let half = self.a * self.a / 2.0;
        (self.v - half, -self.a * (self.v - half / 1.5))
    }

    /// Distance of the fastest stop.
    fn stop(&self, most: f64) -> f64 {
        let sign = if self.released() > 0.0 { -1.0 } else { 1.0 };
        let (v_s, p_s) = self.mirrored(sign).virtual_start();
        sign * (p_s + v_s / 2.0 * ramp((-v_s).max(0.0), most))
    }

    /// Brakes into the limits. Both reasons ask for the same sign of jerk, or the second for none.
    fn brake(&mut self, limits: &Scaled) -> (f64, [f64; 2]) {
        let mut sign = 0.0;
        let mut jerking = 0.0;
        let mut holding = 0.0;
        let over = self.a.abs() - limits.a;
        if over > 0.0 {
            sign = -self.a.signum();
            jerking = over;
            self.run(over, sign);
            self.a = -sign * limits.a;
        }
        let released = self.released();
        let over = released.abs() - limits.v;
        if over > 0.0 {
            let way = released.signum();
            let a = self.a * way;
            let peak = libm::sqrt(over + a.min(0.0) * a.min(0.0)).min(limits.a);
            let more = (peak + a).max(0.0);
            if more > 0.0 {
                sign = -way;
                jerking += more;
                self.run(more, -way);
            }
            holding = ((self.released() * way - limits.v) / limits.a).max(0.0);
            self.run(holding, 0.0);
        }
        (sign, [jerking, holding])
    }
}

impl Start {
    fn new(task: &Task, limits: &AxisLimits) -> Result<(Self, Scaled), Unusable> {
        let jerk = limits.jerk;
        let scaled = Scaled {
            v: limits.velocity / jerk,
            a: limits.acceleration / jerk,
        };
        let usable = |limit: f64| limit.is_finite() && limit > 0.0;
        if ![
            limits.velocity,
            limits.acceleration,
            jerk,
            scaled.v,
            scaled.a,
        ]
        .into_iter()
        .all(usable)
        {
            return Err(Unusable::Limits);
        }
        let mut state = State {
            d: task.distance / jerk,
            v: task.velocity / jerk,
            a: task.acceleration / jerk,
        };
        let brake = state.brake(&scaled);
        let stop = state.stop(scaled.a);
        if !(state.d - stop).is_finite() {
            return Err(Unusable::Task);
        }
        let sign = if state.d < stop { -1.0 } else { 1.0 };
        let start = Self {
            state: state.mirrored(sign),
            brake,
            sign,
        };
        Ok((start, scaled))
    }

    fn braked(&self) -> f64 {
        self.brake.1[0] + self.brake.1[1]
    }

    fn fastest(&self, limits: &Scaled) -> Main {
        let State { d, v: _, a } = self.state;
        let v_z = self.state.released();
        if a < 0.0 && v_z > 0.0 {
            let first = -a * (v_z + a * a / 6.0);
            let least = first + v_z / 2.0 * ramp(v_z, limits.a);
            if d < least {
                return released_in_part(d - first, v_z, -a, limits.a);
            }
        }
        let (v_s, p_s) = self.state.virtual_start();
        let full = (limits.v - v_s).max(0.0);
        let longest = p_s
            + (v_s + limits.v) / 2.0 * ramp(full, limits.a)
            + limits.v / 2.0 * ramp(limits.v, limits.a);
        if d >= longest {
            self.cruising(full, limits.v, (d - longest) / limits.v, limits.a)
        } else {
            // Not as a root of a difference, where that would cost digits.
            let least = if v_z > 0.0 {
                a.max(0.0)
            } else {
                libm::sqrt(-v_s)
            };
            let s = touching(d - p_s, v_s, least, limits);
            self.cruising(s * s, (v_s + s * s).max(0.0), 0.0, limits.a)
        }
    }

    /// Up to a speed `u` above the virtual start's, `top`; that for `hold`; and down to rest.
    fn cruising(&self, u: f64, top: f64, hold: f64, most: f64) -> Main {
        let (up, up_hold) = peak(u, most);
        let (down, down_hold) = peak(top, most);
        Main {
            t: [
                (up - self.state.a).max(0.0),
                up_hold,
                up,
                hold,
                down,
                down_hold,
                down,
            ],
            first: 1.0,
            top,
            released_in_part: false,
        }
    }

    /// The profile of a lower speed in segment 6 that lasts `duration`.
    ///
    /// What the time left for segment 6 would cover at speed `top`, less what is left to cover, is negative for a `top` of
    /// zero and positive at the fastest profile's: bisection and regula falsi between them, and the side that is early.
    fn slower(&self, fastest: &Main, duration: f64, limits: &Scaled) -> Option<Main> {
        let miss = |top: f64| {
            let (t, d) = self.ramps(top, limits.a);
            (top * (duration - t) - (self.state.d - d), self.state.d - d)
        };
        let (mut low, mut high) = (0.0, fastest.top);
        let mut f_low = self.state.stop(limits.a) - self.state.d;
        let (mut f_high, mut left) = miss(high);
        if !(f_low < 0.0 && f_high >= 0.0) {
            return None;
        }
        for round in 0..MOST_ROUNDS {
            // Early by so little is as good as in time.
            if f_high <= high * duration * EARLY {
                break;
            }
            let middle = if round % 3 == 2 {
                (low + high) / 2.0
            } else {
                high - f_high * (high - low) / (f_high - f_low)
            };
            let (f, rest) = miss(middle);
            if f >= 0.0 {
                // Regula falsi would keep the other end for ever: it is made to count for half (Illinois).
                (high, f_high, left) = (middle, f, rest);
                f_low /= 2.0;
            } else {
                (low, f_low) = (middle, f);
                f_high /= 2.0;
            }
        }
        (left >= 0.0 && high > 0.0).then(|| self.at_speed(high, left / high, limits.a))
    }

    /// Time and distance of both ramps at a given speed between them.
    fn ramps(&self, top: f64, most: f64) -> (f64, f64) {
        let first = self.first(top);
        let state = self.state.mirrored(first);
        let (v_s, p_s) = state.virtual_start();
        let up = ramp((first * top - v_s).max(0.0), most);
        let down = ramp(top, most);
        (
            up - state.a + down,
            first * (p_s + (v_s + first * top) / 2.0 * up) + top / 2.0 * down,
        )
    }

    fn first(&self, top: f64) -> f64 {
        if top >= self.state.released() {
            1.0
        } else {
            -1.0
        }
    }

    fn at_speed(&self, top: f64, hold: f64, most: f64) -> Main {
        let first = self.first(top);
        let mirrored = Self {
            state: self.state.mirrored(first),
            brake: self.brake,
            sign: self.sign,
        };
        let (v_s, _) = mirrored.state.virtual_start();
        let mut main = mirrored.cruising((first * top - v_s).max(0.0), top, hold, most);
        main.first = first;
        main
    }

    fn profile(&self, main: &Main, jerk: f64) -> Result<AxisProfile, Unusable> {
        let (brake, [b1, b2]) = self.brake;
        let t = main.t;
        let durations = [b1, b2, t[0], t[1], t[2], t[3], t[4], t[5], t[6]];
        if !durations.iter().all(|t| t.is_finite()) {
            return Err(Unusable::Task);
        }
        let first = self.sign * main.first * jerk;
        let last = self.sign * jerk;
        Ok(AxisProfile {
            durations,
            jerks: [brake * jerk, 0.0, first, 0.0, -first, 0.0, -last, 0.0, last],
            released_in_part: main.released_in_part,
        })
    }
}

/// Rounds of any solution; a few are needed.
const MOST_ROUNDS: usize = 60;
/// Part of a duration by which an axis may be early.
const EARLY: f64 = 1e-4;

/// Case B: the root of the speed gained from the virtual start.
fn touching(d: f64, v_s: f64, low: f64, limits: &Scaled) -> f64 {
    let high = libm::sqrt((limits.v - v_s).max(0.0)).max(low);
    // Exact from rest.
    let most = limits.a;
    let way = d.max(0.0);
    let from_rest = if way <= 2.0 * most * most * most {
        let root = libm::cbrt(way / 2.0);
        root * root
    } else {
        most / 2.0 * (libm::sqrt(most * most + 4.0 * way / most) - most)
    };
    let guess = libm::sqrt((from_rest - v_s).max(0.0));
    newton(low, high, guess, |s| {
        let top = v_s + s * s;
        let (up, up_slope) = if s <= most {
            (2.0 * s, 2.0)
        } else {
            (s * s / most + most, 2.0 * s / most)
        };
        let (down, down_slope) = slope(top.max(0.0), most);
        let mean = (v_s + top) / 2.0;
        (
            mean * up + down - d,
            s * up + mean * up_slope + 2.0 * s * down_slope,
        )
    })
}

/// Distance of the ramp from speed `u` to rest, and its derivative.
fn slope(u: f64, most: f64) -> (f64, f64) {
    if u <= most * most {
        let root = libm::sqrt(u);
        (u * root, 1.5 * root)
    } else {
        (u / 2.0 * (u / most + most), u / most + most / 2.0)
    }
}

/// Case A.
fn released_in_part(d: f64, v_z: f64, a: f64, most: f64) -> Main {
    let q = newton(0.0, a, a / 2.0, |q| {
        let w = v_z + q * q;
        let (way, way_slope) = slope(w, most);
        // Falling: its negative grows.
        (
            d - way + q * (2.0 * v_z + q * q),
            2.0 * v_z + 3.0 * q * q - 2.0 * q * way_slope,
        )
    });
    let (down, hold) = peak(v_z + q * q, most);
    Main {
        t: [a - q, 0.0, 0.0, 0.0, (down - q).max(0.0), hold, down],
        first: 1.0,
        top: v_z,
        released_in_part: true,
    }
}

/// The zero of a growing function between `low` and `high`: Newton's method, bisection where that leaves the bracket.
fn newton(mut low: f64, mut high: f64, guess: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut x = guess.clamp(low, high.max(low));
    for _ in 0..MOST_ROUNDS {
        let (value, slope) = f(x);
        if value > 0.0 {
            high = x;
        } else if value < 0.0 {
            low = x;
        } else {
            return x;
        }
        let next = x - value / slope;
        let inside = next > low && next < high;
        let next = if inside { next } else { (low + high) / 2.0 };
        if (next - x).abs() <= f64::EPSILON * next.abs() {
            return next;
        }
        x = next;
    }
    x
}
