//! Its beginning, its steps and its end.

use super::state::{Recovery, RecoveryEnd, Step};
use crate::commander::coordinates::UNITS_PER_RADIUS;
use crate::commander::error::CommandError;
use crate::commander::in_flight::InFlight;
use crate::commander::reach::closest_pivots_rad;
use crate::commander::sent_plan::{Goal, SentPlan};
use crate::commander::state::Commander;
use crate::control::config::Config;
use crate::mode::Mode;
use crate::motion::{Constraints, Limits, Position};
use crate::parameters::Parameters;
use crate::queues::{Command, CommandQueues, Snapshot};

/// Velocity, acceleration and jerk of the way.
const SPEED_MM_S: f64 = 5.0;
const ACCELERATION_MM_S2: f64 = 50.0;
const JERK_MM_S3: f64 = 5_000.0;
/// Largest rate of a pivot, of which the supervisor allows twice: close to the track pivots are fast.
const PIVOT_RATE_RAD_S: f64 = 0.5;
const PIVOT_ACCELERATION_RAD_S2: f64 = 20.0;
/// How far inside the disk the way ends, track radii.
const INSIDE_RADII: f64 = 0.01;

impl Commander {
    /// Begins to drive a stage back into its reach; the pose at which it was found, mm, mm and deg. Whoever begins goes on with
    /// [`Commander::advance_recovery`].
    ///
    /// # Errors
    /// [`CommandError::NothingToRecover`], and what referencing is refused with; nothing has changed then.
    pub fn begin_recovery(
        &mut self,
        parameters: &Parameters,
        queues: &mut CommandQueues<'_>,
    ) -> Result<[f64; 3], CommandError> {
        let Some(snapshot) = self.current_snapshot() else {
            return Err(CommandError::Busy);
        };
        if self.is_faulted() {
            return Err(CommandError::Faulted);
        }
        self.check_may_drive()?;
        if self.is_motion_commanded() || self.rest.is_fast {
            return Err(CommandError::InMotion);
        }
        if snapshot.encoder_faults != [None; 3] {
            return Err(CommandError::ReferencingFailed);
        }
        let outside = self.reach_margins.pose_outside(snapshot, self.built());
        let pose = outside
            .filter(|_| snapshot.mode == Mode::Off)
            .ok_or(CommandError::NothingToRecover)?;
        let limited = parameters.for_recovery(closest_pivots_rad(snapshot));
        let command = Command::Configure(Config::new(&limited));
        self.send(command, InFlight::Other, queues)?;
        self.recovery = Some(Recovery {
            step: Step::Limit,
            is_given_up: false,
        });
        Ok(pose)
    }

    /// Whether one is under way.
    pub const fn is_recovering(&self) -> bool {
        self.recovery.is_some()
    }

    /// It ends where it is, with the servo off.
    pub(in crate::commander) const fn give_up_recovery(&mut self) {
        if let Some(recovery) = &mut self.recovery {
            recovery.is_given_up = true;
        }
    }

    /// Takes the next step of the recovery under way, if its time has come; how it has ended, when it has. `parameters` are those
    /// that hold after it.
    pub fn advance_recovery(
        &mut self,
        parameters: &Parameters,
        queues: &mut CommandQueues<'_>,
    ) -> Option<RecoveryEnd> {
        let (Some(recovery), Some(_)) = (self.recovery, self.current_snapshot()) else {
            return None;
        };
        match (self.mode(), recovery.step) {
            (Mode::Moving | Mode::Stopping | Mode::Exciting, _) => {}
            (Mode::Holding, _) if self.is_motion_pending() => {}
            (Mode::Holding, _) if recovery.is_given_up => {
                // A full queue: again at the next snapshot. So below.
                let _ = self.send_servo(false, queues);
            }
            (Mode::Holding, Step::Drive) => {
                let is_settled = self.snapshot().is_some_and(|snapshot| snapshot.settled);
                if is_settled && self.restore(parameters, queues) {
                    return Some(RecoveryEnd::InReach);
                }
            }
            (Mode::Holding, _) => self.send_way_back(queues),
            (Mode::Off, Step::Limit) if !recovery.is_given_up => {
                if self
                    .send(Command::Reference, InFlight::Reference, queues)
                    .is_ok()
                {
                    self.set_step(Step::Hold);
                }
            }
            (Mode::Off, Step::Hold) if !recovery.is_given_up => {
                // Encoders that stopped answering, or pivots that are no pose.
                self.report_late(CommandError::ReferencingFailed);
                self.set_step(Step::Restore);
            }
            (Mode::Off | Mode::Fault, _) => {
                return self
                    .restore(parameters, queues)
                    .then_some(RecoveryEnd::GivenUp);
            }
        }
        None
    }

