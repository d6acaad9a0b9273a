//! Setting parameters: who may, when, and how the new values reach the tick.
//!
//! A line is carried out whole or not at all. The commander plans with the new parameters from the next line on; what
//! the tick computes with is derived from them here and handed over as one command, which the tick takes only at rest.
//! Nothing that depends on them is decided before the tick has said that it did.

use super::address::{Address, Item, Settings};
use super::descriptor::{Parameter, When};
use super::looseness::loosened;
use super::table::{COMMISSIONED, PARAMETERS};
use crate::commander::CommandError;
use crate::control::servo::BorneLimits;
use crate::gcs::error::ErrorCode;
use crate::gcs::events::Event;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::session::Session;
use crate::motion::Limits;
use crate::parameters::Parameters;
use crate::queues::CommandQueues;

impl Interpreter {
    /// `SPA`: all settings or, with an error, none.
    pub(in crate::gcs) fn set(
        &mut self,
        settings: &Settings,
        session: &Session,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        let mut wanted = self.parameters.clone();
        for (address, value) in settings.iter().flatten() {
            let parameter = Parameter::find(address.id).ok_or(ErrorCode::UnknownParameter)?;
            self.check_allowed(parameter, session.level)?;
            parameter.set(*value, &mut wanted)?;
        }
        if session.level == 0 && !self.is_within_rated_limits(&wanted) {
            return Err(ErrorCode::OutOfRange);
        }
        self.apply_parameters(wanted, queues)?;
        for (address, value) in settings.iter().flatten() {
            self.events.add(
                self.commander.tick(),
                Event::ParameterSet(address.id, *value),
            );
        }
        Ok(())
    }

    /// `CMS`: 1 says that all that the machine has of its own is set, 0 that it is not. Anything else is out of range.
    pub(in crate::gcs) fn commission(
        &mut self,
        value: f64,
        session: &Session,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        let item = Item::System;
        let address = Address {
            item,
            id: COMMISSIONED,
        };
        let mut settings = Settings::default();
        settings[0] = Some((address, value));
        self.set(&settings, session, queues)
    }

    /// Goes over to other parameters, or leaves everything as it is.
    pub(in crate::gcs) fn apply_parameters(
        &mut self,
        wanted: Parameters,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        let most_rows = self.recorder_state.most_rows(queues.recorder.capacity());
        if wanted.recorder.points > most_rows || !wanted.are_sound() {
            return Err(ErrorCode::OutOfRange);
        }
        let configured = self.commander.configure(&self.parameters, &wanted, queues);
        if let Err(error) = configured {
            if let CommandError::LimitsNotBorne(borne) = &error {
                self.note_borne(borne);
            }
            return Err(error.into());
        }
        if wanted.recorder != self.parameters.recorder {
            self.recorder_state.rearm(&queues.recorder);
        }
        if wanted.learnt != self.parameters.learnt {
            self.servo_reports.outdate();
        }
        let of_drives = |parameters: &Parameters| {
            let Parameters {
                drives,
                guides,
                encoders,
                wiring,
                ..
            } = parameters;
            (*drives, *guides, *encoders, *wiring)
        };
        if of_drives(&wanted) != of_drives(&self.parameters) {
            self.restart_drive_watches();
        }
        self.rated_limits = highest(&self.rated_limits, &wanted.limits);
        self.previous_parameters = core::mem::replace(&mut self.parameters, wanted);
        self.note_looseness();
        Ok(())
    }

    /// An event: limits of motion that the drives bear, in place of those that they do not. Rounded towards what they bear.
    fn note_borne(&mut self, borne: &BorneLimits) {
        let down = |value: f64, steps: f64| (libm::floor(value * steps) / steps) as f32;
        let limits = [
            down(borne.rate_rad_s, 100.0),
            down(borne.acceleration_rad_s2, 10.0),
            -down(-borne.stop_s, 1_000.0),
        ];
        (self.events).add(self.commander.tick(), Event::LimitsNotBorne(limits));
    }

