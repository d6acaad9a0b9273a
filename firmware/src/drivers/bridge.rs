//! Phase/enable H-bridge: a PWM, a direction, a sleep and a fault pin.
//!
//! PWM low brakes (both low sides on), so a duty of zero holds the motor by its own back-EMF; only sleep low lets it
//! coast.

use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal::pwm::SetDutyCycle;

/// A signed duty in counts of the PWM: the sign is the direction pin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Duty(pub i16);

/// What failed while driving the bridge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BridgeError<P, O> {
    /// The PWM.
    Pwm(P),
    /// The direction or the sleep pin.
    Pin(O),
}

/// One bridge.
pub struct Bridge<P, D, S, F> {
    pwm: P,
    direction: D,
    sleep: S,
    fault: F,
}

impl<P, D, S, F, O> Bridge<P, D, S, F>
where
    P: SetDutyCycle,
    D: OutputPin<Error = O>,
    S: OutputPin<Error = O>,
    F: InputPin,
{
    /// Takes the pins and lets the motor coast.
    pub fn new(pwm: P, direction: D, sleep: S, fault: F) -> Result<Self, BridgeError<P::Error, O>> {
        let mut bridge = Self {
            pwm,
            direction,
            sleep,
            fault,
        };
        bridge.coast()?;
        Ok(bridge)
    }

    /// Drives with a duty, limited to what the PWM has; zero brakes.
    #[inline]
    pub fn drive(&mut self, duty: Duty) -> Result<(), BridgeError<P::Error, O>> {
        let counts = duty.0.unsigned_abs().min(self.pwm.max_duty_cycle());
        self.direction
            .set_state((duty.0 >= 0).into())
            .map_err(BridgeError::Pin)?;
        self.sleep.set_high().map_err(BridgeError::Pin)?;
        self.pwm.set_duty_cycle(counts).map_err(BridgeError::Pwm)
    }

    /// Shorts the motor.
    #[inline]
    pub fn brake(&mut self) -> Result<(), BridgeError<P::Error, O>> {
        self.drive(Duty(0))
    }

    /// Opens the bridge: the motor turns freely.
    #[inline]
    pub fn coast(&mut self) -> Result<(), BridgeError<P::Error, O>> {
        self.pwm.set_duty_cycle(0).map_err(BridgeError::Pwm)?;
        self.sleep.set_low().map_err(BridgeError::Pin)
    }

    /// Whether the bridge reports a fault (pin low).
    #[inline]
    pub fn reports_fault(&mut self) -> Result<bool, F::Error> {
        self.fault.is_low()
    }
}
