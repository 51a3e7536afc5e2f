//! Gums: as light as teeth in most photographs, but as red as lips. White, they make a slab of a laughing mouth.

use super::openings::{MOUTH_OPEN, openness};
use super::zones::polygon;
use crate::geometry::Point;
use crate::raster::{Raster, fast_gaussian, median};
use crate::source::{Landmarks, outlines};

/// Redness, the difference of red and green over their sum in linear light, by which lips must exceed teeth: below it there is no colour
/// to go by.
const LEAST_REDDER: f32 = 0.08;
/// The redness of teeth, as a quantile of that between the lips: a throat and a tongue are redder.
const TEETH: f64 = 0.25;
/// Where gums begin between the teeth's redness and the lips', and from where they are in full.
const GUMS: [f32; 2] = [0.25, 0.45];
/// The lightest tone of gums, and the share of their lights that is left above it: without lights they are lips.
const LIGHTEST: f32 = 0.55;
const LIGHTS: f32 = 0.3;
/// Blur of their edge in widths of the face.
const SOFT: f64 = 0.005;

/// The tone with gums darker than teeth, by the photograph's linear light; `strength` is that of the tone, 0 to 1.
pub(super) fn with_gums(mut tone: Raster<f32>, light: &Raster<[f32; 3]>, faces: &[Landmarks], strength: f32) -> Raster<f32> {
    for face in faces {
        let open = openness(&face.line(&outlines::MOUTH), MOUTH_OPEN);
        if open == 0.0 {
            continue;
        }
        let Some((gums, [left, top])) = gums(light, face) else { continue };
        for y in 0..gums.height() {
            for x in 0..gums.width() {
                let v = tone.get(left + x, top + y);
                let less = (1.0 - LIGHTS) * (v - LIGHTEST).max(0.0);
                tone.set(left + x, top + y, v - strength * open * gums.get(x, y) * less);
            }
        }
    }
    tone
}

/// Where the gums of a face are, 0 to 1, in a box around its lips, and the box's upper left corner.
fn gums(light: &Raster<[f32; 3]>, face: &Landmarks) -> Option<(Raster<f32>, [usize; 2])> {
    let [outer, inner] = [&outlines::LIPS, &outlines::MOUTH].map(|line| face.line(line));
    let corner = outer.iter().fold(outer[0], |a, p| Point::new(a.x.min(p.x), a.y.min(p.y)));
    let far = outer.iter().fold(outer[0], |a, p| Point::new(a.x.max(p.x), a.y.max(p.y)));
    let range = |from: f64, to: f64, size: usize| (from.max(0.0) as usize).min(size)..(to.max(0.0).ceil() as usize).min(size);
    let [columns, rows] = [range(corner.x, far.x, light.width()), range(corner.y, far.y, light.height())];
    if columns.is_empty() || rows.is_empty() {
        return None;
    }
    let away = Point::new(columns.start as f64, rows.start as f64).to_vec2();
    let in_box = |line: &[Point]| polygon(columns.len(), rows.len(), &line.iter().map(|p| *p - away).collect::<Vec<_>>());
    let inside = in_box(&inner);
    let lips = in_box(&outer).zip_map(&inside, |lips, inside| lips == 1 && inside == 0);
    let redness = light.part(&columns, &rows).map(|[r, g, _]| (r - g) / (r + g).max(0.01));
    let of = |is: &Raster<bool>| -> Vec<f32> {
        redness.pixels().iter().zip(is.pixels()).filter(|(_, is)| **is).map(|(redness, _)| *redness).collect()
    };
    let mut between = of(&inside.map(|inside| inside == 1));
    between.sort_unstable_by(f32::total_cmp);
    let teeth = *between.get((TEETH * between.len() as f64) as usize)?;
    let redder = median(of(&lips))? - teeth;
    if redder < LEAST_REDDER {
        return None;
    }
    let share = redness.map(|red| (((red - teeth) / redder - GUMS[0]) / (GUMS[1] - GUMS[0])).clamp(0.0, 1.0));
    let gums = share.zip_map(&inside, |share, inside| share * f32::from(inside));
    Some((fast_gaussian(&gums, (SOFT * face.width()) as f32), [columns.start, rows.start]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::unit_at;
    use crate::source::{Iris, POINTS};
    use std::f64::consts::TAU;

    const MIDDLE: Point = Point::new(60.0, 30.0);

    fn laughing() -> Landmarks {
        let mut points = vec![[0.0; 3]; POINTS];
        for (outline, size) in [(&outlines::LIPS, [50.0, 25.0]), (&outlines::MOUTH, [40.0, 16.0])] {
            for (i, point) in outline.iter().enumerate() {
                let along = unit_at(TAU * i as f64 / outline.len() as f64);
                points[*point] = [MIDDLE.x + size[0] * along.x, MIDDLE.y + size[1] * along.y, 0.0];
            }
        }
        let iris = Iris { centre: MIDDLE, radius: 1.0 };
        Landmarks { points, irises: [iris; 2], spectacles: None }
    }

    #[test]
    fn gums_are_darker_than_teeth_in_colour_and_as_they_are_in_grey() {
        let face = laughing();
        let mouth = polygon(120, 60, &face.line(&outlines::MOUTH));
        let light = Raster::from_fn(120, 60, |x, y| match (mouth.get(x, y) == 1, y < 22) {
            (true, true) => [0.8, 0.5, 0.5],
            (true, false) => [0.8, 0.78, 0.7],
            (false, _) => [0.4, 0.15, 0.15],
        });
        let tone = Raster::filled(120, 60, 0.9);
        let in_colour = with_gums(tone.clone(), &light, std::slice::from_ref(&face), 1.0);
        assert!(in_colour.get(60, 18) < 0.75, "{}", in_colour.get(60, 18));
        assert!(in_colour.get(60, 34) > 0.89, "{}", in_colour.get(60, 34));
        assert_eq!(with_gums(tone.clone(), &light.map(|[r, ..]| [r; 3]), &[face], 1.0), tone);
    }
}
