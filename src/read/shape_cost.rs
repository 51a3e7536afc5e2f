//! What one shape costs: its path data, its circles and its corners.

use crate::elementary::Elementary as _;
use roxmltree::Node;

/// 1 if each shape gets its own copy, in units of its bounding box; else 0.
pub(super) fn single(node: Node<'_, '_>) -> f64 {
    let is_of_box = |attribute: &str| node.attribute(attribute) == Some("objectBoundingBox");
    let is_of_page = |attribute: &str| node.attribute(attribute) == Some("userSpaceOnUse");
    let is_shared = match node.tag_name().name() {
        "clipPath" => !is_of_box("clipPathUnits"),
        "mask" => is_of_page("maskUnits") && !is_of_box("maskContentUnits"),
        "pattern" => is_of_page("patternUnits") && !is_of_box("patternContentUnits"),
        "filter" => is_of_page("filterUnits") && !is_of_box("primitiveUnits"),
        _ => is_of_page("gradientUnits"),
    };
    f64::from(u8::from(!is_shared))
}

/// A shape's numbers of segments and subpaths. `None` for an element that is not a shape.
pub(super) fn shape(node: Node<'_, '_>) -> Option<(f64, f64)> {
    let longest = |names: [&str; 2]| names.into_iter().filter_map(|name| pixels(node.attribute(name)?)).fold(0.0, f64::max);
    match node.tag_name().name() {
        "path" => Some(segments(node.attribute("d").unwrap_or_default())),
        "polyline" | "polygon" => {
            Some((svgtypes::PointsParser::from(node.attribute("points").unwrap_or_default()).count() as f64, 1.0))
        }
        "rect" if !node.has_attribute("rx") && !node.has_attribute("ry") => Some((4.0, 1.0)),
        "rect" => Some((4.0 + curves(longest(["rx", "ry"])), 1.0)),
        "circle" => Some((1.0 + curves(longest(["r", "r"])), 1.0)),
        "ellipse" => Some((1.0 + curves(longest(["rx", "ry"])), 1.0)),
        "line" => Some((2.0, 1.0)),
        _ => None,
    }
}

/// Extra segments per squared number of an arc's curves: svgtypes removes each curve from the front of a list of them all. An arc
/// of 1e30 pixels counts as 40,000 curves here and takes three seconds. Arcs on any real sheet have ten.
const SHIFTED: f64 = 1e-3;

/// How far from where it should an arc may end, in its radii: the next one begins there.
const ROUNDING: f64 = 1e-14;

/// Number of curves that a whole ellipse becomes, at the tolerance of 0.1 pixel that usvg gives kurbo.
pub(super) fn curves(radius: f64) -> f64 {
    match (1.1163 * radius.abs() / 0.1).power(1.0 / 6.0) {
        number if number <= 4.0 => 4.0,
        // Each quarter is rounded up.
        number => number.ceil() + 4.0,
    }
}

/// A length in pixels; an upper estimate where it depends on other elements.
fn pixels(text: &str) -> Option<f64> {
    use svgtypes::LengthUnit as Unit;
    let length: svgtypes::Length = text.parse().ok()?;
    let unit = match length.unit {
        Unit::None | Unit::Px => 1.0,
        Unit::In | Unit::Cm | Unit::Mm | Unit::Pt | Unit::Pc => 96.0,
        Unit::Em | Unit::Ex | Unit::Percent => 1e6,
    };
    Some(length.number * unit)
}

/// Segments and subpaths of path data, its arcs as curves.
pub(super) fn segments(data: &str) -> (f64, f64) {
    let (mut segments, mut subpaths) = (0.0, 0.0);
    // Upper bound of the distance of all points so far from the origin.
    let mut reach: f64 = 0.0;
    for segment in svgtypes::PathParser::from(data).map_while(Result::ok) {
        let (x, y) = match segment {
            svgtypes::PathSegment::MoveTo { x, y, .. } => {
                subpaths += 1.0;
                (x, y)
            }
            svgtypes::PathSegment::EllipticalArc { abs, rx, ry, large_arc, x, y, .. } => {
                let chord = x.hypotenuse(y) + if abs { reach } else { 0.0 };
                // Radii too small for the chord are scaled up until they fit.
                let radius = rx.abs().max(ry.abs()) * (chord / rx.abs().min(ry.abs())).max(1.0);
                // The smaller radius bounds the sweep: a tall ellipse goes half round within a short chord.
                let part = if large_arc { 1.0 } else { (chord / (4.0 * rx.abs().min(ry.abs()).max(chord))).min(0.5) };
                let curves = (curves(radius) * part).max(0.0);
                segments += 1.0 + curves + SHIFTED * curves * curves;
                reach += ROUNDING * radius;
                (x, y)
            }
            svgtypes::PathSegment::LineTo { x, y, .. }
            | svgtypes::PathSegment::CurveTo { x, y, .. }
            | svgtypes::PathSegment::SmoothCurveTo { x, y, .. }
            | svgtypes::PathSegment::Quadratic { x, y, .. }
            | svgtypes::PathSegment::SmoothQuadratic { x, y, .. } => {
                segments += 1.0;
                (x, y)
            }
            svgtypes::PathSegment::HorizontalLineTo { x, .. } => {
                segments += 1.0;
                (x, 0.0)
            }
            svgtypes::PathSegment::VerticalLineTo { y, .. } => {
                segments += 1.0;
                (0.0, y)
            }
            svgtypes::PathSegment::ClosePath { .. } => {
                segments += 1.0;
                (0.0, 0.0)
            }
        };
        reach += x.abs() + y.abs();
    }
    (segments, subpaths)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_after_a_huge_one_begins_where_rounding_left_it() {
        let (alone, _) = segments("M0 0A5 5 0 0 1 10 10");
        let (thin, _) = segments("M0 0A1e-30 5 0 0 1 10 10");
        let (after, _) = segments("M0 0A1e23 1e23 0 0 1 10 10A1e-30 5 0 0 1 10 10");
        assert!(alone < 10.0 && thin < 1e7, "{alone} {thin}");
        assert!(after > 1e9, "{after}");
    }
}
