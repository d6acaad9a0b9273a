//! When the host was heard last, and who has promised it.

/// When the host was heard last, and who has promised it.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::gcs) struct Heartbeat {
    /// The tick when it was heard last.
    pub last_heard_tick: u64,
    /// It has been silent for too long, and not heard since.
    pub is_silent: bool,
    /// Connections have promised to be heard, and they alone count.
    pub is_promised: bool,
    /// Times it was switched off: promises from before that are void.
    pub generation: u32,
}
