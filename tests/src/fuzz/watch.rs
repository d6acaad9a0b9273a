//! What has to hold from tick to tick.

use crate::ideal::{Ideal, is_held};
use firmware::drivers::bridge::Duty;
use firmware::parameters::Parameters;
use firmware::recorder::Sample;
use std::collections::VecDeque;

/// Lines that are told when something does not hold.
const LINES: usize = 12;
const PERIOD_S: f64 = 1.0 / Parameters::REFERENCE.limits.rate_hz;
/// Of 32-bit floats, per second.
const ROUNDING: f64 = 1e-5;
/// Most that any limits make of an acceleration, track radii or turns a second squared, the turning about a point included.
const HARDEST: f64 = 2_000.0;

/// Looks at every tick.
#[derive(Default)]
pub(super) struct Watch {
    last: Option<Sample>,
    lines: VecDeque<String>,
}

impl Watch {
    /// Keeps a line for the story.
    pub fn note(&mut self, line: &[u8]) {
        if self.lines.len() == LINES {
            self.lines.pop_front();
        }
        self.lines.push_back(line.escape_ascii().to_string());
    }

    /// The last lines that were sent.
    pub fn story(&self) -> String {
        let lines: Vec<_> = self.lines.iter().map(String::as_str).collect();
        lines.join(" | ")
    }

    /// Looks at the last tick.
    pub fn look(&mut self, stage: &Ideal) {
        let Some(now) = stage.sample() else { return };
        if !is_held(now) {
            assert_eq!(stage.outputs.duty, [Duty(0); 3], "{}", self.story());
        } else if let Some(last) = self.last.as_ref().filter(|last| {
            // After a pause the setpoint starts where the stage is.
            is_held(last) && last.tick + 1 == now.tick
        }) {
            self.compare(last, now);
        }
        self.last = Some(now.clone());
    }

    fn compare(&self, last: &Sample, now: &Sample) {
        let unit = 1.0 / 4_294_967_296.0;
        let turn = std::f64::consts::TAU;
        for (i, scale) in [1.0, 1.0, turn].into_iter().enumerate() {
            let step = (now.setpoint.position[i] - last.setpoint.position[i]) as f64 * unit * scale;
            let [v0, v1] = [last, now].map(|s| {
                let twist = s.setpoint.twist;
                f64::from([twist.x, twist.y, twist.theta][i])
            });
            let [a0, a1] = [last, now].map(|s| {
                let a = s.setpoint.acceleration;
                f64::from([a.x, a.y, a.theta][i])
            });
            let hardest = a0.abs().max(a1.abs());
            let told = || {
                format!(
                    "axis {i} at tick {}: {last:?} {now:?}; {}",
                    now.tick,
                    self.story()
                )
            };
            assert!(hardest < HARDEST * scale, "acceleration of {}", told());
            let off = step - (v0 + v1) / 2.0 * PERIOD_S;
            assert!(
                off.abs() < (ROUNDING + hardest * PERIOD_S) * PERIOD_S + 2.0 * unit * scale,
                "position of {}",
                told()
            );
            let jump = (v1 - v0).abs();
            assert!(
                jump < ROUNDING * (1.0 + v0.abs()) + 2.0 * hardest * PERIOD_S,
                "velocity of {}",
                told()
            );
        }
        for i in 0..3 {
            let step =
                (now.pivot_setpoints[i] - last.pivot_setpoints[i]).units() as f64 * unit * turn;
            let rate = f64::from(last.pivot_rates[i].abs().max(now.pivot_rates[i].abs()));
            let most = rate * PERIOD_S * 1.01 + 1e-6;
            assert!(
                step.abs() < most,
                "pivot {i} at tick {}: {step} rad; {}",
                now.tick,
                self.story()
            );
        }
    }
}
