//! The simulated stage as a controller that can be served.

use desk::serve::Controller;
use embedded_io::Write;
use firmware::fault::Fault;
use firmware::gcs::Session;
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::rig::run::{RunOptions, controller_parameters, machine_settings, stage_parameters};
use hal_sim::rig::{ControllerMemory, Rig};

/// See the module.
pub struct Simulated<'a> {
    rig: Rig<'a>,
    rate_hz: f64,
}

impl<'a> Simulated<'a> {
    /// The stage that these options describe, whose controller keeps its settings in this flash.
    #[must_use]
    pub fn new(
        memory: &'a mut ControllerMemory,
        options: &RunOptions,
        flash: SettingsFlash,
    ) -> Self {
        let (parameters, stage) = (controller_parameters(options), stage_parameters(options));
        let flash = machine_settings(options, flash);
        Self {
            rig: Rig::simulated(memory, &stage, &parameters, flash),
            rate_hz: parameters.limits.rate_hz,
        }
    }
}

impl Controller for Simulated<'_> {
    fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    fn tick(&mut self) {
        self.rig.tick(&mut ());
    }

    fn advance(&mut self) {
        self.rig.advance();
    }

    fn service<W: Write>(
        &mut self,
        session: &mut Session,
        replies: &mut W,
    ) -> Result<(), W::Error> {
        self.rig.service(session, replies)
    }

    fn disconnect(&mut self, session: &mut Session) {
        self.rig.disconnect(session);
    }

    fn keep(&mut self) {
        self.rig.keep();
    }

    fn restart_if_wanted(&mut self) -> bool {
        self.rig.restart_if_wanted()
    }

    fn fault(&self) -> Option<Fault> {
        self.rig.front.fault()
    }
}
