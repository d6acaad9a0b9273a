//! The stage as the command side sees it: what is known of it, what is in flight to it, what is still wanted of it.
//!
//! One command is in flight at most. What a command does is known when the tick has counted it ([`Snapshot::commands`]),
//! a tick later; until then nothing that depends on it is decided. Wishes that have to wait (a stop for its splice, a move
//! for the stop before it) are kept here and carried on by [`Commander::advance_pending`].
//!
//! | file | idea |
//! |---|---|
//! | here | the state, and how snapshots change it |
//! | `look` | what queries ask |
//! | `command` | what is commanded: checked, then sent or kept as a wish |
//! | `configure` | other parameters |
//! | `flow` | streamed targets and running waveforms |
//! | `frame` | frames and the centre of rotation |
//! | `jog` | constant velocities |
//! | `pace` | velocities of axes |
//! | `wave` | waveforms |
//! | `reference` | referencing |
//! | `carry` | wishes whose time has come |

pub(crate) mod axis;
pub(crate) mod coordinates;
pub(crate) mod frames;
pub(crate) mod furthest_target;
pub(crate) mod sent_plan;
pub(crate) mod soft_limits;
pub(crate) mod wave;

mod axis_velocities;
mod configure;
mod frame_changes;
mod jog;
mod moves;
mod pending;
mod queries;
mod referencing;
mod streaming;
mod waveforms;

pub(crate) use referencing::Referencing;
use streaming::{DEFAULT_CYCLE_MS, Streaming};

use crate::commander::axis::{AxisSet, AxisValues};
use crate::commander::coordinates::{Coordinates, coordinates};
use crate::commander::frames::{ActiveFrames, FrameSelection, FrameTree};
use crate::commander::sent_plan::{Goal, SentPlan};
use crate::commander::soft_limits::SoftLimits;
use crate::commander::wave::Waveforms;
use crate::gcs::error::ErrorCode;
use crate::mode::Mode;
use crate::motion::{Ahead, Ground, Limits, Position, Stop, Tries};
use crate::parameters::{Parameters, Targets};
use crate::queues::{Command, PanelLink, Snapshot};

/// Ticks between the snapshot a stop or a transition is planned from and the tick at which it takes over: 2 ms for planning.
const PLANNING_LEAD_TICKS: u64 = 40;
/// Where doubling it ends: a stop that is late even so finds the motion at rest.
const MAX_PLANNING_LEAD_TICKS: u64 = 20_000;

/// See the module.
pub(crate) struct Commander {
    /// What plans keep to, without frames and soft limits: its disk takes long to compute.
    base_constraints: Ground,
    /// Limits of the parameters: those of full system velocity.
    full_limits: Limits,
    soft_limits: SoftLimits,
    waves: Waveforms,
    /// Velocities that `VEL` has set, mm/s and deg/s.
    velocities: AxisValues,
    targets: Targets,
    /// Targets that follow one another, and who makes them.
    streaming: Option<Streaming>,
    /// Time between streamed targets, ms.
    cycle_ms: f64,
    frames: FrameTree,
    /// What targets mean, with the frames in force.
    active_frames: ActiveFrames,
    snapshot: Option<Snapshot>,
    commands_sent: u32,
    /// Plans refused by the tick when the command in flight was sent.
    refused: u32,
    in_flight: Option<InFlight>,
    /// Under way, as far as the tick has said so.
    sent_plan: Option<SentPlan>,
    /// Accepted by the tick to take over from `sent_plan`.
    next_plan: Option<SentPlan>,
    last_plan_id: u32,
    planning_lead_ticks: u64,
    pending_stop: Option<Stop>,
    pending_goal: Option<Goal>,
    /// What is wanted can not be had without a stop before.
    needs_stop_first: bool,
    /// What has been tried to get to it in motion, and what follows the head that has been sent.
    tries: Tries,
    ahead: Option<Ahead>,
    /// Velocities that `JOG` has set and that are kept, mm/s and deg/s in the frames in force.
    jog_velocities: Coordinates,
    target: Coordinates,
    /// The target is where the stage comes to rest, not where it was sent.
    target_is_rest: bool,
    moving_axes: AxisSet,
    /// Tick at which referencing is given up; over when it is past.
    referencing_deadline: u64,
    /// The tick has refused the parameters that were set last.
    configuration_refused: bool,
    /// Bad news for every connection: how many so far, and the latest.
    last_error: (u32, ErrorCode),
}

/// The command in flight.
// There is no heap to box the sent_plan in, and there is one flight.
#[allow(clippy::large_enum_variant)]
enum InFlight {
    Move(SentPlan),
    Reference,
    Configure,
    /// FrameTree with another centre of rotation.
    FrameTree(FrameSelection, ActiveFrames),
    /// Nothing that is needed when it is acknowledged.
    Other,
}

impl Commander {
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            base_constraints: Ground::new(parameters.limits, parameters.geometry),
            full_limits: parameters.limits,
            soft_limits: SoftLimits::new(),
            waves: Waveforms::new(),
            velocities: AxisValues::default(),
            targets: parameters.targets,
            streaming: None,
            cycle_ms: DEFAULT_CYCLE_MS,
            frames: FrameTree::new(),
            active_frames: ActiveFrames::BASE,
            snapshot: None,
            commands_sent: 0,
            refused: 0,
            in_flight: None,
            sent_plan: None,
            next_plan: None,
            last_plan_id: 0,
            planning_lead_ticks: PLANNING_LEAD_TICKS,
            pending_stop: None,
            pending_goal: None,
            jog_velocities: [0.0; 6],
            needs_stop_first: false,
            tries: Tries::NONE,
            ahead: None,
            target: Coordinates::default(),
            target_is_rest: true,
            moving_axes: AxisSet::EMPTY,
            referencing_deadline: 0,
            configuration_refused: false,
            last_error: (0, ErrorCode::None),
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

