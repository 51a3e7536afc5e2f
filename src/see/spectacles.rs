//! Spectacles: dark lines that close around both eyes and meet over the nose.
//!
//! ```text
//!   window   the eyes level, 100 pixels apart
//!   rims     around each eye the closed way that is darkest against both its sides (dynamic programming in polar coordinates), the two alike
//!            above and below the eyes (`rims.rs`)
//!   bridge   the darkest way from rim to rim
//!   gate     lids, brows and folds close around no eye, or nothing crosses the nose
//!   edges    without dark rims, but with a bridge that is no fold: the same ways along the light edges of lenses
//!   temples  from the rims outward, as far as they are dark
//! ```

use super::networks::sixteenths;
use super::rims::{Eye, Rim, rims};
use super::view::{Outside, View, Window};
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Rect, Vec2};
use crate::raster::{Raster, best_way, filled_polygon, median};
use crate::source::{Iris, Spectacles, lab, lightness, luminance, outlines, srgb_to_linear};

/// Distance of the eyes in the window, its size, and the place midway between the eyes.
pub(super) const APART: f64 = 100.0;
const SIZE: [usize; 2] = [320, 160];
pub(super) const MIDDLE: Point = Point::new(160.0, 65.0);
/// Least distance of the eyes in pixels of the view: below it a thin rim is lost.
const LEAST_APART: f64 = 60.0;
/// Distances at which a line is compared with its sides; those of a thick line, and the lightness below which it may be thick; and the limits of what one place counts: black rims on pale skin differ by ten
/// times as much as wire ones.
const BESIDE: [f64; 2] = [2.5, 5.0];
const BESIDE_THICK: [f64; 2] = [6.0, 8.0];
const BLACK: f32 = 0.2;
const COUNTS: [f32; 2] = [-0.012, 0.093];
/// Rows that are searched for the bridge, per pixel and around the eyes; price of a bend of bridge or temple, and of each row between
/// a rim's end and the bridge's.
const ROWS_PER_PIXEL: f64 = 2.0;
const BRIDGE_ROWS: [f64; 2] = [-28.0, 40.0];
const BRIDGE_BEND: f32 = 0.003;
const OFF_END: f32 = 0.001;
/// Lower lines of the brows, from left to right in the window.
const BROWS: [[usize; 5]; 2] = [[46, 53, 52, 65, 55], [285, 295, 282, 283, 276]];
/// Least mean contrast of each rim and of the bridge. Of sixteen portraits the five with rims have at least 0.062 and 0.057, Grace Hopper 0.065 and
/// 0.084; the fainter rim of the nine without spectacles has at most 0.038, of thirty other people 0.042. Two with lenses that have no rims fail
/// at 0.022 and 0.025. Of the other people one wears spectacles, in a dark photograph: 0.063 and 0.043.
const RIM_GATE: f32 = 0.05;
const BRIDGE_GATE: f32 = 0.04;
/// Half the width of the nose where a bridge crosses it, and its usual row there from the middle between the eyes; the lowest row of a bridge, as
/// nostrils are below it; and the least contrast, in the mean and of all but the weakest fifth, of one that tells spectacles without dark rims.
/// Two people with such lenses have 0.088 and 0.093, 0.075 and 0.049; of thirty without spectacles, who have folds there, at most 0.053 and
/// 0.028.
const NOSE: [f64; 2] = [16.0, -5.0];
const LOWEST_BRIDGE: f64 = 24.0;
const BRIDGE_ALONE: [f32; 2] = [0.065, 0.035];
/// What the colourfulness (C* of CIELAB) of that bridge may be at most, as a share of the skin's above and below it, in photographs where that
/// skin has some: in a fold light goes from skin to skin, and it is as colourful as the skin or more. Two bridges have 0.83 and 0.64, folds of
/// eight people 1.0 to 1.09, one of them darker than the second bridge (0.078 and 0.064); that of a ninth, far too light for a bridge, has 0.84.
const BRIDGE_COLOUR: f32 = 0.97;
const COLOURLESS: f32 = 4.0;
/// How far above and below the bridge the skin's colour is taken.
const OFF_BRIDGE: f64 = 6.0;
/// Least mean contrast of the edge of each lens below such a bridge: those two have at least 0.035 and 0.039.
const EDGE_GATE: f32 = 0.025;
/// Contrast that each pixel of a temple must have on average.
const TEMPLE: f32 = 0.025;
/// Points of the mesh beside the ears, and the least length of a temple.
const EARS: [usize; 2] = [234, 454];
const LEAST_TEMPLE: usize = 6;
/// Limits of the frame's width.
const WIDTHS: [f64; 2] = [1.5, 9.0];

