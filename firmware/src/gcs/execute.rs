//! Carrying out what changes something.

use super::error::ErrorCode;
use super::events::Event;
use super::interpreter::Interpreter;
use super::request::Action;
use super::request::MAX_DELAY_MS;
use super::session::{Awaited, Session, Wait};
use crate::commander::axis::{Axis, AxisValues};
use crate::commander::{CommandError, MOST_APPROACH_UM, Quantity, SoftLimitChange};
use crate::motion::Stop;
use crate::queues::CommandQueues;

impl Interpreter {
    /// Carries out `action`; an error means that nothing of it was done, but for stops, which report
    /// [`ErrorCode::Stopped`] when they have stopped something.
    pub(super) fn perform(
        &mut self,
        action: Action,
        session: &mut Session,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        match action {
            Action::Servo(values) => match servo(&values)? {
                Some(on) => self.set_servo(on, session, queues),
                None => Ok(()),
            },
            // Whichever axes are named: the encoders give all of them at once.
            Action::Reference(_) => {
                match self.commander.begin_referencing(queues) {
                    Ok(true) => self.wait(session, Awaited::Reference),
                    Ok(false) => {}
                    Err(error) => {
                        self.note_pose_outside(&error);
                        return Err(error.into());
                    }
                }
                Ok(())
            }
            Action::Move(values) => Ok(self.commander.move_to(&values, queues)?),
            Action::MoveRelative(values) | Action::Step(values) => {
                Ok(self.commander.move_by(&values, queues)?)
            }
            Action::Record(action) => {
                (self.recorder_state).change(&action, &mut self.parameters, &queues.recorder)
            }
            Action::MoveInTool(values) => Ok(self.commander.move_in_tool(&values, queues)?),
            Action::CycleTime(ms) => Ok(self.commander.set_cycle_time(ms)?),
            Action::Jog(values) => self.jog(&values, session, queues),
            Action::Recover(value) => self.recover(value, session, queues),
            Action::JogTime(ms) => self.set_jog_time(ms, session),
            Action::Own(value, name) => self.own(value, name, session),
            Action::AxisVelocity(values) => Ok(self.commander.set_axis_velocity(&values)?),
            Action::Wave(action) => Ok(self.commander.change_waves(&action, queues)?),
            Action::Repeat(action) => self.change_repeated_moves(&action, session, queues),
            Action::Calibrate(action) => self.change_calibration(&action, session, queues),
            Action::Excite(request) => self.excite(&request, session, queues),
            Action::Frame(action) => Ok(self.commander.change_frames(&action, queues)?),
            Action::SoftLowest(values) => {
                Ok((self.commander).set_soft_limits(&SoftLimitChange::Lowest(values))?)
            }
            Action::SoftHighest(values) => {
                Ok((self.commander).set_soft_limits(&SoftLimitChange::Highest(values))?)
            }
            Action::SoftActive(values) => {
                let change = SoftLimitChange::Active(flags(&values)?);
                Ok(self.commander.set_soft_limits(&change)?)
            }
            Action::Set(settings) => self.set(&settings, session, queues),
            Action::Store(addresses) => {
                self.store_parameters(&addresses, queues)?;
                self.wait(session, Awaited::Stored);
                Ok(())
            }
            Action::Recall(addresses) => self.recall(&addresses, queues),
            Action::Level(level, password) => Self::set_level(session, level, password),
            Action::Approach(um) => {
                if !(0.0..=MOST_APPROACH_UM).contains(&um) {
                    return Err(ErrorCode::OutOfRange);
                }
                self.commander.set_approach(um);
                Ok(())
            }
            Action::Velocity(mm_s) => Ok(self.commander.set_velocity(mm_s)?),
            Action::Stop => self.stop_by_command(Event::Stop, session, queues),
            // Whichever axes are named: the axes of a line cannot stop apart.
            Action::Halt(_) => self.stop_by_command(Event::Halt, session, queues),
            Action::Commission(value) => self.commission(value, session, queues),
            Action::Heartbeat(ms) => self.set_heartbeat(ms, session),
            Action::RestartStatistics => {
                self.restart_statistics();
                Ok(())
            }
            Action::Restart => self.restart(session),
            Action::Acknowledge => Ok(self.commander.acknowledge_fault(queues)?),
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

    /// `SVO`: whose motion it ends is told.
    fn set_servo(
        &mut self,
        on: bool,
        session: &Session,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        let moves = self.commander.is_motion_commanded();
        if let Err(error) = self.commander.set_servo(on, queues) {
            self.note_pose_outside(&error);
            return Err(error.into());
        }
        if on && self.commander.value(Quantity::Referenced, Axis::X) == 0.0 {
            (self.events).add_once(self.commander.tick(), Event::ServoBeforeReference);
        }
        if !on && moves {
            self.tell_mover(session);
        }
        Ok(())
    }

    /// An event where an error says that the stage is out of its reach: the pose.
    pub(super) fn note_pose_outside(&mut self, error: &CommandError) {
        if let CommandError::ReferenceOutside(pose) = error {
            (self.events).add(self.commander.tick(), Event::PoseOutside(tenths(*pose)));
        }
    }

    /// `STP`, `#24` and `HLT`. Error 10 says that something was stopped: nothing is told of a stop that found nothing to stop.
    fn stop_by_command(
        &mut self,
        event: Event,
        session: &mut Session,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        let moves = self.commander.is_motion_commanded();
        let waited = core::mem::take(&mut session.has_stopped_wait);
        let is_urgent = event == Event::Stop;
        let has_stopped = moves || is_urgent && (waited || self.macros.is_running());
        self.events
            .add_stop(self.commander.tick(), event, has_stopped);
        if moves {
            self.tell_mover(session);
        }
        if is_urgent {
            self.stop_all(Stop::Urgent, queues);
        } else {
            self.commander.stop(Stop::Smooth, queues);
        }
        if has_stopped {
            Err(ErrorCode::Stopped)
        } else {
            Ok(())
        }
    }

    /// Stops the motion, and with it every macro and every wait.
    pub(super) fn stop_all(&mut self, stop: Stop, queues: &mut CommandQueues<'_>) {
        self.stops = self.stops.wrapping_add(1);
        self.macros.stop();
        self.commander.stop(stop, queues);
    }

    /// `RBT`: a stage in motion would be let go, and what another connection has promised be forgotten.
    fn restart(&mut self, session: &Session) -> Result<(), ErrorCode> {
        if self.commander.is_motion_commanded() {
            return Err(ErrorCode::InMotion);
        }
        if self.heartbeat.is_promised_by_another(session.number) {
            return Err(ErrorCode::NotAllowed);
        }
        self.wants_restart = true;
        Ok(())
    }

    pub(super) fn wait(&self, session: &mut Session, what: Awaited) {
        session.wait = Some(Wait {
            what,
            stops: self.stops,
        });
    }
}

/// To a tenth, and never a zero with a sign.
pub(super) fn tenths(pose: [f64; 3]) -> [f32; 3] {
    pose.map(|value| (libm::rint(value * 10.0) / 10.0 + 0.0) as f32)
}

/// What `SVO` asks of the servo, which all movable axes share: off if any of them is to be off, on if any is to be on.
/// The frozen axes have none to switch.
fn servo(values: &AxisValues) -> Result<Option<bool>, ErrorCode> {
    let mut wanted = None;
    for (axis, on) in Axis::ALL.into_iter().zip(flags(values)?) {
        if let Some(on) = on
            && axis.component().is_some()
        {
            wanted = Some(on && wanted != Some(false));
        }
    }
    Ok(wanted)
}

/// Values that are 0 or 1.
fn flags(values: &AxisValues) -> Result<[Option<bool>; 6], ErrorCode> {
    let mut flags = [None; 6];
    for (flag, value) in flags.iter_mut().zip(values) {
        *flag = match *value {
            None => None,
            Some(0.0) => Some(false),
            Some(1.0) => Some(true),
            Some(_) => return Err(ErrorCode::OutOfRange),
        };
    }
    Ok(flags)
}
