//! Frequency responses of all three pivots to all three drives, from records under periodic excitation.
//!
//! Three experiments, in each of which the excitation is given to another drive, make three columns: U of the voltages, I of the
//! currents, Phi of the angles. Responses are quotients of these: `Phi U^-1` from volts to angles, `Phi I^-1` from currents to angles.
//! They hold in closed loop too, where volts answer to the angles: what the feedback adds is in U (joint input-output identification:
//! Pintelon and Schoukens, System Identification, section 2.6).
//!
//! All is put to the same instant: amplitudes are those of the voltage at the terminals (a step for each tick: its part at the line's
//! frequency), of the current in the winding and of the ring's angle, as continuous signals. So delays of sampling and of the duty are in none
//! of the responses.

use crate::record::{Record, Timing};
use crate::spectrum::spectrum;
use nalgebra::{Complex, Matrix3};
use std::f64::consts::{PI, TAU};

/// Fewest bins between two sines of a run: so far apart that a Hann window over one period keeps them apart.
const LEAST_SPACING: usize = 2;

/// The records of three experiments with the same lines.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Ticks of a period of the excitation, a power of two.
    pub period_ticks: usize,
    /// Ticks from row to row of the records, a power of two. Lines lie under half of the rows' rate; what lies above it folds back.
    pub ticks_per_row: usize,
    /// Periods of each line in it.
    pub bins: Vec<usize>,
    /// Records of the experiments in which drive 1, 2, 3 was excited; each a period or longer, taken after what a start excites has died.
    pub experiments: [Vec<Record>; 3],
}

impl Run {
    /// Rows of a period.
    #[must_use]
    pub fn period_rows(&self) -> usize {
        self.period_ticks / self.ticks_per_row.max(1)
    }
}

/// What was found at one frequency; columns are experiments, rows pivots.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Frequency.
    pub hz: f64,
    /// Voltages, V.
    pub volts: Matrix3<Complex<f64>>,
    /// Currents, A.
    pub current_a: Matrix3<Complex<f64>>,
    /// Angles, rad.
    pub angle_rad: Matrix3<Complex<f64>>,
    /// Standard deviations of the angles by the scatter from period to period, rad.
    pub angle_deviation_rad: Matrix3<f64>,
    /// The same of the currents, A.
    pub current_deviation_a: Matrix3<f64>,
}

/// Why there are no responses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ResponseError {
    /// A period that is no power of two.
    #[error("a period of {0} ticks: it has to be a power of two, 4096 for instance")]
    Period(usize),
    /// Rows that do not divide it.
    #[error("a row every {0} ticks: it has to be a power of two, and less than the period")]
    Rows(usize),
    /// Lines of a run that a window does not keep apart.
    #[error(
        "lines {0} and {1} of a run are too close: leave {LEAST_SPACING} bins between, and put what lies between into another run"
    )]
    Spacing(usize, usize),
    /// A line that no tick can show.
    #[error("line {0} is none: lines are from 1 to under half of the period's rows")]
    Bin(usize),
    /// A pivot with signals of different lengths.
    #[error("pivot {pivot}: volts, current and angle of a record are not as long as each other")]
    Lengths {
        /// 1 to 3.
        pivot: usize,
    },
    /// A pivot that has no whole period, or only one, in an experiment.
    #[error(
        "experiment {experiment} has {blocks} blocks of a period of pivot {pivot}: record two periods or more"
    )]
    TooShort {
        /// 1 to 3.
        experiment: usize,
        /// 1 to 3.
        pivot: usize,
        /// Blocks there are.
        blocks: usize,
    },
    /// A line without an answer that can be inverted.
    #[error("nothing came of the excitation at {hz} Hz: more volts, or a drive does not drive")]
    NotExcited {
        /// Frequency, rounded.
        hz: u32,
    },
}

