//! Cyclic errors of the gears, from turning at steady rates both ways.
//!
//! With the ring at phi the motor stands `d = A sin(n phi + a)` further on, n the gear ratio, all seen at the ring; rings are off the steady rate by
//! what their encoders show, and ask for torque with the platform that they carry. At a rate w, of what varies once a turn of the motor (complex
//! amplitudes over the angle of the ring, K the motor constant, Jm the inertia of the motor with its side of the gear):
//!
//! ```text
//! K I = -(n w)^2 (M E + Jm D) + F sign(w) + k E
//! ```
//!
//! F is friction that is uneven and what the gear passes on of the friction behind it: it has the sign of the rate, and falls out both ways. k is the
//! spring of carriages that do not slide in so small a motion: a platform that turns in its middle leaves them where they are. Rings that hardly
//! move do not tell it from D, and leave it none ([`TELLS_RAD`]). The back-EMF would tell D without Jm, but currents that swing about those below
//! which a bridge's dead time takes less than all leave too little of it.

use core::f64::consts::TAU;

use nalgebra::{Complex, DMatrix, DVector};

/// What varies once a turn of the motor, at a steady rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turning {
    /// Of the ring, with its sign.
    pub rate_rad_s: f64,
    /// Of the current.
    pub current_a: Complex<f64>,
    /// What the rings are off a steady motion, as far as inertias ask for torque at this one: M E, kg m^2 rad.
    pub moved: Complex<f64>,
    /// What this ring is off it, rad: E.
    pub ring: Complex<f64>,
}

/// What is known of a drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Turns of the motor in a turn of the ring.
    pub ratio: f64,
    /// Torque at the ring for each ampere, N m/A.
    pub motor_constant: f64,
    /// Of the motor with its side of the gear, seen at the ring.
    pub motor_inertia_kg_m2: f64,
}

/// A gear's cyclic error, as found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gear {
    /// rad at the ring; as much off as the motor's inertia.
    pub amplitude_rad: f64,
    /// One standard deviation of what is found beside an inertia that is right.
    pub deviation_rad: f64,
    /// Of a sine, at pivot angle 0.
    pub phase_rad: f64,
}

/// Why there is no gear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GearError {
    /// Not both ways, or no turn of the motor.
    #[error("a gear takes records both ways, and of a turn of the motor or more")]
    TooFew,
}

/// What varies once a turn of the motor: amplitude of a cosine, less j times that of a sine, of the angle of the ring; a line is taken away. Rows count
/// by a Hann window, so that what varies more slowly or faster does not count.
///
/// # Errors
/// [`GearError::TooFew`]: the rows are no turn of the motor.
pub fn once_a_turn(
    values: &[f64],
    angles_rad: &[f64],
    ratio: f64,
) -> Result<Complex<f64>, GearError> {
    let count = values.len().min(angles_rad.len());
    let along = |row: usize| (row as f64 + 0.5) / count as f64;
    let window = |row: usize| 1.0 - (TAU * along(row)).cos();
    let rows = DMatrix::from_fn(count, 4, |row, column| {
        let (sin, cos) = (ratio * angles_rad[row]).sin_cos();
        window(row) * [1.0, along(row) - 0.5, cos, sin][column]
    });
    let values = DVector::from_fn(count, |row, _| window(row) * values[row]);
    let (at, _) = fitted(&rows, &values)?;
    Ok(Complex::new(at[2], -at[3]))
}

/// So much of a ring's motion that shows no spring stands beside what was recorded, rad: those that move less tell of none.
const TELLS_RAD: f64 = 2.5e-6;

/// A gear from what was recorded at steady rates.
///
/// # Errors
/// [`GearError::TooFew`].
pub fn gear(turnings: &[Turning], known: &Known) -> Result<Gear, GearError> {
    let ways = [1.0, -1.0].map(|way| turnings.iter().any(|one| one.rate_rad_s * way > 0.0));
    if ways != [true; 2] {
        return Err(GearError::TooFew);
    }
    // Real and imaginary parts of each record; unknown: those of D and of F, and k.
    let square = |one: &Turning| -(known.ratio * one.rate_rad_s).powi(2);
    let rows = DMatrix::from_fn(2 * turnings.len() + 1, 5, |row, column| {
        let Some(one) = turnings.get(row / 2) else {
            return if column == 4 { TELLS_RAD } else { 0.0 };
        };
        match column == row % 2 {
            true => known.motor_inertia_kg_m2 * square(one),
            false if column == 2 + row % 2 => one.rate_rad_s.signum(),
            false if column == 4 => [one.ring.re, one.ring.im][row % 2],
            false => 0.0,
        }
    });
    let torques = DVector::from_fn(2 * turnings.len() + 1, |row, _| {
        let Some(one) = turnings.get(row / 2) else {
            return 0.0;
        };
        let left = one.current_a * known.motor_constant - one.moved * square(one);
        if row % 2 == 0 { left.re } else { left.im }
    });
    let (at, deviations) = fitted(&rows, &torques)?;
    // A sin(x + a) has the amplitude -j A e^(j a).
    let (amplitude_rad, phase_rad) = (Complex::new(at[0], at[1]) * Complex::i()).to_polar();
    Ok(Gear {
        amplitude_rad,
        deviation_rad: deviations[0].hypot(deviations[1]),
        phase_rad,
    })
}

