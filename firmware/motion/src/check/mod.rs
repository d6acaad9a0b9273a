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
//! The check is compiled for speed, as all of this package. Compiled for size, motion and planners together took 52,622
//! bytes of the image in place of 57,462, with stops, jogs and streams 15 to 33 % dearer.
//!
//! | checked | for |
//! |---|---|
//! | speed, acceleration, jerk | translation along the path and rotation; not of a stop, which has its own; a stream may have more jerk |
//! | rate and acceleration of each pivot | the platform's motion about the centre of rotation |
//! | disk | the platform's centre, and where a stop from here would end; a stream's plans have their stop in them |
//! | bounds | x, y and theta of the moved point, and where a stop from here would end |
//!
//! | file | idea |
//! |---|---|
//! | `plan_check` | the pieces of a plan against every limit, interval by interval |
//! | `interval` | an interval: its ends, how large everything is in between, which limit is broken and by how much |
//! | `pivots` | what the platform asks of the pivots: at an instant, and at worst at any orientation |
//! | `workspace` | disk and bounds, on the way and for a stop; which way round to an orientation, and whether a target can be moved to |

mod interval;
pub mod pivots;
mod plan_check;
pub mod workspace;

pub use interval::Violation;
pub use plan_check::{BUDGET, PlanCheck, is_over};
