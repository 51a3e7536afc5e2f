//! Counts what an XML text holds once its entities are expanded, before any is expanded.

use super::budget::{ATTRIBUTE, Budget, TAG};
use super::error::SvgError;
use std::collections::{HashMap, HashSet};

/// Maximum nesting of entities, the same as the parser's.
const DEEPEST: usize = 10;
/// Steps per comparison of two names: of namespaces in scope, of an element's attributes, of entities.
const COMPARISON: f64 = 0.003;

/// Spends the steps of parsing a text.
pub(super) fn spend_parsing(text: &str, budget: &mut Budget) -> Result<(), SvgError> {
    let mut entities = Entities::of(text);
    let census = entities.census(text, 0)?;
    let prefixes = entities.prefixes.len() as f64;
    budget.text(census.bytes)?;
    budget.spend(TAG * census.tags, "elements")?;
    budget.spend(ATTRIBUTE * census.attributes + COMPARISON * census.pairs, "attributes")?;
    // An element that declares a namespace copies all that are in scope.
    budget.spend(COMPARISON * prefixes * (census.tags + 4.0 * census.namespaces), "namespaces")?;
    budget.spend(COMPARISON * entities.values.len() as f64 * census.references, "entities")?;
    Ok(())
}

/// Sums over a text. Text that only looks like an element or attribute (in a comment or a script) counts too.
#[derive(Clone, Copy, Default)]
struct Census {
    bytes: f64,
    tags: f64,
    attributes: f64,
    /// Sum of the squares of the attribute counts.
    pairs: f64,
    namespaces: f64,
    references: f64,
}

impl Census {
    fn add(&mut self, other: &Self) {
        self.bytes += other.bytes;
        self.tags += other.tags;
        self.attributes += other.attributes;
        self.pairs += other.pairs;
        self.namespaces += other.namespaces;
        self.references += other.references;
    }

    fn tag(&mut self, attributes: f64) {
        self.attributes += attributes;
        self.pairs += attributes * attributes;
    }
}

struct Entities<'a> {
    /// All declared values by name.
    values: HashMap<&'a str, Vec<&'a str>>,
    counted: HashMap<&'a str, Census>,
    prefixes: HashSet<&'a str>,
}

impl<'a> Entities<'a> {
    fn of(text: &'a str) -> Self {
        let mut values: HashMap<&str, Vec<&str>> = HashMap::new();
        for (at, sign) in text.match_indices("<!ENTITY") {
            if let Some((name, value)) = declared(&text[at + sign.len()..]) {
                values.entry(name).or_default().push(value);
            }
        }
        Self { values, counted: HashMap::new(), prefixes: HashSet::new() }
    }

    fn census(&mut self, text: &'a str, depth: usize) -> Result<Census, SvgError> {
        let bytes = text.as_bytes();
        let mut census = Census { bytes: bytes.len() as f64, ..Census::default() };
        let mut attributes = 0.0;
        for (at, byte) in bytes.iter().enumerate() {
            match byte {
                b'<' => {
                    census.tag(std::mem::take(&mut attributes));
                    census.tags += 1.0;
                }
                b'=' if is_value(&bytes[at + 1..]) => {
                    attributes += 1.0;
                    if let Some(prefix) = namespace(&text[..at]) {
                        census.namespaces += 1.0;
                        self.prefixes.insert(prefix);
                    }
                }
                b'&' if !self.values.is_empty() => {
                    let rest = &text[at + 1..];
                    let end = rest.find(|c: char| !(c.is_alphanumeric() || "_-.:".contains(c))).unwrap_or(rest.len());
                    census.add(&self.entity(&rest[..end], depth)?);
                }
                _ => {}
            }
        }
        census.tag(attributes);
        Ok(census)
    }

    /// Counts an entity's content; if its name is declared several times, the sum of all.
    fn entity(&mut self, name: &'a str, depth: usize) -> Result<Census, SvgError> {
        if let Some(census) = self.counted.get(name) {
            return Ok(*census);
        }
        let Some(values) = self.values.get(name).cloned() else { return Ok(Census::default()) };
        if depth >= DEEPEST {
            return Err(SvgError::Entities);
        }
        let mut census = Census { references: 1.0, ..Census::default() };
        for value in values {
            census.add(&self.census(value, depth + 1)?);
        }
        self.counted.insert(name, census);
        Ok(census)
    }
}

/// The name and the value of an entity's declaration.
fn declared(text: &str) -> Option<(&str, &str)> {
    let text = text.trim_start();
    let text = text.strip_prefix('%').map_or(text, str::trim_start);
    let (name, rest) = text.split_at(text.find(|c: char| c.is_whitespace() || c == '"' || c == '\'')?);
    let rest = rest.trim_start();
    let quote = rest.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    Some((name, rest[1..].split(quote).next().unwrap_or_default()))
}

/// True if a quoted value begins here.
fn is_value(bytes: &[u8]) -> bool {
    matches!(bytes.iter().find(|byte| !byte.is_ascii_whitespace()), Some(b'"' | b'\''))
}

/// The namespace prefix that an attribute declares, given the text up to its `=`.
fn namespace(text: &str) -> Option<&str> {
    let name = text.trim_end().rsplit(|c: char| c.is_whitespace() || c == '"' || c == '\'').next()?;
    name.strip_prefix("xmlns").map(|rest| rest.trim_start_matches(':'))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn census(text: &str) -> Census {
        Entities::of(text).census(text, 0).unwrap_or_default()
    }

    #[test]
    fn elements_attributes_and_namespaces() {
        let found = census("<svg xmlns='a' xmlns:x = \"b\"><g id='1' x:y='2' style='a:b=c'>a = b</g><g/></svg>");
        assert_eq!((found.tags, found.attributes, found.pairs, found.namespaces), (5.0, 5.0, 4.0 + 9.0, 2.0));
    }

    #[test]
    fn white_space_of_any_length_ends_a_name() {
        let found = census("<?xml\u{2000}xmlns:a=\"b\"\u{85}xmlns='c'\u{a0}d='e'?>");
        assert_eq!((found.attributes, found.namespaces), (3.0, 2.0));
    }

    #[test]
    fn entities_are_written_out() {
        let declared = "<!DOCTYPE svg [<!ENTITY a '0123456789'> <!ENTITY b \"&a;&a;<g/>\">]>";
        let text = format!("{declared}<svg d='&b;&b;&amp;'/>");
        let found = census(&text);
        // The declaration of b counts once too.
        assert_eq!(found.bytes, text.len() as f64 + 2.0 * 10.0 + 2.0 * (10.0 + 20.0));
        assert_eq!(found.references, 2.0 + 2.0 * 3.0);
    }

    #[test]
    fn entities_without_end_are_refused() {
        let text = "<!DOCTYPE svg [<!ENTITY a '&b;'> <!ENTITY b '&a;'>]><svg>&a;</svg>";
        assert!(matches!(spend_parsing(text, &mut Budget::default()), Err(SvgError::Entities)));
        let level = |i: usize| format!("<!ENTITY e{i} '{}'>", format!("&e{};", i - 1).repeat(30));
        let levels = (1..9).map(level).collect::<Vec<_>>().concat();
        let text = format!("<!DOCTYPE svg [<!ENTITY e0 'lol'>{levels}]><svg>&e8;</svg>");
        assert!(matches!(spend_parsing(&text, &mut Budget::default()), Err(SvgError::Work(_))));
    }
}
