//! Winding and motor constant of a drive, from what is recorded of it while it moves: no mechanics in it.
//!
//! At every bin of every period, excited or not, `U = R I + j w L I + j w K Phi + d F`: linear in resistance, inductance, motor constant
//! and the voltage that the bridge's dead time takes. F is the spectrum of the current's sign, which the record gives (1 from the knee on,
//! less in proportion below; [`crate::dead_time`]). At excited bins F is like I, and d could not be told from R; what the dead time makes of a
//! current that crosses zero is in all the others.
//!
//! Only records in which the drive itself was excited are used. In the others its current is what friction and the other drives leave it, at most
//! bins less than the sensor's noise, which makes I and F come out larger than they are: d is then too small, and R too large.
//!
//! The back-EMF is the motor's and the encoder is the ring's. Between them is the transmission, which winds up by the torque that it passes on:
//! `pm = (z p + K i) / (z + Jm s^2)`. So the mechanics, once found, go in; bins at which the motor swings on the spring by itself are left out.
//!
//! Voltage is a step a tick, so it has images beside each multiple of the tick's rate; what of the current they make is sampled into the
//! bins. That part is computed with the winding as found, and taken away.

use super::DriveError;
use crate::chain::Chain;
use crate::dead_time::{Lost, lost};
use crate::frequency_response::{Run, hold};
use crate::friction::MotorConstant;
use crate::record::{Signals, Timing};
use crate::spectrum::spectrum;
use nalgebra::{Complex, Matrix4, Vector4};
use std::f64::consts::TAU;

/// Winding and motor of one drive, seen at its ring, as the controller's own meters see them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Electrical {
    /// Of winding, brushes and bridge as warm as they were, ohm.
    pub resistance_ohm: f64,
    /// H.
    pub inductance_h: f64,
    /// Back-EMF for each rad/s of the ring, V s/rad: torque at the ring for each ampere, N m/A. Torque constant times gear ratio.
    pub motor_constant: f64,
    /// What the bridge's dead time takes, V.
    pub dead_time_v: f64,
    /// Standard deviations of the four, in this order.
    pub deviations: [f64; 4],
}

/// What copper's resistance gains with each kelvin, over itself.
pub const COPPER_1_K: f64 = 0.0039;
/// How much warmer than while it was identified a winding may be at work, K; and how much colder after a rest, as identification warms it.
const AT_WORK_K: f64 = 60.0;
const RESTED_K: f64 = 8.0;

impl Electrical {
    /// With its winding as warm as it may be at work.
    #[must_use]
    pub fn at_work(&self) -> Self {
        self.warmer(AT_WORK_K)
    }

    /// With its winding as cold as it may be after a rest.
    #[must_use]
    pub fn rested(&self) -> Self {
        self.warmer(-RESTED_K)
    }

    fn warmer(&self, by_k: f64) -> Self {
        Self {
            resistance_ohm: self.resistance_ohm * (1.0 + COPPER_1_K * by_k),
            ..*self
        }
    }
}

/// Bins that are used, Hz: below, errors of gear and commutator are; above, the encoder's noise is all there is.
const BAND_HZ: [f64; 2] = [15.0, 4_000.0];
/// Images on either side.
const IMAGES: i32 = 60;
/// Bands, equal by their logarithm, in which residuals are of one size.
const BANDS: usize = 24;
const ROUNDS: usize = 5;
/// What a number that is known weighs more than all that is measured of it.
const SURE: f64 = 1e6;
/// Multiples of its own size, over a normal one's median, at which a residual counts half.
const HALF_AT: f64 = 2.0;

#[derive(Clone)]
struct Row {
    hz: f64,
    /// Of the commanded voltage without its hold: what the images are made of.
    told: Complex<f64>,
    volts: Complex<f64>,
    current: Complex<f64>,
    rate: Complex<f64>,
    lost: Complex<f64>,
    weight: f64,
}

/// What is recorded of a drive, as rows of the equation.
pub struct Equations {
    rows: Vec<Row>,
    pivot: usize,
}

/// What is known of a drive besides.
#[derive(Clone, Copy, Debug, Default)]
pub struct Besides<'a> {
    /// Its motor constant, from steady rates: then it is what these say with the dead time that is found; with the resistance, where friction takes
    /// next to no current.
    pub motor_constant: MotorConstant,
    /// Inertia of the motor, transmission and motor constant, as far as they are known; without, the motor is taken to turn as its ring does.
    pub mechanics: Option<(&'a Chain, f64)>,
}

