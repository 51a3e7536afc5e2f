//! The eyes, each detected once more around its corners: iris, lids and the landmarks around them. The mesh of a whole face is coarse there, and
//! behind spectacles it may be off by the height of an eye.

use super::SeeError;
use super::networks::{Network, sixteenths};
use super::view::{Outside, View, Window};
use crate::elementary::{angle_of, unit_at};
use crate::geometry::Point;
use crate::parallel::both;
use crate::source::Iris;

/// Corners of the eyes: outer and inner of the right, inner and outer of the left, each from left to right on an upright face.
const CORNERS: [(usize, usize); 2] = [(33, 133), (362, 263)];
/// Side of the window in distances between an eye's corners.
const ROOM: f64 = 2.3;
/// Number of points around an eye, and how many of them are taken: brows and what lies beyond them are nearer in the mesh.
const AROUND: usize = 71;
const MOVED: usize = 48;
/// Points of the lids and of each ring, and how far these are moved: brows and cheeks beyond them stay.
const RING: usize = 16;
const SHARES: [f64; 3] = [1.0, 0.67, 0.33];
/// The landmarks of the mesh that the network's first points around an eye are, of the person's right eye (the left one in `MediaPipe`'s lists) and of
/// the left: the lower lid from the outer corner on, the upper lid, and two rings around them, each below and above.
const LANDMARKS: [[usize; MOVED]; 2] = [
    [
        33, 7, 163, 144, 145, 153, 154, 155, 133, 246, 161, 160, 159, 158, 157, 173, 130, 25, 110, 24, 23, 22, 26, 112, 243, 247,
        30, 29, 27, 28, 56, 190, 226, 31, 228, 229, 230, 231, 232, 233, 244, 113, 225, 224, 223, 222, 221, 189,
    ],
    [
        263, 249, 390, 373, 374, 380, 381, 382, 362, 466, 388, 387, 386, 385, 384, 398, 359, 255, 339, 254, 253, 252, 256, 341,
        463, 467, 260, 259, 257, 258, 286, 414, 446, 261, 448, 449, 450, 451, 452, 453, 464, 342, 445, 444, 443, 442, 441, 413,
    ],
];
/// Its outer and inner corner among them.
const ENDS: [usize; 2] = [0, 8];
/// How far an eye may move, in distances between its corners, and how much narrower or wider it may become. Beyond that the network guesses, at
/// eyes that are turned away or hidden; of the sixteen portraits the far eye of one nearly in profile.
const MOST: f64 = 0.5;
const WIDTHS: [f64; 2] = [0.6, 1.5];

/// The irises of a face are as large as each other. One that is smaller than this fraction of the other one is a corner of an eye: the mesh squeezes the
/// far eye of a face nearly in profile (0.44 on one of sixteen portraits, 0.78 and more on the others).
const DOUBTFUL: f64 = 0.6;
/// Where such an eye is looked for: in a window for an eye of this width, in widths of the other eye, and its middle so far outwards. Found it is from
/// this fraction of the other iris on.
const AGAIN: f64 = 0.8;
const OUTWARDS: [f64; 4] = [0.0, 0.1, 0.2, 0.3];
const ALIKE: f64 = 0.75;

/// What the network detects around an eye.
#[derive(Clone)]
struct Eye {
    iris: Iris,
    around: Vec<Point>,
}

/// The person's right iris, then the left; moves the landmarks around the eyes to where they are detected, where that is near. The irises are the
/// network's in any case: the mesh has none. The network was trained on right eyes, so the left one is mirrored.
pub(super) fn irises(network: &Network, view: &View, points: &mut [[f64; 3]]) -> Result<[Iris; 2], SeeError> {
    let corners = CORNERS.map(|(a, b)| [a, b].map(|i| Point::new(points[i][0], points[i][1])));
    let looked = |side: usize, [a, b]: [Point; 2]| {
        let window = Window::square(a.midpoint(b), ROOM * a.distance(b).max(1.0), angle_of(b - a));
        eye(network, view, if side == 0 { window } else { window.mirrored() })
    };
    let (right, left) = both(|| looked(0, corners[0]), || looked(1, corners[1]));
    let mut eyes = [right?, left?];
    for (side, other) in [(0, 1), (1, 0)] {
        let least = ALIKE * eyes[other].iris.radius;
        let again = if eyes[side].iris.radius < DOUBTFUL * eyes[other].iris.radius {
            seen_again(|corners| looked(side, corners), corners[side], corners[other], side, least)?
        } else {
            None
        };
        let is_seen_again = again.is_some();
        eyes[side] = again.unwrap_or(eyes[side].clone());
        if is_seen_again || is_near(&eyes[side].around, points, &LANDMARKS[side]) {
            move_landmarks(&eyes[side].around, points, &LANDMARKS[side]);
        }
    }
    Ok(eyes.map(|eye| eye.iris))
}

/// A doubtful eye, looked for farther out and larger; `None` if no iris of at least this radius is there.
fn seen_again(
    look: impl Fn([Point; 2]) -> Result<Eye, SeeError>,
    corners: [Point; 2],
    other: [Point; 2],
    side: usize,
    least: f64,
) -> Result<Option<Eye>, SeeError> {
    let width = other[0].distance(other[1]);
    let along = unit_at(angle_of(corners[1] - corners[0]));
    let outwards = if side == 0 { -along } else { along };
    for share in OUTWARDS {
        let middle = corners[0].midpoint(corners[1]) + outwards * (share * width);
        let half = along * (0.5 * AGAIN * width);
        let seen = look([middle - half, middle + half])?;
        if seen.iris.radius >= least {
            return Ok(Some(seen));
        }
    }
    Ok(None)
}

