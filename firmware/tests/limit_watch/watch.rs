//! Holds every tick of the setpoint against what is allowed in it.
//!
//! | while | speed | acceleration | jerk |
//! |---|---|---|---|
//! | an ordinary plan is under way | limit | limit | limit |
//! | a stream or waveforms are | limit | limit | limit times [`JERK_TOLERANCE`] |
//! | an urgent stop is | limit | the pivots' limits only | limit times the square of the stop factor |
//! | an urgent stop has been left with more than the ordinary acceleration: until that is ordinary again | limit | as much as that stop had at most | as in the stop |
//! | the same: until that stop would have been over, because its rest is part of the way | limit | | as in the stop |
//!
//! The limit of speed is the one in force when the plan was made. A plan that begins above it, because the limit has been
//! lowered meanwhile, has to come down to it. Pivots keep their limits, the platform keeps in its disk, and position and
//! velocity do not step, whatever is under way.

use super::allowance::{Allowance, JERKS, Purpose, peaks};
use super::commanded::Commanded;
use super::counts::Counts;
use super::limits_in_force::{PivotLimits, SpeedLimits};
use super::quantities::{Pair, UNITS, accelerations, axis_speeds, jerks, speeds};
use super::rule::{Breach, Breaches, Rule, record};
use crate::gcs_bench::FakeTick;
use crate::gcs_bench::axes::Course;
use crate::motion_bench::exact::Worst;
use crate::motion_bench::{CONSTRAINTS, LIMITS};
use firmware::mode::Mode;
use firmware::motion::{AxisState, JERK_TOLERANCE, RotationCentre};

/// Slack of speed, acceleration and jerk; of streamed targets and what takes over from them; of the pivots.
const SLACK: f64 = 1.0 + 2e-4;
const STREAM_SLACK: f64 = 1.0 + 1e-3;
const PIVOT_SLACK: f64 = 1.0 + 1e-3;
/// Out of the disk, track radii.
const RIM: f64 = 1e-6;
/// What is dropped at the end of a plan, 2^-72 track radii or turns, and a tick: two units of a position, 0.1 um/s.
const POSITION_ROUNDING: i128 = 1 << 41;
const VELOCITY_ROUNDING: i64 = 1 << 32;

const ACCELERATIONS: Pair = [LIMITS.acceleration_mm_s2, LIMITS.turn_acceleration_deg_s2];

pub struct Watch {
    pub limits: SpeedLimits,
    /// Of the pivots.
    pub pivot_limits: PivotLimits,
    /// The highest limits in force since the last motion was commanded: a plan for it may be made at any time from then on.
    highest: SpeedLimits,
    /// What is commanded is a velocity.
    jogs: bool,
    /// What plans are for.
    pub commanded: Commanded,
    /// A plan that is to take over.
    next: Option<(u32, Allowance)>,
    allowance: Allowance,
    /// Largest acceleration of the urgent stop that has been left and whose acceleration is still there.
    left_stop: Option<Pair>,
    /// When the urgent stop that was under way last would be over; the rest of one that has been left is still followed.
    stop_ends: u64,
    followed_until: u64,
    /// A stream has been under way since the last rest.
    after_stream: bool,
    last: [AxisState; 3],
    centre: RotationCentre,
    pub breaches: Breaches,
    pub counts: Counts,
}

impl Watch {
    /// Of the reference stage, at rest.
    pub fn new(tick: &FakeTick) -> Self {
        Self {
            limits: SpeedLimits::FULL,
            pivot_limits: PivotLimits::FULL,
            highest: SpeedLimits::FULL,
            jogs: false,
            commanded: Commanded::default(),
            next: None,
            allowance: Allowance::default(),
            left_stop: None,
            stop_ends: 0,
            followed_until: 0,
            after_stream: false,
            last: *tick.axes(),
            centre: tick.now.centre,
            breaches: Breaches::new(),
            counts: Counts::default(),
        }
    }

