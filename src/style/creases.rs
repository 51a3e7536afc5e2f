//! Folds of the skin: lines that steer marks and are not drawn as lines, which would look like scars or wires.

use crate::elementary::Elementary as _;
use crate::field::{CoherentLine, Curve};
use crate::geometry::{Point, Region, Vec2, resample};
use crate::raster::Raster;
use crate::source::{Landmarks, MaskRole, Portrait, outlines};

/// The middle of a face, as a share of its outline's size; a line is a crease if more than the second share of it lies there and less
/// than the third in eyes, brows, nose and mouth or so near an iris, in distances of the eyes, as the rims of spectacles.
const FACE_MIDDLE: f64 = 0.9;
const MOSTLY: f64 = 0.85;
const MOST_IN_FEATURES: f64 = 0.2;
const SPECTACLES: f64 = 0.55;

/// True for a place as near an iris as lids, lashes and the rims of spectacles.
pub(super) fn is_near_iris(portrait: &Portrait, p: Point) -> bool {
    let reach = |face: &Landmarks| SPECTACLES * face.eye_distance();
    portrait.faces.iter().any(|face| face.irises.iter().any(|iris| iris.centre.distance(p) < reach(face)))
}

/// The faces in which lines may be folds.
pub(super) struct Creases<'a> {
    portrait: &'a Portrait,
    /// The insides of the faces, without their borders.
    faces: Vec<Region>,
    foreheads: Vec<Region>,
}

impl<'a> Creases<'a> {
    /// Of the faces that were found.
    pub(super) fn of(portrait: &'a Portrait) -> Self {
        Self {
            portrait,
            faces: portrait.faces.iter().map(middle_of).collect(),
            foreheads: portrait.faces.iter().map(forehead_of).collect(),
        }
    }

    /// True for a line, in working pixels, on bare skin inside a face, away from its features. None without a mask of these.
    pub(super) fn have(&self, line: &Curve) -> bool {
        let Some(detail) = self.portrait.masks.get(&MaskRole::Detail) else { return false };
        share(line, |p| self.are_in(p)) > MOSTLY && share(line, |p| self.is_feature(detail, p)) < MOST_IN_FEATURES
    }

    /// True for a line, in working pixels, that curls on a forehead: it is a lock that hangs before it, or its shadow.
    pub(super) fn have_curl(&self, line: &Curve) -> bool {
        /// Turns from which a line curls, and the length of the chords that are compared, in widths of the face.
        const CURLED: f64 = 0.6;
        const CHORD: f64 = 0.025;
        let on_forehead = |(forehead, face): (&Region, &Landmarks)| {
            let chords: Vec<Vec2> = resample(&line.points, CHORD * face.width()).windows(2).map(|w| w[1] - w[0]).collect();
            let turned: f64 = chords.windows(2).map(|w| w[0].cross(w[1]).angle_over(w[0].dot(w[1]))).sum();
            turned.abs() > CURLED * std::f64::consts::TAU && share(line, |p| forehead.contains(p)) > MOSTLY
        };
        self.foreheads.iter().zip(&self.portrait.faces).any(on_forehead)
    }

