//! For a pen whose line swells as it is lowered, such as a brush: a stroke becomes one pass whose height follows its width.

use super::super::Toolpath;
use super::super::profile::Swell;
use crate::drawing::Stroke;
use crate::geometry::Point;

/// A stroke as one pass, if it is no wider than the pen's widest line. None for wider ones, which are filled.
pub(super) fn swelling_pass(stroke: &Stroke, swell: &Swell, tolerance: f64) -> Option<Vec<Toolpath>> {
    if stroke.widest() > swell.widest() {
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
    Some(vec![Toolpath::new(points)?.with_heights(heights)?])
}

/// Indices of the samples to keep: those that a straight line in position and height does not reproduce within the tolerance
/// (Douglas and Peucker 1973).
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
    use crate::geometry::BezPath;

    #[test]
    fn a_spindle_is_one_pass_that_sinks_and_rises() {
        let swell = Swell { table: vec![[0.1, 0.0], [1.1, -2.0]] };
        let spindle = |most: f64| Stroke::swelling(BezPath::from_svg("M0,0 L10,0 L20,0").unwrap(), vec![0.1, most, 0.1]).unwrap();
        let paths = swelling_pass(&spindle(1.1), &swell, 0.02).unwrap();
        assert_eq!(paths.len(), 1);
        let heights = paths[0].heights().unwrap();
        let at = |x: f64| heights[paths[0].points().iter().position(|p| (p.x - x).abs() < 0.3).unwrap()];
        assert!(at(0.0).abs() < 0.05 && (at(10.0) + 2.0).abs() < 0.05 && at(20.0).abs() < 0.05);
        assert!(swelling_pass(&spindle(1.2), &swell, 0.02).is_none());
    }
}
