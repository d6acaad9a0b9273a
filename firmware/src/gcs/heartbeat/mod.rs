//! The host's heartbeat: when one is asked for with `HBT` or its parameter, a host that is not heard for longer is
//! taken for gone.
//!
//! Heard is any byte on a connection that has promised it with `HBT`: a page that looks on beside a script, or another
//! client, does not stand for a script that has died. Where no connection has promised anything (the parameter was set,
//! kept settings ask for it, or a macro said `HBT`) it is any byte on any connection. What follows is what `STP` does:
//! the motion ends at the highest deceleration, on its path, the macro and all waits end, every connection gets error
//! 10, and the event is kept. It is no fault: a stage that stands still under its servo is safer than one whose motors
//! are off, and whoever comes back finds it where it stopped.
//!
//! | file | idea |
//! |---|---|
//! | `state` | when the host was heard last, and who has promised it |
//! | `execute` | `HBT`, and what follows a silence |

mod execute;
mod state;

pub(super) use state::Heartbeat;
