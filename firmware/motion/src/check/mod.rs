//! Whether a plan keeps to the workspace and to the limits that couple the axes, at every tick.
//!
//! A plan is looked at in intervals. Between the two ends of one, a quantity rises above the greater of its ends by no
//! more than an eighth of the square of the duration times its second derivative: for position that is the
//! acceleration, for velocity the jerk (acceleration is greatest at an end). The pivots' rates and accelerations are
//! first bounded for any orientation; where that is not enough they are computed at both ends, and rise by what the
//! platform's motion can make of their third and fourth derivatives in between. An interval that fails is taken in shorter
//! ones, unless a limit is broken at one of its ends.
//!
//! A plan of retarget or of a stream, a jog in motion and a stop are held against all of it. A line from rest is planned inside
//! the limits at the places of its own grid (`line/pivot_demand`), a jog from rest by bounds for any orientation
//! (`pivots`). This check would cost more than their planning: of a line 16,400 instructions in the mean and 76,800 at most,
//! of a jog from rest 12,100 and 45,100 (300 random states on the chip). And it knows no places: it refuses 36 of 300 lines
//! and 160 of 300 jogs in which every tick keeps every law.
//!
//! The check is compiled for speed, as all of this package: compiled for size, stops, jogs and streams were 15 to 33 % dearer.
//!
//! It does not ask for room for a stop at every instant: of 58,845 smooth stops out of new targets between 60 mm and the rim,
//! one braked 1.3 times as hard as the limit to stay inside the disk, and none left it.
//!
//! | checked | for |
//! |---|---|
//! | speed, acceleration, jerk | translation along the path and rotation; of a stop only the speed, of an urgent one nothing; a stream may have more jerk |
//! | rate and acceleration of each pivot | the platform's motion about the centre of rotation |
//! | disk | the platform's centre, which a stop that would leave it brakes harder for |
//! | bounds | x, y and theta of the moved point |
//!
//! | file | idea |
//! |---|---|
//! | `plan_check` | the pieces of a plan against every limit, interval by interval |
//! | `interval` | an interval: its ends, how large everything is in between, which limit is broken |
//! | `pivots` | what the platform asks of the pivots: at an instant, and at worst at any orientation |
//! | `workspace` | which way round to an orientation, and whether a target can be moved to |

mod interval;
pub mod pivots;
mod plan_check;
pub mod workspace;

pub use interval::Violation;
pub use plan_check::{BUDGET, PlanCheck, is_over};
