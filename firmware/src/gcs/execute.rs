//! Carrying out what changes something.

use super::error::ErrorCode;
use super::events::Event;
use super::request::Action;
use super::session::{Awaited, Session, Wait};
use super::{LONGEST_MS, Panel};
use crate::commander::axis::{Axis, AxisValues};
use crate::commander::soft_limits::SoftLimits;
use crate::motion::Stop;
use crate::queues::CommandQueues;

impl Panel {
    /// Carries out `action`; an error means that nothing of it was done, but for stops, which always report
    /// [`ErrorCode::Stopped`].
    pub(super) fn act(
        &mut self,
        action: Action,
        session: &mut Session,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        match action {
            Action::Servo(values) => match servo(&values)? {
                Some(on) => self.stage.set_servo(on, queues),
                None => Ok(()),
            },
            // Whichever axes are named: the encoders give all of them at once.
            Action::Reference(_) => {
                if self.stage.begin_reference(queues)? {
                    self.wait(session, Awaited::Reference);
                }
                Ok(())
            }
            Action::Move(values) => self.stage.move_to(&values, queues),
            Action::MoveRelative(values) | Action::Step(values) => {
                self.stage.move_by(&values, queues)
            }
            Action::Record(action) => {
                (self.desk).change(&action, &mut self.parameters, &queues.recorder)
            }
            Action::MoveInTool(values) => self.stage.move_in_tool(&values, queues),
            Action::CycleTime(ms) => self.stage.set_cycle_time(ms),
            Action::Jog(values) => self.stage.jog(&values, queues),
            Action::AxisVelocity(values) => self.stage.set_axis_velocity(&values),
            Action::Wave(action) => self.stage.change_waves(&action, queues),
            Action::Frame(action) => self.stage.change_frames(&action, queues),
            Action::SoftLowest(values) => self.stage.set_soft(SoftLimits::set_lowest, &values),
            Action::SoftHighest(values) => self.stage.set_soft(SoftLimits::set_highest, &values),
            Action::SoftActive(values) => self.stage.set_soft(SoftLimits::activate, &values),
            Action::Set(settings) => self.set(&settings, session, queues),
            Action::Keep(addresses) => {
                self.keep(&addresses)?;
                self.wait(session, Awaited::Kept);
                Ok(())
            }
            Action::Recall(addresses) => self.recall(&addresses, queues),
            Action::Level(level, password) => Self::set_level(session, level, password),
            Action::Velocity(mm_s) => self.stage.set_velocity(mm_s),
            Action::Stop => {
                self.events.add(self.stage.tick(), Event::Stop);
                self.stop_all(Stop::Urgent, queues);
                Err(ErrorCode::Stopped)
            }
            // Whichever axes are named: the axes of a line cannot stop apart.
            Action::Halt(_) => {
                self.events.add(self.stage.tick(), Event::Halt);
                self.stage.stop(Stop::Smooth, queues);
                Err(ErrorCode::Stopped)
            }
            Action::Heartbeat(ms) => self.set_heartbeat(ms, session),
            Action::RestartStatistics => {
                self.restart_statistics();
                Ok(())
            }
            Action::Restart => self.restart(),
            Action::Acknowledge => self.stage.acknowledge(queues),
            Action::Delay(ms) => {
                if !(0.0..=LONGEST_MS).contains(&ms) {
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
            Action::Jump(by, condition) => self.jump_if(Some(by), &condition, session),
            Action::Leave(condition) => self.jump_if(None, &condition, session),
        }
    }

    /// Stops the motion, and with it every macro and every wait.
    pub(super) fn stop_all(&mut self, stop: Stop, queues: &mut CommandQueues<'_>) {
        self.stops = self.stops.wrapping_add(1);
        self.macros.stop();
        self.stage.stop(stop, queues);
    }

    /// `RBT`: a stage in motion would be let go.
    fn restart(&mut self) -> Result<(), ErrorCode> {
        if self.stage.is_under_way() {
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
