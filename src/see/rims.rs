//! The rims of spectacles: around each eye the closed way that is darkest against both its sides, the two alike above and below the eyes. The
//! edges of lenses without a frame, in the same way, are light lines.

use super::spectacles::{APART, Light, MIDDLE, Way};
use crate::elementary::{Elementary as _, unit_at};
use crate::geometry::{Point, Rect, Vec2};
use crate::raster::{Raster, best_way};
use std::f64::consts::TAU;

/// The lenses' mean shape: distance of its middle from the iris outward and down, half its width and height, and the power of its
/// superellipse.
const LENS_AT: Vec2 = Vec2::new(4.0, 7.0);
const LENS: Vec2 = Vec2::new(44.0, 29.0);
const SQUARE: f64 = 2.6;
/// Middles of a lens that are tried, from the mean one, which is the first: about one alone, a rim that is cut off on one side may win. Tuned on
/// five portraits and Grace Hopper: farther away hair's border is reached.
const MIDDLES: [Vec2; 5] = [Vec2::ZERO, Vec2::new(-4.0, 0.0), Vec2::new(4.0, 0.0), Vec2::new(0.0, -4.0), Vec2::new(0.0, 4.0)];
/// Sizes of a lens that are tried, as factors of the mean, their number, and the number of directions around the eye.
const SCALES: [f64; 2] = [0.3, 1.4];
const STEPS: usize = 74;
pub(super) const DIRECTIONS: usize = 96;
/// Margins beside, above and below the opening between the lids, where lashes, folds and bags are no rims: with 6 above the upper rims of
/// small spectacles are lost, with 16 below bags are the lower rims of those that have none there. And the least distance from the
/// nose's middle.
const LIDS: [f64; 3] = [5.5, 2.5, 22.0];
const OFF_NOSE: f64 = 4.0;
/// The margin below the opening for the edge of a lens without a frame, which may lie nearer. With 22 a fold farther down is taken for it (02),
/// with 9 the light along the lower lid.
const BELOW_EDGE: f64 = 12.0;
/// Value of a place where no rim can be.
const IMPOSSIBLE: f32 = -0.2;
/// Price of a bend of a rim.
const RIM_BEND: f32 = 0.004;
/// What a place counts at most in the search, where black brows would outweigh wire; and by how much more it counts on a larger rim, which is
/// longer, per size of the mean lens above this one.
const MOST_COUNTED: f32 = 0.07;
const LONGER: f32 = 0.25;
const MEAN_SCALE: f32 = 0.85;
/// What a dark place above a brow's lower line or beyond the face counts, as a share: rims may cross brows, and the cheek of a turned head, but
/// brows and the border of hair are no rims.
const NO_RIM: f32 = 0.4;
/// Price of a place per pixel that it lies off the other rim's mirror image, from so many pixels on, and its most: lenses are alike, and a lid's
/// fold or a temple in place of a rim has no image. Tuned on seven people with rims: without it the left rim of portrait 01 runs along the lid.
const UNLIKE: f64 = 0.002;
const ALIKE: f64 = 2.0;
const MOST_UNLIKE: f64 = 0.03;
/// It counts where the mean lens' border is this far above or below its middle, in shares of half its height: beside the eyes the rims of a turned
/// head (11) differ.
const STEEP: f64 = 0.75;

/// What is around an eye in the window that is no spectacles.
pub(super) struct Eye {
    /// Around the opening between the lids.
    pub lids: Rect,
    /// The lower line of the brow, from left to right.
    pub brow: Vec<Point>,
}

impl Eye {
    /// True between the lids and so near them that dark places are lashes, folds and bags.
    fn holds(&self, p: Point, kind: Rim) -> bool {
        let away = p - self.lids.center();
        let half = self.lids.size() / 2.0;
        let below = if kind == Rim::Dark { LIDS[2] } else { BELOW_EDGE };
        let down = half.height + if away.y > 0.0 { below } else { LIDS[1] };
        (away.x / (half.width + LIDS[0])).powi(2) + (away.y / down).powi(2) < 1.0
    }
}

/// What a rim is told by.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Rim {
    /// A frame, darker than both its sides.
    Dark,
    /// The edge of a lens without a frame, or with one above alone.
    Edge,
}