/// Responses at the lines of all runs, by frequency. Where volts were not recorded (they are all 0), those to volts are none.
///
/// # Errors
/// [`ResponseError`].
pub fn frequency_response(runs: &[Run], timing: &Timing) -> Result<Vec<Line>, ResponseError> {
    let mut lines = Vec::new();
    for run in runs {
        check(run)?;
        let mut empty: Vec<Line> = run
            .bins
            .iter()
            .map(|&bin| empty_line(run, bin, timing))
            .collect();
        for (experiment, records) in run.experiments.iter().enumerate() {
            for pivot in 0..3 {
                let blocks = blocks(run, records, pivot, experiment)?;
                for (line, &bin) in empty.iter_mut().zip(&run.bins) {
                    line.fill(&blocks, bin, (pivot, experiment), timing);
                }
            }
        }
        lines.extend(empty);
    }
    for line in &lines {
        let is_told = line.volts != Matrix3::zeros();
        if is_told && line.volts.determinant().norm() == 0.0
            || line.current_a.determinant().norm() == 0.0
        {
            return Err(ResponseError::NotExcited { hz: line.hz as u32 });
        }
    }
    lines.sort_by(|a, b| a.hz.total_cmp(&b.hz));
    Ok(lines)
}

fn check(run: &Run) -> Result<(), ResponseError> {
    if !run.period_ticks.is_power_of_two() {
        return Err(ResponseError::Period(run.period_ticks));
    }
    if !run.ticks_per_row.is_power_of_two() || run.period_rows() == 0 {
        return Err(ResponseError::Rows(run.ticks_per_row));
    }
    let mut bins = run.bins.clone();
    bins.sort_unstable();
    if let Some(&bin) = (bins.iter()).find(|&&bin| bin == 0 || 2 * bin >= run.period_rows()) {
        return Err(ResponseError::Bin(bin));
    }
    match bins
        .windows(2)
        .find(|pair| pair[1] < pair[0] + LEAST_SPACING)
    {
        Some(pair) => Err(ResponseError::Spacing(pair[0], pair[1])),
        None => Ok(()),
    }
}

fn empty_line(run: &Run, bin: usize, timing: &Timing) -> Line {
    Line {
        hz: bin as f64 / (run.period_ticks as f64 * timing.tick_s),
        volts: Matrix3::zeros(),
        current_a: Matrix3::zeros(),
        angle_rad: Matrix3::zeros(),
        angle_deviation_rad: Matrix3::zeros(),
        current_deviation_a: Matrix3::zeros(),
    }
}

/// Spectra of a period of one pivot, at the phase that the excitation had at its beginning.
pub(crate) struct Block {
    /// Ticks from the excitation's beginning, less whole periods.
    pub first_tick: usize,
    pub period_ticks: usize,
    /// Volts as told, current and angle as read.
    pub signals: [Vec<Complex<f64>>; 3],
}

impl Block {
    /// What of the phase of a bin is the block's beginning.
    pub fn phase(&self, bin: usize) -> Complex<f64> {
        let turns = (bin * self.first_tick % self.period_ticks) as f64;
        Complex::cis(-TAU * turns / self.period_ticks as f64)
    }
}

/// Periods of a pivot in an experiment, each half a period after the last.
fn blocks(
    run: &Run,
    records: &[Record],
    pivot: usize,
    experiment: usize,
) -> Result<Vec<Block>, ResponseError> {
    let mut blocks = Vec::new();
    let period = run.period_rows();
    for record in records {
        let signals = &record.pivots[pivot];
        let ticks = signals
            .ticks()
            .ok_or(ResponseError::Lengths { pivot: pivot + 1 })?;
        let mut from = 0;
        while from + period <= ticks {
            let part = from..from + period;
            blocks.push(Block {
                first_tick: (record.first_tick + from * run.ticks_per_row) % run.period_ticks,
                period_ticks: run.period_ticks,
                signals: [&signals.volts, &signals.current_a, &signals.angle_rad]
                    .map(|all| spectrum(&all[part.clone()])),
            });
            from += period / 2;
        }
    }
    if blocks.len() < 2 {
        return Err(ResponseError::TooShort {
            experiment: experiment + 1,
            pivot: pivot + 1,
            blocks: blocks.len(),
        });
    }
    Ok(blocks)
}

