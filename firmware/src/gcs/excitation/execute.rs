//! What lines about excitations do.

use super::request::{ExcitationRequest, Shape};
use crate::control::excitation::{
    Excitation, ExcitationGuards, ExcitationSignal, ExcitationUntil, Multisine, line_harmonics,
};
use crate::control::units::UNITS_PER_RAD;
use crate::gcs::error::ErrorCode;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::session::Session;
use crate::queues::CommandQueues;

/// Command level that an excitation needs: that of the parameters which it is to find.
const LEVEL: u8 = 1;
/// Longest excitation: whoever asked for it may be gone.
const MAX_MS: f64 = 20_000.0;

impl Interpreter {
    /// `EXC`: begins an excitation within the parameters of group `excitation`.
    pub(in crate::gcs) fn excite(
        &mut self,
        request: &ExcitationRequest,
        session: &mut Session,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        if session.level < LEVEL {
            return Err(ErrorCode::LevelTooLow);
        }
        let excitation = self.excitation(request).ok_or(ErrorCode::OutOfRange)?;
        self.commander.begin_excitation(excitation, queues)?;
        self.note_mover(session);
        Ok(())
    }

    /// What is asked for in the tick's units; `None` where it is out of its range.
    fn excitation(&self, request: &ExcitationRequest) -> Option<Excitation> {
        let is_positive = |value: &f64| *value > 0.0;
        let until = [request.until_mrad, request.until_a];
        if !(0.0..=MAX_MS).contains(&request.ms) || !until.iter().flatten().all(is_positive) {
            return None;
        }
        let ticks = self.commander.ticks(request.ms) as u32;
        let until =
            ExcitationUntil::new(request.until_mrad.map(|mrad| mrad * 1e-3), request.until_a);
        Some(Excitation {
            pivot: request.pivot,
            signal: self.excitation_signal(&request.shape, ticks)?,
            ticks,
            until,
            guards: ExcitationGuards::new(&self.parameters),
        })
    }

    fn excitation_signal(&self, shape: &Shape, ticks: u32) -> Option<ExcitationSignal> {
        let limits = &self.parameters.excitation;
        let allowed = |volts: f64| (volts.abs() <= limits.voltage_v).then_some(volts);
        Some(match *shape {
            Shape::Step { volts } => ExcitationSignal::Volts {
                start: allowed(volts)? as f32,
                per_tick: 0.0,
            },
            Shape::Ramp { volts } => ExcitationSignal::Volts {
                start: 0.0,
                per_tick: (allowed(volts)? / f64::from(ticks.max(1))) as f32,
            },
            Shape::Sines {
                volts,
                harmonics: [first, last],
                lines,
            } => ExcitationSignal::Sines(Multisine::new(
                &line_harmonics(first, last, lines),
                allowed(volts)?,
            )),
            Shape::Ring { mrad, mrad_s } => {
                let (way_rad, rate_rad_s) = (mrad * 1e-3, mrad_s * 1e-3);
                let is_allowed = way_rad.abs() <= core::f64::consts::PI
                    && rate_rad_s > 0.0
                    && rate_rad_s <= limits.rate_rad_s;
                let step = rate_rad_s / self.parameters.limits.rate_hz * UNITS_PER_RAD;
                is_allowed.then_some(ExcitationSignal::Ring {
                    way: (way_rad * UNITS_PER_RAD) as i32,
                    step: (step as u32).max(1),
                })?
            }
        })
    }
}
