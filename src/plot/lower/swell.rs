//! A pen whose line swells as it is lowered, such as a brush: a stroke is one pass whose height follows its width.

use super::super::Toolpath;
use crate::drawing::Stroke;
use crate::geometry::Point;

/// How wide a line a pen draws at which height: two or more pairs of width and height in millimetres, widths ascending.
#[derive(Clone, Debug, PartialEq)]
pub struct Swell {
    /// Widths and the heights at which they are drawn.
    pub heights: Vec<[f64; 2]>,
}

impl Swell {
    /// The height for a width, between the table's; the nearest end's beyond it.
    pub fn height(&self, width: f64) -> f64 {
        let after = self.heights.partition_point(|pair| pair[0] < width);
        let at = |i: usize| self.heights[i.min(self.heights.len() - 1)];
        let (low, high) = (at(after.saturating_sub(1)), at(after));
        let span = high[0] - low[0];
        let share = if span > 0.0 { ((width - low[0]) / span).clamp(0.0, 1.0) } else { 0.0 };
        low[1] + (high[1] - low[1]) * share
    }

    /// The width at a height, the other way round.
    pub fn width(&self, height: f64) -> f64 {
        let covers = |pair: &[[f64; 2]]| (pair[0][1].min(pair[1][1])..=pair[0][1].max(pair[1][1])).contains(&height);
        match self.heights.windows(2).find(|pair| covers(pair)) {
            Some(pair) if pair[1][1] != pair[0][1] => {
                pair[0][0] + (pair[1][0] - pair[0][0]) * (height - pair[0][1]) / (pair[1][1] - pair[0][1])
            }
            Some(pair) => pair[0][0],
            None => {
                let nearest = self.heights.iter().min_by(|a, b| (a[1] - height).abs().total_cmp(&(b[1] - height).abs()));
                nearest.map_or(0.0, |pair| pair[0])
            }
        }
    }

    /// The widest line.
    pub fn widest(&self) -> f64 {
        self.heights.last().map_or(0.0, |pair| pair[0])
    }
}

/// A stroke no wider than the pen can swell, as one pass. None for wider ones, which are filled.
pub(super) fn swelling_pass(stroke: &Stroke, swell: &Swell, tolerance: f64) -> Option<Vec<Toolpath>> {
    if swell.heights.is_empty() || stroke.widest() > swell.widest() {
        return None;
    }
    let (points, widths) = stroke.sampled(0.5 * swell.widest());
    let samples: Vec<(Point, f64)> = points
        .into_iter()
        .zip(widths)
        .filter(|(p, w)| p.is_finite() && w.is_finite())
        .map(|(p, w)| (p, swell.height(w)))
        .collect();
    let kept = kept(&samples, tolerance);
    let points: Vec<Point> = kept.iter().map(|&i| samples[i].0).collect();
    let heights = kept.iter().map(|&i| samples[i].1).collect();
    (!points.is_empty()).then(|| vec![Toolpath { heights: Some(heights), ..Toolpath::new(points) }])
}

/// Samples that a straight line in the page and in height does not give within the tolerance (Douglas and Peucker 1973).
fn kept(samples: &[(Point, f64)], tolerance: f64) -> Vec<usize> {
    if samples.len() < 3 {
        return (0..samples.len()).collect();
    }
    let mut keep = vec![false; samples.len()];
    keep[0] = true;
    keep[samples.len() - 1] = true;
    let mut ranges = vec![(0, samples.len() - 1)];
    while let Some((first, last)) = ranges.pop() {
        let (a, b) = (samples[first], samples[last]);
        let chord = b.0 - a.0;
        let strays = |i: usize| {
            let (p, height) = samples[i];
            let share = if chord.hypot2() > 0.0 { ((p - a.0).dot(chord) / chord.hypot2()).clamp(0.0, 1.0) } else { 0.0 };
            p.distance(a.0 + chord * share).max((a.1 + (b.1 - a.1) * share - height).abs())
        };
        let farthest =
            (first + 1..last).map(|i| (strays(i), i)).fold((0.0, 0), |best, next| if next.0 > best.0 { next } else { best });
        if farthest.0 > tolerance {
            keep[farthest.1] = true;
            ranges.extend([(first, farthest.1), (farthest.1, last)]);
        }
    }
    (0..samples.len()).filter(|&i| keep[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Width;
    use crate::geometry::BezPath;

    #[test]
    fn a_spindle_is_one_pass_that_sinks_and_rises() {
        let swell = Swell { heights: vec![[0.1, 0.0], [1.1, -2.0]] };
        let spindle = |most: f64| Stroke::new(BezPath::from_svg("M0,0 L10,0 L20,0").unwrap(), Width::Along(vec![0.1, most, 0.1]));
        let paths = swelling_pass(&spindle(1.1), &swell, 0.02).unwrap();
        assert_eq!(paths.len(), 1);
        let heights = paths[0].heights.as_ref().unwrap();
        assert_eq!(heights.len(), paths[0].points.len());
        let at = |x: f64| heights[paths[0].points.iter().position(|p| (p.x - x).abs() < 0.3).unwrap()];
        assert!(at(0.0).abs() < 0.05 && (at(10.0) + 2.0).abs() < 0.05 && at(20.0).abs() < 0.05);
        assert!(swelling_pass(&spindle(1.2), &swell, 0.02).is_none());
    }

    #[test]
    fn heights_lie_between_the_table_s() {
        let swell = Swell { heights: vec![[0.2, 1.0], [0.4, 0.0], [1.0, -3.0]] };
        for (width, height) in [(0.0, 1.0), (0.2, 1.0), (0.3, 0.5), (0.7, -1.5), (2.0, -3.0)] {
            assert!((swell.height(width) - height).abs() < 1e-9, "{width}");
            assert!((swell.width(height) - width.clamp(0.2, 1.0)).abs() < 1e-9, "{width}");
        }
    }
}
