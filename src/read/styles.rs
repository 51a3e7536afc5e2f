//! The elements that an SVG element draws by reference (patterns, markers, masks), from attributes and CSS, and the cost of
//! finding them.
//!
//! The cascade is usvg's own: attributes first, then the style sheets' rules, then the `style` attribute.

use super::budget::{Budget, TooMuchWork};
use roxmltree::{Document, Node};
use simplecss::{AttributeOperator, Declaration, DeclarationTokenizer, PseudoClass, StyleSheet};
use std::collections::BTreeMap;

const SVG: &str = "http://www.w3.org/2000/svg";
const XLINK: &str = "http://www.w3.org/1999/xlink";
const XML: &str = "http://www.w3.org/XML/1998/namespace";

/// Steps per declaration and byte of text: at the end of each value, the parser counts line and column from the start.
const WAY: f64 = 1.0 / 1600.0;
/// Steps per declaration that is set.
const DECLARATION: f64 = 0.125;
/// Steps per part of a selector tried on an element, both here and in usvg.
const TRIAL: f64 = 0.1;

/// The properties that draw other elements.
pub(super) const PROPERTIES: [&str; 8] =
    ["fill", "stroke", "marker-start", "marker-mid", "marker-end", "mask", "clip-path", "filter"];
/// Their indices in [`PROPERTIES`].
pub(super) const FILL: usize = 0;
pub(super) const STROKE: usize = 1;
pub(super) const MARKERS: std::ops::Range<usize> = 2..5;
/// The properties of the element itself; the ones before are inherited.
pub(super) const NOT_INHERITED: std::ops::Range<usize> = 5..8;

/// An element's values of [`PROPERTIES`], and the steps of setting them.
#[derive(Clone, Copy, Default)]
pub(super) struct Style<'a> {
    pub values: [Option<&'a str>; 8],
    important: [bool; 8],
    pub steps: f64,
}

impl<'a> Style<'a> {
    fn set(&mut self, declaration: &Declaration<'a>) {
        let of = |name: &str| PROPERTIES.iter().position(|property| *property == name);
        let places = match declaration.name {
            "marker" => MARKERS,
            name => of(name).map_or(0..0, |place| place..place + 1),
        };
        for place in places {
            if !(self.values[place].is_some() && self.important[place]) {
                self.values[place] = Some(declaration.value);
                self.important[place] = declaration.important;
            }
        }
    }
}

/// A document's style sheets.
pub(super) struct Styles<'a> {
    sheet: StyleSheet<'a>,
    /// Number of selectors by the number of ancestors they search for at any distance.
    selectors: BTreeMap<usize, f64>,
}

impl<'a> Styles<'a> {
    pub fn of(document: &'a Document<'_>, budget: &mut Budget) -> Result<Self, TooMuchWork> {
        let mut sheet = StyleSheet::new();
        let mut rules = 0.0;
        let is_css = |node: &Node| node.attribute("type").is_none_or(|kind| kind == "text/css");
        for text in
            document.descendants().filter(|node| node.has_tag_name("style") && is_css(node)).filter_map(|node| node.text())
        {
            budget.spend(sheet_steps(text), "style sheets")?;
            rules += text.matches(['{', ',']).count() as f64;
            // All rules are sorted again for each sheet.
            budget.spend(TRIAL * rules, "style sheets")?;
            sheet.parse_more(text);
        }
        let mut selectors = BTreeMap::new();
        for rule in &sheet.rules {
            let parts = rule.selector.to_string().split_whitespace().filter(|part| !matches!(*part, ">" | "+")).count();
            *selectors.entry(parts.saturating_sub(1)).or_default() += 1.0;
        }
        Ok(Self { sheet, selectors })
    }

    /// True if there are no rules.
    pub fn is_empty(&self) -> bool {
        self.selectors.is_empty()
    }

    /// The steps of trying all selectors on an element at a given depth: all choices of ancestor for each part that searches for
    /// one.
    pub fn trials(&self, depth: usize) -> f64 {
        let choices = |parts: usize| (1..=parts).map(|i| (depth + i) as f64 / i as f64).product::<f64>();
        self.selectors.iter().map(|(parts, number)| TRIAL * number * (*parts as f64 + choices(*parts))).sum()
    }

