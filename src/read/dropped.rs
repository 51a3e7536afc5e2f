//! Counts of what a file holds that was not drawn.

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

    /// Adds all counts of another.
    pub fn add_all(&mut self, other: &Self) {
        other.counts.iter().for_each(|(kind, number)| self.add(kind, *number));
    }

    /// The count of one kind.
    pub fn of(&self, kind: &str) -> usize {
        self.counts.get(kind).copied().unwrap_or(0)
    }

    /// True if nothing was dropped.
    pub fn is_empty(&self) -> bool {
        self.counts.is_empty()
    }

    /// All counts as text, such as `3 text, 1 image`.
    pub fn summary(&self) -> String {
        // Kinds are named in the singular, except fills.
        let named = |kind: &str, n: usize| format!("{n} {}", if (kind, n) == ("fills", 1) { "fill" } else { kind });
        self.counts.iter().map(|(kind, n)| named(kind, *n)).collect::<Vec<_>>().join(", ")
    }
}
