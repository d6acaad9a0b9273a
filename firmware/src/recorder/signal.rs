//! What can be recorded: each signal of the data path as a 32-bit word, as the tick has it.

use super::sample::{Sample, ServoSamples};
use crate::motion::Position;
use kinematics::Angle;

/// A signal in the units of the tick. Pivots are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RawSignal {
    /// Setpoint of the platform's centre, x (0) or y (1).
    Centre(u8),
    /// Setpoint of theta.
    Theta,
    /// Velocity of the pose's setpoint: x, y (track radii/s), theta (rad/s).
    Velocity(u8),
    /// Its acceleration: x, y (track radii/s^2), theta (rad/s^2).
    Acceleration(u8),
    /// Setpoint of a pivot.
    PivotSetpoint(u8),
    /// Measured pivot.
    Pivot(u8),
    /// Measured pivot minus setpoint.
    PivotError(u8),
    /// Rate of a pivot's setpoint, rad/s.
    PivotRate(u8),
    /// Duty of a bridge, PWM counts.
    Duty(u8),
    /// A motor's current, ADC counts.
    Current(u8),
    /// Supply, ADC counts.
    Supply,
    /// The supervisor's [`Mode`](crate::mode::Mode): 0 off, 1 holding, 2 moving, 3 fault, 4 stopping at a fault, 5 excited.
    Mode,
    /// The latched [`FaultKind`](crate::fault::FaultKind), counted from 1; 0 for none.
    Fault,
    /// What the tick before cost, cycles.
    Cost,
    /// What a pivot's feedback has collected, V.
    Integral(u8),
    /// A motor's current by the model, over the dead time's knee.
    ModelCurrent(u8),
    /// What a servo has learnt of the rate besides the model's, V s/rad.
    LearntRate(u8),
    /// Of the torque, V/(N m).
    LearntTorque(u8),
    /// Of friction, V.
    LearntFriction(u8),
}

/// How a signal's 32 bits are to be understood.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignalFormat {
    /// A length in 2^-29 track radii (0.19 nm on a track of 100 mm).
    Length,
    /// An angle in 2^-28 turns (23 nrad, a quarter of an encoder count): 32 bits hold the 16 turns around the last
    /// row's.
    Angle,
    /// A small angle in 2^-32 turns.
    AngleError,
    /// A float.
    Float,
    /// An integer.
    Count,
}

impl RawSignal {
    /// How its bits are to be understood.
    pub const fn format(self) -> SignalFormat {
        match self {
            Self::Centre(_) => SignalFormat::Length,
            Self::Theta | Self::PivotSetpoint(_) | Self::Pivot(_) => SignalFormat::Angle,
            Self::PivotError(_) => SignalFormat::AngleError,
            Self::Velocity(_)
            | Self::Acceleration(_)
            | Self::PivotRate(_)
            | Self::Integral(_)
            | Self::ModelCurrent(_)
            | Self::LearntRate(_)
            | Self::LearntTorque(_)
            | Self::LearntFriction(_) => SignalFormat::Float,
            Self::Duty(_)
            | Self::Current(_)
            | Self::Supply
            | Self::Mode
            | Self::Fault
            | Self::Cost => SignalFormat::Count,
        }
    }

    /// Its value in a tick; the low 32 bits are what is stored. The bits of a float stand in the low 32.
    #[inline]
    pub(super) fn value(self, sample: &Sample, servos: &ServoSamples) -> i64 {
        let setpoint = &sample.setpoint;
        let (twist, acceleration) = (&setpoint.twist, &setpoint.acceleration);
        match self {
            Self::Centre(i) => length(&setpoint.position, i),
            Self::Theta => angle(Angle::from_units(setpoint.position[2])),
            Self::Velocity(i) => float(component(&[twist.x, twist.y, twist.theta], i)),
            Self::Acceleration(i) => float(component(
                &[acceleration.x, acceleration.y, acceleration.theta],
                i,
            )),
            Self::PivotSetpoint(i) => angle(component(&sample.pivot_setpoints, i)),
            Self::Pivot(i) => angle(component(&sample.pivots, i)),
            Self::PivotError(i) => {
                (component(&sample.pivots, i) - component(&sample.pivot_setpoints, i)).units()
            }
            Self::PivotRate(i) => float(component(&sample.pivot_rates, i)),
            Self::Duty(i) => i64::from(component(&sample.duty, i).0),
            Self::Current(i) => i64::from(component(&sample.current_counts, i)),
            Self::Supply => i64::from(sample.supply_counts),
            Self::Mode => sample.mode as i64,
            Self::Fault => sample.fault.map_or(0, |kind| kind as i64 + 1),
            Self::Cost => i64::from(sample.tick_cycles),
            Self::Integral(i) => float(servos.of(i).integral_v),
            Self::ModelCurrent(i) => float(servos.of(i).current_knees),
            Self::LearntRate(i) => float(servos.of(i).weights[0]),
            Self::LearntTorque(i) => float(servos.of(i).weights[1]),
            Self::LearntFriction(i) => float(servos.of(i).weights[2]),
        }
    }

    /// Its value in a tick as a number that orders as the signal does: what triggers compare.
    #[inline]
    pub(super) fn level(self, sample: &Sample, servos: &ServoSamples) -> i64 {
        let value = self.value(sample, servos);
        match self.format() {
            SignalFormat::Float => total_order_key(value as u32),
            _ => value,
        }
    }
}

/// The place of a float, given by its bits, in the order of all floats.
pub(super) const fn total_order_key(bits: u32) -> i64 {
    let signed = bits as i32;
    (signed ^ ((signed >> 31) & i32::MAX)) as i64
}

/// One of three; the last for whatever is too many, so that there is nothing to panic about.
#[inline]
fn component<T: Copy>(three: &[T; 3], i: u8) -> T {
    match i {
        0 => three[0],
        1 => three[1],
        _ => three[2],
    }
}

#[inline]
fn float(value: f32) -> i64 {
    i64::from(value.to_bits())
}

/// From 2^-32 turns to 2^-28, rounded to nearest.
#[inline]
fn angle(angle: Angle) -> i64 {
    angle.units().wrapping_add(8) >> 4
}

/// From 2^-32 track radii to 2^-29, rounded to nearest.
#[inline]
fn length(position: &Position, i: u8) -> i64 {
    component(position, i).wrapping_add(4) >> 3
}