    /// Other limits of speed are in force from now on.
    pub fn set_limits(&mut self, limits: SpeedLimits) {
        self.limits = limits;
        self.highest = self.highest.max(&limits);
    }

    /// A motion is commanded; whether it is one of a stream's, or a velocity.
    pub fn begin_motion(&mut self, streams: bool, jogs: bool) {
        self.commanded.begin_motion(streams);
        self.jogs = jogs;
        self.highest = self.limits;
    }

    /// Looks at the tick that has just run.
    pub fn look(&mut self, tick: &FakeTick) {
        self.counts.ticks += 1;
        if let Some(course) = &tick.accepted {
            self.next = Some((course.plan.id, self.allow(course)));
        }
        if let Some((_, allowance)) = self.next.take_if(|(id, _)| *id == tick.now.plan) {
            self.take_over(allowance);
        }
        let axes = *tick.axes();
        if tick.now.centre == self.centre {
            self.hold_continuity(&axes);
            self.hold_limits(&axes);
        }
        self.hold_mechanism(&axes, tick.now.centre);
        self.centre = tick.now.centre;
        self.last = axes;
        let (speeds, accelerations) = (speeds(&axes), accelerations(&axes));
        self.allowance.narrow(&speeds, &accelerations);
        if (0..2).all(|i| accelerations[i] <= ACCELERATIONS[i] * self.slack()) {
            self.left_stop = None;
        }
        if speeds == [0.0; 2] && accelerations == [0.0; 2] {
            self.after_stream = false;
        }
        if tick.now.mode == Mode::Holding && tick.commands_waiting() == 0 {
            self.commanded.come_to_rest();
        }
    }

    /// What a plan may do that has just been accepted.
    fn allow(&mut self, course: &Course) -> Allowance {
        let purpose = self.commanded.purpose_of(course);
        let mut limits = self.highest.path;
        let mut axis_speeds = [f64::INFINITY; 2];
        if purpose != Purpose::Stream && !self.after_stream {
            let [x, y, w] = self.highest.axes;
            limits[1] = limits[1].min(w);
            // A jog that takes over keeps to the limit of the path: an axis may pass its own while its acceleration turns.
            if !self.jogs {
                axis_speeds = [x, y];
            }
        }
        Allowance {
            purpose,
            speeds: limits,
            lowered: [None; 2],
            axis_speeds,
            ticks: course.plan.ticks(),
            peaks: if purpose == Purpose::UrgentStop {
                peaks(course)
            } else {
                [0.0; 2]
            },
        }
    }

    /// A plan is under way from now on.
    fn take_over(&mut self, mut allowance: Allowance) {
        let (speeds, accelerations) = (speeds(&self.last), accelerations(&self.last));
        allowance.begin_above(&self.allowance.speeds, &speeds, &accelerations);
        let left = self.allowance.purpose == Purpose::UrgentStop && speeds != [0.0; 2];
        let hard = (0..2).any(|i| accelerations[i] > ACCELERATIONS[i] * self.slack());
        if left && hard {
            self.left_stop = Some(self.allowance.peaks);
            self.followed_until = self.stop_ends;
        }
        if allowance.purpose == Purpose::UrgentStop {
            self.stop_ends = self.counts.ticks + allowance.ticks;
        }
        self.counts.stops_left += u64::from(left);
        self.counts.stops_left_hard += u64::from(left && hard);
        self.counts.begun_above += u64::from(allowance.lowered != [None; 2]);
        self.counts.add_plan(allowance.purpose);
        self.after_stream |= allowance.purpose == Purpose::Stream;
        self.allowance = allowance;
    }

    fn slack(&self) -> f64 {
        if self.after_stream {
            STREAM_SLACK
        } else {
            SLACK
        }
    }

