//! Nostrils as dark as they are: small and dark, they are greyed over by a tone made for the skin around them, and a nose without them has no
//! base.

use super::zones::{pixels_in, polygon};
use crate::geometry::{Point, Rect, convex_hull};
use crate::raster::{Raster, fast_gaussian, opening};
use crate::source::{Landmarks, outlines};

/// Half the side of a square that does not fit into a nostril, in widths of the face: what is darker than all squares around it is one.
const NARROW: f64 = 0.04;
/// How much darker than the skin around it the darkest part of a nostril is where it begins to count, and where it counts in full, as a share of
/// that skin's lightness. Shade below a nose has up to 0.1.
const DARKER: [f32; 2] = [0.15, 0.4];
/// The core of a nostril, in shares of how dark its darkest part is: from nothing to all of it. With all that is darker than shade nostrils are bored
/// holes (10, 13, 15).
const CORE: [f32; 2] = [0.4, 0.9];
/// The share of the place that is darker than the darkest part that counts.
const DARKEST: f64 = 0.02;
/// The tone of a nostril: ink that print shows as black.
const TONE: f32 = 0.04;
/// Blur of the edge of the place where nostrils are, in widths of the face.
const SOFT: f64 = 0.008;

/// The tone with the nostrils that the photograph shows, by its `lightness`; `strength` is that of the tone, 0 to 1.
pub(super) fn with_nostrils(mut tone: Raster<f32>, lightness: &Raster<f32>, faces: &[Landmarks], strength: f32) -> Raster<f32> {
    for face in faces {
        for nostril in [&outlines::RIGHT_NOSTRIL, &outlines::LEFT_NOSTRIL] {
            darken(&mut tone, lightness, &convex_hull(face.line(nostril)), face.width(), strength);
        }
    }
    tone
}

/// Darkens what is dark and narrow within an outline.
fn darken(tone: &mut Raster<f32>, lightness: &Raster<f32>, outline: &[Point], width: f64, strength: f32) {
    let reach = (NARROW * width).round().max(1.0);
    let around = outline.iter().fold(Rect::from_points(outline[0], outline[0]), |all, p| all.union_pt(*p)).inset(2.0 * reach);
    let Some([columns, rows]) = pixels_in(around, (lightness.width(), lightness.height())) else { return };
    let away = Point::new(columns.start as f64, rows.start as f64).to_vec2();
    let corners: Vec<Point> = outline.iter().map(|p| *p - away).collect();
    let inside = fast_gaussian(&polygon(columns.len(), rows.len(), &corners).map(f32::from), (SOFT * width) as f32);
    let darker = darker_than_skin(&lightness.part(&columns, &rows), reach as usize);
    let Some(darkest) = darkest(&darker, &inside) else { return };
    let seen = strength * ((darkest - DARKER[0]) / (DARKER[1] - DARKER[0])).clamp(0.0, 1.0);
    for y in 0..darker.height() {
        for x in 0..darker.width() {
            let core = ((darker.get(x, y) / darkest - CORE[0]) / (CORE[1] - CORE[0])).clamp(0.0, 1.0);
            let share = seen * inside.get(x, y) * core * core * (3.0 - 2.0 * core);
            let (x, y) = (columns.start + x, rows.start + y);
            let v = tone.get(x, y);
            tone.set(x, y, v - share * (v - TONE).max(0.0));
        }
    }
}

/// How much darker than what is around them narrow places are, as a share of that lightness.
fn darker_than_skin(lightness: &Raster<f32>, reach: usize) -> Raster<f32> {
    let dark = lightness.map(|v| 1.0 - v);
    dark.zip_map(&opening(&dark, reach), |dark, skin| (dark - skin) / (1.0 - skin).max(0.05))
}

/// The value of the darkest part of a place that is darker than its surroundings; none if nothing is.
fn darkest(darker: &Raster<f32>, inside: &Raster<f32>) -> Option<f32> {
    let within = darker.pixels().iter().zip(inside.pixels()).filter(|(_, inside)| **inside > 0.5);
    let mut values: Vec<f32> = within.map(|(darker, _)| *darker).collect();
    values.sort_unstable_by(|a, b| b.total_cmp(a));
    values.get((DARKEST * values.len() as f64) as usize).copied().filter(|darkest| *darkest > DARKER[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::unit_at;
    use crate::source::{Iris, POINTS};
    use std::f64::consts::TAU;

    /// The tone in the middle of a nostril of a lightness, of a radius, on skin of 0.6, in a face 200 wide.
    fn nostril(radius: f64, light: f32) -> f32 {
        let middle = Point::new(50.0, 40.0);
        let mut points = vec![[0.0; 3]; POINTS];
        (points[234], points[454]) = ([0.0, 40.0, 0.0], [200.0, 40.0, 0.0]);
        for (i, point) in outlines::RIGHT_NOSTRIL.iter().enumerate() {
            let p = middle + 10.0 * unit_at(TAU * i as f64 / outlines::RIGHT_NOSTRIL.len() as f64);
            points[*point] = [p.x, p.y, 0.0];
        }
        let face = Landmarks { points, irises: [Iris { centre: middle, radius: 1.0 }; 2], spectacles: None, pearls: Vec::new() };
        let is_dark = |x: usize, y: usize| middle.distance(Point::new(x as f64 + 0.5, y as f64 + 0.5)) < radius;
        let lightness = Raster::from_fn(120, 80, |x, y| if is_dark(x, y) { light } else { 0.6 });
        with_nostrils(Raster::filled(120, 80, 0.5), &lightness, &[face], 1.0).get(50, 40)
    }

    #[test]
    fn a_dark_nostril_is_black_and_shade_and_a_slab_are_left() {
        assert!(nostril(6.0, 0.2) < 0.08, "{}", nostril(6.0, 0.2));
        assert_eq!(nostril(6.0, 0.56), 0.5, "shade");
        assert_eq!(nostril(30.0, 0.2), 0.5, "wider than a nostril");
    }
}
