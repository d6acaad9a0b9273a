//! A calibration from what was measured, and what is told of the fit.

use calibration::file::{Calibration, Made};
use calibration::table::Table;
use calibration::{Accuracy, Drift, Fit, FitError, Instrument, Left, fit, left};
use kinematics::Geometry;
use serde::Serialize;

use super::line::{Line, URAD_PER_RAD, nm};
use crate::date::today;

/// Why there is no calibration.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
pub enum FittedError {
    /// The fit.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// Nothing can be said of its accuracy.
    #[error("the numbers of the instrument leave nothing to compute with")]
    Lost,
}

/// A fit, its calibration, and what has moved while was measured.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The fit.
    pub fit: Fit,
    /// For the controller.
    pub calibration: Calibration,
    /// None where the reference pose was not visited often enough.
    pub drift: Option<Drift>,
    /// What the fit leaves of each visit.
    pub left: Left,
}

impl Fitted {
    /// Fits a machine to a table. `serial`: what the machine is called.
    ///
    /// # Errors
    /// [`FittedError`].
    pub fn new(
        table: &Table,
        instrument: &Instrument,
        serial: &str,
        temperature_c: Option<f64>,
    ) -> Result<Self, FittedError> {
        let fit = fit(instrument, &table.visits)?;
        let accuracy = Accuracy::new(&fit.machine, &fit.factor, &instrument.sizes())
            .ok_or(FittedError::Lost)?;
        let made = made(serial, temperature_c, instrument, table, &fit, &accuracy);
        let noise = made.instrument_noise();
        let left = left(&table.instrument(noise), &fit, &table.visits)?;
        let references = table.references_but(&fit.outliers);
        Ok(Self {
            drift: Drift::of(&references, &left.visits, &noise),
            calibration: Calibration::new(made, &fit.machine),
            fit,
            left,
        })
    }
}

fn made(
    serial: &str,
    temperature_c: Option<f64>,
    instrument: &Instrument,
    table: &Table,
    fit: &Fit,
    accuracy: &Accuracy,
) -> Made {
    Made {
        serial: serial.to_owned(),
        date: today(),
        temperature_c,
        track_radius_mm: Geometry::REFERENCE.radius_mm,
        kit: table.kit,
        noise_nm: nm(instrument.noise.length),
        noise_urad: instrument.noise.angle_rad * URAD_PER_RAD,
        scatter_nm: nm(fit.scatter_rad),
        visits: table.visits.len(),
        outliers: fit.outliers.len(),
        chi2: fit.chi2,
        chi2_held_out: fit.chi2_held_out,
        expected_xy_nm: nm(accuracy.place_rms),
        expected_worst_xy_nm: nm(accuracy.worst_place_rms),
        expected_theta_urad: accuracy.turn_rms_rad * URAD_PER_RAD,
    }
}

/// What a fit is told as.
#[derive(Clone, Debug, Serialize)]
pub struct FitTold {
    /// The instrument.
    pub kit: &'static str,
    /// Poses that were visited.
    pub visits: usize,
    /// Those that were left out, by their lines in the file.
    pub outliers: Vec<usize>,
    /// Square misses over what is expected of them, a row.
    pub chi2: f64,
    /// The same over what the noise alone makes of them.
    pub chi2_of_noise: f64,
    /// What the machine itself does not repeat, at each pivot.
    pub scatter_nm: f64,
    /// Of poses that were held out of the fit.
    pub chi2_held_out: f64,
    /// Whether that is not what chance brings.
    pub chi2_is_doubtful: bool,
    /// What is expected of x and y together, rms.
    pub expected_xy_nm: f64,
    /// The same where it is worst.
    pub expected_worst_xy_nm: f64,
    /// What is expected of theta, rms.
    pub expected_theta_urad: f64,
    /// Of the reference pose from first to last, and one standard deviation of that; null where it was not visited often enough.
    pub drift: Option<Moved>,
    /// Whether the noise does not explain it.
    pub drift_is_significant: bool,
    /// Of the fit.
    pub steps: usize,
    /// Where the calibration is; empty while it is nowhere.
    pub file: String,
}

/// Drift of x, y and theta.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Moved {
    /// From first to last.
    pub minutes: f64,
    /// By how much.
    pub moved_nm_nm_urad: [f64; 3],
    /// By how much noise alone would, one standard deviation.
    pub noise_nm_nm_urad: [f64; 3],
}

