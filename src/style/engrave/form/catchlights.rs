//! Lines end at the catchlights of eyes: a light that is as wide as the lines' distance would be crossed by one.

use super::runs::Piece;
use crate::geometry::Point;
use crate::raster::Raster;
use crate::source::{Iris, Landmarks};

/// A light lies within this many radii of an iris' middle and has less ink than this.
const WITHIN: f64 = 0.85;
const LIGHT: f32 = 0.4;
/// Parts into which a segment of a line is divided there: lights are narrower than it.
const PARTS: usize = 6;

/// Cuts the lines at the lights of irises that are as wide as a line's distance at least; `pitch` in working pixels.
pub(super) fn open_catchlights(pieces: &mut [Vec<Piece>], faces: &[Landmarks], ink: &Raster<f32>, pitch: f64) {
    let irises: Vec<Iris> = faces.iter().flat_map(|face| face.irises).filter(|iris| iris.radius > pitch).collect();
    let is_near = |p: &Point, reach: f64| irises.iter().any(|iris| iris.centre.distance(*p) < reach * iris.radius);
    let is_light = |p: &Point| is_near(p, WITHIN) && ink.sample(p.x, p.y) < LIGHT;
    for family in pieces {
        let (near, mut rest): (Vec<Piece>, Vec<Piece>) =
            std::mem::take(family).into_iter().partition(|piece| piece.nodes.iter().any(|p| is_near(p, 2.0 * WITHIN)));
        rest.extend(near.iter().flat_map(|piece| without(piece, &is_light)));
        *family = rest;
    }
}

/// The parts of a line outside lights, whole if it has none.
fn without(piece: &Piece, is_light: &dyn Fn(&Point) -> bool) -> Vec<Piece> {
    let fine = divided(piece);
    if !fine.nodes.iter().any(is_light) {
        return vec![piece.clone()];
    }
    let mut parts: Vec<Piece> = Vec::new();
    let mut from = 0;
    for run in fine.nodes.chunk_by(|a, b| is_light(a) == is_light(b)) {
        let to = from + run.len();
        if run.len() > 1 && !is_light(&run[0]) {
            let [widths, ceilings] = [&fine.widths, &fine.ceilings].map(|values| values[from..to].to_vec());
            parts.push(Piece { nodes: run.to_vec(), widths, ceilings });
        }
        from = to;
    }
    parts
}

fn divided(piece: &Piece) -> Piece {
    let last = piece.nodes.len() - 1;
    let at = |i: usize| (i / PARTS, (i % PARTS) as f64 / PARTS as f64, (i / PARTS + 1).min(last));
    let places: Vec<(usize, f64, usize)> = (0..=last * PARTS).map(at).collect();
    let between = |values: &[f64]| places.iter().map(|&(a, t, b)| values[a] + t * (values[b] - values[a])).collect();
    let nodes = places.iter().map(|&(a, t, b)| piece.nodes[a].lerp(piece.nodes[b], t)).collect();
    Piece { nodes, widths: between(&piece.widths), ceilings: between(&piece.ceilings) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_ends_on_either_side_of_a_light_between_its_nodes() {
        let nodes: Vec<Point> = (0..5).map(|i| Point::new(4.0 * f64::from(i), 5.0)).collect();
        let line = Piece { widths: vec![1.0; nodes.len()], ceilings: vec![2.0; nodes.len()], nodes };
        let parts = without(&line, &|p| (p.x - 10.0).abs() < 1.5);
        let ends: Vec<[f64; 2]> = parts.iter().map(|part| [part.nodes[0].x, part.nodes[part.nodes.len() - 1].x]).collect();
        assert_eq!(ends.len(), 2);
        assert!(ends[0][1] > 7.9 && ends[0][1] <= 8.5 && ends[1][0] >= 11.5 && ends[1][0] < 12.1, "{ends:?}");
        assert_eq!(without(&line, &|_| false)[0].nodes, line.nodes);
    }
}
