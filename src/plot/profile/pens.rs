//! Pens, how they are changed, and the pen height for each line width.

use super::check::{above_zero, are_near};
use crate::plot::language::Refusal;
use serde::Deserialize;

/// Pens and how they are changed.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Pens {
    /// Number of pens that the machine holds.
    pub count: u32,
    /// How the pen is changed.
    pub change: PenChange,
    /// Time that the machine takes to fetch a pen, in seconds.
    #[serde(default)]
    pub change_seconds: f64,
    /// Metres that a pen draws before it wears out or runs dry.
    pub pen_life: Option<f64>,
}

/// How a pen is changed.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum PenChange {
    /// The machine takes it from its carousel.
    Machine,
    /// The file pauses, and the user changes it.
    Pause,
}

/// Calibration of the pen in one slot.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct PenSlot {
    /// The slot, from 1.
    pub slot: u32,
    /// Offset of its ink from the nominal place, in millimetres along the machine's x and y. The pen is moved by the opposite
    /// amount.
    #[serde(default)]
    pub offset: [f64; 2],
    /// Metres that it draws before it wears out or runs dry, if it differs from the other pens.
    pub pen_life: Option<f64>,
}

impl Pens {
    pub(super) fn check(self) -> Result<(), Refusal> {
        if self.count == 0 {
            return Err(Refusal::new("pens.count", "must be at least 1"));
        }
        if !(0.0..=60.0).contains(&self.change_seconds) {
            return Err(Refusal::new("pens.change_seconds", "must be from 0 to 60 seconds"));
        }
        self.pen_life.into_iter().try_for_each(|metres| above_zero("pens.pen_life", metres))
    }
}

impl PenSlot {
    pub(super) fn check(&self) -> Result<(), Refusal> {
        if self.slot == 0 || self.offset.iter().any(|mm| !mm.is_finite() || mm.abs() > 100.0) {
            let key = format!("pen.{}.offset", self.slot);
            return Err(Refusal::new(&key, "must be at most 100 mm, and slots count from 1"));
        }
        self.pen_life.into_iter().try_for_each(|metres| above_zero(&format!("pen.{}.pen_life", self.slot), metres))
    }
}

/// The pen's height for each line width, for brushes and other pens whose line swells with their height.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Swell {
    /// Pairs of line width and z in millimetres, in order of increasing width.
    pub table: Vec<[f64; 2]>,
}

impl Swell {
    pub(super) fn check(&self) -> Result<(), Refusal> {
        let grows = self.table.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        if self.table.len() < 2 || !grows || !are_near(self.table.as_flattened()) {
            return Err(Refusal::new("swell.table", "must contain two or more [width, height] pairs of increasing width"));
        }
        Ok(())
    }

    /// The height for a width, linear between the table's rows and constant beyond them.
    pub fn height(&self, width: f64) -> f64 {
        let next = self.table.partition_point(|row| row[0] <= width).clamp(1, self.table.len() - 1);
        let ([w0, z0], [w1, z1]) = (self.table[next - 1], self.table[next]);
        z0 + (z1 - z0) * ((width - w0) / (w1 - w0)).clamp(0.0, 1.0)
    }

    /// The width at a height, the inverse of [`Swell::height`]; beyond the table, the nearest row's width.
    pub fn width(&self, height: f64) -> f64 {
        let covers = |pair: &&[[f64; 2]]| (pair[0][1].min(pair[1][1])..=pair[0][1].max(pair[1][1])).contains(&height);
        match self.table.windows(2).find(covers) {
            Some(pair) if pair[1][1] != pair[0][1] => {
                pair[0][0] + (pair[1][0] - pair[0][0]) * (height - pair[0][1]) / (pair[1][1] - pair[0][1])
            }
            Some(pair) => pair[0][0],
            None => {
                let nearest = self.table.iter().min_by(|a, b| (a[1] - height).abs().total_cmp(&(b[1] - height).abs()));
                nearest.map_or(0.0, |pair| pair[0])
            }
        }
    }

    /// The widest line.
    pub fn widest(&self) -> f64 {
        self.table.last().map_or(0.0, |pair| pair[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_lie_between_the_table_s_and_widths_follow_from_them() {
        let swell = Swell { table: vec![[0.2, 1.0], [0.4, 0.0], [1.0, -3.0]] };
        for (width, height) in [(0.0, 1.0), (0.2, 1.0), (0.3, 0.5), (0.7, -1.5), (2.0, -3.0)] {
            assert!((swell.height(width) - height).abs() < 1e-9, "{width}");
            assert!((swell.width(height) - width.clamp(0.2, 1.0)).abs() < 1e-9, "{width}");
        }
    }
}
