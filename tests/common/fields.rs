//! Fields of known direction, and a score of how well dots align with one.
#![allow(dead_code)]

use drypoint::field::{StripeLattice, StripeParameters, Wave, crossings, stripes};
use drypoint::geometry::{Point, Vec2};
use drypoint::raster::Raster;

pub const PITCH: f64 = 6.0;

/// A field's tangent at a point.
pub type Field = Box<dyn Fn(Point) -> Vec2 + Sync>;

pub fn turned(v: Vec2, degrees: f64) -> Vec2 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    Vec2::new(v.x * cos - v.y * sin, v.x * sin + v.y * cos)
}

/// Parallel at five angles, circular, spiral and saddle, each with its name and, where it has one, its centre.
pub fn known_fields(centre: Point) -> Vec<(String, Option<Point>, Field)> {
    let mut fields: Vec<(String, Option<Point>, Field)> = [0.0, 17.0, 30.0, 45.0, 71.0]
        .into_iter()
        .map(|angle| {
            let field: Field = Box::new(move |_| turned(Vec2::new(1.0, 0.0), angle));
            (format!("parallel {angle}"), None, field)
        })
        .collect();
    let circular: Field = Box::new(move |p| (p - centre).turn_90().normalize());
    let spiral: Field = Box::new(move |p| turned((p - centre).normalize(), 55.0));
    let saddle: Field = Box::new(move |p| Vec2::new(p.x - centre.x, centre.y - p.y).normalize());
    for (name, field) in [("circular", circular), ("spiral", spiral), ("saddle", saddle)] {
        fields.push((name.to_owned(), Some(centre), field));
    }
    fields
}

/// The style's defaults, in pixels.
pub const DEFAULTS: StripeParameters = StripeParameters { step: 0.5 * PITCH, window: 4.0, rounds: 5, levels: 5 };

/// A random number from 0 to 1 for each node.
pub fn noise(seed: u64) -> impl Fn(u64) -> f32 + Sync {
    move |n| {
        let mut h = (n + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (seed + 1).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        h ^= h >> 31;
        h = h.wrapping_mul(0x94d0_49bb_1331_11eb);
        h ^= h >> 29;
        (h >> 40) as f32 / (1_u64 << 24) as f32
    }
}

/// Unit vectors across (turned) or along a field.
pub fn unit_raster(field: &Field, (width, height): (usize, usize), is_turned: bool) -> Raster<[f32; 2]> {
    Raster::from_fn(width, height, |x, y| {
        let t = field(Point::new(x as f64 + 0.5, y as f64 + 0.5));
        let n = if is_turned { t.turn_90() } else { t };
        [n.x as f32, n.y as f32]
    })
}

/// Both families of stripes from random phases.
pub fn both_families(field: &Field, size: (usize, usize), seed: u64) -> [StripeLattice; 2] {
    [true, false].map(|is_turned| {
        let wave: Raster<Wave> = unit_raster(field, size, is_turned).map(|[x, y]| [x / PITCH as f32, y / PITCH as f32]);
        let random = noise(2 * seed + u64::from(is_turned));
        stripes(&wave, DEFAULTS, &|node, _, _| random(node), None)
    })
}

pub fn dots_of(families: &[StripeLattice; 2]) -> Vec<Point> {
    crossings(&families[0], &families[1], &|_| 0.6 * PITCH)
}

/// How well dots align with a field.
#[derive(Debug)]
pub struct Score {
    /// Mean angle between the direction to a neighbour and the nearest of tangent and normal.
    pub degrees: f64,
    /// Coefficient of variation of the distances.
    pub variation: f64,
    /// Number of dots counted.
    pub count: usize,
}

/// Over pairs of dots closer than 1.6 pitches among the four nearest; the field is sampled half way between them.
pub fn score(dots: &[Point], pitch: f64, field: &dyn Fn(Point) -> Option<Vec2>, inside: &dyn Fn(Point) -> bool) -> Score {
    let (mut angles, mut distances, mut count) = (Vec::new(), Vec::new(), 0);
    let mut sorted = dots.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x));
    for (i, a) in sorted.iter().enumerate().filter(|(_, p)| inside(**p)) {
        count += 1;
        let reach = 1.6 * pitch;
        let left = sorted[..i].iter().rev().take_while(|b| a.x - b.x < reach);
        let right = sorted[i + 1..].iter().take_while(|b| b.x - a.x < reach);
        let mut near: Vec<(f64, Point)> = left.chain(right).map(|b| (a.distance(*b), *b)).filter(|(d, _)| *d < reach).collect();
        near.sort_by(|x, y| x.0.total_cmp(&y.0));
        for (d, b) in near.into_iter().take(4) {
            distances.push(d);
            if let Some(t) = field(a.midpoint(b)) {
                let way = (b - *a).normalize();
                let angle = way.cross(t).atan2(way.dot(t)).to_degrees().rem_euclid(90.0);
                angles.push(angle.min(90.0 - angle));
            }
        }
    }
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
    let m = mean(&distances);
    let variance = distances.iter().map(|d| (d - m).powi(2)).sum::<f64>() / distances.len() as f64;
    Score { degrees: mean(&angles), variation: variance.sqrt() / m, count }
}
