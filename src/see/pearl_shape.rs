//! The circle of a pearl: its bright spot lies aside, and is smaller than it.

use super::jewellery::{RADIUS, Spot};
use crate::elementary::unit_at;
use crate::geometry::{Point, Vec2};
use crate::raster::{Raster, median};
use kurbo::Circle;
use std::f64::consts::TAU;

/// Radii that are tried, in those of the spot, how many, and the largest in widths of the face; and how far the centre is moved, in radii of
/// the spot, in steps of so much.
const RADII: [f64; 2] = [0.75, 2.6];
const TRIED: usize = 16;
const LARGEST: f64 = 0.05;
const MOVED: f64 = 0.7;
const STEP: f64 = 0.2;
/// Places of a circle where the difference across it is taken; half the distance of that, in radii and in pixels at least.
const PLACES: usize = 24;
const ACROSS: f64 = 0.18;
const LEAST_ACROSS: f64 = 0.7;
/// The most that one place counts, in lightness: a larger value finds the pearl's highlight.
const MOST: f32 = 0.08;
/// Difference from which a place is on the border, and the share of them from which a circle is a pearl: on forty-three photographs those of
/// necklaces have 0.83 and more, squares of a shirt 0.75 to 0.88.
const BORDER: f32 = 0.03;
const LEAST_SHARE: f64 = 0.83;
/// The fewest pearls of a string, and the least radius in pixels.
const STRING: usize = 4;
const LEAST_RADIUS: f64 = 3.0;
/// The least radius of a pearl on a string, in shares of the room that its neighbours leave; how many of the nearest tell what is usual; and the
/// share of their distance at which two spots are on one pearl.
const LEAST_OF_ROOM: f64 = 0.7;
const NEAR: usize = 5;
const OF_ONE: f64 = 0.7;

/// A circle around a spot and the share of its border that is seen.
struct Border {
    pearl: Circle,
    share: f64,
}

/// The pearls of a string, each as large as its neighbours leave room for, and as they are; none if only a few are round. All in pixels of
/// the lightness.
pub(super) fn strung(light: &Raster<f32>, spots: &[Spot], width: f64) -> Vec<Circle> {
    let spots = one_each(spots);
    let rooms = rooms(&spots);
    let pearls: Vec<Circle> = spots
        .iter()
        .zip(&rooms)
        .filter_map(|(spot, room)| Some((seen(light, spot, width)?, room)))
        .map(|(pearl, room)| Circle::new(pearl.center, pearl.radius.clamp(LEAST_OF_ROOM * room, *room)))
        .collect();
    let even = |pearl: &Circle| {
        let near = nearest(&pearls, |other| other.center.distance(pearl.center));
        let radius = median(near.map(|other| other.radius as f32).collect()).map_or(pearl.radius, f64::from);
        Circle { radius, ..*pearl }
    };
    if pearls.len() < STRING { Vec::new() } else { pearls.iter().map(even).collect() }
}

/// Half the distance of each spot from its nearest.
fn rooms(spots: &[Spot]) -> Vec<f64> {
    let room = |(i, spot): (usize, &Spot)| {
        let others = spots.iter().enumerate().filter(|(k, _)| *k != i);
        0.5 * others.map(|(_, other)| other.centre.distance(spot.centre)).fold(f64::INFINITY, f64::min)
    };
    spots.iter().enumerate().map(room).collect()
}

/// The firmest spot of each pearl: what is much nearer than the spots of a string are to one another lies on one pearl.
fn one_each(spots: &[Spot]) -> Vec<Spot> {
    let rooms = rooms(spots);
    let typical = |spot: &Spot| {
        let with_rooms: Vec<(&Spot, f64)> = spots.iter().zip(rooms.iter().copied()).collect();
        let near = nearest(&with_rooms, |(other, _)| other.centre.distance(spot.centre));
        median(near.map(|(_, room)| *room as f32).collect()).map_or(0.0, f64::from)
    };
    let is_own = |spot: &Spot| {
        let reach = 2.0 * OF_ONE * typical(spot);
        spots.iter().all(|other| other.curved <= spot.curved || other.centre.distance(spot.centre) >= reach)
    };
    spots.iter().filter(|spot| is_own(spot)).copied().collect()
}

