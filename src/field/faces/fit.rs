//! A face's frame fitted to the dark clusters that best match its features, all judged together.
//!
//! ```text
//!   clusters -> every pair that may be the eyes -> a frame -> the best cluster for each other feature -> the likeliest of all
//! ```

use super::super::dark_relief::dark_relief;
use super::frame::FaceFrame;
use crate::elementary::{Elementary as _, angle_of};
use crate::geometry::{Point, Vec2};
use crate::raster::{Raster, components};

/// Shares of the face taken as dark. Each gives its own clusters, since one threshold joins brows to eyes and another loses brows.
const DARK_SHARES: [f64; 8] = [0.08, 0.1, 0.12, 0.14, 0.16, 0.18, 0.2, 0.22];
/// Relief above which nothing is dark.
const FAINTEST: f32 = 0.94;
/// Minimum area of a cluster in squared eye distances.
const LEAST_AREA: f64 = 0.004;
/// The other features: position, tolerance and width in eye distances (down: stretched), and weight. Proportions from drawing manuals:
/// the mouth a little more than an eye distance down and wider than the nose between.
const OTHERS: [[f64; 6]; 4] = [
    [-0.5, -0.33, 0.16, 0.1, 0.6, 0.6],
    [0.5, -0.33, 0.16, 0.1, 0.6, 0.6],
    [0.0, 0.62, 0.14, 0.14, 0.4, 0.7],
    [0.0, 1.06, 0.14, 0.16, 0.7, 1.0],
];
/// Tolerance of a feature's width, as a logarithm: without it a smile passes for the nose of a longer face.
const WIDTH_TOLERANCE: f64 = 0.5;
const EYES_WEIGHT: f64 = 1.2;
/// Maximum width and height of an eye with its lids and shadow.
const LARGEST_EYE: (f64, f64) = (0.75, 0.5);
/// Darkness (area times depth, in squared eye distances) at which a cluster has nearly full weight.
const DARK_ENOUGH: f64 = 0.02;
/// Limits and tolerances of the fitted frame relative to the first one: tilt of the eyes, share of their distance, offset.
const STEEPEST: f64 = 0.25;
const SIZES: (f64, f64) = (0.7, 1.4);
const TOLERANCES: (f64, f64, f64) = (0.12, 0.2, 0.2);
/// Costs of a surprising frame, of unequal eyes, and of a stretch that differs from the first frame's or is unusual.
const COSTS: (f64, f64, f64) = (0.15, 0.15, 0.3);
/// Total score below which the first frame is kept: both eyes alone give 2.4.
const LEAST_TOTAL: f64 = 1.2;
const STRETCHES: [f64; 5] = [0.8, 0.9, 1.0, 1.1, 1.2];

/// A dark cluster: middle, darkness, and width and height in eye distances.
#[derive(Clone, Copy, Debug)]
struct Cluster {
    middle: Point,
    darkness: f64,
    size: (f64, f64),
}

/// The frame that best fits the clusters under `first`; `first` itself if they do not form a face.
pub(super) fn fitted(first: &FaceFrame, lightness: &Raster<f32>, skin: &Raster<f32>) -> FaceFrame {
    let relief = dark_relief(lightness, first.eye_distance).relief;
    let best = DARK_SHARES
        .iter()
        .filter_map(|share| best_frame(first, &clusters(first, &relief, skin, *share)))
        .fold((LEAST_TOTAL, *first), |best, next| if next.0 > best.0 { next } else { best });
    best.1
}

/// Clusters of the darkest `share` of the face's middle.
fn clusters(first: &FaceFrame, relief: &Raster<f32>, skin: &Raster<f32>, share: f64) -> Vec<Cluster> {
    let zone = Raster::from_fn(relief.width(), relief.height(), |x, y| {
        let (across, down) = first.relative(Point::new(x as f64 + 0.5, y as f64 + 0.5));
        u8::from(across.abs() < 1.0 && (-0.65..1.5).contains(&down) && skin.get(x, y) > 0.3)
    });
    let mut values: Vec<f32> = relief.pixels().iter().zip(zone.pixels()).filter(|(_, z)| **z != 0).map(|(r, _)| *r).collect();
    values.sort_unstable_by(f32::total_cmp);
    let limit = values.get((share * values.len() as f64) as usize).map_or(0.0, |limit| limit.min(FAINTEST));
    let (labels, count) = components(&zone.zip_map(relief, |zone, relief| u8::from(zone != 0 && relief < limit)));
    gathered(&labels, count, relief, first.eye_distance)
}

fn gathered(labels: &Raster<u32>, count: usize, relief: &Raster<f32>, unit: f64) -> Vec<Cluster> {
    struct Sum {
        area: f64,
        darkness: f64,
        moment: Vec2,
        bounds: (Point, Point),
    }
    let far = Point::new(f64::INFINITY, f64::INFINITY);
    let mut sums: Vec<Sum> =
        (0..=count).map(|_| Sum { area: 0.0, darkness: 0.0, moment: Vec2::ZERO, bounds: (far, Point::ORIGIN) }).collect();
    for (i, (label, relief)) in labels.pixels().iter().zip(relief.pixels()).enumerate().filter(|(_, (label, _))| **label != 0) {
        let p = Vec2::new((i % labels.width()) as f64 + 0.5, (i / labels.width()) as f64 + 0.5);
        let dark = f64::from(1.0 - relief);
        let sum = &mut sums[*label as usize];
        sum.area += 1.0;
        sum.darkness += dark;
        sum.moment += p * dark;
        let (low, high) = sum.bounds;
        sum.bounds = (Point::new(low.x.min(p.x), low.y.min(p.y)), Point::new(high.x.max(p.x), high.y.max(p.y)));
    }
    sums.iter()
        .filter(|sum| sum.area >= LEAST_AREA * unit * unit && sum.darkness > 0.0)
        .map(|sum| Cluster {
            middle: (sum.moment / sum.darkness).to_point(),
            darkness: sum.darkness / (unit * unit),
            size: ((sum.bounds.1.x - sum.bounds.0.x) / unit, (sum.bounds.1.y - sum.bounds.0.y) / unit),
        })
        .collect()
}

