//! Voronoi cells of many sites: the nearest site of each pixel, and a site's exact cell.
//!
//! A label-carrying distance transform costs the same for any number of sites; with one site per 36 pixels or so, a uniform grid is
//! faster and gives the same exact result. (`benches/` compares both.)

use crate::elementary::Elementary as _;
use crate::geometry::{Point, Rect, Vec2, half_plane};
use crate::parallel::shares;
use crate::raster::Raster;
use std::ops::Range;
use wide::{CmpLt as _, f32x8};

/// Sites in a uniform grid of about one site per cell.
pub struct Sites<'a> {
    points: &'a [Point],
    cell: f64,
    columns: usize,
    rows: usize,
    start: Vec<u32>,
    /// The numbers of the sites, cell after cell, and their places.
    members: Vec<u32>,
    places: Vec<Point>,
}

impl<'a> Sites<'a> {
    /// Sorts sites in a field of `width` x `height` pixels into cells of side `cell`; sites outside go to the border cells.
    pub fn new(points: &'a [Point], width: f64, height: f64, cell: f64) -> Self {
        let columns = (width / cell).ceil().max(1.0) as usize;
        let rows = (height / cell).ceil().max(1.0) as usize;
        let (start, members) = (vec![0; columns * rows + 1], vec![0; points.len()]);
        let mut sites = Self { points, cell, columns, rows, start, members, places: points.to_vec() };
        for p in points {
            let c = sites.cell_index(*p);
            sites.start[c + 1] += 1;
        }
        for c in 0..columns * rows {
            sites.start[c + 1] += sites.start[c];
        }
        let mut next = sites.start.clone();
        for (i, p) in points.iter().enumerate() {
            let c = sites.cell_index(*p);
            sites.members[next[c] as usize] = i as u32;
            sites.places[next[c] as usize] = *p;
            next[c] += 1;
        }
        sites
    }

    fn cell_of(&self, p: Point) -> (usize, usize) {
        (((p.x / self.cell).max(0.0) as usize).min(self.columns - 1), ((p.y / self.cell).max(0.0) as usize).min(self.rows - 1))
    }

    fn cell_index(&self, p: Point) -> usize {
        let (x, y) = self.cell_of(p);
        y * self.columns + x
    }

    fn row_members(&self, x0: usize, x1: usize, y: usize) -> &[u32] {
        &self.members[self.row_range(x0, x1, y)]
    }

    /// Where the sites in some cells of a row stand in `members`.
    fn row_range(&self, x0: usize, x1: usize, y: usize) -> Range<usize> {
        self.start[y * self.columns + x0] as usize..self.start[y * self.columns + x1 + 1] as usize
    }

    /// Sites in the cells at chessboard distance `ring` from the cell of `p`; false when no such cell exists.
    fn for_ring(&self, p: Point, ring: usize, mut visit: impl FnMut(u32)) -> bool {
        let (cx, cy) = self.cell_of(p);
        let (x0, x1) = (cx.saturating_sub(ring), (cx + ring).min(self.columns - 1));
        let mut any = false;
        for y in cy.saturating_sub(ring)..=(cy + ring).min(self.rows - 1) {
            if y.abs_diff(cy) == ring {
                any = true;
                self.row_members(x0, x1, y).iter().for_each(|&i| visit(i));
            } else {
                if cx >= ring {
                    any = true;
                    self.row_members(cx - ring, cx - ring, y).iter().for_each(|&i| visit(i));
                }
                if cx + ring < self.columns && ring > 0 {
                    any = true;
                    self.row_members(cx + ring, cx + ring, y).iter().for_each(|&i| visit(i));
                }
            }
        }
        any
    }

    /// Appends to `out` every site that can be nearest to some point within `radius` of `centre`.
    fn candidates(&self, centre: Point, radius: f64, out: &mut Vec<u32>) {
        let best = self.near(centre);
        let reach = best + 2.0 * radius;
        let squared = reach * reach;
        let (x0, y0) = self.cell_of(Point::new(centre.x - reach, centre.y - reach));
        let (x1, y1) = self.cell_of(Point::new(centre.x + reach, centre.y + reach));
        for y in y0..=y1 {
            let range = self.row_range(x0, x1, y);
            for (i, place) in self.members[range.clone()].iter().zip(&self.places[range]) {
                if place.distance_squared(centre) <= squared {
                    out.push(*i);
                }
            }
        }
    }

