//! Eyes as a draughtsman sets them: one firm line along the upper lid, a fine one along the lower.
//!
//! ```text
//!   columns   from the outer corner to the inner, across either lid
//!   lines     the way through the columns that is darkest against the skin beyond the lid
//!   kept      where there is contrast, and where neither hair nor a hat covers the eye
//!   found     lines that were found on the lids go: crumbs of lashes, bags and reflections on lenses
//! ```

use super::columns::{COLUMNS, SMOOTH, averaged, even, smoothed};
use super::feature_line::feature_stroke;
use crate::drawing::Mark;
use crate::field::{CoherentLine, Curve};
use crate::geometry::{Point, Rect, Region, Vec2};
use crate::raster::{Raster, best_way, gaussian_blur};
use crate::source::{Landmarks, MaskRole, Placement, Portrait, outlines};

/// Rows across a lid.
const ROWS: usize = 31;
/// An eye of fewer pitches is left to the dots.
const LEAST_WIDTH: f64 = 5.0;
/// The blur before anything is compared, and the distance at which the skin beyond a lid is compared with it, in widths of the eye.
const BLUR: f64 = 0.012;
const BESIDE: f64 = 0.07;
/// How much the inside of the eye counts against the skin: an iris is as dark as the lashes.
const INSIDE: f32 = 0.4;
/// The price of a bend by one row, and of a line off the lid by all rows.
const BEND: f32 = 0.006;
const AWAY: f32 = 0.06;
/// The openness from which lines have their whole width, and the least share of it: wide lines would close a narrow eye (04, 05, 14).
const OPEN: f64 = 0.3;
const NARROW: f64 = 0.5;
/// Behind lenses, whose reflections veil the eye: how much contrast counts more, and the least share of the width (11, 14).
const BEHIND_LENSES: [f64; 2] = [2.0, 0.8];
/// Share of a line at each end over which it tapers.
const TAPER: f64 = 0.22;
/// How far beyond the lids and within the eye lines that were found give way, in widths of the eye.
const BEYOND: f64 = 0.1;
const WITHIN: f64 = 0.07;
/// And beyond the outer corner, in the same: a crow's foot that begins there is a wire (13).
const CORNER: f64 = 0.12;
/// Hair or a hat over a lid from which nothing is drawn.
const COVERED: f32 = 0.5;

/// How one of the lids is drawn; in widths of the eye.
struct Lid {
    /// How far the line may lie beyond the lid that was found, and inside the eye.
    beyond: f64,
    inside: f64,
    /// Its width at the contrast from which it is full, its least share of that, and the contrast below which there is none.
    widest: f64,
    full: f64,
    least: f64,
    faintest: f64,
}

/// Lashes lie above the upper lid that was found by up to 0.07 of the eye's width (05, 13).
const UPPER: Lid = Lid { beyond: 0.08, inside: 0.03, widest: 0.055, full: 0.22, least: 0.5, faintest: 0.02 };
const LOWER: Lid = Lid { beyond: 0.05, inside: 0.03, widest: 0.022, full: 0.2, least: 0.4, faintest: 0.035 };

/// The lids of a portrait.
pub(super) struct Lids {
    regions: Vec<Region>,
    /// Width of the eye of each region.
    widths: Vec<f64>,
    lines: Vec<CoherentLine>,
}

impl Lids {
    /// No lids.
    pub(super) const fn none() -> Self {
        Self { regions: Vec::new(), widths: Vec::new(), lines: Vec::new() }
    }

    /// Of the faces that were found, in working pixels; `pitch` in these.
    pub(super) fn of(portrait: &Portrait, pitch: f64) -> Self {
        let eyes = portrait.faces.iter().flat_map(|face| {
            [&outlines::RIGHT_EYE, &outlines::LEFT_EYE].into_iter().filter_map(|outline| Eye::of(face, outline))
        });
        let mut lids = Self::none();
        for eye in eyes.filter(|eye| eye.width >= LEAST_WIDTH * pitch) {
            for (region, lines) in eye.lids().into_iter().zip(eye.lines(portrait)).filter(|(_, lines)| !lines.is_empty()) {
                lids.regions.push(region);
                lids.widths.push(eye.width);
                lids.lines.extend(lines);
            }
        }
        lids
    }

