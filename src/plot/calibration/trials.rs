//! The trials on a test sheet: each gives a row of labelled cells.

use super::cell::{Cell, Drawn, square};
use crate::geometry::{Point, Vec2};
use crate::plot::Toolpath;
use crate::plot::language::Height;
use crate::plot::profile::Profile;

/// Spacings of the ladder in tenths of the nib's nominal width: a nib half or one and a half times as wide still shows.
pub(super) const LADDER_TENTHS: std::ops::RangeInclusive<u32> = 5..=16;
/// Lines per rung of the ladder: enough to see white between them, few enough for a broad pen.
const LADDER_LINES: usize = 6;
/// Overlaps of the filled patches in percent of the nib.
pub(super) const OVERLAPS: [u32; 7] = [0, 5, 10, 15, 20, 25, 30];
/// Rests of the touches in seconds: below a twentieth no servo settles, above half a second ink pens bleed.
pub(super) const DWELLS: [f64; 7] = [0.0, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5];
/// Heights above the profile's lowered pen, in tenths of a millimetre. None is below it, which could bend a nib.
pub(super) const HEIGHTS_TENTHS: [u32; 7] = [12, 10, 8, 6, 4, 2, 0];
/// Speeds in percent of the profile's.
pub(super) const SPEEDS: [u32; 4] = [50, 100, 150, 200];
/// Minimum width of a cell, which keeps neighbouring labels apart, and side of a filled patch, in millimetres.
const PATCH: f64 = 5.0;

/// Settings shared by all trials.
pub(super) struct Bench<'a> {
    pub profile: &'a Profile,
    pub nib: f64,
    pub text: f64,
    pub pens: u32,
}

/// A number as its label shows it, without redundant zeros.
fn short(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    text.strip_prefix('0').filter(|rest| !rest.is_empty()).unwrap_or(text).to_owned()
}

