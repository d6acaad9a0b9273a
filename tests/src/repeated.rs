//! A way there and back that is repeated, and what iterative learning tells of it.

use crate::Bench;
use hal_sim::rig::run::{RunOptions, stage_parameters};

const LEVEL: &str = "CCL 1 ADVANCED\n";
/// The way out.
pub const OUT: &str = "MOV X 30 Y 10 W 20\n";
/// The way back.
pub const BACK: &str = "MOV X 0 Y 0 W 0\n";

impl Bench {
    /// Holding on a machine that is so much off the controller's model, told these lines; it has been there and back.
    ///
    /// # Panics
    /// When referencing fails.
    #[must_use]
    pub fn repeating(mismatch_percent: f64, told: &str) -> Self {
        let mut bench = Self::new(&stage_parameters(&RunOptions {
            mismatch_percent,
            ..RunOptions::default()
        }));
        assert_eq!(bench.error_after("FRF"), "0");
        bench.settle();
        bench.say(LEVEL);
        bench.say(told);
        bench.there_and_back();
        bench
    }

    /// Once more.
    pub fn there_and_back(&mut self) {
        for line in [OUT, BACK] {
            self.say(line);
            self.settle();
        }
    }

    /// Root mean square of the pivots' following errors over the way out, tick by tick, encoder counts; then it comes back.
    pub fn way_out(&mut self) -> f64 {
        self.send(OUT);
        let error = self.rms_error(5_000);
        self.settle();
        self.say(BACK);
        self.settle();
        error
    }

    /// The line of `ILC?` about a table.
    ///
    /// # Panics
    /// When there is no such table.
    pub fn table(&mut self, name: &str) -> String {
        let told = self.say("ILC?\n");
        let line = (told.lines()).find(|line| line.starts_with(&format!("{name}=")));
        line.unwrap_or_else(|| panic!("{name} in {told:?}"))
            .to_owned()
    }
}
