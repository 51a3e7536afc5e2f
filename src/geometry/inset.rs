//! Offsetting outlines, inwards and outwards.

use super::polyline::{flatten, simplify};
use super::tangle::WideSegment;
use crate::interrupt::Interrupt;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;
use i_overlay::mesh::float::outline::offset::OutlineOffset;
use i_overlay::mesh::float::style::{LineJoin, OutlineStyle};
use kurbo::{BezPath, Point};

/// What is smaller than this share of an offset is left out before it. Unions of many strokes leave hundreds of vertices within
/// microns; round joins at each of 400 took half a minute. Ten times more shows in the offset border.
const FINEST: f64 = 0.002;

/// A filled outline, prepared for repeated offsetting.
#[derive(Clone, Debug)]
pub struct OffsetOutline {
    shapes: Vec<Vec<Vec<[f64; 2]>>>,
}

impl OffsetOutline {
    /// From closed subpaths by the nonzero rule, with curves flattened to `tolerance` and simplified to a quarter of it.
    pub fn new(outline: &BezPath, tolerance: f64) -> Self {
        Self::of(flatten(outline, tolerance).into_iter().map(|(points, _)| ring_of(points, 0.25 * tolerance)).collect())
    }

    /// The connected shapes of the union of several outlines.
    pub fn united(outlines: &[Self]) -> Vec<Self> {
        let all = outlines.iter().flat_map(|outline| outline.shapes.iter().flatten()).cloned().collect();
        Self::of(all).shapes.into_iter().map(|shape| Self { shapes: vec![shape] }).collect()
    }

    fn of(contours: Vec<Vec<[f64; 2]>>) -> Self {
        let contours: Vec<Vec<[f64; 2]>> = contours.into_iter().filter(|points| points.len() > 2).collect();
        let nothing: Vec<Vec<[f64; 2]>> = Vec::new();
        Self { shapes: contours.overlay(&nothing, OverlayRule::Subject, FillRule::NonZero) }
    }

    /// All borders, including those of holes.
    pub fn borders(&self) -> Vec<Vec<Point>> {
        self.shapes.iter().flatten().map(|ring| points(ring)).collect()
    }

    /// Number of vertices.
    pub fn len(&self) -> usize {
        self.shapes.iter().flatten().map(Vec::len).sum()
    }

    /// The sides of all borders, with zero width.
    pub fn threads(&self) -> impl Iterator<Item = WideSegment> + '_ {
        let side = |ring: &[[f64; 2]], i: usize| {
            let at = |i: usize| Point::new(ring[i % ring.len()][0], ring[i % ring.len()][1]);
            WideSegment { from: at(i), to: at(i + 1), half_width: 0.0 }
        };
        self.shapes.iter().flatten().flat_map(move |ring| (0..ring.len()).map(move |i| side(ring, i)))
    }

    /// True if nothing is inside.
    pub fn is_empty(&self) -> bool {
        self.shapes.is_empty()
    }

    /// The rings `distance` inside the border, including those around holes; empty if nothing is that far inside.
    pub fn rings(&self, distance: f64) -> Vec<Vec<Point>> {
        self.grown(-distance).borders()
    }

    /// The outline with its border moved outwards by `distance` (inwards if negative), round at corners.
    #[must_use]
    pub fn grown(&self, distance: f64) -> Self {
        let style = OutlineStyle::new(distance).line_join(LineJoin::Round(0.3));
        Self { shapes: self.simplified(FINEST * distance.abs()).shapes.outline(&style) }
    }

    /// The outline with fewer vertices, within `tolerance`.
    #[must_use]
    pub fn simplified(&self, tolerance: f64) -> Self {
        let ring = |ring: &Vec<[f64; 2]>| ring_of(points(ring), tolerance);
        let rings = |shape: &Vec<Vec<[f64; 2]>>| shape.iter().map(ring).filter(|ring| ring.len() > 2).collect::<Vec<_>>();
        Self { shapes: self.shapes.iter().map(rings).filter(|shape| !shape.is_empty()).collect() }
    }

    /// The part of this outside `other`.
    #[must_use]
    pub fn without(&self, other: &Self) -> Self {
        Self { shapes: self.shapes.overlay(&other.shapes, OverlayRule::Difference, FillRule::NonZero) }
    }

    /// Each connected shape as its rings: the border and, in the other direction, its holes.
    pub fn shapes(&self) -> impl Iterator<Item = Vec<Vec<Point>>> + '_ {
        self.shapes.iter().map(|shape| shape.iter().map(|ring| points(ring)).collect())
    }

    /// The outline as closed subpaths, to be filled by the nonzero rule.
    pub fn path(&self) -> BezPath {
        let mut path = BezPath::new();
        for ring in self.shapes.iter().flatten() {
            for (i, &[x, y]) in ring.iter().enumerate() {
                if i == 0 {
                    path.move_to((x, y));
                } else {
                    path.line_to((x, y));
                }
            }
            path.close_path();
        }
        path
    }
}

