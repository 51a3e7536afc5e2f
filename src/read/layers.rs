//! Layers, labels and the recipe: what usvg's tree does not keep, read in one pass over the XML.

use super::Dropped;
use roxmltree::{Document, Node, NodeId};
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;

const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";
const SVG: &str = "http://www.w3.org/2000/svg";
const XLINK: &str = "http://www.w3.org/1999/xlink";
const DRYPOINT: &str = "urn:drypoint";

/// What the XML holds besides geometry.
#[derive(Debug, Default)]
pub(super) struct Outline {
    /// Layers in document order.
    pub layers: Vec<Label>,
    /// Layer index by group id.
    pub by_id: HashMap<String, usize>,
    /// Ids of paths with non-scaling strokes.
    pub fixed_widths: HashSet<String>,
    /// The recipe of a file that drypoint wrote.
    pub recipe: Option<String>,
    /// The machine that drypoint wrote the labels' speeds for.
    pub speeds: Option<LabelSpeeds>,
    /// Elements that usvg silently skips.
    pub dropped: Dropped,
}

/// The meaning of `+S` in the labels of a file that drypoint wrote for a plotter.
#[derive(Clone, Debug, PartialEq)]
pub struct LabelSpeeds {
    /// The plotter's profile.
    pub machine: String,
    /// Speed of one percent, in mm/s.
    pub percent_mm_s: f64,
    /// The percentage of a layer without a speed of its own.
    pub usual_percent: f64,
}

impl LabelSpeeds {
    /// Parses the file's metadata. `None` if it is not as drypoint writes it.
    fn parse(text: &str) -> Option<Self> {
        let value: serde_json::Value = serde_json::from_str(text).ok()?;
        let number = |key: &str| value[key].as_f64().filter(|number| number.is_finite() && *number > 0.0);
        Some(Self {
            machine: value["profile"].as_str()?.to_owned(),
            percent_mm_s: number("mm_s_of_percent")?,
            usual_percent: number("usual_percent")?,
        })
    }
}

/// A layer's label by the plotters' conventions: `%` skips the layer, `!` pauses before it, a number names the pen, and `+S`,
/// `+H`, `+D` with a number set speed, height and delay.
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

/// Maximum nesting of groups. Every level takes room on the stack.
pub(super) const DEEPEST: usize = 256;

/// Collects the outline of a document. `None` if it is nested deeper than [`DEEPEST`].
pub(super) fn outline(document: &Document<'_>) -> Option<Outline> {
    let is_shallow = document.descendants().try_fold(Vec::new(), nested).is_some();
    is_shallow.then(|| {
        let hidden = Rules::of(document, &["display:none", "visibility:hidden", "visibility:collapse"]);
        let named = document.descendants().filter_map(|node| Some((node.attribute("id")?, node))).collect();
        let mut collector = Collector { outline: Outline::default(), hidden, named, used: HashMap::new() };
        collector.outline.fixed_widths = fixed_widths(document);
        collector.collect(document.root_element(), None, 0);
        collector.outline
    })
}

/// Updates the stack of open elements at a node. `None` if it is deeper than [`DEEPEST`].
fn nested(mut open: Vec<NodeId>, node: Node<'_, '_>) -> Option<Vec<NodeId>> {
    let parent = node.parent().map(|parent| parent.id());
    while !open.is_empty() && open.last().copied() != parent {
        open.pop();
    }
    open.push(node.id());
    (open.len() <= DEEPEST).then_some(open)
}

/// The text with an id added to every layer group and non-scaling stroke that has none: usvg's tree keeps nothing else to
/// identify them.
pub(super) fn with_ids<'a>(text: &'a str, document: &Document<'_>) -> Cow<'a, str> {
    let fixed = FixedWidth::of(document);
    let nameless = document.descendants().filter(|node| {
        node.is_element() && (is_layer(*node) || fixed.holds(*node)) && node.attribute("id").is_none_or(str::is_empty)
    });
    let mut out = String::new();
    let mut at = 0;
    for (i, node) in nameless.enumerate() {
        let start = node.range().start;
        let name_end = start + text[start..].find(|c: char| c.is_whitespace() || c == '>' || c == '/').unwrap_or(0);
        // The content of an entity has the range of its declaration, so it cannot get an id here.
        if start < at {
            continue;
        }
        out.push_str(&text[at..name_end]);
        let _ = write!(out, " id=\"drypoint-layer-{i}\"");
        at = name_end;
    }
    if at == 0 { Cow::Borrowed(text) } else { Cow::Owned(out + &text[at..]) }
}

fn is_layer(node: Node<'_, '_>) -> bool {
    node.tag_name().name() == "g" && node.attribute((INKSCAPE, "groupmode")) == Some("layer")
}

/// Finds the non-scaling strokes.
struct FixedWidth<'a> {
    rules: Rules<'a>,
    is_anywhere: bool,
}

impl<'a> FixedWidth<'a> {
    fn of(document: &'a Document<'_>) -> Self {
        let is_anywhere = document.input_text().contains("non-scaling-stroke");
        Self { rules: Rules::of(document, &["vector-effect:non-scaling-stroke"]), is_anywhere }
    }

    fn holds(&self, node: Node<'_, '_>) -> bool {
        self.is_anywhere && (node.attribute("vector-effect") == Some("non-scaling-stroke") || self.rules.apply_to(node))
    }
}

