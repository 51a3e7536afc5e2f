//! The eyebrows, eyes, nose and mouth as the dark places of a face (Wong 1999, chapter 5).
//!
//! ```text
//!   lightness -> divided by the skin's, column by column -> the darkest thin places -> grown into clusters -> named by position
//! ```

use super::super::dark_relief::dark_relief;
use super::frame::FaceFrame;
use crate::elementary::Elementary as _;
use crate::geometry::Point;
use crate::raster::{Raster, components, dilate, gaussian_blur};

/// A feature's name; left and right are the picture's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FacialFeature {
    /// The eyebrow on the picture's left.
    LeftEyebrow,
    /// The eyebrow on the picture's right.
    RightEyebrow,
    /// The eye on the picture's left.
    LeftEye,
    /// The eye on the picture's right.
    RightEye,
    /// The underside of the nose.
    Nose,
    /// The mouth.
    Mouth,
}

impl FacialFeature {
    /// All six, in the order of their labels from 1.
    pub const ALL: [Self; 6] = [Self::LeftEyebrow, Self::RightEyebrow, Self::LeftEye, Self::RightEye, Self::Nose, Self::Mouth];

    /// The feature's name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::LeftEyebrow => "left eyebrow",
            Self::RightEyebrow => "right eyebrow",
            Self::LeftEye => "left eye",
            Self::RightEye => "right eye",
            Self::Nose => "nose",
            Self::Mouth => "mouth",
        }
    }
}

/// Source of the skin's own tone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SkinTone<'a> {
    /// The median skin of each column.
    Found,
    /// Around these places, in working pixels; at least one.
    Given(&'a [Point]),
}

/// The detected features of a face.
#[derive(Clone, Debug)]
pub struct FacialFeatures {
    /// 0 outside, otherwise the index in [`FacialFeature::ALL`] plus 1.
    pub labels: Raster<u8>,
    /// The face's lightness divided by its skin's: 1 is skin.
    pub normalised: Raster<f32>,
    /// The skin's lightness in each column.
    pub skin: Vec<f32>,
    /// Number of clusters of the thresholded face, before small ones went to their neighbours and joined ones were divided.
    pub clusters: usize,
    /// The features that were found.
    pub found: Vec<FacialFeature>,
}

/// Share of the features' windows taken as dark: half of the brows' and eyes', less of nose and mouth. With less, light brows are lost;
/// with more, cheeks join the mouth.
const DARK_SHARE: f64 = 0.22;
/// Number of skin columns between which the light is interpolated (section 5.1).
const SKIN_POINTS: usize = 5;
/// A cluster smaller than this, in squared eye distances, is a speck: its pixels go to the nearest large cluster.
const LEAST_CLUSTER: f64 = 0.004;
/// Pixels farther from their window's middle than this many half sizes belong to no feature.
const WINDOW_REACH: f64 = 1.25;
/// A window has a feature only if its darkest place is darker than skin by this share.
const LEAST_DEPTH: f32 = 0.06;

/// Share of the largest cluster's pixels, weighted by nearness to the window's middle, from which another cluster joins it.
const JOINED: f64 = 0.3;
/// Width of the face's border in which no brow lies, in eye distances.
const RIM: f64 = 0.08;
/// Radius averaged around a given skin point, in eye distances.
const SKIN_RADIUS: f64 = 0.06;

