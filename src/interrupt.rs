//! A request to stop that every long loop checks.
//!
//! The caller keeps one handle and passes a clone to the work. Loops check it every few milliseconds. Once it is raised, the work
//! drops its unfinished result and returns [`Interrupted`].
//!
//! ```
//! use drypoint::interrupt::{Interrupt, Interrupted};
//!
//! let interrupt = Interrupt::new();
//! assert_eq!(interrupt.check(), Ok(()));
//! interrupt.clone().raise();
//! assert_eq!(interrupt.check(), Err(Interrupted));
//! ```

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use thiserror::Error;

/// A handle to one request to stop; clones share it. Checking it costs about as much as a comparison.
#[derive(Clone, Debug)]
pub struct Interrupt(Option<Arc<AtomicBool>>);

/// The work was stopped before it was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("interrupted")]
pub struct Interrupted;

impl Default for Interrupt {
    /// A handle that can be raised.
    fn default() -> Self {
        Self(Some(Arc::default()))
    }
}

impl Interrupt {
    /// A handle that can be raised.
    pub fn new() -> Self {
        Self::default()
    }

    /// A handle for work that is never stopped; raising it does nothing.
    pub const fn never() -> Self {
        Self(None)
    }

    /// Asks the work to stop.
    pub fn raise(&self) {
        if let Some(flag) = &self.0 {
            flag.store(true, Ordering::Relaxed);
        }
    }

    /// True if the work was asked to stop.
    #[inline]
    pub fn is_raised(&self) -> bool {
        self.0.as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    /// Returns [`Interrupted`] if the work was asked to stop, for use with `?`.
    #[inline]
    pub fn check(&self) -> Result<(), Interrupted> {
        if self.is_raised() { Err(Interrupted) } else { Ok(()) }
    }
}