    /// What is left of a line, in working pixels, without the folds that it runs along.
    pub(super) fn cut_from(&self, line: &CoherentLine) -> Vec<CoherentLine> {
        /// A fold that a line runs along is cut out of it from this length on, in distances of the eyes: what is shorter would
        /// leave gaps. And the length from which what is left is drawn: shorter ends would stand alone on the skin. Looked at on
        /// sixteen portraits: without the cut, lines that run from a brow up a forehead or from a mouth along a cheek (13, 16)
        /// are drawn as scars.
        const FOLD: f64 = 0.2;
        const REST: f64 = 0.35;
        let Some(detail) = self.portrait.masks.get(&MaskRole::Detail).filter(|_| !line.curve.closed) else {
            return vec![line.clone()];
        };
        let Some(eyes) = self.portrait.faces.iter().map(Landmarks::eye_distance).reduce(f64::max) else {
            return vec![line.clone()];
        };
        let points = &line.curve.points;
        let is_kept: Vec<bool> = points.iter().map(|p| !self.are_in(*p) || self.is_feature(detail, *p)).collect();
        let length = |first: usize, end: usize| points[first..end].windows(2).map(|w| w[0].distance(w[1])).sum::<f64>();
        let mut is_drawn = vec![true; points.len()];
        let mut first = 0;
        for run in is_kept.chunk_by(|a, b| a == b) {
            let end = first + run.len();
            if !run[0] && length(first, end) > FOLD * eyes {
                is_drawn[first..end].fill(false);
            }
            first = end;
        }
        let mut rest = line.runs(&is_drawn);
        rest.retain(|part| part.curve.points.len() == points.len() || part.curve.length() > REST * eyes);
        rest
    }

    /// True in eyes, brows, nose and mouth, and so near an iris as the rims of spectacles.
    fn is_feature(&self, detail: &Raster<f32>, p: Point) -> bool {
        detail.sample(p.x, p.y) >= 0.5 || is_near_iris(self.portrait, p)
    }

    /// True for a place where folds may be: inside a face, away from its border, or on a forehead above it.
    pub(super) fn are_in(&self, p: Point) -> bool {
        self.faces.iter().any(|face| face.contains(p)) || self.are_on_forehead(p)
    }

    fn are_on_forehead(&self, p: Point) -> bool {
        /// Distance from hair, in widths of the face, from which a line on a forehead is a fold and not the hairline.
        const FROM_HAIR: f64 = 0.07;
        let hair = [MaskRole::Hair, MaskRole::Headwear].map(|role| self.portrait.masks.get(&role));
        let is_hair = |p: Point| hair.iter().flatten().any(|mask| mask.sample(p.x, p.y) > 0.5);
        if self.portrait.subject.sample(p.x, p.y) < 0.95 {
            return false;
        }
        self.foreheads.iter().zip(&self.portrait.faces).any(|(forehead, face)| {
            let reach = FROM_HAIR * face.width();
            let around = [(0.0, 0.0), (reach, 0.0), (-reach, 0.0), (0.0, reach), (0.0, -reach)];
            forehead.contains(p) && !around.into_iter().any(|off| is_hair(p + off))
        })
    }
}

fn middle_of(face: &Landmarks) -> Region {
    let oval = face.line(&outlines::OVAL);
    let centre = middle(&oval);
    Region::of_polygons(vec![oval.iter().map(|p| centre.lerp(*p, FACE_MIDDLE)).collect()])
}

/// How far a forehead may go on above the face's outline, in heights of the face, and how much wider than that it may be: a turned head
/// goes on behind it (16).
const FOREHEAD: f64 = 0.45;
const WIDER: f64 = 1.25;

/// A face's outline moved up over the forehead, and widened.
fn forehead_of(face: &Landmarks) -> Region {
    let height = face.point(10) - face.point(152);
    let oval: Vec<Point> = face.line(&outlines::OVAL).into_iter().map(|p| p + FOREHEAD * height).collect();
    let (centre, up) = (middle(&oval), height / height.hypot().max(1e-9));
    let widened = |p: Point| {
        let off = p - centre;
        centre + WIDER * off + (1.0 - WIDER) * off.dot(up) * up
    };
    Region::of_polygons(vec![oval.into_iter().map(widened).collect()])
}

fn middle(line: &[Point]) -> Point {
    (line.iter().fold(Vec2::ZERO, |sum, p| sum + p.to_vec2()) / line.len() as f64).to_point()
}

/// The share of a line's points for which something holds.
pub(super) fn share(line: &Curve, holds: impl Fn(Point) -> bool) -> f64 {
    line.points.iter().filter(|p| holds(**p)).count() as f64 / line.points.len() as f64
}
