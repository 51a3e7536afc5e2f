//! Light irises as they are drawn: a black pupil, a dark rim, and little between them; as discs of black, blue and green eyes stare.

use super::solids::inside_outlines;
use crate::drawing::{Mark, Stroke};
use crate::elementary::unit_at;
use crate::geometry::{BezPath, Point, Ring, Vec2, catmull_rom};
use crate::raster::{Raster, median};
use crate::source::{Iris, Landmarks, Placement, Portrait, outlines};

/// The pupil and the rim, in radii of the iris.
const PUPIL: f64 = 0.42;
const RIM: [f64; 2] = [0.84, 1.02];
/// What lies between them, where its ink tells whether the iris is light: at most this. The tone of faces gives brown ones 0.96, light ones at
/// most 0.7.
const BETWEEN: [f64; 2] = [0.48, 0.8];
const MOST_INK: f32 = 0.86;
/// Catchlights have less ink than this, and a dark border as wide as this, in radii.
const LIGHT: f32 = 0.4;
const BORDER: f64 = 0.16;
/// Spokes reach from here to there, in radii; their distance in pitches, their fewest, and their width at full ink in shares of that distance: with
/// more, the iris is black in print.
const SPOKE: [f64; 2] = [0.52, 0.8];
const SPACING: f64 = 0.5;
const FEWEST: f64 = 9.0;
const MOST_WIDTH: f32 = 0.7;
const WIDTH: f32 = 0.65;
/// How much wider they are by the ink of the eye's white: light irises in shade would glare (13). And where that lies, in radii, and which share of
/// it is the white.
const IN_SHADE: f32 = 1.0;
const AROUND: [f64; 2] = [1.1, 1.9];
const WHITE: f64 = 0.25;
/// Shade of the upper lid on the iris, in radii.
const SHADE: f64 = 0.24;
/// The least of an iris that is seen between the lids: in narrower eyes it is the only dark.
const SEEN: f64 = 0.5;
/// The least radius in pitches, and in pixels: smaller ones have no rim to see, and their few spokes are splinters.
const LEAST_RADIUS: f64 = 1.5;
const LEAST_PIXELS: f64 = 4.0;

/// A light iris that is large enough to be drawn.
pub(super) struct DrawnIris {
    iris: Iris,
    /// 1 between the lids.
    open: Raster<f32>,
    /// From the chin to the forehead, of length 1.
    up: Vec2,
}

/// The light irises of a portrait by its ink; `pitch` in working pixels.
pub(super) fn light_irises(portrait: &Portrait, ink: &Raster<f32>, pitch: f64) -> Vec<DrawnIris> {
    let of_face = |face: &Landmarks| {
        let opening =
            |outline: &[usize]| inside_outlines(std::slice::from_ref(face), [outline, outline], (ink.width(), ink.height()));
        let up = (face.point(10) - face.point(152)).normalize();
        let opens = [opening(&outlines::RIGHT_EYE), opening(&outlines::LEFT_EYE)];
        let eyes: Vec<DrawnIris> = face.irises.into_iter().zip(opens).map(|(iris, open)| DrawnIris { iris, open, up }).collect();
        if eyes.iter().all(|eye| eye.is_light(ink, pitch)) { eyes } else { Vec::new() }
    };
    portrait.faces.iter().flat_map(of_face).collect()
}

impl DrawnIris {
    /// Whether it is seen, and light.
    fn is_light(&self, ink: &Raster<f32>, pitch: f64) -> bool {
        if self.iris.radius < (LEAST_RADIUS * pitch).max(LEAST_PIXELS) {
            return false;
        }
        let is_open = |(x, y, _): &(usize, usize, f64)| self.open.get(*x, *y) > 0.5;
        let all = self.pixels(ink, [0.0, 1.0]);
        let seen = all.iter().filter(|pixel| is_open(pixel)).count();
        let between = self.pixels(ink, BETWEEN).into_iter().filter(is_open);
        let between = median(between.map(|(x, y, _)| ink.get(x, y)).collect());
        seen as f64 > SEEN * all.len() as f64 && between.is_some_and(|ink| ink < MOST_INK)
    }

