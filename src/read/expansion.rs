//! Counts what an SVG becomes when every use, marker, pattern, mask and clip path is expanded. Works on the XML, before
//! expansion.
//!
//! ```text
//!   13 markers, each drawn at 3 places of the one before: 3^13 paths from 1.5 KB
//!
//!   load(element) = its own + its children's + those of what it uses
//!   A shape inherits fill, stroke and markers from where it is used. Its load leaves them open, as numbers of fills, strokes
//!   and vertices; the next element outwards that sets one multiplies the load of what it refers to by that number.
//! ```
//!
//! Each element is counted once, however often it is used. Counts are floats, so they cannot overflow.

use super::budget::{ATTRIBUTE, Budget, ELEMENT, PATH, SEGMENT};
use super::error::SvgError;
use super::shape_cost::{shape, single};
use super::styles::{FILL, MARKERS, NOT_INHERITED, STROKE, Style, Styles, references, style_steps};
use roxmltree::{Document, Node, NodeId};
use std::collections::{HashMap, HashSet};

const XLINK: &str = "http://www.w3.org/1999/xlink";

/// Maximum nesting of elements, with uses and references followed. Every level takes room on the stack.
const DEEPEST: usize = 512;
/// Steps of resolving what a shape inherits, per attribute of an enclosing element.
const INHERITED: f64 = 0.015;
/// Steps per comparison when the target of a reference is looked up among all others of its kind.
const LOOKED_UP: f64 = 5e-4;
/// Steps per element visited in the search for circular references.
const PASSED: f64 = 0.02;

/// The work of an element.
#[derive(Clone, Copy, Default)]
struct Load {
    /// Number of elements with uses expanded.
    elements: f64,
    /// Steps of reading them with their styles.
    parsing: f64,
    /// Steps of drawing them with everything they refer to.
    drawing: f64,
    /// Number of references, and of those whose target is instantiated for one shape alone.
    links: f64,
    single: f64,
    /// Number of references to elements of the wrong kind.
    mismatched_references: f64,
    shapes: f64,
    /// Number of fills and strokes that take their paint from the context (`context-fill`, `context-stroke`).
    context: f64,
    /// Numbers of fills, strokes, first vertices, vertices and last vertices whose style is inherited from outside.
    open: [f64; 5],
    depth: usize,
}

impl Load {
    fn add(&mut self, other: &Self) {
        self.add_definition(other);
        self.drawing += other.drawing;
        self.links += other.links;
        self.single += other.single;
        self.shapes += other.shapes;
        self.context += other.context;
        self.open.iter_mut().zip(other.open).for_each(|(sum, open)| *sum += open);
    }

    /// Adds a definition, which is drawn only where it is referred to.
    fn add_definition(&mut self, other: &Self) {
        self.elements += other.elements;
        self.parsing += other.parsing;
        self.mismatched_references += other.mismatched_references;
        self.depth = self.depth.max(other.depth + 1);
    }

    /// Adds something that is drawn `times` times.
    fn add_drawn(&mut self, other: &Self, times: f64) {
        self.drawing += times * (ELEMENT + other.drawing);
        self.links += times * other.links;
        self.single += times * other.single;
        self.context += times * other.context;
        self.depth = self.depth.max(other.depth + 1);
    }
}

/// Spends the steps of expanding a document and returns its number of elements. An error if something refers to itself.
pub(super) fn spend_expansion(document: &Document<'_>, budget: &mut Budget) -> Result<f64, SvgError> {
    let styles = Styles::of(document, budget)?;
    spend_style_matching(document, &styles, budget)?;
    let mut expansion = Expansion::new(document, &styles, budget);
    let root = expansion.element(document.root_element(), 0)?;
    let largest_pattern = expansion.largest_pattern;
    budget.spend(root.parsing, "elements and their styles")?;
    budget.spend(root.drawing + root.context * largest_pattern, "uses, markers, patterns and masks")?;
    budget.spend(LOOKED_UP * root.links * root.single, "references")?;
    budget.spend(PASSED * root.mismatched_references * root.elements, "references")?;
    Ok(root.elements)
}

