//! The recorder of a run: every tick goes in; statistics, plots and table rows come out.

use super::path::Path;
use super::sample::{Sample, xy};
use super::statistics::Statistics;
use drawing::envelope::Envelope;

/// Rows of the trace file at the default 20 kHz: one a millisecond.
pub const DEFAULT_EVERY: u32 = 20;

/// Records a run. Statistics and plots see every tick, the table every `every`-th.
#[derive(Clone, Debug)]
pub struct Trace {
    every: u32,
    rows: Vec<Sample>,
    last: Option<Sample>,
    statistics: Statistics,
    plots: Plots,
    path: Path,
}

/// What the picture's charts show, over time.
#[derive(Clone, Default, Debug)]
pub(crate) struct Plots {
    /// True pose: mm, mm, deg.
    pub(crate) pose: Envelope<3>,
    /// Following error of the centre in um and of theta in urad; whether moving (1) or not (0); the same errors of the true pose.
    pub(crate) error: Envelope<5>,
    /// Deg.
    pub(crate) pivots: Envelope<3>,
    /// -1 to 1.
    pub(crate) duty: Envelope<3>,
    /// Rate, acceleration and jerk of the moved point: along the path, then of theta; as in [`MotionSample`].
    ///
    /// [`MotionSample`]: super::MotionSample
    pub(crate) motion: Envelope<6>,
    /// Of the pivots: rad/s, then rad/s^2.
    pub(crate) pivot_rates: Envelope<6>,
}

impl Plots {
    /// The same in at most `most` bins.
    pub(crate) fn reduced(&self, most: usize) -> Self {
        Self {
            pose: self.pose.reduced(most),
            error: self.error.reduced(most),
            pivots: self.pivots.reduced(most),
            duty: self.duty.reduced(most),
            motion: self.motion.reduced(most),
            pivot_rates: self.pivot_rates.reduced(most),
        }
    }
}

impl Trace {
    /// An empty trace that keeps the first of every `every` samples as a row; 0 counts as 1.
    pub fn new(every: u32) -> Self {
        Self {
            every: every.max(1),
            rows: Vec::new(),
            last: None,
            statistics: Statistics::default(),
            plots: Plots::default(),
            path: Path::default(),
        }
    }

    /// Takes one tick.
    pub fn record(&mut self, sample: &Sample) {
        if self.statistics.ticks.is_multiple_of(u64::from(self.every)) {
            self.rows.push(*sample);
        }
        self.statistics.add(sample);
        let time_s = sample.time_s;
        let moving = f64::from(u8::from(sample.moving));
        self.plots.pose.add(time_s, &sample.pose);
        let (seen, truth) = (&sample.following_error, &sample.true_error);
        (self.plots.error).add(time_s, &[xy(seen), seen[2], moving, xy(truth), truth[2]]);
        self.plots.pivots.add(time_s, &sample.pivot_setpoint_deg);
        self.plots.duty.add(time_s, &sample.duty);
        let [v, a, j] = sample.motion.translation;
        let [w, alpha, turn_jerk] = sample.motion.rotation;
        (self.plots.motion).add(time_s, &[v, a, j, w, alpha, turn_jerk]);
        let ([r1, r2, r3], [a1, a2, a3]) = (sample.pivot_rate_rad_s, sample.motion.pivots_rad_s2);
        (self.plots.pivot_rates).add(time_s, &[r1, r2, r3, a1, a2, a3]);
        self.path.add([sample.pose[0], sample.pose[1]]);
        self.last = Some(*sample);
    }

    /// The rows of the trace file.
    pub fn rows(&self) -> &[Sample] {
        &self.rows
    }

    /// The last tick, whether it became a row or not.
    pub fn last(&self) -> Option<&Sample> {
        self.last.as_ref()
    }

    /// Statistics of all ticks so far.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    pub(crate) fn plots(&self) -> &Plots {
        &self.plots
    }

    /// Where the centre was, mm.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::MotionSample;

    fn sample(tick: u32) -> Sample {
        Sample {
            time_s: f64::from(tick) * 50e-6,
            moving: tick >= 3,
            setpoint: [0.0; 3],
            setpoint_rate: [0.0; 3],
            pose: [0.0; 3],
            following_error: [0.6, -0.8, 0.5],
            true_error: [3.0, 4.0, -f64::from(tick)],
            pivot_setpoint_deg: [0.0; 3],
            pivot_rate_rad_s: [0.0; 3],
            motion: MotionSample::default(),
            pivot_error_lsb: [1.0, -2.0, 0.0],
            duty: [0.1, -0.01 * f64::from(tick), 0.0],
            integral_v: [0.0; 3],
            model_current_a: [0.0; 3],
            learnt_rate_v_s_rad: [0.0; 3],
            learnt_torque_v_n_m: [0.0; 3],
            learnt_friction_v: [0.0; 3],
            separation_deg: 100.0 - f64::from(tick % 7),
        }
    }

    #[test]
    fn statistics_see_every_tick_and_rows_every_third() {
        let mut trace = Trace::new(3);
        (0..11).for_each(|tick| trace.record(&sample(tick)));
        let times: Vec<_> = trace.rows().iter().map(|row| row.time_s).collect();
        assert_eq!(times, [0, 3, 6, 9].map(|tick| f64::from(tick) * 50e-6));
        let statistics = trace.statistics();
        assert_eq!(statistics.ticks, 11);
        assert_eq!(statistics.moving.truth.xy_um.count(), 8);
        assert_eq!(statistics.moving.truth.xy_um.peak(), 5.0);
        assert_eq!(statistics.moving.truth.xy_um.rms(), 5.0);
        assert_eq!(statistics.moving.truth.theta_urad.peak(), 10.0);
        let sum_of_squares: f64 = (3..11).map(|tick| f64::from(tick * tick)).sum();
        let rms = (sum_of_squares / 8.0).sqrt();
        assert!((statistics.moving.truth.theta_urad.rms() - rms).abs() < 1e-12);
        let seen = statistics.moving.following;
        assert_eq!(
            (seen.xy_um.count(), seen.xy_um.peak(), seen.theta_urad.rms()),
            (8, 1.0, 0.5)
        );
        assert!((statistics.pivot_error_lsb.rms() - (5.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        assert_eq!(statistics.peak_duty, 0.1);
        assert_eq!(statistics.separation_deg, 94.0);
        assert_eq!(trace.last().map(|last| last.time_s), Some(10.0 * 50e-6));
    }

    #[test]
    fn a_nan_error_shows() {
        let mut trace = Trace::new(1);
        trace.record(&Sample {
            true_error: [f64::NAN, 0.0, 0.0],
            ..sample(5)
        });
        trace.record(&sample(6));
        assert!(trace.statistics().moving.truth.xy_um.peak().is_nan());
        assert!(trace.statistics().moving.truth.xy_um.rms().is_nan());
    }
}
