//! Mouths as a draughtsman sets them: one line where the lips meet, or one along each lip of an open mouth and thin ones between teeth.
//!
//! ```text
//!   columns   from corner to corner, across both lips
//!   lines     the darkest way through the columns: one where the mouth is closed, else one along each lip
//!   teeth     lines in the gaps between them
//!   found     lines that were found inside the lips go: creases of the lips, lights on teeth
//! ```

use super::columns::{COLUMNS, SMOOTH, averaged, between, even, smoothed};
use super::feature_line::feature_stroke;
use super::lip_borders::lip_border;
use super::tooth_gaps::Teeth;
use crate::drawing::Mark;
use crate::field::CoherentLine;
use crate::geometry::{Point, Region, Vec2};
use crate::raster::{Raster, best_way, gaussian_blur};
use crate::source::{Landmarks, MaskRole, Placement, Portrait, outlines};

/// Rows across a lip.
const ROWS: usize = 41;
/// Mean gap between the lips, in widths of the mouth, from which each lip has a line of its own.
const OPEN: f64 = 0.045;
/// A mouth of fewer pitches is left as it was found.
const LEAST_WIDTH: f64 = 8.0;
/// How far a line may lie from the border between the lips as the landmarks have it, as a share of the lip on its side and, in an open mouth,
/// of the gap.
const IN_LIP: f64 = 0.6;
const IN_GAP: f64 = 0.4;
/// Distance of the sides that a line is compared with, the blur before that, in widths of the mouth; and the price of a bend by one row.
const BESIDE: f64 = 0.035;
const BLUR: f64 = 0.006;
const BEND: f32 = 0.006;
/// The width of a line, in widths of the mouth, at the contrast from which it is full; and its least share of that.
const WIDEST: f64 = 0.022;
const FULL: f64 = 0.16;
const LEAST: f64 = 0.35;
/// Width of the line along the lower lip of an open mouth, as a share: in full it is a ring around the teeth.
const LOWER: f64 = 0.6;
/// Share of a line at each end over which it tapers.
const TAPER: f64 = 0.15;
/// Where found lines give way: so much of the way from the middle between the lips to their outer border.
const INSIDE: f64 = 0.88;
/// Hair over the mouth from which nothing is drawn.
const HAIR: f32 = 0.5;

/// The mouths of a portrait.
pub(super) struct Mouths {
    inside: Vec<Region>,
    lines: Vec<CoherentLine>,
    gaps: Vec<CoherentLine>,
    borders: Vec<CoherentLine>,
}

impl Mouths {
    /// Of the faces that were found, in working pixels; `pitch` in these.
    pub(super) fn of(portrait: &Portrait, pitch: f64) -> Self {
        let mut mouths = Self { inside: Vec::new(), lines: Vec::new(), gaps: Vec::new(), borders: Vec::new() };
        let hair = [MaskRole::FacialHair, MaskRole::Hair].map(|role| portrait.masks.get(&role));
        let is_bare = |p: &Point| !hair.iter().flatten().any(|mask| mask.sample(p.x, p.y) > HAIR);
        for face in &portrait.faces {
            let Some(mouth) = Mouth::of(face).filter(|mouth| mouth.width >= LEAST_WIDTH * pitch) else { continue };
            mouths.inside.push(mouth.inside());
            let soft = gaussian_blur(&portrait.lightness, (BLUR * mouth.width) as f32);
            let lips = mouth.lips(&soft);
            let gaps = mouth.gaps(&portrait.lightness, &lips);
            mouths.gaps.extend(gaps.into_iter().filter(|gap| gap.curve.points.iter().all(is_bare)));
            let bare = |line: &CoherentLine| line.runs(&line.curve.points.iter().map(is_bare).collect::<Vec<_>>());
            mouths.lines.extend(lips.iter().flat_map(bare));
            mouths.borders.extend(mouth.borders(&soft).iter().flat_map(bare));
        }
        mouths
    }

    /// The mouths' own lines on the page, whose widths count by `share`.
    pub(super) fn strokes(&self, placement: &Placement, share: f64) -> Vec<Mark> {
        strokes(&self.lines.iter().map(|line| line.widened(share)).collect::<Vec<_>>(), placement)
    }

    /// The lines between teeth on the page.
    pub(super) fn between_teeth(&self, placement: &Placement) -> Vec<Mark> {
        strokes(&self.gaps, placement)
    }

    /// The lines along the lips' outer borders on the page.
    pub(super) fn around_lips(&self, placement: &Placement) -> Vec<Mark> {
        strokes(&self.borders, placement)
    }

