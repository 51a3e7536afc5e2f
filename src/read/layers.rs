//! Layers, labels and the recipe: what usvg's tree does not keep, from one pass over the XML.

use super::Dropped;
use roxmltree::{Document, Node};
use std::collections::HashMap;
use std::fmt::Write as _;

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
        let mut words = Vec::new();
        let spaced = rest.replace('+', " +");
        for word in spaced.split_whitespace() {
            let value = word.get(2..).and_then(|number| number.parse().ok());
            match (word.get(..2).map(str::to_ascii_uppercase).as_deref(), value) {
                (Some("+S"), Some(_)) => label.speed = value,
                (Some("+H"), Some(_)) => label.height = value,
                (Some("+D"), Some(_)) => label.delay = value,
                _ => words.push(word),
            }
        }
        label.name = words.join(" ");
        label
    }
}

pub(super) fn outline(document: &Document<'_>) -> Outline {
    let mut outline = Outline::default();
    collect(document.root_element(), None, &mut outline);
    outline
}

/// The text with an id in every layer's group that has none: usvg's tree keeps nothing else to know it by.
pub(super) fn with_layer_ids(text: &str, document: &Document<'_>) -> String {
    let mut out = String::with_capacity(text.len() + 64);
    let mut at = 0;
    for (i, node) in
        document.descendants().filter(|node| is_layer(*node) && node.attribute("id").is_none_or(str::is_empty)).enumerate()
    {
        let start = node.range().start;
        let name_end = start + text[start..].find(|c: char| c.is_whitespace() || c == '>' || c == '/').unwrap_or(0);
        out.push_str(&text[at..name_end]);
        let _ = write!(out, " id=\"drypoint-layer-{i}\"");
        at = name_end;
    }
    out + &text[at..]
}

fn is_layer(node: Node<'_, '_>) -> bool {
    node.tag_name().name() == "g" && node.attribute((INKSCAPE, "groupmode")) == Some("layer")
}

fn collect(node: Node<'_, '_>, layer: Option<usize>, outline: &mut Outline) {
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
                let layer = if is_layer(child) { Some(add_layer(child, layer, outline)) } else { layer };
                collect(child, layer, outline);
            }
        }
    }
}

/// The number of a group's layer. A layer within a layer is its own only when its label says something of pens.
fn add_layer(group: Node<'_, '_>, around: Option<usize>, outline: &mut Outline) -> usize {
    let id = group.attribute("id").unwrap_or_default();
    let mut label = Label::parse(group.attribute((INKSCAPE, "label")).unwrap_or(id));
    if let Some(around) = around {
        label.is_skipped |= outline.layers[around].is_skipped;
    }
    let number = match around {
        Some(around) if label.pen.is_none() && !label.is_skipped => around,
        _ => {
            outline.layers.push(label);
            outline.layers.len() - 1
        }
    };
    outline.by_id.insert(id.to_owned(), number);
    number
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
        assert_eq!(Label::parse("1+S10+D200 slow").name, "slow");
        assert_eq!(Label::parse("Sketch").pen, None);
    }
}
