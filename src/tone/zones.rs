//! The skin and the features of a face.

use crate::geometry::{Point, Rect, convex_hull};
use crate::raster::{Raster, dilate, fast_gaussian, fast_gaussian_within, filled_polygon};
use crate::source::{Landmarks, outlines};
use std::ops::Range;

/// Distance of skin from the face's border and from its features, in widths of the face: lashes and shadows at the hair are not
/// skin.
const INSET: f64 = 0.04;
const ROUND_FEATURES: f64 = 0.03;
/// Margin around raised features, and the blur of their edge, in widths of the face.
const WITH_FEATURES: f64 = 0.02;
const SOFT: f64 = 0.018;
/// Skin's tones lie within this number of deviations of its median, but at least within this difference of L*/100.
const DEVIATIONS: f32 = 2.2;
const LEAST_SPREAD: f32 = 0.06;
/// Median lightness of skin that is treated as light and as dark.
const LIGHT_SKIN: f32 = 0.64;
const DARK_SKIN: f32 = 0.42;
/// Ratio of a normal distribution's standard deviation to its median absolute deviation.
const MEDIAN_DEVIATION: f32 = 1.4826;
/// Number of rounds in which outliers are removed.
const ROUNDS: usize = 4;

/// A face's zones on the working grid of the tone.
pub(super) struct Zones {
    /// Inside the outline of the face.
    pub oval: Raster<u8>,
    /// Skin without features, where tones are measured.
    pub counted: Raster<u8>,
    /// The part of `counted` with skin's tones, 0 or 1.
    pub skin: Raster<f32>,
    /// Eyes, brows and lips, with soft edges.
    pub features: Raster<f32>,
    /// Median of the skin's lightness.
    pub median: f32,
    /// The face's width in pixels.
    pub width: f64,
}

impl Zones {
    /// `None` if the face has no pixels of skin.
    pub(super) fn new(face: &Landmarks, lightness: &Raster<f32>) -> Option<Self> {
        let (columns, rows) = (lightness.width(), lightness.height());
        let width = face.width();
        let oval = polygon(columns, rows, &face.line(&outlines::OVAL));
        let parts: [&[usize]; 5] =
            [&outlines::LEFT_EYE, &outlines::RIGHT_EYE, &outlines::LEFT_BROW, &outlines::RIGHT_BROW, &outlines::LIPS];
        let parts = parts.map(|indices| polygon(columns, rows, &convex_hull(face.line(indices))));
        let parts = parts.iter().fold(oval.map(|_| 0), |all: Raster<u8>, part| all.zip_map(part, |a, b| a | b));
        let pixels = |share: f64| (share * width).round().max(1.0) as usize;
        let outside = dilate(&oval.map(|v| 1 - v), pixels(INSET));
        let counted = outside.zip_map(&dilate(&parts, pixels(ROUND_FEATURES)), |out, part| u8::from(out == 0 && part == 0));
        let (median, spread) = skin_tones(lightness, &counted)?;
        let skin = counted.zip_map(lightness, |v, l| f32::from(u8::from(v == 1 && (l - median).abs() < 1.4 * spread)));
        let features = fast_gaussian(&dilate(&parts, pixels(WITH_FEATURES)).map(f32::from), (SOFT * width) as f32);
        Some(Self { oval, counted, skin, features, median, width })
    }

    /// A percentile of the values over the counted skin.
    pub(super) fn percentile(&self, values: &Raster<f32>, hundredths: f64) -> f32 {
        let sorted = sorted_where(values, &self.counted);
        sorted[((hundredths / 100.0 * (sorted.len() - 1) as f64).round() as usize).min(sorted.len() - 1)]
    }

    /// The median of values over `skin`.
    pub(super) fn median_of(&self, values: &Raster<f32>) -> f32 {
        let sorted = sorted_where(values, &self.skin.map(|v| u8::from(v > 0.0)));
        sorted.get(sorted.len() / 2).copied().unwrap_or(self.median)
    }

    /// A value between that for light skin and that for dark.
    pub(super) fn by_skin(&self, [light, dark]: [f64; 2]) -> f64 {
        let share = f64::from((LIGHT_SKIN - self.median) / (LIGHT_SKIN - DARK_SKIN)).clamp(0.0, 1.0);
        light + share * (dark - light)
    }

    /// Values blurred over the weighted area only; `share` is sigma in widths of the face.
    pub(super) fn over_skin(&self, values: &Raster<f32>, weight: &Raster<f32>, share: f64) -> Raster<f32> {
        fast_gaussian_within(values, weight, (share * self.width) as f32)
    }
}

/// Median and spread of the tones, without outliers: glasses, hair over the forehead, beards.
fn skin_tones(lightness: &Raster<f32>, counted: &Raster<u8>) -> Option<(f32, f32)> {
    let all = sorted_where(lightness, counted);
    let mut kept = &all[..];
    let mut spread = f32::INFINITY;
    for _ in 0..=ROUNDS {
        let median = *kept.get(kept.len() / 2)?;
        let mut off: Vec<f32> = kept.iter().map(|v| (v - median).abs()).collect();
        off.sort_unstable_by(f32::total_cmp);
        spread = (DEVIATIONS * MEDIAN_DEVIATION * off[off.len() / 2]).max(LEAST_SPREAD);
        kept = &all[all.partition_point(|v| *v < median - spread)..all.partition_point(|v| *v <= median + spread)];
    }
    Some((*kept.get(kept.len() / 2)?, spread))
}

fn sorted_where(values: &Raster<f32>, mask: &Raster<u8>) -> Vec<f32> {
    let inside = values.pixels().iter().zip(mask.pixels()).filter(|(_, inside)| **inside == 1);
    let mut inside: Vec<f32> = inside.map(|(v, _)| *v).collect();
    inside.sort_unstable_by(f32::total_cmp);
    inside
}

/// The columns and rows of the pixels in a box, within a picture of this size; none outside it.
pub(super) fn pixels_in(bounds: Rect, (width, height): (usize, usize)) -> Option<[Range<usize>; 2]> {
    let range = |from: f64, to: f64, size: usize| (from.max(0.0) as usize).min(size)..(to.max(0.0).ceil() as usize).min(size);
    let [columns, rows] = [range(bounds.x0, bounds.x1, width), range(bounds.y0, bounds.y1, height)];
    (!columns.is_empty() && !rows.is_empty()).then_some([columns, rows])
}

/// The pixels inside a closed polygon.
pub(super) fn polygon(columns: usize, rows: usize, corners: &[Point]) -> Raster<u8> {
    filled_polygon(columns, rows, &corners.iter().map(|p| [p.x, p.y]).collect::<Vec<_>>())
}
