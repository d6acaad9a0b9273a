//! What a run amounts to, gathered from every tick.

use super::sample::Sample;

/// Peak and root mean square of one signed or unsigned quantity.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub struct Spread {
    peak: f64,
    sum_of_squares: f64,
    count: u64,
}

impl Spread {
    /// Adds one value.
    pub fn add(&mut self, value: f64) {
        // Not `f64::max`, which drops a NaN: one NaN has to show, and to stay.
        if value.abs() > self.peak || value.is_nan() {
            self.peak = value.abs();
        }
        self.sum_of_squares += value * value;
        self.count += 1;
    }

    /// Largest magnitude; zero without values.
    pub fn peak(&self) -> f64 {
        self.peak
    }

    /// Root mean square; zero without values.
    pub fn rms(&self) -> f64 {
        if self.count == 0 {
            return 0.0;
        }
        (self.sum_of_squares / self.count as f64).sqrt()
    }

    /// How many values were added.
    pub fn count(&self) -> u64 {
        self.count
    }
}

/// Following errors over the moving ticks; duty and separation over all of them.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Statistics {
    /// Distance of the centre from its setpoint, um, moving ticks.
    pub error_xy_um: Spread,
    /// Orientation minus its setpoint, urad, moving ticks.
    pub error_theta_urad: Spread,
    /// Measured minus setpoint of all three pivots together, encoder LSB, moving ticks.
    pub pivot_error_lsb: Spread,
    /// Largest magnitude of any duty, 0 to 1, all ticks.
    pub peak_duty: f64,
    /// Smallest angle between two pivots, deg, all ticks; infinite without samples.
    pub separation_deg: f64,
    /// All ticks.
    pub ticks: u64,
    /// Time of the last sample, s.
    pub end_s: f64,
}

impl Default for Statistics {
    fn default() -> Self {
        Self {
            error_xy_um: Spread::default(),
            error_theta_urad: Spread::default(),
            pivot_error_lsb: Spread::default(),
            peak_duty: 0.0,
            separation_deg: f64::INFINITY,
            ticks: 0,
            end_s: 0.0,
        }
    }
}

impl Statistics {
    /// Adds one tick.
    pub fn add(&mut self, sample: &Sample) {
        self.ticks += 1;
        self.end_s = sample.time_s;
        self.separation_deg = self.separation_deg.min(sample.separation_deg);
        for duty in sample.duty {
            self.peak_duty = self.peak_duty.max(duty.abs());
        }
        if sample.moving {
            self.add_errors(sample);
        }
    }

    fn add_errors(&mut self, sample: &Sample) {
        self.error_xy_um.add(sample.error_xy_um());
        self.error_theta_urad.add(sample.error[2]);
        for error in sample.pivot_error_lsb {
            self.pivot_error_lsb.add(error);
        }
    }
}