/// Spends the steps of trying every style rule on every element once.
fn spend_style_matching(document: &Document<'_>, styles: &Styles<'_>, budget: &mut Budget) -> Result<(), SvgError> {
    let mut by_depth: Vec<f64> = Vec::new();
    let mut open: Vec<NodeId> = Vec::new();
    let mut steps = 0.0;
    for node in document.descendants() {
        let parent = node.parent().map(|parent| parent.id());
        while !open.is_empty() && open.last().copied() != parent {
            open.pop();
        }
        open.push(node.id());
        by_depth.resize(by_depth.len().max(open.len()), 0.0);
        by_depth[open.len() - 1] += 1.0;
        steps += style_steps(node);
    }
    steps += by_depth.iter().enumerate().map(|(depth, number)| number * styles.trials(depth)).sum::<f64>();
    Ok(budget.spend(steps, "styles")?)
}

/// Elements that are drawn only where something refers to them.
const REFERRED: [&str; 7] = ["marker", "pattern", "mask", "clipPath", "filter", "linearGradient", "radialGradient"];
/// What paint may refer to.
const PAINTS: &[&str] = &["pattern", "linearGradient", "radialGradient"];
const KINDS: [&[&str]; 8] = [PAINTS, PAINTS, &["marker"], &["marker"], &["marker"], &["mask"], &["clipPath"], &["filter"]];

struct Expansion<'a, 'd, 'b> {
    styles: &'b Styles<'a>,
    budget: &'b mut Budget,
    by_id: HashMap<&'a str, Vec<Node<'a, 'd>>>,
    /// Every `use` in document order with its target.
    uses: Vec<(NodeId, NodeId)>,
    /// Bytes of all text between tags.
    texts: f64,
    styles_around: HashMap<NodeId, Style<'a>>,
    /// Loads of elements with an id: only those can be visited twice.
    loads: HashMap<NodeId, Load>,
    drawn: HashMap<NodeId, Load>,
    open: HashSet<NodeId>,
    open_drawn: HashSet<NodeId>,
    /// Markers found within themselves, where they are not drawn again. Loads counted there are not cached.
    recursive_markers: Vec<NodeId>,
    largest_pattern: f64,
}

impl<'a, 'd, 'b> Expansion<'a, 'd, 'b> {
    fn new(document: &'a Document<'d>, styles: &'b Styles<'a>, budget: &'b mut Budget) -> Self {
        let mut by_id: HashMap<&str, Vec<Node>> = HashMap::new();
        for node in document.descendants() {
            if let Some(id) = node.attribute("id") {
                by_id.entry(id).or_default().push(node);
            }
        }
        let target = |node: Node| by_id.get(href(node)?)?.first().map(Node::id);
        let uses = document.descendants().filter(|node| node.tag_name().name() == "use");
        let uses = uses.filter_map(|node| Some((node.id(), target(node)?))).collect();
        let texts = document.descendants().filter(Node::is_text).filter_map(|node| node.text()).map(str::len).sum::<usize>();
        Self {
            styles,
            budget,
            by_id,
            uses,
            texts: texts as f64,
            styles_around: HashMap::new(),
            loads: HashMap::new(),
            drawn: HashMap::new(),
            open: HashSet::new(),
            open_drawn: HashSet::new(),
            recursive_markers: Vec::new(),
            largest_pattern: 0.0,
        }
    }

    /// The load of an element in place, with what it inherits left open.
    fn element(&mut self, node: Node<'a, 'd>, depth: usize) -> Result<Load, SvgError> {
        if let Some(load) = self.loads.get(&node.id()) {
            return Ok(*load);
        }
        if depth > DEEPEST {
            return Err(SvgError::TooDeep(DEEPEST));
        }
        if !self.open.insert(node.id()) {
            return Err(circle(node));
        }
        let met_outside = std::mem::take(&mut self.recursive_markers);
        let style = self.styles.style(node);
        let mut load = self.own(node, &style);
        for child in node.children().filter(Node::is_element) {
            self.child(child, &mut load, depth + 1)?;
        }
        self.linked(node, &style, &mut load, depth + 1)?;
        self.referred(node, &style, &mut load, depth + 1)?;
        self.close(node, &style, &mut load, depth + 1)?;
        if load.depth > DEEPEST {
            return Err(SvgError::TooDeep(DEEPEST));
        }
        self.open.remove(&node.id());
        if self.recursive_markers.is_empty() && node.has_attribute("id") {
            self.loads.insert(node.id(), load);
        }
        self.recursive_markers.extend(met_outside);
        Ok(load)
    }