/// The rims around the eyes on the left and on the right in the window: one is free and the other near its image, in the order that counts more.
pub(super) fn rims(light: &Light, eyes: &[Eye; 2], kind: Rim) -> [Way; 2] {
    let directions = &Directions::new();
    let around = |side: usize| Around { side: [-1.0, 1.0][side], eye: &eyes[side], kind, directions };
    let looks = [0, 1].map(|side| light.looks(around(side)));
    let rim = |side: usize, other: Option<&Way>| light.rim(&looks[side], around(side), other.map(Way::mirrored).as_deref());
    let [left, right] = [rim(0, None), rim(1, None)];
    let (as_right, as_left) = (rim(0, Some(&right)), rim(1, Some(&left)));
    if as_right.counted + right.counted > left.counted + as_left.counted { [as_right, right] } else { [left, as_left] }
}

impl Way {
    /// Its image on the other side of the nose.
    fn mirrored(&self) -> Vec<Point> {
        self.points.iter().map(|p| Point::new(2.0 * MIDDLE.x - p.x, p.y)).collect()
    }
}

/// What is searched around an eye on the left (-1) or on the right (1) in the window.
#[derive(Clone, Copy)]
struct Around<'a> {
    side: f64,
    eye: &'a Eye,
    kind: Rim,
    directions: &'a Directions,
}

/// The lens and the direction across its border in each direction around a middle.
struct Directions(Vec<(Vec2, Vec2)>);

impl Directions {
    fn new() -> Self {
        Self((0..DIRECTIONS).map(|direction| (lens(direction), lens_normal(direction))).collect())
    }
}

/// How much each place around a middle looks like a rim, by its size of the lens and its direction.
struct Looks {
    centre: Point,
    values: Raster<f32>,
}

impl Light {
    /// The places around an eye about each middle that is tried.
    fn looks(&self, around: Around<'_>) -> [Looks; MIDDLES.len()] {
        let mean = MIDDLE + Vec2::new(around.side * (0.5 * APART + LENS_AT.x), LENS_AT.y);
        MIDDLES.map(|away| self.looks_about(mean + away, around))
    }

    fn looks_about(&self, centre: Point, Around { side, eye, kind, directions }: Around<'_>) -> Looks {
        let values = Raster::from_fn(STEPS, DIRECTIONS, |step, direction| {
            let (along, across) = directions.0[direction];
            let p = centre + along * scale(step);
            if side * (p.x - MIDDLE.x) < OFF_NOSE || eye.holds(p, kind) {
                return IMPOSSIBLE;
            }
            self.counts(p, along, across, kind)
        });
        Looks { centre, values }
    }

    /// The closed way around the eye that is most a rim, about the best of several middles; near the image of the other rim if that is given.
    fn rim(&self, looks: &[Looks; MIDDLES.len()], around: Around<'_>, image: Option<&[Point]>) -> Way {
        let [first, others @ ..] = looks.each_ref().map(|looks| self.rim_about(looks, around, image));
        others.into_iter().fold(first, |best, way| if way.counted > best.counted { way } else { best })
    }

    /// The closed way about this middle that is most a rim.
    fn rim_about(&self, looks: &Looks, Around { eye, directions, .. }: Around<'_>, image: Option<&[Point]>) -> Way {
        let Looks { centre, values } = looks;
        let lens = |direction: usize| directions.0[direction].0;
        let expected: Vec<Option<f64>> = (0..DIRECTIONS)
            .map(lens)
            .map(|along| image.filter(|_| along.y.abs() > STEEP * LENS.y).and_then(|image| reach_towards(image, *centre, along)))
            .collect();
        let counted = Raster::from_fn(STEPS, DIRECTIONS, |step, direction| {
            let value = values.get(step, direction).min(MOST_COUNTED);
            let p = *centre + lens(direction) * scale(step);
            let share = if is_above(&eye.brow, p) || !self.is_in_face(p) { NO_RIM } else { 1.0 };
            let value = if value > 0.0 { value * share * (1.0 + LONGER * (scale(step) as f32 - MEAN_SCALE)) } else { value };
            value - expected[direction].map_or(0.0, |reach| unlike(scale(step) * lens(direction).hypot() - reach))
        });
        // Once around before and once after, so that both ends meet.
        let around = Raster::from_fn(STEPS, 3 * DIRECTIONS, |step, row| counted.get(step, row % DIRECTIONS));
        let steps = best_way(&around, 2, RIM_BEND)[DIRECTIONS..2 * DIRECTIONS].to_vec();
        let sum = |of: &Raster<f32>| steps.iter().enumerate().map(|(direction, step)| of.get(*step, direction)).sum::<f32>();
        let smooth = |direction: usize| {
            let around = [DIRECTIONS - 2, DIRECTIONS - 1, 0, 1, 2].map(|by| scale(steps[(direction + by) % DIRECTIONS]));
            around.iter().sum::<f64>() / 5.0
        };
        let points = (0..DIRECTIONS).map(|direction| *centre + lens(direction) * smooth(direction)).collect();
        Way { points, contrast: sum(values) / DIRECTIONS as f32, counted: sum(&counted) }
    }

