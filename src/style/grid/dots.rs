//! Dots at the crossings (Son et al. 2011, section 6.1), with exactly the ink of their cells.

use super::Drawer;
use super::cells::Cell;
use super::darks::Darks;
use super::mixing::{Mixing, paper_radius};
use super::parameters::Overlap;
use super::shape::grid_shape;
use super::structure::StructureGrid;
use crate::drawing::{Dot, Layer, Mark};
use crate::geometry::{Point, Vec2, blob, disc_area_in, half_plane, polygon_area, radius_for_area};
use crate::parallel::collected;
use crate::raster::Raster;
use crate::style::random;

/// Radius in pitches below which a dot is left out: 0.001 % ink.
const LEAST_RADIUS: f64 = 0.002;
/// The same for a dot cut by a feature line or the subject's border: smaller ones look like dirt beside the line (seen on faces), larger
/// ones continue the row across it.
const LEAST_CUT_RADIUS: f64 = 0.16;

pub(super) fn layer(drawer: &Drawer<'_>, grid: &StructureGrid, cells: &[Cell], darks: &Darks, ink: &Raster<f32>) -> Layer {
    drawer.observer.begin("dots");
    let mixing = Mixing::new(drawer);
    let mut layer = Layer::new("dots", 1);
    let dot = |i: usize| {
        let cell = cells.get(i).filter(|cell| !darks.cover(cell.centre))?;
        let radius = radius(drawer, grid, &mixing, cell, ink);
        let least = if cell.is_cut { LEAST_CUT_RADIUS } else { LEAST_RADIUS };
        (radius > least * grid.spacing.at(cell.centre)).then(|| Mark::Dot(mark(drawer, grid, cell, radius, i)))
    };
    layer.marks = collected(cells.len(), &dot).into_iter().flatten().collect();
    layer
}

/// Radius in pixels; 0 for no dot.
fn radius(drawer: &Drawer<'_>, grid: &StructureGrid, mixing: &Mixing, cell: &Cell, ink: &Raster<f32>) -> f64 {
    let tone = 1.0 - f64::from(ink.sample(cell.centre.x, cell.centre.y));
    let share = if cell.is_filler { 0.0 } else { mixing.line_share(tone) };
    if share >= 1.0 {
        return 0.0;
    }
    if drawer.parameters.overlap == Overlap::Paper {
        return (1.0 - share) * paper_radius(1.0 - cell.ink / cell.area.max(1e-9), grid.spacing.at(cell.centre));
    }
    if share == 0.0 {
        return radius_for_area(&cell.polygon, cell.centre, cell.ink);
    }
    let width = share * mixing.full_width(tone, [0, 1].map(|family| grid.density_at(family, cell.centre)));
    let half = [0, 1].map(|family| if mixing.hatches(family) { 0.5 * width } else { 0.0 });
    beside_lines(cell, half)
}

/// The radius of the disc that, together with lines of these half widths through the cell's centre (along and across), covers the cell's
/// ink: the disc counts only in the four corners beside the lines.
fn beside_lines(cell: &Cell, half: [f64; 2]) -> f64 {
    let corners = corners(cell, half);
    let white: f64 = corners.iter().map(|corner| polygon_area(corner).abs()).sum();
    let missing = cell.ink - (cell.area - white);
    if missing <= 0.0 {
        return 0.0;
    }
    let covered = |radius: f64| corners.iter().map(|corner| disc_area_in(corner, cell.centre, radius)).sum::<f64>();
    let farthest = cell.polygon.iter().map(|p| p.distance(cell.centre)).fold(0.0, f64::max);
    let (mut low, mut high) = (0.0, farthest);
    // 30 halvings leave a billionth of the cell.
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if covered(middle) < missing { low = middle } else { high = middle }
    }
    high
}

/// The four corners of the cell beside two crossing lines.
fn corners(cell: &Cell, half: [f64; 2]) -> [Vec<Point>; 4] {
    let (along, across) = (cell.tangent, cell.tangent.turn_90());
    [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(a, b): (f64, f64)| {
        // Beside the line along the features: farther across them than its half width; and vice versa.
        let once = beyond(&cell.polygon, cell.centre, across * a, half[0]);
        beyond(&once, cell.centre, along * b, half[1])
    })
}

/// The part of a polygon farther than `distance` from `centre` in one direction.
fn beyond(polygon: &[Point], centre: Point, direction: Vec2, distance: f64) -> Vec<Point> {
    let mut out = Vec::with_capacity(polygon.len() + 1);
    half_plane(polygon, centre + direction * distance, -direction, &mut out);
    out
}

fn mark(drawer: &Drawer<'_>, grid: &StructureGrid, cell: &Cell, radius: f64, index: usize) -> Dot {
    let placement = &drawer.portrait.placement;
    let (centre, scale) = (placement.to_page(cell.centre), placement.mm_per_pixel());
    let outline = if drawer.parameters.blob > 0.0 {
        let mut random = random::stream(drawer.seed, "blobs", index as u64);
        Some(Box::new(blob(centre, radius * scale, drawer.parameters.blob, &mut random)))
    } else if drawer.parameters.dot_shape > 0.0 {
        Some(Box::new(grid_shape(drawer, grid, cell, radius)))
    } else {
        None
    };
    Dot { centre, radius: radius * scale, outline, colour: None }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::unit_at;

    #[test]
    fn dot_and_lines_together_have_the_ink() {
        let polygon = vec![Point::new(-3.2, -2.9), Point::new(3.0, -3.1), Point::new(2.9, 3.0), Point::new(-3.0, 3.1)];
        let area = polygon_area(&polygon).abs();
        for darkness in [0.6, 0.75, 0.9] {
            let tangent = unit_at(0.1);
            let cell = Cell {
                centre: Point::ORIGIN,
                tangent,
                polygon: polygon.clone(),
                area,
                ink: darkness * area,
                is_cut: false,
                is_filler: false,
                darkness,
                is_subject: true,
                open_white: None,
                subject_darkness: darkness,
                light: [0.0; 3],
            };
            let half = [0.4, 0.5];
            let radius = beside_lines(&cell, half);
            let (mut hits, mut all) = (0.0, 0.0);
            for i in 0..800 {
                for j in 0..800 {
                    let p = Point::new(f64::from(i) * 0.01 - 4.0, f64::from(j) * 0.01 - 4.0);
                    let inside = (0..4).all(|k| (polygon[(k + 1) % 4] - polygon[k]).cross(p - polygon[k]) >= 0.0);
                    if inside {
                        all += 1.0;
                        let v = p.to_vec2();
                        let inked = v.cross(tangent).abs() < half[0] || v.dot(tangent).abs() < half[1] || v.hypot() < radius;
                        hits += f64::from(u8::from(inked));
                    }
                }
            }
            assert!((hits / all - darkness).abs() < 0.004, "{} for {darkness}", hits / all);
        }
    }
}
