//! What was read.

use crate::drawing::Layer;

/// One layer of an SVG.
#[derive(Clone, Debug)]
pub struct ImportedLayer {
    /// Its marks.
    pub layer: Layer,
    /// Number of areas that are the outlines of swelling strokes.
    pub swells: usize,
}

impl ImportedLayer {
    /// Numbers of dots, strokes (swelling ones included) and areas.
    pub fn counts(&self) -> [usize; 3] {
        let [dots, strokes, areas] = self.layer.counts();
        [dots, strokes + self.swells, areas - self.swells]
    }
}