    /// Lines that were found, with the mouths' own in place of those inside the lips; what is left of one is at least `least` long.
    pub(super) fn redrawn(&self, found: Vec<CoherentLine>, least: f64) -> Vec<CoherentLine> {
        if self.inside.is_empty() {
            return found;
        }
        let is_outside = |p: &Point| !self.inside.iter().any(|mouth| mouth.contains(*p));
        let kept = found.iter().flat_map(|line| line.parts_where(is_outside, least));
        kept.chain(self.lines.iter().cloned()).collect()
    }
}

fn strokes(lines: &[CoherentLine], placement: &Placement) -> Vec<Mark> {
    lines.iter().filter_map(|line| feature_stroke(line, placement, TAPER * line.curve.length())).collect()
}

/// One mouth: lines from the right corner to the left, each of `COLUMNS` points.
struct Mouth {
    width: f64,
    upper: [Vec<Point>; 2],
    lower: [Vec<Point>; 2],
}

impl Mouth {
    /// The inner and the outer border of both lips; none if it has no width.
    fn of(face: &Landmarks) -> Option<Self> {
        let halves = |closed: &[usize; 20]| {
            let lower = face.line(&closed[..=10]);
            let upper: Vec<Point> = face.line(&closed[10..]).into_iter().chain([face.point(closed[0])]).rev().collect();
            Some([even(&upper)?, even(&lower)?])
        };
        let [inner_upper, inner_lower] = halves(&outlines::MOUTH)?;
        let [outer_upper, outer_lower] = halves(&outlines::LIPS)?;
        let width = outer_upper[0].distance(outer_upper[COLUMNS - 1]);
        (width > 0.0).then_some(Self { width, upper: [inner_upper, outer_upper], lower: [inner_lower, outer_lower] })
    }

    /// Where the lips and what lies between them have no lines but their own.
    fn inside(&self) -> Region {
        let middle = |i: usize| self.upper[0][i].midpoint(self.lower[0][i]);
        let towards = |lip: &[Vec<Point>; 2], i: usize| middle(i).lerp(lip[1][i], INSIDE);
        let upper = (0..COLUMNS).map(|i| towards(&self.upper, i));
        let lower = (0..COLUMNS).rev().map(|i| towards(&self.lower, i));
        Region::of_polygons(vec![upper.chain(lower).collect()])
    }

    fn gap(&self) -> f64 {
        let gaps = self.upper[0].iter().zip(&self.lower[0]).map(|(upper, lower)| upper.distance(*lower));
        gaps.sum::<f64>() / COLUMNS as f64 / self.width
    }

    /// One line where the lips meet, or one along each lip.
    fn lips(&self, light: &Raster<f32>) -> Vec<CoherentLine> {
        let seen = Seen { light, mouth: self };
        let into = |lip: &[Vec<Point>; 2]| between(&lip[0], &lip[1], IN_LIP);
        if self.gap() < OPEN {
            return vec![seen.darkest(&into(&self.upper), &into(&self.lower), WIDEST)];
        }
        let [below, above] = [(&self.upper, &self.lower), (&self.lower, &self.upper)].map(|(a, b)| between(&a[0], &b[0], IN_GAP));
        vec![seen.darkest(&into(&self.upper), &below, WIDEST), seen.darkest(&above, &into(&self.lower), LOWER * WIDEST)]
    }

    /// Lines in the gaps between teeth, if the lips are apart.
    fn gaps(&self, light: &Raster<f32>, lips: &[CoherentLine]) -> Vec<CoherentLine> {
        let [upper, lower] = lips else { return Vec::new() };
        let [upper, lower] = [upper, lower].map(|line| line.curve.points.as_slice());
        Teeth { light, lips: self.lightness_of_lips(light), upper, lower, width: self.width }.gaps()
    }

    /// The outer borders of both lips where they are seen.
    fn borders(&self, light: &Raster<f32>) -> Vec<CoherentLine> {
        let border = |lip: &[Vec<Point>; 2]| lip_border(light, [&lip[0], &lip[1]], self.width);
        [&self.upper, &self.lower].into_iter().flat_map(border).collect()
    }

    /// The mean lightness along the middles of both lips.
    fn lightness_of_lips(&self, light: &Raster<f32>) -> f32 {
        let middles = [&self.upper, &self.lower].map(|lip| between(&lip[0], &lip[1], 0.5));
        middles.iter().flatten().map(|p| light.sample(p.x, p.y)).sum::<f32>() / (2 * COLUMNS) as f32
    }
}

/// A mouth in the photograph.
struct Seen<'a> {
    light: &'a Raster<f32>,
    mouth: &'a Mouth,
}

