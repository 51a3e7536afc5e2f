//! A face with known landmarks: its frame, its features' windows and its outline, without a search.

use crate::elementary::angle_of;
use crate::field::{FaceFrame, FeatureWindow};
use crate::geometry::{Point, Rect};
use crate::raster::{Raster, filled_polygon, gaussian_blur};
use crate::source::{Landmarks, outlines};

/// The mesh's points around the underside of the nose.
const NOSTRILS: [usize; 7] = [129, 98, 97, 2, 326, 327, 358];
/// The lips' middle, where they meet.
const LIPS_MEET: (usize, usize) = (13, 14);
/// How far down the mouth lies in the template, in eye distances, and the range of stretch from a nod or a long face.
const MOUTH_DOWN: f64 = 1.06;
const STRETCHES: (f64, f64) = (0.75, 1.5);
/// Minimum eye distance as a share of the face's width: in a face turned to the side the eyes come close together.
const LEAST_DISTANCE: f64 = 0.4;
/// Room around the points of a feature, across and down, in eye distances: brows grow beyond their points, lids have lashes, a nose has
/// its shadow.
const ROUND_BROW: [f64; 2] = [0.1, 0.1];
const ROUND_EYE: [f64; 2] = [0.12, 0.1];
const ROUND_NOSE: [f64; 2] = [0.06, 0.14];
const ROUND_MOUTH: [f64; 2] = [0.1, 0.08];
/// Softness of the outline, in eye distances.
const SOFT: f64 = 0.02;

/// The frame of a detected face, with its own windows.
pub(super) fn frame(face: &Landmarks) -> FaceFrame {
    let [right, left] = face.irises.map(|iris| iris.centre);
    let across = left - right;
    let mouth = face.point(LIPS_MEET.0).midpoint(face.point(LIPS_MEET.1));
    let between_eyes = right.midpoint(left);
    let eye_distance = across.hypot().max(LEAST_DISTANCE * face.width()).max(1.0);
    let tilt = angle_of(across);
    let plain = FaceFrame { between_eyes, eye_distance, stretch: 1.0, tilt, score: 1.0, windows: crate::field::USUAL_WINDOWS };
    let stretch = (plain.relative(mouth).1 / MOUTH_DOWN).clamp(STRETCHES.0, STRETCHES.1);
    let frame = FaceFrame { stretch, ..plain };
    let window = |points: &[usize], room| window(&frame, &face.line(points), room);
    let windows = [
        window(&outlines::RIGHT_BROW, ROUND_BROW),
        window(&outlines::LEFT_BROW, ROUND_BROW),
        window(&outlines::RIGHT_EYE, ROUND_EYE),
        window(&outlines::LEFT_EYE, ROUND_EYE),
        window(&NOSTRILS, ROUND_NOSE),
        window(&outlines::LIPS, ROUND_MOUTH),
    ];
    FaceFrame { windows, ..frame }
}

fn window(frame: &FaceFrame, points: &[Point], [across, down]: [f64; 2]) -> FeatureWindow {
    let places = points.iter().map(|p| Point::from(frame.relative(*p)));
    let bounds = places.map(|p| Rect::from_points(p, p)).reduce(|a, b| a.union(b)).unwrap_or_default();
    let middle = bounds.center();
    [middle.x, middle.y, 0.5 * bounds.width() + across, 0.5 * bounds.height() + down]
}

/// The inside of the faces' outlines, 0 to 1.
pub(super) fn region(faces: &[Landmarks], width: usize, height: usize) -> Raster<f32> {
    let nothing = Raster::filled(width, height, 0.0_f32);
    faces.iter().fold(nothing, |all, face| {
        let corners: Vec<[f64; 2]> = face.line(&outlines::OVAL).iter().map(|p| [p.x, p.y]).collect();
        let inside = filled_polygon(width, height, &corners).map(f32::from);
        all.zip_map(&gaussian_blur(&inside, (SOFT * frame(face).eye_distance) as f32), f32::max)
    })
}
