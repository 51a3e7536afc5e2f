//! The outline of a stroke whose width varies along it.

use kurbo::{BezPath, CubicBez, ParamCurve, ParamCurveArclen, ParamCurveDeriv, PathEl, PathSeg, Point, Rect, Shape, Vec2};

/// The shape of a stroke's two ends, if its width there is not 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ends {
    /// Half a disc beyond the curve's end.
    #[default]
    Round,
    /// Cut square at the curve's end.
    Flat,
}

/// Maximum number of halvings of a segment to follow its side; what remains is a cusp, a 64th of the segment long.
const MOST_HALVINGS: usize = 6;

/// Length of a curve to 1e-6 mm.
pub fn curve_length(path: &BezPath) -> f64 {
    path.segments().map(|segment| segment_length(segment, 1e-6)).sum()
}

/// Length of a segment. Kurbo gives NaN for a quadratic whose points coincide; this gives 0.
pub fn segment_length(segment: PathSeg, accuracy: f64) -> f64 {
    let length = segment.arclen(accuracy);
    if length.is_nan() { 0.0 } else { length }
}

/// The closed outline of a stroke along `curve`, with full width `widths[i]` at the i-th node (the start, then the end of each
/// segment). Between nodes the width changes smoothly, without overshoot.
///
/// Each side is a chain of cubics with the ends and end tangents of the true offset curve; a segment is halved until its quarter
/// points are within `tolerance` of it. No handle is longer than its chord (a half circle's is two thirds of it): where the line
/// turns tighter than its half width, the offset curve's own handles are far too long. Ends are half discs or, with
/// [`Ends::Flat`], square. Only the first subpath is used.
///
/// # Panics
/// If `widths` does not have one entry per node.
pub fn swelling_outline(curve: &BezPath, widths: &[f64], ends: Ends, tolerance: f64) -> BezPath {
    let pieces = pieces(curve, widths);
    let mut outline = BezPath::new();
    let (Some(first), Some(last)) = (pieces.first(), pieces.last()) else { return outline };
    let closed = matches!(curve.elements().last(), Some(PathEl::ClosePath));
    outline.move_to(pieces[0].side(0.0, 1.0).0);
    for piece in &pieces {
        meet(&mut outline, piece.side(0.0, 1.0).0);
        piece.append_side(&mut outline, 0.0, 1.0, 1.0, tolerance, 0);
    }
    if closed {
        outline.close_path();
        outline.move_to(pieces[pieces.len() - 1].side(1.0, -1.0).0);
    } else {
        append_cap(&mut outline, last.curve.p3, tangent(&last.curve, 1.0), last.to.0, ends);
    }
    for piece in pieces.iter().rev() {
        meet(&mut outline, piece.side(1.0, -1.0).0);
        piece.append_side(&mut outline, 1.0, 0.0, -1.0, tolerance, 0);
    }
    if !closed {
        append_cap(&mut outline, first.curve.p0, -tangent(&first.curve, 0.0), first.from.0, ends);
    }
    outline.close_path();
    outline
}

/// Appends a straight line to the start of the next piece's side, if it is not there already (at a corner of the line).
fn meet(outline: &mut BezPath, side: Point) {
    if outline.elements().last().and_then(PathEl::end_point).is_some_and(|end| end.distance(side) > 1e-6) {
        outline.line_to(side);
    }
}

/// Points along a swelling stroke at most `spacing` apart, with the full width of its outline there.
///
/// # Panics
/// If `widths` does not have one entry per node.
pub fn sample_swelling(curve: &BezPath, widths: &[f64], spacing: f64) -> Vec<(Point, f64)> {
    let mut samples = Vec::new();
    for piece in pieces(curve, widths) {
        let steps = (piece.curve.arclen(1e-3) / spacing).ceil().max(1.0) as usize;
        for step in usize::from(!samples.is_empty())..=steps {
            let t = step as f64 / steps as f64;
            samples.push((piece.curve.eval(t), piece.width(t).0));
        }
    }
    samples
}

/// A point on a swelling stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// Point on the centre line.
    pub at: Point,
    /// Unit tangent of the centre line.
    pub along: Vec2,
    /// Full width.
    pub width: f64,
    /// Position by nodes: the segment's index plus its parameter.
    pub node: f64,
}

