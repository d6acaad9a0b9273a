//! `tripivot calibrate demo`: a machine that nobody knows is commissioned, calibrates itself with a plate that nobody has measured, and what
//! has come of it is judged by what only a simulator knows, the true pose.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use calibration::frames::Pair;
use calibration::plan::stops;
use calibration::table::Table;
use calibration::{Instrument, Kit, Noise, Seen, plan};
use desk::calibrate::report::{Report, Truth, before_and_after, page};
use desk::calibrate::{
    Evidence, FitTold, Reader, Told, Verdict, Wanted, Way, apply, measure, nm, serial, verify,
    with_references,
};
use desk::commission::{Chosen, ZerosBy, run as run_steps};
use drawing::{make_folder, write_file, write_png};
use hal_sim::machine::devices::{SettingsFlash, StageParameters};
use hal_sim::machine::instruments::Beside;
use hal_sim::machine::unknown;
use hal_sim::rig;
use kinematics::Geometry;

use super::super::FAILED;
use super::super::arguments::CalibrateDemo;
use super::super::error::CliError;
use super::error::CalibrateError;
use super::fit::fitted;
use super::measure::Kept;
use super::reader::{Simulated, TruePose};
use super::{line, lines, read};
use crate::attended::SimulatedMachine;

/// Noise of the camera, nm.
const NOISE_NM: f64 = 50.0;
/// Poses at which true and commanded ones are compared, and those that the sequence has before them.
const COMPARED: usize = 100;
const PASSED: usize = 20_000;
/// Fresh poses of the verification.
const VERIFIED: usize = 40;
/// Names of the files in the folder.
const SETTINGS: &str = "settings.flash";
const MEASURED: &str = "measured.csv";
const CALIBRATION: &str = "calibration.toml";
const REPORT: &str = "report.html";
const MAPS: &str = "error-maps.png";

/// Sees the true pose itself.
struct Omniscient(TruePose);

impl Reader for Omniscient {
    fn read(&mut self, wanted: &Wanted) -> Result<Seen, String> {
        let [x, y, theta_rad] = self.0.get(wanted.pose[2]);
        let radii = 1e3 / Geometry::REFERENCE.radius_mm;
        Ok(Seen::Pose([x * radii, y * radii, theta_rad]))
    }
}

pub(super) fn run(arguments: &CalibrateDemo) -> Result<ExitCode, CliError> {
    let folder = &arguments.out;
    make_folder(folder)?;
    let stage = unknown(arguments.unknown);
    let start = Instant::now();
    let settings = folder.join(SETTINGS);
    if let Some(from) = &arguments.settings {
        fs::copy(from, &settings).map_err(|source| CalibrateError::Unreadable {
            path: from.clone(),
            source,
        })?;
    } else if !commissioned(&stage, &settings, arguments.unknown)? {
        return Ok(ExitCode::from(FAILED));
    }
    let mut machine =
        SimulatedMachine::told(&stage, SettingsFlash::open(&settings)?, rig::Told::Machine);
    say(
        "the unmeasured plate and the camera are set up; before that, true poses against commanded ones as drawn\n",
    )?;
    let before = compared(&mut machine, &stage)?;
    let instrument = Instrument::new(
        Kit::Camera2,
        Noise {
            length: NOISE_NM / nm(1.0),
            angle_rad: 1e-6,
            encoder_rad: Noise::ENCODER_RAD,
        },
    );
    let mut reader = reader(&machine, &stage, &instrument, arguments.unknown)?;
    let table = measured(
        &mut machine,
        &mut reader,
        &instrument,
        arguments.poses,
        folder,
    )?;
    let instrument = table.instrument(instrument.noise);
    let path = folder.join(CALIBRATION);
    let fitted = fitted(
        &table,
        &instrument,
        &serial(&mut machine)?,
        None,
        &folder.join(MEASURED),
    )?;
    let calibration = &fitted.calibration;
    write_file(&path, calibration.to_text().as_bytes())?;
    let told = FitTold::new(&fitted, &table, &path.display().to_string());
    say(&lines(&told.lines()))?;
    let evidence = Evidence {
        instrument: table.instrument(calibration.made.noise()),
        visits: table.visits.clone(),
        references: table.references_but(&fitted.fit.outliers),
        over: None,
    };
    apply(&mut machine, calibration, &evidence).map_err(CalibrateError::Apply)?;
    let fresh = Instrument::new(Kit::Camera2, calibration.made.noise());
    let verified = verify(
        &mut machine,
        &mut reader,
        calibration,
        &fresh,
        VERIFIED,
        &mut |_, _| (),
    )
    .map_err(CalibrateError::Verify)?;
    let told = Told::new(&fresh, &verified);
    say(&lines(&told.lines()))?;
    let after = compared(&mut machine, &stage)?;
    let truth = Truth { before, after };
    let report = Report {
        calibration,
        measured: &table,
        verified: Some(&told),
        truth: Some(&truth),
    };
    let text = page(&report).map_err(CalibrateError::Report)?;
    write_file(&folder.join(REPORT), text.as_bytes())?;
    write_png(&folder.join(MAPS), &before_and_after(&truth))?;
    let [before, after] = truth.sizes();
    say(&[
        line(
            "true, as drawn",
            &format!(
                "{:.2} um and {:.1} urad rms from commanded poses",
                before[0], before[1]
            ),
        ),
        line(
            "true, calibrated",
            &format!("{:.3} um and {:.3} urad rms", after[0], after[1]),
        ),
        line("report in", &folder.join(REPORT).display().to_string()),
        line("took", &format!("{:.0} s", start.elapsed().as_secs_f64())),
    ]
    .concat())?;
    Ok(match verified.verdict() {
        Verdict::Holds | Verdict::Better => ExitCode::SUCCESS,
        Verdict::Worse | Verdict::WorseThanDrawn => ExitCode::from(FAILED),
    })
}

