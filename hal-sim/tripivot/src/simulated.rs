//! The simulated stage as a controller that can be served.

use std::sync::mpsc::{self, Receiver};
use std::sync::{Arc, Mutex, PoisonError};

use crate::person::Person;
use desk::commission::Task;
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
    person: Person,
    /// What the person beside it is asked for.
    tasks: Option<Receiver<Task>>,
    /// Where the platform truly is, m, m and rad, for instruments in other threads, if there are any.
    true_pose: Option<Arc<Mutex<[f64; 3]>>>,
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
            person: Person::default(),
            tasks: None,
            true_pose: None,
        }
    }

    /// Whoever asks the person beside it for something.
    pub fn person(&mut self) -> desk::web::Person {
        let (tasks, asked) = mpsc::channel();
        self.tasks = Some(asked);
        Arc::new(move |task| {
            // A machine that is gone needs no person.
            let _ = tasks.send(task);
        })
    }

    /// The platform's true pose, m, m and rad, as it is whenever that is looked at.
    pub fn true_pose(&mut self) -> impl Fn() -> [f64; 3] + Clone + Send + Sync + use<> {
        let pose = self.rig.front.stage.plant.pose();
        let shared = Arc::new(Mutex::new(pose));
        self.true_pose = Some(Arc::clone(&shared));
        move || *shared.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Controller for Simulated<'_> {
    fn rate_hz(&self) -> f64 {
        self.rate_hz
    }

    fn tick(&mut self) {
        let task = self.tasks.as_ref().and_then(|tasks| tasks.try_recv().ok());
        let stage = &mut self.rig.front.stage;
        if let Some(task) = task {
            self.person.begin(task, stage);
        }
        self.person.tick(stage);
        self.rig.tick(&mut ());
        if let Some(true_pose) = &self.true_pose {
            let pose = self.rig.front.stage.plant.pose();
            *true_pose.lock().unwrap_or_else(PoisonError::into_inner) = pose;
        }
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