/// The part that a voltage of one step for each tick has at a frequency, over what is told, with its delay.
#[must_use]
pub fn hold(hz: f64, timing: &Timing) -> Complex<f64> {
    let half_turns = hz * timing.tick_s;
    let size = if half_turns == 0.0 {
        1.0
    } else {
        (PI * half_turns).sin() / (PI * half_turns)
    };
    size * Complex::cis(-TAU * hz * (timing.duty_s + 0.5 * timing.tick_s))
}

impl Line {
    fn fill(&mut self, blocks: &[Block], bin: usize, at: (usize, usize), timing: &Timing) {
        let sampled = |offset_s: f64| Complex::cis(-TAU * self.hz * offset_s);
        let factors = [
            hold(self.hz, timing),
            sampled(timing.current_s),
            sampled(timing.angle_s),
        ];
        let [volts, current, angle] = [0, 1, 2].map(|signal| {
            let values: Vec<_> = blocks
                .iter()
                .map(|block| block.signals[signal][bin] * block.phase(bin) * factors[signal])
                .collect();
            let count = values.len() as f64;
            let mean = values.iter().sum::<Complex<f64>>() / count;
            let scatter = values
                .iter()
                .map(|value| (value - mean).norm_sqr())
                .sum::<f64>()
                / (count - 1.0);
            // Blocks that overlap by half are correlated by a sixth.
            (mean, (scatter / count * (1.0 + 2.0 / 6.0)).sqrt())
        });
        self.volts[at] = volts.0;
        (self.current_a[at], self.current_deviation_a[at]) = current;
        (self.angle_rad[at], self.angle_deviation_rad[at]) = angle;
    }

    /// From volts to angles, rad/V.
    #[must_use]
    pub fn angle_by_volts(&self) -> Matrix3<Complex<f64>> {
        over(&self.angle_rad, &self.volts)
    }

    /// From volts to currents, A/V.
    #[must_use]
    pub fn current_by_volts(&self) -> Matrix3<Complex<f64>> {
        over(&self.current_a, &self.volts)
    }

    /// From currents to angles, rad/A.
    #[must_use]
    pub fn angle_by_current(&self) -> Matrix3<Complex<f64>> {
        over(&self.angle_rad, &self.current_a)
    }

    /// Standard deviations of [`Self::angle_by_volts`] by the noise of the angles, rad/V.
    #[must_use]
    pub fn angle_by_volts_deviation(&self) -> Matrix3<f64> {
        deviation(&self.angle_deviation_rad, &self.volts)
    }

    /// The same of [`Self::angle_by_current`], rad/A.
    #[must_use]
    pub fn angle_by_current_deviation(&self) -> Matrix3<f64> {
        deviation(&self.angle_deviation_rad, &self.current_a)
    }

    /// How much of what the encoder of the worst pivot shows is an answer to its own drive, 0 to 1: the share of its energy, as a
    /// coherence is.
    #[must_use]
    pub fn quality(&self) -> f64 {
        (0..3)
            .map(|i| {
                let (answer, noise) = (
                    self.angle_rad[(i, i)].norm_sqr(),
                    self.angle_deviation_rad[(i, i)].powi(2),
                );
                answer / (answer + noise)
            })
            .fold(1.0, f64::min)
    }
}

/// `outputs inputs^-1`.
fn over(outputs: &Matrix3<Complex<f64>>, inputs: &Matrix3<Complex<f64>>) -> Matrix3<Complex<f64>> {
    let unknown = Matrix3::repeat(Complex::new(f64::NAN, f64::NAN));
    inputs
        .try_inverse()
        .map_or(unknown, |inverse| outputs * inverse)
}

fn deviation(outputs: &Matrix3<f64>, inputs: &Matrix3<Complex<f64>>) -> Matrix3<f64> {
    let unknown = Matrix3::repeat(f64::NAN);
    inputs.try_inverse().map_or(unknown, |inverse| {
        let squares = outputs.component_mul(outputs) * inverse.map(|value| value.norm_sqr());
        squares.map(f64::sqrt)
    })
}