/// A part of a swelling stroke, from one station to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stretch {
    /// Along this curve, an exact part of the stroke's.
    Curve(CubicBez),
    /// A straight line, for a short part.
    Straight,
}

/// A swelling stroke as stations, each with the stretch that leads to it from the one before. If `is_clear` is true for the
/// bounding box of a stretch's ink, the stretch is kept as a curve; else it is cut into pieces of at most `spacing`.
///
/// # Panics
/// If `widths` does not have one entry per node.
pub fn stations(curve: &BezPath, widths: &[f64], spacing: f64, is_clear: impl Fn(Rect) -> bool) -> Vec<(Station, Stretch)> {
    let kept = curve.segments().enumerate().filter(|(_, s)| is_long(s)).map(|(i, _)| i as f64);
    let mut stations = Vec::new();
    for (piece, first) in pieces(curve, widths).iter().zip(kept) {
        if stations.is_empty() {
            stations.push((piece.station(0.0, first), Stretch::Straight));
        }
        piece.append_stations(&mut stations, 0.0, 1.0, first, spacing, &is_clear);
    }
    stations
}

/// The stroke's segments, each with the width and its slope at both ends.
fn pieces(curve: &BezPath, widths: &[f64]) -> Vec<Swelling> {
    assert_eq!(widths.len(), curve.segments().count() + 1, "a width for each node");
    let kept: Vec<(CubicBez, f64)> = curve.segments().filter(is_long).map(|s| with_length(to_cubic(s))).collect();
    let widths = kept_widths(curve, widths);
    let slopes = width_slopes(&kept, &widths);
    let piece = |(i, &(curve, length)): (usize, &(CubicBez, f64))| Swelling {
        curve,
        length,
        from: (widths[i], slopes[i]),
        to: (widths[i + 1], slopes[i + 1]),
    };
    kept.iter().enumerate().map(piece).collect()
}

/// True for a segment that is longer than nothing.
pub(super) fn is_long(segment: &PathSeg) -> bool {
    let cubic = segment.to_cubic();
    [(cubic.p0, cubic.p1), (cubic.p1, cubic.p2), (cubic.p2, cubic.p3)].into_iter().any(|(a, b)| (b - a).hypot() > 1e-9)
}

fn with_length(curve: CubicBez) -> (CubicBez, f64) {
    (curve, curve.arclen(1e-4))
}

fn to_cubic(segment: PathSeg) -> CubicBez {
    match segment {
        // A straight segment as an evenly parametrised cubic.
        PathSeg::Line(l) => CubicBez::new(l.p0, l.p0.lerp(l.p1, 1.0 / 3.0), l.p0.lerp(l.p1, 2.0 / 3.0), l.p1),
        PathSeg::Quad(q) => q.raise(),
        PathSeg::Cubic(c) => c,
    }
}

/// Widths at the nodes that remain when segments of zero length are dropped.
fn kept_widths(curve: &BezPath, widths: &[f64]) -> Vec<f64> {
    let mut kept = vec![widths[0].max(0.0)];
    for (segment, &width) in curve.segments().zip(&widths[1..]) {
        if is_long(&segment) {
            kept.push(width.max(0.0));
        }
    }
    kept
}

/// Slope of the width per millimetre at each node: the harmonic mean of the neighbouring secants (Fritsch and Butland 1984), 0 at
/// a peak, so that the width never overshoots its nodes.
fn width_slopes(segments: &[(CubicBez, f64)], widths: &[f64]) -> Vec<f64> {
    let secants: Vec<f64> =
        segments.iter().enumerate().map(|(i, (_, length))| (widths[i + 1] - widths[i]) / length.max(1e-9)).collect();
    (0..widths.len())
        .map(|i| match (i.checked_sub(1).map(|j| secants[j]), secants.get(i).copied()) {
            (Some(a), Some(b)) if a * b > 0.0 => 2.0 * a * b / (a + b),
            (None, Some(b)) => b,
            (Some(a), None) => a,
            _ => 0.0,
        })
        .collect()
}

