//! Plans walked tick by tick against the exact limits.

use crate::motion_bench::exact::{Worst, ends_at_rest};
use crate::planner::{Kind, Step, Way};
use firmware::motion::Constraints;

/// How many plans were walked, how many broke something, and the largest parts of the limits.
#[derive(Clone, Copy, Default)]
pub struct Walked {
    pub plans: u64,
    pub broken: u64,
    pub worst: Worst,
}

impl Walked {
    /// Takes all plans of a way, each to its end: whatever is handed over may be followed so far.
    pub fn take(&mut self, way: &Way, constraints: &Constraints) {
        for step in &way.steps {
            let (worst, is_kept) = walked(step, constraints);
            self.plans += 1;
            self.broken += u64::from(!is_kept);
            self.worst = self.worst.max(worst);
        }
    }
}

/// Parts of the limits in a plan, and whether they are kept, to what plans in motion are granted, and rest is at the
/// plan's end.
fn walked(step: &Step, constraints: &Constraints) -> (Worst, bool) {
    let motion = &step.motion;
    let mut worst = Worst::default();
    let end = worst.walk(&motion.plan, &motion.from, constraints);
    let worst = match step.kind {
        Kind::Stop => worst.of_a_stop(constraints),
        Kind::Transition => worst.left_with(&Worst::of(&motion.from, constraints), constraints),
        Kind::Line => worst,
    };
    let is_kept = worst.is_kept_but_for_a_thousandth() && ends_at_rest(&motion.plan, &end);
    (worst, is_kept)
}