/// The nearest few by a distance.
fn nearest<T>(all: &[T], distance: impl Fn(&T) -> f64) -> impl Iterator<Item = &T> {
    let mut near: Vec<(f64, &T)> = all.iter().map(|each| (distance(each), each)).collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    near.into_iter().take(NEAR).map(|(_, each)| each)
}

/// The pearl around a spot; none if it has no round border.
pub(super) fn seen(light: &Raster<f32>, spot: &Spot, width: f64) -> Option<Circle> {
    let own = RADIUS * spot.scale;
    let most = (LARGEST * width).max(own).min(RADII[1] * own);
    let radii = (0..TRIED).map(|i| RADII[0] * own + (most - RADII[0] * own) * i as f64 / (TRIED - 1) as f64);
    let steps = (MOVED / STEP) as i32;
    let moves = (-steps..=steps).flat_map(|x| (-steps..=steps).map(move |y| (f64::from(x), f64::from(y))));
    let centres: Vec<Point> = moves
        .filter(|(x, y)| x * x + y * y <= (MOVED / STEP) * (MOVED / STEP))
        .map(|(x, y)| spot.centre + STEP * own * Point::new(x, y).to_vec2())
        .collect();
    let circles = radii.flat_map(|radius| centres.iter().map(move |centre| Circle::new(*centre, radius)));
    let best = circles.map(|pearl| scored(light, pearl, own)).reduce(|best, each| if each.0 > best.0 { each } else { best })?;
    let Border { pearl, share } = best.1;
    let is_inside = |p: Point| {
        let (x, y) = (light.width() as f64, light.height() as f64);
        p.x >= pearl.radius && p.y >= pearl.radius && p.x <= x - pearl.radius && p.y <= y - pearl.radius
    };
    (share >= LEAST_SHARE && pearl.radius >= LEAST_RADIUS && is_inside(pearl.center)).then_some(pearl)
}

/// How well a circle lies on the border of a light disc.
fn scored(light: &Raster<f32>, pearl: Circle, own: f64) -> (f64, Border) {
    let half = (ACROSS * pearl.radius).max(LEAST_ACROSS);
    let at = |radius: f64, out: Vec2| {
        let p = pearl.center + radius * out;
        light.sample(p.x, p.y)
    };
    let differences = (0..PLACES).map(|i| {
        let out = unit_at(TAU * i as f64 / PLACES as f64);
        at(pearl.radius - half, out) - at(pearl.radius + half, out)
    });
    let (sum, seen) = differences.fold((0.0, 0), |(sum, seen), difference| {
        (sum + f64::from(difference.clamp(-MOST, MOST)), seen + usize::from(difference > BORDER))
    });
    // Of two good circles the larger is the pearl, the other its highlight.
    let score = sum / PLACES as f64 * (pearl.radius / own).sqrt();
    (score, Border { pearl, share: seen as f64 / PLACES as f64 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_border_of_a_pearl_is_found_around_its_highlight() {
        let discs = |centres: &[f64]| {
            Raster::from_fn(160, 60, |x, y| {
                let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
                let is_on = |radius: f64, off: f64| centres.iter().any(|x| p.distance(Point::new(*x - off, 30.0 - off)) < radius);
                if is_on(3.0, 3.0) {
                    0.95
                } else if is_on(9.0, 0.0) {
                    0.7
                } else {
                    0.4_f32
                }
            })
        };
        let spot = |x: f64| Spot { centre: Point::new(x - 3.0, 27.0), scale: 4.0, curved: 0.1 };
        let pearl = seen(&discs(&[40.0]), &spot(40.0), 200.0).expect("a pearl");
        assert!((pearl.radius - 9.0).abs() < 1.0 && pearl.center.distance(Point::new(40.0, 30.0)) < 2.0, "{pearl:?}");
        assert!(seen(&Raster::from_fn(160, 60, |x, _| if x < 40 { 0.7 } else { 0.4 }), &spot(40.0), 200.0).is_none());
        let string = [30.0, 50.0, 70.0, 90.0, 110.0];
        let spots = string.map(spot);
        assert_eq!(strung(&discs(&string), &spots, 200.0).len(), 5);
        assert!(strung(&discs(&string[..3]), &spots[..3], 200.0).is_empty());
    }
}