/// A closed ring's finite points, simplified to `tolerance`.
fn ring_of(mut points: Vec<Point>, tolerance: f64) -> Vec<[f64; 2]> {
    points.retain(|p| p.is_finite());
    if points.len() > 3 {
        points.push(points[0]);
        points = simplify(&points, tolerance);
        points.pop();
    }
    points.into_iter().map(|p| [p.x, p.y]).collect()
}

fn points(ring: &[[f64; 2]]) -> Vec<Point> {
    ring.iter().map(|&[x, y]| Point::new(x, y)).collect()
}

impl OffsetOutline {
    /// The parts narrower than `2 * distance`: those that a disc of radius `distance` inside the outline cannot reach. Each is
    /// given as its rings, the border first and holes in the other direction. `core` is this outline moved inwards by `distance`:
    /// the possible positions of the disc's centre. Empty once the interrupt is raised.
    pub fn narrow_parts(&self, core: &Self, distance: f64, interrupt: &Interrupt) -> Vec<Vec<Vec<Point>>> {
        // Slightly more, so that flattened corners leave no slivers.
        let reached = core.grown(1.04 * distance);
        if interrupt.is_raised() { Vec::new() } else { self.without(&reached).shapes().collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon_area;

    #[test]
    fn a_flag_s_pole_is_narrow_and_its_cloth_is_not() {
        let flag = OffsetOutline::new(&BezPath::from_svg("M0,0 H5 V3 H0.2 V9 H0 Z").unwrap(), 0.01);
        let parts = flag.narrow_parts(&flag.grown(-0.3), 0.3, &Interrupt::never());
        let area: f64 = parts.iter().map(|part| polygon_area(&part[0]).abs()).sum();
        // The pole, and the cloth's corners that no disc reaches.
        assert!((1.1..1.6).contains(&area), "{area}");
    }

    #[test]
    fn vertices_within_microns_get_no_joins() {
        // As where hundreds of strokes cross in nearly one place.
        let mut border = BezPath::from_svg("M10,0").unwrap();
        (0..500).for_each(|i| border.line_to((5.0 - 1e-5 * f64::from(i), 1e-7 * f64::from(i % 7))));
        [(0.0, 0.0), (0.0, 10.0), (10.0, 10.0)].into_iter().for_each(|corner| border.line_to(corner));
        border.close_path();
        let square = OffsetOutline::new(&border, 1e-9);
        assert!(square.len() > 100, "{}", square.len());
        let grown = square.grown(0.3);
        let area = polygon_area(&grown.borders()[0]).abs();
        assert!(grown.len() < 60, "{}", grown.len());
        assert!((area - (100.0 + 12.0 + 0.09 * std::f64::consts::PI)).abs() < 0.01, "{area}");
    }

    #[test]
    fn a_frame_shrinks_from_both_sides() {
        for text in ["M0,0 H10 V10 H0 Z M3,3 V7 H7 V3 Z", "M0,0 V10 H10 V0 Z M3,3 H7 V7 H3 Z"] {
            let insets = OffsetOutline::new(&BezPath::from_svg(text).unwrap(), 0.01);
            let mut areas: Vec<f64> = insets.rings(1.0).iter().map(|ring| polygon_area(ring).abs()).collect();
            areas.sort_unstable_by(f64::total_cmp);
            // The hole's ring has round corners: 6 x 6 less the corners' (4 - pi).
            assert_eq!(areas.len(), 2);
            assert!((areas[0] - (36.0 - (4.0 - std::f64::consts::PI))).abs() < 0.1, "{areas:?}");
            assert!((areas[1] - 64.0).abs() < 0.01, "{areas:?}");
            // The corners are the last to go: a place is at most 3 - 3 / (1 + sqrt 2) = 1.757 inside.
            assert_eq!(insets.rings(1.6).len(), 4);
            assert!(insets.rings(1.8).is_empty());
        }
    }
}
