//! Ids that no other drawing has: several drawings may stand in one page.

use super::SvgHead;
use crate::drawing::{Drawing, Mark};
use sha2::{Digest, Sha256};

/// The part of ids that belongs to one drawing.
#[derive(Clone, Debug)]
pub(crate) struct Names {
    own: String,
}

impl Names {
    /// From what is drawn and its title.
    pub(crate) fn of(drawing: &Drawing, head: &SvgHead) -> Self {
        let layers = drawing.layers.iter().flat_map(|layer| {
            let first = layer.marks.first().map(Mark::bounding_box);
            let place = first.map_or([0.0; 2], |bounds| [bounds.x0, bounds.y1]);
            [layer.marks.len() as f64, place[0], place[1]]
        });
        Self::new(head, [drawing.page.width, drawing.page.height].into_iter().chain(layers))
    }

    /// From a title and any numbers.
    pub(crate) fn new(head: &SvgHead, numbers: impl Iterator<Item = f64>) -> Self {
        let mut hash = Sha256::new();
        hash.update(head.title.as_bytes());
        numbers.for_each(|number| hash.update(number.to_bits().to_le_bytes()));
        let digest = hash.finalize();
        Self { own: digest[..4].iter().fold(String::new(), |text, byte| text + &format!("{byte:02x}")) }
    }

    /// The id of the layer with this index.
    pub(crate) fn of_layer(&self, index: usize) -> String {
        format!("layer{}_{}", index + 1, self.own)
    }

    /// The id of a part such as the paper.
    pub(crate) fn of_part(&self, part: &str) -> String {
        format!("{part}_{}", self.own)
    }
}
