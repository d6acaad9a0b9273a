//! What can be served.

use embedded_io::Write;
use firmware::fault::Fault;
use firmware::gcs::Session;

/// A controller in this process: what ticks, and what carries out its clients' lines.
pub trait Controller {
    /// Ticks in a second of its own time.
    fn rate_hz(&self) -> f64;

    /// One tick.
    fn tick(&mut self);

    /// What the command side does with no client there: a macro goes on.
    fn advance(&mut self);

    /// Has the command side carry out what a session has received.
    ///
    /// # Errors
    /// Those of `replies`.
    fn service<W: Write>(&mut self, session: &mut Session, replies: &mut W)
    -> Result<(), W::Error>;

    /// A connection has ended; what was its own ends with it.
    fn disconnect(&mut self, session: &mut Session);

    /// Goes on keeping settings.
    fn keep(&mut self);

    /// Starts it again if a client has asked for that; whether one has.
    fn restart_if_wanted(&mut self) -> bool;

    /// The latched fault.
    fn fault(&self) -> Option<Fault>;
}