    fn own(&self, node: Node<'a, 'd>, style: &Style<'a>) -> Load {
        let bytes = node.attributes().map(|attribute| attribute.value().len()).sum::<usize>() as f64;
        let texts = node.children().filter(Node::is_text);
        let (mut number, mut text) = (0.0, 0.0);
        if matches!(node.tag_name().name(), "text" | "tspan" | "textPath") {
            (number, text) = texts.fold((0.0, 0.0), |(n, sum), node| (n + 1.0, sum + node.text().map_or(0, str::len) as f64));
        }
        let reading = Budget::steps_of_text(bytes + text);
        let trials = if self.styles.is_empty() { 0.0 } else { self.styles.trials(node.ancestors().count()) };
        let attributes = node.attributes().len() as f64;
        let parsing = ELEMENT + ATTRIBUTE * attributes + reading + trials + style.steps;
        let mut load = Load { elements: 1.0 + number, parsing, drawing: reading, ..Load::default() };
        if let Some((segments, subpaths)) = shape(node) {
            load.drawing += SEGMENT * segments + PATH * subpaths;
            load.shapes = 1.0;
            load.open = [1.0, 1.0, 1.0, segments, 1.0];
        }
        load
    }

    fn child(&mut self, child: Node<'a, 'd>, load: &mut Load, depth: usize) -> Result<(), SvgError> {
        match child.tag_name().name() {
            name if REFERRED.contains(&name) => load.add_definition(&self.drawn(child, depth)?),
            "defs" | "symbol" | "metadata" | "style" | "title" | "desc" => load.add_definition(&self.element(child, depth)?),
            _ => load.add(&self.element(child, depth)?),
        }
        Ok(())
    }

    /// Adds the target of an element's `href`.
    fn linked(&mut self, node: Node<'a, 'd>, style: &Style<'a>, load: &mut Load, depth: usize) -> Result<(), SvgError> {
        let targets = href(node).and_then(|id| self.by_id.get(id)).cloned().unwrap_or_default();
        match node.tag_name().name() {
            "use" => {
                let Some(&target) = targets.first() else { return Ok(()) };
                load.parsing += PASSED * f64::from(last_within(target).get() - target.id().get());
                if self.is_circular_use(node, target)? {
                    return Ok(());
                }
                // A used element with `inherit` takes the mask, clip path or filter of the use.
                let inherits = self.styles.style(target);
                for place in NOT_INHERITED.filter(|place| inherits.values[*place].is_some_and(|value| value.trim() == "inherit"))
                {
                    self.refer(place, style.values[place].unwrap_or_default(), load, depth)?;
                }
                match target.tag_name().name() {
                    name if REFERRED.contains(&name) => load.add_definition(&self.drawn(target, depth)?),
                    "defs" => load.add_definition(&self.element(target, depth)?),
                    _ => load.add(&self.element(target, depth)?),
                }
            }
            "pattern" | "linearGradient" | "radialGradient" | "filter" | "feImage" => {
                for target in targets {
                    let drawn = self.drawn(target, depth)?;
                    load.add_drawn(&drawn, 1.0);
                }
            }
            "tref" => load.parsing += Budget::steps_of_text(self.texts) + PASSED * self.by_id.len() as f64,
            _ => {}
        }
        Ok(())
    }

    /// True if a `use` is skipped because it is circular: it uses itself, an ancestor, or something that uses it.
    fn is_circular_use(&mut self, node: Node<'a, 'd>, target: Node<'a, 'd>) -> Result<bool, SvgError> {
        let first = self.uses.partition_point(|(id, _)| id.get() <= target.id().get());
        let last = self.uses.partition_point(|(id, _)| id.get() <= last_within(target).get());
        self.budget.spend(PASSED * 0.1 * (last - first) as f64, "uses")?;
        Ok(target == node || self.uses[first..last].iter().any(|(_, to)| *to == node.id() || *to == target.id()))
    }

    /// Adds an element's own mask, clip path and filter.
    fn referred(&mut self, node: Node<'a, 'd>, style: &Style<'a>, load: &mut Load, depth: usize) -> Result<(), SvgError> {
        for place in NOT_INHERITED {
            let mut value = style.values[place];
            let mut around = node.parent_element();
            while let (Some("inherit"), Some(parent)) = (value.map(str::trim), around) {
                value = self.style_around(parent).values[place];
                around = parent.parent_element();
            }
            self.refer(place, value.unwrap_or_default(), load, depth)?;
        }
        Ok(())
    }