impl Equations {
    /// Of pivot `pivot` (0 to 2) from all runs in which it was excited. `knee_a`: current from which the whole dead time counts.
    ///
    /// # Errors
    /// [`DriveError::NotRecorded`].
    pub fn new(
        runs: &[Run],
        timing: &Timing,
        pivot: usize,
        knee_a: f64,
    ) -> Result<Self, DriveError> {
        let mut rows = Vec::new();
        for run in runs {
            for record in &run.experiments[pivot] {
                add_rows(&record.pivots[pivot], run, timing, knee_a, &mut rows);
            }
        }
        if rows.is_empty() {
            return Err(DriveError::NotRecorded { pivot: pivot + 1 });
        }
        Ok(Self { rows, pivot })
    }
}

/// Winding and motor constant of a drive.
///
/// # Errors
/// [`DriveError`].
pub fn electrical(
    equations: &Equations,
    timing: &Timing,
    besides: &Besides<'_>,
) -> Result<Electrical, DriveError> {
    let pivot = equations.pivot + 1;
    let mut rows = equations.rows.clone();
    if let Some((chain, motor_constant)) = besides.mechanics {
        rows.retain_mut(|row| row.take_motor(chain, motor_constant));
    }
    let mut found = solve_with(&rows, besides.motor_constant, |_| Complex::default());
    for _ in 0..ROUNDS {
        let winding = found.map(|(numbers, _)| [numbers[0], numbers[1]]);
        let winding = winding.ok_or(DriveError::NoMotion { pivot })?;
        weigh(&mut rows, &found, timing, winding);
        found = solve_without_images(&rows, besides.motor_constant, timing, winding);
    }
    let (numbers, deviations) = found.ok_or(DriveError::NoMotion { pivot })?;
    let [resistance_ohm, inductance_h, motor_constant, dead_time_v] = numbers.into();
    if !(resistance_ohm > 0.0 && inductance_h > 0.0 && motor_constant > 0.0) {
        return Err(DriveError::Senseless { pivot });
    }
    Ok(Electrical {
        resistance_ohm,
        inductance_h,
        motor_constant,
        dead_time_v,
        deviations: deviations.into(),
    })
}

fn add_rows(signals: &Signals, run: &Run, timing: &Timing, knee_a: f64, rows: &mut Vec<Row>) {
    let period = run.period_rows();
    let Some(ticks) = signals.ticks() else { return };
    let bin_hz = 1.0 / (run.period_ticks as f64 * timing.tick_s);
    let bins = BAND_HZ.map(|hz| (hz / bin_hz).ceil() as usize);
    let Lost { shares, per_row } = lost(&signals.current_a, run.ticks_per_row, knee_a);
    let mut from = 0;
    while from + period <= ticks {
        let part = from..from + period;
        let [volts, current, angle] = [&signals.volts, &signals.current_a, &signals.angle_rad]
            .map(|all| spectrum(&all[part.clone()]));
        let lost = spectrum(&shares[per_row * part.start..per_row * part.end]);
        for bin in bins[0]..bins[1].min(period / 2) {
            let hz = bin as f64 * bin_hz;
            let sampled = |offset_s: f64| Complex::cis(-TAU * hz * offset_s);
            rows.push(Row {
                hz,
                told: volts[bin],
                volts: volts[bin] * hold(hz, timing),
                current: current[bin] * sampled(timing.current_s),
                rate: angle[bin] * sampled(timing.angle_s) * Complex::new(0.0, TAU * hz),
                lost: lost[bin] * sampled(timing.current_s),
                weight: 1.0 / hz,
            });
        }
        from += period;
    }
}

type Found = Option<(Vector4<f64>, Vector4<f64>)>;

impl Row {
    /// Puts the motor's rate in the ring's place; false where that cannot be told.
    fn take_motor(&mut self, chain: &Chain, motor_constant: f64) -> bool {
        let motor = chain.motor_rate(self.hz, self.rate, motor_constant * self.current);
        self.rate = motor.unwrap_or(self.rate);
        motor.is_some()
    }

    /// Coefficients of the four numbers, with a current that has so much less for each volt told.
    fn coefficients(&self, image_a_v: Complex<f64>) -> [Complex<f64>; 4] {
        let current = self.current - self.told * image_a_v;
        [
            current,
            current * Complex::new(0.0, TAU * self.hz),
            self.rate,
            self.lost,
        ]
    }
}