/// The spectacles before these eyes, if there are any.
pub(super) fn spectacles(view: &View, points: &[[f64; 3]], irises: &[Iris; 2]) -> Option<Spectacles> {
    let [right, left] = irises.map(|iris| iris.centre);
    let apart = left - right;
    if apart.hypot() / view.step().x < LEAST_APART {
        return None;
    }
    let across = apart / APART;
    let down = Vec2::new(-across.y, across.x);
    let origin = right.midpoint(left) - across * MIDDLE.x - down * MIDDLE.y;
    let window = Window { origin, across: across * SIZE[0] as f64, down: down * SIZE[1] as f64 };
    let seen = view.resampled_to(&window, SIZE, Outside::Repeated);
    let ears = EARS.map(|ear| (Point::new(points[ear][0], points[ear][1]) - origin).dot(across) / across.hypot2());
    let in_window = |point: &usize| {
        let away = Point::new(points[*point][0], points[*point][1]) - origin;
        Point::new(away.dot(across) / across.hypot2(), away.dot(down) / down.hypot2())
    };
    let line = |of: &[usize]| of.iter().map(in_window).collect::<Vec<Point>>();
    let corners: Vec<[f64; 2]> = outlines::OVAL.iter().map(in_window).map(|p| [p.x, p.y]).collect();
    let light = Light {
        seen: seen.map(|rgb| lightness(luminance(rgb.map(|v| srgb_to_linear(v / 255.0))))),
        colour: seen.map(|rgb| chroma(rgb.map(|v| srgb_to_linear(v / 255.0)))),
        face: filled_polygon(SIZE[0], SIZE[1], &corners),
    };
    let eyes = [(&outlines::RIGHT_EYE, &BROWS[0]), (&outlines::LEFT_EYE, &BROWS[1])]
        .map(|(lids, brow)| Eye { lids: bounds(&line(lids)), brow: line(brow) });
    let found = frame(&light, ears, &eyes)?;
    let place = |p: Point| {
        let p = origin + across * p.x + down * p.y;
        Point::new(sixteenths(p.x), sixteenths(p.y))
    };
    Some(found.placed(place, across.hypot()))
}

/// C* of CIELAB of a linear colour.
fn chroma(linear: [f32; 3]) -> f32 {
    let [_, a, b] = lab(linear);
    a.hypotenuse(b)
}

fn bounds(points: &[Point]) -> Rect {
    points.iter().fold(Rect::from_points(points[0], points[0]), |bounds, p| bounds.union_pt(*p))
}

/// A line in the window, and its mean contrast to both its sides.
pub(super) struct Way {
    pub points: Vec<Point>,
    pub contrast: f32,
    /// What its places count together, by which rims are compared, with the price of being unlike the other.
    pub counted: f32,
}

impl Way {
    /// Its farthest point to the left (-1) or to the right (1).
    fn farthest(&self, side: f64) -> Point {
        self.points.iter().copied().fold(self.points[0], |best, p| if side * (p.x - best.x) > 0.0 { p } else { best })
    }
}

/// The frame in the window; `ears` are the columns where temples end.
fn frame(light: &Light, ears: [f64; 2], eyes: &[Eye; 2]) -> Option<Spectacles> {
    let ([right, left], kind) = framed(light, eyes).or_else(|| frameless(light, eyes))?;
    let bridge = light.bridge(right.farthest(1.0), left.farthest(-1.0))?;
    if bridge.contrast < BRIDGE_GATE {
        return None;
    }
    let [right_end, left_end] = [right.farthest(-1.0), left.farthest(1.0)];
    let temples = [light.temple(right_end, ears[0]), light.temple(left_end, ears[1])];
    let width = match kind {
        Rim::Dark => median([&right, &left].iter().flat_map(|rim| light.widths(&rim.points)).collect())?,
        Rim::Edge => WIDTHS[0] as f32,
    };
    Some(Spectacles {
        rims: [right.points, left.points],
        bridge: bridge.points,
        temples,
        width: f64::from(width).clamp(WIDTHS[0], WIDTHS[1]),
    })
}

