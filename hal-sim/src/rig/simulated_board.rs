//! What the simulated controller says of its board: that there is none.

use firmware::self_test::{Board, Reading};

/// See the module.
pub struct SimulatedBoard;

impl Board for SimulatedBoard {
    fn name(&self) -> &'static str {
        "none: this controller is simulated, and has neither clocks nor pins to test"
    }

    fn readings(&self, _tell: &mut dyn FnMut(&Reading)) {}
}
