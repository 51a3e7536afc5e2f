//! The same outline with fewer curves (after Schneider 1990, "An algorithm for automatically fitting digitized curves").

use super::cubic_fit::{Passed, Place, arc, least_squares, move_to_nearest};
use super::polyline::lengths_along;
use super::swell::{curve_length, is_long, segment_length, tangent};
use kurbo::{BezPath, CubicBez, Line, ParamCurve, ParamCurveArea, PathEl, PathSeg, Point, QuadBez, Shape, Vec2};

/// Cosine of the least turn of an outline that is a corner, 26 degrees. At a smaller angle the short chords of a traced disc
/// would be corners; at a larger one the tips of spindles would be rounded.
const CORNER: f64 = 0.9;
/// Distance of the places where an outline is followed, in tolerances, and their least number on a curve: between closer ones a cubic
/// does not stray, and more cost time alone.
const SPACING: f64 = 12.0;
const LEAST_PLACES: usize = 4;
/// Rounds in which the places are moved to where the curve passes them: the first few are far from the nearest curve, and after
/// the last ones heads of hair get hardly smaller (portraits 01 and 15: 1 and 2 % between 8 rounds in all and 24).
const LEAST_ROUNDS: usize = 4;
const ROUNDS: usize = 24;
/// Least chord of a part, as a share of its length: a ring needs two curves.
const LEAST_CHORD: f64 = 0.3;
/// By how much a curve may lie to one side in the mean: this share of the outline's mean width, so that its ink is kept to 2.5 %, but
/// not less and not more than these shares of the tolerance. Without the first, thin hairs would have a curve for each bend of
/// their noise; without the second, one side of a broad shape could lie off as a whole.
const BIAS_OF_WIDTH: f64 = 0.0125;
const LEAST_BIAS: f64 = 0.125;
const MOST_BIAS: f64 = 0.3;
/// A part is straight if its places lie within this share of the tolerance of its chord and its ends point along it, by their cosine.
const STRAIGHT: f64 = 0.1;
const ALIGNED: f64 = 0.9998;
/// A curve whose handles lie within this share of the tolerance of its chord is written as a straight line: it passes the outline
/// nearly as well, in a third of the text.
const FLAT: f64 = 0.75;
/// A cubic that lies within this share of the tolerance of a quadratic is written as one: four numbers in place of six.
const QUADRATIC: f64 = 0.75;
/// Parts shorter than this many tolerances may lie to one side: they are the tips of hairs, which hold next to no ink.
const SMALL: f64 = 4.0;
/// Steps of an outline that are shorter than this share of the tolerance are none: they are what is left where clipping and
/// offsetting meet, and their directions would be corners.
const SHORT: f64 = 0.3;

/// Outlines and lines with as few cubics, quadratics and straight lines as pass near places on them, 12 tolerances apart at most: cubics
/// within `tolerance`, the others within twice that. Corners stay; where the outline is smooth its curves are smooth, with its own tangents,
/// but parts that hardly bend or are shorter than 4 tolerances may be straight. Its area hardly changes.
pub fn with_fewer_curves(path: &BezPath, tolerance: f64) -> BezPath {
    if !path.is_finite() || tolerance.is_nan() || tolerance <= 0.0 {
        return path.clone();
    }
    let bias = (BIAS_OF_WIDTH * mean_width(path)).clamp(LEAST_BIAS * tolerance, MOST_BIAS * tolerance);
    let mut fewer = BezPath::new();
    for elements in path.elements().chunk_by(|_, next| !matches!(next, PathEl::MoveTo(_))) {
        let subpath: BezPath = elements.iter().copied().collect();
        let is_closed = matches!(elements.last(), Some(PathEl::ClosePath));
        match Course::of(&subpath, is_closed, tolerance, bias) {
            Some(course) => course.append_to(&mut fewer),
            None => fewer.extend(subpath),
        }
        if is_closed && !matches!(fewer.elements().last(), Some(PathEl::ClosePath)) {
            fewer.close_path();
        }
    }
    fewer
}

