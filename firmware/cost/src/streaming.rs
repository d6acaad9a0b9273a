//! Streams under way, just before the target that makes the next plan.

use crate::random::Random;
use crate::states::ground;
use core::f64::consts::TAU;
use firmware::motion::{AxisState, Clock, PlanProgress, Position, Stream, StreamStep};

const UNIT: f64 = 4_294_967_296.0;
/// Seconds in which a path is brought to its rate.
const START_S: f64 = 0.05;
/// Plans after which the stream is looked at, at most: well into the path at its rate.
const MOST_PLANS: u32 = 40;

/// A stream, what the tick says, and where the axes are.
#[derive(Default)]
pub struct Streaming {
    stream: Option<Stream>,
    id: u32,
    /// The axes at the start of the plan that the tick has begun.
    pub state: [AxisState; 3],
}

/// A circle, its centre and radius in track radii, turned by `rate` turns a second, and theta with it.
struct Circle {
    centre: [f64; 2],
    radius: f64,
    rate: f64,
    turning: f64,
}

impl Circle {
    fn new(random: &mut Random) -> Self {
        let radius = random.within(0.02, 0.3);
        Self {
            centre: [random.within(-0.3, 0.3), random.within(-0.3, 0.3)],
            radius,
            // Within 150 mm/s and 3 m/s^2.
            rate: (1.5 / radius).min(libm::sqrt(30.0 / radius)) / TAU * random.within(0.1, 1.0),
            turning: random.within(-0.5, 0.5),
        }
    }

    fn at(&self, seconds: f64) -> Position {
        let u = (seconds / START_S).min(1.0);
        let eased = START_S * (u * u / 2.0 - (1.0 - libm::cos(TAU * u)) / (TAU * TAU));
        let done = eased + (seconds - START_S).max(0.0);
        let (sin, cos) = libm::sincos(self.rate * done * TAU);
        let [x, y] = self.centre;
        [
            x + self.radius * cos,
            y + self.radius * sin,
            self.turning * done,
        ]
        .map(|value| (value * UNIT) as i64)
    }
}

impl Streaming {
    /// Brings a stream along a path to where one target more makes a plan; that target.
    pub fn prepare(&mut self, random: &mut Random, periods: [u64; 3]) -> Position {
        loop {
            let circle = Circle::new(random);
            let period = periods[random.up_to(2) as usize] as f64;
            let plans = 1 + random.up_to(u64::from(MOST_PLANS)) as u32;
            if let Some(target) = self.along(&circle, period, plans) {
                return target;
            }
        }
    }

    fn along(&mut self, circle: &Circle, period: f64, plans: u32) -> Option<Position> {
        let mut stream = Stream::new(circle.at(0.0), period, Clock::Sender)?;
        self.id = 0;
        let mut number = 0_u32;
        loop {
            let target = circle.at(f64::from(number) * period / ground().limits.rate_hz);
            let mut trial = stream.clone();
            trial.push(target, ground()).ok()?;
            let next = trial.next(self.id + 1, &self.progress(), ground());
            if let StreamStep::Send(plan, start) = &next {
                if self.id == plans {
                    self.stream = Some(stream);
                    return Some(target);
                }
                self.id += 1;
                self.state = plan.state_after(start, 1);
            } else if matches!(next, StreamStep::Over(_)) {
                return None;
            }
            stream = trial;
            number += 1;
        }
    }

    /// The plan sent last has just begun.
    fn progress(&self) -> PlanProgress {
        PlanProgress {
            plan: self.id,
            tick: 1,
            moving: self.id > 0,
        }
    }

    /// Takes a target, and makes the plan.
    pub fn take(&mut self, target: Position) -> Option<StreamStep> {
        let progress = self.progress();
        let stream = self.stream.as_mut()?;
        stream.push(target, ground()).ok()?;
        Some(stream.next(self.id + 1, &progress, ground()))
    }
}
