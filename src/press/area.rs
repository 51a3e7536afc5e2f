//! Areas: shrunk by the spread, without parts too narrow for print, which dots replace.

use super::Press;
use super::plan::{Plan, Speck};
use crate::drawing::{Area, Dot, Mark};
use crate::geometry::{BezPath, OffsetOutline, Point, Rect, clip_polygon, polygon_area};
use std::f64::consts::PI;

/// Flattening tolerance in millimetres: a tenth of the distance by which presses move borders.
const TOLERANCE: f64 = 0.002;
/// Minimum ink of a narrow piece, as a share of the smallest dot's. Less is the tip of a corner, which print rounds anyway.
const LEAST_SHARE: f64 = 0.25;

/// A filled outline with its border moved outwards.
pub(super) fn grown(outline: &BezPath, distance: f64) -> BezPath {
    OffsetOutline::new(outline, TOLERANCE).grown(distance).path()
}

/// The part of the area that a disc of the smallest mark can reach inside it (its opening), and dots for the rest.
pub(super) fn plan(area: &Area, press: &Press) -> Plan {
    let shape = OffsetOutline::new(&area.outline, TOLERANCE);
    let radius = press.least_printed_radius();
    let core = shape.grown(-radius);
    let outline = core.grown(0.5 * press.least).path();
    let kept = (!outline.elements().is_empty()).then_some(Mark::Area(Area { outline, colour: area.colour }));
    let disc = PI * radius * radius;
    let mut specks = Vec::new();
    for rings in shape.without(&core.grown(radius)).shapes() {
        if signed_area(&rings).abs() < LEAST_SHARE * disc {
            continue;
        }
        // A square with the disc's area contains at most a disc's ink.
        for (at, ink) in squares(rings, PI.sqrt() * radius) {
            let mark = Mark::Dot(Dot { colour: area.colour, ..Dot::circle(at, 0.5 * press.least) });
            specks.push(Speck { at, share: ink / disc, mark });
        }
    }
    Plan::Specks(kept, specks)
}

fn signed_area(rings: &[Vec<Point>]) -> f64 {
    rings.iter().map(|ring| polygon_area(ring)).sum()
}

/// Halves a shape until its parts fit into squares of this side. Returns the centroid and the area of each part.
fn squares(rings: Vec<Vec<Point>>, side: f64) -> Vec<(Point, f64)> {
    let (mut parts, mut out) = (vec![rings], Vec::new());
    while let Some(rings) = parts.pop() {
        let Some(bounds) = bounds(&rings) else { continue };
        if bounds.width().max(bounds.height()) <= side {
            out.push((middle(&rings).unwrap_or(bounds.center()), signed_area(&rings).abs()));
            continue;
        }
        let Point { x, y } = bounds.center();
        let halves = if bounds.width() > bounds.height() {
            [Rect { x1: x, ..bounds }, Rect { x0: x, ..bounds }]
        } else {
            [Rect { y1: y, ..bounds }, Rect { y0: y, ..bounds }]
        };
        for half in halves {
            let cut = rings.iter().map(|ring| clip_polygon(ring, half)).filter(|ring| polygon_area(ring) != 0.0).collect();
            parts.push(cut);
        }
    }
    out
}

fn bounds(rings: &[Vec<Point>]) -> Option<Rect> {
    rings.iter().flatten().map(|p| Rect::from_points(*p, *p)).reduce(|a, b| a.union(b))
}

/// The centroid.
fn middle(rings: &[Vec<Point>]) -> Option<Point> {
    let origin = *rings.first()?.first()?;
    let (mut sum, mut twice) = (kurbo::Vec2::ZERO, 0.0);
    for ring in rings {
        for (i, p) in ring.iter().enumerate() {
            let (a, b) = (*p - origin, ring[(i + 1) % ring.len()] - origin);
            sum += (a + b) * a.cross(b);
            twice += a.cross(b);
        }
    }
    (twice != 0.0).then(|| origin + sum / (3.0 * twice))
}
