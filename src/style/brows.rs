//! Brows in short strokes along their hairs, as engravers set them.
//!
//! ```text
//!   ridge    the middle of the brow, from its inner to its outer end
//!   region   what is darker than the skin around, within reach of the ridge
//!   hairs    rise at the inner end, lie down along the ridge towards the temple, and meet on it from above and below
//! ```

use super::Drawer;
use super::charcoal::Hairs;
use super::declaration::Radians;
use super::drawer::Pitched;
use crate::elementary::Elementary as _;
use crate::field::OrientationField;
use crate::geometry::{Millimetres, Point, Vec2};
use crate::raster::{Raster, fast_gaussian, fast_gaussian_within, filled_polygon};
use crate::source::{Landmarks, outlines};

/// A face of fewer pitches keeps its brows in dots: a brow would be three strokes.
const LEAST_WIDTH: f64 = 24.0;
/// Blur of a brow's outline, the skin that it is compared with, and the blur of its hairs, in widths of the face.
const REACH: f64 = 0.016;
const NEAR: [f32; 2] = [0.15, 0.45];
const AROUND: f64 = 0.07;
const FINE: f64 = 0.006;
/// A brow is at least this much darker than the skin around; its border is where the difference is this share of the brow's own.
const LEAST_DEPTH: f32 = 0.03;
const BORDER: [f32; 2] = [0.1, 0.34];
/// Width of a hair in pitches, its mean length in widths of the face, and its angle to the others at most, in degrees. Wider or less even ones
/// are combs and false lashes (03, 08, 15).
const WIDTH: f64 = 0.36;
const LENGTH: f64 = 0.085;
const TURN: f64 = 6.0;
/// The share of a brow's ink that is dots, below the strokes. Without dots brows have white gaps, as if grizzled.
pub(super) const DOTS: f32 = 0.4;
/// A brow of which hair or a hat covers more than this share is not one.
const MOST_COVERED: f64 = 0.5;
/// The angle of the hairs above the ridge at its inner end, a third along, two thirds along and at the outer end, and by how much hairs at the
/// upper border lean down and those at the lower border up, in degrees.
const RISES: [f64; 4] = [38.0, 18.0, 6.0, -6.0];
const LEAN: f64 = 10.0;

/// Where brows are, and the direction of their hairs; on the working grid.
pub(super) struct Brows {
    pub region: Raster<f32>,
    pub hairs: OrientationField,
    /// Their sizes on the page.
    pub sizes: Hairs,
}

