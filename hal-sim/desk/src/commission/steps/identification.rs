//! The numbers of drives and platform, from multisines on one motor after the other while the platform turns in the middle, and far out.

use super::carried;
use super::friction::torque_constant;
use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding, Found, fail};
use crate::commission::id;
use crate::commission::id::AXES;
use crate::commission::known::Known;
use crate::commission::measured_loop::place_of;
use crate::commission::sines::{
    CENTRE, Excited, FAR_OUT, GENTLE_V, PEAK_V, Recorded, WEAKER, excite,
};
use commissioning::chain::Place;
use commissioning::drive_model::{
    DriveError, DriveModel, Guess, Known as Before, LOAD_INERTIA, MASS, Mechanical, Responses,
    drive_model,
};
use commissioning::frequency_response::Line;
use commissioning::friction::MotorConstant;
use commissioning::record::Timing;
use commissioning::tuning::IDENTIFIED_LEARNING;

/// Sets of lines in the middle, and periods of each; fewer where the drives are known and only the load is another.
const OF_DRIVES: (u32, usize) = (3, 3);
const OF_LOAD: (u32, usize) = (2, 2);
const SETS_OF_WEAKER: u32 = 2;
const SETS_FAR_OUT: u32 = 2;
/// Lines that the model follows, Hz.
const TO_HZ: f64 = 2_300.0;
/// Least share of what an encoder shows that answers to its own drive, up to a frequency.
const LEAST_QUALITY: f64 = 0.9;
const QUALITY_TO_HZ: f64 = 1_000.0;
/// Most that the model may leave of the responses.
const MOST_LEFT: f64 = 0.2;
/// Most that a number may be uncertain by (one standard deviation), over itself: of a winding, of the drives' inertia and mass, of the inertia.
const WINDING: f64 = 0.05;
const INERTIA: f64 = 0.1;
const INERTIA_OF_LOAD: f64 = 0.2;
const RUBS: &str = "look for what rubs, gives way or is loose, and for noise on encoders and current sensors; then once more";

pub(super) fn run(
    bench: &mut Bench<'_>,
    known: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    allow(bench, PEAK_V)?;
    let Identified { excited, model } = identify(bench, known, found)?;
    let quality = quality(&excited.lines);
    found.push(Finding::new(
        format!("share of the angles that answers to the drive, up to {QUALITY_TO_HZ:.0} Hz"),
        format!("{quality:.3} at nine lines of ten"),
        format!("over {LEAST_QUALITY}"),
        quality > LEAST_QUALITY,
        RUBS,
    ));
    let model = match model {
        Ok(model) => model,
        Err(error) => return fail(error.to_string(), RUBS),
    };
    tell_drives(bench, known, found, &model)?;
    tell_platform(bench, found, &model.mechanical)?;
    known.model = Some(model);
    known.excited = Some(excited);
    Ok(())
}

/// What was recorded in the middle, and the model of all that was.
struct Identified {
    excited: Excited,
    model: Result<DriveModel, DriveError>,
}

/// From excitations of a peak, and from weaker ones; all more gently where the model does not follow that: in the middle alone, before more is recorded,
/// or in the end. Only then: what play does is the more of it the weaker the excitation is.
fn identify(
    bench: &mut Bench<'_>,
    known: &Known,
    found: &mut Found,
) -> Result<Identified, CommissionError> {
    let fitting = Fitting::new(bench, known)?;
    let (sets, periods) = if known.is_loaded_anew {
        OF_LOAD
    } else {
        OF_DRIVES
    };
    let in_the_middle = |bench: &mut Bench<'_>, peak_v: f64| {
        excite(bench, &CENTRE, (sets, peak_v), Recorded::Drives { periods })
    };
    let excited = in_the_middle(bench, PEAK_V)?;
    let fits = |model: &DriveModel| model.mechanical.residual < MOST_LEFT;
    if fitting.model(&excited, &[], &[]).as_ref().is_ok_and(fits) {
        let identified = fitting.complete(bench, excited)?;
        if identified.model.as_ref().is_ok_and(fits) {
            return Ok(identified);
        }
    }
    found.push(Finding::told(
        "measured once more, more gently",
        format!("with {GENTLE_V} V; {PEAK_V} V may have lifted the teeth of the gears where they resonate"),
    ));
    let excited = in_the_middle(bench, GENTLE_V)?;
    fitting.complete(bench, excited)
}

