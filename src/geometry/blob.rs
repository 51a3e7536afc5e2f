//! Ink blobs: the dot of a hand-held pen as a closed smooth outline (Bruehl 2023, section 4.4 asks for a dictionary of them).

use crate::elementary::{Elementary as _, unit_at};
use kurbo::{BezPath, Point, Shape, Vec2};
use rand::{Rng, RngExt};
use std::f64::consts::TAU;

/// Number of lobes of a blob's outline. Six keep the path under 250 bytes; fewer look like bent ellipses, more are lost in print.
const NODES: usize = 6;

/// An irregular outline around `centre` with exactly the area of a disc of `radius`.
///
/// `irregularity` runs from 0 (a circle) to 1 (radii vary by about a third, angles by a quarter of their step).
pub fn blob(centre: Point, radius: f64, irregularity: f64, random: &mut impl Rng) -> BezPath {
    let turn: f64 = random.random_range(0.0..TAU);
    let mut nodes = [Vec2::ZERO; NODES];
    for (i, node) in nodes.iter_mut().enumerate() {
        let step = TAU / NODES as f64;
        let angle = turn + step * (i as f64 + irregularity * random.random_range(-0.25..0.25));
        let stretch = 1.0 + irregularity * random.random_range(-0.33..0.33);
        *node = unit_at(angle) * stretch;
    }
    let unit = closed_spline(&nodes);
    let scale = radius * (std::f64::consts::PI / unit.area().abs()).sqrt();
    // Centred on its centroid, so that a lopsided blob stays in line with its row.
    let weight = centroid(&unit);
    let place = kurbo::Affine::translate(centre.to_vec2()) * kurbo::Affine::scale(scale) * kurbo::Affine::translate(-weight);
    place * unit
}

/// A smooth closed curve through the nodes whose handles follow the circle's: 4/3 tan(step/4) of the radius.
fn closed_spline(nodes: &[Vec2; NODES]) -> BezPath {
    let handle = 4.0 / 3.0 * (TAU / NODES as f64 / 4.0).tangent();
    let tangent = |i: usize| {
        let chord = nodes[(i + 1) % NODES] - nodes[(i + NODES - 1) % NODES];
        chord.normalize() * nodes[i].hypot() * handle
    };
    let mut path = BezPath::new();
    path.move_to(nodes[0].to_point());
    for i in 0..NODES {
        let j = (i + 1) % NODES;
        path.curve_to((nodes[i] + tangent(i)).to_point(), (nodes[j] - tangent(j)).to_point(), nodes[j].to_point());
    }
    path.close_path();
    path
}

/// Centroid of a closed path, from a fine polygon.
fn centroid(path: &BezPath) -> Vec2 {
    let polygon = super::flatten(path, 0.002).swap_remove(0).0;
    let (mut sum, mut area) = (Vec2::ZERO, 0.0);
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let cross = a.to_vec2().cross(b.to_vec2());
        sum += (a.to_vec2() + b.to_vec2()) * cross;
        area += cross;
    }
    sum / (3.0 * area)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand::rngs::ChaCha8Rng;

    #[test]
    fn a_blob_has_the_disc_s_area_and_differs_from_the_next() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let first = blob(Point::new(3.0, 4.0), 0.5, 0.8, &mut random);
        let second = blob(Point::new(3.0, 4.0), 0.5, 0.8, &mut random);
        for outline in [&first, &second] {
            assert!((outline.area().abs() - std::f64::consts::PI * 0.25).abs() < 1e-9);
            assert!(outline.bounding_box().center().distance(Point::new(3.0, 4.0)) < 0.15);
        }
        assert_ne!(first, second);
    }

    #[test]
    fn without_irregularity_it_is_a_circle() {
        let outline = blob(Point::ORIGIN, 2.0, 0.0, &mut ChaCha8Rng::seed_from_u64(2));
        for segment in outline.segments() {
            use kurbo::ParamCurve;
            for t in [0.0, 0.3, 0.5, 0.9] {
                assert!((segment.eval(t).to_vec2().hypot() - 2.0).abs() < 0.01);
            }
        }
    }
}
