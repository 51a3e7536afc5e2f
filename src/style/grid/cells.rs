//! The Voronoi cells of the crossings: outline, area and target ink.

use super::Drawer;
use super::lines::{LONGEST_TAPER, Lines};
use super::structure::StructureGrid;
use crate::field::{CoherentLine, Sites, cell_polygon};
use crate::geometry::{Point, Rect, Vec2, polygon_area};
use crate::parallel::collected;
use crate::raster::Raster;
use crate::style::feature_line::tapered_widths;
use kurbo::{Line, ParamCurveNearest, Shape};

/// Maximum reach of a cell from its crossing, in pitches; cells are open at singular points and beyond the subject's border.
const CELL_REACH: f64 = 1.5;

/// One crossing and its cell, in working pixels.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    pub centre: Point,
    /// Unit vector along the features.
    pub tangent: Vec2,
    /// The Voronoi cell.
    pub polygon: Vec<Point>,
    pub area: f64,
    /// Target ink in square pixels, less the ink of the feature lines.
    pub ink: f64,
    /// True if part of it lies under a feature line or outside the subject.
    pub is_cut: bool,
    /// True if it fills a hole in the grid: no line runs through it.
    pub is_filler: bool,
    /// Target ink as a share, 0 to 1.
    pub darkness: f64,
    /// True if more than half of it belongs to the subject.
    pub is_subject: bool,
    /// For a cell partly outside the subject: the white that the tone leaves inside, in square pixels.
    pub open_white: Option<f64>,
    /// Target ink as a share of its pixels of the subject.
    pub subject_darkness: f64,
    /// Mean linear light of the photograph.
    pub light: [f32; 3],
}

/// The cells of the grid's points, with less ink where lines are drawn.
pub(super) fn cells(drawer: &Drawer<'_>, grid: &StructureGrid, ink: &Raster<f32>, lines: &Lines) -> Vec<Cell> {
    drawer.observer.begin("cells");
    let (width, height) = drawer.size();
    let covering = || lines.drawn.iter().chain(&lines.rims);
    let covered = covering().next().is_some().then(|| coverage(covering(), LONGEST_TAPER * drawer.pitch(), (width, height)));
    cells_of(drawer, grid, &grid.crossings, grid.true_crossings, ink, covered.as_ref())
}

/// The cells of any points, of which the first `true_points` are crossings and the others fill holes.
pub(super) fn cells_of(
    drawer: &Drawer<'_>,
    grid: &StructureGrid,
    points: &[Point],
    true_points: usize,
    ink: &Raster<f32>,
    covered: Option<&Raster<f32>>,
) -> Vec<Cell> {
    if points.is_empty() {
        return Vec::new();
    }
    let (width, height) = drawer.size();
    let field = Rect::new(0.0, 0.0, width as f64, height as f64);
    let sites = Sites::new(points, field.x1, field.y1, drawer.pitch());
    let wanted = sums(drawer, &sites, points.len(), ink, covered);
    collected(points.len(), &|i| {
        let polygon = cell_polygon(&sites, i, field, CELL_REACH * drawer.pitch());
        wanted[i].cell(points[i], grid.tangent(points[i]), polygon, i >= true_points)
    })
}

/// Sums over the pixels of one cell.
#[derive(Clone, Copy, Default)]
struct Sum {
    pixels: f64,
    ink: f64,
    /// Ink of the feature lines.
    covered: f64,
    light: [f64; 3],
    subject: f64,
    /// True if part of the cell lies outside the subject, so that its polygon is larger than the drawn part.
    is_open: bool,
}

impl Sum {
    /// Ink area for a cell of area `cell`: the share of its mean tone or, at the subject's border, the sum over its pixels.
    fn ink(&self, cell: f64) -> f64 {
        let wanted = (self.ink - self.covered).max(0.0);
        if self.is_open || self.pixels == 0.0 { wanted } else { wanted / self.pixels * cell }
    }

    fn cell(&self, centre: Point, tangent: Vec2, polygon: Vec<Point>, is_filler: bool) -> Cell {
        let area = polygon_area(&polygon).abs();
        Cell {
            centre,
            tangent,
            polygon,
            area,
            ink: self.ink(area),
            is_cut: self.covered > 0.0 || self.is_open,
            is_filler,
            darkness: self.ink / self.pixels.max(1.0),
            is_subject: self.subject > 0.5 * self.pixels,
            open_white: self.is_open.then_some(self.subject - self.ink),
            subject_darkness: self.ink / self.subject.max(1e-9),
            light: self.light.map(|v| (v / self.pixels.max(1.0)) as f32),
        }
    }
}

