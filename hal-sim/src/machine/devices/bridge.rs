//! One phase/enable H-bridge: PWM, direction and sleep in, fault out, a voltage at the motor.
//!
//! PWM high drives the motor in the direction of the phase pin, PWM low brakes it (both low sides on), sleep low opens
//! all switches. [`BridgePins`] are the firmware's side of a [`Bridge`]; [`BridgeState`] is the same as plain data, for
//! a front that reads pulses and levels off an emulated chip.

use serde::{Deserialize, Serialize};
use std::cell::Cell;
use std::convert::Infallible;
use std::rc::Rc;

use embedded_hal::digital::{self, InputPin, OutputPin};
use embedded_hal::pwm::{self, SetDutyCycle};

use super::bridge_heat::BridgeHeat;
use crate::machine::plant::Drive;
use firmware::drivers::power_stage::BRIDGE;

/// Counts of the reference stage's PWM: 168 MHz over 40 kHz.
pub const MAX_DUTY: u16 = 4200;
/// Counts of a PWM whose quantisation is switched off: as fine as a signed 16-bit duty can be.
pub const FINE_PWM: u16 = 32_000;

/// What a bridge is made like.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BridgeParameters {
    /// Supply, V. A stage puts the plant's here.
    #[serde(skip, default = "reference_supply_v")]
    pub supply_v: f64,
    /// PWM frequency, Hz.
    pub pwm_hz: f64,
    /// Dead time of the switching leg, s; zero switches its effect off.
    pub dead_time_s: f64,
    /// Current at which it opens all switches and pulls its fault pin, until it has slept, A.
    pub trip_a: f64,
    /// Time from its sleep pin to its first pulse, s.
    pub wake_s: f64,
    /// How it becomes warm.
    pub heat: BridgeHeat,
    /// Current from which the whole dead time counts, A. Below, the PWM's current ripple crosses zero within the
    /// period and part of the loss turns into gain.
    pub dead_time_knee_a: f64,
}

impl BridgeParameters {
    /// 48 V and 40 kHz of the reference stage; 200 ns dead time is what makers of such bridges state, and the knee is
    /// a tenth of the largest ripple (48 V / (4 * 0.7 mH * 40 kHz) = 0.43 A), since near rest the pulses are short. Trip and wake-up are
    /// those of the part that the board has.
    pub const REFERENCE: Self = Self {
        supply_v: 48.0,
        pwm_hz: 40e3,
        dead_time_s: 200e-9,
        dead_time_knee_a: 0.043,
        trip_a: BRIDGE.trip_a,
        wake_s: BRIDGE.wake_s,
        heat: BridgeHeat::REFERENCE,
    };
}

const fn reference_supply_v() -> f64 {
    BridgeParameters::REFERENCE.supply_v
}

/// What the pins of one bridge say.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BridgeState {
    /// Part of the PWM period that the enable pin is high, 0 to 1.
    pub pulse: f64,
    /// Direction pin high: positive voltage.
    pub forward: bool,
    /// Sleep pin high: the bridge is awake.
    pub awake: bool,
    /// The bridge has switched itself off and pulls its fault pin low.
    pub fault: bool,
}

impl BridgeState {
    /// All pins low, as a chip in reset leaves them: asleep.
    pub const RESET: Self = Self {
        pulse: 0.0,
        forward: false,
        awake: false,
        fault: false,
    };

    /// What it does to a motor that carries this current, averaged over a PWM period.
    #[must_use]
    pub fn drive(&self, parameters: &BridgeParameters, current_a: f64) -> Drive {
        if !self.awake || self.fault {
            return Drive::Coast;
        }
        if self.pulse <= 0.0 {
            return Drive::Brake;
        }
        let sign = if self.forward { 1.0 } else { -1.0 };
        let volts = sign * self.pulse.min(1.0) * parameters.supply_v;
        Drive::Voltage(volts - self.dead_time_loss(parameters, current_a))
    }

    /// What it draws from the bus for a motor that carries this current, A; less than 0: gives back.
    #[must_use]
    pub fn drawn_a(&self, current_a: f64) -> f64 {
        if !self.awake || self.fault {
            // Through the diodes.
            return -current_a.abs();
        }
        let sign = if self.forward { 1.0 } else { -1.0 };
        sign * self.pulse.clamp(0.0, 1.0) * current_a
    }

    /// What the current has more than its mean at a time after the beginning of a PWM period, A: it rises from the edge on while
    /// the pulse lasts, and falls until the next.
    #[must_use]
    pub fn ripple_a(&self, parameters: &BridgeParameters, inductance_h: f64, at_s: f64) -> f64 {
        if !self.awake || self.fault {
            return 0.0;
        }
        let pulse = self.pulse.clamp(0.0, 1.0);
        let part = (at_s * parameters.pwm_hz).fract();
        let share = if part < pulse {
            (1.0 - pulse) * (part - 0.5 * pulse)
        } else {
            pulse * (0.5 * (1.0 + pulse) - part)
        };
        let sign = if self.forward { 1.0 } else { -1.0 };
        sign * share * parameters.supply_v / (inductance_h * parameters.pwm_hz)
    }