    /// The distance of the nearest site among the cells around a place, or of the nearest of all if these are empty.
    fn near(&self, centre: Point) -> f64 {
        let (cx, cy) = self.cell_of(centre);
        let around = |c: usize, count: usize| c.saturating_sub(1)..=(c + 1).min(count - 1);
        let (columns, rows) = (around(cx, self.columns), around(cy, self.rows));
        let places = rows.flat_map(|y| &self.places[self.row_range(*columns.start(), *columns.end(), y)]);
        let nearest = places.fold(f64::INFINITY, |nearest, place| nearest.min(place.distance_squared(centre)));
        if nearest.is_finite() {
            return nearest.sqrt();
        }
        let (mut best, mut ring) = (f64::INFINITY, 2);
        // A ring's sites are at least (ring - 1) cells plus something away; stops once none can beat the best.
        while (ring as f64 - 1.0) * self.cell <= best {
            let found = self.for_ring(centre, ring, |i| best = best.min(self.points[i as usize].distance(centre)));
            if !found {
                break;
            }
            ring += 1;
        }
        best
    }

    /// The nearest site of each pixel's centre; equal distances go to the lower number. Tiles of pixels in which `wanted` is 0
    /// everywhere are skipped and hold `u32::MAX`.
    ///
    /// # Panics
    /// If there is no site.
    pub fn nearest(&self, wanted: &Raster<f32>) -> Raster<u32> {
        assert!(!self.points.is_empty(), "no site to be nearest");
        let (width, height) = (wanted.width(), wanted.height());
        let tile = (self.cell.round() as usize).clamp(2, 64);
        let mut out = Raster::filled(width, height, u32::MAX);
        shares(out.pixels_mut(), width * tile, &|band, out| {
            let (mut candidates, mut places) = (Vec::new(), Vec::new());
            let y0 = band * tile;
            let rows = out.len() / width;
            for x0 in (0..width).step_by(tile) {
                let x1 = (x0 + tile).min(width);
                if (y0..y0 + rows).all(|y| wanted.row(y)[x0..x1].iter().all(|&v| v == 0.0)) {
                    continue;
                }
                let centre = Point::new(0.5 * (x0 + x1) as f64, y0 as f64 + 0.5 * rows as f64);
                let radius = 0.5 * ((x1 - x0) as f64).hypotenuse(rows as f64);
                candidates.clear();
                self.candidates(centre, radius, &mut candidates);
                candidates.sort_unstable();
                places.clear();
                places.extend(candidates.iter().map(|&i| {
                    let offset = self.points[i as usize] - Point::new(x0 as f64 + 0.5, y0 as f64 + 0.5);
                    (offset.x as f32, offset.y as f32)
                }));
                label_tile(out, width, x0..x1, &candidates, &places);
            }
        });
        out
    }
}

/// Pixels of a row that are labelled at a time.
const LANES: usize = 8;

/// The slots of the nearest candidates of pixels in a row, the first at `x`; places are relative to the tile's first pixel.
fn nearest_in_row(places: &[(f32, f32)], x: f32, y: f32) -> [u32; LANES] {
    let columns = f32x8::from([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]) + f32x8::splat(x);
    let (mut best, mut nearest) = (f32x8::splat(f32::INFINITY), f32x8::ZERO);
    for (slot, &(sx, sy)) in places.iter().enumerate() {
        let across = f32x8::splat(sx) - columns;
        let squared = across * across + f32x8::splat((sy - y) * (sy - y));
        let is_nearer = squared.cmp_lt(best);
        best = best ^ (is_nearer & (squared ^ best));
        // Slots are carried as bits, which no arithmetic touches.
        nearest = nearest ^ (is_nearer & (f32x8::splat(f32::from_bits(slot as u32)) ^ nearest));
    }
    nearest.to_array().map(f32::to_bits)
}

