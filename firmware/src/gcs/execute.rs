//! Carrying out what changes something.

use super::error::ErrorCode;
use super::events::Event;
use super::request::Action;
use super::session::{Awaited, Session, Wait};
use super::{MAX_DELAY_MS, Panel};
use crate::commander::axis::{Axis, AxisValues};
use crate::commander::soft_limits::SoftLimits;
use crate::motion::Stop;
use crate::queues::PanelLink;

impl Panel {
    /// Carries out `action`; an error means that nothing of it was done, but for stops, which always report
    /// [`ErrorCode::Stopped`].
    pub(super) fn perform(
        &mut self,
        action: Action,
        session: &mut Session,
        link: &mut PanelLink<'_>,
    ) -> Result<(), ErrorCode> {
        match action {
            Action::Servo(values) => match servo(&values)? {
                Some(on) => self.commander.set_servo(on, link),
                None => Ok(()),
            },
            // Whichever axes are named: the encoders give all of them at once.
            Action::Reference(_) => {
                if self.commander.begin_referencing(link)? {
                    self.wait(session, Awaited::Reference);
                }
                Ok(())
            }
            Action::Move(values) => self.commander.move_to(&values, link),
            Action::MoveRelative(values) | Action::Step(values) => {
                self.commander.move_by(&values, link)
            }
            Action::Record(action) => {
                (self.recorder_state).change(&action, &mut self.parameters, &link.recorder)
            }
            Action::MoveInTool(values) => self.commander.move_in_tool(&values, link),
            Action::CycleTime(ms) => self.commander.set_cycle_time(ms),
            Action::Jog(values) => self.commander.jog(&values, link),
            Action::AxisVelocity(values) => self.commander.set_axis_velocity(&values),
            Action::Wave(action) => self.commander.change_waves(&action, link),
            Action::Frame(action) => self.commander.change_frames(&action, link),
            Action::SoftLowest(values) => self
                .commander
                .set_soft_limits(SoftLimits::set_lowest, &values),
            Action::SoftHighest(values) => self
                .commander
                .set_soft_limits(SoftLimits::set_highest, &values),
            Action::SoftActive(values) => self
                .commander
                .set_soft_limits(SoftLimits::activate, &values),
            Action::Set(settings) => self.set(&settings, session, link),
            Action::Store(addresses) => {
                self.store_parameters(&addresses)?;
                self.wait(session, Awaited::Stored);
                Ok(())
            }
            Action::Recall(addresses) => self.recall(&addresses, link),
            Action::Level(level, password) => Self::set_level(session, level, password),
            Action::Velocity(mm_s) => self.commander.set_velocity(mm_s),
            Action::Stop => {
                self.events.add(self.commander.tick(), Event::Stop);
                self.stop_all(Stop::Urgent, link);
                Err(ErrorCode::Stopped)
            }
            // Whichever axes are named: the axes of a line cannot stop apart.
            Action::Halt(_) => {
                self.events.add(self.commander.tick(), Event::Halt);
                self.commander.stop(Stop::Smooth, link);
                Err(ErrorCode::Stopped)
            }
            Action::Heartbeat(ms) => self.set_heartbeat(ms, session),
            Action::RestartStatistics => {
                self.restart_statistics();
                Ok(())
            }
            Action::Restart => self.restart(),
            Action::Acknowledge => self.commander.acknowledge_fault(link),
            Action::Delay(ms) => {
                if !(0.0..=MAX_DELAY_MS).contains(&ms) {
                    return Err(ErrorCode::OutOfRange);
                }
                let until = self.commander.tick() + self.commander.ticks(ms);
                self.wait(session, Awaited::Tick(until));
                Ok(())
            }
            Action::Wait(condition) => {
                self.wait(session, Awaited::Condition(condition));
                Ok(())
            }
            Action::Jump(by, condition) => self.jump_if(Some(by), &condition, session),
            Action::Leave(condition) => self.jump_if(None, &condition, session),
        }
    }

    /// Stops the motion, and with it every macro and every wait.
    pub(super) fn stop_all(&mut self, stop: Stop, link: &mut PanelLink<'_>) {
        self.stops = self.stops.wrapping_add(1);
        self.macros.stop();
        self.commander.stop(stop, link);
    }

    /// `RBT`: a stage in motion would be let go.
    fn restart(&mut self) -> Result<(), ErrorCode> {
        if self.commander.is_motion_commanded() {
            return Err(ErrorCode::InMotion);
        }
        self.wants_restart = true;
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
