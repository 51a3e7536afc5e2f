//! Work limit of reading a file. Work is counted before it is done, and summed over the file.
//!
//! A step is about a microsecond and 150 bytes. The costs were measured with `inspect` and `plot --order none` on files of one
//! kind (300,000 short paths, one path of 1,000,000 segments, 961,550 dashes), so that a file at the default limit stays below 2
//! GB and 20 seconds on one idle core, whatever it is made of.

use crate::geometry::Crossings;
use thiserror::Error;

/// The default limit, in millions of steps. Twice as much is 3 GB; half refuses drawings of 500,000 strokes that people do plot.
const USUAL: f64 = 12.0;
/// The greatest limit that may be set, in millions of steps; 150 GB.
pub const MOST_WORK: f64 = 1000.0;
const MILLION: f64 = 1e6;

/// Bytes of text per step.
const BYTES: f64 = 32.0;
/// Steps per element of an SVG as XML.
pub(super) const TAG: f64 = 1.0;
/// Steps per element of an SVG in the tree of shapes, each time it is used.
pub(super) const ELEMENT: f64 = 2.0;
/// Steps per attribute of an element.
pub(super) const ATTRIBUTE: f64 = 0.25;
/// Steps per path segment in the file.
pub(super) const SEGMENT: f64 = 2.0;
/// Steps per separate path in the plot: a subpath, a dash, a stroke of a machine's file.
pub(crate) const PATH: f64 = 8.0;
/// Steps per point of a flattened curve or arc that is kept.
pub(crate) const POINT: f64 = 0.5;
/// Steps per crossing of two borders in an overlay: `i_overlay` took 480 bytes and 2 to 5 microseconds for each.
const CROSSING: f64 = 6.0;
/// Steps per pair of edges that is compared.
const PAIR: f64 = 0.004;
/// Steps per point of a curve that lowering will flatten.
pub(super) const LOWERED_POINT: f64 = 0.1;

/// Error: a file needs more work than the limit.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("takes at least {} million steps of work to read, counted up to its {what}; the limit is {} million", shown(*.steps), shown(*.most))]
pub struct TooMuchWork {
    /// Steps that were counted; more may follow.
    pub steps: f64,
    /// The limit, in steps.
    pub most: f64,
    /// What was counted last.
    pub what: &'static str,
}

fn shown(steps: f64) -> String {
    match steps / MILLION {
        // Rounded up, so that a count above the limit also reads as above it.
        millions if millions < 100.0 => format!("{:.1}", (10.0 * millions).ceil() / 10.0).trim_end_matches(".0").to_owned(),
        millions if millions < 1e9 => format!("{millions:.0}"),
        millions if millions.is_finite() => format!("{millions:.0e}"),
        _ => "10^300".to_owned(),
    }
}

impl TooMuchWork {
    /// A limit in millions of steps that may suffice: a quarter above the count so far, since more may follow. `None` if above
    /// [`MOST_WORK`].
    pub fn sufficient_limit(&self) -> Option<f64> {
        Some((1.25 * self.steps / MILLION).ceil()).filter(|millions| *millions <= MOST_WORK)
    }
}

/// Work counter of a file, with its limit.
#[derive(Clone, Debug)]
pub struct Budget {
    most: f64,
    spent: f64,
}

impl Default for Budget {
    fn default() -> Self {
        Self::of_millions(USUAL)
    }
}

impl Budget {
    /// A budget of `millions` of steps, at most [`MOST_WORK`].
    pub fn of_millions(millions: f64) -> Self {
        Self { most: MILLION * millions.min(MOST_WORK), spent: 0.0 }
    }

    /// The longest text that can be read, in bytes: it would use the whole budget.
    pub fn most_bytes(&self) -> u64 {
        (self.most * BYTES) as u64
    }

    /// Spends steps before they are done.
    pub(crate) fn spend(&mut self, steps: f64, what: &'static str) -> Result<(), TooMuchWork> {
        self.spent += steps;
        // Also refuses a NaN count.
        if self.spent <= self.most { Ok(()) } else { Err(TooMuchWork { steps: self.spent, most: self.most, what }) }
    }

    /// Spends the steps of untangling borders. `count` counts their crossings, up to a maximum for which steps are left.
    pub(super) fn overlay(&mut self, edges: usize, count: impl FnOnce(usize) -> Crossings) -> Result<(), TooMuchWork> {
        self.spend(POINT * edges as f64, "outlines")?;
        let found = count(((self.most - self.spent) / CROSSING) as usize + 1);
        self.spend(CROSSING * found.crossings as f64 + PAIR * found.pairs as f64, "crossings of outlines")
    }

    /// Spends the steps of testing a line's points, or its pieces, against all edges of a border.
    pub(super) fn cuts(&mut self, points: f64, edges: usize) -> Result<(), TooMuchWork> {
        self.spend(POINT * points + 2.0 * PAIR * points * edges as f64, "clipped lines")
    }

    /// Steps spent so far.
    #[cfg(test)]
    pub(super) const fn spent(&self) -> f64 {
        self.spent
    }

    /// The steps of scanning a text of `bytes` bytes.
    pub(super) fn steps_of_text(bytes: f64) -> f64 {
        bytes / BYTES
    }

    /// Spends the steps of scanning a text of `bytes` bytes.
    pub(crate) fn text(&mut self, bytes: f64) -> Result<(), TooMuchWork> {
        self.spend(Self::steps_of_text(bytes), "text")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_much_is_told_with_numbers_and_what_lifts_it() {
        let mut budget = Budget::default();
        assert!(budget.spend(11e6, "arcs").is_ok());
        let refused = budget.spend(9e6, "arcs").unwrap_err();
        assert_eq!(
            refused.to_string(),
            "takes at least 20 million steps of work to read, counted up to its arcs; the limit is 12 million"
        );
        assert_eq!(refused.sufficient_limit(), Some(25.0));
        for endless in [1e12, 1e300, f64::INFINITY, f64::NAN] {
            let refused = Budget::default().spend(endless, "arcs").unwrap_err();
            assert!(refused.to_string().contains("limit is 12 million") && refused.sufficient_limit().is_none(), "{refused}");
        }
    }
}
