//! Clipping by any outline: lines parametrically, which keeps their order and direction; areas by boolean operations.

use super::clip::clip_polygon;
use super::crossings::{Crossings, crossings};
use super::polyline::{distance_to_segment, flatten};
use crate::elementary::Elementary as _;
use crate::interrupt::Interrupt;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;
use kurbo::{BezPath, Point, Rect, Shape};

/// A filled region of the page, by the nonzero rule.
#[derive(Clone, Debug)]
pub struct Region {
    polygons: Vec<Vec<Point>>,
    bounds: Rect,
    rows: Rows,
}

/// The edges of a region by horizontal rows of the page, so that only those near a point are tested.
#[derive(Clone, Debug)]
struct Rows {
    top: f64,
    height: f64,
    /// Start of each row's edges in `edges`, and the end of the last row's.
    first: Vec<u32>,
    edges: Vec<[Point; 2]>,
}

/// Mean number of edges per row, and maximum mean number of rows per edge: rows are as low as these allow.
const EDGES_A_ROW: usize = 4;
const ROWS_AN_EDGE: f64 = 6.0;

impl Rows {
    fn new(edges: &[[Point; 2]], bounds: Rect) -> Self {
        let finite: Vec<[Point; 2]> = edges.iter().filter(|edge| edge.iter().all(|p| p.is_finite())).copied().collect();
        let heights: f64 = finite.iter().map(|[a, b]| (a.y - b.y).abs()).sum();
        let extent = bounds.height().max(1e-9);
        let few = ROWS_AN_EDGE * finite.len() as f64 * extent / heights.max(1e-9);
        let count = (finite.len() / EDGES_A_ROW).min(few.min(65_536.0) as usize).max(1);
        let mut rows = Self { top: bounds.y0, height: extent / count as f64, first: vec![0; count + 1], edges: Vec::new() };
        for edge in &finite {
            rows.of(edge[0].y, edge[1].y).for_each(|row| rows.first[row + 1] += 1);
        }
        (0..count).for_each(|row| rows.first[row + 1] += rows.first[row]);
        let mut next = rows.first.clone();
        let mut all = vec![[Point::ORIGIN; 2]; rows.first[count] as usize];
        for edge in finite {
            for row in rows.of(edge[0].y, edge[1].y) {
                all[next[row] as usize] = edge;
                next[row] += 1;
            }
        }
        rows.edges = all;
        rows
    }

    /// The rows between two heights, clamped to the first and the last.
    fn of(&self, a: f64, b: f64) -> std::ops::RangeInclusive<usize> {
        let row = |y: f64| (((y - self.top) / self.height).max(0.0) as usize).min(self.first.len() - 2);
        row(a.min(b))..=row(a.max(b))
    }

    fn edges(&self, row: usize) -> &[[Point; 2]] {
        &self.edges[self.first[row] as usize..self.first[row + 1] as usize]
    }
}

impl Region {
    /// The inside of closed subpaths, with curves flattened to `tolerance`. Points that are no numbers are left out.
    pub fn new(outline: &BezPath, tolerance: f64) -> Self {
        let polygons: Vec<Vec<Point>> =
            flatten(outline, tolerance).into_iter().map(|(points, _)| finite(&points)).filter(|p| p.len() > 2).collect();
        match outline.bounding_box() {
            bounds if bounds.is_finite() => Self::within(polygons, bounds),
            _ => Self::of_polygons(polygons),
        }
    }

    fn within(polygons: Vec<Vec<Point>>, bounds: Rect) -> Self {
        let edges: Vec<[Point; 2]> = polygons.iter().flat_map(|polygon| edges_of(polygon)).collect();
        Self { rows: Rows::new(&edges, bounds), polygons, bounds }
    }

