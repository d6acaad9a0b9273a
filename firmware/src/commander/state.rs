//! What is known of the stage and asked of it, and how snapshots change it.

use super::axis::{AxisSet, AxisValues, Coordinates};
use super::coordinates::coordinates;
use super::error::CommandError;
use super::frames::{ActiveFrames, FrameTree};
use super::in_flight::InFlight;
use super::kept_approach::Approach;
use super::kept_calibration::KeptCalibration;
use super::kept_temperature::Temperature;
use super::pending::Pending;
use super::reach::ReachMargins;
use super::recovery::Recovery;
use super::rest_watch::RestWatch;
use super::sent_plan::{Goal, SentPlan};
use super::soft_limits::SoftLimits;
use super::wave::Waveforms;
use crate::fault::{Fault, FaultKind};
use crate::iterative_learning::Tables;
use crate::mode::Mode;
use crate::motion::{Constraints, Limits, Position};
use crate::parameters::{Parameters, Subdivision, Targets};
use crate::queues::{Command, CommandQueues, Snapshot};

/// Time between streamed targets at first, ms.
const DEFAULT_CYCLE_MS: f64 = 10.0;
/// Ticks between the snapshot a stop or a way to another goal is planned from and the tick at which it takes over: 2 ms for
/// planning.
const PLANNING_LEAD_TICKS: u64 = 40;
/// Where doubling it ends: a stop that is late even so finds the motion at rest.
const MAX_PLANNING_LEAD_TICKS: u64 = 20_000;

/// The stage as the command side sees it. See the [module](super).
pub struct Commander {
    /// What plans keep to, without frames and soft limits: its disk takes long to compute.
    pub(super) base_constraints: Constraints,
    /// Limits of the parameters: those of full system velocity.
    pub(super) full_limits: Limits,
    pub(super) soft_limits: SoftLimits,
    pub(super) waves: Waveforms,
    /// Of moves that are repeated.
    pub(super) tables: Tables,
    /// Velocities that have been set for single axes, mm/s and deg/s.
    pub(super) velocities: AxisValues,
    pub(super) targets: Targets,
    /// Whether the machine is commissioned: if not, nothing drives.
    pub(super) commissioned: bool,
    /// Whether a debugger is attached that is not allowed to be: then nothing drives either.
    pub(super) is_debugged: bool,
    /// Whether the emergency stop has to be pressed once after a start before anything drives, and whether it has been.
    pub(super) stop_test_needed: bool,
    /// See above.
    pub(super) stop_seen: bool,
    /// Time between streamed targets, ms.
    pub(super) cycle_ms: f64,
    pub(super) calibrating: KeptCalibration,
    pub(super) temperature: Temperature,
    pub(super) approach: Approach,
    /// The track's radius as the parameter says; that of `base_constraints` is what it is at the machine's temperature.
    pub(super) drawn_radius_mm: f64,
    /// What the tick takes from the encoders' readings.
    pub(super) subdivision: [Subdivision; 3],
    pub(super) frames: FrameTree,
    /// What targets mean, with the frames in force.
    pub(super) active_frames: ActiveFrames,
    pub(super) snapshot: Option<Snapshot>,
    pub(super) commands_sent: u32,
    /// Plans refused by the tick when the command in flight was sent.
    pub(super) refusals_before: u32,
    pub(super) in_flight: Option<InFlight>,
    /// Under way, as far as the tick has said so.
    pub(super) sent_plan: Option<SentPlan>,
    /// Accepted by the tick to take over from `sent_plan`.
    pub(super) next_plan: Option<SentPlan>,
    pub(super) last_plan_id: u32,
    pub(super) planning_lead_ticks: u64,
    pub(super) pending: Pending,
    /// Velocities that a jog keeps, mm/s and deg/s in the frames in force.
    pub(super) jog_velocities: Coordinates,
    pub(super) target: Coordinates,
    /// The target is where the stage comes to rest, not where it was sent.
    pub(super) target_is_rest: bool,
    pub(super) moving_axes: AxisSet,
    pub(super) reach_margins: ReachMargins,
    /// The stage is being driven back into its reach.
    pub(super) recovery: Option<Recovery>,
    /// Tick at which referencing is given up; over when it is past.
    pub(super) referencing_deadline: u64,
    /// The tick has refused the parameters that were set last.
    pub(super) configuration_refused: bool,
    /// `VLS` has been given since the start.
    pub(super) velocity_is_set: bool,
    /// Whether the measured pivots rest.
    pub(super) rest: RestWatch,
    /// The motors have let go of a stage in motion, or brake it, since this tick, and it has not come to rest yet.
    pub(super) slides_since: Option<u64>,
    /// The servo goes off as soon as the motion has come to its end.
    pub(super) off_at_rest: bool,
    /// The excitation under way is to end, and the tick has not been told yet.
    pub(super) ends_excitation: bool,
    /// What became, later, of a request that had been accepted; not asked for yet.
    pub(super) late_error: Option<CommandError>,
}