impl Place {
    fn is_corner(&self) -> bool {
        self.arriving.dot(self.leaving) < CORNER
    }

    /// A smooth place has one direction.
    fn smoothed(self) -> Self {
        if self.is_corner() {
            return self;
        }
        let mean = (self.arriving + self.leaving).normalize();
        Self { arriving: mean, leaving: mean, ..self }
    }
}

/// One outline or line as places along it; a closed one ends where it starts.
struct Course {
    places: Vec<Place>,
    tolerance: f64,
    /// By how much a curve may lie to one side in the mean.
    bias: f64,
}

impl Course {
    /// None for an outline that has no length.
    fn of(subpath: &BezPath, is_closed: bool, tolerance: f64, bias: f64) -> Option<Self> {
        let mut places: Vec<Place> = Vec::new();
        for segment in subpath.segments() {
            append(&mut places, segment, tolerance);
        }
        let last = places.len().checked_sub(1).filter(|last| *last > 1)?;
        if is_closed {
            // A last step may have been too short: the one before it then ends here.
            let rest = Line::new(places[last].at, places[0].at).signed_area();
            places[0] = Place { arriving: places[last].arriving, swept: places[last].swept + rest, ..places[0] };
            places.pop();
            if let Some(corner) = places.iter().position(Place::is_corner) {
                places.rotate_left(corner);
            }
            places.push(places[0]);
        }
        Some(Self { places: places.into_iter().map(Place::smoothed).collect(), tolerance, bias })
    }

    fn append_to(&self, fewer: &mut BezPath) {
        fewer.move_to(self.places[0].at);
        let last = self.places.len() - 1;
        let (mut from, mut corner) = (0, 0);
        while from < last {
            if corner <= from {
                corner = (from + 1..last).find(|i| self.places[*i].is_corner()).unwrap_or(last);
            }
            let (to, part) = self.longest(from, corner);
            match self.simpler(part, &self.places[from..=to]) {
                PathSeg::Line(line) => fewer.line_to(line.p1),
                PathSeg::Quad(quad) => fewer.quad_to(quad.p1, quad.p2),
                PathSeg::Cubic(cubic) => fewer.curve_to(cubic.p1, cubic.p2, cubic.p3),
            }
            from = to;
        }
    }

    /// The farthest place up to the next corner that one curve reaches from a place, and the curve: by steps that double, then halve.
    fn longest(&self, from: usize, corner: usize) -> (usize, PathSeg) {
        let next = &self.places[from..=from + 1];
        let short = straight(next, self.tolerance).unwrap_or_else(|| PathSeg::Cubic(arc(next, next[0].at.distance(next[1].at))));
        let mut best = (from + 1, short);
        let mut step = 1;
        let mut is_growing = true;
        while step > 0 {
            let to = (best.0 + step).min(corner);
            let part = if to > best.0 { self.fitted(&self.places[from..=to]) } else { None };
            match part {
                Some(part) => best = (to, part),
                None => is_growing = false,
            }
            step = if is_growing { 2 * step } else { step / 2 };
        }
        best
    }

    /// A straight line or one cubic with the end tangents of these places that passes all of them.
    fn fitted(&self, places: &[Place]) -> Option<PathSeg> {
        if let Some(line) = straight(places, self.tolerance) {
            return Some(line);
        }
        let (first, last) = (places.first()?, places.last()?);
        let points: Vec<Point> = places.iter().map(|place| place.at).collect();
        let lengths = lengths_along(&points);
        let whole = *lengths.last()?;
        if first.at.distance(last.at) < LEAST_CHORD * whole || whole <= 0.0 {
            return None;
        }
        let mut passed: Vec<Passed> = lengths.iter().map(|length| Passed { at: length / whole, along: Vec2::ZERO }).collect();
        for round in 1..=ROUNDS {
            let cubic = least_squares(places, &passed, whole);
            move_to_nearest(&cubic, places, &mut passed);
            let is_near = |(place, passed): (&Place, &Passed)| {
                cubic.eval(passed.at).distance_squared(place.at) <= self.tolerance * self.tolerance
            };
            let is_fair = self.is_fair(cubic.signed_area(), places, whole);
            if round >= LEAST_ROUNDS && is_fair && places.iter().zip(&passed).all(is_near) {
                return Some(PathSeg::Cubic(cubic));
            }
        }
        None
    }