    /// The inside of closed polygons.
    pub fn of_polygons(polygons: Vec<Vec<Point>>) -> Self {
        let corners = polygons.iter().flatten().map(|p| Rect::from_points(*p, *p));
        let bounds = corners.reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO);
        Self::within(polygons, bounds)
    }

    /// The part of the region in a window; its sides along the window count as border.
    #[must_use]
    pub fn in_window(&self, window: Rect) -> Self {
        let cut = self.polygons.iter().map(|polygon| clip_polygon(polygon, window)).filter(|polygon| polygon.len() > 2);
        Self::of_polygons(cut.collect())
    }

    /// Whether a box lies inside or outside as a whole; none if it may meet the border.
    pub fn holds_box(&self, shape: Rect) -> Option<bool> {
        let reach = 0.5 * shape.width().hypotenuse(shape.height());
        (!self.is_near_border(shape.center(), reach)).then(|| self.contains(shape.center()))
    }

    /// The bounding box.
    pub const fn bounds(&self) -> Rect {
        self.bounds
    }

    /// Number of edges of its border.
    pub fn edge_count(&self) -> usize {
        self.polygons.iter().map(Vec::len).sum()
    }

    /// Crossings of its border and another's, with themselves and each other, counted up to `most`: the work of an overlay.
    pub fn crossings_with(&self, other: &Self, most: usize) -> Crossings {
        crossings(self.polygons.iter().chain(&other.polygons), most)
    }

    /// True if a point lies inside (winding number not 0).
    pub fn contains(&self, p: Point) -> bool {
        let mut winding = 0;
        for &[a, b] in self.rows.edges(*self.rows.of(p.y, p.y).start()) {
            if (a.y <= p.y) != (b.y <= p.y) {
                let side = (b - a).cross(p - a);
                if b.y > a.y && side > 0.0 {
                    winding += 1;
                } else if b.y < a.y && side < 0.0 {
                    winding -= 1;
                }
            }
        }
        winding != 0
    }

    /// True if a point lies within `slack` of the border.
    pub fn is_near_border(&self, p: Point, slack: f64) -> bool {
        let rows = || self.rows.of(p.y - slack, p.y + slack).flat_map(|row| self.rows.edges(row));
        self.bounds.inflate(slack, slack).contains(p) && rows().any(|&[a, b]| distance_to_segment(p, a, b) <= slack)
    }

    /// The pieces of a polyline inside, in order and direction. A single point is kept if it is inside. Anything within `slack`
    /// of the border counts as inside; otherwise rounding would decide about lines on the border.
    pub fn clip_line(&self, points: &[Point], slack: f64) -> Vec<Vec<Point>> {
        let pieces = self.pieces(points, |p| self.contains(p) || self.is_near_border(p, slack), &Interrupt::never());
        pieces.into_iter().map(|piece| piece.into_iter().map(|(p, _)| p).collect()).collect()
    }

    /// The pieces of a polyline outside, each point with its position along the line (vertex index plus fraction). Incomplete
    /// once the interrupt is raised.
    pub fn outside_of_line(&self, points: &[Point], interrupt: &Interrupt) -> Vec<Vec<(Point, f64)>> {
        self.pieces(points, |p| !self.contains(p), interrupt)
    }

    /// The pieces of a polyline inside, each point with its position along the line (vertex index plus fraction).
    pub fn inside_of_line(&self, points: &[Point]) -> Vec<Vec<(Point, f64)>> {
        self.pieces(points, |p| self.contains(p), &Interrupt::never())
    }

    fn pieces(&self, points: &[Point], is_wanted: impl Fn(Point) -> bool, interrupt: &Interrupt) -> Vec<Vec<(Point, f64)>> {
        if let [p] = points {
            return if is_wanted(*p) { vec![vec![(*p, 0.0)]] } else { Vec::new() };
        }
        let mut pieces: Vec<Vec<(Point, f64)>> = Vec::new();
        let mut is_open = false;
        for (i, pair) in points.windows(2).enumerate().take_while(|_| !interrupt.is_raised()) {
            let mut cuts = self.cuts(pair[0], pair[1]);
            cuts.sort_unstable_by(f64::total_cmp);
            for span in cuts.windows(2).filter(|span| span[1] > span[0]) {
                let at = |t: f64| if t >= 1.0 { pair[1] } else { pair[0].lerp(pair[1], t) };
                if !is_wanted(at(0.5 * (span[0] + span[1]))) {
                    is_open = false;
                    continue;
                }
                if !is_open {
                    pieces.push(vec![(at(span[0]), i as f64 + span[0])]);
                }
                if let Some(piece) = pieces.last_mut() {
                    // A point where the line touches the outline without crossing it needs no vertex.
                    if is_open && span[0] > 0.0 {
                        piece.pop();
                    }
                    piece.push((at(span[1]), i as f64 + span[1]));
                }
                is_open = true;
            }
        }
        pieces
    }

    /// Number of points at which a polyline meets the outline.
    pub fn cut_count(&self, points: &[Point]) -> usize {
        points.windows(2).map(|pair| self.cuts(pair[0], pair[1]).len() - 2).sum()
    }

    /// Parameters at which a segment meets the outline, and those of its own ends (0 and 1).
    fn cuts(&self, a: Point, b: Point) -> Vec<f64> {
        let mut cuts = vec![0.0, 1.0];
        if !Rect::from_points(a, b).inflate(1e-9, 1e-9).overlaps(self.bounds) {
            return cuts;
        }
        let d = b - a;
        for &[p, q] in self.rows.of(a.y, b.y).flat_map(|row| self.rows.edges(row)) {
            let e = q - p;
            let denominator = d.cross(e);
            if denominator != 0.0 {
                let (t, u) = ((p - a).cross(e) / denominator, (p - a).cross(d) / denominator);
                if (0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&u) {
                    cuts.push(t);
                }
            }
        }
        cuts
    }

    /// The part of another region inside this one.
    pub fn clip_area(&self, area: &Self) -> BezPath {
        self.overlay(area, OverlayRule::Intersect)
    }

    /// The part of another region outside this one.
    pub fn outside_of_area(&self, area: &Self) -> BezPath {
        self.overlay(area, OverlayRule::Difference)
    }

    fn overlay(&self, area: &Self, rule: OverlayRule) -> BezPath {
        let contours = |region: &Self| -> Vec<Vec<[f64; 2]>> {
            region.polygons.iter().map(|polygon| polygon.iter().map(|p| [p.x, p.y]).collect()).collect()
        };
        path_of(contours(area).overlay(&contours(self), rule, FillRule::NonZero))
    }
}