/// Finds the features of a face whose pattern lies at `frame`, inside `face` (0 to 1), in `lightness` (0 to 1).
pub fn facial_features(lightness: &Raster<f32>, face: &Raster<f32>, frame: &FaceFrame, tone: SkinTone<'_>) -> FacialFeatures {
    let skin = skin_tone(lightness, face, frame, tone);
    let fine = gaussian_blur(lightness, (0.02 * frame.eye_distance) as f32);
    let normalised = Raster::from_fn(fine.width(), fine.height(), |x, y| (fine.get(x, y) / skin[x].max(0.02)).min(2.0));
    // Darker than skin and than the pixels above and below: shadows and hair over the brow are not features.
    let depth = normalised.zip_map(&dark_relief(lightness, frame.eye_distance).relief, f32::max);
    let windows = windows(frame, face);
    let threshold = threshold(&depth, &windows);
    let dark = depth.zip_map(face, |n, face| u8::from(face >= 0.5 && n < threshold));
    let within = dark.zip_map(&windows, |dark, window| dark & u8::from(window != 0));
    let (_, clusters) = components(&within);
    let labels = named(&dark, &windows, &depth, frame);
    let has = |i: usize| labels.pixels().iter().any(|label| usize::from(*label) == i + 1);
    let found = FacialFeature::ALL.into_iter().enumerate().filter(|(i, _)| has(*i)).map(|(_, feature)| feature).collect();
    FacialFeatures { labels, normalised, skin, clusters, found }
}

/// The skin's lightness in each column, interpolated between places across the face (section 5.1): those given by hand, as in the
/// thesis, or the medians around five columns.
pub(super) fn skin_tone(lightness: &Raster<f32>, face: &Raster<f32>, frame: &FaceFrame, tone: SkinTone<'_>) -> Vec<f32> {
    let places = match tone {
        SkinTone::Found => skin_columns(lightness, face, frame),
        SkinTone::Given(points) => {
            let soft = gaussian_blur(lightness, (SKIN_RADIUS * frame.eye_distance) as f32);
            let mut places: Vec<(f64, f32)> = points.iter().map(|p| (p.x, soft.sample(p.x, p.y))).collect();
            places.sort_by(|a, b| a.0.total_cmp(&b.0));
            places
        }
    };
    (0..lightness.width()).map(|x| interpolated(&places, x as f64 + 0.5)).collect()
}

/// The median skin of five columns of a face: position and lightness.
fn skin_columns(lightness: &Raster<f32>, face: &Raster<f32>, frame: &FaceFrame) -> Vec<(f64, f32)> {
    let place = |i: usize| -0.95 + 1.9 * (i as f64 + 0.5) / SKIN_POINTS as f64;
    let half = 0.95 / SKIN_POINTS as f64;
    let mut columns: Vec<(f64, Vec<f32>)> = (0..SKIN_POINTS).map(|i| (frame.place(place(i), 0.4).x, Vec::new())).collect();
    for y in 0..face.height() {
        for x in (0..face.width()).filter(|x| face.get(*x, y) >= 0.5) {
            let (across, down) = frame.relative(Point::new(x as f64 + 0.5, y as f64 + 0.5));
            if !(-0.8..1.5).contains(&down) {
                continue;
            }
            if let Some(i) = (0..SKIN_POINTS).find(|i| (across - place(*i)).abs() <= half) {
                columns[i].1.push(lightness.get(x, y));
            }
        }
    }
    columns
        .into_iter()
        .filter(|(_, values)| !values.is_empty())
        .map(|(x, mut values)| {
            values.sort_unstable_by(f32::total_cmp);
            // Slightly above the median, since features darken their columns.
            (x, values[values.len() * 3 / 5])
        })
        .collect()
}

fn interpolated(points: &[(f64, f32)], x: f64) -> f32 {
    let after = points.iter().position(|(px, _)| *px >= x);
    match after {
        None => points.last().map_or(1.0, |p| p.1),
        Some(0) => points[0].1,
        Some(i) => {
            let ((x0, a), (x1, b)) = (points[i - 1], points[i]);
            a + (b - a) * ((x - x0) / (x1 - x0).max(1e-9)) as f32
        }
    }
}

/// For each pixel of the face, the feature in whose window it lies (its index plus 1); the nearest where windows overlap.
fn windows(frame: &FaceFrame, face: &Raster<f32>) -> Raster<u8> {
    let rim = dilate(&face.map(|face| u8::from(face < 0.5)), (RIM * frame.eye_distance).round() as usize);
    Raster::from_fn(face.width(), face.height(), |x, y| {
        if face.get(x, y) < 0.5 {
            return 0;
        }
        let (across, down) = frame.relative(Point::new(x as f64 + 0.5, y as f64 + 0.5));
        let off = |feature: usize| {
            let [cx, cy, hx, hy] = frame.windows[feature];
            ((across - cx) / hx).hypotenuse((down - cy) / hy)
        };
        let nearest = (0..6).min_by(|a, b| off(*a).total_cmp(&off(*b)));
        // Dark pixels at the face's upper border are hair, not a brow.
        let is_hairline = |i: usize| i < 2 && rim.get(x, y) != 0;
        nearest.filter(|i| off(*i) <= WINDOW_REACH && !is_hairline(*i)).map_or(0, |i| i as u8 + 1)
    })
}

