//! What a file held and was not drawn.

use std::collections::BTreeMap;

/// Counts by kind, such as `text` or `image`.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(transparent)]
pub struct Dropped {
    counts: BTreeMap<String, usize>,
}

impl Dropped {
    /// Counts one.
    pub fn count(&mut self, kind: &str) {
        self.add(kind, 1);
    }

    /// Counts several.
    pub fn add(&mut self, kind: &str, number: usize) {
        if number > 0 {
            *self.counts.entry(kind.to_owned()).or_default() += number;
        }
    }

    /// Counts all that another has counted.
    pub fn add_all(&mut self, other: &Self) {
        other.counts.iter().for_each(|(kind, number)| self.add(kind, *number));
    }

    /// How many of a kind.
    pub fn of(&self, kind: &str) -> usize {
        self.counts.get(kind).copied().unwrap_or(0)
    }

    /// Whether nothing was dropped.
    pub fn is_empty(&self) -> bool {
        self.counts.is_empty()
    }

    /// Such as `3 text, 1 image`.
    pub fn summary(&self) -> String {
        // Kinds are named as one of them is, but for fills.
        let named = |kind: &str, n: usize| format!("{n} {}", if (kind, n) == ("fills", 1) { "fill" } else { kind });
        self.counts.iter().map(|(kind, n)| named(kind, *n)).collect::<Vec<_>>().join(", ")
    }
}
