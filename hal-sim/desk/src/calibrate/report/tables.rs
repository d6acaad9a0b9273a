//! The numbers of a report: what came of it, predicted beside seen, what cannot be told, and the coefficients.

use calibration::file::{Calibration, Made};
use calibration::freedom::Freedom;
use calibration::{Kit, Plan, numbers as names, plan};
use drawing::page::{escaped, table};
use kinematics::COEFFICIENTS;

use super::super::told::Told;
use super::maps::figures;
use super::{Found, Report};

/// Numbers of a pivot that are shown at once; the others unfold.
const FIRST: usize = 6;

/// What came of it.
pub(super) fn summary(report: &Report<'_>, found: &Found) -> String {
    let made = &report.calibration.made;
    let celsius = (made.temperature_c).map_or_else(
        || "not told".to_owned(),
        |celsius| format!("{celsius} deg C; 1 K is 1 to 2 um at the rim"),
    );
    let verdict = report.verified.map_or_else(
        || "not verified".to_owned(),
        |told| format!("{}, by {} fresh poses", told.verdict, told.visits / 2),
    );
    let scatter = if made.scatter_nm > 0.0 {
        format!(
            "{} nm at each pivot (the noise alone would leave a chi^2 of 1, and {:.1} is left); it is in all that is expected",
            figures(made.scatter_nm),
            found.fit.chi2_of_noise
        )
    } else {
        "none to be seen beside the instrument's noise".to_owned()
    };
    let row = |what: &str, told: String| [what.to_owned(), told];
    table(
        ["", ""],
        &[
            row("verdict", verdict),
            row(
                "expected of commanded poses",
                format!(
                    "x and y {} nm rms over the disk and all orientations, {} nm where it is worst; theta {} urad rms",
                    figures(made.expected_xy_nm),
                    figures(made.expected_worst_xy_nm),
                    figures(made.expected_theta_urad)
                ),
            ),
            row("what the machine does not repeat", scatter),
            row(
                "measured",
                format!(
                    "{}, {} poses, {} of them left out; noise {}",
                    made.kit,
                    made.visits,
                    made.outliers,
                    noise(made)
                ),
            ),
            row(
                "chi^2 a row",
                format!(
                    "{:.2}, {:.2} of poses that were held out of the fit: 1 is what noise and scatter explain",
                    made.chi2, made.chi2_held_out
                ),
            ),
            row("date", made.date.clone()),
            row("temperature", celsius),
        ],
    )
}

/// The noise of what the instrument sees.
fn noise(made: &Made) -> String {
    let length = format!("{} nm", figures(made.noise_nm));
    let angle = format!("{} urad", figures(made.noise_urad));
    match made.kit {
        Kit::Xyt => format!("{length} and {angle}"),
        Kit::Theta => angle,
        Kit::Xy | Kit::Camera | Kit::Camera2 | Kit::Balls | Kit::Ends => length,
    }
}

/// Predicted beside seen.
pub(super) fn verified(told: Option<&Told>) -> String {
    let head = "<h2>Verified at fresh poses</h2>\n";
    let Some(told) = told else {
        return format!(
            "{head}<p>Not verified: `tripivot calibrate verify --json` tells what fresh poses say of it.</p>\n"
        );
    };
    let kinds = [
        ("x and y, um rms", told.xy_um),
        ("theta, urad rms", told.theta_urad),
    ];
    let rows: Vec<[String; 7]> = (kinds.into_iter())
        .filter_map(|(what, kind)| {
            let kind = kind?;
            Some([
                what.to_owned(),
                figures(kind.as_drawn),
                figures(kind.seen),
                figures(kind.noise),
                figures(kind.noise.hypot(kind.predicted)),
                format!(
                    "{:.2} ({} to {})",
                    kind.ratio, told.as_predicted[0], told.as_predicted[1]
                ),
                figures(kind.largest),
            ])
        })
        .collect();
    let columns = [
        "",
        "without it",
        "seen",
        "of it noise and scatter",
        "was to be seen",
        "seen over that (limits)",
        "largest",
    ];
    format!(
        "{head}{}<p>{}, by {}.</p>\n",
        table(columns, &rows),
        escaped(&told.verdict),
        told.kit
    )
}

/// What cannot be told, and what is the user's to choose.
pub(super) fn freedoms(found: &Found) -> String {
    // Of the plan, not of what was measured: a frame is free to rounding only where every mark is under its camera.
    let Some(Plan { freedoms, .. }) = plan(&found.instrument, 1) else {
        return String::new();
    };
    let listed = |is_choice: bool| {
        let named = freedoms
            .named
            .iter()
            .filter(|freedom| freedom.is_choice() == is_choice);
        let mut names: Vec<String> = named.map(Freedom::to_string).collect();
        if !is_choice && freedoms.unnamed() > 0 {
            names.push(format!(
                "{} more directions of the numbers",
                freedoms.unnamed()
            ));
        }
        if names.is_empty() {
            return "nothing".to_owned();
        }
        names.join("; ")
    };
    format!(
        "<p>Yours to choose, and no errors: {}. They follow from where the drawing has its frames, and, of the scale, from the one length that was \
         known.</p>\n<p>Not identifiable with this instrument, so held at what a workshop keeps: {}.</p>\n",
        escaped(&listed(true)),
        escaped(&listed(false))
    )
}

/// All numbers with their uncertainties and limits.
pub(super) fn numbers(calibration: &Calibration, found: &Found) -> String {
    let radius_mm = calibration.made.track_radius_mm;
    let lists = calibration.machine().map(|pivot| names::to_list(&pivot));
    let limits: Vec<(&str, f64)> = (calibration.pivots[0].numbers())
        .map(|(name, _, most)| (name, most))
        .collect();
    let rows: Vec<[String; 6]> = (0..COEFFICIENTS)
        .map(|number| {
            let (key, most) = limits[number];
            // um or urad.
            let (unit, factor) = if key.ends_with("_mm") {
                ("um", radius_mm * 1e3)
            } else {
                ("urad", 1e6)
            };
            let limit = if unit == "um" { most * 1e3 } else { most * 1e6 };
            let name = names::name(0, number);
            let told = |pivot: usize| {
                let deviation = found.deviations[COEFFICIENTS * pivot + number] * factor;
                format!(
                    "{:.3} \u{b1} {}",
                    lists[pivot][number] * factor,
                    figures(deviation)
                )
            };
            [
                format!("{}, {unit}", name.trim_end_matches(" of pivot 1")),
                told(0),
                told(1),
                told(2),
                figures(names::size(number) * factor),
                format!("{limit:.0}"),
            ]
        })
        .collect();
    let columns = [
        "number",
        "pivot 1",
        "pivot 2",
        "pivot 3",
        "a workshop keeps",
        "limit",
    ];
    format!(
        "<p>Each with one standard deviation. Those of the first six are large although the machine is known well: numbers of all three pivots together \
         are also a choice of frames. What counts is the expected error above.</p>\n{}<details><summary>Harmonics and straightness</summary>\n{}</details>\n",
        table(columns, &rows[..FIRST]),
        table(columns, &rows[FIRST..])
    )
}
