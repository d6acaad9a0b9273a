//! What a run amounts to, gathered from every tick.

use super::sample::{Sample, xy};

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

/// An error of the pose.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub struct PoseSpread {
    /// Distance of the centre from its setpoint, um.
    pub xy_um: Spread,
    /// Orientation minus its setpoint, urad.
    pub theta_urad: Spread,
}

impl PoseSpread {
    fn add(&mut self, error: &[f64; 3]) {
        self.xy_um.add(xy(error));
        self.theta_urad.add(error[2]);
    }
}

/// Errors of the pose, told apart by who sees them.
#[derive(Clone, Copy, PartialEq, Default, Debug)]
pub struct PoseErrors {
    /// What the encoders see: the following error.
    pub following: PoseSpread,
    /// Where the platform is: the true pose minus the setpoint.
    pub truth: PoseSpread,
    /// What of that no encoder sees: in motion what the guides sag by, at rest what is lost in them (lost motion); and all that the geometry
    /// is off besides.
    pub unseen: PoseSpread,
}

impl PoseErrors {
    fn add(&mut self, sample: &Sample) {
        let (following, truth) = (&sample.following_error, &sample.true_error);
        self.following.add(following);
        self.truth.add(truth);
        self.unseen.add(&[0, 1, 2].map(|k| truth[k] - following[k]));
    }
}

/// Time from the setpoint's arrival on from which on errors count as those at rest, s: a settled stage has come to rest by then.
const AT_REST_S: f64 = 0.02;

/// Errors over the moving ticks and at rest; duty and separation over all ticks.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Statistics {
    /// Moving ticks.
    pub moving: PoseErrors,
    /// Ticks at rest, from some time after each move on.
    pub at_rest: PoseErrors,
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
    /// Time of the last moving one, s.
    moved_s: Option<f64>,
}

impl Default for Statistics {
    fn default() -> Self {
        Self {
            moving: PoseErrors::default(),
            at_rest: PoseErrors::default(),
            pivot_error_lsb: Spread::default(),
            peak_duty: 0.0,
            separation_deg: f64::INFINITY,
            ticks: 0,
            end_s: 0.0,
            moved_s: None,
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
            self.moved_s = Some(sample.time_s);
            self.moving.add(sample);
            for error in sample.pivot_error_lsb {
                self.pivot_error_lsb.add(error);
            }
        } else if (self.moved_s).is_some_and(|moved_s| sample.time_s > moved_s + AT_REST_S) {
            self.at_rest.add(sample);
        }
    }
}