    /// Pupil, rim, the border of the light and the shade of the lid in the darkness of features, 0 to 1, in place of what is there.
    pub(super) fn draw(&self, dark: &mut Raster<f32>, ink: &Raster<f32>) {
        let radius = self.iris.radius;
        let light = self.light(ink);
        for (x, y, away) in self.pixels(ink, [0.0, RIM[1]]).into_iter().filter(|(x, y, _)| self.open.get(*x, *y) > 0.5) {
            let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
            let from_light = light.iter().map(|light| light.distance(p)).fold(f64::INFINITY, f64::min);
            let inside = (PUPIL - away).max((away - RIM[0]).min(RIM[1] - away)).max(BORDER - from_light / radius) * radius;
            let lid = p + SHADE * radius * self.up;
            let shade = 1.0 - self.open.sample(lid.x, lid.y);
            let share = shade.max((inside + 0.5).clamp(0.0, 1.0) as f32);
            dark.set(x, y, if from_light < 0.1 { 0.0 } else { share });
        }
    }

    /// The middles of the pixels that are the iris' catchlight.
    fn light(&self, ink: &Raster<f32>) -> Vec<Point> {
        let bright = self.pixels(ink, [0.0, RIM[0]]).into_iter();
        let bright = bright.filter(|(x, y, _)| self.open.get(*x, *y) > 0.5 && ink.get(*x, *y) < LIGHT);
        bright.map(|(x, y, _)| Point::new(x as f64 + 0.5, y as f64 + 0.5)).collect()
    }

    /// Spokes between pupil and rim, on the page, as wide as the ink there, and the rim.
    pub(super) fn spokes(&self, placement: &Placement, ink: &Raster<f32>, pitch: f64) -> Vec<Mark> {
        let middle = f64::midpoint(SPOKE[0], SPOKE[1]) * self.iris.radius;
        let share = WIDTH + IN_SHADE * self.ink_of_white(ink);
        let count = (std::f64::consts::TAU * middle / (SPACING * pitch)).round().max(FEWEST);
        let spacing = std::f64::consts::TAU * middle / count;
        let spoke = |i: usize| {
            let along = unit_at(std::f64::consts::TAU * (i as f64 + 0.5) / count);
            let [from, mid, to] =
                [SPOKE[0] * self.iris.radius, middle, SPOKE[1] * self.iris.radius].map(|away| self.iris.centre + away * along);
            let at = |raster: &Raster<f32>, p: Point| raster.sample(p.x, p.y);
            let is_seen = [from, mid, to].iter().all(|p| at(&self.open, *p) > 0.5 && at(ink, *p) > LIGHT);
            let width = f64::from((share * at(ink, mid)).min(MOST_WIDTH)) * spacing * placement.mm_per_pixel();
            let mut line = BezPath::new();
            line.move_to(placement.to_page(from));
            line.line_to(placement.to_page(to));
            is_seen.then(|| Mark::Stroke(Stroke::even(line, width)))
        };
        (0..count as usize).filter_map(spoke).chain(self.rim(placement, ink)).collect()
    }

    /// The rim in strokes on the page, where lids and light leave it: in a small iris it is narrower than a pixel.
    fn rim(&self, placement: &Placement, ink: &Raster<f32>) -> Vec<Mark> {
        /// Places around it.
        const PLACES: usize = 48;
        let away = f64::midpoint(RIM[0], RIM[1]) * self.iris.radius;
        let width = (RIM[1] - RIM[0]) * self.iris.radius * placement.mm_per_pixel();
        let place = |i: usize| self.iris.centre + away * unit_at(std::f64::consts::TAU * i as f64 / PLACES as f64);
        let is_seen = |p: &Point| self.open.sample(p.x, p.y) > 0.5 && ink.sample(p.x, p.y) > LIGHT;
        // From a hidden place on, so that no run is cut where the count begins.
        let first = (0..PLACES).find(|i| !is_seen(&place(*i))).unwrap_or(0);
        let places: Vec<Point> = (first..=first + PLACES).map(place).collect();
        let runs = places.chunk_by(|a, b| is_seen(a) == is_seen(b)).filter(|run| is_seen(&run[0]) && run.len() > 2);
        let stroke = |run: &[Point]| {
            let run: Vec<Point> = run.iter().map(|p| placement.to_page(*p)).collect();
            Mark::Stroke(Stroke::even(catmull_rom(&run, Ring::Open), width))
        };
        runs.map(stroke).collect()
    }

    /// The ink of the eye's white, 0 if it is hidden.
    fn ink_of_white(&self, ink: &Raster<f32>) -> f32 {
        let around = self.pixels(ink, AROUND).into_iter().filter(|(x, y, _)| self.open.get(*x, *y) > 0.5);
        let mut values: Vec<f32> = around.map(|(x, y, _)| ink.get(x, y)).collect();
        values.sort_unstable_by(f32::total_cmp);
        values.get((WHITE * values.len() as f64) as usize).copied().unwrap_or(0.0)
    }

