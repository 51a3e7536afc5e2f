//! Plotting: from a [`Drawing`](crate::drawing::Drawing) to ordered tool paths for one machine.
//!
//! In: marks with their ink. Out: a [`Plot`], the polylines that one nib per pen draws, in the page's millimetres; a
//! [`Mounting`] says where the page lies on a machine. Nothing here knows of styles or fields.

mod lower;
mod mounting;
mod order;
mod profile;
mod report;
mod time;

pub use lower::{InkModel, Nibs, lower};
pub use mounting::{Mounting, MountingError, Turn, clip_to, mount};
pub use order::{Direction, Effort, PathEnds, Visit, chain, drop_duplicates, order, pen_up_length};
pub use profile::{
    Area, GcodeDialect, HpglDialect, Language, Limits, Motion, Paper, PenChange, Pens, Planner, Profile, ProfileError, built_in,
    built_in_names,
};
pub use report::{PenReport, PlotReport, report};
pub use time::{Clock, clock};

use crate::drawing::{Colour, Handling, Page};
use crate::geometry::{Point, polyline_length};

/// Tool paths, in the order in which they are drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// The sheet.
    pub page: Page,
    /// Pens in the order in which they are used.
    pub pens: Vec<PenPaths>,
}

/// What one pen draws.
#[derive(Clone, Debug, PartialEq)]
pub struct PenPaths {
    /// The pen's number, from 1.
    pub number: u32,
    /// What it draws, such as `dots`.
    pub name: String,
    /// The ink's colour, for previews.
    pub colour: Colour,
    /// The nib's width in millimetres.
    pub nib: f64,
    /// Pause, speed and delay that its layer asks for.
    pub handling: Handling,
    /// Paths in drawing order.
    pub paths: Vec<Toolpath>,
}

/// One pen-down path: at least one point; a single one is a touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Toolpath {
    /// Vertices in millimetres on the page; a closed path repeats its first.
    pub points: Vec<Point>,
}

impl Toolpath {
    /// Its two ends.
    ///
    /// # Panics
    /// If it has no point, which no function here makes.
    pub fn ends(&self) -> PathEnds {
        PathEnds { start: self.points[0], end: self.points[self.points.len() - 1] }
    }

    /// Length drawn.
    pub fn length(&self) -> f64 {
        polyline_length(&self.points)
    }
}

impl Plot {
    /// Joins, orders and turns each pen's paths for the least pen-up travel from `home`.
    pub fn ordered(&mut self, home: Point, effort: Effort, direction: Direction, merge: f64) {
        let mut at = home;
        for pen in &mut self.pens {
            let lines: Vec<Vec<Point>> = std::mem::take(&mut pen.paths).into_iter().map(|path| path.points).collect();
            let joined = chain(lines, merge, direction);
            let mut paths: Vec<Option<Toolpath>> = joined.into_iter().map(|points| Some(Toolpath { points })).collect();
            let ends: Vec<PathEnds> = paths.iter().flatten().map(Toolpath::ends).collect();
            for visit in order(&ends, at, effort, direction) {
                let Some(mut path) = paths[visit.path].take() else { continue };
                if visit.reversed {
                    path.points.reverse();
                }
                at = path.ends().end;
                pen.paths.push(path);
            }
        }
    }
}
