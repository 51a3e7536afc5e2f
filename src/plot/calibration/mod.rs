//! A test sheet for one machine and its pens. Its readings go into the profile (see `docs/calibration.md`).
//!
//! ```text
//!   +--------------------------+  a square of 100 mm           scale_x, scale_y
//!   | NIB    = = = = = = = =   |  lines at growing spacing     --pen
//!   | Z      - - - - - - -     |  lines at falling height      gcode.height.down
//!   | DWELL  .. .. .. .. ..    |  touches that rest longer     motion.touch_seconds
//!   | FILL   # # # # # # #     |  patches of growing overlap   --pen
//!   | PENS   + + + +           |  a cross for each pen         pen.N.offset
//!   | SPEED  [] [] []          |  squares at growing speed     motion.draw_speed, motion.acceleration
//!   +--------------------------+
//! ```

mod cell;
use crate::geometry::stroke_letters as font;
mod trials;

use super::profile::Profile;
use super::{PenPaths, Plot, mount};
use crate::drawing::{Colour, Handling, Page};
use crate::geometry::{Point, Rect, Vec2};
use cell::{Cell, Drawn, GAP, square};
use thiserror::Error;
use trials::{Bench, laid_out};

/// Side of the square if the machine has room, in millimetres: a ruler shows its error to a thousandth.
const SIDE: f64 = 100.0;
/// Minimum side of the square.
const LEAST_SIDE: f64 = 70.0;
/// Free room beside the square that a sheet needs to become the default, in millimetres.
const ROOM: f64 = 10.0;
/// Margin around the square.
const FREE: f64 = 1.0;
/// Distance between the square and its contents, for labels.
const BORDER: f64 = 4.0;
/// Minimum height of letters; broad nibs need larger ones.
const LEAST_TEXT: f64 = 1.6;
/// Sheets tried for a machine without its own, landscape: ISO 216 A4, A5, A6.
const SHEETS: [(f64, f64); 3] = [(297.0, 210.0), (210.0, 148.0), (148.0, 105.0)];

/// A test sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// Its tool paths, in drawing order.
    pub plot: Plot,
    /// The square to measure, on the page.
    pub square: Rect,
    /// Reasons for the trials left out on this machine.
    pub left_out: Vec<&'static str>,
}

/// Why there is no test sheet.
#[derive(Debug, Error, PartialEq)]
pub enum CalibrationError {
    /// The machine or sheet is too small.
    #[error("the test sheet needs {needed:.0} x {needed:.0} mm, but this sheet has {width:.1} x {height:.1} mm to draw on")]
    NoRoom {
        /// Side of the area that it needs.
        needed: f64,
        /// Width of the drawable area.
        width: f64,
        /// Height of the drawable area.
        height: f64,
    },
    /// The trials do not fit into the square.
    #[error("with a nib of {nib} mm the trials need {needed:.0} mm, but the square has room for {side:.0} mm")]
    TooMuch {
        /// The nib.
        nib: f64,
        /// Width or height that the trials need.
        needed: f64,
        /// Width and height inside the square.
        side: f64,
    },
}

/// The default sheet for calibration: the machine's first, else the largest from A4 to A6 on which the whole square fits.
pub fn calibration_page(profile: &Profile) -> Page {
    if let Some(paper) = profile.paper.first() {
        return Page::new(paper.width, paper.height);
    }
    let pages = SHEETS.map(|(width, height)| Page::new(width, height));
    let has_room = |page: &&Page| {
        mount(profile, page).is_ok_and(|mounting| {
            let free = mounting.drawable(page);
            free.width().min(free.height()) >= SIDE + ROOM
        })
    };
    *pages.iter().find(has_room).unwrap_or(&pages[2])
}

