//! One output file, or with `{layer}` in its name one file per layer.

use crate::drawing::Drawing;
use std::borrow::Cow;

/// Placeholder for the layer in names of outputs and previews.
const PLACEHOLDER: &str = "{layer}";

/// A file and what it holds.
pub(super) struct LayerFile<'a> {
    pub name: String,
    /// Replaces `{layer}` in the names of the output and the preview.
    pub layer: String,
    pub drawing: Cow<'a, Drawing>,
}

/// The whole drawing, or with `{layer}` in the name one drawing per layer.
pub(super) fn split_by_layer<'a>(drawing: &'a Drawing, output: &str) -> Vec<LayerFile<'a>> {
    if !output.contains(PLACEHOLDER) {
        // A preview may still be named after the first layer.
        let layer = drawing.layers.first().map_or_else(String::new, |layer| file_part(&layer.name));
        return vec![LayerFile { name: output.to_owned(), layer, drawing: Cow::Borrowed(drawing) }];
    }
    let mut files: Vec<LayerFile<'_>> = Vec::new();
    for layer in &drawing.layers {
        let plain = file_part(&layer.name);
        // Layers whose names give the same file name must not overwrite each other.
        let numbered = (2..).map(|n| format!("{plain}-{n}"));
        let is_free = |part: &String| files.iter().all(|file| file.layer != *part);
        let part = std::iter::once(plain.clone()).chain(numbered).find(is_free).unwrap_or(plain);
        let drawing = Cow::Owned(Drawing { page: drawing.page, layers: vec![layer.clone()] });
        files.push(LayerFile { name: output.replace(PLACEHOLDER, &part), layer: part, drawing });
    }
    files
}

/// A layer's name as part of a file name; it never leads to another folder.
fn file_part(name: &str) -> String {
    let part: String = name.chars().map(|c| if c == '/' || c == '\\' || c.is_control() { '_' } else { c }).collect();
    if part.is_empty() || part.starts_with('.') { format!("_{part}") } else { part }
}

/// The file names, for a summary.
pub(super) fn names(files: &[LayerFile<'_>]) -> String {
    files.iter().map(|file| file.name.as_str()).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Layer, Page};

    #[test]
    fn every_layer_has_a_file_of_its_own_beside_the_others() {
        let layers = ["dots", "dots", "../../home/x", ""].map(|name| Layer::new(name, 1)).to_vec();
        let drawing = Drawing { page: Page::new(10.0, 10.0), layers };
        let files = split_by_layer(&drawing, "out/a-{layer}.svg");
        assert_eq!(names(&files), "out/a-dots.svg, out/a-dots-2.svg, out/a-_.._.._home_x.svg, out/a-_.svg");
        assert_eq!(split_by_layer(&drawing, "a.svg").len(), 1);
    }
}
