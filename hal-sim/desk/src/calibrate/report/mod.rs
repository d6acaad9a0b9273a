//! All that is known of a calibration, as one page: what the machine was off, what is left, and how that is known.
//!
//! | file | idea |
//! |---|---|
//! | `maps` | errors over disk and orientation |
//! | `plots` | what the fit leaves: over visits, harmonics and time |
//! | `tables` | numbers with their uncertainties and limits; predicted beside seen; what cannot be told |

mod maps;
mod plots;
mod tables;

use calibration::file::Calibration;
use calibration::frames::{Pair, without_frames};
use calibration::table::Table;
use calibration::{Drift, Fit, FitError, Instrument, Left, fit, left, numbers};
use drawing::page::{END, escaped, figure, head};
use std::fmt::Write;

use super::told::Told;
pub use maps::{before_and_after, errors};
pub use plots::left_by_visit;

/// What a report is made of.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    /// The calibration.
    pub calibration: &'a Calibration,
    /// What it was fitted to.
    pub measured: &'a Table,
    /// What fresh poses have said of it, if they were asked.
    pub verified: Option<&'a Told>,
    /// True poses against commanded ones, which only a simulator knows.
    pub truth: Option<&'a Truth>,
}

/// True poses against commanded ones in a controller without and with the calibration.
#[derive(Clone, Debug)]
pub struct Truth {
    /// Without it.
    pub before: Vec<Pair>,
    /// With it.
    pub after: Vec<Pair>,
}

impl Truth {
    /// Root mean squares without and with it, frames and scale out: um and urad.
    #[must_use]
    pub fn sizes(&self) -> [[f64; 2]; 2] {
        let radius_mm = kinematics::Geometry::REFERENCE.radius_mm;
        [&self.before, &self.after].map(|pairs| sizes_of(pairs, radius_mm))
    }
}

/// Why there is no report.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum ReportError {
    /// The measurement.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// It is not what the calibration was fitted to.
    #[error(
        "the calibration is not the fit of this measurement: '{number}' is {told:.6e} in it, and {found:.6e} by the measurement"
    )]
    Another {
        /// Which number.
        number: String,
        /// In the calibration, track radii or rad.
        told: f64,
        /// By the measurement.
        found: f64,
    },
}

/// The fit again, with what the report tells of it.
struct Found {
    instrument: Instrument,
    fit: Fit,
    left: Left,
    /// One standard deviation of each number.
    deviations: Vec<f64>,
    drift: Option<Drift>,
}

/// The page.
///
/// # Errors
/// [`ReportError`].
pub fn page(report: &Report<'_>) -> Result<String, ReportError> {
    let found = found(report)?;
    let made = &report.calibration.made;
    let mut page = head(&format!("Calibration of {}", made.serial));
    // Writing to a text does not fail.
    let _ = writeln!(page, "<h1>Calibration of {}</h1>", escaped(&made.serial));
    page += &tables::summary(report, &found);
    if let Some(truth) = report.truth {
        page += "<h2>True pose against commanded pose</h2>\n";
        page += &figure(
            &before_and_after(truth),
            "Only a simulator knows this. Each arrow begins where the stage was sent, and shows how far off the platform truly came to rest, \
             magnified as the arrow at the right tells; its dot's colour is the error of theta. A column holds a quarter of all orientations. Above: \
             the controller believes the drawing. Below: it uses this calibration; mind the other scale.",
        );
    }
    page += "<h2>Errors of the machine before, by the fit</h2>\n";
    page += &figure(
        &maps::before(&found.fit.machine),
        "What a controller that believes the drawing does with this machine, over the disk of 80 mm, at four orientations. The pattern turns with \
         theta since most errors are of the platform's guides. Base frame, platform frame and scale are chosen so that the arrows are shortest.",
    );
    page += "<h2>What is expected to be left</h2>\n";
    if let Some(svg) = maps::expected(&found) {
        page += &figure(
            &svg,
            "One standard deviation of a commanded pose after this calibration: the radius of a circle is that of x and y together, its colour that of theta. \
             It grows towards the rim, where fewer measured poses lie around. The noise of a single pose, such as lost motion of guides, comes on top.",
        );
    }
    page += &tables::verified(report.verified);
    if let Some(told) = report.verified {
        page += &figure(
            &maps::seen(told),
            "What the instrument saw at fresh poses, each gone to from both sides: above as the controller without calibration would have had it, below \
             with it; the instrument's noise is in both. Below there should be no pattern: arrows of all directions. \
             Above, a camera takes a part of the machine's errors for those of the plate, whose marks nobody knows.",
        );
    }
    page += "<h2>What the fit leaves</h2>\n";
    page += &plots::visits(&found);
    page += &plots::harmonics(&found);
    page += "<h2>Drift while was measured</h2>\n";
    page += &plots::drift(report.measured, &found);
    page += "<h2>What cannot be told</h2>\n";
    page += &tables::freedoms(&found);
    page += "<h2>Numbers</h2>\n";
    page += &tables::numbers(report.calibration, &found);
    Ok(page + END)
}

fn found(report: &Report<'_>) -> Result<Found, ReportError> {
    let table = report.measured;
    let instrument = table.instrument(report.calibration.made.instrument_noise());
    let fit = fit(&instrument, &table.visits)?;
    is_of(report.calibration, &fit)?;
    let left = left(&instrument, &fit, &table.visits)?;
    let deviations = fit.factor.deviations().ok_or(FitError::NotFinite)?;
    let sizes = instrument.sizes();
    let references = table.references_but(&fit.outliers);
    Ok(Found {
        drift: Drift::of(&references, &left.visits, &instrument.noise),
        deviations: (deviations.iter().zip(&sizes))
            .map(|(deviation, size)| deviation * size)
            .collect(),
        instrument,
        fit,
        left,
    })
}

/// A calibration is this fit, to what its file has rounded.
fn is_of(calibration: &Calibration, fit: &Fit) -> Result<(), ReportError> {
    let pivots = calibration.machine().into_iter().zip(&fit.machine);
    for (i, (told, found)) in pivots.enumerate() {
        let (told, found) = (numbers::to_list(&told), numbers::to_list(found));
        for (number, (&told, &found)) in told.iter().zip(&found).enumerate() {
            if (told - found).abs() > 1e-6 * numbers::size(number) {
                return Err(ReportError::Another {
                    number: numbers::name(i, number),
                    told,
                    found,
                });
            }
        }
    }
    Ok(())
}

/// Root mean squares of errors, frames and scale out: um and urad.
fn sizes_of(pairs: &[Pair], radius_mm: f64) -> [f64; 2] {
    let size = without_frames(pairs).size();
    [size.place_rms * radius_mm * 1e3, size.turn_rms_rad * 1e6]
}