fn fixed_widths(document: &Document<'_>) -> HashSet<String> {
    let fixed = FixedWidth::of(document);
    let held = document.descendants().filter(|node| node.is_element() && fixed.holds(*node));
    held.filter_map(|node| node.attribute("id").map(str::to_owned)).collect()
}

struct Collector<'a, 'd> {
    outline: Outline,
    hidden: Rules<'a>,
    named: HashMap<&'a str, Node<'a, 'd>>,
    /// What is dropped in each element that a `use` refers to.
    used: HashMap<NodeId, Dropped>,
}

impl<'a, 'd> Collector<'a, 'd> {
    fn collect(&mut self, node: Node<'a, 'd>, layer: Option<usize>, depth: usize) {
        for child in node.children().filter(Node::is_element) {
            self.element(child, layer, depth);
        }
    }

    fn element(&mut self, node: Node<'a, 'd>, layer: Option<usize>, depth: usize) {
        let is_skipped = layer.is_some_and(|layer| self.outline.layers[layer].is_skipped);
        let mut count = |kind: &str| self.outline.dropped.add(kind, usize::from(!is_skipped));
        match node.tag_name().name() {
            _ if self.hidden.apply_to(node) || is_hidden(node) || depth > DEEPEST => {}
            "metadata" => {
                let own = |name: &str| {
                    let is_own = |node: &Node| node.tag_name().name() == name && node.tag_name().namespace() == Some(DRYPOINT);
                    node.descendants().find(is_own).and_then(|node| node.text())
                };
                self.outline.recipe = own("recipe").map(str::to_owned).or(self.outline.recipe.take());
                self.outline.speeds = own("machine").and_then(LabelSpeeds::parse).or(self.outline.speeds.take());
            }
            "defs" | "clipPath" | "mask" | "pattern" | "marker" | "symbol" | "style" | "title" | "desc" => {}
            "foreignObject" if has_substitute(node) => {}
            kind @ ("text" | "foreignObject" | "script" | "image") => count(kind),
            "use" => match href(node).map(|href| (href, href.strip_prefix('#').and_then(|id| self.named.get(id)).copied())) {
                Some((_, Some(target))) if !is_skipped => {
                    let dropped = self.dropped_in(target, depth);
                    self.outline.dropped.add_all(&dropped);
                }
                Some((href, None)) => count(if href.starts_with('#') { "use of nothing" } else { "use of another file" }),
                _ => {}
            },
            _ => {
                let layer = if is_layer(node) { Some(add_layer(node, layer, &mut self.outline)) } else { layer };
                self.collect(node, layer, depth + 1);
            }
        }
    }

    /// Counts what is not drawn inside an element that a `use` refers to.
    fn dropped_in(&mut self, target: Node<'a, 'd>, depth: usize) -> Dropped {
        if let Some(dropped) = self.used.get(&target.id()) {
            return dropped.clone();
        }
        // An element that uses itself adds nothing the second time.
        self.used.insert(target.id(), Dropped::default());
        let outline = std::mem::take(&mut self.outline);
        if target.tag_name().name() == "symbol" {
            self.collect(target, None, depth + 1);
        } else {
            self.element(target, None, depth + 1);
        }
        let dropped = std::mem::replace(&mut self.outline, outline).dropped;
        self.used.insert(target.id(), dropped.clone());
        dropped
    }
}

fn href<'a>(node: Node<'a, '_>) -> Option<&'a str> {
    node.attribute("href").or_else(|| node.attribute((XLINK, "href"))).map(str::trim)
}

/// True if the node is in a `switch` that has another choice after it.
fn has_substitute(node: Node<'_, '_>) -> bool {
    node.parent().is_some_and(|parent| parent.has_tag_name((SVG, "switch"))) && node.next_sibling_element().is_some()
}

/// Adds a group's layer and returns its index. A layer within a layer is separate only if its label names a pen or skips it.
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
    node.attribute("display") == Some("none") || matches!(node.attribute("visibility"), Some("hidden" | "collapse"))
}

/// Simple selectors (`.class`, `#id`, an element's name) of the style rules that contain one of the given declarations.
struct Rules<'a> {
    selectors: HashSet<&'a str>,
    declarations: &'static [&'static str],
}

impl<'a> Rules<'a> {
    fn of(document: &'a Document<'_>, declarations: &'static [&'static str]) -> Self {
        let sheets = document.descendants().filter(|node| node.is_element() && node.tag_name().name() == "style");
        let rules =
            sheets.filter_map(|sheet| sheet.text()).flat_map(|sheet| sheet.split('}')).filter_map(|rule| rule.split_once('{'));
        let found = rules.filter(|(_, body)| declares(body, declarations));
        let selectors = found.flat_map(|(selectors, _)| selectors.split(',')).map(str::trim).collect();
        Self { selectors, declarations }
    }

    fn apply_to(&self, node: Node<'_, '_>) -> bool {
        if node.attribute("style").is_some_and(|style| declares(style, self.declarations)) {
            return true;
        }
        if self.selectors.is_empty() {
            return false;
        }
        let has = |sign: &str, name: &str| self.selectors.contains(format!("{sign}{name}").as_str());
        has("", node.tag_name().name())
            || node.attribute("id").is_some_and(|id| has("#", id))
            || node.attribute("class").is_some_and(|classes| classes.split_whitespace().any(|class| has(".", class)))
    }
}

fn declares(body: &str, declarations: &[&str]) -> bool {
    let tight: String = body.chars().filter(|c| !c.is_whitespace()).collect();
    tight.split(';').any(|found| declarations.contains(&found))
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
