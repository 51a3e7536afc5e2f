//! Dots that take the shape of the bent grid (Son et al. 2011, section 6.4).
//!
//! The paper blends two distances from a dot's centre: `G`, straight, and `G'`, along the grid's own lines. Here the outline is where
//! the blend is the dot's radius, scaled to the area for the tone.

use super::Drawer;
use super::cells::Cell;
use super::structure::StructureGrid;
use crate::elementary::{Elementary as _, angle_of, unit_at};
use crate::geometry::{Affine, BezPath, Point, Ring, Vec2, catmull_rom};
use kurbo::Shape;
use std::f64::consts::{PI, TAU};

/// Nodes of an outline; enough for a rounded square.
const NODES: u32 = 12;

/// Outline on the page of a dot of this radius (pixels).
pub(super) fn grid_shape(drawer: &Drawer<'_>, grid: &StructureGrid, cell: &Cell, radius: f64) -> BezPath {
    let blend = drawer.parameters.dot_shape;
    let base = angle_of(cell.tangent);
    let nodes: Vec<Point> = (0..NODES)
        .map(|k| {
            let way = unit_at(base + TAU * f64::from(k) / f64::from(NODES));
            cell.centre + way * reach(drawer, grid, cell, way, radius, blend)
        })
        .collect();
    let placement = &drawer.portrait.placement;
    let page: Vec<Point> = nodes.iter().map(|p| placement.to_page(*p)).collect();
    let outline = catmull_rom(&page, Ring::Closed);
    let wanted = PI * (radius * placement.mm_per_pixel()).powi(2);
    let centre = placement.to_page(cell.centre).to_vec2();
    let scale = (wanted / outline.area().abs().max(1e-12)).sqrt();
    Affine::translate(centre) * Affine::scale(scale) * Affine::translate(-centre) * outline
}

/// Distance of the outline in one direction, found by bisection; at most 1.6 times the radius.
fn reach(drawer: &Drawer<'_>, grid: &StructureGrid, cell: &Cell, way: Vec2, radius: f64, blend: f64) -> f64 {
    let bent = |r: f64| {
        let p = cell.centre + way * r;
        let distance = [0, 1].map(|family| {
            let cycles = grid.stripes[family].phase_at(p) / TAU;
            (cycles - cycles.round()).abs() * drawer.pitch()
        });
        distance[0].hypotenuse(distance[1])
    };
    let (mut low, mut high) = (0.5 * radius, 1.6 * radius);
    for _ in 0..12 {
        let middle = 0.5 * (low + high);
        if (1.0 - blend) * middle + blend * bent(middle) < radius { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
