//! The grooves around the wings of a nose: thin and hardly darker than the skin, they are lost among marks, and a nose
//! without them has no sides.

use super::zones::pixels_in;
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Rect, Vec2};
use crate::raster::{Raster, fast_gaussian};
use crate::source::Landmarks;

/// The outlines of a nose's right wing and left, from above it to its base, by the numbers of the landmarks.
const WINGS: [[usize; 5]; 2] = [[209, 49, 48, 64, 98], [429, 279, 278, 294, 327]];
/// How far from the outline that was found a groove may lie, in widths of the face, and the soft end of that.
const BESIDE: f64 = 0.028;
const SOFT: f64 = 0.02;
/// The blurs that grooves lie between, in widths of the face: narrower is grain, wider is the shade of the nose.
const FINEST: f64 = 0.006;
const WIDEST: f64 = 0.035;
/// The gain of a small difference, and the most that a large one is deepened. With half as much again, and with the line below the nose,
/// a face finder sees noses in charcoal elsewhere than in the photograph (by 2.9 % in place of 2.1).
const GAIN: f32 = 1.3;
const MOST: f32 = 0.125;
/// The tone below which a groove is deepened less: in shade it would be a blot (09, 13).
const SHADE: f32 = 0.42;

/// The tone with the grooves of noses deepened, except under hair of the face; `strength` is that of the tone, 0 to 1.
pub(super) fn with_nose_wings(
    mut tone: Raster<f32>,
    beard: Option<&Raster<f32>>,
    faces: &[Landmarks],
    strength: f32,
) -> Raster<f32> {
    for face in faces {
        for wing in &WINGS {
            deepen(&mut tone, beard, &face.line(wing), face.width(), strength);
        }
    }
    tone
}

fn deepen(tone: &mut Raster<f32>, beard: Option<&Raster<f32>>, outline: &[Point], width: f64, strength: f32) {
    let around =
        outline.iter().fold(Rect::from_points(outline[0], outline[0]), |all, p| all.union_pt(*p)).inset(2.5 * WIDEST * width);
    let Some([columns, rows]) = pixels_in(around, (tone.width(), tone.height())) else { return };
    let part = tone.part(&columns, &rows);
    let blurred = |share: f64| fast_gaussian(&part, (share * width) as f32);
    let grooves = blurred(FINEST).zip_map(&blurred(WIDEST), |fine, wide| (wide - fine).max(0.0));
    for y in 0..grooves.height() {
        for x in 0..grooves.width() {
            let (column, row) = (columns.start + x, rows.start + y);
            let distance = distance_to(outline, Point::new(column as f64 + 0.5, row as f64 + 0.5)) / width;
            let near = 1.0 - ((distance - BESIDE) / SOFT).clamp(0.0, 1.0) as f32;
            let bare = 1.0 - beard.map_or(0.0, |beard| beard.get(column, row));
            let deeper = MOST * (GAIN * grooves.get(x, y) / MOST).hyperbolic_tangent();
            let v = tone.get(column, row);
            tone.set(column, row, (v - strength * near * bare * deeper * (v / SHADE).min(1.0)).max(0.0));
        }
    }
}

/// Distance of a place from the nearest point of a line.
fn distance_to(line: &[Point], p: Point) -> f64 {
    let from = |w: &[Point]| {
        let (along, off): (Vec2, Vec2) = (w[1] - w[0], p - w[0]);
        let share = (off.dot(along) / along.hypot2().max(1e-9)).clamp(0.0, 1.0);
        (off - share * along).hypot2()
    };
    line.windows(2).map(from).fold(f64::INFINITY, f64::min).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::{Iris, POINTS};

    /// A face 200 wide with the outline of a nose's wing along y = 40 from x = 30 to 90.
    fn face() -> Landmarks {
        let mut points = vec![[0.0; 3]; POINTS];
        (points[234], points[454]) = ([0.0, 40.0, 0.0], [200.0, 40.0, 0.0]);
        for (i, point) in WINGS[0].iter().enumerate() {
            points[*point] = [30.0 + 15.0 * i as f64, 40.0, 0.0];
        }
        let iris = Iris { centre: Point::new(60.0, 10.0), radius: 1.0 };
        Landmarks { points, irises: [iris; 2], spectacles: None, pearls: Vec::new() }
    }

    /// The tone at a place of skin of 0.6 with grooves of 0.55 along y = 40 and y = 70.
    fn at(x: usize, y: usize, beard: Option<&Raster<f32>>) -> f32 {
        let is_groove = |y: usize| [40, 70].iter().any(|groove| y.abs_diff(*groove) <= 1);
        let tone = Raster::from_fn(120, 100, |_, y| if is_groove(y) { 0.55 } else { 0.6 });
        with_nose_wings(tone, beard, &[face()], 1.0).get(x, y)
    }

    #[test]
    fn grooves_are_deepened_where_a_nose_has_them_and_neither_elsewhere_nor_under_a_moustache() {
        assert!(at(60, 40, None) < 0.53, "{}", at(60, 40, None));
        assert!((at(60, 70, None) - 0.55).abs() < 1e-3, "a fold of the cheek: {}", at(60, 70, None));
        assert!((at(60, 34, None) - 0.6).abs() < 0.03, "skin beside it: {}", at(60, 34, None));
        assert!((at(60, 40, Some(&Raster::filled(120, 100, 1.0))) - 0.55).abs() < 1e-3);
    }
}
