//! Friction and motor constants of the drives, from turning at steady rates both ways.
//!
//! At a steady rate the torque of the motor is friction, `K i = Tc sign(w) + b w`, and the voltage is `R i + K w + d s`, d being what the
//! dead time takes and s the mean share of it that counts. That is the sign of the current where this is large all the time; what friction and
//! gears make of it at a slow rate may be less, and more at a fast one: a share that is taken for whole is then taken for a motor constant.
//! So K is what is left of the volts for each rad/s when dead time and resistance have had their parts: a [`MotorConstant`] goes on to say what
//! it is as these become better known. A winding grows warm as it turns, and its resistance with it: at these rates it is what Coulomb's friction
//! says, whose volts are all resistance and dead time. An offset of the current's sensor is the same both ways and falls out. What is found is all that rubs between a motor and the platform where it turns: brushes, gear, ring. With the platform in
//! the middle the carriages stand still on their guides, and theirs is not in it; but while they do not slide they hold a torque between the
//! rings, so that a drive carries a part of another's friction: [`mean`] of the three is right, one alone is off by that.

use nalgebra::{Matrix3, Vector3};

/// A stretch at a steady rate, means over whole turns of the motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteadyRate {
    /// Of the ring, with its sign.
    pub rate_rad_s: f64,
    /// Of the current.
    pub current_a: f64,
    /// Of the voltage.
    pub volts: f64,
    /// Of the [share of the dead time](crate::dead_time::dead_time_share) that counts.
    pub dead_time_share: f64,
}

/// Least current of Coulomb's friction that tells of the resistance, A.
const LEAST_A: f64 = 0.03;

/// Motor constant of a drive as steady rates tell it: what each rad/s takes of the volts, less what the resistance takes of that.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MotorConstant {
    /// Volts for each rad/s of the ring, V s/rad.
    volts: f64,
    /// Current for each rad/s of the ring, A s/rad.
    current: f64,
    /// Volts that go with the whole dead time whatever the rate: what Coulomb's friction and the dead time take.
    coulomb_v: f64,
    /// The same of the current, A: with the whole dead time.
    coulomb_a: f64,
}

impl MotorConstant {
    /// Known whatever the resistance is, V s/rad.
    #[must_use]
    pub const fn known(v_s_rad: f64) -> Self {
        Self {
            volts: v_s_rad,
            current: 0.0,
            coulomb_v: 0.0,
            coulomb_a: 0.0,
        }
    }

    /// With a winding of a resistance, V s/rad.
    #[must_use]
    pub fn with(&self, resistance_ohm: f64) -> f64 {
        self.volts - resistance_ohm * self.current
    }

    /// Coefficients of the resistance, of itself and of the dead time's volts in an equation, and what they make. At these rates the resistance
    /// R' was another one than it is later: `current R' + K = volts` and `coulomb_a R' + d = coulomb_v`. Without friction R' is taken for R.
    pub(crate) fn equation(&self) -> ([f64; 3], f64) {
        if self.coulomb_a < LEAST_A {
            return ([self.current, 1.0, 0.0], self.volts);
        }
        let share = self.current / self.coulomb_a;
        ([0.0, 1.0, -share], self.volts - share * self.coulomb_v)
    }
}

/// Friction of a drive, seen at its ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// Torque at the ring for each ampere as well.
    pub motor_constant: MotorConstant,
    /// Coulomb friction.
    pub coulomb_n_m: f64,
    /// What grows with the rate.
    pub viscous_n_m_s: f64,
    /// Offset of the current's sensor.
    pub offset_a: f64,
    /// Volts that Coulomb friction and dead time take together.
    pub break_away_v: f64,
    /// Standard deviations of Coulomb friction and of what grows with the rate.
    pub deviations: [f64; 2],
    /// Root of the mean square of what is left, over the Coulomb friction.
    pub residual: f64,
}

/// Why there is no friction.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FrictionError {
    /// Not both ways, or too few rates.
    #[error("friction takes two rates or more each way; there are {forwards} and {backwards}")]
    TooFew {
        /// Rates forwards.
        forwards: usize,
        /// Rates backwards.
        backwards: usize,
    },
    /// Rates too near to each other.
    #[error(
        "the rates are too near to each other: let the largest be three times the smallest or more"
    )]
    TooNear,
    /// Faster with less voltage.
    #[error(
        "the ring turns against its voltage: look at the polarity of the bridge and the encoder's direction"
    )]
    AgainstTheVolts,
    /// Less than none.
    #[error(
        "friction of {coulomb_n_m:.3} N m: the current is against the motion; look at the polarity of current and encoder"
    )]
    Negative {
        /// As found.
        coulomb_n_m: f64,
    },
    /// Something else than friction.
    #[error(
        "currents differ by {percent} % of the friction from what friction would make of them: something catches, or the rates are not steady"
    )]
    Uneven {
        /// Of the Coulomb friction.
        percent: u32,
    },
}

