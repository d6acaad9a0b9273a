//! The one assembly of a controller: command side, settings, queues, tick, and starting again.
//!
//! What differs from one use to the next is passed in: what the tick stands before ([`Front`]), who sends lines and reads the
//! replies, who records the ticks.
//!
//! ```text
//! lines -> Session -> Interpreter -> queues -> tick of the Front -> recorder
//! replies <---------/  |  ^------------/
//!               SettingsFlash
//! ```

use super::simulated_board::SimulatedBoard;
use crate::front::{Front, Host};
use crate::machine::devices::{SettingsFlash, StageParameters};
use embedded_io::Write;
use firmware::calibration::MachineCalibration;
use firmware::control::Outputs;
use firmware::fault::FaultKind;
use firmware::fault_record::RetainedMemory;
use firmware::gcs::{Identity, Interpreter, Session};
use firmware::parameters::Parameters;
use firmware::queues::{CommandQueues, Queues, TickQueues};
use firmware::recorder::TickObserver;
use firmware::settings_store::SettingsStore;

/// Who the simulated controller says it is.
pub const IDENTITY: Identity = Identity {
    serial: "SIM",
    version: env!("CARGO_PKG_VERSION"),
};

/// The queues between tick and command side, and what outlives a restart of both. A rig borrows it.
pub struct ControllerMemory {
    queues: Box<Queues>,
    retained_memory: Box<RetainedMemory>,
}

/// See the module.
pub struct Rig<'a, F = Host> {
    /// The tick, and what it stands before.
    pub front: F,
    /// The command side.
    pub interpreter: Box<Interpreter>,
    /// Keeps its settings.
    pub settings_store: SettingsStore<SettingsFlash>,
    /// The tick's ends of the queues.
    pub tick_queues: TickQueues<'a>,
    /// The command side's ends of the queues.
    pub command_queues: CommandQueues<'a>,
    /// What the controller has by itself.
    own: Parameters,
}

impl Default for ControllerMemory {
    fn default() -> Self {
        Self::new()
    }
}

impl ControllerMemory {
    /// Empty.
    #[must_use]
    pub fn new() -> Self {
        Self {
            queues: Box::new(Queues::new()),
            retained_memory: Box::new(RetainedMemory::new()),
        }
    }

    /// The ends of the tick, and those of the command side.
    pub fn split(&mut self) -> (TickQueues<'_>, CommandQueues<'_>) {
        self.queues.split_with_retained(&self.retained_memory)
    }

    /// Memory that lives as long as the process: some kilobytes each time.
    #[must_use]
    pub fn endless() -> &'static mut Self {
        Box::leak(Box::new(Self::new()))
    }
}

impl<'a> Rig<'a> {
    /// A simulated stage whose controller starts with the settings of this flash; where it keeps none, with those of the machine.
    #[must_use]
    pub fn simulated(
        memory: &'a mut ControllerMemory,
        stage: &StageParameters,
        parameters: &Parameters,
        flash: SettingsFlash,
    ) -> Self {
        let front = |parameters: &Parameters| Host::new(stage, parameters);
        Self::new(memory.split(), parameters, flash, front)
    }
}

impl<'a, F: Front> Rig<'a, F> {
    /// A controller that starts with the settings of this flash. Into one that keeps none go those that a machine of these parameters
    /// comes with; if the parameters are not commissioned, it stays empty. `front` is told with which parameters it starts.
    #[must_use]
    pub fn new(
        (tick_queues, mut command_queues): (TickQueues<'a>, CommandQueues<'a>),
        parameters: &Parameters,
        flash: SettingsFlash,
        front: impl FnOnce(&Parameters) -> F,
    ) -> Self {
        let flash = with_machine_settings(flash, parameters, None);
        let own = parameters.clone().uncommissioned();
        let mut settings_store = SettingsStore::new(flash);
        let (interpreter, fault) = started(&own, &mut settings_store, &mut command_queues);
        let mut front = front(interpreter.parameters());
        front.restart(interpreter.parameters(), fault, motor_heat(&command_queues));
        Self {
            front,
            interpreter,
            settings_store,
            tick_queues,
            command_queues,
            own,
        }
    }

