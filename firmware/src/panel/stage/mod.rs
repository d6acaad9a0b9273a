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
//! | `reference` | referencing |
//! | `carry` | wishes whose time has come |

mod carry;
mod command;
mod look;
mod reference;

pub(super) use reference::Referencing;

use super::axis::AxisSet;
use super::course::Course;
use super::error::ErrorCode;
use super::soft::SoftLimits;
use super::target::{Coordinates, coordinates};
use crate::link::{Command, Mode, PanelLink, Snapshot};
use crate::motion::{Limits, Position, Stop};
use crate::parameters::Parameters;
use kinematics::Geometry;

/// Ticks between the snapshot a stop or a transition is planned from and the tick at which it takes over: 2 ms for planning.
const LOOK_AHEAD: u64 = 40;
/// Where doubling it ends: a stop that is late even so finds the motion at rest.
const LOOK_AHEAD_MOST: u64 = 20_000;

/// See the module.
pub(super) struct Stage {
    pub geometry: Geometry,
    limits: Limits,
    /// Limits of the parameters: those of full system velocity.
    full: Limits,
    soft: SoftLimits,
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
    move_wanted: Option<Position>,
    /// The move that is wanted can not be had without a stop before.
    rest_first: bool,
    target: Coordinates,
    /// The target is where the stage comes to rest, not where it was sent.
    target_is_rest: bool,
    moving: AxisSet,
    /// Tick at which referencing is given up; over when it is past.
    reference_until: u64,
    /// Bad news for every connection: how many so far, and the latest.
    news: (u32, ErrorCode),
}

/// The command in flight.
// There is no heap to box the course in, and there is one flight.
#[allow(clippy::large_enum_variant)]
enum Flight {
    Move(Course),
    Reference,
    /// Nothing that is looked at when it lands.
    Other,
}

impl Stage {
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            geometry: parameters.geometry,
            limits: parameters.limits,
            full: parameters.limits,
            soft: SoftLimits::new(&parameters.geometry),
            snapshot: None,
            sent: 0,
            refused: 0,
            flight: None,
            course: None,
            next: None,
            ids: 0,
            look_ahead: LOOK_AHEAD,
            stop_wanted: None,
            move_wanted: None,
            rest_first: false,
            target: Coordinates::default(),
            target_is_rest: true,
            moving: AxisSet::EMPTY,
            reference_until: 0,
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

    pub const fn news(&self) -> (u32, ErrorCode) {
        self.news
    }

    /// The tick of the latest snapshot.
    pub fn tick(&self) -> u64 {
        self.snapshot.as_ref().map_or(0, |snapshot| snapshot.tick)
    }

    /// Ticks in so many milliseconds.
    pub fn ticks(&self, ms: f64) -> u64 {
        libm::ceil(ms * 1e-3 * self.limits.rate_hz) as u64
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
        let Flight::Move(course) = flight else { return };
        match (refused, course.is_splice()) {
            (true, true) => self.look_ahead = (self.look_ahead * 2).min(LOOK_AHEAD_MOST),
            (false, true) => self.look_ahead = LOOK_AHEAD,
            _ => {}
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
            (None, true) if self.stop_wanted.is_none() && self.move_wanted.is_none() => {
                self.move_wanted = Some(course.plan.end);
            }
            (None, true) => {}
        }
    }

    /// After a stop by command the target is where it ends; known as soon as the stop is, so that `MVR` can go on from there.
    fn will_rest_at(&mut self, end: &Position) {
        if self.target_is_rest {
            self.target = coordinates(end, &self.geometry);
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
                if self.target_is_rest && self.move_wanted.is_none() {
                    self.target = coordinates(&snapshot.setpoint, &self.geometry);
                    self.target_is_rest = false;
                }
            }
            Mode::Off | Mode::Fault => {
                self.course = None;
                self.next = None;
                self.stop_wanted = None;
                self.move_wanted = None;
                self.target_is_rest = true;
            }
        }
    }

    /// A full queue is [`ErrorCode::Busy`], not 304: nothing that was received is lost, the command is refused whole.
    fn send(
        &mut self,
        command: Command,
        flight: Flight,
        link: &mut PanelLink<'_>,
    ) -> Result<(), ErrorCode> {
        link.send(command).map_err(|_| ErrorCode::Busy)?;
        self.sent = self.sent.wrapping_add(1);
        self.refused = self.snapshot.as_ref().map_or(0, |s| s.refused);
        self.flight = Some(flight);
        Ok(())
    }
}
