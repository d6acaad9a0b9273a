//! What a tick offers at its end.

use crate::drivers::bridge::Duty;
use crate::fault::FaultKind;
use crate::mode::Mode;
use crate::motion::Setpoint;
use kinematics::Angle;

/// All that a tick computed.
#[derive(Clone, Debug)]
pub struct Sample {
    /// The tick.
    pub tick: u64,
    /// State of the supervisor.
    pub mode: Mode,
    /// The latched fault.
    pub fault: Option<FaultKind>,
    /// Setpoint of the platform.
    pub setpoint: Setpoint,
    /// Setpoint of the point that is moved: the platform's unless a centre of rotation has been chosen.
    pub reference_point: Setpoint,
    /// Setpoint of the pivots; the measured angles while the servo is off.
    pub pivot_setpoints: [Angle; 3],
    /// Their rates, rad/s.
    pub pivot_rates: [f32; 3],
    /// Measured pivots.
    pub pivots: [Angle; 3],
    /// Duties.
    pub duty: [Duty; 3],
    /// Motor currents, ADC counts.
    pub current_counts: [i16; 3],
    /// Supply, ADC counts.
    pub supply_counts: u16,
    /// What the tick before cost, cycles.
    pub tick_cycles: u32,
    /// Commands taken before this tick: those that it can have followed.
    pub commands: u32,
    /// One servo, another one in each tick, as it is at its end.
    pub servo: Option<ServoSample>,
}

/// What a servo has learnt and what its loop stands at.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ServoSample {
    /// Which pivot, 0 to 2.
    pub pivot: u8,
    /// Learnt weights besides the model's: V s/rad for the rate, V/(N m) for the torque, V for friction.
    pub weights: [f32; 3],
    /// What feedback has collected, V.
    pub integral_v: f32,
    /// The motor's current by the model, over the dead time's knee.
    pub current_knees: f32,
}

/// The servos, as they were last seen.
#[derive(Clone, Copy, Debug, Default)]
pub struct ServoSamples([ServoSample; 3]);

impl ServoSamples {
    /// Takes the one that a tick tells of.
    #[inline]
    pub fn update(&mut self, sample: &Sample) {
        if let Some(servo) = &sample.servo
            && let Some(own) = self.0.get_mut(usize::from(servo.pivot))
        {
            *own = *servo;
        }
    }

    /// One of them; nothing for a pivot that there is not.
    #[inline]
    pub fn of(&self, pivot: u8) -> ServoSample {
        (self.0.get(usize::from(pivot)).copied()).unwrap_or_default()
    }
}

/// Observes every tick. Runs inside it, or right behind it: no allocation, no blocking, no unbounded work.
pub trait TickObserver {
    /// Takes the sample of one tick.
    fn observe(&mut self, sample: &Sample);
}

impl TickObserver for () {
    #[inline]
    fn observe(&mut self, _: &Sample) {}
}