/// What a model is found with besides what is recorded.
struct Fitting {
    before: Before,
    far_place: Place,
}

impl Fitting {
    fn new(bench: &mut Bench<'_>, known: &Known) -> Result<Self, CommissionError> {
        let far_place = place_of(bench, &FAR_OUT)?;
        let before = Before {
            knee_a: bench.parameter(id::of(id::DEAD_TIME_KNEE, 0))?,
            motor_constants: known.motor_constants,
            guess: Guess::STAGE,
            to_hz: TO_HZ,
        };
        Ok(Self { before, far_place })
    }

    fn model(
        &self,
        excited: &Excited,
        weaker: &[Line],
        far: &[Line],
    ) -> Result<DriveModel, DriveError> {
        let responses = Responses {
            lines: &excited.lines,
            weaker,
            times: WEAKER,
            far,
            far_place: &self.far_place,
        };
        drive_model(&excited.runs, &responses, &Timing::STAGE, &self.before)
    }

    /// Records far out and more weakly as well.
    fn complete(
        &self,
        bench: &mut Bench<'_>,
        excited: Excited,
    ) -> Result<Identified, CommissionError> {
        let peak_v = excited.peak_v;
        let far = excite(bench, &FAR_OUT, (SETS_FAR_OUT, peak_v), Recorded::Loop)?;
        let weaker = (SETS_OF_WEAKER, peak_v / WEAKER);
        let weaker = excite(bench, &CENTRE, weaker, Recorded::Loop)?;
        let model = self.model(&excited, &weaker.lines, &far.lines);
        Ok(Identified { excited, model })
    }
}

/// Sets the largest voltage of an excitation, which takes a servo that is off.
pub(super) fn allow(bench: &mut Bench<'_>, volts: f64) -> Result<(), CommissionError> {
    bench.ask("SVO X 0")?;
    bench.delay(0.3)?;
    bench.set(&[(id::EXCITATION_V, volts)])?;
    bench.hold()
}

/// Of all lines but a tenth: beside a resonance of the platform little of a ring's angle is left to answer.
fn quality(lines: &[Line]) -> f64 {
    let mut all: Vec<f64> = (lines.iter())
        .filter(|line| line.hz < QUALITY_TO_HZ)
        .map(Line::quality)
        .collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 10).copied().unwrap_or(0.0)
}

fn uncertain(name: impl Into<String>, value: String, deviation: f64, most: f64) -> Finding {
    Finding::new(
        name,
        format!("{value}, +-{:.1} %", 100.0 * deviation),
        format!("known to {:.0} %", 100.0 * most),
        deviation < most,
        RUBS,
    )
}

