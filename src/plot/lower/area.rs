//! A filled outline with one nib: rings that follow the outline, from its border inwards, joined where they lie side by side.

use super::super::Toolpath;
use super::dot::OVERLAP;
use crate::drawing::Area;
use crate::geometry::{BezPath, Insets, Point};
use kurbo::Shape;

/// The paths that fill an area. Parts narrower than the nib cannot be filled without spilling; a sliver nowhere as wide as the nib
/// is drawn along its border if it has at least half of a touch's ink, else as a touch.
pub(super) fn fill_area(area: &Area, nib: f64, tolerance: f64) -> Vec<Toolpath> {
    let pitch = nib * (1.0 - OVERLAP);
    let insets = Insets::new(&area.outline, 0.5 * tolerance);
    let mut rings = Vec::new();
    let mut depth = 0.5 * nib;
    loop {
        let next = insets.rings(depth);
        if next.is_empty() {
            break;
        }
        rings.push(next);
        depth += pitch;
    }
    // What is left in the middle may be nearly two pitches wide: half a step more covers it.
    let last = insets.rings(depth - 0.5 * pitch);
    if !rings.is_empty() && !last.is_empty() {
        rings.push(last);
    }
    if rings.is_empty() { sliver(&area.outline, nib) } else { joined(rings, 1.5 * pitch) }
}

/// Something smaller than the nib.
fn sliver(outline: &BezPath, nib: f64) -> Vec<Toolpath> {
    let least = std::f64::consts::FRAC_PI_4 * nib * nib;
    let area = outline.area().abs();
    let bounds = outline.bounding_box();
    if area < 0.25 * least || !bounds.is_finite() {
        return Vec::new();
    }
    // Along its longer side, as long as its ink at the nib's width is its area.
    let middle = bounds.center();
    let length = (area / nib - nib).clamp(0.0, bounds.width().max(bounds.height()));
    let half = if bounds.width() >= bounds.height() { (0.5 * length, 0.0) } else { (0.0, 0.5 * length) };
    let ends = [middle - half, middle + crate::geometry::Vec2::new(half.0, half.1)];
    vec![Toolpath::new(if length > 0.01 { ends.to_vec() } else { vec![middle] })]
}

/// Rings as few paths: each continues at the nearest ring of the next level when a step over is short.
fn joined(levels: Vec<Vec<Vec<Point>>>, reach: f64) -> Vec<Toolpath> {
    let mut paths: Vec<Toolpath> = Vec::new();
    for ring in levels.into_iter().flatten().filter(|ring| ring.len() > 2) {
        let nearest = |from: Point| {
            let index =
                (0..ring.len()).min_by(|&a, &b| ring[a].distance_squared(from).total_cmp(&ring[b].distance_squared(from)));
            index.map(|i| (ring[i].distance(from), i))
        };
        let open = paths.iter_mut().rev().find_map(|path| {
            let (distance, start) = path.points.last().and_then(|end| nearest(*end))?;
            (distance <= reach).then_some((path, start))
        });
        let count = ring.len();
        let around = |start: usize| (0..=count).map(move |k| (start + k) % count);
        match open {
            Some((path, start)) => path.points.extend(around(start).map(|i| ring[i])),
            None => paths.push(Toolpath::new(around(0).map(|i| ring[i]).collect())),
        }
    }
    paths
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filled(text: &str, nib: f64) -> Vec<Toolpath> {
        fill_area(&Area { outline: BezPath::from_svg(text).unwrap(), colour: None }, nib, 0.02)
    }

    #[test]
    fn a_square_is_one_path_of_about_its_area_over_the_pitch() {
        let paths = filled("M0,0 H10 V10 H0 Z", 0.5);
        assert_eq!(paths.len(), 1);
        let expected = 100.0 / (0.5 * (1.0 - OVERLAP));
        assert!((paths[0].length() / expected - 1.0).abs() < 0.06, "{} for {expected}", paths[0].length());
        assert!(paths[0].points.iter().all(|p| p.x > 0.24 && p.x < 9.76 && p.y > 0.24 && p.y < 9.76));
    }

    #[test]
    fn slivers_are_lines_or_nothing() {
        let line = filled("M0,0 H5 V0.1 H0 Z", 0.3);
        assert_eq!(line.len(), 1);
        assert!((line[0].length() - (0.5 / 0.3 - 0.3)).abs() < 1e-6);
        assert!(filled("M0,0 H0.05 V0.05 H0 Z", 0.3).is_empty());
    }
}
