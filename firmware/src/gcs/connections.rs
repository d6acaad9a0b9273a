//! Connections as the controller knows them: their numbers, who commanded last, and what ends with one.

use super::connection_number::ConnectionNumber;
use super::error::ErrorCode;
use super::interpreter::Interpreter;
use super::session::Session;
use super::text::Text;

/// What is known of all connections together.
#[derive(Default)]
pub(super) struct Connections {
    /// Connections so far.
    count: u32,
    /// Whose motion is under way, or was the last.
    mover: Option<ConnectionNumber>,
    /// Who is to be told that its motion was ended by another connection.
    stopped_mover: Option<ConnectionNumber>,
    /// Who changed something of the stage last, and at which tick.
    pub last_command: Option<(Text, u64)>,
}

impl Interpreter {
    /// Gives a connection its number when it is first heard of.
    pub(super) fn register(&mut self, session: &mut Session) {
        if session.number.is_none() {
            self.connections.count += 1;
            session.number = Some(self.connections.count);
        }
    }

    /// A connection has ended. What was its own ends with it: the constant velocities that it commanded, its recovery and its
    /// ownership at once, its heartbeat when it should have been heard.
    pub fn disconnect(&mut self, session: &mut Session) {
        let Some(number) = session.number.take() else {
            return;
        };
        self.jogs.connection_ended(number);
        self.ownership.release(number);
        self.heartbeat.connection_ended(number);
        self.recovery_owner.connection_ended(number);
    }

    /// A connection has begun a motion.
    pub(super) const fn note_mover(&mut self, session: &Session) {
        self.connections.mover = session.number;
    }

    /// A connection ends the motion under way: the one that began it is told with error 10, if it is another one.
    pub(super) fn tell_mover(&mut self, session: &Session) {
        let mover = self.connections.mover;
        if mover != session.number {
            self.connections.stopped_mover = mover;
        }
    }

    /// The error of a connection whose motion was ended by another one.
    pub(super) fn report_stopped_motion(&mut self, session: &mut Session) {
        let stopped = &mut self.connections.stopped_mover;
        if stopped.is_some() && *stopped == session.number && !session.is_macro {
            *stopped = None;
            session.error = ErrorCode::Stopped;
        }
    }
}
