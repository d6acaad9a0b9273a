//! The controller in front of a machine: on the host here; on an emulated chip in the package `image`.
//!
//! | file | idea |
//! |---|---|
//! | `control_loop` | [`ControlLoop`]: the firmware's tick with its state, which is given what the hardware would give it |
//! | `host` | [`Host`]: the same behind the firmware's drivers, between the simulated encoders and bridges |

mod control_loop;
mod host;

pub use control_loop::ControlLoop;
pub use host::{Host, Wiring};

use firmware::control::Outputs;
use firmware::fault::FaultKind;
use firmware::parameters::Parameters;
use firmware::queues::TickQueues;
use firmware::recorder::TickObserver;

/// A controller's loop with what it stands before.
pub trait Front {
    /// One tick of the controller, and what it stands before up to the next.
    fn tick(&mut self, link: &mut TickQueues<'_>, recorder: &mut impl TickObserver) -> Outputs;

    /// Starts the controller again, with these parameters, perhaps a fault, and motors as warm as the retained memory says; what it
    /// stands before stays as it is.
    fn restart(&mut self, parameters: &Parameters, fault: Option<FaultKind>, motor_heat: [f32; 3]);
}