    /// How much a place looks like a rim in a direction around the eye. Lenses may have a dark upper frame; below they have a light edge,
    /// and what is dark there are folds.
    fn counts(&self, p: Point, along: Vec2, across: Vec2, kind: Rim) -> f32 {
        match kind {
            Rim::Dark => self.sharp_contrast(p, across),
            Rim::Edge if along.y > 0.0 => self.light_contrast(p, across),
            Rim::Edge => self.sharp_contrast(p, across).max(self.light_contrast(p, across)),
        }
    }
}

/// How far from a centre the points of a ring lie in a direction.
fn reach_towards(ring: &[Point], centre: Point, along: Vec2) -> Option<f64> {
    let along = along / along.hypot();
    let ahead = ring.iter().map(|p| *p - centre).filter(|away| away.dot(along) > 0.0);
    ahead.min_by(|a, b| a.cross(along).abs().total_cmp(&b.cross(along).abs())).map(|away| away.dot(along))
}

/// The price of a distance from the other rim's image.
fn unlike(away: f64) -> f32 {
    (UNLIKE * (away.abs() - ALIKE).max(0.0)).min(MOST_UNLIKE) as f32
}

/// True above a line that runs from left to right, within its columns.
fn is_above(line: &[Point], p: Point) -> bool {
    line.windows(2).any(|w| {
        let share = (p.x - w[0].x) / (w[1].x - w[0].x).max(1e-9);
        (0.0..1.0).contains(&share) && p.y < w[0].lerp(w[1], share).y
    })
}

/// The size of a lens in the search, as a factor of the mean.
fn scale(step: usize) -> f64 {
    SCALES[0] + (SCALES[1] - SCALES[0]) * step as f64 / (STEPS - 1) as f64
}

/// The border of the mean lens in a direction around its middle.
pub(super) fn lens(direction: usize) -> Vec2 {
    let along = unit_at(TAU * direction as f64 / DIRECTIONS as f64);
    let sum = (along.x.abs() / LENS.x).power(SQUARE) + (along.y.abs() / LENS.y).power(SQUARE);
    along * sum.power(-1.0 / SQUARE)
}

/// The direction across the border of the mean lens.
fn lens_normal(direction: usize) -> Vec2 {
    let along = lens((direction + 1) % DIRECTIONS) - lens((direction + DIRECTIONS - 1) % DIRECTIONS);
    Vec2::new(along.y, -along.x) / along.hypot()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rim_off_the_image_of_the_other_costs_more_the_farther_it_is() {
        let ring: Vec<Point> = (0..96).map(|i| Point::new(50.0, 20.0) + 10.0 * unit_at(TAU * f64::from(i) / 96.0)).collect();
        let reach = |along: (f64, f64)| reach_towards(&ring, Point::new(48.0, 20.0), Vec2::from(along)).expect("a reach");
        assert!((reach((1.0, 0.0)) - 12.0).abs() < 0.1 && (reach((-3.0, 0.0)) - 8.0).abs() < 0.1);
        assert_eq!(unlike(1.5), 0.0);
        assert!(unlike(-6.0) > 0.005 && unlike(6.0) < unlike(10.0) && unlike(40.0) == unlike(100.0));
        let way = Way { points: ring, contrast: 0.1, counted: 0.1 };
        let across = 2.0 * MIDDLE.x - 50.0;
        assert!(way.mirrored().iter().all(|p| (p.distance(Point::new(across, 20.0)) - 10.0).abs() < 1e-9));
    }
}