/// The unit tangent; where a handle has no length, towards the nearest control point that differs.
pub(super) fn tangent(curve: &CubicBez, t: f64) -> Vec2 {
    let d = curve.deriv().eval(t).to_vec2();
    if d.hypot() > 1e-9 {
        return d.normalize();
    }
    // A handle of zero length: take the direction to the nearest control point that differs.
    let (near, far) =
        if t < 0.5 { (curve.p0, [curve.p1, curve.p2, curve.p3]) } else { (curve.p3, [curve.p2, curve.p1, curve.p0]) };
    let away = far.iter().map(|p| *p - near).find(|v| v.hypot() > 1e-9).unwrap_or(Vec2::new(1.0, 0.0));
    away.normalize() * if t < 0.5 { 1.0 } else { -1.0 }
}

/// Appends the cap from the left side to the right, as a half circle or a straight line; `forward` points out of the stroke.
fn append_cap(outline: &mut BezPath, end: Point, forward: Vec2, width: f64, ends: Ends) {
    let radius = 0.5 * width;
    if radius < 1e-6 {
        return;
    }
    let left = forward.turn_90() * radius;
    let ahead = forward * radius;
    if ends == Ends::Flat {
        outline.line_to(end - left);
        return;
    }
    let handle = 0.552_284_749_8;
    outline.curve_to(end + left + ahead * handle, end + ahead + left * handle, end + ahead);
    outline.curve_to(end + ahead - left * handle, end - left + ahead * handle, end - left);
}

/// One cubic of the centre line with the width and its slope (per millimetre) at both ends.
struct Swelling {
    curve: CubicBez,
    /// The curve's length, cached for the points of its sides.
    length: f64,
    from: (f64, f64),
    to: (f64, f64),
}

impl Swelling {
    fn station(&self, t: f64, first: f64) -> Station {
        Station { at: self.curve.eval(t), along: tangent(&self.curve, t), width: self.width(t).0, node: first + t }
    }

    fn append_stations(
        &self,
        stations: &mut Vec<(Station, Stretch)>,
        t0: f64,
        t1: f64,
        first: f64,
        spacing: f64,
        is_clear: &impl Fn(Rect) -> bool,
    ) {
        let part = self.curve.subsegment(t0..t1);
        // The width never overshoots its ends.
        let half = 0.5 * self.width(t0).0.max(self.width(t1).0);
        if is_clear(part.bounding_box().inflate(half, half)) {
            stations.push((self.station(t1, first), Stretch::Curve(part)));
        } else if part.arclen(1e-3) <= spacing {
            stations.push((self.station(t1, first), Stretch::Straight));
        } else {
            let middle = 0.5 * (t0 + t1);
            self.append_stations(stations, t0, middle, first, spacing, is_clear);
            self.append_stations(stations, middle, t1, first, spacing, is_clear);
        }
    }

    /// Width and its derivative with respect to the curve's parameter (cubic Hermite).
    fn width(&self, t: f64) -> (f64, f64) {
        let (w0, w1, m0, m1) = (self.from.0, self.to.0, self.from.1 * self.length, self.to.1 * self.length);
        let (t2, t3) = (t * t, t * t * t);
        let value = (2.0 * t3 - 3.0 * t2 + 1.0) * w0 + (t3 - 2.0 * t2 + t) * m0 + (3.0 * t2 - 2.0 * t3) * w1 + (t3 - t2) * m1;
        let slope =
            (6.0 * t2 - 6.0 * t) * w0 + (3.0 * t2 - 4.0 * t + 1.0) * m0 + (6.0 * t - 6.0 * t2) * w1 + (3.0 * t2 - 2.0 * t) * m1;
        (value.max(0.0), slope)
    }

    /// The point of the left (+1) or right (-1) side at `t`, and its derivative with respect to `t`.
    ///
    /// With `p` the centre, `n` the unit normal: `p + side n w/2`, and `n' = k x p'` from the curvature.
    fn side(&self, t: f64, side: f64) -> (Point, Vec2) {
        let point = self.curve.eval(t);
        let velocity = self.curve.deriv().eval(t).to_vec2();
        let acceleration = self.curve.deriv().deriv().eval(t).to_vec2();
        let along = tangent(&self.curve, t);
        let normal = along.turn_90();
        let speed = velocity.hypot().max(1e-9);
        let turning = velocity.cross(acceleration) / (speed * speed);
        let (width, slope) = self.width(t);
        let half = 0.5 * side;
        (point + normal * (half * width), velocity + normal * (half * slope) - along * (half * width * turning))
    }