/// Writes the nearest candidate of each pixel of a tile; places are relative to the tile's first pixel.
fn label_tile(out: &mut [u32], width: usize, columns: Range<usize>, candidates: &[u32], places: &[(f32, f32)]) {
    for (y, row) in out.chunks_mut(width).enumerate() {
        for (i, labels) in row[columns.clone()].chunks_mut(LANES).enumerate() {
            let nearest = nearest_in_row(places, (i * LANES) as f32, y as f32);
            labels.iter_mut().zip(nearest).for_each(|(label, slot)| *label = candidates[slot as usize]);
        }
    }
}

/// The Voronoi cell of site `index` inside a rectangle and within `reach` of the site (a square), as a convex polygon.
///
/// Of sites at the same place, the one with the lower number gets the cell, the others an empty one.
pub fn cell_polygon(sites: &Sites<'_>, index: usize, field: Rect, reach: f64) -> Vec<Point> {
    let site = sites.points[index];
    let bounds = field.intersect(Rect::from_center_size(site, (2.0 * reach, 2.0 * reach)));
    let mut cell = vec![
        Point::new(bounds.x0, bounds.y0),
        Point::new(bounds.x1, bounds.y0),
        Point::new(bounds.x1, bounds.y1),
        Point::new(bounds.x0, bounds.y1),
    ];
    let mut scratch = Vec::with_capacity(12);
    let mut ring = 0;
    loop {
        let farthest = cell.iter().map(|p| p.distance(site)).fold(0.0, f64::max);
        // A site farther than twice the farthest corner cuts nothing.
        if (ring as f64 - 1.0) * sites.cell > 2.0 * farthest || cell.is_empty() {
            return cell;
        }
        let found = sites.for_ring(site, ring, |i| {
            let other = sites.points[i as usize];
            if i as usize == index || cell.is_empty() {
                return;
            }
            let apart = other - site;
            if apart == Vec2::ZERO {
                if (i as usize) < index {
                    cell.clear();
                }
                return;
            }
            half_plane(&cell, site.midpoint(other), apart, &mut scratch);
            std::mem::swap(&mut cell, &mut scratch);
        });
        if !found {
            return cell;
        }
        ring += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon_area;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_grid_finds_what_trying_all_finds(seeds in prop::collection::vec((0.0_f64..50.0, 0.0_f64..30.0), 1..60), cell in 2.0_f64..20.0) {
            let points: Vec<Point> = seeds.into_iter().map(|(x, y)| Point::new(x, y)).collect();
            let labels = Sites::new(&points, 50.0, 30.0, cell).nearest(&Raster::filled(50, 30, 1.0));
            for y in 0..30 {
                for x in 0..50 {
                    let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
                    let best = points.iter().map(|s| s.distance(p)).fold(f64::INFINITY, f64::min);
                    prop_assert!(points[labels.get(x, y) as usize].distance(p) <= best + 1e-4);
                }
            }
        }

        #[test]
        fn cells_tile_the_field(seeds in prop::collection::vec((0.0_f64..50.0, 0.0_f64..30.0), 1..60)) {
            let points: Vec<Point> = seeds.into_iter().map(|(x, y)| Point::new(x, y)).collect();
            let sites = Sites::new(&points, 50.0, 30.0, 6.0);
            let area: f64 = (0..points.len()).map(|i| polygon_area(&cell_polygon(&sites, i, Rect::new(0.0, 0.0, 50.0, 30.0), 100.0)).abs()).sum();
            prop_assert!((area - 1500.0).abs() < 1e-6, "{}", area);
        }
    }

    #[test]
    fn tiles_that_nobody_wants_are_left_out() {
        let points = [Point::new(5.0, 5.0)];
        let wanted = Raster::from_fn(60, 12, |x, _| f32::from(x < 6));
        let labels = Sites::new(&points, 60.0, 12.0, 6.0).nearest(&wanted);
        assert_eq!(labels.get(2, 2), 0);
        assert_eq!(labels.get(50, 2), u32::MAX);
    }
}
