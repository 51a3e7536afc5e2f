//! Observers of a style at work: progress bars, `stages`, timings and tests.

use crate::drawing::Drawing;
use crate::raster::Raster;
use crate::source::MaskRole;

/// An intermediate result.
#[derive(Clone, Debug)]
pub enum Picture {
    /// Grey values, 0 black to 1 white.
    Grey(Raster<f32>),
    /// Marked pixels, shown black on white.
    Mask(Raster<u8>),
    /// Numbered regions, each in a colour of its own.
    Labels(Raster<i32>),
    /// Marks on the page.
    Drawing(Box<Drawing>),
}

/// Receives each step as it happens. All methods may be called from the drawing thread at any time.
pub trait Observer: Sync {
    /// A step begins; the previous one has ended.
    fn begin(&self, step: &str);
    /// How much of the step is done, 0 to 1.
    fn progress(&self, fraction: f64);
    /// An intermediate result; `make` is called only if it is used.
    fn picture(&self, name: &str, make: &dyn Fn() -> Picture);
    /// A warning; the drawing continues.
    fn warn(&self, message: &str);
    /// A warning that a mask of this role would resolve.
    fn want_mask(&self, role: MaskRole, message: &str) {
        self.warn(&format!("{message}; a mask of the role {} marks it", role.name()));
    }
    /// True if the work should stop.
    fn is_interrupted(&self) -> bool;
}

/// Ignores everything and never interrupts.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {
    fn begin(&self, _: &str) {}
    fn progress(&self, _: f64) {}
    fn picture(&self, _: &str, _: &dyn Fn() -> Picture) {}
    fn warn(&self, _: &str) {}
    fn is_interrupted(&self) -> bool {
        false
    }
}
