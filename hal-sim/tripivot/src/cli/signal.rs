//! Ctrl-C.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use desk::serve::ServeError;
use signal_hook::consts::{SIGINT, SIGTERM};

/// Set once Ctrl-C is pressed or the process is asked to end.
///
/// # Errors
/// [`ServeError::Signals`].
pub fn until_signal() -> Result<Arc<AtomicBool>, ServeError> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        signal_hook::flag::register(signal, Arc::clone(&stop)).map_err(ServeError::Signals)?;
    }
    Ok(stop)
}
