//! The progress bar of a run: how far, what simulated time, how fast.

use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};

/// Shown on standard error while a run lasts; hidden where that is no terminal.
pub struct Progress {
    bar: ProgressBar,
    begun: Instant,
}

impl Progress {
    /// A bar of `steps` steps, say lines of a script; hidden if `quiet`.
    pub fn new(steps: u64, quiet: bool) -> Self {
        let bar = if quiet {
            ProgressBar::hidden()
        } else {
            ProgressBar::new(steps)
        };
        if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len}  {msg}") {
            bar.set_style(style);
        }
        Self {
            bar,
            begun: Instant::now(),
        }
    }

    /// `steps` steps are done; what is being done.
    pub fn tell(&self, steps: u64, what: &'static str) {
        self.bar.set_position(steps);
        self.bar.set_message(what);
    }

    /// `steps` steps are done and `simulated_s` seconds simulated. Cheap, yet meant for every so many ticks, not each.
    pub fn update(&self, steps: u64, simulated_s: f64) {
        let speed = simulated_s / self.begun.elapsed().as_secs_f64();
        self.bar.set_position(steps);
        self.bar
            .set_message(format!("{simulated_s:.1} s simulated, {speed:.0}x"));
    }

    /// Removes the bar and gives the wall-clock time since it was made, s.
    pub fn finish(self) -> f64 {
        self.bar.finish_and_clear();
        self.begun.elapsed().as_secs_f64()
    }
}
