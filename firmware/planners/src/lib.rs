//! Planners: from a target, a velocity, a stream of targets or a stop to a [`Plan`](motion::Plan).
//!
//! They run at low priority and are compiled for size; the profiles and the check, which they call often, stand in the package
//! `motion`, compiled for speed.
//!
//! # Which planner when
//!
//! | asked for | from | planner |
//! |---|---|---|
//! | a target | rest | [`plan_line`]: a straight line |
//! | a target | motion | [`plan_retarget`]: the end of the motion under way, and a line, that overlap |
//! | a velocity | rest or motion | [`plan_jog`] |
//! | targets at a steady rate | rest | [`Stream`] |
//! | a stop | motion | [`plan_stop`], smooth or urgent |
//! | the stop of a fault | motion | none: the plan under way is followed slower and slower ([`FaultStop`](motion::FaultStop)) |
//!
//! There are two profiles. From rest to rest: seven segments, or the time-optimal ones where the pivots ask for it. From
//! any velocity and acceleration to a velocity: three segments and a closing tick; a stop is that to zero, a jog that to
//! a velocity, held, and to zero, the end of a stream that to zero. Everything else is a sum of these, because a plan is
//! linear in its pieces:
//!
//! ```text
//! speed  ______                            A new target in motion. The stop under way ends at A, a line goes from A to the
//!              \    stop                   target. Begun when the stop is over it is "stop, then line"; begun sooner, the
//!               \____                      two add up to a motion that ends at the target all the same. The least delay
//!                 ________                 at which every limit is kept is taken. Towards a target straight ahead the
//!           |    /  line  \                stop's braking and the line's acceleration cancel, and the stage goes on.
//!           |___/          \____
//!           delay                    time
//! ```
//!
//! A target in motion is planned in three steps, so that the stage reacts soon: first the stop, then a first way that takes its
//! place, then, some milliseconds into that, the soonest of all ([`Effort`]).
//!
//! Retargets, stops, streams and jogs in motion are held against every limit by one check ([`motion::check`]), with the
//! tolerances of one table ([`motion::tolerances`]). A line and a jog from rest are planned inside them by means of their own;
//! the head of the check says which.
//!
//! # Where what is
//!
//! | file or folder | idea |
//! |---|---|
//! | `steady_motion` | how far a steady motion can go before the edge or a bound: for lines and jogs |
//! | `line`, `stop`, `jog`, `stream` | the planners of the table above |
//! | `retarget` | a new target in motion: uses none of the others, but the same profiles |
#![cfg_attr(not(test), no_std)]

#[macro_use]
extern crate motion;

mod jog;
mod line;
mod retarget;
mod steady_motion;
mod stop;
mod stream;

pub use jog::plan_jog;
pub use line::disk::check_line;
pub use line::plan_line;
pub use retarget::{Effort, plan_retarget};
pub use stop::{Stop, plan_stop};
pub use stream::{
    Clock, PERIOD_RANGE, PlanProgress, PushError, STREAM_CAPACITY, Stream, StreamEnd, StreamStep,
};
