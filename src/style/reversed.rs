//! Reversed stipple, as on scraperboard: where dots or lines would close up, black with even white holes instead of the irregular
//! slivers that overlapping marks leave.
//!
//! ```text
//!   cells      each dark cell is black except for a hole with the white of its tone
//!   regions    only where dark cells form a wide region; a pupil or an eyebrow stays as it is
//!   tiles      cells are grouped into areas a few pitches wide, which a plotter fills one at a time
//! ```

use crate::drawing::{Area, Mark};
use crate::field::contours;
use crate::geometry::{Affine, BezPath, Point, Region, Vec2, Winding, distance_to_segment, half_plane, polygon_area, untangled};
use crate::parallel::mapped;
use crate::raster::{Raster, dilate};
use crate::source::{Placement, Portrait};
use kurbo::Shape;
use std::collections::BTreeMap;

/// Half the width of the narrowest region that is reversed, in pitches. At 1, specks appear in eyes and eyebrows; at 2.5, strands of
/// hair beside it stay black dots.
const NARROWEST: f64 = 1.5;
/// Overlap of a cell with its dark neighbours, in pitches, so that no seam shows between two tiles; the holes begin at 0.25.
const OVERLAP: f64 = 0.1;
/// Side of a tile in pitches, tuned on Grace Hopper plotted with 0.3 mm: at 6 a nib of two thirds of the pitch leaves 1.9 % bare along
/// the seams, at 16 there are too few tiles for two threads (5.9 s against 3.9 s at 9).
const TILE: f64 = 9.0;
/// Flattening tolerance where holes are cut out, in pixels.
const TOLERANCE: f64 = 0.02;

/// Radius below which there is no hole, in pitches: 0.5 % white, which ink closes; smaller ones look like dust on a black helmet.
pub(super) const LEAST_HOLE: f64 = 0.04;

/// A black cell with a hole, in working pixels.
#[derive(Clone, Debug)]
pub(super) struct ReversedCell {
    pub centre: Point,
    pub polygon: Vec<Point>,
    /// Outline around the centre; empty if there is no hole.
    pub hole: BezPath,
    /// True if part of it lies outside the subject, or the hole may extend beyond the cell.
    pub is_open: bool,
}

/// Which cells are reversed.
pub(super) struct ReversedCells {
    /// For each cell.
    pub is_reversed: Vec<bool>,
    /// 1 on their pixels.
    pub mask: Raster<u8>,
}

impl ReversedCells {
    /// Chooses the dark cells that form wide enough regions. `nearest` is each pixel's cell, `u32::MAX` outside the subject; `pitch` in
    /// pixels.
    pub(super) fn new(nearest: &Raster<u32>, is_dark: &[bool], pitch: f64) -> Self {
        let reach = (NARROWEST * pitch).round() as usize;
        // The outside does not narrow a region.
        let bare = nearest.map(|cell| u8::from(cell != u32::MAX && !is_dark[cell as usize]));
        let wide = dilate(&dilate(&bare, reach).map(|near| 1 - near), reach);
        let mut pixels = vec![[0_u32; 2]; is_dark.len()];
        for (&cell, &wide) in nearest.pixels().iter().zip(wide.pixels()) {
            if cell != u32::MAX {
                pixels[cell as usize][usize::from(wide)] += 1;
            }
        }
        let is_reversed: Vec<bool> = pixels.iter().zip(is_dark).map(|([out, inside], dark)| *dark && inside > out).collect();
        let mask = nearest.map(|cell| u8::from(cell != u32::MAX && is_reversed[cell as usize]));
        Self { is_reversed, mask }
    }

    /// Where other marks are left out: pixels at least `reach` inside the reversed regions.
    pub(super) fn inside(&self, subject: &Raster<f32>, reach: usize) -> Raster<u8> {
        let bare = self.mask.zip_map(subject, |reversed, subject| u8::from(reversed == 0 && subject >= 0.5));
        dilate(&bare, reach).zip_map(&self.mask, |near_bare, reversed| reversed & (1 - near_bare))
    }
}

/// The reversed cells as areas on the page, one per tile; `mask` as in [`ReversedCells`], `pitch` in pixels.
pub(super) fn areas(cells: &[ReversedCell], mask: &Raster<u8>, portrait: &Portrait, pitch: f64) -> Vec<Mark> {
    let mut tiles: BTreeMap<(i64, i64), Vec<&ReversedCell>> = BTreeMap::new();
    let side = TILE * pitch;
    for cell in cells {
        tiles.entry(((cell.centre.y / side) as i64, (cell.centre.x / side) as i64)).or_default().push(cell);
    }
    let subject = cells.iter().any(|cell| cell.is_open).then(|| subject_region(&portrait.subject));
    let to_page = to_page(&portrait.placement);
    let tiles: Vec<Vec<&ReversedCell>> = tiles.into_values().collect();
    let outlines = mapped(&tiles, &|tile| to_page * tile_outline(tile, mask, subject.as_ref(), OVERLAP * pitch));
    let drawn = outlines.into_iter().filter(|outline| !outline.elements().is_empty());
    drawn.map(|outline| Mark::Area(Area { outline, colour: None })).collect()
}

