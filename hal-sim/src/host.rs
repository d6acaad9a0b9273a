//! The controller on the host: the firmware's own loop and drivers between the simulated encoders and bridges.

use firmware::config::Config;
use firmware::controller::{Inputs, Outputs, State, tick};
use firmware::drivers::biss::{RawFrame, read};
use firmware::drivers::bridge;
use firmware::fault::Fault;
use firmware::link::TickLink;
use firmware::parameters::Parameters;
use firmware::recorder::Record;

use crate::devices::{
    Bridge, BridgeState, DirectionPin, FaultPin, PwmPin, SleepPin, Stage, StageParameters,
};
use crate::plant::AXES;

type Driver = bridge::Bridge<PwmPin, DirectionPin, SleepPin, FaultPin>;

/// A simulated stage under the controller, at a tick.
pub struct Host {
    /// The stage; public so that a scenario can push it, break it and look at it.
    pub stage: Stage,
    /// Bridges, the plant's side.
    pub bridges: [Bridge; AXES],
    /// Emergency stop pressed.
    pub emergency_stop: bool,
    /// The tick before was late, or there should have been one more: what a host has no clock to find out.
    pub late: bool,
    drivers: [Driver; AXES],
    config: Config,
    state: State,
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
                let (bridge, pins) = Bridge::with_pwm_counts(parameters.drive.pwm_counts);
                let driver = Driver::new(pins.pwm, pins.direction, pins.sleep, pins.fault);
                Some((bridge, sure(driver)?))
            })
            .unzip();
        let three = "three of each were made";
        Self {
            stage: Stage::new(stage),
            bridges: bridges.try_into().expect(three),
            emergency_stop: false,
            late: false,
            drivers: drivers.try_into().ok().expect(three),
            config: Config::new(parameters),
            state: State::new(),
        }
    }

    /// One tick of the controller, and the stage's motion up to the next.
    pub fn tick(&mut self, link: &mut TickLink<'_>, recorder: &mut impl Record) -> Outputs {
        let inputs = self.inputs();
        let outputs = tick(&mut self.config, &mut self.state, &inputs, link, recorder);
        for (driver, duty) in self.drivers.iter_mut().zip(outputs.duty) {
            let done = if outputs.awake {
                driver.drive(duty)
            } else {
                driver.coast()
            };
            sure(done);
        }
        let pins: [BridgeState; AXES] = self.bridges.each_ref().map(Bridge::state);
        self.stage.advance_period(pins);
        outputs
    }

    /// Starts the controller again, with these parameters; the stage stays as it is.
    pub fn restart(&mut self, parameters: &Parameters) {
        self.config = Config::new(parameters);
        self.state = State::new();
    }

    /// The latched fault.
    #[must_use]
    pub fn fault(&self) -> Option<Fault> {
        self.state.fault()
    }

    fn inputs(&mut self) -> Inputs {
        let frames = self
            .stage
            .encoders
            .each_mut()
            .map(|encoder| read(encoder).unwrap_or(RawFrame::MISSING));
        let bridge_fault = self
            .drivers
            .each_mut()
            .map(|driver| driver.faulty().unwrap_or(true));
        let (current_counts, supply_counts) = self.stage.analog();
        Inputs {
            frames,
            bridge_fault,
            emergency_stop: self.emergency_stop,
            current_counts,
            supply_counts,
            tick_cycles: 0,
            late: self.late,
        }
    }
}
