//! How much work a file may ask for: counted before it is done, added up over the file.
//!
//! A step is about a microsecond and 150 bytes. What each thing takes was measured with `inspect` and `plot --order none` on files
//! of one kind (300,000 short paths, one path of 1,000,000 segments, 961,550 dashes), so that a file at the usual limit stays below
//! 2 GB and 20 seconds on one quiet core, whatever it is made of.

use crate::geometry::Crossings;
use thiserror::Error;

/// The usual limit, in millions of steps. Twice as much is 3 GB; half refuses drawings of 500,000 strokes that people do plot.
const USUAL: f64 = 12.0;
/// The greatest limit that may be asked for, in millions of steps; 150 GB.
pub const MOST_WORK: f64 = 1000.0;
const MILLION: f64 = 1e6;

/// Bytes of text in a step.
const BYTES: f64 = 32.0;
/// An element of an SVG as XML.
pub(super) const TAG: f64 = 1.0;
/// An element of an SVG in the tree of shapes, each time that it is used.
pub(super) const ELEMENT: f64 = 2.0;
/// An attribute of one.
pub(super) const ATTRIBUTE: f64 = 0.25;
/// A segment of a path as it stands in the file.
pub(super) const SEGMENT: f64 = 2.0;
/// A path of its own in the plot: a subpath, a dash, a stroke of a machine's file.
pub(crate) const PATH: f64 = 8.0;
/// A point of a flattened curve or arc that is kept.
pub(crate) const POINT: f64 = 0.5;
/// A crossing of two borders in an overlay: `i_overlay` took 480 bytes and 2 to 5 microseconds for each.
const CROSSING: f64 = 6.0;
/// Two edges that are looked at.
const PAIR: f64 = 0.004;
/// A point of a curve that lowering will flatten.
pub(super) const POINT_TO_COME: f64 = 0.1;

/// A file asks for more work than it may.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("takes at least {} million steps of work to read, counted up to its {what}, and the limit is {} million", shown(*.steps), shown(*.most))]
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
        // Rounded up, so that it is more than the limit where it is.
        millions if millions < 100.0 => format!("{:.1}", (10.0 * millions).ceil() / 10.0).trim_end_matches(".0").to_owned(),
        millions if millions < 1e9 => format!("{millions:.0}"),
        millions if millions.is_finite() => format!("{millions:.0e}"),
        _ => "10^300".to_owned(),
    }
}

impl TooMuchWork {
    /// The limit in millions of steps that may let it through, where one may: the count is of what was met so far, and with a little more
    /// there is a chance.
    pub fn lifted_by(&self) -> Option<f64> {
        Some((1.25 * self.steps / MILLION).ceil()).filter(|millions| *millions <= MOST_WORK)
    }
}

/// What is left of a file's work.
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
    /// So many millions of steps, up to [`MOST_WORK`].
    pub fn of_millions(millions: f64) -> Self {
        Self { most: MILLION * millions.min(MOST_WORK), spent: 0.0 }
    }

    /// The longest text that can be read, in bytes: it alone would take all there is.
    pub fn most_bytes(&self) -> u64 {
        (self.most * BYTES) as u64
    }

    /// Takes steps, before they are done.
    pub(crate) fn spend(&mut self, steps: f64, what: &'static str) -> Result<(), TooMuchWork> {
        self.spent += steps;
        // A count that is no number is refused too.
        if self.spent <= self.most { Ok(()) } else { Err(TooMuchWork { steps: self.spent, most: self.most, what }) }
    }

    /// Takes the work of untangling borders; `count` counts their crossings, up to as many as there are steps left for.
    pub(super) fn overlay(&mut self, edges: usize, count: impl FnOnce(usize) -> Crossings) -> Result<(), TooMuchWork> {
        self.spend(POINT * edges as f64, "outlines")?;
        let found = count(((self.most - self.spent) / CROSSING) as usize + 1);
        self.spend(CROSSING * found.crossings as f64 + PAIR * found.pairs as f64, "crossings of outlines")
    }

    /// Takes the work of meeting so many points of a line, or so many of its pieces, with all edges of a border.
    pub(super) fn cuts(&mut self, points: f64, edges: usize) -> Result<(), TooMuchWork> {
        self.spend(POINT * points + 2.0 * PAIR * points * edges as f64, "clipped lines")
    }

    /// What was taken so far.
    #[cfg(test)]
    pub(super) const fn spent(&self) -> f64 {
        self.spent
    }

    /// The steps of going through a text.
    pub(super) fn steps_of_text(bytes: f64) -> f64 {
        bytes / BYTES
    }

    /// Takes the work of going through a text.
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
            "takes at least 20 million steps of work to read, counted up to its arcs, and the limit is 12 million"
        );
        assert_eq!(refused.lifted_by(), Some(25.0));
        for endless in [1e12, 1e300, f64::INFINITY, f64::NAN] {
            let refused = Budget::default().spend(endless, "arcs").unwrap_err();
            assert!(refused.to_string().contains("limit is 12 million") && refused.lifted_by().is_none(), "{refused}");
        }
    }
}
