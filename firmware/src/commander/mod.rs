//! The stage as the command side sees it: what is known of it, what is in flight to it, what is still wanted of it.
//!
//! One command is in flight at most. What a command does is known when the tick has counted it ([`Snapshot::commands`]),
//! a tick later; until then nothing that depends on it is decided. Wishes that have to wait (a stop for its splice, a move
//! for the stop before it) are kept here and carried on by [`Stage::carry_on`].
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
use streaming::{CYCLE_MS, Flow};

use crate::commander::axis::{AxisSet, AxisValues};
use crate::commander::coordinates::{Coordinates, coordinates};
use crate::commander::frames::{Choice, Frames, View};
use crate::commander::sent_plan::{Course, Goal};
use crate::commander::soft_limits::SoftLimits;
use crate::commander::wave::Waves;
use crate::gcs::error::ErrorCode;
use crate::mode::Mode;
use crate::motion::{Ahead, Constraints, Limits, Position, Stop, Tries};
use crate::parameters::{Parameters, Targets};
use crate::queues::{Command, CommandQueues, Snapshot};

/// Ticks between the snapshot a stop or a transition is planned from and the tick at which it takes over: 2 ms for planning.
const LOOK_AHEAD: u64 = 40;
/// Where doubling it ends: a stop that is late even so finds the motion at rest.
const LOOK_AHEAD_MOST: u64 = 20_000;

/// See the module.
pub(crate) struct Stage {
    /// What plans keep to, without frames and soft limits: its disk takes long to compute.
    base: Constraints,
    /// Limits of the parameters: those of full system velocity.
    full: Limits,
    soft: SoftLimits,
    waves: Waves,
    /// Velocities that `VEL` has set, mm/s and deg/s.
    velocities: AxisValues,
    targets: Targets,
    /// Targets that follow one another, and who makes them.
    flow: Option<Flow>,
    /// Time between streamed targets, ms.
    cycle_ms: f64,
    frames: Frames,
    /// What targets mean, with the frames in force.
    view: View,
    snapshot: Option<Snapshot>,
    sent: u32,
    /// Plans refused by the tick when the command in flight was sent.
    refused: u32,
    flight: Option<Flight>,
    /// Under way, as far as the tick has said so.
    course: Option<Course>,
    /// Accepted by the tick to take over from `course`.
    next: Option<Course>,
    ids: u32,
    look_ahead: u64,
    stop_wanted: Option<Stop>,
    wanted: Option<Goal>,
    /// What is wanted can not be had without a stop before.
    rest_first: bool,
    /// What has been tried to get to it in motion, and what follows the head that has been sent.
    tries: Tries,
    ahead: Option<Ahead>,
    /// Velocities that `JOG` has set and that are kept, mm/s and deg/s in the frames in force.
    jog: Coordinates,
    target: Coordinates,
    /// The target is where the stage comes to rest, not where it was sent.
    target_is_rest: bool,
    moving: AxisSet,
    /// Tick at which referencing is given up; over when it is past.
    reference_until: u64,
    /// The tick has refused the parameters that were set last.
    settings_refused: bool,
    /// Bad news for every connection: how many so far, and the latest.
    news: (u32, ErrorCode),
}

/// The command in flight.
// There is no heap to box the course in, and there is one flight.
#[allow(clippy::large_enum_variant)]
enum Flight {
    Move(Course),
    Reference,
    Configure,
    /// Frames with another centre of rotation.
    Frames(Choice, View),
    /// Nothing that is looked at when it lands.
    Other,
}