fn tell_drives(
    bench: &mut Bench<'_>,
    known: &mut Known,
    found: &mut Found,
    model: &DriveModel,
) -> Result<(), CommissionError> {
    let inertia = model.mechanical.chain.inertia(&Place::centre());
    for pivot in 0..AXES {
        let drive = &model.electrical[pivot];
        let [ohm, henry] = [drive.resistance_ohm, drive.inductance_h];
        let deviation = f64::max(
            drive.deviations[0] / drive.resistance_ohm,
            drive.deviations[1] / drive.inductance_h,
        );
        found.push(uncertain(
            format!("winding of pivot {} while it turns", pivot + 1),
            format!("{ohm:.3} ohm, {:.3} mH", henry * 1e3),
            deviation,
            WINDING,
        ));
        found.push(Finding::told(
            format!("pivot {}: R J / K", pivot + 1),
            format!(
                "{:.5} V s^2/rad, of {:.4} kg m^2 at the ring and {:.3} V s/rad",
                ohm * inertia[(pivot, pivot)] / drive.motor_constant,
                inertia[(pivot, pivot)],
                drive.motor_constant
            ),
        ));
        let name = format!("winding of pivot {}", pivot + 1);
        found.number(name.clone(), ohm, "ohm");
        found.number(name, henry * 1e3, "mH");
        found.number(
            format!("pivot {}: R J / K", pivot + 1),
            ohm * inertia[(pivot, pivot)] / drive.motor_constant,
            "V s^2/rad",
        );
        known.windings[pivot] = [ohm, henry];
        known.motor_constants[pivot] = MotorConstant::known(drive.motor_constant);
        let torque_constant = torque_constant(bench, pivot, drive.motor_constant)?;
        bench.set(&[
            torque_constant,
            (id::of(id::RESISTANCE, pivot), ohm),
            (id::of(id::INDUCTANCE, pivot), henry),
        ])?;
    }
    Ok(())
}

fn tell_platform(
    bench: &mut Bench<'_>,
    found: &mut Found,
    mechanical: &Mechanical,
) -> Result<(), CommissionError> {
    let chain = &mechanical.chain;
    let (drive, load) = (chain.motor_inertia + chain.ring_inertia, &chain.load);
    let radius_m = 1e-3 * bench.parameter(id::TRACK_RADIUS)?;
    let mass_kg = load.mass / (radius_m * radius_m);
    found.push(Finding::new(
        "what the model of motors, rings and platform leaves of the responses",
        format!("{:.1} %", 100.0 * mechanical.residual),
        format!("under {:.0} %", 100.0 * MOST_LEFT),
        mechanical.residual < MOST_LEFT,
        RUBS,
    ));
    found.push(uncertain(
        "inertia of a motor with its ring",
        format!("{drive:.5} kg m^2"),
        mechanical.drive_inertia_deviation,
        INERTIA,
    ));
    found.push(uncertain(
        "mass of platform and load",
        format!("{mass_kg:.2} kg"),
        mechanical.deviations[MASS],
        INERTIA,
    ));
    found.push(uncertain(
        "their inertia about the platform's centre",
        format!("{:.4} kg m^2", load.inertia),
        mechanical.deviations[LOAD_INERTIA],
        INERTIA_OF_LOAD,
    ));
    found.push(Finding::told(
        "the motor's part of that, by the resonances",
        format!(
            "{:.5} kg m^2, +-{:.1} %",
            chain.motor_inertia,
            100.0 * mechanical.deviations[0]
        ),
    ));
    found.number("inertia of a motor with its ring", drive, "kg m^2");
    found.number("inertia of a motor", chain.motor_inertia, "kg m^2");
    found.number("mass of platform and load", mass_kg, "kg");
    found.number("inertia of platform and load", load.inertia, "kg m^2");
    for (number, hz) in (1..).zip(chain.resonances_hz(&Place::centre())) {
        found.number(format!("resonance {number}"), hz, "Hz");
    }
    let resonances: Vec<_> = (chain.resonances_hz(&Place::centre()).iter())
        .map(|hz| format!("{hz:.0}"))
        .collect();
    found.push(Finding::told(
        "resonances in the middle, where play in the gears is not crossed",
        format!("{} Hz", resonances.join(", ")),
    ));
    let softer = 1.0 - mechanical.excited.stiffness / chain.stiffness;
    found.push(Finding::told(
        "play in the gears, where these sines cross it",
        format!("makes the transmission {:.0} % softer", 100.0 * softer),
    ));
    carried::set(bench, chain, radius_m)?;
    Ok(bench.set(&[(id::LEARNING, IDENTIFIED_LEARNING)])?)
}
