//! The calibration, as it is stored.
//!
//! | bytes | what |
//! |---|---|
//! | 1 | 1 counts, 0 does not |
//! | 1, n | length of the serial number, serial number |
//! | 1, n | length of the date, date |
//! | 4 | temperature, deg C, as a 32-bit float; no number where it is not known |
//! | each 4 | 48 numbers of each pivot, track radii and rad, as 32-bit floats |

use crate::calibration::{CALIBRATION_TEXT_BYTES, CalibrationText, MachineCalibration};
use crate::settings_store::{Reader, Sink};
use embedded_storage::nor_flash::NorFlash;
use kinematics::COEFFICIENTS;

/// Bytes of the longest.
pub(super) const CALIBRATION_BYTES: usize =
    1 + 2 * (1 + CALIBRATION_TEXT_BYTES) + 4 + 3 * COEFFICIENTS * 4;

pub(super) fn write<S: Sink>(
    calibration: &MachineCalibration,
    sink: &mut S,
) -> Result<(), S::Error> {
    sink.put(&[u8::from(calibration.is_on)])?;
    for text in [&calibration.serial, &calibration.date] {
        sink.put(&[text.len() as u8])?;
        sink.put(text.as_bytes())?;
    }
    let celsius = calibration.temperature_c.unwrap_or(f32::NAN);
    sink.put(&celsius.to_le_bytes())?;
    for number in calibration.numbers.as_flattened() {
        sink.put(&number.to_le_bytes())?;
    }
    Ok(())
}

/// What is stored; `None` when it is none that [`write`] gives.
pub(super) fn read<F: NorFlash>(reader: &mut Reader<'_, F>) -> Option<MachineCalibration> {
    let [is_on] = reader.take()?;
    let serial = read_text(reader)?;
    let date = read_text(reader)?;
    let celsius = f32::from_le_bytes(reader.take()?);
    let mut numbers = [[0.0; COEFFICIENTS]; 3];
    for number in numbers.as_flattened_mut() {
        *number = f32::from_le_bytes(reader.take()?);
    }
    (is_on <= 1).then_some(MachineCalibration {
        serial,
        date,
        temperature_c: celsius.is_finite().then_some(celsius),
        numbers,
        is_on: is_on == 1,
    })
}

fn read_text<F: NorFlash>(reader: &mut Reader<'_, F>) -> Option<CalibrationText> {
    let [length] = reader.take()?;
    let mut text = [0; CALIBRATION_TEXT_BYTES];
    let text = text.get_mut(..usize::from(length))?;
    reader.fill(text)?;
    CalibrationText::try_from(core::str::from_utf8(text).ok()?).ok()
}
