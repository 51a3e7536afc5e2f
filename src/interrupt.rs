//! A request to stop, which every long loop looks at.
//!
//! Whoever starts some work keeps a handle and hands another to the work. Loops look at it every few milliseconds; what they leave
//! unfinished is thrown away, and the work returns [`Interrupted`] instead of a result.
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

/// A handle to one request to stop; clones share it. Looking at it costs about as much as a comparison.
#[derive(Clone, Debug)]
pub struct Interrupt(Option<Arc<AtomicBool>>);

/// The work was stopped before it was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("interrupted")]
pub struct Interrupted;

impl Default for Interrupt {
    /// One that can be raised.
    fn default() -> Self {
        Self(Some(Arc::default()))
    }
}

impl Interrupt {
    /// One that can be raised.
    pub fn new() -> Self {
        Self::default()
    }

    /// For work that nobody stops; raising it does nothing.
    pub const fn never() -> Self {
        Self(None)
    }

    /// Asks the work to stop.
    pub fn raise(&self) {
        if let Some(flag) = &self.0 {
            flag.store(true, Ordering::Relaxed);
        }
    }

    /// Whether the work was asked to stop.
    #[inline]
    pub fn is_raised(&self) -> bool {
        self.0.as_ref().is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    /// To be used with `?`.
    #[inline]
    pub fn check(&self) -> Result<(), Interrupted> {
        if self.is_raised() { Err(Interrupted) } else { Ok(()) }
    }
}
