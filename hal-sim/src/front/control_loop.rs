//! The firmware's tick with its state, which is given what the hardware would give it.

use super::Front;
use firmware::control::config::Config;
use firmware::control::{Inputs, Outputs, State, tick};
use firmware::drivers::biss::RawFrame;
use firmware::fault::{Fault, FaultKind};
use firmware::parameters::Parameters;
use firmware::queues::TickQueues;
use firmware::recorder::TickObserver;

/// See the module.
pub struct ControlLoop {
    /// What the next tick is given.
    pub inputs: Inputs,
    /// What the tick computes with.
    pub config: Config,
    state: State,
}

/// Nothing is connected.
const NO_INPUTS: Inputs = Inputs {
    frames: [RawFrame::MISSING; 3],
    bridge_fault: [false; 3],
    emergency_stop: false,
    current_counts: [0; 3],
    supply_counts: 0,
    tick_cycles: 0,
    program_damaged: false,
    late: false,
};

impl ControlLoop {
    /// Freshly started, with nothing connected.
    #[must_use]
    pub fn new(parameters: &Parameters) -> Self {
        let config = Config::new(parameters);
        Self {
            inputs: NO_INPUTS,
            state: State::new().with_learnt(&config),
            config,
        }
    }

    /// The latched fault.
    #[must_use]
    pub fn fault(&self) -> Option<Fault> {
        self.state.fault()
    }

    /// The fault that has ended the controlled stop of that one.
    #[must_use]
    pub fn stop_ended_by(&self) -> Option<Fault> {
        self.state.stop_ended_by()
    }
}

impl Front for ControlLoop {
    fn tick(&mut self, link: &mut TickQueues<'_>, recorder: &mut impl TickObserver) -> Outputs {
        tick(
            &mut self.config,
            &mut self.state,
            &self.inputs,
            link,
            recorder,
        )
    }

    fn restart(&mut self, parameters: &Parameters, fault: Option<FaultKind>, motor_heat: [f32; 3]) {
        self.config = Config::new(parameters);
        let state = fault.map_or_else(State::new, State::with_fault);
        self.state = state.with_motor_heat(motor_heat).with_learnt(&self.config);
    }
}
