//! `tripivot calibrate verify`: the calibration in force, judged by fresh poses.

use std::io::{self, Write};
use std::process::ExitCode;

use calibration::{Instrument, Noise};
use desk::calibrate::{Told, Verdict, noise, verify};
use desk::date::age_days;

use super::super::FAILED;
use super::super::arguments::CalibrateVerify;
use super::super::error::CliError;
use super::super::json;
use super::error::CalibrateError;
use super::measure::opened;
use super::{calibration, lines};

/// Days after which a calibration is worth a new one: guides wear, and are set anew.
const OLD_DAYS: u64 = 365;

pub(super) fn run(arguments: &CalibrateVerify) -> Result<ExitCode, CliError> {
    let calibration = calibration(&arguments.file)?;
    let made = &calibration.made;
    let told = made.noise();
    let noise = arguments.noise.map_or(told, |noise_m| Noise {
        // The machine's scatter is the same before any instrument.
        encoder_rad: told.encoder_rad,
        ..noise(noise_m, None)
    });
    let noise = Noise {
        angle_rad: arguments.noise_theta.unwrap_or(noise.angle_rad),
        ..noise
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
        &mut |_, _| (),
    )
    .map_err(CalibrateError::Verify)?;
    let told = Told::new(&instrument, &verified);
    if arguments.json {
        json::print(&told)?;
    } else {
        (io::stdout().write_all(lines(&told.lines()).as_bytes())).map_err(CliError::output)?;
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
