//! `tripivot calibrate measure`: a plan is driven, and every visit kept as it is made.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use crate::attended::SimulatedMachine;
use calibration::plan::Stop;
use calibration::table::Table;
use calibration::{Instrument, Kit, plan};
use desk::calibrate::{
    MeasureError, Measured, Reader, Way, measure, nm, rows, serial, with_references,
};
use desk::commission::{Attended, Machine};
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::machine::instruments::Beside;
use hal_sim::rig::Told;
use kinematics::Geometry;

use super::super::arguments::{CalibrateMeasure, CalibratedMachine};
use super::super::commission::{by_hand, wait_for_enter};
use super::super::error::CliError;
use super::super::view::endpoint;
use super::error::CalibrateError;
use super::reader::{Asked, NoInstrument, Simulated, TruePose};
use super::{line, noise, read};

/// Begins the line that says what is measured.
const BEGUN: &str = "# tripivot calibrate measure: ";

pub(super) fn run(arguments: &CalibrateMeasure) -> Result<ExitCode, CliError> {
    if arguments.kit == Kit::Ends && arguments.reader.is_some() {
        return Err(CalibrateError::NothingToRead.into());
    }
    let instrument = Instrument::new(arguments.kit, noise(&arguments.noise));
    let planned = plan(&instrument, arguments.poses).ok_or(CalibrateError::Lost)?;
    let stops = with_references(&planned.stops);
    let (mut machine, mut reader) =
        opened(&arguments.stage, arguments.reader.as_deref(), &instrument)?;
    let begun = format!(
        "{BEGUN}machine {}, {}, {:.4} nm, {} poses",
        serial(machine.as_mut())?,
        arguments.kit,
        nm(instrument.noise.length),
        arguments.poses
    );
    let kept = kept(&arguments.out, &begun)?;
    let mut file = Kept::open(&arguments.out, &begun, &instrument, kept)?;
    let way = Way {
        stops: &stops,
        first: kept,
        radius_mm: Geometry::REFERENCE.radius_mm,
        ends: &instrument.ends,
        is_from_both_sides: false,
    };
    measure(machine.as_mut(), reader.as_mut(), &way, &mut |measured| {
        file.keep(&stops, measured)
    })
    .map_err(CalibrateError::Measure)?;
    let text = [
        line(
            "measured",
            &format!(
                "{}, {} poses, {} visits, {kept} of them before",
                arguments.kit,
                arguments.poses,
                stops.len()
            ),
        ),
        line("visits in", &arguments.out.display().to_string()),
    ]
    .concat();
    (io::stdout().write_all(text.as_bytes())).map_err(CliError::output)?;
    Ok(ExitCode::SUCCESS)
}

/// The machine, simulated or not.
pub(super) fn machine(stage: &CalibratedMachine) -> Result<Box<dyn Machine>, CliError> {
    if stage.machine.is_simulated() {
        return Ok(Box::new(simulated(stage)?));
    }
    Ok(Box::new(Attended::open(
        &endpoint(&stage.controller)?,
        by_hand(wait_for_enter),
    )?))
}

fn simulated(stage: &CalibratedMachine) -> Result<SimulatedMachine, CliError> {
    let mut parameters = stage.machine.parameters()?;
    parameters.seed = stage.seed;
    let flash = match &stage.settings {
        Some(path) => SettingsFlash::open(path)?,
        None => SettingsFlash::in_memory(),
    };
    Ok(SimulatedMachine::told(&parameters, flash, Told::Machine))
}

type Opened = (Box<dyn Machine>, Box<dyn Reader>);

/// The machine, with what reads the instrument: this command, or the simulated one.
pub(super) fn opened(
    stage: &CalibratedMachine,
    command: Option<&str>,
    instrument: &Instrument,
) -> Result<Opened, CliError> {
    if let Some(command) = command {
        let reader = Asked {
            command: command.to_owned(),
            instrument: instrument.clone(),
        };
        return Ok((machine(stage)?, Box::new(reader)));
    }
    if instrument.kit == Kit::Ends {
        return Ok((machine(stage)?, Box::new(NoInstrument)));
    }
    if !stage.machine.is_simulated() {
        return Err(CalibrateError::NoReader.into());
    }
    let built = stage.machine.parameters()?;
    let radius_m = built.plant.track_radius_m;
    let machine = simulated(stage)?;
    let reader = Simulated {
        instrument: Beside::set_up(instrument, radius_m, stage.seed)
            .ok_or(CalibrateError::NothingToRead)?,
        true_pose: TruePose::new(machine.true_pose(), &built.wiring),
    };
    Ok((Box::new(machine), Box::new(reader)))
}

/// How many visits a file holds already. What a power cut has left of a line is no visit, and goes.
fn kept(path: &Path, begun: &str) -> Result<usize, CliError> {
    if !path.exists() {
        return Ok(0);
    }
    let text = read(path)?;
    let found = text.lines().next().unwrap_or_default();
    if found != begun {
        return Err(CalibrateError::Begun {
            path: path.to_owned(),
            found: found.trim_start_matches(BEGUN).to_owned(),
            wanted: begun.trim_start_matches(BEGUN).to_owned(),
        }
        .into());
    }
    let whole = &text[..text.rfind('\n').map_or(0, |end| end + 1)];
    if whole.len() < text.len() {
        fs::write(path, whole)
            .map_err(MeasureError::Unwritten)
            .map_err(CalibrateError::Measure)?;
    }
    let table = Table::from_text(whole, Geometry::REFERENCE.radius_mm);
    let table = table.map_err(|source| CalibrateError::Table {
        path: path.to_owned(),
        source,
    })?;
    Ok(table.visits.len())
}

/// The file, and what its rows are of.
pub(super) struct Kept {
    file: File,
    instrument: Instrument,
}

impl Kept {
    /// Opened behind what it holds; begun if that is nothing.
    pub(super) fn open(
        path: &Path,
        begun: &str,
        instrument: &Instrument,
        kept: usize,
    ) -> Result<Self, CliError> {
        let is_new = !path.exists();
        let written = || -> io::Result<Self> {
            let mut file = OpenOptions::new().create(true).append(true).open(path)?;
            if is_new {
                file.write_all(rows::head(begun, instrument).as_bytes())?;
            }
            file.write_all(rows::from(kept).as_bytes())?;
            let instrument = instrument.clone();
            Ok(Self { file, instrument })
        };
        Ok(written()
            .map_err(MeasureError::Unwritten)
            .map_err(CalibrateError::Measure)?)
    }

    /// A row, with what it is and when above it.
    pub(super) fn keep(&mut self, stops: &[Stop], measured: &Measured) -> io::Result<()> {
        let text = rows::row(&self.instrument, stops, measured);
        self.file.write_all(text.as_bytes())
    }
}