    /// One tick of the controller, and of what it stands before up to the next.
    pub fn tick(&mut self, recorder: &mut impl TickObserver) -> Outputs {
        self.front.tick(&mut self.tick_queues, recorder)
    }

    /// Has the command side carry out what a connection has received.
    ///
    /// # Errors
    /// Those of `replies`.
    pub fn service<W: Write>(
        &mut self,
        session: &mut Session,
        replies: &mut W,
    ) -> Result<(), W::Error> {
        self.interpreter
            .service(session, &mut self.command_queues, replies)
    }

    /// A connection has ended; what was its own ends with it.
    pub fn disconnect(&mut self, session: &mut Session) {
        self.interpreter.disconnect(session);
    }

    /// What the command side does with no connection there: a macro goes on.
    pub fn advance(&mut self) {
        self.interpreter.advance(&mut self.command_queues);
    }

    /// Goes on keeping settings.
    pub fn keep(&mut self) {
        let trial = &mut self.command_queues.trial;
        (self.settings_store).store_pending(&mut self.interpreter.contents(trial));
    }

    /// Starts the controller again if it was told to (`RBT`); whether it was. The connections' sessions are the caller's to
    /// start again.
    pub fn restart_if_wanted(&mut self) -> bool {
        let wanted = self.interpreter.wants_restart();
        if wanted {
            self.start();
        }
        wanted
    }

    /// What a reset of the chip leaves: what the tick stands before as it is, the controller started anew for this cause.
    pub fn reset(&mut self, cause: &'static str) {
        self.start();
        self.interpreter.set_start_cause(cause);
    }

    fn start(&mut self) {
        self.tick_queues.clear();
        self.command_queues.clear();
        let queues = &mut self.command_queues;
        let (interpreter, fault) = started(&self.own, &mut self.settings_store, queues);
        self.interpreter = interpreter;
        let motor_heat = motor_heat(&self.command_queues);
        (self.front).restart(self.interpreter.parameters(), fault, motor_heat);
    }
}

/// What a machine of these parameters comes with, and its calibration if it has one, is stored in a flash that keeps nothing yet.
#[must_use]
pub fn with_machine_settings(
    flash: SettingsFlash,
    parameters: &Parameters,
    calibration: Option<&MachineCalibration>,
) -> SettingsFlash {
    with_settings_over(parameters, flash, parameters, calibration)
}

/// The same for a controller that has `own` parameters by itself, as the image has those of the reference: what differs from them is stored.
#[must_use]
pub fn with_settings_over(
    own: &Parameters,
    flash: SettingsFlash,
    parameters: &Parameters,
    calibration: Option<&MachineCalibration>,
) -> SettingsFlash {
    if !parameters.commissioned || !flash.is_erased() {
        return flash;
    }
    let mut interpreter = Box::new(Interpreter::new(&own.clone().uncommissioned(), IDENTITY));
    interpreter.start_with(parameters.clone(), calibration.cloned());
    let mut settings_store = SettingsStore::new(flash);
    // One that does not take them leaves the controller uncommissioned, or its settings damaged: it says so itself.
    let mut queues = ControllerMemory::new();
    let (_, mut queues) = queues.split();
    let _ = settings_store.write(&interpreter.contents(&mut queues.trial));
    settings_store.into_flash()
}

/// How warm the motors are from before the start.
fn motor_heat(queues: &CommandQueues<'_>) -> [f32; 3] {
    (queues.retained_memory).map_or([0.0; 3], RetainedMemory::motor_heat)
}

/// The command side of a controller that starts with what is kept, and the fault that it starts with.
fn started(
    parameters: &Parameters,
    settings_store: &mut SettingsStore<SettingsFlash>,
    queues: &mut CommandQueues<'_>,
) -> (Box<Interpreter>, Option<FaultKind>) {
    let mut interpreter = Box::new(Interpreter::new(parameters, IDENTITY));
    interpreter.set_board(&SimulatedBoard);
    let fault = settings_store.restore(&mut interpreter.contents(&mut queues.trial));
    (interpreter, fault)
}
