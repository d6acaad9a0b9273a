//! What a tick is given, what it gives, and what the loop remembers between ticks.

use super::brake_resistor::BrakeResistor;
use super::calibrated::Calibrated;
use super::config::Config;
use super::encoder::Encoder;
use super::excitation::ExcitationRun;
use super::guides::Guides;
use super::inspection::PivotWatch;
use super::lead_test::LeadTest;
use super::loop_counters::LoopCounters;
use super::pivot_setpoints::NextSetpoint;
use super::rest_mode::RestMode;
use super::servo::PivotServo;
use super::settling::Settling;
use super::subdivision::SubdivisionTable;
use crate::drivers::biss::RawFrame;
use crate::drivers::bridge::Duty;
use crate::fault::{Fault, FaultKind};
use crate::iterative_learning::Trial;
use crate::mode::Mode;
use crate::motion::PlanFollower;

/// What the hardware gives a tick.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// Frames of the three encoders, latched one right after the other
    /// ([`LATCH_OFFSET_S`](crate::drivers::latch::LATCH_OFFSET_S)).
    pub frames: [RawFrame; 3],
    /// Fault pins of the bridges (true: fault).
    pub bridge_fault: [bool; 3],
    /// Emergency stop pressed.
    pub emergency_stop: bool,
    /// The program is no longer what it was: somebody has looked.
    pub program_damaged: bool,
    /// Motor currents, ADC counts with their sign.
    pub current_counts: [i16; 3],
    /// Supply, ADC counts.
    pub supply_counts: u16,
    /// Cost of the tick before, processor cycles; 0 where nobody counts them.
    pub tick_cycles: u32,
    /// The duties of the tick before missed their PWM period, or there should have been one more tick since.
    pub late: bool,
}

/// What a tick gives the hardware.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// Duties; zero brakes.
    pub duty: [Duty; 3],
    /// Sleep pins: false lets the motors coast whatever the duty.
    pub awake: bool,
    /// Pin of the brake resistor.
    pub brake_resistor: bool,
}

/// All that the loop remembers.
#[derive(Clone, Debug, Default)]
pub struct State {
    pub(super) tick: u64,
    pub(super) mode: Mode,
    pub(super) fault: Option<Fault>,
    /// The fault that has ended the controlled stop of the one before.
    pub(super) stop_ended_by: Option<Fault>,
    /// A latched fault lets the motors coast.
    pub(super) coasts: bool,
    /// The pivot that has lost its encoder, until the fault is acknowledged.
    pub(super) lost_pivot: Option<usize>,
    pub(super) referenced: bool,
    /// What is taken from the encoders' readings.
    pub(super) subdivision: Option<[SubdivisionTable; 3]>,
    pub(super) encoders: [Encoder; 3],
    pub(super) calibrated: Calibrated,
    pub(super) motion: PlanFollower,
    pub(super) next: NextSetpoint,
    pub(super) servo: [PivotServo; 3],
    pub(super) guides: Guides,
    pub(super) trial: Trial,
    pub(super) excitation: ExcitationRun,
    pub(super) settling: Settling,
    pub(super) rest_mode: RestMode,
    pub(super) supply: f32,
    pub(super) commands: u32,
    pub(super) refused: u32,
    /// Mode and commands that were last told of.
    pub(super) told_mode_and_commands: (Mode, u32),
    pub(super) loop_counters: LoopCounters,
    /// The pivot whose servo is told of in the next snapshot.
    pub(super) reported_servo: usize,
    /// Late ticks, a hundred each, less those forgiven.
    pub(super) lateness: u32,
    /// Ticks in a row with a supply that is too low, or too high.
    pub(super) bad_supply_ticks: u8,
    /// Ticks left of those in which the bridges wake up and the brake resistor is tested: no duty, nothing collected, and commands wait.
    pub(super) waking_ticks: u32,
    /// Behind that, at servo on.
    pub(super) lead_test: LeadTest,
    /// Fault pins in the tick before, while the bridges are awake (index: pivot).
    pub(super) bridge_faults: [bool; 3],
    pub(super) brake_resistor: BrakeResistor,
    /// Square of how far out the setpoint may be, track radii.
    pub(super) max_radius_squared: f32,
    /// The pivot that is inspected in this tick; in [`SNAPSHOT_SLOT`](super::inspection::SNAPSHOT_SLOT) none is.
    pub(super) inspection_slot: usize,
    pub(super) pivot_watches: [PivotWatch; 3],
}

impl State {
    /// State at power-up.
    pub fn new() -> Self {
        Self::default()
    }

    /// State at power-up, with a fault that was found before: latched, so that nothing drives until it is acknowledged.
    pub fn with_fault(kind: FaultKind) -> Self {
        let fault = Fault {
            kind,
            pivot: None,
            tick: 0,
            value: 0.0,
            limit: 0.0,
        };
        Self {
            mode: Mode::Fault,
            fault: Some(fault),
            coasts: true,
            ..Self::new()
        }
    }

    /// The same with motors that are warm from before the start: see [`Snapshot::motor_heat`](super::snapshot::Snapshot).
    #[must_use]
    pub fn with_motor_heat(mut self, motor_heat: [f32; 3]) -> Self {
        for (watch, heat) in self.pivot_watches.iter_mut().zip(motor_heat) {
            watch.mean_square_current = heat;
        }
        self
    }

    /// The same with what the servos have learnt before, as the constants have it.
    #[must_use]
    pub fn with_learnt(mut self, config: &Config) -> Self {
        for (servo, config) in self.servo.iter_mut().zip(&config.servo.pivots) {
            servo.restore(&config.learnt);
        }
        self
    }

    /// The latched fault.
    pub fn fault(&self) -> Option<Fault> {
        self.fault
    }

    /// The fault that has ended the controlled stop of that one.
    pub fn stop_ended_by(&self) -> Option<Fault> {
        self.stop_ended_by
    }

    /// Whether the servo drives the motors.
    pub(super) fn servo_on(&self) -> bool {
        matches!(self.mode, Mode::Holding | Mode::Moving | Mode::Stopping)
    }

    /// Whether the bridges wake up, or motors and brake resistor are tested before anything is driven.
    pub(super) fn is_waking(&self) -> bool {
        self.waking_ticks != 0 || self.lead_test.is_under_way()
    }

    /// Whether anything drives the motors.
    pub(super) fn is_driven(&self) -> bool {
        self.servo_on() || self.mode == Mode::Exciting
    }

    /// Whether the bridges drive or brake.
    pub(super) fn bridges_awake(&self) -> bool {
        match self.mode {
            Mode::Off => false,
            Mode::Fault => !self.coasts,
            Mode::Holding | Mode::Moving | Mode::Stopping | Mode::Exciting => true,
        }
    }
}
