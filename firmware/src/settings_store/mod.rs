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
//! # Why no key-value store
//!
//! What is kept is small and is kept all at once, so a store of keys would only take it apart. Besides:
//!
//! - The flash's contract ([`NorFlash`]) leaves a page whose erase was cut off with undefined contents. A store that
//!   tells a page's state by one byte of it can then take an old page for the one in use.
//! - A store that passes over an item whose checksum is wrong is right after a power cut and wrong after damage: an
//!   encoder's offset would silently be the default again.
//! - `ekv` 1.0 writes all keys of a transaction or none, and reports damage. But its own page says that its format in
//!   flash is not stable yet: a new major release need not read what an old one wrote, and encoder offsets have to
//!   outlive an update of the firmware. It erases a page at least for every transaction, where a whole image here goes
//!   behind the last one without an erase. It is asynchronous and has a flash trait of its own; the command side is
//!   neither, and has [`NorFlash`].
//!
//! [`NorFlash`]: embedded_storage::nor_flash::NorFlash

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
