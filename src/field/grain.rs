//! Grain: the irregular marks that a smudged stick leaves on the tooth of the paper.

use super::contour::contours;
use super::curve::Curve;
use crate::geometry::Point;
use crate::raster::{Raster, components};

/// The areas where the paper's `texture` (uniform over 0 to 1) is above `tone` (0 to 1, the target white fraction), each as its
/// outlines: an outer border and its holes, wound the opposite way. The mean ink of a place is 1 - tone.
///
/// Both rasters have the same size, and the resolution that the grain needs: five pixels from hill to hill.
pub fn grain_areas(tone: &Raster<f32>, texture: &Raster<f32>) -> Vec<Vec<Curve>> {
    let (width, height) = (tone.width(), tone.height());
    // A bare rim of one pixel closes every outline.
    let rise = Raster::from_fn(width + 2, height + 2, |x, y| {
        let is_rim = x == 0 || y == 0 || x == width + 1 || y == height + 1;
        // A white place stays white even at the texture's maximum.
        if is_rim || tone.get(x - 1, y - 1) >= 1.0 { -1.0 } else { texture.get(x - 1, y - 1) - tone.get(x - 1, y - 1) }
    });
    let (labels, count) = components(&rise.map(|v| u8::from(v > 0.0)));
    let mut areas: Vec<Vec<Curve>> = vec![Vec::new(); count + 1];
    for mut outline in contours(&rise, 0.0) {
        let Some(first) = outline.points.first() else { continue };
        let label = inked_beside(&labels, *first);
        outline.points.iter_mut().for_each(|p| *p = Point::new(p.x - 1.0, p.y - 1.0));
        areas[label as usize].push(outline);
    }
    areas.into_iter().skip(1).filter(|outlines| !outlines.is_empty()).collect()
}

/// An outline's vertex lies between two pixels: the label of the inked one.
fn inked_beside(labels: &Raster<u32>, p: Point) -> u32 {
    let (x, y) = (p.x - 0.5, p.y - 0.5);
    let one = labels.clamped(x.floor() as isize, y.floor() as isize);
    if one != 0 { one } else { labels.clamped(x.ceil() as isize, y.ceil() as isize) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::Elementary as _;
    use crate::geometry::polygon_area;
    use crate::raster::paper_texture;

    #[test]
    fn the_ink_is_what_the_tone_leaves() {
        let texture = paper_texture(300, 300, 5.0, 3);
        for wanted in [0.15_f32, 0.3, 0.5, 0.7, 0.9] {
            let areas = grain_areas(&Raster::filled(300, 300, wanted), &texture);
            // Outer borders and holes run opposite ways, so that their signed areas add up to the ink.
            let ink: f64 = areas.iter().flatten().map(|outline| polygon_area(&outline.points)).sum::<f64>().abs() / 90_000.0;
            assert!((ink - f64::from(1.0 - wanted)).abs() < 0.012, "{ink} for tone {wanted}");
        }
    }

    #[test]
    fn holes_stay_with_their_border() {
        let ring = Raster::from_fn(30, 30, |x, y| {
            let r = (x as f32 - 14.5).hypotenuse(y as f32 - 14.5);
            if (5.0..11.0).contains(&r) { 0.0 } else { 1.0 }
        });
        let areas = grain_areas(&ring, &Raster::filled(30, 30, 0.5));
        assert_eq!(areas.iter().map(Vec::len).collect::<Vec<_>>(), [2]);
    }
}