    /// An element's values.
    pub fn style(&self, node: Node<'a, '_>) -> Style<'a> {
        let mut style = Style::default();
        for attribute in node.attributes().filter(|attribute| matches!(attribute.namespace(), None | Some(SVG | XLINK | XML))) {
            if let Some(place) = PROPERTIES.iter().position(|property| *property == attribute.name()) {
                style.values[place] = style.values[place].or(Some(attribute.value()));
            }
        }
        for rule in self.sheet.rules.iter().filter(|rule| rule.selector.matches(&XmlNode(node))) {
            rule.declarations.iter().for_each(|declaration| style.set(declaration));
            style.steps += DECLARATION * rule.declarations.len() as f64;
        }
        if let Some(text) = node.attribute("style") {
            DeclarationTokenizer::from(text).for_each(|declaration| style.set(&declaration));
            style.steps += style_steps(node);
        }
        style
    }
}

/// The steps of an element's `style` attribute.
pub(super) fn style_steps(node: Node<'_, '_>) -> f64 {
    let declarations = |text: &str| (1 + text.matches(';').count()) as f64;
    node.attribute("style").map_or(0.0, |text| declarations(text) * (DECLARATION + WAY * text.len() as f64))
}

/// The steps of parsing a style sheet.
fn sheet_steps(text: &str) -> f64 {
    let copies = text.split('}').filter_map(|rule| rule.split_once('{')).map(|(selectors, body)| {
        let (selectors, declarations) = (1 + selectors.matches(',').count(), 1 + body.matches(';').count());
        selectors as f64 * declarations as f64
    });
    DECLARATION * copies.sum::<f64>() + WAY * text.matches([';', '}']).count() as f64 * text.len() as f64
}

/// The ids that a value such as `url(#id)` refers to; a filter may name several.
pub(super) fn references(value: &str) -> impl Iterator<Item = &str> {
    value.split("url(").skip(1).filter_map(|rest| {
        let target =
            rest.split(')').next().unwrap_or_default().trim_matches(|c: char| c.is_whitespace() || c == '"' || c == '\'');
        target.strip_prefix('#')
    })
}

struct XmlNode<'a, 'd>(Node<'a, 'd>);

impl simplecss::Element for XmlNode<'_, '_> {
    fn parent_element(&self) -> Option<Self> {
        self.0.parent_element().map(XmlNode)
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        self.0.prev_sibling_element().map(XmlNode)
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.0.tag_name().name() == name
    }

    fn attribute_matches(&self, name: &str, operator: AttributeOperator<'_>) -> bool {
        self.0.attribute(name).is_some_and(|value| operator.matches(value))
    }

    fn pseudo_class_matches(&self, class: PseudoClass<'_>) -> bool {
        matches!(class, PseudoClass::FirstChild) && self.prev_sibling_element().is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cascade_and_its_cost() {
        let text = "<svg xmlns='http://www.w3.org/2000/svg'><style>.a{fill:url(#p);mask:url(#x)!important}g path{marker:url(#m)}</style>\
                    <g><path class='a' fill='red' mask='none' style='mask:none;stroke:url( \"#q\" )'/></g></svg>";
        let document = Document::parse(text).unwrap();
        let styles = Styles::of(&document, &mut Budget::default()).unwrap();
        let path = document.descendants().find(|node| node.has_tag_name("path")).unwrap();
        let style = styles.style(path);
        let ids: Vec<Vec<&str>> =
            style.values.iter().map(|value| value.map_or(Vec::new(), |v| references(v).collect())).collect();
        let expected: [&[&str]; 8] = [&["p"], &["q"], &["m"], &["m"], &["m"], &["x"], &[], &[]];
        assert_eq!(ids, expected);
        assert!(styles.trials(100) > styles.trials(2));
        let deep = format!("<svg><style>{}path{{fill:red}}</style></svg>", "g ".repeat(9));
        let document = Document::parse(&deep).unwrap();
        assert!(Styles::of(&document, &mut Budget::default()).unwrap().trials(100) > 1e9);
    }
}
