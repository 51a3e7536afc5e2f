//! The cubic with given end tangents that passes places closest (Schneider 1990, "An algorithm for automatically fitting digitized
//! curves").

use super::swell::tangent;
use kurbo::{CubicBez, ParamCurve, ParamCurveDeriv, Point, Vec2};

/// What a deviation along the curve counts, to one across it. With 1, plain distances, 150 rounds come about as near as 8 with this.
const ALONG: f64 = 0.01;
/// Longest handle, in lengths of the part that the curve stands for; longer ones make loops between the places.
const LONGEST_HANDLE: f64 = 1.2;

/// A place on an outline with the unit directions in which it arrives and leaves.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) at: Point,
    pub(super) arriving: Vec2,
    pub(super) leaving: Vec2,
    /// Area of the outline's step to here, towards the origin.
    pub(super) swept: f64,
}

/// The cubic with the end tangents of the places whose handles are those of a flat arc.
pub(super) fn arc(places: &[Place], length: f64) -> CubicBez {
    let (first, last) = (places[0], places[places.len() - 1]);
    let reach = length / 3.0;
    CubicBez::new(first.at, first.at + first.leaving * reach, last.at - last.arriving * reach, last.at)
}

/// Where a cubic passes a place: its parameter and its unit tangent there.
#[derive(Clone, Copy)]
pub(super) struct Passed {
    pub(super) at: f64,
    pub(super) along: Vec2,
}

impl Passed {
    /// Product of two deviations: along the cubic they hardly count, since its parameters follow.
    fn product(self, a: Vec2, b: Vec2) -> f64 {
        a.dot(b) - (1.0 - ALONG) * a.dot(self.along) * b.dot(self.along)
    }
}

/// The cubic with the end tangents of the places that passes them closest.
pub(super) fn least_squares(places: &[Place], passed: &[Passed], length: f64) -> CubicBez {
    let (first, last) = (places[0], places[places.len() - 1]);
    let (start, end) = (first.leaving, -last.arriving);
    let [mut c11, mut c12, mut c22, mut x1, mut x2] = [0.0; 5];
    for (place, passed) in places.iter().zip(passed) {
        let (s, t) = (1.0 - passed.at, passed.at);
        let [b0, b1, b2, b3] = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
        let (a1, a2) = (start * b1, end * b2);
        let rest = place.at.to_vec2() - first.at.to_vec2() * (b0 + b1) - last.at.to_vec2() * (b2 + b3);
        c11 += passed.product(a1, a1);
        c12 += passed.product(a1, a2);
        c22 += passed.product(a2, a2);
        x1 += passed.product(a1, rest);
        x2 += passed.product(a2, rest);
    }
    let determinant = c11 * c22 - c12 * c12;
    let [h1, h2] = [(x1 * c22 - x2 * c12) / determinant, (c11 * x2 - c12 * x1) / determinant];
    let is_fair = |handle: &f64| (0.0..=LONGEST_HANDLE * length).contains(handle);
    let is_told = determinant > 1e-9 * c11 * c22 && is_fair(&h1) && is_fair(&h2);
    if !is_told {
        return arc(places, length);
    }
    CubicBez::new(first.at, first.at + start * h1, last.at + end * h2, last.at)
}

/// Moves each parameter to where the cubic is nearest to its place (a step of Newton's).
pub(super) fn move_to_nearest(cubic: &CubicBez, places: &[Place], passed: &mut [Passed]) {
    let velocity = cubic.deriv();
    let acceleration = velocity.deriv();
    let inner = 1..places.len() - 1;
    for (place, passed) in places[inner.clone()].iter().zip(&mut passed[inner]) {
        let t = passed.at;
        let (off, v, a) = (cubic.eval(t) - place.at, velocity.eval(t).to_vec2(), acceleration.eval(t).to_vec2());
        let slope = v.dot(v) + off.dot(a);
        if slope > 0.0 {
            passed.at = (t - off.dot(v) / slope).clamp(0.0, 1.0);
        }
        passed.along = tangent(cubic, passed.at);
    }
}
