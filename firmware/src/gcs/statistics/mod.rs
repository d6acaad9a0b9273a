//! Statistics of the loop, gathered from every snapshot: `LST?` tells them, `LST` starts them again.
//!
//! | file | idea |
//! |---|---|
//! | `state` | what is counted |
//! | `replies` | `LST?` and `LST` |

mod replies;
mod state;

pub(super) use state::Statistics;