    /// Where they run.
    pub(super) fn curves(&self) -> Vec<Curve> {
        self.lines.iter().map(|line| line.curve.clone()).collect()
    }

    /// Their strokes on the page, whose widths count by `share`.
    pub(super) fn strokes(&self, placement: &Placement, share: f64) -> Vec<Mark> {
        let stroke = |line: &CoherentLine| feature_stroke(&line.widened(share), placement, TAPER * line.curve.length());
        self.lines.iter().filter_map(stroke).collect()
    }

    /// Lines that were found, with the lids' own in place of those on the lids.
    pub(super) fn redrawn(&self, found: &[CoherentLine], least: f64) -> Vec<CoherentLine> {
        self.cut_from(found, |_| least).into_iter().chain(self.lines.iter().cloned()).collect()
    }

    /// Lines that were found, without what lies on the lids; what is left of one is at least as long as asked for an eye of that width.
    pub(super) fn cut_from(&self, found: &[CoherentLine], least: impl Fn(f64) -> f64) -> Vec<CoherentLine> {
        let cut = |line: &CoherentLine| {
            let holds = |region: &Region| line.curve.points.iter().any(|p| region.contains(*p));
            let on: Vec<usize> = (0..self.regions.len()).filter(|i| holds(&self.regions[*i])).collect();
            let width = on.iter().map(|i| self.widths[*i]).fold(0.0, f64::max);
            line.parts_where(|p| !on.iter().any(|i| self.regions[*i].contains(*p)), least(width))
        };
        found.iter().flat_map(cut).collect()
    }
}

/// One eye: its lids from the outer corner to the inner, each of [`COLUMNS`] points.
struct Eye {
    width: f64,
    upper: Vec<Point>,
    lower: Vec<Point>,
    /// From the lower lid to the upper, of length 1.
    up: Vec2,
    /// How much a line's contrast counts, and the least share of its width.
    counts: f64,
    narrow: f64,
}

impl Eye {
    /// By the outline of its lids; none if it has no width.
    fn of(face: &Landmarks, outline: &[usize; 16]) -> Option<Self> {
        let lower = face.line(&outline[..=8]);
        let upper: Vec<Point> = face.line(&outline[8..]).into_iter().chain([lower[0]]).rev().collect();
        let across = lower[8] - lower[0];
        let width = across.hypot();
        let up = across.turn_90() / width.max(1e-9);
        let up = if up.dot(face.point(10) - face.point(152)) < 0.0 { -up } else { up };
        (width > 0.0).then_some(())?;
        let [counts, narrow] = if face.spectacles.is_some() { BEHIND_LENSES } else { [1.0, NARROW] };
        Some(Self { width, upper: even(&upper)?, lower: even(&lower)?, up, counts, narrow })
    }

    /// The upper lid and the lower: an iris that is open keeps its lines.
    fn lids(&self) -> [Region; 2] {
        let band = |lid: &[Point], out: Vec2| {
            let corner = lid[0] + (lid[0] - lid[lid.len() - 1]) * CORNER;
            let lid: Vec<Point> = std::iter::once(corner).chain(lid.iter().copied()).collect();
            let beyond = lid.iter().map(|p| *p + out * (BEYOND * self.width));
            Region::of_polygons(vec![beyond.chain(lid.iter().rev().map(|p| *p - out * (WITHIN * self.width))).collect()])
        };
        [band(&self.upper, self.up), band(&self.lower, -self.up)]
    }

    /// Greatest height of the opening over its width.
    fn openness(&self) -> f64 {
        let heights = self.upper.iter().zip(&self.lower).map(|(upper, lower)| (*upper - *lower).dot(self.up));
        heights.fold(0.0, f64::max) / self.width
    }

