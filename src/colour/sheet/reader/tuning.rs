//! The view made exact by all marks of the sheet, and the sheet's code.

use super::picture::Probe;
use super::spotting::{Grey, LEAST_CONTRAST, Stamp};
use super::view::View;
use crate::colour::sheet::code::{self, Code};
use crate::colour::sheet::grid::{BITS, COLUMNS, CORNERS, NODE, RING, ROWS, bar, nodes};
use crate::geometry::{Point, Rect, Vec2};

/// How far a dot may lie from where it is sought, in cells, in each round.
const REACH: [f64; 4] = [0.16, 0.1, 0.05, 0.05];
/// Least share of the dots that must be found.
const LEAST_SHARE: f64 = 0.6;
/// Number of dots after which a wrong start may show.
const EARLY: usize = 9;
/// Samples along each side of a bar of the code.
const BAR_SAMPLES: usize = 5;

/// What the marks tell.
#[derive(Clone, Debug)]
pub(super) struct Tuned {
    pub view: View,
    /// Typical error of the marks' places in pixels.
    pub error: f64,
    /// Share of the dots that were found.
    pub share: f64,
    found: Vec<(Point, Point)>,
}

/// The code row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// Least contrast of its bars, 0 to 1.
    pub contrast: f64,
    /// What it says, if it can be read.
    pub code: Option<Code>,
    /// Whether it can only be read from right to left.
    pub is_mirrored: bool,
}

/// Whether the dots beside the corner marks are there: quick, and enough to tell a sheet from rings on a table.
pub(super) fn has_neighbours(view: &View, probe: &Probe<'_>, grey: Grey) -> bool {
    let value = |p: Point| grey.of(probe.at(view.at(p)));
    let mean = |p: Point, radius: f64| {
        let around = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)].map(|d| value(p + radius * Vec2::from(d)));
        0.25 * around.iter().sum::<f64>()
    };
    CORNERS.iter().all(|corner| {
        let middle = Point::new(0.5 * COLUMNS as f64, 0.5 * ROWS as f64);
        let dot = *corner + 0.5 * Vec2::new((middle.x - corner.x).signum(), (middle.y - corner.y).signum());
        mean(dot, 0.4 * NODE) < (1.0 - LEAST_CONTRAST) * mean(dot, 2.0 * NODE)
    })
}

/// The view fitted to all dots and corner marks; `None` if too few dots are where they should be.
pub(super) fn tuned(start: View, probe: &Probe<'_>, grey: Grey) -> Option<Tuned> {
    let (dot, corner) = (Stamp::new(0.0, NODE), Stamp::new(RING[1], RING[0]));
    let count = nodes().count();
    let (mut view, mut error, mut found) = (start, 0.0, Vec::new());
    for reach in REACH {
        found.clear();
        for (i, p) in nodes().enumerate() {
            found.extend(dot.seek(&view, probe, grey, p, reach).map(|q| (p, view.at(q))));
            // Most wrong starts show after a few dots.
            if i >= EARLY && (found.len() as f64) < LEAST_SHARE * (i + 1) as f64 * 0.7 {
                return None;
            }
        }
        if (found.len() as f64) < LEAST_SHARE * count as f64 {
            return None;
        }
        found.extend(CORNERS.iter().filter_map(|p| corner.seek(&view, probe, grey, *p, 0.0).map(|q| (*p, view.at(q)))));
        (view, error) = view.fitted(&found);
    }
    let share = found.iter().filter(|(p, _)| p.x.fract() == 0.0).count() as f64 / count as f64;
    view.is_sound(&CORNERS).then_some(Tuned { view, error, share, found })
}

impl Tuned {
    /// The same view with the sheet turned by half.
    pub(super) fn turned(&self, width: usize, height: usize) -> Option<Self> {
        let whole = Vec2::new(COLUMNS as f64, ROWS as f64);
        let found: Vec<(Point, Point)> = self.found.iter().map(|(p, q)| ((whole - p.to_vec2()).to_point(), *q)).collect();
        let seen = CORNERS.map(|p| self.view.at((whole - p.to_vec2()).to_point()));
        let (view, error) = View::through(&CORNERS, &seen, width, height)?.fitted(&found);
        Some(Self { view, error, found, share: self.share })
    }

    /// Reads the code row.
    pub(super) fn code(&self, probe: &Probe<'_>, grey: Grey) -> Row {
        let mut contrast = 1.0_f64;
        let bits: [bool; BITS] = std::array::from_fn(|i| {
            let [left, right] = [true, false].map(|is_set| self.mean(probe, grey, bar(i, is_set)));
            contrast = contrast.min((left - right).abs() / left.max(right).max(1e-6));
            left < right
        });
        let reversed: [bool; BITS] = std::array::from_fn(|i| !bits[BITS - 1 - i]);
        let is_clear = contrast > LEAST_CONTRAST;
        let code = code::read(&bits).filter(|_| is_clear);
        Row { contrast, code, is_mirrored: is_clear && code.is_none() && code::read(&reversed).is_some() }
    }

    /// Mean grey of the inner part of a rectangle.
    fn mean(&self, probe: &Probe<'_>, grey: Grey, area: Rect) -> f64 {
        let at = |i: usize| 0.3 + 0.4 * i as f64 / (BAR_SAMPLES - 1) as f64;
        let places = (0..BAR_SAMPLES * BAR_SAMPLES).map(|k| {
            let (u, v) = (at(k % BAR_SAMPLES), at(k / BAR_SAMPLES));
            Point::new(area.x0 + u * area.width(), area.y0 + v * area.height())
        });
        places.map(|p| grey.of(probe.at(self.view.at(p)))).sum::<f64>() / (BAR_SAMPLES * BAR_SAMPLES) as f64
    }
}