/// Moves an eye's landmarks in the picture plane: the lids wholly, the rings by falling shares, as what is beyond them stays.
fn move_landmarks(around: &[Point], points: &mut [[f64; 3]], landmarks: &[usize; MOVED]) {
    for (ring, (around, landmarks)) in around.chunks(RING).zip(landmarks.chunks(RING)).enumerate() {
        for (p, &i) in around.iter().zip(landmarks) {
            let moved = Point::new(points[i][0], points[i][1]).lerp(*p, SHARES[ring]);
            (points[i][0], points[i][1]) = (sixteenths(moved.x), sixteenths(moved.y));
        }
    }
}

/// True if an eye lies about where the mesh has it, in about its size.
fn is_near(around: &[Point], points: &[[f64; 3]], landmarks: &[usize; MOVED]) -> bool {
    let [a, b] = ENDS.map(|end| around[end]);
    let [c, d] = ENDS.map(|end| Point::new(points[landmarks[end]][0], points[landmarks[end]][1]));
    let width = c.distance(d);
    a.midpoint(b).distance(c.midpoint(d)) < MOST * width && (WIDTHS[0]..WIDTHS[1]).contains(&(a.distance(b) / width))
}

/// An eye's points, farther from its inner corner by a share: the network sets the outer corner too near, on 16 portraits by 3 to 10 % of the
/// width.
fn wider(around: &[Point]) -> Vec<Point> {
    const WIDER: f64 = 0.06;
    let [outer, inner] = ENDS.map(|end| around[end]);
    let across = (outer - inner) / outer.distance(inner).max(1e-9);
    around.iter().map(|p| *p + across * (WIDER * across.dot(*p - inner))).collect()
}

fn eye(network: &Network, view: &View, window: Window) -> Result<Eye, SeeError> {
    let side = network.side as f64;
    let failed = |reason: &str| SeeError::Network { network: "iris_landmark", reason: reason.to_owned() };
    let outputs = network.run(&view.through(&window, network.side, Outside::Repeated), 1.0 / 255.0, 0.0)?;
    let [around, points] = outputs.map(|numbers| -> Vec<Point> {
        let place = |p: &[f32]| window.place(f64::from(p[0]) / side, f64::from(p[1]) / side);
        numbers.chunks_exact(3).map(place).map(|p| Point::new(sixteenths(p.x), sixteenths(p.y))).collect()
    });
    // The iris' centre, then its right, upper, left and lower end.
    let [centre, ends @ ..] = points.as_slice() else {
        return Err(failed("it returned no points"));
    };
    let radius = sixteenths(ends.iter().map(|p| p.distance(*centre)).sum::<f64>() / ends.len().max(1) as f64);
    if around.len() != AROUND || !(centre.is_finite() && radius.is_finite() && around.iter().all(|p| p.is_finite())) {
        return Err(failed("its points do not form an eye"));
    }
    let around = wider(&around);
    Ok(Eye { iris: Iris { centre: *centre, radius }, around })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::POINTS;

    /// An eye from `outer` to `inner`, on one line.
    fn around(outer: f64, inner: f64) -> Vec<Point> {
        let last = ENDS[1] as f64;
        (0..AROUND).map(|i| Point::new(outer + (inner - outer) * (i as f64 / last).min(1.0), 50.0)).collect()
    }

    #[test]
    fn an_eye_grows_from_its_inner_corner() {
        let eye = wider(&around(10.0, 60.0));
        assert!((eye[0].x - 7.0).abs() < 1e-9 && eye[ENDS[1]] == Point::new(60.0, 50.0) && eye[0].y == 50.0);
        assert!(wider(&[Point::ZERO; AROUND]).iter().all(|p| p.is_finite()), "an eye of one point");
    }

    #[test]
    fn an_eye_far_from_the_meshs_or_of_another_size_is_not_taken() {
        let mut points = vec![[0.0; 3]; POINTS];
        let [outer, inner] = ENDS.map(|end| LANDMARKS[0][end]);
        (points[outer], points[inner]) = ([10.0, 50.0, 0.0], [60.0, 50.0, 0.0]);
        let is_taken = |from: f64, to: f64| is_near(&around(from, to), &points, &LANDMARKS[0]);
        assert!(is_taken(15.0, 62.0));
        assert!(!is_taken(40.0, 90.0), "beside it");
        assert!(!is_taken(30.0, 50.0), "too narrow");
        points[inner] = points[outer];
        assert!(!is_near(&around(10.0, 60.0), &points, &LANDMARKS[0]), "the mesh's has no width");
    }

    #[test]
    fn a_squeezed_eye_is_looked_for_outwards_until_its_iris_is_large_enough() {
        let corners = [Point::new(100.0, 50.0), Point::new(110.0, 50.0)];
        let other = [Point::new(150.0, 50.0), Point::new(190.0, 50.0)];
        // Irises are seen from 99 to the left alone.
        let look = |[a, b]: [Point; 2]| {
            let centre = a.midpoint(b);
            let radius = if centre.x < 99.0 { 8.0 } else { 2.0 };
            Ok(Eye { iris: Iris { centre, radius }, around: Vec::new() })
        };
        let found = seen_again(look, corners, other, 0, 6.0).expect("no network fails").expect("an eye");
        assert!((found.iris.centre.x - 97.0).abs() < 1e-9, "{:?}", found.iris);
        assert!(seen_again(look, corners, other, 1, 6.0).expect("no network fails").is_none(), "the left eye lies to the right");
    }

    #[test]
    fn each_landmark_around_an_eye_is_moved_once() {
        let all: std::collections::BTreeSet<usize> = LANDMARKS.concat().into_iter().collect();
        assert!(all.len() == 2 * MOVED && all.iter().all(|i| *i < POINTS));
    }
}
