//! Running a script on the simulated stage, on the host.

use std::path::PathBuf;

use commissioning::chain::cylinder_kg_m2;
use firmware::fault::Fault;
use firmware::gcs::Session;
use firmware::mode::Mode;
use firmware::parameters::Parameters;

use super::{ControllerMemory, Disturbances, Rig, Told, with_machine_settings};
use crate::machine::devices::{FINE_PWM, SettingsFlash, StageParameters};
use crate::machine::plant::{FrictionParameters, Imperfections, Payload, PlantParameters};
use crate::report::{DEFAULT_EVERY, Run};
use crate::rig::client::{Client, Event};
use crate::rig::observer::{Observer, TickRecord};
use crate::rig::run_conditions;
use crate::rig::script::{Line, Script};
use drawing::Progress;

/// What a run is to do besides the script.
#[derive(Clone, Debug, PartialEq)]
pub struct RunOptions {
    /// Folder for trace and pictures.
    pub out: PathBuf,
    /// Every so many ticks a row of the trace.
    pub every: u32,
    /// The machine, before mismatch and payload, whose imperfections are switched below.
    pub machine: StageParameters,
    /// What to call it.
    pub machine_name: String,
    /// Seed of the simulated noise.
    pub seed: u64,
    /// By how much the plant departs from the controller's model of it, in percent.
    pub mismatch_percent: f64,
    /// Mass of a load on the platform that the controller knows nothing of: a cylinder of 50 mm radius, 20 mm off the centre. Zero
    /// leaves what the machine carries.
    pub payload_kg: f64,
    /// Imperfections of the simulated stage.
    pub imperfections: Imperfections,
    /// The controller's flash keeps nothing unless another is given: the machine is not commissioned.
    pub uncommissioned: bool,
    /// What the controller has been told of the machine, in place of commissioning and calibration.
    pub told: Told,
    /// No progress bar.
    pub quiet: bool,
}

impl Default for RunOptions {
    /// What the command line has by default.
    fn default() -> Self {
        Self {
            out: PathBuf::from("tripivot-run"),
            every: DEFAULT_EVERY,
            machine: StageParameters::REFERENCE,
            machine_name: "reference stage".to_owned(),
            seed: 1,
            mismatch_percent: 20.0,
            payload_kg: 0.0,
            imperfections: Imperfections::CALIBRATED,
            uncommissioned: false,
            told: Told::Nothing,
            quiet: true,
        }
    }
}

impl RunOptions {
    /// The reference stage as a workshop builds it, under a controller with the settings that its commissioning found, and calibrated.
    #[must_use]
    pub fn reference() -> Self {
        let mut machine = StageParameters::REFERENCE;
        machine.plant.imperfections = Imperfections::ALL;
        Self {
            machine,
            imperfections: Imperfections::ALL,
            mismatch_percent: 0.0,
            told: Told::Reference,
            ..Self::default()
        }
    }
}

/// A run that came to its end, one way or another.
#[derive(Debug)]
pub struct RunOutcome {
    /// Statistics, trace and moves.
    pub run: Run,
    /// The fault that ended it, or the line that was refused, in words.
    pub fault: Option<String>,
    /// Answers of the script's queries, with their lines.
    pub answers: Vec<(String, String)>,
    /// Running hash of all ticks.
    pub hash: u32,
    /// Ticks.
    pub ticks: u64,
}

/// Distance of the payload from the platform's centre, m.
const OFF_CENTRE_M: f64 = 0.02;

/// The machine as the options have it: off from the controller's model by their mismatch, heavier, with more
/// friction, and with weaker motors, the combination that costs the servo most.
#[must_use]
pub fn stage_parameters(options: &RunOptions) -> StageParameters {
    let more = 1.0 + options.mismatch_percent / 100.0;
    let less = 1.0 - options.mismatch_percent / 100.0;
    let reference = options.machine.plant;
    let load = Payload {
        mass_kg: options.payload_kg,
        inertia_kg_m2: cylinder_kg_m2(options.payload_kg),
        eccentricity_m: OFF_CENTRE_M,
        direction_rad: 0.7,
    };
    StageParameters {
        plant: PlantParameters {
            platform_mass_kg: reference.platform_mass_kg * more,
            platform_inertia_kg_m2: reference.platform_inertia_kg_m2 * more,
            ring_inertia_kg_m2: reference.ring_inertia_kg_m2 * more,
            motor_inertia_kg_m2: reference.motor_inertia_kg_m2 * more,
            ring_friction: FrictionParameters {
                coulomb: reference.ring_friction.coulomb * more,
                viscous: reference.ring_friction.viscous * more,
                ..reference.ring_friction
            },
            torque_constant_n_m_a: reference.torque_constant_n_m_a * less,
            payload: if options.payload_kg > 0.0 {
                load
            } else {
                reference.payload
            },
            imperfections: options.imperfections,
            ..reference
        },
        seed: options.seed,
        ..options.machine
    }
}

/// Runs a script on the simulated stage. Nothing is kept of its settings.
#[must_use]
pub fn run(script: &Script, options: &RunOptions) -> RunOutcome {
    run_with(script, options, SettingsFlash::in_memory())
}

