//! The controller on the host: the firmware's own loop and drivers between the simulated encoders and bridges.

use super::{ControlLoop, Front};
use crate::machine::devices::{
    Bridge, BridgeState, DirectionPin, FaultPin, PwmPin, Reset, SleepPin, Stage, StageParameters,
    Watchdog,
};
use crate::machine::plant::AXES;
use firmware::control::{Inputs, Outputs};
use firmware::drivers::biss::{RawFrame, read};
use firmware::drivers::bridge;
use firmware::drivers::power_stage::signed_current_counts;
use firmware::fault::{Fault, FaultKind};
use firmware::parameters::Parameters;
use firmware::queues::TickQueues;
use firmware::recorder::TickObserver;

type Driver = bridge::Bridge<PwmPin, DirectionPin, SleepPin, FaultPin>;

/// The wires between a bridge and its motor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wiring {
    /// As they should be.
    #[default]
    Sound,
    /// A wire to the motor is broken: it turns freely, and no pin tells.
    Open,
    /// The direction pin does not reach the bridge, which takes it for high or low.
    Direction {
        /// High: positive voltage.
        forward: bool,
    },
}

impl Wiring {
    /// What becomes of a bridge's pins.
    #[must_use]
    pub const fn pass(self, pins: BridgeState) -> BridgeState {
        match self {
            Self::Sound => pins,
            Self::Open => BridgeState {
                awake: false,
                ..pins
            },
            Self::Direction { forward } => BridgeState { forward, ..pins },
        }
    }
}

/// A simulated stage under the controller, at a tick.
pub struct Host {
    /// The stage; public so that a scenario can push it, break it and look at it.
    pub stage: Stage,
    /// Bridges, the plant's side.
    pub bridges: [Bridge; AXES],
    /// Emergency stop pressed.
    pub emergency_stop: bool,
    /// Wires to the motors.
    pub wiring: [Wiring; AXES],
    /// The program is no longer what it was.
    pub program_damaged: bool,
    /// The tick before was late, or there should have been one more: what a host has no clock to find out.
    pub late: bool,
    /// What starts the controller again.
    pub watchdog: Watchdog,
    /// The tick before did not come.
    missed: bool,
    drivers: [Driver; AXES],
    control: ControlLoop,
}

/// Nothing that the simulated pins return can fail.
fn sure<T, E>(result: Result<T, E>) -> Option<T> {
    result.ok()
}

impl Host {
    /// A stage with a freshly started controller. The counts of the PWM are the controller's parameter.
    #[must_use]
    pub fn new(stage: &StageParameters, parameters: &Parameters) -> Self {
        let (bridges, drivers): (Vec<_>, Vec<_>) = (0..AXES)
            .filter_map(|_| {
                let (bridge, pins) = Bridge::with_pwm_counts(parameters.power.pwm_counts);
                let driver = Driver::new(pins.pwm, pins.direction, pins.sleep, pins.fault);
                Some((bridge, sure(driver)?))
            })
            .unzip();
        let three = "three of each were made";
        Self {
            stage: Stage::new(stage),
            bridges: bridges.try_into().expect(three),
            emergency_stop: false,
            wiring: [Wiring::Sound; AXES],
            program_damaged: false,
            late: false,
            watchdog: Watchdog::new(0.5),
            missed: false,
            drivers: drivers.try_into().ok().expect(three),
            control: ControlLoop::new(parameters),
        }
    }

    /// One tick of the controller, and the stage's motion up to the next.
    pub fn tick(&mut self, link: &mut TickQueues<'_>, recorder: &mut impl TickObserver) -> Outputs {
        self.control.inputs = self.inputs();
        let outputs = self.control.tick(link, recorder);
        for (driver, duty) in self.drivers.iter_mut().zip(outputs.duty) {
            let done = if outputs.awake {
                driver.drive(duty)
            } else {
                driver.coast()
            };
            sure(done);
        }
        self.stage.set_brake_resistor(outputs.brake_resistor);
        self.stage.advance_period(self.pins());
        self.watchdog.feed();
        outputs
    }

    /// A period in which the program hangs, or starts again. The reset after which the next tick is due is told: the caller starts
    /// the controller again then.
    pub fn stand_still(&mut self) -> Option<Reset> {
        let pins = if self.watchdog.is_cut() {
            [BridgeState::RESET; AXES]
        } else {
            self.pins()
        };
        self.stage.advance_period(pins);
        self.watchdog.step(self.stage.period_s())
    }

    /// A period in which the controller does not run: the bridges keep what the last tick gave them, and the next tick is
    /// told.
    pub fn miss_tick(&mut self) {
        self.missed = true;
        self.stage.advance_period(self.pins());
    }

    /// What the bridges are told, after their wiring.
    #[must_use]
    pub fn pins(&self) -> [BridgeState; AXES] {
        [0, 1, 2].map(|axis| self.wiring[axis].pass(self.bridges[axis].state()))
    }

    /// Starts the controller again, with these parameters, perhaps a fault, and motors this warm; the stage stays as it is.
    pub fn restart(
        &mut self,
        parameters: &Parameters,
        fault: Option<FaultKind>,
        motor_heat: [f32; 3],
    ) {
        self.control.restart(parameters, fault, motor_heat);
    }

    /// The latched fault.
    #[must_use]
    pub fn fault(&self) -> Option<Fault> {
        self.control.fault()
    }

    /// The fault that has ended the controlled stop of that one.
    #[must_use]
    pub fn stop_ended_by(&self) -> Option<Fault> {
        self.control.stop_ended_by()
    }

    fn inputs(&mut self) -> Inputs {
        let frames =
            [0, 1, 2].map(|port| read(self.stage.encoder_at(port)).unwrap_or(RawFrame::MISSING));
        let bridge_fault = self
            .drivers
            .each_mut()
            .map(|driver| driver.reports_fault().unwrap_or(true));
        let pulled = self.stage.pulled_fault_pins();
        let bridge_fault = [0, 1, 2].map(|axis| bridge_fault[axis] || pulled[axis]);
        let (currents, supply_counts) = self.stage.analog();
        Inputs {
            frames,
            bridge_fault,
            emergency_stop: self.emergency_stop,
            current_counts: currents.map(signed_current_counts),
            supply_counts,
            tick_cycles: 0,
            program_damaged: self.program_damaged,
            late: self.late | std::mem::take(&mut self.missed),
        }
    }
}

impl Front for Host {
    fn tick(&mut self, link: &mut TickQueues<'_>, recorder: &mut impl TickObserver) -> Outputs {
        self.tick(link, recorder)
    }

    fn restart(&mut self, parameters: &Parameters, fault: Option<FaultKind>, motor_heat: [f32; 3]) {
        self.restart(parameters, fault, motor_heat);
    }
}