impl FitTold {
    /// Of this fit; `file`: where its calibration is; empty while it is nowhere.
    #[must_use]
    pub fn new(fitted: &Fitted, table: &Table, file: &str) -> Self {
        let Fitted {
            fit,
            calibration,
            drift,
            ..
        } = fitted;
        let made = &calibration.made;
        Self {
            kit: table.kit.name(),
            visits: made.visits,
            outliers: (fit.outliers.iter())
                .filter_map(|&visit| table.lines.get(visit).copied())
                .collect(),
            chi2: fit.chi2,
            chi2_of_noise: fit.chi2_of_noise,
            scatter_nm: made.scatter_nm,
            chi2_held_out: fit.chi2_held_out,
            chi2_is_doubtful: fit.is_doubtful(),
            expected_xy_nm: made.expected_xy_nm,
            expected_worst_xy_nm: made.expected_worst_xy_nm,
            expected_theta_urad: made.expected_theta_urad,
            drift: drift.map(|drift| {
                let told = |[x, y, theta]: [f64; 3]| [nm(x), nm(y), theta * URAD_PER_RAD];
                Moved {
                    minutes: drift.seconds / 60.0,
                    moved_nm_nm_urad: told(drift.moved),
                    noise_nm_nm_urad: told(drift.noise),
                }
            }),
            drift_is_significant: drift.is_some_and(|drift| drift.is_significant()),
            steps: fit.steps,
            file: file.to_owned(),
        }
    }

    /// In words.
    #[must_use]
    pub fn lines(&self) -> Vec<Line> {
        let outliers = match &self.outliers[..] {
            [] => String::new(),
            lines => {
                let lines: Vec<String> = lines.iter().map(ToString::to_string).collect();
                format!(", without those of lines {}", lines.join(", "))
            }
        };
        let doubt = match (self.chi2_is_doubtful, self.chi2 < 1.0) {
            (false, _) => "",
            (true, true) => {
                ": under 1, so the noise is less than was said, and what is expected is too much"
            }
            (true, false) => {
                ": over 1, so the noise is more than was said, or the machine is not of this model, and what is expected does not hold"
            }
        };
        let mut lines = vec![
            Line::new(
                "measured",
                format!("{}, {} poses{outliers}", self.kit, self.visits),
            ),
            Line::judged(
                "chi^2 a row",
                format!(
                    "{:.2}, {:.2} of poses that were held out{doubt}",
                    self.chi2, self.chi2_held_out
                ),
                !self.chi2_is_doubtful,
            ),
            Line::new("machine's scatter", scatter(self)),
            Line::new(
                "expected, x and y",
                format!(
                    "{:.1} nm rms; {:.1} nm rms where it is worst",
                    self.expected_xy_nm, self.expected_worst_xy_nm
                ),
            ),
            Line::new(
                "expected, theta",
                format!("{:.3} urad rms", self.expected_theta_urad),
            ),
            Line::judged("drift", drift(self), !self.drift_is_significant),
        ];
        if !self.file.is_empty() {
            lines.push(Line::new("calibration in", self.file.clone()));
        }
        lines
    }
}

/// What the machine does not repeat, in words.
fn scatter(document: &FitTold) -> String {
    if document.scatter_nm == 0.0 {
        return "none to be seen: the noise explains what is left".to_owned();
    }
    format!(
        "{:.0} nm at each pivot: what is left is {:.1} times the square of the noise, and counts in what is expected",
        document.scatter_nm, document.chi2_of_noise
    )
}

/// What has moved, in words.
fn drift(document: &FitTold) -> String {
    let Some(Moved {
        minutes,
        moved_nm_nm_urad: [x, y, theta],
        noise_nm_nm_urad: [x_noise, y_noise, theta_noise],
    }) = document.drift
    else {
        return "unknown: the reference pose was not visited often enough".to_owned();
    };
    let verdict = if document.drift_is_significant {
        "more than the noise explains: something was warming up, and `apply` will refuse it"
    } else {
        "no more than the noise explains"
    };
    format!(
        "x {x:.0} nm, y {y:.0} nm, theta {theta:.2} urad in {minutes:.1} min, with {x_noise:.0}, {y_noise:.0} and {theta_noise:.2} by noise: {verdict}"
    )
}
