//! A filled outline with one nib: rings that follow the outline, from its border inwards, or one ring and hatching inside it, whichever
//! is shorter; parts narrower than the nib are drawn like thin lines.

use super::super::Toolpath;
use super::dash::dashes;
use super::dot::OVERLAP;
use super::hatch::hatching;
use super::needle::needle;
use crate::drawing::Area;
use crate::geometry::{Insets, Point, distance_to_segment, polygon_area, resample};
use crate::interrupt::Interrupt;
use std::f64::consts::FRAC_PI_4;

/// What lifting and lowering the pen once more is worth in millimetres of line, when two ways to fill are compared: 0.35 s of a servo
/// at 30 mm/s, about.
const LIFT: f64 = 10.0;
/// A narrow part is worth drawing from this share of a touch's ink: corners of wide parts stay round.
const LEAST_PART: f64 = 0.5;

/// The paths that fill an area; some of them once the interrupt is raised. `phase` says where in their rhythm the dashes of narrow
/// parts begin.
pub(super) fn fill_area(area: &Area, nib: f64, tolerance: f64, phase: f64, interrupt: &Interrupt) -> Vec<Toolpath> {
    let pitch = nib * (1.0 - OVERLAP);
    let insets = Insets::new(&area.outline, 0.5 * tolerance);
    let rings = rings(&insets, nib, pitch, interrupt);
    let ringed = joined(&rings, 1.5 * pitch, interrupt);
    let mut paths = match rings.first().and_then(|border| hatching(&insets, border, nib, pitch, interrupt)) {
        Some(hatched) if cost(&hatched) < cost(&ringed) => hatched,
        _ => ringed,
    };
    let least = LEAST_PART * FRAC_PI_4 * nib * nib;
    if interrupt.is_raised() {
        return paths;
    }
    for (i, part) in insets.narrow_parts(0.5 * nib).into_iter().filter(|part| polygon_area(part).abs() >= least).enumerate() {
        paths.extend(dashes(&needle(&part, nib), nib, phase + 0.618 * i as f64));
    }
    paths
}

fn cost(paths: &[Toolpath]) -> f64 {
    paths.iter().map(|path| path.length() + LIFT).sum()
}

/// Rings half a nib inside the border and then a pitch further in each time, level by level; between two levels, pieces of a ring where
/// the next one is missing and the middle would stay bare.
fn rings(insets: &Insets, nib: f64, pitch: f64, interrupt: &Interrupt) -> Vec<Vec<Vec<Point>>> {
    let mut levels = Vec::new();
    let mut depth = 0.5 * nib;
    let mut rings = insets.rings(depth);
    while !rings.is_empty() && !interrupt.is_raised() {
        let next = insets.rings(depth + pitch);
        let between = insets.rings(depth + 0.5 * pitch);
        let pieces: Vec<Vec<Point>> = between.iter().flat_map(|ring| far_pieces(ring, &next, 0.75 * pitch, interrupt)).collect();
        levels.push(rings.into_iter().filter(|ring| ring.len() > 2).map(closed).collect());
        if !pieces.is_empty() {
            levels.push(pieces);
        }
        rings = next;
        depth += pitch;
    }
    levels
}

fn closed(mut ring: Vec<Point>) -> Vec<Point> {
    ring.push(ring[0]);
    ring
}

/// The parts of a ring farther than `reach` from every other ring, as open lines; the whole ring, closed, where that is all of it.
fn far_pieces(ring: &[Point], others: &[Vec<Point>], reach: f64, interrupt: &Interrupt) -> Vec<Vec<Point>> {
    let points = resample(&closed(ring.to_vec()), 0.6 * reach);
    let is_near = |p: Point| {
        let sides = others.iter().flat_map(|other| (0..other.len()).map(move |i| (other[i], other[(i + 1) % other.len()])));
        sides.into_iter().any(|(a, b)| {
            let (low, high) = (a.x.min(b.x) - reach, a.x.max(b.x) + reach);
            (low..=high).contains(&p.x) && distance_to_segment(p, a, b) <= reach
        })
    };
    let far: Vec<bool> = points.iter().map(|p| interrupt.is_raised() || !is_near(*p)).collect();
    let Some(first_near) = far.iter().position(|far| !far) else { return vec![points] };
    // Once round from a point that is near, so that no piece is cut where the ring begins.
    let last = points.len() - 1;
    let mut pieces: Vec<Vec<Point>> = Vec::new();
    let mut was_far = false;
    for i in (1..=last).map(|k| (first_near + k) % last) {
        if far[i] {
            if !was_far {
                pieces.push(Vec::new());
            }
            pieces.last_mut().into_iter().for_each(|piece| piece.push(points[i]));
        }
        was_far = far[i];
    }
    pieces
}

