//! Tile mosaics (Son et al. 2011, section 7.3): a square at each crossing, turned with the features.

use super::Drawer;
use super::cells::Cell;
use crate::drawing::{Area, Colour, Layer, Mark, Stroke};
use crate::elementary::Elementary as _;
use crate::geometry::{BezPath, Point, Vec2, half_plane, polygon_area};

/// Width of a tile's outline and hatching for a pen, in pitches.
const PEN: f64 = 0.08;

/// Tiles as areas in the photograph's colours.
pub(super) fn layer(drawer: &Drawer<'_>, cells: &[Cell]) -> Layer {
    drawer.observer.begin("tiles");
    let mut layer = Layer::new("tiles", 1);
    layer.marks = inked(cells)
        .filter_map(|cell| {
            let outline = on_page(drawer, &tile(drawer, cell)?, Closing::Closed);
            Some(Mark::Area(Area { outline, colour: Some(colour(cell.light)) }))
        })
        .collect();
    layer
}

/// Tiles as outlines, hatched to make the tone.
pub(super) fn line_layer(drawer: &Drawer<'_>, cells: &[Cell]) -> Layer {
    drawer.observer.begin("tiles");
    let width = PEN * drawer.parameters.pitch.0;
    let mut layer = Layer::new("tiles", 1);
    for cell in inked(cells) {
        let Some(tile) = tile(drawer, cell) else { continue };
        layer.marks.push(Mark::Stroke(Stroke::even(on_page(drawer, &tile, Closing::Closed), width)));
        for line in hatched(&tile, cell, PEN * drawer.pitch()) {
            layer.marks.push(Mark::Stroke(Stroke::even(on_page(drawer, &line, Closing::Open), width)));
        }
    }
    layer
}

/// Cells with a tile: those of the subject.
fn inked(cells: &[Cell]) -> impl Iterator<Item = &Cell> {
    cells.iter().filter(|cell| cell.area > 0.0 && cell.is_subject)
}

/// The square of side `sqrt(cell) - gap`, clipped to its own cell less half the gap, so that no two tiles touch.
fn tile(drawer: &Drawer<'_>, cell: &Cell) -> Option<Vec<Point>> {
    let gap = drawer.pixels(drawer.parameters.tile_gap);
    let half = 0.5 * (cell.area.sqrt() - gap);
    if half <= 0.0 {
        return None;
    }
    let (a, b) = (cell.tangent * half, cell.tangent.turn_90() * half);
    let mut square = vec![cell.centre + a + b, cell.centre + a - b, cell.centre - a - b, cell.centre - a + b];
    let mut cut = Vec::with_capacity(10);
    let clockwise = polygon_area(&cell.polygon) > 0.0;
    for (i, &p) in cell.polygon.iter().enumerate() {
        let side = cell.polygon[(i + 1) % cell.polygon.len()] - p;
        if side.hypot() < 1e-9 {
            continue;
        }
        let outward = if clockwise { -side.turn_90() } else { side.turn_90() }.normalize();
        half_plane(&square, p - outward * (0.5 * gap), outward, &mut cut);
        std::mem::swap(&mut square, &mut cut);
    }
    (square.len() > 2 && polygon_area(&square).abs() > 0.05 * half * half).then_some(square)
}

/// Lines across a tile whose ink, together with the outline's, is the cell's.
fn hatched(tile: &[Point], cell: &Cell, width: f64) -> Vec<Vec<Point>> {
    let around: f64 = (0..tile.len()).map(|i| tile[i].distance(tile[(i + 1) % tile.len()])).sum();
    let missing = cell.darkness * cell.area - around * width;
    let side = polygon_area(tile).abs().sqrt();
    let count = (missing / (side * width)).round().clamp(0.0, (side / width).floor()) as usize;
    let (along, across) = (cell.tangent, cell.tangent.turn_90());
    let (low, high) = extent(tile, cell.centre, across);
    (0..count)
        .filter_map(|i| {
            let at = low + (high - low) * (i as f64 + 1.0) / (count as f64 + 1.0);
            chord(tile, cell.centre + across * at, along)
        })
        .collect()
}

fn extent(polygon: &[Point], centre: Point, direction: Vec2) -> (f64, f64) {
    polygon
        .iter()
        .map(|p| (*p - centre).dot(direction))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)))
}

/// The part of a line inside a convex polygon.
fn chord(polygon: &[Point], p: Point, direction: Vec2) -> Option<Vec<Point>> {
    let mut cuts: Vec<f64> = (0..polygon.len())
        .filter_map(|i| {
            let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
            let (da, db) = (direction.cross(a - p), direction.cross(b - p));
            if (da < 0.0) == (db < 0.0) {
                return None;
            }
            let q = a.lerp(b, da / (da - db));
            Some((q - p).dot(direction))
        })
        .collect();
    cuts.sort_unstable_by(f64::total_cmp);
    let (first, last) = (*cuts.first()?, *cuts.last()?);
    (last - first > 1e-6).then(|| vec![p + direction * first, p + direction * last])
}

#[derive(Clone, Copy, PartialEq)]
enum Closing {
    Open,
    Closed,
}

fn on_page(drawer: &Drawer<'_>, points: &[Point], closing: Closing) -> BezPath {
    let mut path = BezPath::new();
    for (i, p) in points.iter().enumerate() {
        let p = drawer.portrait.placement.to_page(*p);
        if i == 0 { path.move_to(p) } else { path.line_to(p) }
    }
    if closing == Closing::Closed {
        path.close_path();
    }
    path
}

/// Linear light as an sRGB colour.
fn colour(light: [f32; 3]) -> Colour {
    let encode = |v: f32| {
        let v = v.clamp(0.0, 1.0);
        let encoded = if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.power(1.0 / 2.4) - 0.055 };
        (encoded * 255.0).round() as u8
    };
    Colour { r: encode(light[0]), g: encode(light[1]), b: encode(light[2]) }
}