/// The points of a polygon that are numbers: the area library panics at others.
fn finite(points: &[Point]) -> Vec<Point> {
    points.iter().filter(|p| p.is_finite()).copied().collect()
}

/// The sides of a closed polygon.
fn edges_of(polygon: &[Point]) -> impl Iterator<Item = [Point; 2]> + '_ {
    (0..polygon.len()).map(|i| [polygon[i], polygon[(i + 1) % polygon.len()]])
}

/// The fill rule of an outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Winding {
    /// Inside where the winding number is not 0.
    NonZero,
    /// Inside where a ray outwards crosses it an odd number of times.
    EvenOdd,
}

/// An outline with the same inside, with borders in one direction and holes in the other: the nonzero rule fills it, also
/// together with other such outlines. Curves are flattened to `tolerance`.
pub fn untangled(outline: &BezPath, winding: Winding, tolerance: f64) -> BezPath {
    untangled_polygons(&flatten(outline, tolerance).into_iter().map(|(points, _)| points).collect::<Vec<_>>(), winding)
}

/// [`untangled`] for polygons.
pub fn untangled_polygons(polygons: &[Vec<Point>], winding: Winding) -> BezPath {
    let contours: Vec<Vec<[f64; 2]>> =
        polygons.iter().map(|points| finite(points).into_iter().map(|p| [p.x, p.y]).collect()).collect();
    let rule = if winding == Winding::EvenOdd { FillRule::EvenOdd } else { FillRule::NonZero };
    let nothing: Vec<Vec<[f64; 2]>> = Vec::new();
    path_of(contours.overlay(&nothing, OverlayRule::Subject, rule))
}