    /// A straight line in place of a curve that hardly bends, or a quadratic in place of one that bends evenly.
    fn simpler(&self, part: PathSeg, places: &[Place]) -> PathSeg {
        let PathSeg::Cubic(cubic) = part else { return part };
        let chord = Line::new(cubic.p0, cubic.p3);
        let length = (cubic.p3 - cubic.p0).hypot();
        let is_fair = |area: f64| length < SMALL * self.tolerance || self.is_fair(area, places, length);
        if is_flat(&cubic, FLAT * self.tolerance) && is_fair(chord.signed_area()) {
            return PathSeg::Line(chord);
        }
        let (quad, apart) = like_quadratic(&cubic);
        if apart <= QUADRATIC * self.tolerance && is_fair(quad.signed_area()) { PathSeg::Quad(quad) } else { part }
    }

    /// True if a curve of this area and length does not lie to one side of these places.
    fn is_fair(&self, area: f64, places: &[Place], length: f64) -> bool {
        let swept: f64 = places[1..].iter().map(|place| place.swept).sum();
        (area - swept).abs() <= self.bias * length
    }
}

/// True if a curve's handles lie beside its chord, within this distance of it.
fn is_flat(cubic: &CubicBez, within: f64) -> bool {
    let along = cubic.p3 - cubic.p0;
    let length = along.hypot();
    [cubic.p1, cubic.p2].iter().all(|handle| {
        let off = *handle - cubic.p0;
        (0.0..=length * length).contains(&off.dot(along)) && off.cross(along).abs() <= within * length
    })
}

/// The quadratic between a cubic's ends that is near it and sweeps as much, and how far they are apart at most: by the cubic's third
/// difference, which a quadratic does not have, and by how far its handle was moved for its area.
fn like_quadratic(cubic: &CubicBez) -> (QuadBez, f64) {
    /// Largest difference of a cubic with a third difference of 1 from its nearest quadratic: the square root of 3, by 36.
    const LARGEST: f64 = 0.048_112_522;
    let [a, b, c, d] = [cubic.p0, cubic.p1, cubic.p2, cubic.p3].map(Point::to_vec2);
    let third = d - 3.0 * c + 3.0 * b - a;
    let handle = ((3.0 * (b + c) - a - d) / 4.0).to_point();
    let near = QuadBez::new(cubic.p0, handle, cubic.p3);
    let along = d - a;
    // A handle that moves by this much across the chord sweeps a third of it along the whole chord.
    let across = 3.0 * (cubic.signed_area() - near.signed_area()) / along.hypot2().max(f64::MIN_POSITIVE);
    let moved = Vec2::new(along.y, -along.x) * across;
    (QuadBez { p1: handle + moved, ..near }, LARGEST * third.hypot() + 0.5 * moved.hypot())
}

/// Width of a long shape, or of a ring, with this outline.
fn mean_width(outline: &BezPath) -> f64 {
    let around = curve_length(outline);
    if around > 0.0 { 2.0 * outline.area().abs() / around } else { 0.0 }
}

/// Appends places along a segment, its end among them.
fn append(places: &mut Vec<Place>, segment: PathSeg, tolerance: f64) {
    let mut cubic = segment.to_cubic();
    if !is_long(&segment) || places.last().is_some_and(|last| is_short(last.at, cubic, SHORT * tolerance)) {
        return;
    }
    // Steps that were too short leave no gap.
    cubic.p0 = places.last().map_or(cubic.p0, |last| last.at);
    let spacing = SPACING * tolerance;
    let [start, end] = [0.0, 1.0].map(|t| tangent(&cubic, t));
    match places.last_mut() {
        Some(last) => last.leaving = start,
        None => places.push(Place { at: cubic.p0, arriving: start, leaving: start, swept: 0.0 }),
    }
    let length = segment_length(PathSeg::Cubic(cubic), 0.1 * spacing);
    let steps = ((length / spacing).ceil() as usize).max(LEAST_PLACES);
    for step in 1..=steps {
        let [before, t] = [step - 1, step].map(|step| step as f64 / steps as f64);
        let along = if step == steps { end } else { tangent(&cubic, t) };
        let swept = cubic.subsegment(before..t).signed_area();
        places.push(Place { at: cubic.eval(t), arriving: along, leaving: along, swept });
    }
}