/// Unknowns and their deviations, by what is left.
fn fitted(
    rows: &DMatrix<f64>,
    values: &DVector<f64>,
) -> Result<(DVector<f64>, DVector<f64>), GearError> {
    let free = rows.nrows().saturating_sub(rows.ncols()).max(1);
    let inverse = rows.tr_mul(rows).try_inverse().ok_or(GearError::TooFew)?;
    let at = &inverse * rows.tr_mul(values);
    let variance = (values - rows * &at).norm_squared() / free as f64;
    let deviations = inverse.diagonal().map(|share| (share * variance).sqrt());
    Ok((at, deviations))
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOWN: Known = Known {
        ratio: 50.0,
        motor_constant: 4.1,
        motor_inertia_kg_m2: 0.014,
    };
    const ERROR_RAD: (f64, f64) = (150e-6, 2.1);

    /// What a drive with such a gear would be recorded as, whose ring is off a steady motion.
    fn turning(rate_rad_s: f64, friction: Complex<f64>, stuck_n_m_rad: f64) -> Turning {
        let square = -(KNOWN.ratio * rate_rad_s).powi(2);
        let error: Complex<f64> =
            -Complex::<f64>::i() * Complex::from_polar(ERROR_RAD.0, ERROR_RAD.1);
        let moved = Complex::new(3e-7, -2e-7);
        let ring = Complex::new(5e-6 * rate_rad_s, -2e-6);
        let torque = (moved + error * KNOWN.motor_inertia_kg_m2) * square
            + friction * rate_rad_s.signum()
            + ring * stuck_n_m_rad;
        Turning {
            rate_rad_s,
            current_a: torque / KNOWN.motor_constant,
            moved,
            ring,
        }
    }

    #[test]
    fn a_gear_is_found_beside_uneven_friction() {
        let friction = Complex::new(0.01, 0.004);
        let all = [3.0, -3.0, 1.5, -1.5].map(|rate| turning(rate, friction, 0.0));
        let found = gear(&all, &KNOWN).expect("both ways");
        let is = |value: f64, wanted: f64| (value / wanted - 1.0).abs() < 1e-9;
        assert!(is(found.amplitude_rad, ERROR_RAD.0) && is(found.phase_rad, ERROR_RAD.1));
        assert!(found.deviation_rad < 1e-12);
        assert_eq!(gear(&all[..1], &KNOWN), Err(GearError::TooFew));
    }

    /// Rings that move by some times what tells of a spring leave 0.02 and 0.05 % of it in the gear, which had 0.25 and 0.5 %.
    #[test]
    fn carriages_that_do_not_slide_are_no_part_of_a_gear() {
        let friction = Complex::new(0.01, 0.004);
        let off = |stuck_n_m_rad: f64| {
            let all = [3.0, -3.0, 1.5, -1.5].map(|rate| turning(rate, friction, stuck_n_m_rad));
            let found = gear(&all, &KNOWN).expect("both ways");
            found.amplitude_rad / ERROR_RAD.0 - 1.0
        };
        let off = [100.0, 200.0].map(off);
        println!("{off:?}");
        assert!(off[0].abs() < 0.00026 && off[1].abs() < 0.00052);
    }

    /// Rings that are held still move by a tenth of a microradian, by the gear and by what else there is: that tells of no spring. Friction
    /// differs by a milli-newton metre from record to record.
    #[test]
    fn rings_that_hardly_move_leave_the_gear_as_it_is() {
        let rates = [3.0, -3.0, 1.5, -1.5, 3.0, -3.0];
        let differs = [1.0, 0.3, -0.8, 0.5, -0.2, -0.9];
        let all = std::array::from_fn::<_, 6, _>(|k| {
            let one = turning(rates[k], Complex::from(0.01), 0.0);
            let ring = Complex::from_polar(1e-7 * (rates[k] / 3.0).powi(2), ERROR_RAD.1);
            Turning {
                current_a: one.current_a + 1e-3 * differs[k] / KNOWN.motor_constant,
                ring: -Complex::<f64>::i() * ring + 2e-8 * differs[5 - k],
                ..one
            }
        });
        let found = gear(&all, &KNOWN).expect("both ways");
        let off = found.amplitude_rad / ERROR_RAD.0 - 1.0;
        println!("{off}");
        assert!(off.abs() < 0.0006);
    }

    #[test]
    fn what_varies_once_a_turn_is_told_from_what_varies_otherwise() {
        let angles_rad: Vec<f64> = (0..500).map(|row| 0.3 + 4e-3 * f64::from(row)).collect();
        let values = angles_rad.iter().map(|angle| {
            2.0 + 0.7 * angle + 0.1 * (50.0 * angle + 0.4).sin() + 0.1 * (12.0 * angle).cos()
        });
        let found = once_a_turn(&values.collect::<Vec<_>>(), &angles_rad, 50.0).expect("turns");
        let (amplitude, phase) = (found * Complex::i()).to_polar();
        assert!((amplitude - 0.1).abs() < 1e-3 && (phase - 0.4).abs() < 1e-2);
    }
}