    /// Speed, acceleration and jerk.
    fn hold_limits(&mut self, axes: &[AxisState; 3]) {
        let slack = self.slack();
        let (v, a, j) = (speeds(axes), accelerations(axes), jerks(&self.last, axes));
        let urgent = self.allowance.purpose == Purpose::UrgentStop;
        let jerk_factor = self.jerk_factor();
        for i in 0..2 {
            let rules = RULES[i];
            let units = UNITS.map(|units| units[i]);
            self.hold(rules[0], v[i], self.allowance.speeds[i] * slack, units[0]);
            let left = self.left_stop.map_or(0.0, |peaks| peaks[i]);
            if !urgent {
                let granted = ACCELERATIONS[i].max(left) * slack;
                self.hold(rules[1], a[i], granted, units[1]);
            }
            self.hold(rules[2], j[i], JERKS[i] * jerk_factor * slack, units[2]);
            let limit = self.allowance.axis_speeds[i];
            self.hold(Rule::AxisSpeed, axis_speeds(axes)[i], limit * slack, "mm/s");
        }
    }

    /// In limits of jerk.
    fn jerk_factor(&self) -> f64 {
        let stop = LIMITS.stop_factor.powi(2);
        match self.allowance.purpose {
            Purpose::Stream => f64::from(JERK_TOLERANCE).max(stop),
            Purpose::UrgentStop => stop,
            Purpose::Ordinary if self.left_stop.is_some() => stop,
            Purpose::Ordinary if self.counts.ticks <= self.followed_until => stop,
            Purpose::Ordinary => 1.0,
        }
    }

    /// Pivots and disk.
    fn hold_mechanism(&mut self, axes: &[AxisState; 3], centre: RotationCentre) {
        let mut constraints = CONSTRAINTS;
        constraints.rotation_centre = centre.point();
        // Shares of the reference stage's limits.
        let worst = Worst::of(axes, &constraints);
        let limits = &constraints.limits;
        let PivotLimits {
            rate_rad_s,
            acceleration_rad_s2,
        } = self.pivot_limits;
        let rate = worst.pivot_rate * limits.pivot_rate_rad_s;
        self.hold(Rule::PivotRate, rate, rate_rad_s * PIVOT_SLACK, "rad/s");
        let acceleration = worst.pivot_acceleration * limits.pivot_acceleration_rad_s2;
        let granted = acceleration_rad_s2 * PIVOT_SLACK;
        self.hold(Rule::PivotAcceleration, acceleration, granted, "rad/s^2");
        self.hold(Rule::Disk, worst.outside, RIM, "track radii outside");
    }

    /// Position by the velocity, velocity by the acceleration.
    fn hold_continuity(&mut self, axes: &[AxisState; 3]) {
        for (before, now) in self.last.into_iter().zip(axes) {
            let jerk = now.acceleration - before.acceleration;
            let velocity = before.velocity + before.acceleration + jerk / 2;
            let way = before.velocity + before.acceleration / 2 + jerk / 6;
            let steps = [
                (now.position - before.position - i128::from(way)).unsigned_abs() as f64,
                (now.velocity - velocity).unsigned_abs() as f64,
            ];
            let unit = "2^-72 units";
            let [position, velocity] = [POSITION_ROUNDING as f64, VELOCITY_ROUNDING as f64];
            self.hold(Rule::PositionStep, steps[0], position, unit);
            self.hold(Rule::VelocityStep, steps[1], velocity, unit);
        }
    }

    fn hold(&mut self, rule: Rule, value: f64, granted: f64, unit: &'static str) {
        if value > granted {
            self.report(rule, value, granted, unit);
        }
    }

    /// A rule is broken.
    pub fn report(&mut self, rule: Rule, value: f64, granted: f64, unit: &'static str) {
        let during = match self.allowance.purpose {
            Purpose::Ordinary if self.left_stop.is_some() => "where an urgent stop was left",
            purpose => purpose.name(),
        };
        let breach = Breach {
            value,
            granted,
            unit,
            tick: self.counts.ticks,
            first: self.counts.ticks,
            during,
        };
        record(&mut self.breaches, rule, breach);
    }
}

const RULES: [[Rule; 3]; 2] = [
    [Rule::Speed, Rule::Acceleration, Rule::Jerk],
    [Rule::TurnSpeed, Rule::TurnAcceleration, Rule::TurnJerk],
];
