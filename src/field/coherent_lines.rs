//! From the pixels of coherent lines to curves with a width (lines as in Son et al. 2011, section 4.1; Bruehl 2023, section 4.3.1,
//! suggests them instead of Canny's edges).

use super::curve::Curve;
use super::distance::nearest_seed;
use super::flow_dog::FlowLines;
use super::trace::trace;
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Vec2, smooth_polyline};
use crate::raster::{Raster, components, remove_components, thin};

/// A line and its full width at each of the curve's points, both in pixels.
#[derive(Clone, Debug)]
pub struct CoherentLine {
    /// Smooth, its points about 1.5 pixels apart.
    pub curve: Curve,
    /// One for each point.
    pub widths: Vec<f64>,
    /// Mean difference of grey between the line and both sides, 0 to 1.
    pub contrast: f64,
}

impl CoherentLine {
    /// A line of one width that was not found but given: its contrast is full.
    pub fn plain(curve: Curve, width: f64) -> Self {
        Self { widths: vec![width; curve.points.len()], curve, contrast: 1.0 }
    }

    /// The same line, its widths multiplied by a share.
    #[must_use]
    pub(crate) fn widened(&self, share: f64) -> Self {
        Self { widths: self.widths.iter().map(|width| share * width).collect(), ..self.clone() }
    }

    /// The runs of its points that are kept, with their widths; itself if all are.
    pub fn runs(&self, is_kept: &[bool]) -> Vec<Self> {
        if is_kept.iter().all(|&keep| keep) {
            return vec![self.clone()];
        }
        let mut out = Vec::new();
        let mut start = 0;
        for run in is_kept.chunk_by(|a, b| a == b) {
            let range = start..start + run.len();
            start += run.len();
            if run[0] && run.len() > 2 {
                let curve = Curve { points: self.curve.points[range.clone()].to_vec(), closed: false };
                out.push(Self { curve, widths: self.widths[range].to_vec(), contrast: self.contrast });
            }
        }
        out
    }

    /// The parts of it at which `keep` is true; itself if it is everywhere, else those of at least `least` pixels. A closed line ends only
    /// where it is cut.
    pub(crate) fn parts_where(&self, keep: impl Fn(&Point) -> bool, least: f64) -> Vec<Self> {
        let mut is_kept: Vec<bool> = self.curve.points.iter().map(keep).collect();
        let Some(first) = is_kept.iter().position(|kept| !kept) else { return vec![self.clone()] };
        let mut line = self.clone();
        if line.curve.closed {
            line.curve.points.rotate_left(first);
            line.widths.rotate_left(first);
            is_kept.rotate_left(first);
        }
        let mut parts = line.runs(&is_kept);
        parts.retain(|part| part.curve.length() >= least);
        parts
    }
}

/// Every step from pixels to curves, for `stages`.
#[derive(Clone, Debug)]
pub struct CoherentLines {
    /// The lines' pixels without the short ones.
    pub kept: Raster<u8>,
    /// One pixel wide.
    pub skeleton: Raster<u8>,
    /// The curves.
    pub lines: Vec<CoherentLine>,
}

/// Distance between a curve's points in pixels.
const SPACING: f64 = 1.5;

/// Thins, traces and smooths (`smoothing` pixels along the line); lines shorter than `least` pixels are left out. A line's width is
/// twice the distance from its middle to the nearest pixel off the line. `grey` is the raster in which they were found.
pub fn coherent_lines(found: &FlowLines, grey: &Raster<f32>, smoothing: f64, least: f64) -> CoherentLines {
    let kept = without_short(&found.line, least);
    let skeleton = thin(&kept);
    let outside = nearest_seed(&kept.map(|v| 1 - v));
    let lines = trace(&skeleton)
        .into_iter()
        .filter(|line| line.length() >= least)
        .map(|line| Curve {
            points: smooth_polyline(&line.points, line.closed.into(), smoothing.max(0.5), SPACING),
            closed: line.closed,
        })
        .filter(|line| line.points.len() > 2)
        .map(|curve| {
            let widths = widths(&curve, &kept, outside.as_ref(), smoothing);
            let contrast = contrast(&curve, &widths, grey);
            CoherentLine { curve, widths, contrast }
        })
        .collect();
    CoherentLines { kept, skeleton, lines }
}

