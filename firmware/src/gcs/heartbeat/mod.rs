//! The host's heartbeat: when one is asked for with `HBT` or its parameter, a host that is not heard for longer is
//! taken for gone.
//!
//! With `HBT` a connection promises to be heard: any byte of its own counts, and nothing of another one does. A page that looks on
//! beside a script does not stand for a script that has died, and nobody but the connection itself can end what it has
//! promised. The parameter asks for any byte on any connection. What follows is what `STP` does: the motion ends at the highest
//! deceleration, on its path, the macro and all waits end, every connection gets error 10, and the event is kept. It is no
//! fault: a stage that stands still under its servo is safer than one whose motors are off, and whoever comes back finds it
//! where it stopped.
//!
//! | file | idea |
//! |---|---|
//! | `state` | who has promised to be heard, and when it was |
//! | `execute` | `HBT`, and what follows a silence |

mod execute;
mod state;

pub(super) use state::Heartbeat;
