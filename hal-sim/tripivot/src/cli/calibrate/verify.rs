//! `tripivot calibrate verify`: the calibration in force, judged by fresh poses.

use std::io::{self, Write};
use std::process::ExitCode;

use calibration::{Instrument, Noise};
use desk::calibrate::{Told, Verdict, verify};
use desk::date::age_days;

use super::super::FAILED;
use super::super::arguments::CalibrateVerify;
use super::super::error::CliError;
use super::super::json;
use super::error::CalibrateError;
use super::measure::opened;
use super::{BASE_M, calibration, line, nm};

/// Days after which a calibration is worth a new one: guides wear, and are set anew.
const OLD_DAYS: u64 = 365;

pub(super) fn run(arguments: &CalibrateVerify) -> Result<ExitCode, CliError> {
    let calibration = calibration(&arguments.file)?;
    let made = &calibration.made;
    let told = made.noise();
    let noise = Noise {
        length: arguments
            .noise
            .map_or(told.length, |noise_m| noise_m * 1e9 / nm(1.0)),
        angle_rad: match (arguments.noise_theta, arguments.noise) {
            (Some(theta_rad), _) => theta_rad,
            (None, Some(noise_m)) => noise_m / BASE_M,
            (None, None) => told.angle_rad,
        },
        // The machine's scatter is the same before any instrument.
        ..told
    };
    let instrument = Instrument::new(arguments.kit.unwrap_or(made.kit), noise);
    let (mut machine, mut reader) =
        opened(&arguments.stage, arguments.reader.as_deref(), &instrument)?;
    let verified = verify(
        machine.as_mut(),
        reader.as_mut(),
        &calibration,
        &instrument,
        arguments.poses,
    )
    .map_err(CalibrateError::Verify)?;
    let told = Told::new(&instrument, &verified);
    if arguments.json {
        json::print(&told)?;
    } else {
        (io::stdout().write_all(text(&told).as_bytes())).map_err(CliError::output)?;
    }
    let temperature = machine.ask("TMP?").ok().flatten().unwrap_or_default();
    for warning in warnings(age_days(&made.date), &temperature) {
        eprintln!("tripivot: {warning}");
    }
    Ok(match verified.verdict() {
        Verdict::Holds | Verdict::Better => ExitCode::SUCCESS,
        Verdict::Worse | Verdict::WorseThanDrawn => ExitCode::from(FAILED),
    })
}

/// What the controller cannot know, as it has no clock, and what it has been told.
fn warnings(age_days: Option<u64>, temperature: &str) -> Vec<String> {
    let old = age_days.filter(|days| *days > OLD_DAYS);
    let old = old.map(|days| format!("this calibration is {days} days old"));
    let over = temperature.lines().map(str::trim);
    let is_off = over.clone().any(|line| line == "STATE=OFF");
    let over = over.filter_map(|line| line.strip_prefix("OVER="));
    let off = over
        .filter(|_| is_off)
        .map(|over_k| format!("the machine is {over_k} K warmer than when it was calibrated"));
    old.into_iter().chain(off).collect()
}

pub(super) fn text(document: &Told) -> String {
    let poses = document.visits / 2;
    let mut text = line(
        "verified",
        &format!(
            "{}, {poses} fresh poses, each from both sides",
            document.kit
        ),
    );
    let kinds = [
        ("x and y", "um", &document.xy_um),
        ("theta", "urad", &document.theta_urad),
    ];
    for (what, unit, kind) in kinds {
        let Some(kind) = kind else { continue };
        let told = |more: &str, told: String| line(&format!("{what}{more}"), &told);
        text += &told(
            "",
            format!(
                "{:.4} {unit} rms seen, {:.4} of it noise and scatter: {}, {:.4} predicted",
                kind.seen,
                kind.noise,
                if kind.of_stage > 0.0 {
                    format!("{:.4} of the stage", kind.of_stage)
                } else {
                    "nothing of the stage to be seen".to_owned()
                },
                kind.predicted
            ),
        );
        text += &told(
            ", over predicted",
            format!(
                "{:.3}, noise in both; from {} to {} is as predicted",
                kind.ratio, document.as_predicted[0], document.as_predicted[1]
            ),
        );
        text += &told(
            ", largest",
            format!(
                "{:.4} {unit}, on visit {}",
                kind.largest, kind.largest_at_visit
            ),
        );
        text += &told(
            ", both sides",
            format!(
                "{:.4} {unit} rms apart, {:.4} by noise and scatter alone",
                kind.both_sides_apart,
                kind.noise * std::f64::consts::SQRT_2
            ),
        );
        text += &told(
            ", as drawn",
            format!("{:.3} {unit} rms without it", kind.as_drawn),
        );
    }
    if let Some(scale) = document.scale {
        let told = format!("{scale:.7} of the instrument's, taken out: the calibration knows none");
        text += &line("scale", &told);
    }
    let verdict = match &*document.verdict {
        "worse than predicted" | "worse than without it" => format!(
            "{}: another machine's, damaged, out of date, or the instrument is not what was said; `tripivot calibrate undo` takes it out of force",
            document.verdict
        ),
        "better than predicted" => {
            "better than predicted: the noise is not what was said".to_owned()
        }
        verdict => verdict.to_owned(),
    };
    text + &line("verdict", &verdict)
}

#[cfg(test)]
mod tests {
    use super::warnings;

    #[test]
    fn age_and_temperature_are_warned_of() {
        let off = "TEMPERATURE=24.5 \nGROWTH=12 \nOVER=4.000 \nSTATE=OFF\n";
        let warm = "the machine is 4.000 K warmer than when it was calibrated";
        assert_eq!(warnings(Some(365), ""), [""; 0]);
        assert_eq!(warnings(None, &off.replace("OFF", "CALIBRATED")), [""; 0]);
        assert_eq!(
            warnings(Some(366), off),
            ["this calibration is 366 days old", warm]
        );
    }
}