/// Brings it up by the steps of `tripivot commission`, into these settings. Whether it came up.
fn commissioned(stage: &StageParameters, settings: &Path, seed: u64) -> Result<bool, CliError> {
    say(&format!(
        "commissioning unknown machine {seed} first, as `tripivot commission` does: wires, zeros, gains, identification; 200 s of its time, about a \
         minute of yours (--settings FILE skips it)\n"
    ))?;
    // Nobody knows it yet, whatever an earlier run has left.
    if settings.exists() {
        fs::remove_file(settings).map_err(drawing::unwritable(settings))?;
    }
    let mut machine = SimulatedMachine::new(stage, SettingsFlash::open(settings)?);
    let mut written = Ok(ExitCode::SUCCESS);
    let ran = run_steps(&mut machine, &Chosen::all(ZerosBy::Jig), &mut |done| {
        let verdict = done
            .failure
            .as_ref()
            .map_or("done", |failure| &failure.what);
        let told = format!("  {}: {verdict} ({:.0} s)\n", done.step.name, done.seconds);
        if written.is_ok() {
            written = say(&told);
        }
    })?;
    written?;
    Ok(ran.done.iter().all(|done| done.failure.is_none()))
}

/// True poses where the controller was sent to, all over the disk.
fn compared(
    machine: &mut SimulatedMachine,
    stage: &StageParameters,
) -> Result<Vec<Pair>, CliError> {
    let mut reader = Omniscient(TruePose::new(machine.true_pose(), &stage.wiring));
    let perfect = Instrument::new(
        Kit::Xyt,
        Noise {
            length: 0.0,
            angle_rad: 0.0,
            encoder_rad: 0.0,
        },
    );
    let stops = stops(&perfect, PASSED, COMPARED);
    let way = Way {
        stops: &stops,
        first: 0,
        radius_mm: Geometry::REFERENCE.radius_mm,
        ends: &[],
        is_from_both_sides: false,
    };
    let mut pairs = Vec::new();
    measure(machine, &mut reader, &way, &mut |measured| {
        if let Seen::Pose(reached) = measured.visited.seen {
            pairs.push(Pair {
                asked: measured.commanded,
                reached,
            });
        }
        Ok(())
    })
    .map_err(CalibrateError::Measure)?;
    Ok(pairs)
}

fn reader(
    machine: &SimulatedMachine,
    stage: &StageParameters,
    instrument: &Instrument,
    seed: u64,
) -> Result<Simulated, CliError> {
    let beside = Beside::set_up(instrument, stage.plant.track_radius_m, seed);
    Ok(Simulated {
        instrument: beside.ok_or(CalibrateError::NothingToRead)?,
        true_pose: TruePose::new(machine.true_pose(), &stage.wiring),
    })
}

/// Drives the plan, and keeps what was seen.
fn measured(
    machine: &mut SimulatedMachine,
    reader: &mut Simulated,
    instrument: &Instrument,
    poses: usize,
    folder: &Path,
) -> Result<Table, CliError> {
    let planned = plan(instrument, poses).ok_or(CalibrateError::Lost)?;
    let stops = with_references(&planned.stops);
    say(&format!(
        "measuring: {} visits of the plate's marks, each brought under the camera; {:.0} nm are expected of the noise alone\n",
        stops.len(),
        nm(planned.accuracy.place_rms)
    ))?;
    let path: PathBuf = folder.join(MEASURED);
    if path.exists() {
        fs::remove_file(&path).map_err(drawing::unwritable(&path))?;
    }
    let begun = format!("# tripivot calibrate demo: {} poses", poses);
    let mut file = Kept::open(&path, &begun, instrument, 0)?;
    let way = Way {
        stops: &stops,
        first: 0,
        radius_mm: Geometry::REFERENCE.radius_mm,
        ends: &[],
        is_from_both_sides: false,
    };
    measure(machine, reader, &way, &mut |measured| {
        file.keep(&stops, measured)
    })
    .map_err(CalibrateError::Measure)?;
    let table = Table::from_text(&read(&path)?, Geometry::REFERENCE.radius_mm);
    Ok(table.map_err(|source| CalibrateError::Table { path, source })?)
}

fn say(text: &str) -> Result<ExitCode, CliError> {
    let mut out = io::stdout();
    (out.write_all(text.as_bytes()).and_then(|()| out.flush())).map_err(CliError::output)?;
    Ok(ExitCode::SUCCESS)
}