/// Draws the test sheet into the drawable area of a page, for a nib in millimetres and the machine's first `pens` pens.
pub fn calibration_sheet(
    profile: &Profile,
    page: Page,
    drawable: Rect,
    nib: f64,
    pens: u32,
) -> Result<Calibration, CalibrationError> {
    let room = drawable.width().min(drawable.height()) - 2.0 * FREE - nib;
    let side = (room / 10.0).floor().min(SIDE / 10.0) * 10.0;
    if side.is_nan() || side < LEAST_SIDE {
        let (width, height) = (drawable.width().max(0.0), drawable.height().max(0.0));
        return Err(CalibrationError::NoRoom { needed: LEAST_SIDE + 2.0 * FREE + nib, width, height });
    }
    let corner = drawable.center() - Vec2::new(0.5 * side, 0.5 * side);
    let bench = Bench { profile, nib, text: LEAST_TEXT.max(3.5 * nib), pens };
    let mut drawn = vec![Drawn::by_first_pen(square(Point::ORIGIN, side))];
    drawn.extend(side_labels(&bench, &page, side));
    drawn.extend(trials_within(&bench, side)?);
    let drawn = drawn.into_iter().map(|drawn| drawn.moved(corner.to_vec2())).collect();
    let plot = Plot { page, pens: by_pen(drawn, nib) };
    Ok(Calibration { plot, square: Rect::from_origin_size(corner, (side, side)), left_out: left_out(&bench) })
}

/// Labels for the side's length and for the machine's axes along the upper and left sides.
fn side_labels(bench: &Bench<'_>, page: &Page, side: f64) -> Vec<Drawn> {
    let is_upright = mount(bench.profile, page).is_ok_and(|m| m.to_machine.as_coeffs()[0].abs() > 1e-6);
    let (across, down) = if is_upright { ("X", "Y") } else { ("Y", "X") };
    let height = bench.text.min(BORDER - 1.5);
    let text = |text: &str| Cell::text(text, height);
    let length = text(&format!("{across} {side:.0} MM"));
    let middle = 0.5 * (side - length.width);
    let inset = 0.5 * (BORDER - height);
    let mut drawn = length.placed(Vec2::new(middle, inset));
    drawn.extend(text(down).placed(Vec2::new(inset, 0.5 * side)));
    drawn
}

/// All trials, one below another.
fn trials_within(bench: &Bench<'_>, side: f64) -> Result<Vec<Drawn>, CalibrationError> {
    let inner = side - 2.0 * BORDER;
    let titles = ["NIB", "Z", "DWELL", "FILL", "PENS", "SPEED"];
    let rows = [bench.ladder(), bench.heights(), bench.dwells(), bench.patches(), bench.crosses(), bench.speeds()];
    let indent = font::width("SPEED", bench.text) + GAP;
    let mut drawn = Vec::new();
    let mut y = 0.0;
    for (title, cells) in titles.into_iter().zip(rows).filter(|(_, cells)| !cells.is_empty()) {
        let (row, height) = laid_out(Cell::text(title, bench.text), cells, inner, indent, GAP);
        drawn.extend(row.into_iter().map(|one| one.moved(Vec2::new(BORDER, BORDER + y))));
        y += height + GAP;
    }
    let right = drawn.iter().flat_map(|one| one.path.points()).fold(0.0, |most: f64, p| most.max(p.x)) - BORDER;
    let needed = (y - GAP).max(right);
    if needed > inner + 1e-9 {
        return Err(CalibrationError::TooMuch { nib: bench.nib, needed, side: inner });
    }
    Ok(drawn)
}

/// Groups paths by pen and speed: the first pen, its other speeds, then the other pens.
fn by_pen(drawn: Vec<Drawn>, nib: f64) -> Vec<PenPaths> {
    let mut pens: Vec<((u32, Option<u32>), PenPaths)> = Vec::new();
    for Drawn { pen, speed_percent, path } in drawn {
        let key = (pen, speed_percent);
        let at = pens.iter().position(|(known, _)| *known == key).unwrap_or_else(|| {
            let handling = Handling { speed_percent: speed_percent.map(f64::from), ..Handling::default() };
            let name = speed_percent.map_or_else(|| "calibration".to_owned(), |percent| format!("speed {percent} percent"));
            pens.push((key, PenPaths { number: pen, name, colour: Colour::BLACK, nib, handling, paths: Vec::new() }));
            pens.len() - 1
        });
        pens[at].1.paths.push(path);
    }
    pens.sort_by_key(|(key, _)| *key);
    pens.into_iter().map(|(_, pen)| pen).collect()
}

fn left_out(bench: &Bench<'_>) -> Vec<&'static str> {
    let mut why = Vec::new();
    if bench.z_height().is_none() {
        why.push("no Z row: this pen is not lifted by a z axis; try gcode.pen_down, or the height in the plotter's own program, until NIB is drawn without gaps");
    }
    if bench.dwells().is_empty() {
        why.push("no DWELL row: this machine has no command to wait at each touch");
    }
    if bench.pens == 1 {
        why.push("only one cross: a sheet for several pens has one per pen");
    }
    why
}
