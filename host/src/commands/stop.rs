//! Ctrl-C, and requests to terminate.

use super::CommandError;
use signal_hook::consts::{SIGINT, SIGTERM};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A file that may not grow further is a write that fails, with an error to be told, rather than the end of the program.
pub(super) fn outlive_limits_of_files() {
    // Where it cannot be had, the program ends as others do.
    #[cfg(unix)]
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::new(AtomicBool::new(false)));
}

/// A flag that Ctrl-C and requests to terminate raise; they do nothing else any more. A command that has acted upon it
/// lowers it, and then sees whether there is another.
#[derive(Debug)]
pub(super) struct StopSignal(Arc<AtomicBool>);

impl StopSignal {
    /// From now on.
    ///
    /// # Errors
    /// [`CommandError::Signal`].
    pub(super) fn catch() -> Result<Self, CommandError> {
        let raised = Arc::new(AtomicBool::new(false));
        for signal in [SIGINT, SIGTERM] {
            signal_hook::flag::register(signal, Arc::clone(&raised)).map_err(CommandError::Signal)?;
        }
        Ok(Self(raised))
    }

    /// The flag, for those who only look.
    pub(super) fn flag(&self) -> &AtomicBool {
        &self.0
    }

    /// Whether it is raised.
    pub(super) fn is_raised(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Whether it was raised; it no longer is.
    pub(super) fn take(&self) -> bool {
        self.0.swap(false, Ordering::Relaxed)
    }
}
