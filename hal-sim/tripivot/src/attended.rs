//! A simulated machine with a simulated person beside it, as fast as this computer can.

use std::cell::Cell;
use std::rc::Rc;

use crate::person::Person;
use desk::commission::{Machine, Task};
use desk::record::RecordError;
use firmware::gcs::Session;
use firmware::parameters::Parameters;
use hal_sim::front::Host;
use hal_sim::machine::devices::{SettingsFlash, StageParameters};
use hal_sim::rig::{ControllerMemory, Rig, Told};

/// Ticks that a line may take.
const PATIENCE: u32 = 400_000;
const TICK_S: f64 = 50e-6;

/// What looks at a machine before each of its ticks, or breaks it; and whether the person has it in hand.
pub type EachTick = Box<dyn FnMut(&mut Host, bool)>;

/// See the module.
pub struct SimulatedMachine {
    rig: Rig<'static>,
    session: Session,
    answers: Vec<u8>,
    person: Person,
    /// What the encoders' data sheet says.
    scale_periods: u32,
    each_tick: Option<EachTick>,
    /// Where the platform truly is, m, m and rad, for instruments.
    true_pose: Rc<Cell<[f64; 3]>>,
}

impl SimulatedMachine {
    /// Switched on, with a controller that keeps its settings in this flash, and knows nothing where that is empty.
    #[must_use]
    pub fn new(stage: &StageParameters, flash: SettingsFlash) -> Self {
        Self::watched(stage, flash, None)
    }

    /// The same, looked at from the first tick on.
    #[must_use]
    pub fn watched(
        stage: &StageParameters,
        flash: SettingsFlash,
        each_tick: Option<EachTick>,
    ) -> Self {
        Self::switched_on(
            stage,
            &Parameters::REFERENCE.uncommissioned(),
            flash,
            each_tick,
        )
    }

    /// Switched on, with a controller that is told this of the machine unless this flash keeps something else.
    #[must_use]
    pub fn told(stage: &StageParameters, flash: SettingsFlash, told: Told) -> Self {
        let parameters = told.parameters(&Parameters::REFERENCE, stage);
        Self::switched_on(stage, &parameters, flash, None)
    }

    fn switched_on(
        stage: &StageParameters,
        parameters: &Parameters,
        flash: SettingsFlash,
        each_tick: Option<EachTick>,
    ) -> Self {
        let mut machine = Self {
            rig: Rig::simulated(ControllerMemory::endless(), stage, parameters, flash),
            session: Session::new(),
            answers: Vec::new(),
            person: Person::default(),
            scale_periods: stage.encoders[0].scale_periods_per_turn,
            each_tick,
            true_pose: Rc::default(),
        };
        machine.run(2_000);
        machine
    }

    /// The platform's true pose, m, m and rad, as it is whenever that is looked at.
    pub fn true_pose(&self) -> impl Fn() -> [f64; 3] + use<> {
        let true_pose = Rc::clone(&self.true_pose);
        move || true_pose.get()
    }

    /// What its controller has been told, or has found.
    #[must_use]
    pub fn parameters(&self) -> &Parameters {
        self.rig.interpreter.parameters()
    }

    /// The machine itself, which a controller does not see.
    pub fn host(&mut self) -> &mut Host {
        &mut self.rig.front
    }

    fn tick(&mut self) {
        self.person.tick(&mut self.rig.front.stage);
        let in_hand = self.person.has_it_in_hand();
        if let Some(each_tick) = &mut self.each_tick {
            each_tick(&mut self.rig.front, in_hand);
        }
        self.rig.tick(&mut ());
        // Writing to a vector does not fail.
        let _ = self.rig.service(&mut self.session, &mut self.answers);
        self.rig.keep();
        self.true_pose.set(self.rig.front.stage.plant.pose());
    }

    fn run(&mut self, ticks: u32) {
        for _ in 0..ticks {
            self.tick();
        }
    }
}

impl Machine for SimulatedMachine {
    fn ask(&mut self, line: &str) -> Result<Option<String>, RecordError> {
        self.say("ERR?")?;
        let answer = self.say(line)?;
        let error = self.say("ERR?")?;
        match error.trim().parse() {
            // A stop has this error without having been refused.
            Ok(0 | 10) => Ok((!answer.is_empty()).then_some(answer)),
            Ok(code) => Err(RecordError::Refused {
                line: line.to_owned(),
                code,
                hint: "",
            }),
            Err(_) => Err(RecordError::Strange {
                line: "ERR?".to_owned(),
                answer: error,
            }),
        }
    }

    fn delay(&mut self, seconds: f64) -> Result<(), RecordError> {
        self.run((seconds / TICK_S).ceil() as u32);
        Ok(())
    }

    fn request(&mut self, task: Task) -> Result<(), RecordError> {
        self.person.begin(task, &mut self.rig.front.stage);
        if task.is_said_to_be_done() {
            self.run(400);
        }
        Ok(())
    }

    fn scale_periods(&self) -> Option<u32> {
        Some(self.scale_periods)
    }
}

impl SimulatedMachine {
    fn say(&mut self, line: &str) -> Result<String, RecordError> {
        let text = format!("{line}\n");
        let mut bytes = text.as_bytes();
        for _ in 0..PATIENCE {
            let taken = self.session.receive(bytes);
            bytes = &bytes[taken..];
            self.tick();
            if bytes.is_empty() && self.session.is_idle() {
                let answer =
                    String::from_utf8_lossy(&std::mem::take(&mut self.answers)).into_owned();
                let lines: Vec<&str> = answer.trim_end().lines().map(str::trim_end).collect();
                return Ok(lines.join("\n"));
            }
        }
        Err(RecordError::Strange {
            line: line.to_owned(),
            answer: "(none)".to_owned(),
        })
    }
}