    /// Sets the error of every connection.
    pub fn report_error(&mut self, code: ErrorCode) {
        self.last_error = (self.last_error.0.wrapping_add(1), code);
    }

    pub const fn last_error(&self) -> (u32, ErrorCode) {
        self.last_error
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
            // Whoever commanded before this panel: its commands are not ours to wait for, its plans not ours to stop.
            self.commands_sent = snapshot.commands;
            self.last_plan_id = snapshot.plan;
        }
        let acknowledged = snapshot.commands == self.commands_sent;
        if acknowledged && let Some(flight) = self.in_flight.take() {
            self.acknowledge(flight, snapshot.refused != self.refused);
        }
        if let Some(next) = self.next_plan.take_if(|next| next.plan.id == snapshot.plan) {
            self.sent_plan = Some(next);
        }
        if acknowledged {
            self.update_from_mode(&snapshot);
        }
        self.snapshot = Some(snapshot);
        if !self.is_moving() {
            self.moving_axes = AxisSet::EMPTY;
        }
    }

    /// The tick has taken what was in flight, or refused it.
    fn acknowledge(&mut self, flight: InFlight, refused: bool) {
        if refused && matches!(flight, InFlight::Configure) {
            self.configuration_refused = true;
            self.last_error = (self.last_error.0.wrapping_add(1), ErrorCode::Busy);
        }
        let sent_plan = match flight {
            InFlight::Move(sent_plan) => sent_plan,
            InFlight::FrameTree(selection, active_frames) if !refused => {
                return self.apply_frames(selection, active_frames);
            }
            _ => return,
        };
        match (refused, sent_plan.takes_over()) {
            (true, true) => {
                self.planning_lead_ticks =
                    (self.planning_lead_ticks * 2).min(MAX_PLANNING_LEAD_TICKS)
            }
            (false, true) => self.planning_lead_ticks = PLANNING_LEAD_TICKS,
            _ => {}
        }
        if !refused && sent_plan.goal == Goal::Velocity([0.0; 3]) {
            self.set_target_to_rest(&sent_plan.plan.end);
        }
        match (sent_plan.stop, refused) {
            (Some(_), true) => {}
            (Some(stop), false) => {
                // An urgent stop may have been asked for while a smooth one was in flight.
                self.pending_stop = self
                    .pending_stop
                    .filter(|&wanted| wanted == Stop::Urgent && stop == Stop::Smooth);
                self.set_target_to_rest(&sent_plan.plan.end);
                self.next_plan = Some(sent_plan);
            }
            (None, false) if sent_plan.takes_over() => self.next_plan = Some(sent_plan),
            (None, false) => self.sent_plan = Some(sent_plan),
            // The setpoint was not where the snapshot said: tried again from where it is, unless stopped meanwhile.
            (None, true) if sent_plan.goal == Goal::Stream => self.abort_streaming(),
            (None, true) if self.pending_stop.is_none() && self.pending_goal.is_none() => {
                self.pending_goal = Some(sent_plan.goal);
            }
            (None, true) => {}
        }
    }

    /// After a stop by command the target is where it ends; known as soon as the stop is, so that `MVR` can go on from there.
    fn set_target_to_rest(&mut self, end: &Position) {
        if self.target_is_rest {
            self.target = coordinates(end, &self.active_frames, &self.base_constraints.geometry);
        }
    }

    /// Forgets the wishes that the supervisor's state has settled.
    fn update_from_mode(&mut self, snapshot: &Snapshot) {
        match snapshot.mode {
            Mode::Moving => {}
            Mode::Holding => {
                self.sent_plan = None;
                self.next_plan = None;
                self.pending_stop = None;
                if self.target_is_rest && self.pending_goal.is_none() && self.streaming.is_none() {
                    self.jog_velocities = [0.0; 6];
                    self.target = coordinates(
                        &snapshot.setpoint,
                        &self.active_frames,
                        &self.base_constraints.geometry,
                    );
                    self.target_is_rest = false;
                }
            }
            Mode::Off | Mode::Fault | Mode::Stopping => {
                self.sent_plan = None;
                self.next_plan = None;
                self.pending_stop = None;
                self.pending_goal = None;
                self.streaming = None;
                self.jog_velocities = [0.0; 6];
                self.target_is_rest = true;
            }
        }
    }

    /// A full queue is [`ErrorCode::Busy`], not 304: nothing that was received is lost, the command is refused whole.
    fn send(
        &mut self,
        command: Command,
        flight: InFlight,
        link: &mut PanelLink<'_>,
    ) -> Result<(), ErrorCode> {
        link.send(command).map_err(|_| ErrorCode::Busy)?;
        self.commands_sent = self.commands_sent.wrapping_add(1);
        self.refused = self.snapshot.as_ref().map_or(0, |s| s.refused);
        self.in_flight = Some(flight);
        Ok(())
    }
}