    /// An event when the drives do not bear the limits of motion in force, which a firmware that did not look had kept.
    pub(in crate::gcs) fn note_limits_in_force(&mut self) {
        let borne = BorneLimits::new(&self.parameters);
        if self.parameters.commissioned && borne.excess(&self.parameters) > 1.0 {
            self.note_borne(&borne);
        }
    }

    /// An event when supervision becomes looser than the reference, or does not stay so.
    pub(in crate::gcs) fn note_looseness(&mut self) {
        let count = loosened(&self.parameters).count() as u16;
        if core::mem::replace(&mut self.loosened, count) != count {
            (self.events).add(self.commander.tick(), Event::SupervisionLoosened(count));
        }
    }

    /// Whether this may become of the parameters now: what was stored may be in force again at any command level.
    pub(in crate::gcs) fn check_change_allowed(
        &self,
        wanted: &Parameters,
    ) -> Result<(), ErrorCode> {
        let changed = |p: &&Parameter| p.number(&self.parameters) != p.number(wanted);
        let settable = PARAMETERS.iter().filter(|p| !p.is_read_only());
        settable
            .filter(changed)
            .try_for_each(|parameter| self.check_allowed(parameter, parameter.level))
    }

    fn check_allowed(&self, parameter: &Parameter, level: u8) -> Result<(), ErrorCode> {
        if level < parameter.level {
            return Err(ErrorCode::LevelTooLow);
        }
        // A motion under way was planned with other ones.
        if self.commander.is_motion_commanded() {
            return Err(ErrorCode::InMotion);
        }
        match parameter.when {
            When::Never => Err(ErrorCode::ReadOnly),
            When::ServoOff if self.commander.is_held() => Err(ErrorCode::NotAllowed),
            When::AtRest | When::ServoOff => Ok(()),
        }
    }

    /// Whether no limit of motion is over what the stage was set up for.
    fn is_within_rated_limits(&self, wanted: &Parameters) -> bool {
        highest(&self.rated_limits, &wanted.limits) == self.rated_limits
    }

    /// `CCL`: the command level of the connection.
    pub(in crate::gcs) fn set_level(
        session: &mut Session,
        level: f64,
        password: bool,
    ) -> Result<(), ErrorCode> {
        match (level, password) {
            (0.0, _) => session.level = 0,
            (1.0, true) => session.level = 1,
            (1.0, false) => return Err(ErrorCode::Password),
            _ => return Err(ErrorCode::OutOfRange),
        }
        Ok(())
    }

    /// Back to the parameters that the tick has, if it has refused those that were set last.
    pub(in crate::gcs) fn revert_if_refused(&mut self) {
        if self.commander.take_configuration_refused() {
            self.parameters.clone_from(&self.previous_parameters);
            self.commander.use_parameters(&self.parameters);
        }
    }
}

/// The higher of each limit of motion.
fn highest(a: &Limits, b: &Limits) -> Limits {
    Limits {
        speed_mm_s: a.speed_mm_s.max(b.speed_mm_s),
        acceleration_mm_s2: a.acceleration_mm_s2.max(b.acceleration_mm_s2),
        jerk_mm_s3: a.jerk_mm_s3.max(b.jerk_mm_s3),
        turn_speed_deg_s: a.turn_speed_deg_s.max(b.turn_speed_deg_s),
        turn_acceleration_deg_s2: a.turn_acceleration_deg_s2.max(b.turn_acceleration_deg_s2),
        turn_jerk_deg_s3: a.turn_jerk_deg_s3.max(b.turn_jerk_deg_s3),
        pivot_rate_rad_s: a.pivot_rate_rad_s.max(b.pivot_rate_rad_s),
        pivot_acceleration_rad_s2: a.pivot_acceleration_rad_s2.max(b.pivot_acceleration_rad_s2),
        ..*a
    }
}
