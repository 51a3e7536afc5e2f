//! The irises, each detected around the corners of its eye.

use super::SeeError;
use super::networks::{Network, sixteenths};
use super::view::{Outside, View, Window};
use crate::elementary::angle_of;
use crate::geometry::Point;
use crate::source::Iris;

/// Corners of the eyes: outer and inner of the right, inner and outer of the left, each from left to right on an upright face.
const CORNERS: [(usize, usize); 2] = [(33, 133), (362, 263)];
/// Side of the window in distances between an eye's corners.
const ROOM: f64 = 2.3;

/// The person's right iris, then the left. The network was trained on left eyes, so the right one is mirrored.
pub(super) fn irises(network: &Network, view: &View, points: &[[f64; 3]]) -> Result<[Iris; 2], SeeError> {
    let window = |(a, b): (usize, usize)| {
        let [a, b] = [a, b].map(|i| Point::new(points[i][0], points[i][1]));
        Window::square(a.midpoint(b), ROOM * (b - a).hypot().max(1.0), angle_of(b - a))
    };
    Ok([iris(network, view, window(CORNERS[0]).mirrored())?, iris(network, view, window(CORNERS[1]))?])
}

fn iris(network: &Network, view: &View, window: Window) -> Result<Iris, SeeError> {
    let side = network.side as f64;
    let [_lids, numbers] = network.run(&view.through(&window, network.side, Outside::Repeated), 1.0 / 255.0, 0.0)?;
    let points: Vec<Point> =
        numbers.chunks_exact(3).map(|p| window.place(f64::from(p[0]) / side, f64::from(p[1]) / side)).collect();
    // The iris' centre, then its right, upper, left and lower end.
    let [middle, ends @ ..] = points.as_slice() else {
        return Err(SeeError::Network { network: "iris_landmark", reason: "it returned no points".to_owned() });
    };
    let radius = ends.iter().map(|p| (*p - *middle).hypot()).sum::<f64>() / ends.len().max(1) as f64;
    if !(middle.is_finite() && radius.is_finite()) {
        return Err(SeeError::Network { network: "iris_landmark", reason: "its points do not form an iris".to_owned() });
    }
    Ok(Iris { centre: Point::new(sixteenths(middle.x), sixteenths(middle.y)), radius: sixteenths(radius) })
}