/// Rims with a dark frame, if both are dark enough.
fn framed(light: &Light, eyes: &[Eye; 2]) -> Option<([Way; 2], Rim)> {
    let rims = rims(light, eyes, Rim::Dark);
    rims.iter().all(|rim| rim.contrast >= RIM_GATE).then_some((rims, Rim::Dark))
}

/// The edges of lenses without a dark frame all around, below a bridge that is dark by itself.
fn frameless(light: &Light, eyes: &[Eye; 2]) -> Option<([Way; 2], Rim)> {
    if !light.has_bridge_alone() {
        return None;
    }
    let rims = rims(light, eyes, Rim::Edge);
    rims.iter().all(|rim| rim.contrast >= EDGE_GATE).then_some((rims, Rim::Edge))
}

/// What the window shows.
pub(super) struct Light {
    /// Lightness, 0 to 1.
    seen: Raster<f32>,
    /// C* of CIELAB.
    colour: Raster<f32>,
    /// Not 0 in the face's oval.
    face: Raster<u8>,
}

impl Light {
    fn at(&self, p: Point) -> f32 {
        self.seen.sample(p.x, p.y)
    }

    pub(super) fn is_in_face(&self, p: Point) -> bool {
        let at = |v: f64, count: usize| (v.max(0.0) as usize).min(count - 1);
        self.face.get(at(p.x, self.face.width()), at(p.y, self.face.height())) != 0
    }

    /// How much darker a place is than both its sides at some distance.
    fn below(&self, p: Point, across: Vec2) -> f32 {
        self.at(p + across).min(self.at(p - across)) - self.at(p)
    }

    /// How much darker a place is than both its sides at the distance where it differs most.
    fn contrast(&self, p: Point, across: Vec2) -> f32 {
        let [near, far] = BESIDE.map(|away| self.below(p, across * away));
        near.max(far).clamp(COUNTS[0], COUNTS[1])
    }

    /// The same as the mean of two distances: rims are sharp, folds are darkest far from their sides. A black line may be thick.
    pub(super) fn sharp_contrast(&self, p: Point, across: Vec2) -> f32 {
        let mean = |beside: [f64; 2]| {
            let [near, far] = beside.map(|away| self.below(p, across * away));
            f32::midpoint(near, far)
        };
        let thin = mean(BESIDE);
        let contrast = if self.at(p) < BLACK { thin.max(mean(BESIDE_THICK)) } else { thin };
        contrast.clamp(COUNTS[0], COUNTS[1])
    }

    /// How much lighter a place is than both its sides, as the mean of two distances.
    pub(super) fn light_contrast(&self, p: Point, across: Vec2) -> f32 {
        let [near, far] = BESIDE.map(|away| self.at(p) - self.at(p + across * away).max(self.at(p - across * away)));
        f32::midpoint(near, far).clamp(COUNTS[0], COUNTS[1])
    }

    /// True if a line crosses the nose between the eyes that is so dark all along that it is no fold.
    fn has_bridge_alone(&self) -> bool {
        let from = MIDDLE + Vec2::new(-NOSE[0], NOSE[1]);
        let columns = (2.0 * NOSE[0]) as usize;
        let (way, mut contrasts) = self.level_way(from, 1.0, columns, MIDDLE.y + BRIDGE_ROWS[0], None);
        let lowest = way.iter().fold(0.0, |lowest: f64, p| lowest.max(p.y - MIDDLE.y));
        let mean = contrasts.iter().sum::<f32>() / columns as f32;
        contrasts.sort_unstable_by(f32::total_cmp);
        lowest < LOWEST_BRIDGE && mean >= BRIDGE_ALONE[0] && contrasts[columns / 5] >= BRIDGE_ALONE[1] && !self.is_fold(&way)
    }

    /// True if a dark line across the nose is as colourful as the skin above and below it.
    fn is_fold(&self, way: &[Point]) -> bool {
        let mean = |down: f64| way.iter().map(|p| self.colour.sample(p.x, p.y + down)).sum::<f32>() / way.len() as f32;
        let skin = f32::midpoint(mean(-OFF_BRIDGE), mean(OFF_BRIDGE));
        skin > COLOURLESS && mean(0.0) > BRIDGE_COLOUR * skin
    }