/// The best frame over all pairs of clusters as eyes, with its total score.
fn best_frame(first: &FaceFrame, clusters: &[Cluster]) -> Option<(f64, FaceFrame)> {
    let mut best: Option<(f64, FaceFrame)> = None;
    for (i, left) in clusters.iter().enumerate() {
        for (k, right) in clusters.iter().enumerate().filter(|(k, right)| *k != i && right.middle.x > left.middle.x) {
            let Some((eyes, frame)) = eyes(first, left, right) else { continue };
            for stretch in STRETCHES {
                let frame = FaceFrame { stretch, ..frame };
                let others = clusters.iter().enumerate().filter(|(j, _)| *j != i && *j != k).map(|(_, cluster)| *cluster);
                let total = eyes - COSTS.2 * ((stretch - first.stretch).abs() + (stretch - 1.0).abs()) + likeness(&frame, others);
                if best.is_none_or(|(most, _)| total > most) {
                    best = Some((total, frame));
                }
            }
        }
    }
    best
}

/// Score of two clusters as eyes, and their frame; none if they cannot be eyes.
fn eyes(first: &FaceFrame, left: &Cluster, right: &Cluster) -> Option<(f64, FaceFrame)> {
    let along = right.middle - left.middle;
    let (distance, tilt) = (along.hypot(), angle_of(along));
    let share = distance / first.eye_distance;
    let is_eye = |cluster: &Cluster| cluster.size.0 <= LARGEST_EYE.0 && cluster.size.1 <= LARGEST_EYE.1;
    if tilt.abs() > STEEPEST || share < SIZES.0 || share > SIZES.1 || !is_eye(left) || !is_eye(right) {
        return None;
    }
    let middle = left.middle.midpoint(right.middle);
    let offset = (middle - first.between_eyes).hypot() / first.eye_distance;
    let off = [tilt / TOLERANCES.0, share.logarithm() / TOLERANCES.1, offset / TOLERANCES.2];
    let surprise =
        COSTS.0 * off.iter().map(|off| off * off).sum::<f64>() + COSTS.1 * (left.darkness / right.darkness).logarithm().abs();
    let frame = FaceFrame { between_eyes: middle, eye_distance: distance, tilt, ..*first };
    Some((EYES_WEIGHT * (weight(left) + weight(right)) - surprise, frame))
}

/// Sum of the scores of the best cluster for each other feature.
fn likeness(frame: &FaceFrame, clusters: impl Iterator<Item = Cluster>) -> f64 {
    let mut most = [0.0_f64; OTHERS.len()];
    for cluster in clusters {
        let (across, down) = frame.relative(cluster.middle);
        for (most, [x, y, reach_x, reach_y, width, _]) in most.iter_mut().zip(OTHERS) {
            let size = (cluster.size.0.max(0.05) / width).logarithm() / WIDTH_TOLERANCE;
            let off = ((across - x) / reach_x).powi(2) + ((down - y) / reach_y).powi(2) + size * size;
            *most = most.max(weight(&cluster) * (-0.5 * off).exponential());
        }
    }
    most.iter().zip(OTHERS).map(|(most, [.., weight])| weight * most).sum()
}

/// Weight of a cluster, 0 to 1.
fn weight(cluster: &Cluster) -> f64 {
    1.0 - (-cluster.darkness / DARK_ENOUGH).exponential()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eyes_are_told_from_the_brows_and_the_fringe() {
        let marks = [
            (-0.5, 0.0, 0.2, 0.08),
            (0.5, 0.0, 0.2, 0.08),
            (-0.5, -0.3, 0.28, 0.04),
            (0.5, -0.3, 0.28, 0.04),
            (0.0, 0.62, 0.18, 0.06),
            (0.0, 1.06, 0.35, 0.08),
        ];
        let lightness = Raster::from_fn(260, 300, |x, y| {
            let (across, down) = ((x as f64 - 130.0) / 80.0, (y as f64 - 120.0) / 80.0);
            let is_mark = marks.iter().any(|&(cx, cy, w, h)| ((across - cx) / w).hypotenuse((down - cy) / h) < 1.0);
            if down < -0.5 || is_mark { 0.25 } else { 0.8 }
        });
        let first = FaceFrame {
            between_eyes: Point::new(138.0, 108.0),
            eye_distance: 88.0,
            stretch: 0.9,
            tilt: 0.06,
            score: 0.2,
            windows: crate::field::USUAL_WINDOWS,
        };
        let frame = fitted(&first, &lightness, &Raster::filled(260, 300, 1.0));
        assert!(frame.between_eyes.distance(Point::new(130.0, 120.0)) < 2.0, "{frame:?}");
        assert!((frame.eye_distance - 80.0).abs() < 2.0 && frame.tilt.abs() < 0.02, "{frame:?}");
    }
}
