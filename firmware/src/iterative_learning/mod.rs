//! Iterative learning: a move that is repeated is followed better each time.
//!
//! What a model of the machine and its feedback leave of an error is the same whenever the same plan is followed from the same place, so
//! it can be put right before it comes. A table of voltages, a point each half millisecond or more, goes with the plan; linear between
//! its points it is added to feedforward. In a trial k the voltage that the plan would have needed is
//!
//! ```text
//! u_k + v_k - P^-1 e_k        u the table, v what the feedback added, e the following error, P from volts to the pivot's angle
//! ```
//!
//! and that, smoothed, is the next table: feedback is what the model had not known, and what it left undone is put into volts by the
//! drive's and the body's inertia, `P^-1 e = R J / (Kt N) e'' + (Kt N + R b / (Kt N)) e'`, as much later as winding and latency take. It is
//! the inverse of the loop as far as the points reach, some 350 Hz where they are half a millisecond apart (Bristow, Tharayil, Alleyne,
//! A survey of iterative learning control, 2006).
//!
//! The first step is a quarter: a machine that is told too heavy by r answers r times too much, and from twice on a whole step makes it
//! worse. A step that gains what it should is followed by one twice as large. Where a trial was worse than the best, the best is followed
//! once more, for it may have started from another state of the friction; if it still is the best, the step from it is halved, as are
//! those to come; three times in a row, and the best is what stays. Where a trial is hardly better, what is left is noise, and the step is
//! halved as well.
//!
//! The tick adds up and keeps one number a point and pivot; all else is done beside it, after the move. At the end of the table what it
//! holds goes over to the integral, without a step.
//!
//! | file | idea |
//! |---|---|
//! | `memory` | what the tick and the command side share: the table that is followed, and what the feedback had to add |
//! | `trial` | the tick's part |
//! | `tables` | the tables by their names, and what they learn |
//! | `kept` | tables that outlive a restart |

mod kept;
mod memory;
mod tables;
mod trial;

pub use kept::KeptTable;
pub use memory::{
    POOL_POINTS, Point, TRIAL_POINTS, TrialControl, TrialMemory, TrialResult, TrialTable,
};
pub use tables::{
    LearningError, MOST_TABLES, Repeated, TableName, TableReport, TableState, Tables,
};
pub use trial::{InversePlant, ServoStep, Trial};
