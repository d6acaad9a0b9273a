//! What lines about calibration do.

use super::request::CalibrationAction;
use crate::calibration::{CalibrationText, MachineCalibration};
use crate::gcs::error::ErrorCode;
use crate::gcs::events::Event;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::session::Session;
use crate::gcs::text::Text;
use crate::queues::CommandQueues;
use kinematics::COEFFICIENTS;

/// Command level that it needs: that of the encoders' zeros.
const LEVEL: u8 = 1;
/// All numbers of a pivot, a bit each.
const ALL_GIVEN: u64 = (1 << COEFFICIENTS) - 1;

/// Temperatures of a machine that anybody means, deg C.
const TEMPERATURES_C: core::ops::RangeInclusive<f64> = -50.0..=100.0;
/// And how much it can grow, ppm per K: plastics do not, as far as a nanometre counts.
const GROWTHS_PPM_PER_K: core::ops::RangeInclusive<f64> = 0.0..=50.0;
/// Further off than that, K, a calibration is not what was measured: parts of other materials bend what they are screwed to.
pub(super) const CALIBRATED_WITHIN_K: f64 = 2.0;

/// What has been given since `CAL BEG`.
pub(in crate::gcs) struct GatheredCalibration {
    machine: MachineCalibration,
    /// Which numbers, a bit each.
    given: [u64; 3],
}

impl Interpreter {
    /// `CAL BEG`, `CAL SET`, `CAL END`, `CAL ON`, `CAL OFF`, `CAL DEL`, `TMP`.
    // In a frame of its own: calibrations that are copied there are not on the stack while a line is planned.
    #[inline(never)]
    pub(in crate::gcs) fn change_calibration(
        &mut self,
        action: &CalibrationAction,
        session: &Session,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        // The temperature is no calibration: it is told again and again, and forgotten with the next start.
        if let CalibrationAction::Temperature(celsius, growth_ppm_per_k) = *action {
            return self.set_temperature(celsius, growth_ppm_per_k);
        }
        if session.level < LEVEL {
            return Err(ErrorCode::LevelTooLow);
        }
        match action {
            CalibrationAction::Begin(serial, date, temperature_c) => {
                self.begin_calibration(serial, date, *temperature_c)
            }
            CalibrationAction::Set {
                pivot,
                first,
                numbers,
                count,
            } => {
                let numbers = numbers.get(..*count).unwrap_or_default();
                self.gather_calibration(*pivot, *first, numbers)
            }
            CalibrationAction::End(checksum) => self.end_calibration(*checksum, queues),
            CalibrationAction::Switch(on) => self.switch_calibration(*on, queues),
            CalibrationAction::Forget => self.use_calibration(None, queues),
            CalibrationAction::Temperature(..) => Ok(()),
        }
    }

    fn set_temperature(
        &mut self,
        celsius: f64,
        growth_ppm_per_k: Option<f64>,
    ) -> Result<(), ErrorCode> {
        let is_growth = growth_ppm_per_k.is_none_or(|ppm| GROWTHS_PPM_PER_K.contains(&ppm));
        if !TEMPERATURES_C.contains(&celsius) || !is_growth {
            return Err(ErrorCode::OutOfRange);
        }
        self.commander.set_temperature(celsius, growth_ppm_per_k)?;
        self.watch_temperature();
        Ok(())
    }

    /// Tells when the machine leaves the temperature at which it was calibrated, and when it is back.
    fn watch_temperature(&mut self) {
        let over_k = self.commander.over_calibrated_k();
        let is_off = over_k.is_some_and(|over_k| over_k.abs() > CALIBRATED_WITHIN_K);
        if is_off != self.is_off_calibrated_temperature {
            self.is_off_calibrated_temperature = is_off;
            let event = Event::CalibratedTemperature(is_off, over_k.unwrap_or_default() as f32);
            self.events.add(self.commander.tick(), event);
        }
    }

    fn begin_calibration(
        &mut self,
        serial: &Text,
        date: &Text,
        temperature_c: Option<f32>,
    ) -> Result<(), ErrorCode> {
        self.gathered_calibration = None;
        if !(serial.as_bytes()).eq_ignore_ascii_case(self.identity.serial.as_bytes()) {
            return Err(ErrorCode::CalibrationOfAnother);
        }
        // As long as a text can be.
        let text = |text: &Text| CalibrationText::try_from(text.as_str()).unwrap_or_default();
        self.gathered_calibration = Some(GatheredCalibration {
            machine: MachineCalibration {
                serial: text(serial),
                date: text(date),
                temperature_c,
                numbers: [[0.0; COEFFICIENTS]; 3],
                is_on: true,
            },
            given: [0; 3],
        });
        Ok(())
    }

    fn gather_calibration(
        &mut self,
        pivot: usize,
        first: usize,
        numbers: &[f32],
    ) -> Result<(), ErrorCode> {
        let gathered = (self.gathered_calibration.as_mut()).ok_or(ErrorCode::NotAllowed)?;
        let (Some(list), Some(given)) = (
            gathered.machine.numbers.get_mut(pivot),
            gathered.given.get_mut(pivot),
        ) else {
            return Err(ErrorCode::OutOfRange);
        };
        for (place, &number) in (first..).zip(numbers) {
            *list.get_mut(place).ok_or(ErrorCode::OutOfRange)? = number;
            *given |= 1 << place;
        }
        Ok(())
    }

    fn end_calibration(
        &mut self,
        checksum: u32,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        let gathered = (self.gathered_calibration.as_ref()).ok_or(ErrorCode::NotAllowed)?;
        if gathered.given != [ALL_GIVEN; 3] || gathered.machine.checksum() != checksum {
            self.gathered_calibration = None;
            return Err(ErrorCode::CalibrationDamaged);
        }
        let machine = gathered.machine.clone();
        self.use_calibration(Some(machine), queues)?;
        self.gathered_calibration = None;
        Ok(())
    }

    fn switch_calibration(
        &mut self,
        on: bool,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        let machine = self.commander.calibration().ok_or(ErrorCode::NotAllowed)?;
        let machine = MachineCalibration {
            is_on: on,
            ..machine.clone()
        };
        self.use_calibration(Some(machine), queues)
    }

    /// It is stored as soon as nothing moves.
    fn use_calibration(
        &mut self,
        machine: Option<MachineCalibration>,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        self.commander.calibrate(machine, queues)?;
        self.watch_temperature();
        self.persistence.mark_changed();
        Ok(())
    }
}