    /// What is lost in it while a motor carries this current, W: in the two switches that carry it, whether it drives or brakes, and at the
    /// two edges of a period, half of voltage times current each. While it is off the current dies in its diodes within a millisecond, which hardly warms it.
    #[must_use]
    pub fn lost_w(&self, parameters: &BridgeParameters, current_a: f64) -> f64 {
        if !self.awake || self.fault {
            return 0.0;
        }
        let heat = &parameters.heat;
        let is_switched = self.pulse > 0.0 && self.pulse < 1.0;
        let edges_j = if is_switched {
            parameters.supply_v * current_a.abs() * heat.edge_s
        } else {
            0.0
        };
        heat.resistance_ohm * current_a * current_a + edges_j * parameters.pwm_hz
    }

    /// While both switches of a leg are off, a diode carries the current and the leg lies on the wrong rail.
    fn dead_time_loss(&self, parameters: &BridgeParameters, current_a: f64) -> f64 {
        if self.pulse >= 1.0 {
            return 0.0;
        }
        // A pulse shorter than the dead time is swallowed whole, no more.
        let lost = (parameters.dead_time_s * parameters.pwm_hz).min(self.pulse);
        let direction = (current_a / parameters.dead_time_knee_a).clamp(-1.0, 1.0);
        lost * parameters.supply_v * direction
    }
}

/// The plant's side of one bridge on the host.
#[derive(Debug)]
pub struct Bridge(Rc<Cell<BridgeState>>);

/// The firmware's side of one bridge on the host, one object a pin.
#[derive(Debug)]
pub struct BridgePins {
    /// Enable pin, on a PWM channel.
    pub pwm: PwmPin,
    /// Phase pin.
    pub direction: DirectionPin,
    /// Sleep pin, active low.
    pub sleep: SleepPin,
    /// Fault pin, active low.
    pub fault: FaultPin,
}

/// A PWM channel.
#[derive(Debug)]
pub struct PwmPin {
    shared: Rc<Cell<BridgeState>>,
    counts: u16,
}

/// The phase pin.
#[derive(Debug)]
pub struct DirectionPin(Rc<Cell<BridgeState>>);

/// The sleep pin.
#[derive(Debug)]
pub struct SleepPin(Rc<Cell<BridgeState>>);

/// The fault pin.
#[derive(Debug)]
pub struct FaultPin(Rc<Cell<BridgeState>>);

impl Bridge {
    /// A bridge in reset, and its pins; the PWM has [`MAX_DUTY`] counts.
    #[must_use]
    pub fn new() -> (Self, BridgePins) {
        Self::with_pwm_counts(MAX_DUTY)
    }

    /// A bridge in reset, and its pins, with so many counts in a period of the PWM.
    #[must_use]
    pub fn with_pwm_counts(counts: u16) -> (Self, BridgePins) {
        let shared = Rc::new(Cell::new(BridgeState::RESET));
        let pins = BridgePins {
            pwm: PwmPin {
                shared: Rc::clone(&shared),
                counts,
            },
            direction: DirectionPin(Rc::clone(&shared)),
            sleep: SleepPin(Rc::clone(&shared)),
            fault: FaultPin(Rc::clone(&shared)),
        };
        (Self(shared), pins)
    }

    /// What the pins say now.
    #[must_use]
    pub fn state(&self) -> BridgeState {
        self.0.get()
    }

    /// Lets the bridge switch itself off (over-current, over-temperature), or recover.
    pub fn set_fault(&self, fault: bool) {
        change(&self.0, |state| state.fault = fault);
    }
}

fn change(shared: &Cell<BridgeState>, edit: impl FnOnce(&mut BridgeState)) {
    let mut state = shared.get();
    edit(&mut state);
    shared.set(state);
}

impl pwm::ErrorType for PwmPin {
    type Error = Infallible;
}

impl SetDutyCycle for PwmPin {
    fn max_duty_cycle(&self) -> u16 {
        self.counts
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        let pulse = f64::from(duty.min(self.counts)) / f64::from(self.counts);
        change(&self.shared, |state| state.pulse = pulse);
        Ok(())
    }
}

impl digital::ErrorType for DirectionPin {
    type Error = Infallible;
}

impl OutputPin for DirectionPin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        change(&self.0, |state| state.forward = false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        change(&self.0, |state| state.forward = true);
        Ok(())
    }
}

impl digital::ErrorType for SleepPin {
    type Error = Infallible;
}

impl OutputPin for SleepPin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        change(&self.0, |state| state.awake = false);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        change(&self.0, |state| state.awake = true);
        Ok(())
    }
}

impl digital::ErrorType for FaultPin {
    type Error = Infallible;
}

impl InputPin for FaultPin {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(!self.0.get().fault)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(self.0.get().fault)
    }
}