impl Commander {
    /// For a stage of these parameters, of which nothing is known yet.
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            base_constraints: Constraints::new(parameters.limits, parameters.geometry),
            full_limits: parameters.limits,
            soft_limits: SoftLimits::new(),
            waves: Waveforms::new(),
            tables: Tables::new(),
            velocities: AxisValues::default(),
            targets: parameters.targets,
            commissioned: parameters.commissioned,
            is_debugged: false,
            stop_test_needed: parameters.supervision.stop_test_needed,
            stop_seen: false,
            cycle_ms: DEFAULT_CYCLE_MS,
            calibrating: KeptCalibration::default(),
            temperature: Temperature::default(),
            approach: Approach::default(),
            drawn_radius_mm: parameters.geometry.radius_mm,
            subdivision: [Subdivision::NONE; 3],
            frames: FrameTree::new(),
            active_frames: ActiveFrames::BASE,
            snapshot: None,
            commands_sent: 0,
            refusals_before: 0,
            in_flight: None,
            sent_plan: None,
            next_plan: None,
            last_plan_id: 0,
            planning_lead_ticks: PLANNING_LEAD_TICKS,
            pending: Pending::Nothing,
            jog_velocities: [0.0; 6],
            target: Coordinates::default(),
            target_is_rest: true,
            moving_axes: AxisSet::EMPTY,
            reach_margins: ReachMargins::new(parameters),
            recovery: None,
            referencing_deadline: 0,
            configuration_refused: false,
            velocity_is_set: false,
            rest: RestWatch::default(),
            slides_since: None,
            off_at_rest: false,
            ends_excitation: false,
            late_error: None,
        }
    }

    /// The latest snapshot, once there is one.
    pub const fn snapshot(&self) -> Option<&Snapshot> {
        self.snapshot.as_ref()
    }

    /// The latest snapshot, when nothing is in flight: what it says holds.
    pub fn current_snapshot(&self) -> Option<&Snapshot> {
        self.snapshot
            .as_ref()
            .filter(|snapshot| snapshot.commands == self.commands_sent)
    }

    /// What became of a request that had been accepted, if it came to nothing since this was last asked: the latest.
    pub const fn take_late_error(&mut self) -> Option<CommandError> {
        self.late_error.take()
    }

    pub(super) const fn report_late(&mut self, error: CommandError) {
        self.late_error = Some(error);
    }

    /// The tick of the latest snapshot.
    pub fn tick(&self) -> u64 {
        self.snapshot.as_ref().map_or(0, |snapshot| snapshot.tick)
    }

    /// Ticks in so many milliseconds.
    pub fn ticks(&self, ms: f64) -> u64 {
        libm::ceil(ms * 1e-3 * self.base_constraints.limits.rate_hz) as u64
    }

    /// Takes a snapshot.
    pub fn update(&mut self, snapshot: Snapshot) {
        if self.snapshot.is_none() {
            // Whoever commanded before: those commands are not to be waited for, those plans not to be stopped.
            self.commands_sent = snapshot.commands;
            self.last_plan_id = snapshot.plan;
        }
        let acknowledged = snapshot.commands == self.commands_sent;
        if acknowledged && let Some(in_flight) = self.in_flight.take() {
            self.acknowledge(in_flight, snapshot.refused != self.refusals_before);
        }
        if let Some(next) = self.next_plan.take_if(|next| next.plan.id == snapshot.plan) {
            self.sent_plan = Some(next);
        }
        if acknowledged {
            self.update_from_mode(&snapshot);
        }
        let is_stop = |fault: Fault| fault.kind == FaultKind::EmergencyStop;
        self.stop_seen |= snapshot.fault.is_some_and(is_stop);
        self.watch_rest(&snapshot);
        self.snapshot = Some(snapshot);
        if !self.is_moving() {
            self.moving_axes = AxisSet::EMPTY;
        }
    }

    /// The tick has taken what was in flight, or refused it.
    fn acknowledge(&mut self, in_flight: InFlight, refused: bool) {
        match in_flight {
            InFlight::Plan(sent_plan, goal) => {
                self.adapt_planning_lead(&sent_plan, refused);
                if refused {
                    self.plan_refused(&sent_plan, goal);
                } else {
                    self.plan_taken(sent_plan);
                }
            }
            InFlight::SelectFrames(selection, active_frames) if !refused => {
                self.apply_frames(selection, active_frames);
            }
            InFlight::Excitation if refused => self.report_late(CommandError::ExcitationRefused),
            InFlight::Configure if refused => {
                self.configuration_refused = true;
                self.report_late(CommandError::ConfigurationRefused);
            }
            _ => {}
        }
    }

    /// A plan that takes over from another one in motion comes too late when planning takes longer than it was given.
    fn adapt_planning_lead(&mut self, sent_plan: &SentPlan, refused: bool) {
        if sent_plan.takes_over() {
            self.planning_lead_ticks = if refused {
                (self.planning_lead_ticks * 2).min(MAX_PLANNING_LEAD_TICKS)
            } else {
                PLANNING_LEAD_TICKS
            };
        }
    }

    fn plan_taken(&mut self, sent_plan: SentPlan) {
        if sent_plan.goal == Goal::Velocity([0.0; 3]) {
            self.set_target_to_rest(&sent_plan.plan.end);
        }
        if let Some(stop) = sent_plan.stop {
            self.pending.stop_taken(stop);
            self.set_target_to_rest(&sent_plan.plan.end);
            self.next_plan = Some(sent_plan);
        } else if sent_plan.takes_over() {
            self.next_plan = Some(sent_plan);
        } else {
            self.sent_plan = Some(sent_plan);
        }
    }

    /// The setpoint was not where the snapshot said. A stop is still pending, a stream can not wait.
    fn plan_refused(&mut self, sent_plan: &SentPlan, goal: Option<Goal>) {
        if sent_plan.stop.is_some() {
            return;
        }
        if sent_plan.goal == Goal::Stream {
            self.abort_streaming();
        } else if let Some(goal) = goal {
            self.pending.plan_refused(goal);
        }
    }

    /// After a stop by command the target is where it ends; known as soon as the stop is, so that a relative move can
    /// go on from there.
    pub(super) fn set_target_to_rest(&mut self, end: &Position) {
        if self.target_is_rest {
            self.target = coordinates(end, &self.active_frames, &self.base_constraints.geometry);
        }
    }

    /// Forgets what the supervisor's state has settled.
    fn update_from_mode(&mut self, snapshot: &Snapshot) {
        match snapshot.mode {
            Mode::Moving => {}
            Mode::Holding => {
                self.sent_plan = None;
                self.next_plan = None;
                self.pending.drop_stop();
                if matches!(self.pending, Pending::Improving(_)) {
                    self.pending = Pending::Nothing;
                }
                if self.target_is_rest && matches!(self.pending, Pending::Nothing) {
                    self.jog_velocities = [0.0; 6];
                    self.target = coordinates(
                        &snapshot.setpoint,
                        &self.active_frames,
                        &self.base_constraints.geometry,
                    );
                    self.target_is_rest = false;
                }
            }
            Mode::Off | Mode::Fault | Mode::Stopping | Mode::Exciting => {
                self.sent_plan = None;
                self.next_plan = None;
                self.pending = Pending::Nothing;
                self.approach.target = None;
                self.jog_velocities = [0.0; 6];
                self.target_is_rest = true;
            }
        }
    }

    /// Sends a command; with a full queue nothing has changed.
    pub(super) fn send(
        &mut self,
        command: Command,
        in_flight: InFlight,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        queues.send(command).map_err(|_| CommandError::Busy)?;
        self.note_sent(in_flight);
        Ok(())
    }

    pub(super) fn note_sent(&mut self, in_flight: InFlight) {
        self.commands_sent = self.commands_sent.wrapping_add(1);
        self.refusals_before = self.snapshot.as_ref().map_or(0, |s| s.refused);
        self.in_flight = Some(in_flight);
    }

    /// Servo on or off.
    // In a frame of its own: a command is long, and callers plan.
    #[inline(never)]
    pub(super) fn send_servo(
        &mut self,
        on: bool,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        self.send(Command::Servo(on), InFlight::Other, queues)
    }
}
