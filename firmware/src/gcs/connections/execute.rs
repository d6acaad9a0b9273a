//! A connection is heard of, moves, stops another's motion, ends.

use crate::gcs::error::ErrorCode;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::session::Session;

impl Interpreter {
    /// Gives a connection its number when it is first heard of.
    pub(in crate::gcs) fn register(&mut self, session: &mut Session) {
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
    pub(in crate::gcs) const fn note_mover(&mut self, session: &Session) {
        self.connections.mover = session.number;
    }

    /// A connection ends the motion under way: the one that began it is told with error 10, if it is another one.
    pub(in crate::gcs) fn tell_mover(&mut self, session: &Session) {
        let mover = self.connections.mover;
        if mover != session.number {
            self.connections.stopped_mover = mover;
        }
    }

    /// The error of a connection whose motion was ended by another one.
    pub(in crate::gcs) fn report_stopped_motion(&mut self, session: &mut Session) {
        let stopped = &mut self.connections.stopped_mover;
        if stopped.is_some() && *stopped == session.number && !session.is_macro {
            *stopped = None;
            session.error = ErrorCode::Stopped;
        }
    }
}
