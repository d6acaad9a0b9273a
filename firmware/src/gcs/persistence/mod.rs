//! Settings over a restart: `WPA`, `RPA`, and macros, which are stored as they are recorded and deleted.
//!
//! The interpreter says what is to be stored, [`SettingsStore`](crate::settings_store::SettingsStore) does it while the
//! stage is at rest. `WPA` waits for it and tells the sender what came of it. Without a store, `WPA` and `RPA` are
//! refused.
//!
//! | file | idea |
//! |---|---|
//! | `state` | what is stored, and what is to be |
//! | `contents` | what stands in the store |
//! | `stored_calibration` | the calibration, as it is stored |
//! | `stored_moves` | and of the tables of repeated moves |
//! | `names` | names in it |
//! | `execute` | `WPA` and `RPA` |

mod contents;
mod execute;
mod names;
mod state;
mod stored_calibration;
mod stored_moves;

pub use contents::{Contents, STORED_BYTES};
pub(super) use state::Persistence;
