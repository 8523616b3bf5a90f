//! How far a map is, and whether it is to end early, for whoever waits for it in another thread.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Counts nodes that are done and carries the wish to stop.
#[derive(Debug, Default)]
pub struct Progress {
    done: AtomicUsize,
    stopped: AtomicBool,
}

impl Progress {
    /// Nodes done so far.
    #[must_use]
    pub fn done(&self) -> usize {
        self.done.load(Ordering::Relaxed)
    }

    /// Ends the map soon, with what is done.
    pub fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    /// Whether the map is to end.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    pub(super) fn count(&self, nodes: usize) {
        self.done.fetch_add(nodes, Ordering::Relaxed);
    }
}
