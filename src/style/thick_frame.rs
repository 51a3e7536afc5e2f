//! Thick dark frames of spectacles, as a mask: lines alone would show frames of wire.

use super::spectacles::frame_lines;
use crate::geometry::{Point, convex_hull};
use crate::raster::{Raster, components, dilate, fast_gaussian, filled_polygon, median, remove_components};
use crate::source::{Landmarks, outlines};

/// Darker than this a frame may be solid: lighter ones are horn or clear, and have form.
const DARK: f32 = 0.30;
/// Where between the frame and what is around it the frame ends, in lightness.
const BORDER: f32 = 0.32;
/// How far a frame reaches from its line, and how far beyond that what is around it is measured, in distances of the eyes.
const REACH: f64 = 0.11;
const AROUND: f64 = 0.06;
/// Mean width in distances of the eyes from which a frame is thick. The one horn frame of sixteen portraits has 0.048; the wire of four others
/// is lighter than `DARK`.
const THICK: f64 = 0.035;
/// The least mean width in pixels: a wire of a small face is no thinner.
const LEAST_PIXELS: f64 = 3.0;
/// Brows and hair are dark too; farther than this from the line they are no frame, in distances of the eyes.
const OWN: f64 = 0.05;
/// Room around the lids, in distances of the eyes: lashes are no frame.
const LIDS: f64 = 0.05;

/// 1 in a face's thick frame; none if it has none.
pub(super) fn thick_frame(face: &Landmarks, lightness: &Raster<f32>, hair: Option<&Raster<f32>>) -> Option<Raster<u8>> {
    let frame = face.spectacles.as_ref()?;
    let (columns, rows) = (lightness.width(), lightness.height());
    let apart = face.eye_distance();
    let pixels = |share: f64| (share * apart).round().max(1.0) as usize;
    let line = frame_lines(frame, columns, rows);
    let values = |mask: &Raster<u8>| -> Vec<f32> {
        mask.pixels().iter().zip(lightness.pixels()).filter(|(is_in, _)| **is_in == 1).map(|(_, v)| *v).collect()
    };
    let dark = median(values(&line)).filter(|dark| *dark < DARK)?;
    let near = dilate(&line, pixels(REACH));
    let around = dilate(&near, pixels(AROUND)).zip_map(&near, |wide, near| wide * (1 - near));
    let border = dark + BORDER * (median(values(&around))? - dark).max(0.0);
    let open = near.zip_map(&other_darks(face, hair, &dilate(&line, pixels(OWN)), pixels(LIDS)), |near, dark| near * (1 - dark));
    let smooth = fast_gaussian(lightness, (0.008 * apart).max(0.5) as f32);
    let is_dark = smooth.zip_map(&open, |v, open| open * u8::from(v < border));
    let grown = joined_to(&is_dark, &line);
    let area = grown.pixels().iter().filter(|v| **v == 1).count() as f64;
    let length = line.pixels().iter().filter(|v| **v == 1).count() as f64;
    (area > (THICK * apart).max(LEAST_PIXELS) * length).then_some(grown)
}

/// 1 around the lids, and in brows and hair away from the frame's own place.
fn other_darks(face: &Landmarks, hair: Option<&Raster<f32>>, own: &Raster<u8>, round_lids: usize) -> Raster<u8> {
    let filled =
        |corners: Vec<Point>| filled_polygon(own.width(), own.height(), &corners.iter().map(|p| [p.x, p.y]).collect::<Vec<_>>());
    let both = |[a, b]: [Raster<u8>; 2]| a.zip_map(&b, u8::max);
    let lids = dilate(&both([&outlines::LEFT_EYE, &outlines::RIGHT_EYE].map(|lids| filled(face.line(lids)))), round_lids);
    let brows = both([&outlines::LEFT_BROW, &outlines::RIGHT_BROW].map(|brow| filled(convex_hull(face.line(brow)))));
    let dark = hair.map_or_else(|| brows.clone(), |hair| brows.zip_map(hair, |brow, hair| brow.max(u8::from(hair > 0.5))));
    lids.zip_map(&dark.zip_map(own, |dark, own| dark * (1 - own)), u8::max)
}

/// The connected parts of a mask that a line runs through.
fn joined_to(mask: &Raster<u8>, line: &Raster<u8>) -> Raster<u8> {
    let (labels, count) = components(mask);
    let mut is_met = vec![false; count + 1];
    for (label, line) in labels.pixels().iter().zip(line.pixels()) {
        is_met[*label as usize] |= *line == 1;
    }
    remove_components(mask, &labels, |label| is_met[label as usize])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::distance_to_segment;
    use crate::source::{Iris, POINTS, Spectacles};

    /// Eyes 60 pixels apart behind square rims whose lines are drawn so wide on light skin; how many pixels are a thick frame.
    fn thick_pixels(width: f64, dark: f32) -> Option<usize> {
        let rim = |x: f64| {
            [(-20.0, -14.0), (20.0, -14.0), (20.0, 14.0), (-20.0, 14.0)].map(|(dx, dy)| Point::new(x + dx, 60.0 + dy)).to_vec()
        };
        let frame = Spectacles {
            rims: [rim(60.0), rim(120.0)],
            bridge: vec![Point::new(80.0, 55.0), Point::new(100.0, 55.0)],
            temples: [Vec::new(), Vec::new()],
            width: 3.0,
        };
        let lines = frame.lines();
        let light = Raster::from_fn(180, 120, |x, y| {
            let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
            let away =
                |line: &Vec<Point>| line.windows(2).map(|w| distance_to_segment(p, w[0], w[1])).fold(f64::INFINITY, f64::min);
            if lines.iter().map(away).fold(f64::INFINITY, f64::min) < 0.5 * width { dark } else { 0.7 }
        });
        let irises = [60.0, 120.0].map(|x| Iris { centre: Point::new(x, 60.0), radius: 4.0 });
        let face = Landmarks { points: vec![[90.0, 60.0, 0.0]; POINTS], irises, spectacles: Some(frame), pearls: Vec::new() };
        Some(thick_frame(&face, &light, None)?.pixels().iter().filter(|v| **v == 1).count())
    }

    #[test]
    fn horn_is_solid_and_neither_wire_nor_a_clear_frame_is() {
        let horn = thick_pixels(6.0, 0.1).expect("a thick frame");
        assert!((1300..2000).contains(&horn), "{horn}");
        assert_eq!(thick_pixels(1.6, 0.1), None, "black wire");
        assert_eq!(thick_pixels(6.0, 0.45), None, "clear plastic");
    }
}
