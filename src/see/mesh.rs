//! The 468 landmarks of a face: computed in the detector's box, then twice more in the box of the landmarks themselves.

use super::SeeError;
use super::faces::Found;
use super::networks::{Network, sigmoid, sixteenths};
use super::view::{Outside, View, Window};
use crate::elementary::angle_of;
use crate::geometry::{Point, Vec2};
use crate::source::POINTS;

/// Side of the window in longer sides of the box; the box leaves out brow and hair.
const ROOM: f64 = 1.5;
/// The outer corners of the right and the left eye.
const EYE_LINE: (usize, usize) = (33, 263);
/// Number of refinements in the landmarks' own box: the detector's box is a few percent off, and lids follow the box.
const AGAIN: usize = 2;

/// The landmarks in pixels of the upright picture (z too), and the network's probability that they are on a face.
pub(super) struct Mesh {
    pub points: Vec<[f64; 3]>,
    pub presence: f64,
}

pub(super) fn mesh(network: &Network, view: &View, found: &Found) -> Result<Mesh, SeeError> {
    let window = Window::square(found.bounds.center(), ROOM * found.side(), found.angle());
    (0..AGAIN).try_fold(points_in(network, view, window)?, |mesh, _| points_in(network, view, window_of(&mesh.points)))
}

/// The window for a set of landmarks: their box with the eyes level, and a margin.
fn window_of(points: &[[f64; 3]]) -> Window {
    let at = |i: usize| Point::new(points[i][0], points[i][1]);
    let across = (at(EYE_LINE.1) - at(EYE_LINE.0)).normalize();
    let down = Vec2::new(-across.y, across.x);
    let ends = |axis: Vec2| {
        let along = points.iter().map(|p| axis.dot(Vec2::new(p[0], p[1])));
        along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
    };
    let ((left, right), (top, bottom)) = (ends(across), ends(down));
    let centre = (0.5 * (left + right) * across + 0.5 * (top + bottom) * down).to_point();
    Window::square(centre, ROOM * (right - left).max(bottom - top), angle_of(across))
}

fn points_in(network: &Network, view: &View, window: Window) -> Result<Mesh, SeeError> {
    let side = network.side as f64;
    let [numbers, flag] = network.run(&view.through(&window, network.side, Outside::Repeated), 1.0 / 255.0, 0.0)?;
    let depth = window.across.hypot() / side;
    let points: Vec<[f64; 3]> = numbers
        .chunks_exact(3)
        .map(|p| {
            let place = window.place(f64::from(p[0]) / side, f64::from(p[1]) / side);
            [place.x, place.y, f64::from(p[2]) * depth].map(sixteenths)
        })
        .collect();
    let is_whole = points.len() == POINTS && points.iter().flatten().all(|v| v.is_finite());
    if !is_whole || points[EYE_LINE.0] == points[EYE_LINE.1] {
        return Err(SeeError::Network { network: "face_landmark", reason: "its points do not form a face".to_owned() });
    }
    Ok(Mesh { points, presence: flag.first().map_or(0.0, |flag| sigmoid(*flag)) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::Elementary as _;

    #[test]
    fn the_window_of_points_is_level_with_their_eyes() {
        let angle = 0.3_f64;
        let (sin, cos) = angle.sine_and_cosine();
        let turned = |x: f64, y: f64| [50.0 + x * cos - y * sin, 70.0 + x * sin + y * cos, 0.0];
        let mut points = vec![turned(0.0, 0.0); POINTS];
        (points[33], points[263]) = (turned(-10.0, -5.0), turned(10.0, -5.0));
        (points[10], points[152]) = (turned(0.0, -20.0), turned(0.0, 20.0));
        let window = window_of(&points);
        assert!((angle_of(window.across) - angle).abs() < 1e-9 && (window.across.hypot() - 60.0).abs() < 1e-9);
        assert!((window.place(0.5, 0.5) - Point::new(50.0, 70.0)).hypot() < 1e-9);
    }
}
