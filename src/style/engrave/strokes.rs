//! From pieces of lines to marks on the page.

use super::breaks::{Piece, taper_at};
use super::lines::{FIT_ROOM, Family, Line};
use crate::drawing::{Dot, Mark, Stroke};
use crate::geometry::{BezPath, Ends, FitTolerance, Graph, GraphNode};

/// Maximum length of a piece of a stroke's curve, in millimetres: longer ones are halved on nearly any form.
const LONGEST_PIECE: f64 = 8.0;
/// Maximum error of the width, as a fraction of the pitch; the mean ink is exact regardless.
const WIDTH_TOLERANCE: f64 = 0.03;
/// Widths below this draw no ink, in millimetres.
const NO_INK: f64 = 1e-4;

/// The mark of a piece; none if it has no ink.
pub(super) fn mark(family: &Family, line: &Line, piece: &Piece) -> Option<Mark> {
    let graph = Graph { first: family.first + line.first as f64 * family.step, step: family.step, heights: &line.heights };
    match piece {
        Piece::Dot { at, radius } => {
            Some(Mark::Dot(Dot::circle(family.frame.to_page(*at, graph.height(*at)), *radius))).filter(|_| *radius > NO_INK)
        }
        Piece::Dash { places, tapers } => stroke(family, graph, places, *tapers),
    }
}

fn stroke(family: &Family, graph: Graph<'_>, places: &[(f64, f64)], tapers: [f64; 2]) -> Option<Mark> {
    let (from, to) = (places[0].0, places[places.len() - 1].0);
    if places.iter().all(|(_, width)| *width < NO_INK) {
        return None;
    }
    let width = |u: f64| {
        let i = places.partition_point(|(at, _)| *at < u).clamp(1, places.len() - 1);
        let ((a, wa), (b, wb)) = (places[i - 1], places[i]);
        let t = ((u - a) / (b - a).max(1e-12)).clamp(0.0, 1.0);
        (wa * (1.0 - t) + wb * t) * taper_at(u, from, to, tapers)
    };
    let mut through = vec![from];
    through.extend([from + tapers[0], to - tapers[1]].into_iter().filter(|u| *u > from + 1e-6 && *u < to - 1e-6));
    through.push(to);
    through.dedup_by(|b, a| *b <= *a + 1e-6);
    let tolerance = FitTolerance { height: 0.75 * FIT_ROOM, width: WIDTH_TOLERANCE * family.pitch, piece: LONGEST_PIECE };
    let nodes = graph.fit(&through, width, tolerance);
    let stroke = Stroke::swelling(curve(family, &nodes), nodes.iter().map(|n| n.width).collect())?;
    Some(Mark::Stroke(stroke.with_ends(Ends::Flat)))
}

fn curve(family: &Family, nodes: &[GraphNode]) -> BezPath {
    let mut path = BezPath::new();
    path.move_to(family.frame.to_page(nodes[0].at, nodes[0].height));
    for pair in nodes.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let third = (b.at - a.at) / 3.0;
        path.curve_to(
            family.frame.to_page(a.at + third, a.height + third * a.slope_after),
            family.frame.to_page(b.at - third, b.height - third * b.slope_before),
            family.frame.to_page(b.at, b.height),
        );
    }
    path
}
