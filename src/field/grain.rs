//! Grain: the irregular marks that a smudged stick leaves on the tooth of the paper.

use super::contour::contours;
use super::curve::Curve;
use crate::geometry::{Point, Vec2};
use crate::parallel::collected;
use crate::raster::{Raster, components};
use std::ops::Range;

/// Side in pixels of the parts of a sheet that threads share, and into which larger areas are cut, so that no outline is millions of
/// points long: programs refuse to read such paths. Cut areas overlap by half a grain. Without that a white seam would show; with two
/// grains the doubled edges of gaps show as a grey one. For pens they are united again (`plot/lower/unite.rs`).
const PART: usize = 1024;
const OVERLAP: usize = 2;

/// The areas where the paper's `texture` (uniform over 0 to 1) is above `tone` (0 to 1, the target white fraction), each as its
/// outlines: an outer border and its holes, wound the opposite way; large areas in parts. The mean ink of a place is 1 - tone.
///
/// Both rasters have the same size, and the resolution that the grain needs: five pixels from hill to hill.
pub fn grain_areas(tone: &Raster<f32>, texture: &Raster<f32>) -> Vec<Vec<Curve>> {
    // A white place stays white even at the texture's maximum.
    let rise = tone.zip_map(texture, |tone, texture| if tone >= 1.0 { -1.0 } else { texture - tone });
    let (labels, count) = components(&rise.map(|v| u8::from(v > 0.0)));
    let bounds = bounds_of(&labels, count);
    let is_large = |label: u32| {
        let Bounds { columns, rows } = &bounds[label as usize];
        columns.len() > PART || rows.len() > PART
    };
    let (across, down) = (rise.width().div_ceil(PART), rise.height().div_ceil(PART));
    let cut = |part: usize| {
        let (left, top) = (part % across * PART, part / across * PART);
        let columns = left..(left + PART + OVERLAP).min(rise.width());
        Bounds { columns, rows: top..(top + PART + OVERLAP).min(rise.height()) }
    };
    // A small area is whole in the part where it begins.
    let part_of = |label: u32| {
        let Bounds { columns, rows } = &bounds[label as usize];
        rows.start / PART * across + columns.start / PART
    };
    let mut whole: Vec<Bounds> = (0..across * down).map(cut).collect();
    for label in (1..=count as u32).filter(|label| !is_large(*label)) {
        let all = &mut whole[part_of(label)];
        *all = all.with(&bounds[label as usize]);
    }
    let areas = collected(across * down, &|part| {
        let cut = cut(part);
        outlined(&rise, &whole[part], &|x, y| match labels.get(x, y) {
            0 => true,
            label if is_large(label) => cut.columns.contains(&x) && cut.rows.contains(&y),
            label => part_of(label) == part,
        })
    });
    areas.into_iter().flatten().collect()
}

/// Columns and rows of an area.
#[derive(Clone, Debug)]
struct Bounds {
    columns: Range<usize>,
    rows: Range<usize>,
}

impl Bounds {
    fn with(&self, other: &Self) -> Self {
        let both = |a: &Range<usize>, b: &Range<usize>| a.start.min(b.start)..a.end.max(b.end);
        Self { columns: both(&self.columns, &other.columns), rows: both(&self.rows, &other.rows) }
    }
}

/// The bounds of each component, after those of none.
fn bounds_of(labels: &Raster<u32>, count: usize) -> Vec<Bounds> {
    let mut bounds = vec![Bounds { columns: 0..0, rows: 0..0 }; count + 1];
    for y in 0..labels.height() {
        for (x, label) in labels.row(y).iter().enumerate().filter(|(_, label)| **label != 0) {
            let (all, here) = (&mut bounds[*label as usize], Bounds { columns: x..x + 1, rows: y..y + 1 });
            *all = if all.rows.is_empty() { here } else { all.with(&here) };
        }
    }
    bounds
}

/// The areas where a raster is above 0 within bounds, of the pixels that are kept.
fn outlined(rise: &Raster<f32>, within: &Bounds, is_kept: &(impl Fn(usize, usize) -> bool + Sync)) -> Vec<Vec<Curve>> {
    let Bounds { columns, rows } = within;
    // A bare rim of one pixel closes every outline.
    let part = Raster::from_fn(columns.len() + 2, rows.len() + 2, |x, y| {
        if x == 0 || y == 0 || x > columns.len() || y > rows.len() {
            return -1.0;
        }
        let (x, y) = (columns.start + x - 1, rows.start + y - 1);
        let rise = rise.get(x, y);
        if is_kept(x, y) { rise } else { -rise.abs() }
    });
    let (own, count) = components(&part.map(|v| u8::from(v > 0.0)));
    let mut areas: Vec<Vec<Curve>> = vec![Vec::new(); count + 1];
    let to_sheet = Vec2::new(columns.start as f64 - 1.0, rows.start as f64 - 1.0);
    for mut outline in contours(&part, 0.0) {
        let Some(first) = outline.points.first() else { continue };
        let label = inked_beside(&own, *first);
        outline.points.iter_mut().for_each(|p| *p += to_sheet);
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
    fn a_large_area_is_cut_without_a_seam() {
        let (width, height) = (2 * PART + 300, 40);
        let areas = grain_areas(&Raster::filled(width, height, 0.2), &Raster::filled(width, height, 0.5));
        let bounds = |outline: &Curve| {
            let xs = || outline.points.iter().map(|p| p.x);
            (xs().fold(f64::INFINITY, f64::min), xs().fold(f64::NEG_INFINITY, f64::max))
        };
        let mut parts: Vec<(f64, f64)> = areas.iter().map(|area| bounds(&area[0])).collect();
        parts.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert_eq!(parts.len(), 3);
        assert!(parts.windows(2).all(|pair| pair[1].0 < pair[0].1 - 0.5), "{parts:?}");
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
