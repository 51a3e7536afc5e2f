//! What a style prepares once for several drawings of one portrait.

use std::any::Any;
use std::fmt;
use std::sync::Arc;

/// What does not depend on the tone and is the same for all pens; only the style knows what it is.
#[derive(Clone, Default)]
pub(crate) struct Prepared(Option<Arc<dyn Any + Send + Sync>>);

impl Prepared {
    pub fn new(value: impl Any + Send + Sync) -> Self {
        Self(Some(Arc::new(value)))
    }

    /// What was prepared, if it is of this type.
    pub fn get<T: Any + Send + Sync>(&self) -> Option<Arc<T>> {
        self.0.clone()?.downcast().ok()
    }
}

impl fmt::Debug for Prepared {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(if self.0.is_some() { "prepared" } else { "not prepared" })
    }
}
