//! Pearls as they are drawn: a ring, wider on the side away from the light, and strokes along it in the shade of large ones.

use super::creases::share;
use crate::drawing::{Mark, Stroke};
use crate::elementary::{angle_of, unit_at};
use crate::field::Curve;
use crate::geometry::{BezPath, Point, Ring, Vec2, catmull_rom};
use crate::source::Portrait;
use kurbo::Circle;
use std::f64::consts::TAU;

/// Width of the ring in pitches, where the light comes from and opposite.
const RING: [f64; 2] = [0.26, 0.55];
/// Strokes in the shade: their distance and their width in pitches, how far they reach to either side of the darkest place, in turns, and
/// the least radius that they have, in radii of the pearl: nearer its middle is its light.
const APART: f64 = 0.75;
const WIDTH: f64 = 0.4;
const REACH: f64 = 0.2;
const INNERMOST: f64 = 0.4;
/// Rings of fewer pitches are blots.
const LEAST_RADIUS: f64 = 0.7;
/// How far around a pearl its ring takes the place of lines, in radii.
const OWN: f64 = 1.4;
/// Nodes of a ring.
const NODES: usize = 16;

/// The pearls of a portrait on the page.
#[derive(Default)]
pub(super) struct Pearls {
    /// What lies inside their rings.
    pub ground: BezPath,
    pub marks: Vec<Mark>,
}

/// A pearl on the page in millimetres.
struct Round {
    centre: Point,
    radius: f64,
    pitch: f64,
    /// The direction away from the light, in radians.
    shade: f64,
}

impl Pearls {
    /// Those that are large enough to be drawn; `pitch` in working pixels.
    pub(super) fn of(portrait: &Portrait, pitch: f64) -> Self {
        let scale = portrait.placement.mm_per_pixel();
        let mut pearls = Self::default();
        for face in &portrait.faces {
            let shade = angle_of(Vec2::new(-face.lit_side(&portrait.lightness), 1.0));
            for Circle { center, radius } in large(&face.pearls, pitch) {
                let centre = portrait.placement.to_page(*center);
                let round = Round { centre, radius: radius * scale, pitch: pitch * scale, shade };
                pearls.ground.extend(round.circle());
                pearls.marks.extend(round.ring());
                pearls.marks.extend(round.strokes());
            }
        }
        pearls
    }
}

/// True for a line, in working pixels, that runs along the border of a pearl that is drawn, or over it.
pub(super) fn are_lined_by(portrait: &Portrait, pitch: f64, line: &Curve) -> bool {
    let is_near = |p: Point| {
        let worn = portrait.faces.iter().flat_map(|face| large(&face.pearls, pitch));
        worn.into_iter().any(|pearl| pearl.center.distance(p) < OWN * pearl.radius)
    };
    share(line, is_near) > 0.5
}

/// Those that are large enough to be drawn.
fn large(pearls: &[Circle], pitch: f64) -> impl Iterator<Item = &Circle> {
    pearls.iter().filter(move |pearl| pearl.radius >= LEAST_RADIUS * pitch)
}

impl Round {
    fn places(&self) -> Vec<Point> {
        (0..NODES).map(|i| self.centre + self.radius * unit_at(self.shade + TAU * i as f64 / NODES as f64)).collect()
    }

    fn circle(&self) -> BezPath {
        catmull_rom(&self.places(), Ring::Closed)
    }

    /// The ring, which begins in the shade.
    fn ring(&self) -> Option<Mark> {
        let [light, dark] = RING.map(|width| width * self.pitch);
        let width = |i: usize| f64::midpoint(light, dark) + 0.5 * (dark - light) * unit_at(TAU * i as f64 / NODES as f64).x;
        Stroke::swelling(self.circle(), (0..=NODES).map(width).collect()).map(Mark::Stroke)
    }

    /// Strokes along the ring in the shade, each shorter than the one around it.
    fn strokes(&self) -> Vec<Mark> {
        let first = self.radius - (0.5 * RING[1] + APART) * self.pitch;
        let radii = std::iter::successors(Some(first), |radius| Some(radius - APART * self.pitch));
        radii.take_while(|radius| *radius > INNERMOST * self.radius).filter_map(|radius| self.stroke(radius)).collect()
    }

    fn stroke(&self, radius: f64) -> Option<Mark> {
        let reach = REACH * radius / self.radius;
        let along = |i: usize| 2.0 * i as f64 / (NODES / 2) as f64 - 1.0;
        let place = |i: usize| self.centre + radius * unit_at(self.shade + TAU * reach * along(i));
        let places: Vec<Point> = (0..=NODES / 2).map(place).collect();
        let widths = (0..=NODES / 2).map(|i| WIDTH * self.pitch * (1.0 - along(i).powi(2)).max(0.1)).collect();
        Stroke::swelling(catmull_rom(&places, Ring::Open), widths).map(Mark::Stroke)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::form::mean_portrait;

    #[test]
    fn a_large_pearl_is_a_ring_with_its_shade_and_a_small_one_is_none() {
        let mut portrait = mean_portrait(6.0, 0.0, |_| 100);
        let centre = Point::new(20.0, 20.0);
        portrait.faces[0].pearls = vec![Circle::new(centre, 9.0), Circle::new((50.0, 20.0), 2.0)];
        let pearls = Pearls::of(&portrait, 3.0);
        let strokes: Vec<&Stroke> =
            pearls.marks.iter().filter_map(|mark| if let Mark::Stroke(stroke) = mark { Some(stroke) } else { None }).collect();
        assert!(strokes.len() >= 2 && strokes.iter().filter(|stroke| stroke.is_closed()).count() == 1, "{}", strokes.len());
        let page = portrait.placement.to_page(centre);
        let lowest = |stroke: &Stroke| stroke.nodes().map(|p| p.y - page.y).fold(f64::NEG_INFINITY, f64::max);
        assert!(strokes[1..].iter().all(|stroke| lowest(stroke) > 0.0), "the shade is below");
        let line = |x: f64| Curve { points: (0..20).map(|i| Point::new(x, 10.0 + f64::from(i))).collect(), closed: false };
        assert!(are_lined_by(&portrait, 3.0, &line(29.0)) && !are_lined_by(&portrait, 3.0, &line(40.0)));
    }
}