/// What the images of a volt told make of the current's samples at a frequency, A/V.
fn images(hz: f64, timing: &Timing, [resistance_ohm, inductance_h]: [f64; 2]) -> Complex<f64> {
    if resistance_ohm == 0.0 && inductance_h == 0.0 {
        return Complex::default();
    }
    let sum: Complex<f64> = (-IMAGES..=IMAGES)
        .filter(|&image| image != 0)
        .map(|image| {
            let shift_hz = f64::from(image) / timing.tick_s;
            let image_hz = hz + shift_hz;
            let impedance = Complex::new(resistance_ohm, TAU * image_hz * inductance_h);
            hold(image_hz, timing) * Complex::cis(TAU * shift_hz * timing.current_s) / impedance
        })
        .sum();
    sum
}

fn solve_without_images(
    rows: &[Row],
    constant: MotorConstant,
    timing: &Timing,
    winding: [f64; 2],
) -> Found {
    let mut cache = std::collections::HashMap::new();
    let images: Vec<_> = rows
        .iter()
        .map(|row| {
            *cache
                .entry(row.hz.to_bits())
                .or_insert_with(|| images(row.hz, timing, winding))
        })
        .collect();
    solve_with(rows, constant, |k| images[k])
}

fn solve_with(
    rows: &[Row],
    constant: MotorConstant,
    image: impl Fn(usize) -> Complex<f64>,
) -> Found {
    let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
    let (mut square, mut weights) = (0.0, 0.0);
    for (k, row) in rows.iter().enumerate() {
        let coefficients = row.coefficients(image(k));
        for (i, a) in coefficients.iter().enumerate() {
            right[i] += row.weight * (a.conj() * row.volts).re;
            for (j, b) in coefficients.iter().enumerate() {
                normal[(i, j)] += row.weight * (a.conj() * b).re;
            }
        }
    }
    let ([of_resistance, of_constant, of_lost], volts) = constant.equation();
    let sure = SURE * normal[(2, 2)];
    let row = Vector4::new(of_resistance, 0.0, of_constant, of_lost);
    normal += sure * row * row.transpose();
    right += sure * volts * row;
    // Each in its own size, so that the inverse is one of likes.
    let scale = normal.diagonal().map(|d: f64| 1.0 / d.sqrt());
    let scaled = Matrix4::from_diagonal(&scale) * normal * Matrix4::from_diagonal(&scale);
    let inverse = scaled.try_inverse()?;
    let numbers = (inverse * right.component_mul(&scale)).component_mul(&scale);
    for (k, row) in rows.iter().enumerate() {
        square += row.weight * row.residual(&numbers, image(k)).norm_sqr();
        weights += 1.0;
    }
    let variance = 0.5 * square / f64::max(weights - 4.0, 1.0);
    let deviations = inverse
        .diagonal()
        .map(|d| (d.max(0.0) * variance).sqrt())
        .component_mul(&scale);
    numbers
        .iter()
        .all(|number| number.is_finite())
        .then_some((numbers, deviations))
}

impl Row {
    fn residual(&self, numbers: &Vector4<f64>, image_a_v: Complex<f64>) -> Complex<f64> {
        let said: Complex<f64> = (self.coefficients(image_a_v).iter())
            .zip(numbers.iter())
            .map(|(a, &number)| a * number)
            .sum();
        self.volts - said
    }
}

/// Weights by the size that residuals have in each band, and less for those that stand out: a commutator's ripple is a line.
fn weigh(rows: &mut [Row], found: &Found, timing: &Timing, winding: [f64; 2]) {
    let Some((numbers, _)) = found else { return };
    let band = |hz: f64| {
        (((hz / BAND_HZ[0]).ln() / (BAND_HZ[1] / BAND_HZ[0]).ln() * BANDS as f64) as usize)
            .min(BANDS - 1)
    };
    let mut cache = std::collections::HashMap::new();
    let sizes: Vec<f64> = rows
        .iter()
        .map(|row| {
            let image = *cache
                .entry(row.hz.to_bits())
                .or_insert_with(|| images(row.hz, timing, winding));
            row.residual(numbers, image).norm()
        })
        .collect();
    let mut by_band: Vec<Vec<f64>> = vec![Vec::new(); BANDS];
    for (row, size) in rows.iter().zip(&sizes) {
        by_band[band(row.hz)].push(*size);
    }
    let medians: Vec<f64> = by_band
        .iter_mut()
        .map(|sizes| {
            sizes.sort_by(f64::total_cmp);
            sizes.get(sizes.len() / 2).copied().unwrap_or(1.0).max(1e-9)
        })
        .collect();
    for (row, size) in rows.iter_mut().zip(sizes) {
        let median = medians[band(row.hz)];
        let over = size / (HALF_AT * median);
        row.weight = 1.0 / (median * median * (1.0 + over * over));
    }
}