fn sums(drawer: &Drawer<'_>, sites: &Sites<'_>, count: usize, ink: &Raster<f32>, covered: Option<&Raster<f32>>) -> Vec<Sum> {
    let subject = &drawer.portrait.subject;
    let nearest = sites.nearest(subject);
    let mut sums = vec![Sum::default(); count];
    for (pixel, &site) in nearest.pixels().iter().enumerate() {
        if site == u32::MAX {
            continue;
        }
        let sum = &mut sums[site as usize];
        sum.pixels += 1.0;
        sum.ink += f64::from(ink.pixels()[pixel]);
        sum.covered += covered.map_or(0.0, |raster| f64::from(raster.pixels()[pixel]));
        sum.subject += f64::from(subject.pixels()[pixel]);
        sum.is_open |= subject.pixels()[pixel] < 0.999;
        for (total, light) in sum.light.iter_mut().zip(drawer.portrait.light.pixels()[pixel]) {
            *total += f64::from(light);
        }
    }
    sums
}

/// How much of each pixel the strokes of feature lines cover.
fn coverage<'a>(
    lines: impl Iterator<Item = &'a CoherentLine>,
    longest_taper: f64,
    (width, height): (usize, usize),
) -> Raster<f32> {
    let mut covered = Raster::filled(width, height, 0.0_f32);
    for line in lines {
        let widths = tapered_widths(line, longest_taper);
        let closing = usize::from(line.curve.closed);
        let count = widths.len();
        for (i, j) in (0..(count + closing).saturating_sub(1)).map(|i| (i, (i + 1) % count)) {
            let piece = Line::new(line.curve.points[i], line.curve.points[j]);
            let wide = 0.5 * (widths[i] + widths[j]);
            let reach = 0.5 * wide + 0.5;
            let near = piece.bounding_box().inflate(reach, reach);
            let (x0, x1) = (near.x0.max(0.0) as usize, (near.x1.max(0.0) as usize).min(width - 1));
            let (y0, y1) = (near.y0.max(0.0) as usize, (near.y1.max(0.0) as usize).min(height - 1));
            for y in y0..=y1 {
                for x in x0..=x1 {
                    let away = piece.nearest(Point::new(x as f64 + 0.5, y as f64 + 0.5), 1e-3).distance_sq.sqrt();
                    let share = (reach - away).clamp(0.0, wide.clamp(0.0, 1.0)) as f32;
                    covered.set(x, y, covered.get(x, y).max(share));
                }
            }
        }
    }
    covered
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Mark;
    use crate::elementary::unit_at;
    use crate::field::Curve;
    use crate::source::Placement;
    use crate::style::feature_line::feature_stroke;

    /// What dots leave to a line is what its stroke lays.
    #[test]
    fn a_line_covers_the_ink_of_its_tapering_stroke() {
        let points: Vec<Point> = (0..90).map(|i| Point::new(5.0 + f64::from(i), 20.0 + 0.1 * f64::from(i))).collect();
        let around = |i: u32| Point::new(60.0, 30.0) + 20.0 * unit_at(std::f64::consts::TAU * f64::from(i) / 120.0);
        let ring: Vec<Point> = (0..120).map(around).collect();
        let lines = [(points, false), (ring, true)];
        for (width, (points, closed)) in [0.4, 1.5, 4.0].into_iter().flat_map(|width| lines.iter().map(move |line| (width, line)))
        {
            let line = CoherentLine::plain(Curve { points: points.clone(), closed: *closed }, width);
            let covered: f32 = coverage(std::iter::once(&line), 20.0, (120, 60)).pixels().iter().sum();
            let placement = Placement::new(Rect::new(0.0, 0.0, 120.0, 60.0), 1.0);
            let Some(Mark::Stroke(stroke)) = feature_stroke(&line, &placement, 20.0) else { panic!("a stroke") };
            let ink = stroke.ink_outline(1e-3).area().abs();
            assert!((f64::from(covered) / ink - 1.0).abs() < 0.1, "{width} {closed}: {covered} for {ink}");
        }
    }
}