impl Stage {
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            base: Constraints::new(parameters.limits, parameters.geometry),
            full: parameters.limits,
            soft: SoftLimits::new(),
            waves: Waves::new(),
            velocities: AxisValues::default(),
            targets: parameters.targets,
            flow: None,
            cycle_ms: CYCLE_MS,
            frames: Frames::new(),
            view: View::BASE,
            snapshot: None,
            sent: 0,
            refused: 0,
            flight: None,
            course: None,
            next: None,
            ids: 0,
            look_ahead: LOOK_AHEAD,
            stop_wanted: None,
            wanted: None,
            jog: [0.0; 6],
            rest_first: false,
            tries: Tries::NONE,
            ahead: None,
            target: Coordinates::default(),
            target_is_rest: true,
            moving: AxisSet::EMPTY,
            reference_until: 0,
            settings_refused: false,
            news: (0, ErrorCode::None),
        }
    }

    /// The latest snapshot, once there is one.
    pub const fn snapshot(&self) -> Option<&Snapshot> {
        self.snapshot.as_ref()
    }

    /// The latest snapshot, when nothing is in flight: what it says holds.
    pub fn present(&self) -> Option<&Snapshot> {
        self.snapshot
            .as_ref()
            .filter(|snapshot| snapshot.commands == self.sent)
    }

    /// Sets the error of every connection.
    pub fn tell_all(&mut self, code: ErrorCode) {
        self.news = (self.news.0.wrapping_add(1), code);
    }

    pub const fn news(&self) -> (u32, ErrorCode) {
        self.news
    }

    /// The tick of the latest snapshot.
    pub fn tick(&self) -> u64 {
        self.snapshot.as_ref().map_or(0, |snapshot| snapshot.tick)
    }

    /// Ticks in so many milliseconds.
    pub fn ticks(&self, ms: f64) -> u64 {
        libm::ceil(ms * 1e-3 * self.base.limits.rate_hz) as u64
    }

    /// Takes a snapshot.
    pub fn take(&mut self, snapshot: Snapshot) {
        if self.snapshot.is_none() {
            // Whoever commanded before this panel: its commands are not ours to wait for, its plans not ours to stop.
            self.sent = snapshot.commands;
            self.ids = snapshot.plan;
        }
        let landed = snapshot.commands == self.sent;
        if landed && let Some(flight) = self.flight.take() {
            self.land(flight, snapshot.refused != self.refused);
        }
        if let Some(next) = self.next.take_if(|next| next.plan.id == snapshot.plan) {
            self.course = Some(next);
        }
        if landed {
            self.follow_mode(&snapshot);
        }
        self.snapshot = Some(snapshot);
        if !self.is_moving() {
            self.moving = AxisSet::EMPTY;
        }
    }

    /// The tick has taken what was in flight, or refused it.
    fn land(&mut self, flight: Flight, refused: bool) {
        if refused && matches!(flight, Flight::Configure) {
            self.settings_refused = true;
            self.news = (self.news.0.wrapping_add(1), ErrorCode::Busy);
        }
        let course = match flight {
            Flight::Move(course) => course,
            Flight::Frames(choice, view) if !refused => return self.take_frames(choice, view),
            _ => return,
        };
        match (refused, course.is_splice()) {
            (true, true) => self.look_ahead = (self.look_ahead * 2).min(LOOK_AHEAD_MOST),
            (false, true) => self.look_ahead = LOOK_AHEAD,
            _ => {}
        }
        if !refused && course.goal == Goal::Velocity([0.0; 3]) {
            self.will_rest_at(&course.plan.end);
        }
        match (course.stop, refused) {
            (Some(_), true) => {}
            (Some(stop), false) => {
                // An urgent stop may have been asked for while a smooth one was in flight.
                self.stop_wanted = self
                    .stop_wanted
                    .filter(|&wanted| wanted == Stop::Urgent && stop == Stop::Smooth);
                self.will_rest_at(&course.plan.end);
                self.next = Some(course);
            }
            (None, false) if course.is_splice() => self.next = Some(course),
            (None, false) => self.course = Some(course),
            // The setpoint was not where the snapshot said: tried again from where it is, unless stopped meanwhile.
            (None, true) if course.goal == Goal::Stream => self.lose_flow(),
            (None, true) if self.stop_wanted.is_none() && self.wanted.is_none() => {
                self.wanted = Some(course.goal);
            }
            (None, true) => {}
        }
    }

    /// After a stop by command the target is where it ends; known as soon as the stop is, so that `MVR` can go on from there.
    fn will_rest_at(&mut self, end: &Position) {
        if self.target_is_rest {
            self.target = coordinates(end, &self.view, &self.base.geometry);
        }
    }

    /// Forgets the wishes that the supervisor's state has settled.
    fn follow_mode(&mut self, snapshot: &Snapshot) {
        match snapshot.mode {
            Mode::Moving => {}
            Mode::Holding => {
                self.course = None;
                self.next = None;
                self.stop_wanted = None;
                if self.target_is_rest && self.wanted.is_none() && self.flow.is_none() {
                    self.jog = [0.0; 6];
                    self.target = coordinates(&snapshot.setpoint, &self.view, &self.base.geometry);
                    self.target_is_rest = false;
                }
            }
            Mode::Off | Mode::Fault | Mode::Stopping => {
                self.course = None;
                self.next = None;
                self.stop_wanted = None;
                self.wanted = None;
                self.flow = None;
                self.jog = [0.0; 6];
                self.target_is_rest = true;
            }
        }
    }

    /// A full queue is [`ErrorCode::Busy`], not 304: nothing that was received is lost, the command is refused whole.
    fn send(
        &mut self,
        command: Command,
        flight: Flight,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        queues.send(command).map_err(|_| ErrorCode::Busy)?;
        self.sent = self.sent.wrapping_add(1);
        self.refused = self.snapshot.as_ref().map_or(0, |s| s.refused);
        self.flight = Some(flight);
        Ok(())
    }
}