fn to_page(placement: &Placement) -> Affine {
    Affine::translate(placement.to_page(Point::ORIGIN).to_vec2()) * Affine::scale(placement.mm_per_pixel())
}

/// The subject's inside, closed along the picture's border.
fn subject_region(subject: &Raster<f32>) -> Region {
    let (width, height) = (subject.width(), subject.height());
    let rimmed = Raster::from_fn(width + 2, height + 2, |x, y| {
        let is_rim = x == 0 || y == 0 || x == width + 1 || y == height + 1;
        if is_rim { 0.0 } else { subject.get(x - 1, y - 1) }
    });
    let mut outline = BezPath::new();
    for line in contours(&rimmed, 0.5) {
        append(&mut outline, line.points.iter().map(|p| Point::new(p.x - 1.0, p.y - 1.0)));
    }
    Region::new(&outline, TOLERANCE)
}

fn tile_outline(cells: &[&ReversedCell], mask: &Raster<u8>, subject: Option<&Region>, overlap: f64) -> BezPath {
    let mut black = BezPath::new();
    for cell in cells {
        append_cell(&mut black, cell, mask, overlap);
    }
    let mut outline = untangled(&black, Winding::NonZero, TOLERANCE);
    let holes = || cells.iter().map(|cell| &cell.hole).filter(|hole| !hole.elements().is_empty());
    if let Some(subject) = subject.filter(|_| cells.iter().any(|cell| cell.is_open)) {
        // At the subject's border a hole may be clipped.
        let mut all = BezPath::new();
        holes().for_each(|hole| all.extend(hole.iter()));
        let inside = Region::new(&subject.clip_area(&Region::new(&outline, TOLERANCE)), TOLERANCE);
        return Region::new(&all, TOLERANCE).outside_of_area(&inside);
    }
    let is_positive = outline.area() > 0.0;
    for hole in holes() {
        // A hole winds the other way.
        let hole = if (hole.area() > 0.0) == is_positive { hole.reverse_subpaths() } else { hole.clone() };
        outline.extend(hole);
    }
    outline
}

/// Appends the cell's polygon, always with the same winding, and a strip over each side shared with another reversed cell.
fn append_cell(path: &mut BezPath, cell: &ReversedCell, mask: &Raster<u8>, overlap: f64) {
    let corners = turning_one_way(&cell.polygon);
    append(path, corners.iter().copied());
    for (a, b, outward) in shared_sides(&corners, mask) {
        append(path, [a, a + outward * overlap, b + outward * overlap, b].into_iter());
    }
}

fn turning_one_way(polygon: &[Point]) -> Vec<Point> {
    let mut corners = polygon.to_vec();
    if polygon_area(&corners) < 0.0 {
        corners.reverse();
    }
    corners
}

/// The sides of a polygon that border on a reversed cell, with their outward direction.
fn shared_sides<'a>(corners: &'a [Point], mask: &'a Raster<u8>) -> impl Iterator<Item = (Point, Point, Vec2)> + 'a {
    let sides = corners.iter().enumerate().map(|(i, &a)| (a, corners[(i + 1) % corners.len()]));
    sides.filter(|(a, b)| a.distance(*b) > 1e-9).filter_map(|(a, b)| {
        let outward = -(b - a).turn_90().normalize();
        let beyond = a.midpoint(b) + outward;
        let (x, y) = (beyond.x.floor() as isize, beyond.y.floor() as isize);
        (mask.contains(x, y) && mask.get(x as usize, y as usize) == 1).then_some((a, b, outward))
    })
}

/// Distance in pitches of a cell's ink from its middle above which the edge of the dark runs through it; 0.25 for a half-black cell.
const EDGE: f64 = 0.08;

