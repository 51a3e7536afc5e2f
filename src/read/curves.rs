//! usvg's paths as curves in millimetres, and tests on them: flat, self-crossing, circular.

use crate::drawing::{Colour, Dot};
use crate::geometry::{Affine, BezPath, Point};
use kurbo::{PathEl, Shape};
use usvg::tiny_skia_path::PathSegment;

/// Millimetres per CSS pixel, the unit of usvg.
pub(super) const MM_PER_PX: f64 = 25.4 / 96.0;

pub(super) fn to_mm(t: usvg::Transform) -> Affine {
    Affine::scale(MM_PER_PX) * affine(t)
}

pub(super) fn affine(t: usvg::Transform) -> Affine {
    Affine::new([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from))
}

pub(super) fn bez_path(path: &usvg::tiny_skia_path::Path) -> BezPath {
    let point = |p: usvg::tiny_skia_path::Point| Point::new(f64::from(p.x), f64::from(p.y));
    path.segments()
        .map(|segment| match segment {
            PathSegment::MoveTo(p) => PathEl::MoveTo(point(p)),
            PathSegment::LineTo(p) => PathEl::LineTo(point(p)),
            PathSegment::QuadTo(a, p) => PathEl::QuadTo(point(a), point(p)),
            PathSegment::CubicTo(a, b, p) => PathEl::CurveTo(point(a), point(b), point(p)),
            PathSegment::Close => PathEl::ClosePath,
        })
        .collect()
}

/// True if an outline encloses no area: its points lie on one line.
pub(super) fn is_flat(curve: &BezPath) -> bool {
    let mut area = 0.0;
    let (mut start, mut last) = (Point::ORIGIN, Point::ORIGIN);
    for element in curve.elements() {
        let points: &[Point] = match element {
            PathEl::MoveTo(p) => {
                (start, last) = (*p, *p);
                &[]
            }
            PathEl::LineTo(p) => &[*p],
            PathEl::QuadTo(a, p) => &[*a, *p],
            PathEl::CurveTo(a, b, p) => &[*a, *b, *p],
            PathEl::ClosePath => &[],
        };
        for p in points {
            area += (last - start).cross(*p - start).abs();
            last = *p;
        }
    }
    area < 2e-5
}

/// True if the even-odd and nonzero fill rules could differ. They cannot for a path of straight lines with at most two `LineTo`s.
pub(super) fn has_crossings(curve: &BezPath) -> bool {
    let lines = curve.elements().iter().filter(|element| matches!(element, PathEl::LineTo(_))).count();
    let others = curve.elements().iter().filter(|element| matches!(element, PathEl::QuadTo(..) | PathEl::CurveTo(..))).count();
    lines > 2 || others > 0
}

/// The curve with every subpath closed, as a fill does.
pub(super) fn with_closed_subpaths(curve: &BezPath) -> BezPath {
    let mut closed = BezPath::new();
    for mut piece in subpaths(curve) {
        if !matches!(piece.elements().last(), Some(PathEl::ClosePath)) {
            piece.close_path();
        }
        closed.extend(piece);
    }
    closed
}

/// The subpaths of a curve; a bare move is not one.
pub(super) fn subpaths(curve: &BezPath) -> Vec<BezPath> {
    let mut pieces: Vec<BezPath> = Vec::new();
    for element in curve.elements() {
        if let PathEl::MoveTo(_) = element {
            pieces.push(BezPath::new());
        }
        if let Some(piece) = pieces.last_mut() {
            piece.push(*element);
        }
    }
    pieces.retain(|piece| piece.elements().len() > 1);
    pieces
}

/// A path of a `dots` group as a dot: a circle if it fills its bounding box like one, else a blob.
pub(super) fn dot(outline: BezPath, colour: Option<Colour>) -> Dot {
    let bounds = outline.bounding_box();
    let area = outline.area().abs();
    let radius = 0.25 * (bounds.width() + bounds.height());
    let disc = std::f64::consts::PI * radius * radius;
    let is_circle = (bounds.width() - bounds.height()).abs() < 0.002 + 0.002 * radius && (area / disc - 1.0).abs() < 0.003;
    if is_circle && outline.elements().len() < 12 {
        Dot { centre: bounds.center(), radius, outline: None, colour }
    } else {
        Dot { centre: bounds.center(), radius: (area / std::f64::consts::PI).sqrt(), outline: Some(Box::new(outline)), colour }
    }
}