/// Drops connected lines of fewer skeleton pixels than `least`.
fn without_short(line: &Raster<u8>, least: f64) -> Raster<u8> {
    let (labels, count) = components(line);
    let mut length = vec![0_u32; count + 1];
    for (&label, &marked) in labels.pixels().iter().zip(thin(line).pixels()) {
        length[label as usize] += u32::from(marked != 0);
    }
    remove_components(line, &labels, |label| f64::from(length[label as usize]) >= least)
}

fn widths(curve: &Curve, kept: &Raster<u8>, outside: Option<&Raster<u32>>, smoothing: f64) -> Vec<f64> {
    let Some(outside) = outside else { return vec![1.0; curve.points.len()] };
    let columns = kept.width();
    let raw: Vec<f64> = curve.points.iter().map(|p| width_at(*p, kept, outside, columns)).collect();
    let reach = (2.0 * smoothing / SPACING).ceil() as isize;
    let count = raw.len() as isize;
    (0..count)
        .map(|i| {
            let (mut sum, mut total) = (0.0, 0.0);
            for j in -reach..=reach {
                let k = if curve.closed { (i + j).rem_euclid(count) } else { (i + j).clamp(0, count - 1) };
                let weight = (-0.5 * (j as f64 * SPACING / smoothing).powi(2)).exponential();
                sum += weight * raw[k as usize];
                total += weight;
            }
            sum / total
        })
        .collect()
}

/// Distance beyond its half width at which a line's surroundings are read, in pixels.
const BESIDE: f64 = 2.0;

fn contrast(curve: &Curve, widths: &[f64], grey: &Raster<f32>) -> f64 {
    let last = curve.points.len() - 1;
    let sum: f64 = (0..=last)
        .map(|i| {
            let way = curve.points[(i + 1).min(last)] - curve.points[i.saturating_sub(1)];
            let side = if way.hypot() > 0.0 { way.normalize().turn_90() * (0.5 * widths[i] + BESIDE) } else { Vec2::ZERO };
            let greys = [-1.0, 0.0, 1.0].map(|k| curve.points[i] + side * k).map(|p| grey.sample(p.x, p.y));
            f64::from(
                greys.iter().copied().fold(f32::NEG_INFINITY, f32::max) - greys.iter().copied().fold(f32::INFINITY, f32::min),
            )
        })
        .sum();
    sum / (last + 1) as f64
}

/// Width at a place: in a line one pixel wide the nearest outside pixel is one pixel away, in a line two pixels wide one or two.
fn width_at(p: Point, kept: &Raster<u8>, outside: &Raster<u32>, columns: usize) -> f64 {
    let x = (p.x.max(0.0) as usize).min(kept.width() - 1);
    let y = (p.y.max(0.0) as usize).min(kept.height() - 1);
    let nearest = outside.get(x, y) as usize;
    let away = Point::new((nearest % columns) as f64, (nearest / columns) as f64).distance(Point::new(x as f64, y as f64));
    (2.0 * away - 1.0).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_s_middle_and_width_are_found_and_a_speck_is_left_out() {
        let line = Raster::from_fn(100, 40, |x, y| u8::from((10..90).contains(&x) && (18..23).contains(&y) || (x < 4 && y < 4)));
        let found = FlowLines { response: Raster::filled(100, 40, 0.0), line };
        let grey = found.line.map(|v| 1.0 - 0.6 * f32::from(v));
        let lines = coherent_lines(&found, &grey, 3.0, 12.0).lines;
        assert_eq!(lines.len(), 1);
        let middle = lines[0].curve.points.len() / 2;
        assert!((lines[0].curve.points[middle].y - 20.5).abs() < 0.6);
        assert!((lines[0].contrast - 0.6).abs() < 0.05, "{}", lines[0].contrast);
        assert!((lines[0].widths[middle] - 5.0).abs() < 0.3, "{}", lines[0].widths[middle]);
    }
}
