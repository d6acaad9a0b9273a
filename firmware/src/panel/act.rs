//! Carrying out what changes something.

use super::Panel;
use super::axis::{Axis, AxisValues};
use super::error::ErrorCode;
use super::parameter::{Parameter, Settings};
use super::request::Action;
use super::session::{Awaited, Session, Wait};
use super::soft::SoftLimits;
use crate::link::PanelLink;
use crate::motion::Stop;

/// Longest `DEL`: a day.
const LONGEST_DELAY_MS: f64 = 86_400_000.0;

impl Panel {
    /// Carries out `action`; an error means that nothing of it was done, but for stops, which always report
    /// [`ErrorCode::Stopped`].
    pub(super) fn act(
        &mut self,
        action: Action,
        session: &mut Session,
        link: &mut PanelLink<'_>,
    ) -> Result<(), ErrorCode> {
        match action {
            Action::Servo(values) => match servo(&values)? {
                Some(on) => self.stage.set_servo(on, link),
                None => Ok(()),
            },
            // Whichever axes are named: the encoders give all of them at once.
            Action::Reference(_) => {
                if self.stage.begin_reference(link)? {
                    self.wait(session, Awaited::Reference);
                }
                Ok(())
            }
            Action::Move(values) => self.stage.move_to(&values, link),
            Action::MoveRelative(values) => self.stage.move_by(&values, link),
            Action::SoftLowest(values) => self.stage.set_soft(SoftLimits::set_lowest, &values),
            Action::SoftHighest(values) => self.stage.set_soft(SoftLimits::set_highest, &values),
            Action::SoftActive(values) => self.stage.set_soft(SoftLimits::activate, &values),
            Action::Set(settings) => self.set(&settings),
            Action::Velocity(mm_s) => self.stage.set_velocity(mm_s),
            Action::Stop => {
                self.stops = self.stops.wrapping_add(1);
                self.stage.stop(Stop::Urgent, link);
                Err(ErrorCode::Stopped)
            }
            // Whichever axes are named: the axes of a line cannot stop apart.
            Action::Halt(_) => {
                self.stage.stop(Stop::Smooth, link);
                Err(ErrorCode::Stopped)
            }
            Action::Acknowledge => self.stage.acknowledge(link),
            Action::Delay(ms) => {
                if !(0.0..=LONGEST_DELAY_MS).contains(&ms) {
                    return Err(ErrorCode::OutOfRange);
                }
                let until = self.stage.tick() + self.stage.ticks(ms);
                self.wait(session, Awaited::Tick(until));
                Ok(())
            }
            Action::Wait(condition) => {
                self.wait(session, Awaited::Condition(condition));
                Ok(())
            }
        }
    }

    /// All settings or, when one is out of range, none. A motion under way was planned with other limits: not then.
    fn set(&mut self, settings: &Settings) -> Result<(), ErrorCode> {
        if !self.stage.moving().is_empty() {
            return Err(ErrorCode::InMotion);
        }
        let mut limits = self.parameters.limits;
        for (address, value) in settings.iter().flatten() {
            let parameter = Parameter::find(address.id).ok_or(ErrorCode::UnknownParameter)?;
            if !parameter.set(*value, &mut limits, &self.rated) {
                return Err(ErrorCode::OutOfRange);
            }
        }
        self.parameters.limits = limits;
        self.stage.set_limits(limits);
        Ok(())
    }

    fn wait(&self, session: &mut Session, what: Awaited) {
        session.wait = Some(Wait {
            what,
            stops: self.stops,
        });
    }
}

/// What `SVO` asks of the servo, which all movable axes share: off if any of them is to be off, on if any is to be on. The
/// frozen axes have none to switch.
fn servo(values: &AxisValues) -> Result<Option<bool>, ErrorCode> {
    let mut wanted = None;
    for (axis, value) in Axis::ALL.into_iter().zip(values) {
        let on = match *value {
            None => continue,
            Some(0.0) => false,
            Some(1.0) => true,
            Some(_) => return Err(ErrorCode::OutOfRange),
        };
        if axis.component().is_some() {
            wanted = Some(on && wanted != Some(false));
        }
    }
    Ok(wanted)
}