    /// 1 on the iris between the lids, within its rim.
    pub(super) fn ground(&self) -> Raster<f32> {
        let mut ground = self.open.map(|_| 0.0);
        for (x, y, _) in self.pixels(&self.open, [0.0, RIM[0]]) {
            ground.set(x, y, self.open.get(x, y));
        }
        ground
    }

    /// The pixels between two distances from the middle, with theirs; in radii.
    fn pixels(&self, raster: &Raster<f32>, [from, to]: [f64; 2]) -> Vec<(usize, usize, f64)> {
        let Iris { centre, radius } = self.iris;
        let range = |middle: f64, size: usize| {
            let end = |v: f64| (v.max(0.0) as usize).min(size);
            end(middle - to * radius)..end((middle + to * radius).ceil())
        };
        let (columns, rows) = (range(centre.x, raster.width()), range(centre.y, raster.height()));
        let places = rows.flat_map(|y| columns.clone().map(move |x| (x, y)));
        let away = |(x, y): (usize, usize)| (x, y, centre.distance(Point::new(x as f64 + 0.5, y as f64 + 0.5)) / radius);
        places.map(away).filter(|(_, _, away)| (from..to).contains(away)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Rect;

    /// An eye of 60 by 40 pixels around an iris, with this ink between pupil and rim and a catchlight.
    fn eye(between: f32) -> (DrawnIris, Raster<f32>) {
        let iris = Iris { centre: Point::new(60.0, 40.0), radius: 20.0 };
        let open = Raster::from_fn(120, 80, |x, y| f32::from(u8::from((30..90).contains(&x) && (20..60).contains(&y))));
        let ink = Raster::from_fn(120, 80, |x, y| {
            let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
            match iris.centre.distance(p) / iris.radius {
                _ if p.distance(Point::new(66.0, 34.0)) < 4.0 => 0.0,
                away if away < PUPIL || (RIM[0]..RIM[1]).contains(&away) => 1.0,
                away if away < 1.0 => between,
                _ => 0.1,
            }
        });
        (DrawnIris { iris, open, up: Vec2::new(0.0, -1.0) }, ink)
    }

    #[test]
    fn an_iris_is_light_by_its_ink_and_by_its_size() {
        let is_light = |between: f32, pitch: f64| {
            let (iris, ink) = eye(between);
            iris.is_light(&ink, pitch)
        };
        assert!(is_light(0.6, 10.0));
        assert!(!is_light(0.96, 10.0), "brown");
        assert!(!is_light(0.6, 30.0), "smaller than a dot");
    }

    #[test]
    fn a_light_iris_has_pupil_rim_light_and_the_shade_of_the_lid() {
        let (iris, ink) = eye(0.6);
        let mut dark = Raster::filled(120, 80, 0.5);
        iris.draw(&mut dark, &ink);
        assert_eq!([dark.get(56, 42), dark.get(41, 40), dark.get(60, 22)], [1.0; 3], "pupil, rim and shade");
        assert_eq!([dark.get(66, 34), dark.get(60, 53)], [0.0; 2], "light and ground");
        assert_eq!(dark.get(10, 10), 0.5, "outside");
        assert!(dark.get(71, 34) > 0.9, "the border of the light");
        assert_eq!([iris.ground().get(60, 53), iris.ground().get(60, 62)], [1.0, 0.0]);
    }

    #[test]
    fn spokes_reach_from_pupil_to_rim_and_leave_the_light() {
        let (iris, ink) = eye(0.6);
        let placement = Placement::new(Rect::new(0.0, 0.0, 120.0, 80.0), 1.0);
        let spokes = iris.spokes(&placement, &ink, 10.0);
        let (rims, spokes): (Vec<Mark>, Vec<Mark>) =
            spokes.into_iter().partition(|mark| matches!(mark, Mark::Stroke(stroke) if stroke.curve().elements().len() > 3));
        assert!((10..17).contains(&spokes.len()) && (1..4).contains(&rims.len()), "{} {}", spokes.len(), rims.len());
        let within = Rect::from_center_size((60.0, 40.0), (34.0, 34.0));
        assert!(
            spokes
                .iter()
                .all(|spoke| matches!(spoke, Mark::Stroke(stroke) if within.contains(stroke.curve().control_box().center())))
        );
    }
}