    const fn set_step(&mut self, step: Step) {
        if let Some(recovery) = &mut self.recovery {
            recovery.step = step;
        }
    }

    /// Gives the tick the limits that hold after the recovery, which then is over; false when it can not be told now.
    fn restore(&mut self, parameters: &Parameters, queues: &mut CommandQueues<'_>) -> bool {
        let command = Command::Configure(Config::new(parameters));
        let is_sent = self.send(command, InFlight::Other, queues).is_ok();
        if is_sent {
            self.recovery = None;
        }
        is_sent
    }

    fn send_way_back(&mut self, queues: &mut CommandQueues<'_>) {
        let Some(snapshot) = self.snapshot() else {
            return;
        };
        let from = snapshot.setpoint;
        let to = self.inside(snapshot);
        let constraints = self.recovery_constraints();
        let id = self.next_plan_id();
        let sent = SentPlan::from_rest(id, from, Goal::Position(to), &constraints).and_then(
            |way| match way.plan.ticks() {
                0 => Ok(()),
                _ => self.send_plan(way, None, queues),
            },
        );
        match sent {
            Ok(()) => {
                self.target_is_rest = true;
                self.set_step(Step::Drive);
            }
            Err(CommandError::Busy) => {}
            Err(error) => {
                self.report_late(error);
                self.give_up_recovery();
            }
        }
    }

    /// Where the moved point is when the platform's centre is just inside the disk, towards the middle from where it is now.
    fn inside(&self, snapshot: &Snapshot) -> Position {
        let [x, y, theta] = snapshot.setpoint;
        let centre = snapshot.centre.to_platform(&snapshot.setpoint);
        let [centre_x, centre_y] = [centre[0], centre[1]].map(|part| part as f64);
        let inside = (self.base_constraints.usable_radius - INSIDE_RADII) * UNITS_PER_RADIUS;
        let share = (1.0 - inside / libm::hypot(centre_x, centre_y)).max(0.0);
        let [way_x, way_y] = [centre_x, centre_y].map(|part| libm::rint(part * share) as i64);
        [x - way_x, y - way_y, theta]
    }

    /// What the way keeps to: the soft limits are for a stage that is in reach.
    fn recovery_constraints(&self) -> Constraints {
        let limits = &self.full_limits;
        Constraints {
            limits: Limits {
                speed_mm_s: SPEED_MM_S.min(limits.speed_mm_s),
                acceleration_mm_s2: ACCELERATION_MM_S2.min(limits.acceleration_mm_s2),
                jerk_mm_s3: JERK_MM_S3.min(limits.jerk_mm_s3),
                pivot_rate_rad_s: PIVOT_RATE_RAD_S.min(limits.pivot_rate_rad_s),
                pivot_acceleration_rad_s2: PIVOT_ACCELERATION_RAD_S2
                    .min(limits.pivot_acceleration_rad_s2),
                ..*limits
            },
            rotation_centre: self.radii(self.active_frames.tool.origin()),
            ..self.base_constraints
        }
    }
}