/// True if a curve and its end are less than this far from the last place.
fn is_short(last: Point, cubic: CubicBez, least: f64) -> bool {
    last.distance(cubic.p3) < least && segment_length(PathSeg::Cubic(cubic), 0.1 * least) < least
}

/// A straight line, if these places lie on one.
fn straight(places: &[Place], tolerance: f64) -> Option<PathSeg> {
    let (first, last) = (places.first()?, places.last()?);
    let chord = last.at - first.at;
    if chord.hypot() < 1e-9 {
        return None;
    }
    let along = chord.normalize();
    let is_on_it = |place: &Place| {
        let off = place.at - first.at;
        off.cross(along).abs() <= STRAIGHT * tolerance && off.dot(along) >= 0.0
    };
    let is_aligned = first.leaving.dot(along) > ALIGNED && last.arriving.dot(along) > ALIGNED;
    (is_aligned && places.iter().all(is_on_it)).then(|| PathSeg::Line(Line::new(first.at, last.at)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::Elementary as _;
    use crate::geometry::{Ends, Ring, catmull_rom, swelling_outline};
    use kurbo::ParamCurveNearest;

    /// A waving stroke that tapers to both ends, with a node every 0.1 mm.
    fn lock() -> BezPath {
        let points: Vec<Point> = (0..60).map(|i| Point::new(0.1 * f64::from(i), 0.6 * (0.05 * f64::from(i)).sine())).collect();
        let widths: Vec<f64> = (0..60).map(|i| 0.04 + 0.2 * (std::f64::consts::PI * f64::from(i) / 59.0).sine()).collect();
        swelling_outline(&catmull_rom(&points, Ring::Open), &widths, Ends::Round, 0.002)
    }

    fn farthest(from: &BezPath, to: &BezPath) -> f64 {
        let places = from.segments().flat_map(|segment| (0..16).map(move |i| segment.eval(f64::from(i) / 16.0)));
        let distance = |p: Point| to.segments().map(|s| s.nearest(p, 1e-5).distance_sq).fold(f64::MAX, f64::min).sqrt();
        places.map(distance).fold(0.0, f64::max)
    }

    #[test]
    fn a_swelling_stroke_keeps_its_outline_and_its_ink_with_few_curves() {
        let exact = lock();
        let fewer = with_fewer_curves(&exact, 0.005);
        let (before, after) = (exact.segments().count(), fewer.segments().count());
        assert!(after * 10 < before, "{after} of {before}");
        assert!(farthest(&exact, &fewer) < 0.006 && farthest(&fewer, &exact) < 0.006);
        let change = fewer.area() / exact.area() - 1.0;
        assert!(change.abs() < 0.006, "{change}");
    }

    #[test]
    fn a_curve_that_bends_evenly_is_a_quadratic_that_sweeps_as_much() {
        let even = BezPath::from_svg("M0,0 C1,0.4 2,0.41 3,0 Z").unwrap();
        let fewer = with_fewer_curves(&even, 0.01);
        assert!(fewer.elements().iter().any(|element| matches!(element, PathEl::QuadTo(..))), "{}", fewer.to_svg());
        assert!((fewer.area() / even.area() - 1.0).abs() < 1e-3 && farthest(&even, &fewer) < 0.01);
        let bent = BezPath::from_svg("M0,0 C0.1,0.8 2,0.4 3,0 Z").unwrap();
        assert!(with_fewer_curves(&bent, 0.01).elements().iter().all(|element| !matches!(element, PathEl::QuadTo(..))));
    }

    #[test]
    fn corners_and_straight_lines_stay() {
        let square = BezPath::from_svg("M0,0 L2,0 L4,0 L4,4 L0,4 Z M1,1 L1,2 L2,2 Z").unwrap();
        let fewer = with_fewer_curves(&square, 0.005);
        assert_eq!(fewer.segments().count(), 7, "{}", fewer.to_svg());
        assert!((fewer.area() - square.area()).abs() < 1e-9);
        let open = BezPath::from_svg("M0,0 L4,0 L4,4").unwrap();
        assert_eq!(with_fewer_curves(&open, 0.005), open);
    }

    /// Small rings, teardrops and short strokes are what holes in the darks and blobs are.
    #[test]
    fn small_shapes_stay_what_they_are() {
        let circle = |r: f64| kurbo::Circle::new((3.0, 3.0), r).to_path(1e-4);
        let drop = |r: f64| BezPath::from_svg(&format!("M0,0 C{r},{r} {r},{0} 0,{0} C-{r},{0} -{r},{r} 0,0 Z", 3.0 * r)).unwrap();
        let stroke = |length: f64| {
            let line = BezPath::from_svg(&format!("M0,0 L{length},0")).unwrap();
            swelling_outline(&line, &[0.1, 0.1], Ends::Round, 0.002)
        };
        let sizes = [0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 2.0];
        for shape in sizes.iter().flat_map(|size| [circle(*size), drop(*size), stroke(*size)]) {
            let fewer = with_fewer_curves(&shape, 0.01);
            let change = fewer.area() / shape.area() - 1.0;
            assert!(change.abs() < 0.08, "{change}: {} for {}", fewer.to_svg(), shape.to_svg());
            assert!(farthest(&shape, &fewer) < 0.012 && fewer.segments().count() <= 12, "{}", fewer.to_svg());
        }
    }

    /// What clipping leaves of steps is shorter than any pixel, and turns any way.
    #[test]
    fn steps_of_no_length_are_no_corners() {
        let clean = BezPath::from_svg("M100,150 C101,150.2 102,150.2 103,150 C102,149.8 101,149.8 100,150 Z").unwrap();
        let torn =
            "M100,150 C101,150.2 102,150.2 103,150 l0.001,0.001 l0.001,-0.002 C102,149.8 101,149.8 100.002,150 l-0.001,0.001 Z";
        let fewer = with_fewer_curves(&BezPath::from_svg(torn).unwrap(), 0.01);
        assert_eq!(fewer.segments().count(), with_fewer_curves(&clean, 0.01).segments().count(), "{}", fewer.to_svg());
        assert!(farthest(&clean, &fewer) < 0.012);
    }

    #[test]
    fn thin_hairs_keep_their_ink() {
        for (wave, width, tip) in [(0.0, 0.1, 0.0), (0.0, 0.15, 0.03), (0.3, 0.1, 0.03), (0.3, 0.1, 0.1)] {
            let points: Vec<Point> =
                (0..31).map(|i| Point::new(0.1 * f64::from(i), wave * (0.2 * f64::from(i)).sine())).collect();
            let widths: Vec<f64> =
                (0..31).map(|i| tip + (width - tip) * (std::f64::consts::PI * f64::from(i) / 30.0).sine()).collect();
            let exact = swelling_outline(&catmull_rom(&points, Ring::Open), &widths, Ends::Round, 0.002);
            let change = with_fewer_curves(&exact, 0.01).area() / exact.area() - 1.0;
            assert!(change.abs() < 0.03, "{wave} {width} {tip}: {change}");
        }
    }

    #[test]
    fn what_has_no_length_or_no_number_stays() {
        for text in ["M1,1 L1,1 Z", "M1,1", "M1,1 C1,1 1,1 1,1"] {
            let path = BezPath::from_svg(text).unwrap();
            assert_eq!(with_fewer_curves(&path, 0.005), path);
        }
        let mut wild = BezPath::new();
        wild.move_to((0.0, f64::NAN));
        wild.line_to((1.0, 1.0));
        assert_eq!(with_fewer_curves(&wild, 0.005).elements().len(), 2);
    }
}