/// More that is left than this share of the Coulomb friction is no friction.
pub const MOST_RESIDUAL: f64 = 0.1;
/// Largest rate over the smallest.
const LEAST_RANGE: f64 = 3.0;

/// Friction of a drive whose winding has a resistance.
///
/// # Errors
/// [`FrictionError`].
pub fn friction(steady: &[SteadyRate], resistance_ohm: f64) -> Result<Friction, FrictionError> {
    let forwards = steady.iter().filter(|one| one.rate_rad_s > 0.0).count();
    let backwards = steady.iter().filter(|one| one.rate_rad_s < 0.0).count();
    if forwards < 2 || backwards < 2 {
        return Err(FrictionError::TooFew {
            forwards,
            backwards,
        });
    }
    let sizes = steady.iter().map(|one| one.rate_rad_s.abs());
    let (least, most) = sizes.fold((f64::INFINITY, 0.0), |(least, most), size| {
        (f64::min(least, size), f64::max(most, size))
    });
    if !(most >= LEAST_RANGE * least) {
        return Err(FrictionError::TooNear);
    }
    let of = |value: fn(&SteadyRate) -> f64| {
        fit(steady, |one| one.dead_time_share, value).ok_or(FrictionError::TooNear)
    };
    let (volts, ..) = of(|one| one.volts)?;
    let (currents, ..) = of(|one| one.current_a)?;
    let motor_constant = MotorConstant {
        volts: volts.y,
        current: currents.y,
        coulomb_v: volts.x,
        coulomb_a: currents.x,
    };
    let torque_n_m_a = motor_constant.with(resistance_ohm);
    if !(torque_n_m_a > 0.0) {
        return Err(FrictionError::AgainstTheVolts);
    }
    let (numbers, deviations, left) = fit(
        steady,
        |one| one.rate_rad_s.signum(),
        |one| one.current_a * torque_n_m_a,
    )
    .ok_or(FrictionError::TooNear)?;
    let coulomb_n_m = numbers.x;
    if !(coulomb_n_m > 0.0) {
        return Err(FrictionError::Negative { coulomb_n_m });
    }
    let residual = left / coulomb_n_m;
    if residual > MOST_RESIDUAL {
        return Err(FrictionError::Uneven {
            percent: (100.0 * residual) as u32,
        });
    }
    Ok(Friction {
        motor_constant,
        coulomb_n_m,
        viscous_n_m_s: numbers.y,
        offset_a: numbers.z / torque_n_m_a,
        break_away_v: volts.x + resistance_ohm * (numbers.x / torque_n_m_a - currents.x),
        deviations: [deviations.x, deviations.y],
        residual,
    })
}

/// Coulomb friction (N m) and what grows with the rate (N m s/rad), of a drive in the mean of all three.
#[must_use]
pub fn mean(all: &[Friction; 3]) -> [f64; 2] {
    let third = |value: fn(&Friction) -> f64| all.iter().map(value).sum::<f64>() / 3.0;
    [third(|one| one.coulomb_n_m), third(|one| one.viscous_n_m_s)]
}

impl Friction {
    /// All of it at a rate, N m.
    #[must_use]
    pub fn at(&self, rate_rad_s: f64) -> f64 {
        self.coulomb_n_m * rate_rad_s.signum() + self.viscous_n_m_s * rate_rad_s
    }
}

/// A sign, the rate and 1 to a value, by least squares; deviations and what is left.
fn fit(
    steady: &[SteadyRate],
    sign: impl Fn(&SteadyRate) -> f64,
    value: impl Fn(&SteadyRate) -> f64,
) -> Option<(Vector3<f64>, Vector3<f64>, f64)> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    let row = |one: &SteadyRate| Vector3::new(sign(one), one.rate_rad_s, 1.0);
    for one in steady {
        normal += row(one) * row(one).transpose();
        right += row(one) * value(one);
    }
    let inverse = normal.try_inverse()?;
    let numbers = inverse * right;
    let square: f64 = steady
        .iter()
        .map(|one| (value(one) - row(one).dot(&numbers)).powi(2))
        .sum();
    let variance = square / (steady.len() as f64 - 3.0).max(1.0);
    let deviations = inverse.diagonal().map(|d| (d.max(0.0) * variance).sqrt());
    Some((numbers, deviations, (square / steady.len() as f64).sqrt()))
}
