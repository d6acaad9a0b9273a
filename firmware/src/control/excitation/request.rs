//! What an excitation is asked to do.

use super::multisine::Multisine;
use crate::control::units::{CURRENT_A_PER_COUNT, UNITS_PER_RAD};
use crate::parameters::Parameters;

/// An excitation of one pivot's motor; the other two get no voltage (or, with a servo, hold).
#[derive(Clone, Debug, PartialEq)]
pub struct Excitation {
    /// Which pivot, 0 to 2.
    pub pivot: usize,
    /// What it does.
    pub signal: ExcitationSignal,
    /// For so long.
    pub ticks: u32,
    /// What ends it before.
    pub until: ExcitationUntil,
    /// What must not happen.
    pub guards: ExcitationGuards,
}

impl Excitation {
    /// Whether it can be had with the servo off alone: there are no other servos, and nothing else looks for what ends it.
    pub fn needs_servo_off(&self) -> bool {
        matches!(self.signal, ExcitationSignal::Ring { .. }) || self.until != ExcitationUntil::TIME
    }
}

/// What an excitation does.
// There is no heap to box the sines in, and one excitation at a time.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Debug, PartialEq)]
pub enum ExcitationSignal {
    /// A voltage, and what it changes by in a tick.
    Volts {
        /// At its first tick.
        start: f32,
        /// From tick to tick.
        per_tick: f32,
    },
    /// A sum of sines.
    Sines(Multisine),
    /// The servos hold all three rings where they are, each on its own encoder, and move this one.
    Ring {
        /// How far, 2^-32 turns.
        way: i32,
        /// By how much in a tick, 2^-32 turns.
        step: u32,
    },
}

/// What ends an excitation as it is meant to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExcitationUntil {
    /// A pivot has gone so far, 2^-32 turns.
    pub way: u32,
    /// The motor carries so much, ADC counts.
    pub current_counts: u16,
}

impl ExcitationUntil {
    /// Nothing but time.
    pub const TIME: Self = Self {
        way: u32::MAX,
        current_counts: u16::MAX,
    };

    /// For a way in rad and a current in A.
    pub fn new(way_rad: Option<f64>, current_a: Option<f64>) -> Self {
        Self {
            way: way_rad.map_or(u32::MAX, |rad| (rad * UNITS_PER_RAD) as u32),
            current_counts: current_a.map_or(u16::MAX, |a| (a / CURRENT_A_PER_COUNT) as u16),
        }
    }
}

/// What an excitation with the servo off must not leave: a fault else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExcitationGuards {
    /// Largest voltage of a motor.
    pub volts: f32,
    /// Furthest that a pivot may go from where it was, or from where a servo has it, 2^-32 turns.
    pub way: u32,
    /// Largest step of a pivot in a tick, 2^-32 turns.
    pub step: u32,
    /// Share of the servo's gains.
    pub stiffness: f32,
}

impl ExcitationGuards {
    /// As the parameters have them.
    pub fn new(parameters: &Parameters) -> Self {
        let excitation = &parameters.excitation;
        Self {
            volts: excitation.voltage_v as f32,
            way: (excitation.way_rad * UNITS_PER_RAD) as u32,
            step: (excitation.rate_rad_s * UNITS_PER_RAD / parameters.limits.rate_hz) as u32,
            stiffness: excitation.stiffness as f32,
        }
    }
}