    fn refer(&mut self, place: usize, value: &'a str, load: &mut Load, depth: usize) -> Result<(), SvgError> {
        self.multiply(place, value, 1.0, load, depth)
    }

    /// Adds the target of a property's value `times` times.
    fn multiply(&mut self, place: usize, value: &'a str, times: f64, load: &mut Load, depth: usize) -> Result<(), SvgError> {
        for id in references(value) {
            let targets = self.by_id.get(id).cloned().unwrap_or_default();
            self.budget.spend(PASSED * targets.len() as f64, "references")?;
            for target in targets {
                if !KINDS[place].contains(&target.tag_name().name()) {
                    load.mismatched_references += times;
                    continue;
                }
                let drawn = self.drawn(target, depth)?;
                load.add_drawn(&drawn, times);
                load.links += times;
                load.single += if MARKERS.contains(&place) { times.min(load.shapes) } else { times * single(target) };
            }
        }
        Ok(())
    }

    /// Multiplies what an element sets by the number of shapes that inherit it.
    fn close(&mut self, node: Node<'a, 'd>, style: &Style<'a>, load: &mut Load, depth: usize) -> Result<(), SvgError> {
        for place in FILL..MARKERS.end {
            let Some(value) = style.values[place].map(str::trim).filter(|value| *value != "inherit") else { continue };
            let times = std::mem::take(&mut load.open[place]);
            if place <= STROKE && value.starts_with("context-") {
                load.context += times;
            } else if times > 0.0 {
                self.multiply(place, value, times, load, depth)?;
            }
        }
        load.drawing += INHERITED * load.shapes * (1 + node.attributes().len()) as f64;
        Ok(())
    }

    fn style_around(&mut self, node: Node<'a, 'd>) -> Style<'a> {
        let styles = self.styles;
        *self.styles_around.entry(node.id()).or_insert_with(|| styles.style(node))
    }

    /// The load of a referenced element, which inherits from its own ancestors.
    fn drawn(&mut self, node: Node<'a, 'd>, depth: usize) -> Result<Load, SvgError> {
        if let Some(load) = self.drawn.get(&node.id()) {
            return Ok(*load);
        }
        let is_marker = node.tag_name().name() == "marker";
        if !self.open_drawn.insert(node.id()) {
            // A marker within itself is not drawn; anything else would recurse forever.
            self.recursive_markers.push(node.id());
            return if is_marker { Ok(Load::default()) } else { Err(circle(node)) };
        }
        self.budget.spend(ELEMENT, "references")?;
        let met_outside = std::mem::take(&mut self.recursive_markers);
        let mut load = self.element(node, depth)?;
        for around in node.ancestors().skip(1).filter(Node::is_element) {
            let style = self.style_around(around);
            self.close(around, &style, &mut load, depth)?;
        }
        self.open_drawn.remove(&node.id());
        self.recursive_markers.retain(|recursive_markers| *recursive_markers != node.id());
        if self.recursive_markers.is_empty() {
            self.drawn.insert(node.id(), load);
        }
        self.recursive_markers.extend(met_outside);
        if node.tag_name().name() == "pattern" {
            self.largest_pattern = self.largest_pattern.max(load.drawing);
        }
        Ok(load)
    }
}

fn circle(node: Node<'_, '_>) -> SvgError {
    SvgError::Circle(node.attribute("id").unwrap_or_else(|| node.tag_name().name()).to_owned())
}

/// The id that an element links to: SVG 2's `href`, else `XLink`'s.
fn href<'a>(node: Node<'a, '_>) -> Option<&'a str> {
    let found = |namespace: Option<&str>| {
        node.attributes().find(|attribute| attribute.name() == "href" && attribute.namespace() == namespace)
    };
    found(None).or_else(|| found(Some(XLINK)))?.value().trim().strip_prefix('#')
}

fn last_within(node: Node<'_, '_>) -> NodeId {
    let mut last = node;
    while let Some(child) = last.last_child() {
        last = child;
    }
    last.id()
}

#[cfg(test)]
mod tests;
