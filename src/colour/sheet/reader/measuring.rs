//! The colour of a patch relative to the paper around it.

use super::chroma::Chroma;
use super::light::Light;
use super::picture::Probe;
use super::sensor::balanced;
use super::view::View;
use crate::geometry::{Point, Rect};

/// Samples along each side of a window: about one for each pixel, and enough for fine hatching.
const LEAST_SAMPLES: usize = 24;
const MOST_SAMPLES: usize = 128;
/// Deviations from the median beyond which a sample has no weight (Tukey's biweight), and rounds.
const BEYOND: f32 = 4.0;
const ROUNDS: usize = 5;
/// Least deviation, relative to paper: below it lies the rounding of 8 bits.
const LEAST_DEVIATION: f32 = 0.002;

/// What a patch is made of decides how its samples become one colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// One film of ink: hairlines of paper between the pen's strokes are left out.
    Film,
    /// Lines and paper: the plain mean. The ink is the pen's solid patch relative to paper.
    Lines([f64; 3]),
}

/// A colour as the picture has it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sampled {
    /// Relative to paper in each channel.
    pub colour: [f64; 3],
    /// The plain mean, the same way.
    pub mean: [f64; 3],
    /// The paper there.
    pub paper: [f64; 3],
    /// Robust standard deviation of the samples in their noisiest channel, relative to paper.
    pub deviation: f64,
}

impl Sampled {
    /// The colour if paper were seen as `paper`, relative to it.
    pub(super) fn on(&self, paper: [f64; 3]) -> [f64; 3] {
        let seen = std::array::from_fn(|c| self.colour[c] * self.paper[c]);
        let colour = balanced(seen, self.paper, paper);
        std::array::from_fn(|c| colour[c] / paper[c])
    }
}

/// Reads a window of the sheet.
pub(super) fn sampled(view: &View, probe: &Probe<'_>, light: &Light, window: Rect, kind: Kind) -> Sampled {
    let side = window.width().max(window.height()) * view.scale(window.center());
    let count = ((1.3 * side).ceil() as usize).clamp(LEAST_SAMPLES, MOST_SAMPLES);
    let corners = [(window.x0, window.y0), (window.x1, window.y0), (window.x0, window.y1), (window.x1, window.y1)];
    let corners = corners.map(|p| light.at(Point::from(p)));
    let paper = light.at(window.center());
    let place = |u: f64, v: f64| view.at(Point::new(window.x0 + u * window.width(), window.y0 + v * window.height()));
    let at = |k: usize| (((k % count) as f64 + 0.5) / count as f64, ((k / count) as f64 + 0.5) / count as f64);
    let chroma = match kind {
        Kind::Film => None,
        Kind::Lines(ink) => chroma(probe, paper, ink, (0..count * count).map(|k| place(at(k).0, at(k).1))),
    };
    let mut channels = [const { Vec::new() }; 3];
    for (u, v) in (0..count * count).map(at) {
        let p = place(u, v);
        let value = chroma.map_or_else(|| probe.at(p), |chroma| probe.restored_at(p, &chroma));
        for (c, channel) in channels.iter_mut().enumerate() {
            let top = corners[0][c] * (1.0 - u) + corners[1][c] * u;
            let bottom = corners[2][c] * (1.0 - u) + corners[3][c] * u;
            channel.push(value[c] / (top * (1.0 - v) + bottom * v) as f32);
        }
    }
    let mean = std::array::from_fn(|c| mean(&channels[c]));
    let film = channels.map(biweight);
    let colour = if kind == Kind::Film { film.map(|(colour, _)| colour) } else { mean };
    let deviation = film.iter().fold(0.0, |most, (_, spread)| spread.max(most));
    Sampled { colour, mean, paper, deviation }
}

/// How colour follows luma among lines of ink on paper, over these places.
fn chroma(probe: &Probe<'_>, paper: [f64; 3], ink: [f64; 3], places: impl Iterator<Item = Point>) -> Option<Chroma> {
    let (mut sum, mut count) = ([0.0_f64; 3], 0.0);
    for value in places.filter_map(|p| probe.encoded_at(p)) {
        sum = std::array::from_fn(|c| sum[c] + f64::from(value[c]));
        count += 1.0;
    }
    let seen = std::array::from_fn(|c| ink[c] * paper[c]);
    if count > 0.0 { Chroma::of(paper, seen, probe.curve(), sum.map(|v| (v / count) as f32)) } else { None }
}

fn mean(values: &[f32]) -> f64 {
    values.iter().map(|v| f64::from(*v)).sum::<f64>() / values.len().max(1) as f64
}

/// Tukey's biweight mean, and the robust deviation.
fn biweight(mut values: Vec<f32>) -> (f64, f64) {
    let middle = values.len() / 2;
    let median = |values: &mut [f32]| values.select_nth_unstable_by(middle, f32::total_cmp).1.to_owned();
    let mut centre = median(&mut values);
    let mut off: Vec<f32> = values.iter().map(|v| (v - centre).abs()).collect();
    let deviation = 1.4826 * median(&mut off);
    let reach = BEYOND * deviation.max(LEAST_DEVIATION);
    for _ in 0..ROUNDS {
        let (mut sum, mut whole) = (0.0_f64, 0.0_f64);
        for v in &values {
            let t = (v - centre) / reach;
            if t.abs() < 1.0 {
                let weight = f64::from((1.0 - t * t) * (1.0 - t * t));
                (sum, whole) = (sum + weight * f64::from(*v), whole + weight);
            }
        }
        if whole > 0.0 {
            centre = (sum / whole) as f32;
        }
    }
    (f64::from(centre), f64::from(deviation))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hairlines_do_not_count() {
        let values: Vec<f32> = (0..1000).map(|i| if i % 12 == 0 { 0.9 } else { 0.2 + 0.01 * ((i % 7) as f32 - 3.0) }).collect();
        let (centre, deviation) = biweight(values);
        assert!((centre - 0.2).abs() < 0.003 && deviation < 0.03, "{centre} {deviation}");
    }
}