fn path_of(shapes: Vec<Vec<Vec<[f64; 2]>>>) -> BezPath {
    let mut path = BezPath::new();
    for contour in shapes.into_iter().flatten() {
        for (i, [x, y]) in contour.into_iter().enumerate() {
            if i == 0 { path.move_to((x, y)) } else { path.line_to((x, y)) }
        }
        path.close_path();
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring() -> Region {
        // A 10 x 10 square with a 4 x 4 hole, wound the other way.
        Region::new(&BezPath::from_svg("M0,0 H10 V10 H0 Z M3,3 V7 H7 V3 Z").unwrap(), 0.01)
    }

    #[test]
    fn a_line_across_a_ring_gives_two_pieces_in_order() {
        let pieces = ring().clip_line(&[Point::new(12.0, 5.0), Point::new(-2.0, 5.0)], 0.0);
        assert_eq!(pieces.len(), 2);
        assert!(pieces[0][0].distance(Point::new(10.0, 5.0)) < 1e-9 && pieces[0][1].distance(Point::new(7.0, 5.0)) < 1e-9);
        assert!(pieces[1][0].distance(Point::new(3.0, 5.0)) < 1e-9 && pieces[1][1].distance(Point::new(0.0, 5.0)) < 1e-9);
    }

    #[test]
    fn a_line_on_the_border_is_whole() {
        let square = Region::new(&BezPath::from_svg("M0,0 H10 V10 H0 Z").unwrap(), 0.01);
        for off in [-0.009, -1e-7, 0.0, 1e-7, 0.009] {
            let frame = [(off, off), (10.0 - off, off), (10.0 - off, 10.0 - off), (off, 10.0 - off), (off, off)].map(Point::from);
            let pieces = square.clip_line(&frame, 0.01);
            assert_eq!((pieces.len(), pieces[0].len()), (1, 5), "{off}: {pieces:?}");
        }
        assert!(square.clip_line(&[Point::new(0.0, -0.02), Point::new(10.0, -0.02)], 0.01).is_empty());
    }

    #[test]
    fn even_odd_outlines_keep_their_holes_by_the_nonzero_rule() {
        let nested = BezPath::from_svg("M0,0 H10 V10 H0 Z M3,3 H7 V7 H3 Z").unwrap();
        assert!((untangled(&nested, Winding::EvenOdd, 0.01).area().abs() - 84.0).abs() < 1e-6);
        assert!((untangled(&nested, Winding::NonZero, 0.01).area().abs() - 100.0).abs() < 1e-6);
    }

    #[test]
    fn points_that_are_no_numbers_are_left_out() {
        let mut outline = BezPath::from_svg("M0,0 H10 V10").unwrap();
        outline.line_to((f64::NAN, 12.0));
        outline.line_to((0.0, 10.0));
        outline.close_path();
        let square = Region::new(&outline, 0.01);
        assert!(square.bounds().is_finite() && square.contains(Point::new(5.0, 5.0)));
        assert!((ring().clip_area(&square).area().abs() - 84.0).abs() < 1e-6);
        assert!((untangled(&outline, Winding::NonZero, 0.01).area().abs() - 100.0).abs() < 1e-6);
    }

    #[test]
    fn a_window_s_part_cuts_what_lies_in_the_window_as_the_whole_does() {
        let dot = Region::new(&kurbo::Circle::new((3.2, 5.0), 0.8).to_path(1e-3), 1e-3);
        let window = dot.bounds().inflate(0.1, 0.1);
        let [whole, part] = [ring(), ring().in_window(window)].map(|region| region.clip_area(&dot).area().abs());
        assert!((whole - part).abs() < 1e-6 && whole > 0.1, "{whole} {part}");
        let at = |x: f64, y: f64| Rect::from_center_size((x, y), (1.0, 1.0));
        assert_eq!(
            [at(1.5, 5.0), at(5.0, 5.0), at(3.0, 5.0), at(20.0, 5.0)].map(|b| ring().holds_box(b)),
            [Some(true), Some(false), None, Some(false)]
        );
    }

    #[test]
    fn an_area_is_cut() {
        let area = Region::new(&BezPath::from_svg("M-5,-5 H5 V5 H-5 Z").unwrap(), 0.01);
        assert!((ring().clip_area(&area).area().abs() - 21.0).abs() < 1e-6);
    }
}