/// The depth below which the target share of the windows lies.
fn threshold(depth: &Raster<f32>, windows: &Raster<u8>) -> f32 {
    let mut values: Vec<f32> = depth.pixels().iter().zip(windows.pixels()).filter(|(_, w)| **w != 0).map(|(n, _)| *n).collect();
    values.sort_unstable_by(f32::total_cmp);
    values.get((DARK_SHARE * values.len() as f64) as usize).copied().unwrap_or(0.0).min(1.0 - LEAST_DEPTH)
}

/// Clusters by name: in each window the largest one, joined by the smaller ones near it (the thesis's reclustering).
fn named(dark: &Raster<u8>, windows: &Raster<u8>, depth: &Raster<f32>, frame: &FaceFrame) -> Raster<u8> {
    let least = LEAST_CLUSTER * frame.eye_distance.powi(2);
    let mut labels = dark.map(|_| 0_u8);
    for name in 1..=6_u8 {
        let mut part = dark.zip_map(windows, |d, w| u8::from(d != 0 && w == name));
        if part.pixels().iter().map(|v| f64::from(*v)).sum::<f64>() < least {
            part = darkest_of(depth, windows, name);
        }
        let (clusters, count) = components(&part);
        let mut sizes = vec![0_u32; count + 1];
        clusters.pixels().iter().for_each(|c| sizes[*c as usize] += 1);
        let weights = weights(&clusters, count, frame, name);
        let Some(main) = (1..=count).max_by(|a, b| weights[*a].total_cmp(&weights[*b])) else { continue };
        if f64::from(sizes[main]) < least {
            continue;
        }
        for (label, (&cluster, &inside)) in labels.pixels_mut().iter_mut().zip(clusters.pixels().iter().zip(part.pixels())) {
            let is_near = cluster as usize == main || weights[cluster as usize] > JOINED * weights[main];
            if inside != 0 && is_near {
                *label = name;
            }
        }
    }
    labels
}

/// Number of pixels of each cluster, weighted by nearness to the window's middle.
fn weights(clusters: &Raster<u32>, count: usize, frame: &FaceFrame, name: u8) -> Vec<f64> {
    let [cx, cy, hx, hy] = frame.windows[usize::from(name) - 1];
    let mut weights = vec![0.0; count + 1];
    for (i, cluster) in clusters.pixels().iter().enumerate().filter(|(_, cluster)| **cluster != 0) {
        let p = Point::new((i % clusters.width()) as f64 + 0.5, (i / clusters.width()) as f64 + 0.5);
        let (across, down) = frame.relative(p);
        weights[*cluster as usize] += (-(((across - cx) / hx).powi(2) + ((down - cy) / hy).powi(2))).exponential();
    }
    weights
}

/// Fallback if the common threshold finds nothing: the darkest seventh of the window, if darker than the rest of it.
fn darkest_of(depth: &Raster<f32>, windows: &Raster<u8>, name: u8) -> Raster<u8> {
    let mut values: Vec<f32> =
        depth.pixels().iter().zip(windows.pixels()).filter(|(_, w)| **w == name).map(|(n, _)| *n).collect();
    values.sort_unstable_by(f32::total_cmp);
    let (Some(&least), middle) = (values.get(values.len() / 7), values.get(values.len() / 2)) else {
        return windows.map(|_| 0);
    };
    let is_deep = middle.is_some_and(|middle| middle - least > 0.5 * LEAST_DEPTH);
    depth.zip_map(windows, |n, w| u8::from(is_deep && w == name && n <= least))
}