    /// The darkest way over the nose between the rims' inner ends; none if these meet.
    fn bridge(&self, from: Point, to: Point) -> Option<Way> {
        let columns = (to.x - from.x).round() as usize;
        if to.x <= from.x || columns < 6 {
            return None;
        }
        let (inner, contrasts) = self.level_way(from, 1.0, columns, MIDDLE.y + BRIDGE_ROWS[0], Some(to));
        let contrast = contrasts.iter().sum::<f32>() / columns as f32;
        Some(Way { points: std::iter::once(from).chain(inner).chain([to]).collect(), contrast, counted: contrast })
    }

    /// The way from a rim's outer end to the ear, as far as it is dark; empty if it is not.
    fn temple(&self, from: Point, ear: f64) -> Vec<Point> {
        let side = (from.x - MIDDLE.x).signum();
        let columns = (side * (ear - from.x)).clamp(0.0, SIZE[0] as f64) as usize;
        if columns < LEAST_TEMPLE {
            return Vec::new();
        }
        let top = from.y + 0.5 * (BRIDGE_ROWS[0] - BRIDGE_ROWS[1]);
        let (way, contrasts) = self.level_way(from, side, columns, top, None);
        let (mut sum, mut best, mut length) = (0.0, 0.0, 0);
        for (column, contrast) in contrasts.iter().enumerate() {
            sum += contrast - TEMPLE;
            if sum > best {
                (best, length) = (sum, column + 1);
            }
        }
        if length < LEAST_TEMPLE {
            return Vec::new();
        }
        std::iter::once(from).chain(way).take(length + 1).collect()
    }

    /// The darkest way sideways (-1 left, 1 right) over a number of columns, below `top`, from beside a place and to beside an end if one
    /// is given; and the contrast at each of its points.
    fn level_way(&self, from: Point, side: f64, columns: usize, top: f64, end: Option<Point>) -> (Vec<Point>, Vec<f32>) {
        let count = ((BRIDGE_ROWS[1] - BRIDGE_ROWS[0]) * ROWS_PER_PIXEL) as usize;
        let place = |column: usize, row: usize| Point::new(from.x + side * column as f64, top + row as f64 / ROWS_PER_PIXEL);
        let value = |column: usize, row: usize| self.contrast(place(column, row), Vec2::new(0.0, 1.0));
        let priced = Raster::from_fn(count, columns, |row, column| {
            let beside = if column == 0 { Some(from) } else { end.filter(|_| column + 1 == columns) };
            let off = beside.map_or(0.0, |end| (place(column, row).y - end.y).abs() as f32);
            value(column, row) - OFF_END * ROWS_PER_PIXEL as f32 * off
        });
        let rows = best_way(&priced, 3, BRIDGE_BEND);
        let each = || rows.iter().copied().enumerate();
        (each().map(|(column, row)| place(column, row)).collect(), each().map(|(column, row)| value(column, row)).collect())
    }