/// Runs a script on the simulated stage, whose controller starts with the settings of this flash and keeps them there.
#[must_use]
pub fn run_with(script: &Script, options: &RunOptions, flash: SettingsFlash) -> RunOutcome {
    let stage = stage_parameters(options);
    let parameters = controller_parameters(options);
    let flash = machine_settings(options, flash);
    run_machine(script, &parameters, &stage, options, flash)
}

/// What the machine comes with, and what its controller is told, in a flash that keeps nothing yet.
#[must_use]
pub fn machine_settings(options: &RunOptions, flash: SettingsFlash) -> SettingsFlash {
    let calibration = options.told.calibration(&stage_parameters(options));
    with_machine_settings(flash, &controller_parameters(options), calibration.as_ref())
}

/// The controller's parameters, as the imperfections that are left make them: those that the machine comes with, none, or what it is told.
#[must_use]
pub fn controller_parameters(options: &RunOptions) -> Parameters {
    let mut parameters = Parameters::REFERENCE;
    if !options.imperfections.pwm_quantisation {
        parameters.power.pwm_counts = FINE_PWM;
    }
    if !options.imperfections.dead_time {
        // What is not there must not be made up for: that would be positive feedback around rest.
        for drive in &mut parameters.drives {
            drive.dead_time_s = 0.0;
        }
    }
    if options.uncommissioned {
        parameters = parameters.uncommissioned();
    }
    if options.told == Told::Nothing {
        return parameters;
    }
    parameters.commissioned = true;
    options
        .told
        .parameters(&parameters, &stage_parameters(options))
}

/// Ticks between two updates of the progress bar.
const PROGRESS_EVERY: u64 = 2_000;

/// Bytes between controller and client, on the host.
#[derive(Default)]
struct Wire {
    to_client: Vec<u8>,
    to_stage: Vec<u8>,
}

/// Runs a script on any machine, under a controller that starts with these parameters. Of the options, the trace's spacing counts, and
/// what the report is told.
#[must_use]
pub fn run_machine(
    script: &Script,
    parameters: &Parameters,
    stage: &StageParameters,
    options: &RunOptions,
    flash: SettingsFlash,
) -> RunOutcome {
    let mut memory = ControllerMemory::new();
    let mut rig = Rig::simulated(&mut memory, stage, parameters, flash);
    let Parameters {
        geometry, limits, ..
    } = *rig.interpreter.parameters();
    let mut session = Session::new();
    let mut client = Client::new(script);
    let mut observer = Observer::new(rig.interpreter.parameters(), options.every);
    let mut record = TickRecord::default();
    let mut wire = Wire::default();
    let mut disturbances = Disturbances::default();
    let mut answers = Vec::new();
    let mut ticks = 0;
    let progress = Progress::new(script.lines.len() as u64, options.quiet);
    let fault = loop {
        let pose = rig.front.stage.latched_pose();
        let stage = &mut rig.front.stage;
        let period_s = stage.period_s();
        disturbances.act(&mut stage.plant, period_s);
        rig.tick(&mut record);
        ticks += 1;
        let mut moving = false;
        if let Some(sample) = &record.sample {
            moving = sample.mode == Mode::Moving;
            observer.look(sample, pose);
            if sample.mode == Mode::Fault {
                break Some(fault_text(script, &client, rig.front.fault()));
            }
        }
        let taken = session.receive(&wire.to_stage);
        wire.to_stage.drain(..taken);
        // Writing to a vector does not fail.
        let _ = rig.service(&mut session, &mut wire.to_client);
        rig.keep();
        if rig.restart_if_wanted() {
            session.start_again();
        }
        let (bytes, event) = client.poll(&std::mem::take(&mut wire.to_client), moving);
        wire.to_stage.extend(bytes);
        match event {
            Some(Event::Done(line, Some(answer))) => answers.push((line.text, answer)),
            Some(Event::Refused(line, error)) => {
                let at = place(script, &line);
                break Some(format!("{at}: refused with GCS error {error}"));
            }
            Some(Event::Stuck(line)) => break Some(stuck_text(script, &line)),
            Some(Event::Disturbed(disturbance)) => disturbances.begin(disturbance),
            Some(Event::Finished) => break None,
            _ => {}
        }
        if ticks % PROGRESS_EVERY == 0 {
            progress.update(
                client.done() as u64,
                ticks as f64 * rig.front.stage.period_s(),
            );
        }
    };
    RunOutcome {
        run: Run {
            name: script.name.clone(),
            geometry,
            limits,
            trace: observer.trace,
            moves: observer.moves,
            conditions: run_conditions(options),
            wall_s: progress.finish(),
        },
        fault,
        answers,
        hash: record.hash.0,
        ticks,
    }
}

/// What is said of a line that waits for ever.
#[must_use]
pub fn stuck_text(script: &Script, line: &Line) -> String {
    let at = place(script, line);
    format!("{at}: still waiting, and the stage has been at rest for a simulated minute")
}

fn place(script: &Script, line: &Line) -> String {
    format!("{}:{}: {}", script.name, line.number, line.text)
}

fn fault_text(script: &Script, client: &Client, fault: Option<Fault>) -> String {
    let at = (client.current()).map_or_else(|| script.name.clone(), |line| place(script, line));
    let fault = fault.map_or_else(|| "unknown".to_owned(), |fault| fault.to_string());
    format!("fault: {fault}; at {at}")
}