/// A cell beside reversed ones through which the edge of the dark runs: its ink lies on the dark side, up to a straight cut. A dot in
/// the middle would leave a white sliver beside the dark. `ink_middle` is the centroid of the cell's target ink, `ink` its area.
pub(super) fn edge_cell(polygon: &[Point], ink_middle: Point, ink: f64, mask: &Raster<u8>, pitch: f64) -> Option<ReversedCell> {
    let corners = turning_one_way(polygon);
    let middle = middle(&corners)?;
    let towards = ink_middle - middle;
    if towards.hypot() < EDGE * pitch || shared_sides(&corners, mask).next().is_none() {
        return None;
    }
    let towards = towards.normalize();
    let reach = corners.iter().map(|p| p.distance(middle)).fold(0.0, f64::max);
    let (mut low, mut high, mut cut) = (-reach, reach, Vec::new());
    // 24 halvings of a cell of a few pixels end far below the output precision.
    for _ in 0..24 {
        let at = 0.5 * (low + high);
        half_plane(&corners, middle + towards * at, -towards, &mut cut);
        if polygon_area(&cut).abs() > ink { low = at } else { high = at }
    }
    (cut.len() > 2).then(|| ReversedCell { centre: middle, polygon: cut, hole: BezPath::new(), is_open: false })
}

/// Centroid of a convex polygon.
fn middle(corners: &[Point]) -> Option<Point> {
    let first = *corners.first()?;
    let (mut sum, mut twice) = (Vec2::ZERO, 0.0);
    for pair in corners.windows(2) {
        let (a, b) = (pair[0] - first, pair[1] - first);
        sum += (a + b) * a.cross(b);
        twice += a.cross(b);
    }
    (twice.abs() > 1e-9).then(|| first + sum / (3.0 * twice))
}

fn append(path: &mut BezPath, points: impl Iterator<Item = Point>) {
    for (i, p) in points.enumerate() {
        if i == 0 { path.move_to(p) } else { path.line_to(p) }
    }
    path.close_path();
}

/// True if a round hole of this radius at the centre lies well inside the cell.
pub(super) fn holds(polygon: &[Point], centre: Point, radius: f64) -> bool {
    (0..polygon.len()).all(|i| distance_to_segment(centre, polygon[i], polygon[(i + 1) % polygon.len()]) > 1.05 * radius)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square lattice of cells of 6 pixels with round holes.
    fn lattice(count: usize) -> (Vec<ReversedCell>, Raster<u32>) {
        let cells = (0..count * count)
            .map(|i| {
                let (x, y) = (6.0 * (i % count) as f64, 6.0 * (i / count) as f64);
                let centre = Point::new(x + 3.0, y + 3.0);
                let polygon =
                    vec![Point::new(x, y), Point::new(x + 6.0, y), Point::new(x + 6.0, y + 6.0), Point::new(x, y + 6.0)];
                ReversedCell { centre, polygon, hole: kurbo::Circle::new(centre, 1.0).to_path(1e-3), is_open: false }
            })
            .collect();
        (cells, Raster::from_fn(6 * count, 6 * count, |x, y| (y / 6 * count + x / 6) as u32))
    }

    #[test]
    fn a_tile_is_black_but_for_its_holes() {
        let (cells, _) = lattice(5);
        let mask = Raster::filled(30, 30, 1_u8);
        let outline = tile_outline(&cells.iter().collect::<Vec<_>>(), &mask, None, 0.6);
        let wanted = 900.0 - 25.0 * std::f64::consts::PI;
        // Strips over the tile's own border would lie outside the raster.
        assert!((outline.area().abs() - wanted).abs() < 0.5, "{} for {wanted}", outline.area());
    }

    #[test]
    fn the_edge_of_the_dark_is_straight_and_has_the_cell_s_ink() {
        let polygon = [Point::new(0.0, 0.0), Point::new(6.0, 0.0), Point::new(6.0, 6.0), Point::new(0.0, 6.0)];
        // Reversed cells lie on the left.
        let polygon = polygon.map(|p| p + Vec2::new(4.0, 0.0));
        let mask = Raster::from_fn(12, 6, |x, _| u8::from(x < 4));
        let cell = edge_cell(&polygon, Point::new(6.0, 3.0), 20.0, &mask, 6.0).unwrap();
        assert!((polygon_area(&cell.polygon).abs() - 20.0).abs() < 1e-3);
        assert!(cell.polygon.iter().all(|p| p.x < 4.0 + 20.0 / 6.0 + 1e-3), "{:?}", cell.polygon);
        assert!(edge_cell(&polygon, Point::new(7.1, 3.0), 20.0, &mask, 6.0).is_none(), "an even cell has no edge");
    }

    #[test]
    fn only_wide_regions_are_reversed() {
        let (_, nearest) = lattice(10);
        // A block of 5 x 5 cells and a row of one.
        let is_dark: Vec<bool> = (0..100).map(|i| (i % 10 < 5 && i / 10 < 5) || i / 10 == 8).collect();
        let chosen = ReversedCells::new(&nearest, &is_dark, 6.0);
        for (i, reversed) in chosen.is_reversed.iter().enumerate() {
            assert_eq!(*reversed, i % 10 < 5 && i / 10 < 5, "cell {i}");
        }
        assert_eq!(chosen.mask.pixels().iter().map(|v| u32::from(*v)).sum::<u32>(), 900);
    }
}
