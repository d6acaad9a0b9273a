//! What lines about calibration mean.

use super::request::{CalibrationAction, LINE_NUMBERS};
use crate::gcs::arguments::{ParseError, number, required, whole};
use crate::gcs::error::ErrorCode;
use crate::gcs::request::{Action, Request};
use crate::gcs::scan::Scanner;
use crate::gcs::text::Text;
use kinematics::COEFFICIENTS;

type Parsed = Result<Request, ParseError>;

/// `CAL BEG`: serial number, date, and perhaps the temperature.
pub(in crate::gcs) fn begin(scanner: &mut Scanner<'_>) -> Parsed {
    let serial = text(scanner, "a serial number")?;
    let date = text(scanner, "a date")?;
    let temperature_c = if scanner.is_at_end() {
        None
    } else {
        Some(number(scanner.next())? as f32)
    };
    act(CalibrationAction::Begin(serial, date, temperature_c))
}

/// `CAL SET`: pivot, the first number's place, numbers.
pub(in crate::gcs) fn set(scanner: &mut Scanner<'_>) -> Parsed {
    let pivot = whole(scanner.next(), 1.0, 3.0)? as usize - 1;
    let first = whole(scanner.next(), 1.0, COEFFICIENTS as f64)? as usize - 1;
    let mut numbers = [0.0; LINE_NUMBERS];
    let mut count = 0;
    loop {
        let word = scanner.next();
        let place = (numbers
            .get_mut(count)
            .filter(|_| first + count < COEFFICIENTS))
        .ok_or_else(|| word.error(ErrorCode::ParameterCount, "the end of the line"))?;
        *place = number(word)? as f32;
        count += 1;
        if scanner.is_at_end() {
            break;
        }
    }
    act(CalibrationAction::Set {
        pivot,
        first,
        numbers,
        count,
    })
}

/// `CAL END`: the checksum.
pub(in crate::gcs) fn end(scanner: &mut Scanner<'_>) -> Parsed {
    let checksum = whole(scanner.next(), 0.0, f64::from(u32::MAX))?;
    act(CalibrationAction::End(checksum as u32))
}

/// `TMP`: deg C, and perhaps ppm per K.
pub(in crate::gcs) fn temperature(scanner: &mut Scanner<'_>) -> Parsed {
    let celsius = number(scanner.next())?;
    let growth_ppm_per_k = if scanner.is_at_end() {
        None
    } else {
        Some(number(scanner.next())?)
    };
    act(CalibrationAction::Temperature(celsius, growth_ppm_per_k))
}

fn act(action: CalibrationAction) -> Parsed {
    Ok(Request::Act(Action::Calibrate(action)))
}

fn text(scanner: &mut Scanner<'_>, expected: &'static str) -> Result<Text, ParseError> {
    let word = required(scanner, expected)?;
    Text::new(word.text).ok_or_else(|| word.error(ErrorCode::OutOfRange, expected))
}