impl Seen<'_> {
    /// The darkest line from corner to corner between two others; `widest` in widths of the mouth.
    fn darkest(&self, from: &[Point], to: &[Point], widest: f64) -> CoherentLine {
        let place = |column: usize, row: usize| from[column].lerp(to[column], row as f64 / (ROWS - 1) as f64);
        let values =
            Raster::from_fn(ROWS, COLUMNS, |row, column| self.contrast(place(column, row), self.across(from, to, column)));
        let rows = best_way(&values, 2, BEND);
        let points: Vec<Point> = rows.iter().enumerate().map(|(column, row)| place(column, *row)).collect();
        let contrasts: Vec<f64> = rows.iter().enumerate().map(|(column, row)| f64::from(values.get(*row, column))).collect();
        let widths: Vec<f64> = averaged(&contrasts, SMOOTH)
            .iter()
            .map(|contrast| widest * self.mouth.width * (contrast / FULL).clamp(LEAST, 1.0))
            .collect();
        smoothed(&points, &widths)
    }

    fn across(&self, from: &[Point], to: &[Point], column: usize) -> Vec2 {
        let middle = |i: usize| from[i].midpoint(to[i]);
        let along = middle((column + 1).min(COLUMNS - 1)) - middle(column.saturating_sub(1));
        along.turn_90() * (BESIDE * self.mouth.width / along.hypot().max(1e-9))
    }

    /// How much lighter both sides are than a place, in the mean.
    fn contrast(&self, p: Point, across: Vec2) -> f32 {
        let at = |p: Point| self.light.sample(p.x, p.y);
        f32::midpoint(at(p + across), at(p - across)) - at(p)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::unit_at;
    use crate::field::Curve;
    use crate::source::Iris;

    /// A mouth of 100 by 40 pixels about (80, 60) whose lips meet, or are `gap` apart in the middle.
    fn mouth(gap: f64) -> Mouth {
        let mut points = vec![[0.0; 3]; crate::source::POINTS];
        let mut set = |closed: &[usize; 20], half: [f64; 2]| {
            for (i, index) in closed.iter().enumerate() {
                let turn = unit_at(std::f64::consts::TAU * i as f64 / 20.0);
                points[*index] = [80.0 - half[0] * turn.x, 60.0 + half[1] * turn.y, 0.0];
            }
        };
        set(&outlines::LIPS, [50.0, 20.0]);
        set(&outlines::MOUTH, [45.0, 0.5 * gap]);
        let irises = [60.0, 100.0].map(|x| Iris { centre: Point::new(x, 20.0), radius: 4.0 });
        Mouth::of(&Landmarks { points, irises, spectacles: None, pearls: Vec::new() }).expect("it has a width")
    }

    /// Lips with a dark line of a depth along `at`.
    fn lips(at: impl Fn(f64) -> f64 + Sync, depth: f32) -> Raster<f32> {
        Raster::from_fn(160, 120, |x, y| if (y as f64 + 0.5 - at(x as f64)).abs() < 1.5 { 0.6 - depth } else { 0.6 })
    }

    #[test]
    fn a_closed_mouth_has_one_line_where_it_is_darkest() {
        let mouth = mouth(2.0);
        assert!(mouth.gap() < OPEN);
        let at = |x: f64| 58.0 + 0.05 * (x - 80.0);
        let (faint, firm) = (lips(at, 0.05), lips(at, 0.3));
        let line = |light: &Raster<f32>| {
            let into = |lip: &[Vec<Point>; 2]| between(&lip[0], &lip[1], IN_LIP);
            Seen { light, mouth: &mouth }.darkest(&into(&mouth.upper), &into(&mouth.lower), WIDEST)
        };
        let (faint, firm) = (line(&faint), line(&firm));
        for p in firm.curve.points.iter().filter(|p| (50.0..110.0).contains(&p.x)) {
            assert!((p.y - at(p.x)).abs() < 1.5, "{p:?}");
        }
        let middle = |line: &CoherentLine| line.widths[line.widths.len() / 2];
        assert!(middle(&firm) > 1.5 * middle(&faint) && middle(&firm) <= WIDEST * mouth.width + 1e-9);
    }

    #[test]
    fn creases_of_the_lips_go_and_lines_beyond_them_stay() {
        let mouth = mouth(20.0);
        assert!(mouth.gap() > OPEN);
        let mouths = Mouths { inside: vec![mouth.inside()], lines: Vec::new(), gaps: Vec::new(), borders: Vec::new() };
        let line = |x: f64, y: [f64; 2]| {
            let points: Vec<Point> = (0..=20).map(|i| Point::new(x, y[0] + (y[1] - y[0]) * f64::from(i) / 20.0)).collect();
            CoherentLine { widths: vec![1.0; points.len()], curve: Curve { points, closed: false }, contrast: 0.3 }
        };
        let kept = mouths.redrawn(vec![line(80.0, [50.0, 70.0]), line(80.0, [90.0, 110.0]), line(70.0, [60.0, 100.0])], 5.0);
        assert_eq!(kept.len(), 2, "the crease goes, the fold of the chin stays, and of the third a part");
        assert!(kept[1].curve.points[0].y > 74.0 && kept[1].curve.length() > 15.0);
    }
}