    /// The lines of the upper lid and of the lower.
    fn lines(&self, portrait: &Portrait) -> [Vec<CoherentLine>; 2] {
        let Some(light) = Light::around(self, &portrait.lightness) else { return Default::default() };
        let covers = [MaskRole::Hair, MaskRole::Headwear].map(|role| portrait.masks.get(&role));
        let is_bare = |p: &Point| !covers.iter().flatten().any(|mask| mask.sample(p.x, p.y) > COVERED);
        let lids = [(&self.upper, self.up, UPPER), (&self.lower, -self.up, LOWER)];
        lids.map(|(points, out, lid)| self.lid(&light, points, out, &lid, &is_bare))
    }

    /// The line of one lid, in its parts; `out` points away from the eye.
    fn lid(&self, light: &Light, points: &[Point], out: Vec2, lid: &Lid, is_bare: &dyn Fn(&Point) -> bool) -> Vec<CoherentLine> {
        let off = |by: f64| points.iter().map(|p| *p + out * (by * self.width)).collect::<Vec<_>>();
        let (from, to) = (off(lid.beyond), off(-lid.inside));
        let place = |column: usize, row: usize| from[column].lerp(to[column], row as f64 / (ROWS - 1) as f64);
        let contrast = |column: usize, row: usize| {
            let (p, beside) = (place(column, row), out * (BESIDE * self.width));
            let at = |p: Point| light.at(p);
            at(p + beside) - at(p) + INSIDE * (at(p - beside) - at(p)).max(0.0)
        };
        let middle = lid.beyond / (lid.beyond + lid.inside) * (ROWS - 1) as f64;
        let away = |row: usize| AWAY * ((row as f64 - middle) / (ROWS - 1) as f64).powi(2) as f32;
        let values = Raster::from_fn(ROWS, COLUMNS, |row, column| contrast(column, row));
        let rows = best_way(&Raster::from_fn(ROWS, COLUMNS, |row, column| values.get(row, column) - away(row)), 2, BEND);
        let points: Vec<Point> = rows.iter().enumerate().map(|(column, row)| place(column, *row)).collect();
        let found: Vec<f64> =
            rows.iter().enumerate().map(|(column, row)| self.counts * f64::from(values.get(*row, column))).collect();
        let found = averaged(&found, SMOOTH);
        let widest = lid.widest * self.width * (self.openness() / OPEN).clamp(self.narrow, 1.0);
        let widths: Vec<f64> = found.iter().map(|contrast| widest * (contrast / lid.full).clamp(lid.least, 1.0)).collect();
        let line = smoothed(&points, &widths);
        let last = line.curve.points.len() - 1;
        let is_seen = |i: usize| found[i * (COLUMNS - 1) / last.max(1)] > lid.faintest;
        let kept: Vec<bool> = line.curve.points.iter().enumerate().map(|(i, p)| is_seen(i) && is_bare(p)).collect();
        line.runs(&kept)
    }
}

/// The photograph's lightness around an eye.
struct Light {
    blurred: Raster<f32>,
    origin: Vec2,
}

impl Light {
    /// None for an eye outside the picture.
    fn around(eye: &Eye, lightness: &Raster<f32>) -> Option<Self> {
        /// Room around the lids, in widths of the eye.
        const ROOM: f64 = 0.3;
        let lids =
            eye.upper.iter().chain(&eye.lower).fold(Rect::from_points(eye.upper[0], eye.lower[0]), |lids, p| lids.union_pt(*p));
        let wide = lids.inflate(ROOM * eye.width, ROOM * eye.width);
        let range = |from: f64, to: f64, most: usize| (from.max(0.0) as usize).min(most)..(to.ceil().max(0.0) as usize).min(most);
        let (columns, rows) = (range(wide.x0, wide.x1, lightness.width()), range(wide.y0, wide.y1, lightness.height()));
        let origin = Vec2::new(columns.start as f64, rows.start as f64);
        let is_in = !columns.is_empty() && !rows.is_empty();
        is_in.then(|| Self { blurred: gaussian_blur(&lightness.part(&columns, &rows), (BLUR * eye.width) as f32), origin })
    }