impl Bench<'_> {
    /// Parallel lines with spacing from half the nib upwards: the first rung with white between its lines is wider than the nib.
    pub(super) fn ladder(&self) -> Vec<Cell> {
        let rung = |tenths: u32| {
            let spacing = self.nib * f64::from(tenths) / 10.0;
            let tallest = 1.6 * self.nib * (LADDER_LINES - 1) as f64;
            let (mut cell, below) = Cell::labelled(&short(spacing, 3), self.text, PATCH, tallest);
            for i in 0..LADDER_LINES {
                let y = i as f64 * spacing;
                cell.add_path(Toolpath::through(Point::new(0.0, y) + below, [Point::new(PATCH, y) + below]));
            }
            cell
        };
        LADDER_TENTHS.map(rung).collect()
    }

    /// Lines at increasing depth, for machines that lift the pen by height.
    pub(super) fn heights(&self) -> Vec<Cell> {
        let Some(height) = self.z_height() else { return Vec::new() };
        let most = 0.4 * (height.up - height.down).abs();
        let line = |tenths: u32| {
            let above = f64::from(tenths) / 10.0;
            let (mut cell, below) = Cell::labelled(&short(above, 1), self.text, PATCH, 1.0);
            let line = Toolpath::through(Point::new(0.0, 0.5) + below, [Point::new(PATCH, 0.5) + below]);
            let z = height.down + above.copysign(height.up - height.down);
            cell.add_path(line.with_heights(vec![z; 2])?);
            Some(cell)
        };
        HEIGHTS_TENTHS.into_iter().filter(|tenths| f64::from(*tenths) / 10.0 <= most).filter_map(line).collect()
    }

    /// The pen's heights, if a z axis lifts it.
    pub(super) fn z_height(&self) -> Option<Height> {
        self.profile.height()
    }

    /// Rows of touches with increasing rests, if the machine can wait.
    pub(super) fn dwells(&self) -> Vec<Cell> {
        if !self.profile.speech().can_dwell() {
            return Vec::new();
        }
        let row = |seconds: f64| {
            let (mut cell, below) = Cell::labelled(&short(seconds, 2), self.text, PATCH, 1.0);
            for i in 0..4 {
                let mut touch = Toolpath::touch(Point::new(0.5 + f64::from(i) * (PATCH - 1.0) / 3.0, 0.5) + below);
                touch.dwell_seconds = seconds;
                cell.add_path(touch);
            }
            cell
        };
        DWELLS.into_iter().map(row).collect()
    }

    /// Patches filled back and forth, with increasing overlap of the lines.
    pub(super) fn patches(&self) -> Vec<Cell> {
        let side = PATCH.max(8.0 * self.nib);
        let patch = |percent: u32| {
            let (mut cell, below) = Cell::labelled(&format!("{percent}%"), self.text, side, side);
            let pitch = self.nib * (1.0 - f64::from(percent) / 100.0);
            let rows = ((side / pitch) + 1e-9).floor() as u32;
            let ends = |row: u32| {
                let y = f64::from(row) * pitch;
                let (from, to) = if row.is_multiple_of(2) { (0.0, side) } else { (side, 0.0) };
                [Point::new(from, y) + below, Point::new(to, y) + below]
            };
            cell.add((0..=rows).flat_map(ends).collect());
            cell
        };
        OVERLAPS.into_iter().map(patch).collect()
    }

    /// For each pen, a frame with ticks in the middle of its sides, drawn by the first pen, and a cross that should meet them.
    pub(super) fn crosses(&self) -> Vec<Cell> {
        let side = 6.0;
        let cross = |pen: u32| {
            let (mut cell, below) = Cell::labelled(&pen.to_string(), self.text, side + 2.0, side + 2.0);
            let at = |x: f64, y: f64| Point::new(x + 1.0, y + 1.0) + below;
            let half = 0.5 * side;
            cell.add_path(square(at(0.0, 0.0), side));
            for [x0, y0, x1, y1] in
                [[half, -1.0, half, 0.0], [side, half, side + 1.0, half], [half, side, half, side + 1.0], [-1.0, half, 0.0, half]]
            {
                cell.add(vec![at(x0, y0), at(x1, y1)]);
            }
            let first = cell.drawn.len();
            cell.add(vec![at(half, 0.3), at(half, side - 0.3)]);
            cell.add(vec![at(0.3, half), at(side - 0.3, half)]);
            cell.drawn[first..].iter_mut().for_each(|drawn| drawn.pen = pen);
            cell
        };
        (1..=self.pens).map(cross).collect()
    }

    /// Nested squares at increasing speed, whose corners show lost steps or shaking.
    pub(super) fn speeds(&self) -> Vec<Cell> {
        let motion = &self.profile.motion;
        let fastest = motion.draw_speed_limit.unwrap_or(f64::INFINITY).min(motion.travel_speed.max(motion.draw_speed));
        let squares = |percent: u32| {
            let (mut cell, below) = Cell::labelled(&format!("{percent}%"), self.text, 10.0, 10.0);
            let first = cell.drawn.len();
            for inset in [0.0, 1.5, 3.0, 4.0] {
                cell.add_path(square(Point::new(inset, inset) + below, 10.0 - 2.0 * inset));
            }
            cell.drawn[first..].iter_mut().for_each(|drawn| drawn.speed_percent = Some(percent));
            cell
        };
        let reached = |percent: &u32| motion.draw_speed * f64::from(*percent) / 100.0 <= fastest;
        SPEEDS.into_iter().filter(reached).map(squares).collect()
    }
}

/// Lays out cells after a title in rows within a width, from the upper left corner; also returns the height.
pub(super) fn laid_out(title: Cell, cells: Vec<Cell>, width: f64, indent: f64, gap: f64) -> (Vec<Drawn>, f64) {
    let (mut x, mut y, mut row) = (indent, 0.0, title.height);
    let mut drawn = title.placed(Vec2::ZERO);
    for cell in cells {
        if x + cell.width > width {
            (x, y, row) = (indent, y + row + gap, 0.0);
        }
        row = row.max(cell.height);
        let step = cell.width + gap;
        drawn.extend(cell.placed(Vec2::new(x, y)));
        x += step;
    }
    (drawn, y + row)
}
