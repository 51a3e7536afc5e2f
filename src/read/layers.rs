//! Layers, labels and the recipe: what usvg's tree does not keep, from one pass over the XML.

use super::Dropped;
use roxmltree::{Document, Node};
use std::collections::HashMap;

const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";
const DRYPOINT: &str = "urn:drypoint";

/// What the XML says beside the geometry.
#[derive(Debug, Default)]
pub(super) struct Outline {
    /// Layers in document order.
    pub layers: Vec<Label>,
    /// Which layer a group's id stands for.
    pub by_id: HashMap<String, usize>,
    /// The recipe of a file that drypoint wrote.
    pub recipe: Option<String>,
    /// Elements that usvg passes over in silence.
    pub dropped: Dropped,
}

/// A layer's label by the plotters' conventions: `%` skips it, `!` asks for a pause, a number names the pen, `+S`, `+H`, `+D` with
/// a number set speed, height and delay.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Label {
    pub name: String,
    pub pen: Option<u32>,
    pub is_skipped: bool,
    pub pauses: bool,
    pub speed: Option<f64>,
    pub height: Option<f64>,
    pub delay: Option<f64>,
}

impl Label {
    pub(super) fn parse(text: &str) -> Self {
        let mut rest = text.trim();
        let mut label = Self::default();
        if let Some(after) = rest.strip_prefix('%') {
            label.is_skipped = true;
            rest = after.trim_start();
        }
        if let Some(after) = rest.strip_prefix('!') {
            label.pauses = true;
            rest = after.trim_start();
        }
        let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
        label.pen = rest[..digits].parse().ok().filter(|&pen| pen > 0);
        rest = if label.pen.is_some() { &rest[digits..] } else { rest };
        for (mark, value) in [("+S", &mut label.speed), ("+H", &mut label.height), ("+D", &mut label.delay)] {
            if let Some((_, after)) = rest.to_ascii_uppercase().split_once(mark) {
                let number: String = after.trim_start().chars().take_while(|c| c.is_ascii_digit() || *c == '.').collect();
                *value = number.parse().ok();
            }
        }
        let name = rest.split('+').next().unwrap_or("").trim();
        name.clone_into(&mut label.name);
        label
    }
}

pub(super) fn outline(document: &Document<'_>) -> Outline {
    let mut outline = Outline::default();
    collect(document.root_element(), false, &mut outline);
    outline
}

fn collect(node: Node<'_, '_>, in_layer: bool, outline: &mut Outline) {
    for child in node.children().filter(Node::is_element) {
        let tag = child.tag_name().name();
        if is_hidden(child) {
            continue;
        }
        match tag {
            "recipe" if child.tag_name().namespace() == Some(DRYPOINT) => outline.recipe = child.text().map(str::to_owned),
            "defs" | "clipPath" | "mask" | "pattern" | "marker" | "symbol" | "style" | "title" | "desc" => {}
            "text" => outline.dropped.count("text"),
            "foreignObject" => outline.dropped.count("foreignObject"),
            "script" => outline.dropped.count("script"),
            _ => {
                let is_layer = tag == "g" && !in_layer && child.attribute((INKSCAPE, "groupmode")) == Some("layer");
                if is_layer {
                    add_layer(child, outline);
                }
                collect(child, in_layer || is_layer, outline);
            }
        }
    }
}

fn add_layer(group: Node<'_, '_>, outline: &mut Outline) {
    let id = group.attribute("id").unwrap_or_default();
    let label = group.attribute((INKSCAPE, "label")).unwrap_or(id);
    if !id.is_empty() {
        outline.by_id.insert(id.to_owned(), outline.layers.len());
    }
    outline.layers.push(Label::parse(label));
}

fn is_hidden(node: Node<'_, '_>) -> bool {
    let style = node.attribute("style").unwrap_or("").replace(' ', "");
    node.attribute("display") == Some("none") || style.contains("display:none")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels() {
        assert_eq!(Label::parse("1 dots"), Label { name: "dots".into(), pen: Some(1), ..Label::default() });
        assert_eq!(Label::parse("% notes"), Label { name: "notes".into(), is_skipped: true, ..Label::default() });
        let full = Label::parse("!3 red +S40 +H55 +D100");
        assert_eq!(
            (full.pauses, full.pen, full.speed, full.height, full.delay),
            (true, Some(3), Some(40.0), Some(55.0), Some(100.0))
        );
        assert_eq!(full.name, "red");
        assert_eq!(Label::parse("Sketch").pen, None);
    }
}
