//! Who has promised to be heard, and when it was.

use crate::gcs::connection_number::ConnectionNumber;
use heapless::Vec;

/// Connections that may have promised to be heard at once.
pub(super) const MAX_PROMISES: usize = 16;

/// When the host was heard last.
#[derive(Clone, Debug, Default)]
pub(in crate::gcs) struct Heartbeat {
    /// Of each connection that has promised to be heard.
    pub(super) promises: Vec<Promise, MAX_PROMISES>,
    /// Of any connection, for the parameter.
    pub(super) any: Silence,
}

/// A connection has promised to be heard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Promise {
    pub connection: ConnectionNumber,
    /// Longest silence.
    pub ms: f64,
    pub silence: Silence,
    /// The connection has ended: what it promised ends when it has been missed.
    pub has_ended: bool,
}

/// Since when nothing has been heard.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Silence {
    pub last_heard_tick: u64,
    /// It has been too long, and nothing has been heard since.
    pub is_too_long: bool,
}

impl Silence {
    /// Something is heard.
    pub const fn end(&mut self, tick: u64) {
        *self = Self {
            last_heard_tick: tick,
            is_too_long: false,
        };
    }

    /// Whether it has just become too long.
    pub const fn becomes_too_long(&mut self, tick: u64, ticks: u64) -> bool {
        let becomes = !self.is_too_long && tick > self.last_heard_tick + ticks;
        self.is_too_long |= becomes;
        becomes
    }
}

impl Heartbeat {
    /// A connection has ended; it is missed when it should have been heard, and that ends its promise.
    pub fn connection_ended(&mut self, number: ConnectionNumber) {
        for promise in &mut self.promises {
            promise.has_ended |= promise.connection == number;
        }
        self.forget_missed();
    }

    /// Promises of connections that have ended and have been missed are over.
    pub(super) fn forget_missed(&mut self) {
        self.promises
            .retain(|promise| !(promise.has_ended && promise.silence.is_too_long));
    }

    /// Whether a connection that is still there has promised to be heard, other than this one.
    pub fn is_promised_by_another(&self, connection: Option<ConnectionNumber>) -> bool {
        let is_others =
            |promise: &Promise| !promise.has_ended && Some(promise.connection) != connection;
        self.promises.iter().any(is_others)
    }

    /// What a connection has promised, ms.
    pub fn promised_ms(&self, connection: Option<ConnectionNumber>) -> Option<f64> {
        let own = |promise: &&Promise| Some(promise.connection) == connection;
        self.promises.iter().find(own).map(|promise| promise.ms)
    }
}