impl<P: Pitched> Drawer<'_, P> {
    /// The brows of the faces that are large enough, where hair does not cover them. A face has both or none.
    pub(super) fn brows(&self, hair: Option<&Raster<f32>>) -> Option<Brows> {
        let least = LEAST_WIDTH * self.pitch();
        let (width, height) = self.size();
        let mut region = Raster::filled(width, height, 0.0_f32);
        let mut ridges = Vec::new();
        let mut widest = 0.0_f64;
        for face in self.portrait.faces.iter().filter(|face| face.width() >= least) {
            let both = [&outlines::RIGHT_BROW, &outlines::LEFT_BROW].map(|outline| self.brow(face, outline, hair));
            let [Some(right), Some(left)] = both else { continue };
            right.add_to(&mut region);
            left.add_to(&mut region);
            ridges.extend([right.ridge, left.ridge]);
            widest = widest.max(face.width());
        }
        let length = Millimetres(LENGTH * widest * self.portrait.placement.mm_per_pixel());
        let pitch = self.parameters.pitch();
        let sizes = Hairs { pitch, width: WIDTH * pitch, length, turn: Radians(TURN.to_radians()), combed: 1.0, in_beards: 1.0 };
        (!ridges.is_empty()).then(|| Brows { hairs: hairs(&region, &ridges), region, sizes })
    }

    /// One brow; none if it is too pale or covered.
    fn brow(&self, face: &Landmarks, outline: &[usize; 10], hair: Option<&Raster<f32>>) -> Option<Brow> {
        let sigma = |share: f64| (share * face.width()) as f32;
        let line = face.line(outline);
        let room = 3.0 * AROUND * face.width();
        let range = |of: fn(&Point) -> f64, most: usize| {
            let (least, last) = line.iter().map(of).fold((f64::MAX, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
            ((least - room).max(0.0) as usize).min(most)..((last + room).ceil() as usize).min(most)
        };
        let (columns, rows) = (range(|p| p.x, self.size().0), range(|p| p.y, self.size().1));
        if columns.is_empty() || rows.is_empty() {
            return None;
        }
        let corners: Vec<[f64; 2]> = line.iter().map(|p| [p.x - columns.start as f64, p.y - rows.start as f64]).collect();
        let inside = filled_polygon(columns.len(), rows.len(), &corners).map(f32::from);
        let near = fast_gaussian(&inside, sigma(REACH)).map(|v| share_of(v, NEAR));
        let tone = self.portrait.tone.part(&columns, &rows).map(|v| v.clamp(0.0, 1.0));
        let around = fast_gaussian_within(&tone, &near.map(|near| 1.0 - near + 1e-6), sigma(AROUND));
        let below = around.zip_map(&fast_gaussian(&tone, sigma(FINE)), |around, tone| around - tone);
        let depth = depth(&below, &inside)?;
        let mut region = near.zip_map(&below, |near, below| near * share_of(below / depth, BORDER));
        if let Some(hair) = hair.map(|hair| hair.part(&columns, &rows)) {
            let whole = sum(&region);
            region = region.zip_map(&hair, |brow, hair| brow.min(1.0 - hair));
            if sum(&region) < (1.0 - MOST_COVERED) * whole {
                return None;
            }
        }
        Some(Brow { region, at: (columns.start, rows.start), ridge: Ridge::of(face, outline) })
    }
}

/// The tone of strokes that make a tone together with the dots below them.
pub(super) fn tone_over_dots(tone: f32) -> f32 {
    let ink = (1.0 - tone).clamp(0.0, 1.0);
    1.0 - ink * (1.0 - DOTS) / (1.0 - DOTS * ink)
}

/// One brow in its box.
struct Brow {
    region: Raster<f32>,
    at: (usize, usize),
    ridge: Ridge,
}

impl Brow {
    /// Adds it to a region of the whole grid.
    fn add_to(&self, region: &mut Raster<f32>) {
        for (y, x) in (0..self.region.height()).flat_map(|y| (0..self.region.width()).map(move |x| (y, x))) {
            let (column, row) = (x + self.at.0, y + self.at.1);
            region.set(column, row, region.get(column, row).max(self.region.get(x, y)));
        }
    }
}

fn sum(region: &Raster<f32>) -> f64 {
    region.pixels().iter().map(|v| f64::from(*v)).sum()
}

/// The middle of a brow from its inner to its outer end, and the side on which the forehead is.
struct Ridge {
    points: Vec<Point>,
    up: Vec2,
    half: f64,
}

impl Ridge {
    /// An outline is the lower border from the outer to the inner end, then the upper one back.
    fn of(face: &Landmarks, outline: &[usize; 10]) -> Self {
        let line = face.line(outline);
        let points: Vec<Point> = (0..5).map(|i| line[4 - i].midpoint(line[5 + i])).collect();
        let half = (0..5).map(|i| 0.5 * line[4 - i].distance(line[5 + i])).fold(0.0, f64::max);
        Self { points, up: face.point(10) - face.point(152), half }
    }

    /// The nearest place on the ridge: its distance, the share of the way along, the direction there, and the height of `p` above it in half
    /// heights of the brow.
    fn nearest(&self, p: Point) -> (f64, f64, Vec2, f64) {
        let steps = (self.points.len() - 1) as f64;
        let on = |i: usize| {
            let (a, way) = (self.points[i], self.points[i + 1] - self.points[i]);
            let share = ((p - a).dot(way) / way.hypot2().max(1e-9)).clamp(0.0, 1.0);
            let off = p - (a + way * share);
            (off.hypot(), (i as f64 + share) / steps, way, off.dot(self.up.normalize()) / self.half.max(1e-9))
        };
        (1..self.points.len() - 1).map(on).fold(on(0), |best, next| if next.0 < best.0 { next } else { best })
    }

    /// The direction of a hair.
    fn hair(&self, along: f64, way: Vec2, above: f64) -> Vec2 {
        let at = along * (RISES.len() - 1) as f64;
        let first = (at as usize).min(RISES.len() - 2);
        let rise = RISES[first] + (RISES[first + 1] - RISES[first]) * (at - first as f64);
        let angle = (rise - LEAN * above.clamp(-1.0, 1.0)).to_radians();
        let across = Vec2::new(-way.y, way.x);
        let up = if across.dot(self.up) < 0.0 { -across } else { across };
        way * angle.cosine() + up * angle.sine()
    }
}

/// The direction of the hairs of the nearest brow, wherever there is one.
fn hairs(region: &Raster<f32>, ridges: &[Ridge]) -> OrientationField {
    OrientationField::new(Raster::from_fn(region.width(), region.height(), |x, y| {
        if region.get(x, y) <= 0.0 {
            return [0.0; 2];
        }
        let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
        let places = ridges.iter().map(|ridge| (ridge, ridge.nearest(p)));
        let nearest = places.min_by(|(_, a), (_, b)| a.0.total_cmp(&b.0));
        let Some((ridge, (_, along, way, above))) = nearest else { return [0.0; 2] };
        let hair = ridge.hair(along, way, above);
        let length = hair.hypot2().max(1e-9);
        [((hair.x * hair.x - hair.y * hair.y) / length) as f32, (2.0 * hair.x * hair.y / length) as f32]
    }))
}

/// How much darker than its skin a brow is in its dark quarter; none if it is too pale.
fn depth(below: &Raster<f32>, inside: &Raster<f32>) -> Option<f32> {
    let within = below.pixels().iter().zip(inside.pixels()).filter(|(_, inside)| **inside > 0.5);
    let mut depths: Vec<f32> = within.map(|(below, _)| *below).collect();
    depths.sort_unstable_by(f32::total_cmp);
    depths.get(depths.len() * 3 / 4).copied().filter(|depth| *depth >= LEAST_DEPTH)
}

/// How far a value has come on its way from 0 to 1.
fn share_of(value: f32, [from, to]: [f32; 2]) -> f32 {
    ((value - from) / (to - from)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::{Iris, POINTS};

    /// A face whose right brow runs from its inner end (60, 40) to its outer one (20, 40), 8 pixels high; the chin is below.
    fn face() -> Landmarks {
        let mut points = vec![[80.0, 70.0, 0.0]; POINTS];
        (points[10], points[152]) = ([80.0, 0.0, 0.0], [80.0, 140.0, 0.0]);
        for (i, index) in outlines::RIGHT_BROW.iter().enumerate() {
            let (x, y) = if i < 5 { (20 + 10 * i, 44.0) } else { (60 - 10 * (i - 5), 36.0) };
            points[*index] = [x as f64, y, 0.0];
        }
        let irises = [40.0, 120.0].map(|x| Iris { centre: Point::new(x, 60.0), radius: 4.0 });
        Landmarks { points, irises, spectacles: None, pearls: Vec::new() }
    }

    #[test]
    fn hairs_rise_at_the_inner_end_and_lie_down_towards_the_temple() {
        let ridge = Ridge::of(&face(), &outlines::RIGHT_BROW);
        let slope = |p: Point| {
            let (_, along, way, above) = ridge.nearest(p);
            let hair = ridge.hair(along, way, above);
            assert!(hair.x < 0.0, "outwards");
            (-hair.y).angle_over(-hair.x).to_degrees()
        };
        let [inner, middle, outer] = [60.0, 40.0, 20.0].map(|x| slope(Point::new(x, 40.0)));
        assert!((inner - RISES[0]).abs() < 1e-6 && (outer - RISES[3]).abs() < 1e-6, "{inner} {outer}");
        assert!(inner > middle && middle > outer, "{middle}");
        let [upper, lower] = [36.0, 44.0].map(|y| slope(Point::new(40.0, y)));
        assert!((upper - (middle - LEAN)).abs() < 1e-6 && (lower - (middle + LEAN)).abs() < 1e-6, "{upper} {lower}");
    }

    #[test]
    fn a_pale_brow_stays_in_dots() {
        let below = Raster::filled(10, 10, 0.02_f32);
        assert_eq!(depth(&below, &below.map(|_| 1.0)), None);
        assert_eq!(depth(&below.map(|_| 0.2), &below.map(|_| 1.0)), Some(0.2));
    }
}