    fn at(&self, p: Point) -> f32 {
        self.blurred.sample(p.x - self.origin.x, p.y - self.origin.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::{Iris, POINTS};

    /// A face whose right eye is 60 by 20 pixels about (80, 60); the chin is below.
    fn face() -> Landmarks {
        let mut points = vec![[80.0, 60.0, 0.0]; POINTS];
        (points[10], points[152]) = ([80.0, 0.0, 0.0], [80.0, 140.0, 0.0]);
        for (i, index) in outlines::RIGHT_EYE.iter().enumerate() {
            let across = if i <= 8 { i as f64 / 8.0 } else { (16 - i) as f64 / 8.0 };
            let high = 40.0 * across * (1.0 - across) * if i <= 8 { 1.0 } else { -1.0 };
            points[*index] = [50.0 + 60.0 * across, 60.0 + high, 0.0];
        }
        let irises = [80.0, 120.0].map(|x| Iris { centre: Point::new(x, 60.0), radius: 6.0 });
        Landmarks { points, irises, spectacles: None, pearls: Vec::new() }
    }

    fn eye() -> Eye {
        Eye::of(&face(), &outlines::RIGHT_EYE).expect("it has a width")
    }

    /// Skin with a dark line two pixels above the upper lid that was found, and a dark iris below it.
    fn skin(depth: f32) -> Raster<f32> {
        Raster::from_fn(160, 120, |x, y| {
            let (across, y) = ((x as f64 + 0.5 - 50.0) / 60.0, y as f64 + 0.5);
            let lid = 58.0 - 40.0 * across * (1.0 - across);
            let is_lash = (0.0..1.0).contains(&across) && (y - lid).abs() < 1.0;
            let is_iris = Point::new(x as f64 + 0.5, y).distance(Point::new(80.0, 58.0)) < 6.0;
            if is_lash || is_iris { 0.7 - depth } else { 0.7 }
        })
    }

    fn upper(light: &Raster<f32>, is_bare: &dyn Fn(&Point) -> bool) -> Vec<CoherentLine> {
        let eye = eye();
        eye.lid(&Light::around(&eye, light).expect("it is in the picture"), &eye.upper, eye.up, &UPPER, is_bare)
    }

    #[test]
    fn the_upper_lids_line_lies_on_the_lashes_and_is_firmer_where_they_are_darker() {
        let [faint, firm] = [0.08, 0.5].map(|depth| upper(&skin(depth), &|_| true));
        let [faint, firm] = [&faint[0], &firm[0]];
        for p in firm.curve.points.iter().filter(|p| (60.0..100.0).contains(&p.x)) {
            let across = (p.x - 50.0) / 60.0;
            assert!((p.y - (58.0 - 40.0 * across * (1.0 - across))).abs() < 1.5, "{p:?}");
        }
        let middle = |line: &CoherentLine| line.widths[line.widths.len() / 2];
        assert!(middle(firm) > 1.3 * middle(faint) && middle(firm) <= UPPER.widest * 60.0 + 1e-9);
    }

    #[test]
    fn an_eye_without_contrast_or_under_hair_has_no_line() {
        assert!(upper(&skin(0.0), &|_| true).is_empty());
        let half = upper(&skin(0.5), &|p| p.x < 80.0);
        assert!(half.iter().flat_map(|line| &line.curve.points).all(|p| p.x < 80.0) && !half.is_empty());
    }

    #[test]
    fn crumbs_of_lashes_go_and_the_lines_of_an_iris_stay() {
        let lids = Lids { regions: eye().lids().into(), widths: vec![60.0; 2], lines: Vec::new() };
        let line = |from: (f64, f64), to: (f64, f64)| {
            let points: Vec<Point> = (0..=10).map(|i| Point::from(from).lerp(Point::from(to), f64::from(i) / 10.0)).collect();
            CoherentLine::plain(Curve { points, closed: false }, 1.0)
        };
        let kept = lids.cut_from(&[line((70.0, 51.0), (90.0, 51.0)), line((76.0, 58.0), (76.0, 62.0))], |_| 5.0);
        assert_eq!(kept.len(), 1);
        assert_eq!(kept[0].curve.points[0], Point::new(76.0, 58.0));
    }
}
