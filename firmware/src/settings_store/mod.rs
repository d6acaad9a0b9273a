//! Settings that survive a restart, in flash.
//!
//! Everything that is stored is written whole behind what was stored before: a power cut leaves all of the old settings
//! or all of the new ones, never a set of parameters of which only some were changed. [`SettingsStore`] reads it before
//! anything can move and writes it while the stage is at rest; it runs on the command side, and the tick never waits
//! for it. What the settings are is for their owner to say ([`StoredSettings`]).
//!
//! | file | idea |
//! |---|---|
//! | `store` | when contents are read and written |
//! | `stored_settings` | whoever has settings |
//! | `journal` | where contents lie, and which of several are the newest; power cuts, damage |
//! | `envelope` | what stands around contents, and whether they are whole |
//! | `byte_counter` | how long contents are, before they are written |
//! | `error` | why settings could not be stored |
//!
//! Why no key-value store of the crates there are: the flash's contract
//! ([`NorFlash`](embedded_storage::nor_flash::NorFlash)) leaves a page whose erase was cut off with undefined contents,
//! and a store that tells a page's state by one byte of it can then take an old page for the one in use. And such a
//! store passes over an item whose checksum is wrong, which is right after a power cut and wrong after damage: an
//! encoder's offset would silently be the default again.

mod byte_counter;
mod envelope;
mod error;
mod journal;
mod store;
mod stored_settings;

pub use envelope::{Reader, Sink, envelope_bytes};
pub use error::StoreError;
pub use store::SettingsStore;
pub use stored_settings::{StoredSettings, Unusable};