/// Rings as few paths: each continues at the nearest ring of the next level when a step over is short.
fn joined(levels: &[Vec<Vec<Point>>], reach: f64, interrupt: &Interrupt) -> Vec<Toolpath> {
    let mut paths: Vec<Toolpath> = Vec::new();
    for line in levels.iter().flatten().take_while(|_| !interrupt.is_raised()) {
        let is_ring = line.len() > 2 && line[0] == line[line.len() - 1];
        let starts = if is_ring { 0..line.len() - 1 } else { 0..1 };
        let nearest = |from: Point| {
            let index = starts.clone().min_by(|&a, &b| line[a].distance_squared(from).total_cmp(&line[b].distance_squared(from)));
            index.map(|i| (line[i].distance(from), i))
        };
        let open = paths.iter_mut().rev().find_map(|path| {
            let (distance, start) = path.points.last().and_then(|end| nearest(*end))?;
            (distance <= reach).then_some((path, start))
        });
        let around = |start: usize| {
            let turned = line[start..].iter().chain(if is_ring { &line[1..=start] } else { &[] });
            turned.copied().collect::<Vec<Point>>()
        };
        match open {
            Some((path, start)) => path.points.extend(around(start)),
            None => paths.push(Toolpath::new(around(0))),
        }
    }
    paths
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::BezPath;

    fn filled(text: &str, nib: f64) -> Vec<Toolpath> {
        fill_area(&Area { outline: BezPath::from_svg(text).unwrap(), colour: None }, nib, 0.02, 0.0, &Interrupt::never())
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
    fn slivers_are_dashes_with_their_ink_or_nothing() {
        let ink = |paths: &[Toolpath]| -> f64 { paths.iter().map(|path| 0.3 * path.length() + 0.0707).sum() };
        let line = filled("M0,0 H40 V0.1 H0 Z", 0.3);
        assert!((ink(&line) / 4.0 - 1.0).abs() < 0.06, "{}", ink(&line));
        assert!(line.iter().flat_map(|path| &path.points).all(|p| (p.y - 0.05).abs() < 0.02));
        assert!(filled("M0,0 H0.05 V0.05 H0 Z", 0.3).is_empty());
    }

    #[test]
    fn a_comb_s_teeth_are_drawn() {
        // A back of 1 mm with teeth of 0.2 mm, thinner than the nib.
        let teeth: Vec<String> = (0..10).map(|i| format!("H{} V3 H{} V1", i + 1, f64::from(i) + 1.2)).collect();
        let paths = filled(&format!("M12,1 V0 H0 V1 {} Z", teeth.join(" ")), 0.3);
        for i in 0..10 {
            let is_on = |p: &Point| p.y > 1.5 && (p.x - f64::from(i) - 1.1).abs() < 0.05;
            assert!(paths.iter().any(|path| path.points.iter().all(is_on)), "tooth {i}");
        }
    }

    #[test]
    fn the_middle_of_a_frame_is_filled_although_its_corners_are_wider() {
        let paths = filled("M5,5 H15 V15 H5 Z M8,8 V12 H12 V8 Z", 0.5);
        for p in [Point::new(6.5, 10.0), Point::new(10.0, 13.5), Point::new(6.45, 8.0)] {
            let near = |path: &Toolpath| path.points.windows(2).any(|w| distance_to_segment(p, w[0], w[1]) < 0.25);
            assert!(paths.iter().any(near), "{p:?}");
        }
    }
}