    /// Appends the side from parameter `t0` to `t1` (in either direction) as cubics.
    fn append_side(&self, outline: &mut BezPath, t0: f64, t1: f64, side: f64, tolerance: f64, depth: usize) {
        let ((a, da), (b, db)) = (self.side(t0, side), self.side(t1, side));
        let step = (t1 - t0) / 3.0;
        let chord = a.distance(b);
        let cubic = CubicBez::new(a, a + capped(da * step, chord), b - capped(db * step, chord), b);
        let is_near = |part: f64| cubic.eval(part).distance(self.side(t0 + (t1 - t0) * part, side).0) <= tolerance;
        if [0.5, 0.25, 0.75].into_iter().all(is_near) {
            outline.curve_to(cubic.p1, cubic.p2, cubic.p3);
        } else if depth < MOST_HALVINGS {
            let half = 0.5 * (t0 + t1);
            self.append_side(outline, t0, half, side, tolerance, depth + 1);
            self.append_side(outline, half, t1, side, tolerance, depth + 1);
        } else {
            // A cusp: its tangents are meaningless, so take a straight line.
            outline.line_to(b);
        }
    }
}

/// A handle no longer than its chord.
fn capped(handle: Vec2, chord: f64) -> Vec2 {
    let length = handle.hypot();
    if length > chord { handle * (chord / length) } else { handle }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(outline: &BezPath) -> f64 {
        outline.area().abs()
    }

    #[test]
    fn a_quadratic_whose_points_are_one_has_no_length() {
        let place = Point::new(5.291_666_666_666_667, 2.645_833_333_333_333_5);
        let mut path = BezPath::new();
        path.move_to(place);
        path.quad_to(place, place);
        assert_eq!(curve_length(&path), 0.0);
    }

    #[test]
    fn a_straight_stroke_of_one_width() {
        let line = BezPath::from_svg("M0,0 L10,0").unwrap();
        let outline = swelling_outline(&line, &[2.0, 2.0], Ends::Round, 0.01);
        assert!((area(&outline) - (20.0 + std::f64::consts::PI)).abs() < 0.01);
    }

    #[test]
    fn a_spindle_has_the_integral_of_its_width() {
        let line = BezPath::from_svg("M0,0 L5,0 L10,0").unwrap();
        let outline = swelling_outline(&line, &[0.0, 1.0, 0.0], Ends::Round, 0.001);
        let expected: f64 = {
            // Integral of the two Hermite pieces: 5 (w0 + w1)/2 + 25 (m0 - m1)/12 each.
            let piece = 5.0 * 0.5 + 25.0 * (0.2 - 0.0) / 12.0;
            2.0 * piece
        };
        assert!((area(&outline) - expected).abs() < 0.01, "{} {expected}", area(&outline));
    }

    #[test]
    fn a_ring_closes() {
        let circle = kurbo::Circle::new((0.0, 0.0), 5.0).to_path(0.001);
        let nodes = circle.segments().count() + 1;
        let outline = swelling_outline(&circle, &vec![1.0; nodes], Ends::Round, 0.001);
        let expected = std::f64::consts::PI * (5.5 * 5.5 - 4.5 * 4.5);
        assert!((area(&outline) - expected).abs() < 0.02, "{} {expected}", area(&outline));
    }

    /// A turn much tighter than half the width: the inner side's own tangents would be 90 times its chord.
    #[test]
    fn a_tight_turn_throws_no_spike() {
        let line = BezPath::from_svg("M0,0 C0.02,0 0.02,0 0.02,0.01 C0.02,0.02 0.02,0.02 0,0.02 L-3,0.02").unwrap();
        let outline = swelling_outline(&line, &[4.0, 4.0, 4.0, 4.0], Ends::Round, 0.002);
        let bounds = line.bounding_box().inflate(2.0, 2.0).inflate(0.01, 0.01);
        let found = outline.bounding_box();
        assert_eq!(bounds.union(found), bounds, "{found:?}");
        for segment in outline.segments() {
            if let PathSeg::Cubic(c) = segment {
                let (chord, handle) = (c.p0.distance(c.p3), c.p0.distance(c.p1).max(c.p2.distance(c.p3)));
                assert!(handle <= chord + 1e-9, "{handle} on {chord}");
            }
        }
    }
}