    /// Widths of a closed dark line at its points: between the places where it is half as dark as in its middle.
    fn widths(&self, rim: &[Point]) -> Vec<f32> {
        let count = rim.len();
        let width = |i: usize| {
            let along = rim[(i + 1) % count] - rim[(i + count - 1) % count];
            let across = Vec2::new(-along.y, along.x) / along.hypot().max(1e-9);
            let far = BESIDE[1] + 1.0;
            let beside = self.at(rim[i] + across * far).min(self.at(rim[i] - across * far));
            let half = f32::midpoint(beside, self.at(rim[i]));
            let reach =
                |side: f64| (1..=12).map(|n| 0.5 * f64::from(n)).find(|away| self.at(rim[i] + across * (side * away)) > half);
            (reach(1.0).unwrap_or(far) + reach(-1.0).unwrap_or(far) - 0.5) as f32
        };
        (0..count).map(width).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::rims::{DIRECTIONS, lens};
    use super::*;
    use crate::geometry::resample;

    /// Skin with brows, eyes and a soft shadow, and with lines of a frame of a width drawn over it.
    fn face(lines: &[Vec<Point>], width: f64) -> Light {
        face_behind(lines, width, 0.3)
    }

    /// The same with lines of a lightness.
    fn face_behind(lines: &[Vec<Point>], width: f64, light: f32) -> Light {
        let spots: Vec<Point> = lines.iter().flat_map(|line| resample(line, 1.0)).collect();
        let eyes = [-50.0, 50.0].map(|x| MIDDLE + Vec2::new(x, 0.0));
        let seen = Raster::from_fn(SIZE[0], SIZE[1], |x, y| {
            let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
            let is_eye = eyes.iter().any(|eye| ((p.x - eye.x) / 24.0).powi(2) + ((p.y - eye.y) / 9.0).powi(2) < 1.0);
            let is_brow = eyes.iter().any(|eye| (p.x - eye.x).abs() < 28.0 && (p.y - eye.y + 25.0).abs() < 4.0);
            let is_frame = spots.iter().any(|spot| spot.distance(p) < 0.5 * width);
            let skin = 0.65 + 0.1 * ((x as f32) / 320.0);
            match (is_frame, is_eye || is_brow) {
                (true, _) => light,
                (false, true) => 0.3,
                (false, false) => skin,
            }
        });
        let face = seen.map(|_| 1);
        // As in a photograph of metal and skin.
        let colour = seen.map(|light| if light > 0.5 { 30.0 } else { 10.0 });
        Light { seen, colour, face }
    }

    /// Eyes of the size drawn by `face`.
    fn eyes() -> [Eye; 2] {
        [-50.0, 50.0].map(|x| Eye { lids: Rect::from_center_size(MIDDLE + Vec2::new(x, 0.0), (48.0, 18.0)), brow: Vec::new() })
    }

    /// Oval rims, a bridge, and one temple.
    fn drawn() -> Vec<Vec<Point>> {
        let oval = |side: f64| {
            let point = |i: i32| MIDDLE + Vec2::new(side * 53.0, 8.0) + 1.1 * lens(i as usize % DIRECTIONS);
            (0..=DIRECTIONS as i32).map(point).collect::<Vec<_>>()
        };
        let line =
            |from: [f64; 2], to: [f64; 2]| vec![MIDDLE + Vec2::from((from[0], from[1])), MIDDLE + Vec2::from((to[0], to[1]))];
        vec![oval(-1.0), oval(1.0), line([-5.0, 4.0], [5.0, 4.0]), line([101.0, 0.0], [130.0, -4.0])]
    }

    #[test]
    fn rims_bridge_and_temple_are_found_where_they_are_and_no_spectacles_on_a_bare_face() {
        assert!(frame(&face(&[], 0.0), [20.0, 300.0], &eyes()).is_none(), "brows and eyes are no spectacles");
        let lines = drawn();
        let found = frame(&face(&lines, 3.0), [20.0, 300.0], &eyes()).expect("spectacles");
        for (rim, drawn) in found.rims.iter().zip(&lines) {
            let worst =
                rim.iter().map(|p| drawn.iter().map(|q| p.distance(*q)).fold(f64::INFINITY, f64::min)).fold(0.0, f64::max);
            assert!(worst < 4.0, "{worst}");
        }
        assert!((2.0..4.5).contains(&found.width), "{}", found.width);
        assert!(found.temples[0].is_empty(), "nothing is drawn there");
        assert!(found.temples[1].last().expect("a temple").x > MIDDLE.x + 120.0);
    }

    #[test]
    fn rims_without_a_bridge_are_none() {
        assert!(frame(&face(&drawn()[..2], 3.0), [20.0, 300.0], &eyes()).is_none());
    }

    #[test]
    fn lenses_without_a_frame_are_found_by_their_bridge_and_their_light_edges() {
        let lines = drawn();
        let mut light = face_behind(&lines[..2], 2.0, 0.85);
        assert!(frame(&light, [20.0, 300.0], &eyes()).is_none(), "light lines without a bridge");
        for x in 138..182 {
            (68..71).for_each(|y| light.seen.set(x, y, 0.3));
        }
        assert!(frame(&light, [20.0, 300.0], &eyes()).is_none(), "a fold, of the skin's colour");
        for x in 138..182 {
            (68..71).for_each(|y| light.colour.set(x, y, 10.0));
        }
        let found = frame(&light, [20.0, 300.0], &eyes()).expect("spectacles");
        let off = |p: &Point| lines[0].iter().chain(&lines[1]).map(|q| p.distance(*q)).fold(f64::INFINITY, f64::min);
        let near = found.rims.iter().flatten().filter(|p| off(p) < 4.0).count();
        assert!(near > 170, "{near} of 192 points");
        assert_eq!(found.width, WIDTHS[0]);
    }
}
