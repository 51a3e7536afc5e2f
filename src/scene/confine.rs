//! Cuts a drawing to a part of the picture.

use super::Parts;
use crate::drawing::{Area, Dot, Drawing, Mark, Stroke, Width};
use crate::geometry::{BezPath, Point, Region, lengths_along};
use crate::parallel::mapped;
use kurbo::Shape;

impl Parts {
    /// A part's drawing without what lies outside of the part. Dots and areas are cut along its border, strokes end there.
    pub fn confined(&self, part: usize, drawing: &Drawing) -> Drawing {
        let region = self.outline(part);
        let layers = drawing.layers.iter().map(|layer| {
            let marks: Vec<Vec<Mark>> = mapped(&layer.marks, &|mark| within(mark, region));
            crate::drawing::Layer { marks: marks.into_iter().flatten().collect(), ..layer.clone() }
        });
        Drawing { page: drawing.page, layers: layers.filter(|layer| !layer.marks.is_empty()).collect() }
    }
}

fn within(mark: &Mark, region: &Region) -> Vec<Mark> {
    match region.holds_box(mark.bounding_box()) {
        Some(true) => return vec![mark.clone()],
        Some(false) => return Vec::new(),
        None => {}
    }
    match mark {
        Mark::Dot(dot) => dot_within(dot, region).map(Mark::Dot).into_iter().collect(),
        Mark::Stroke(stroke) => stroke_within(stroke, region).into_iter().map(Mark::Stroke).collect(),
        Mark::Area(area) => area_within(area, region).map(Mark::Area).into_iter().collect(),
    }
}

/// Share of a dot's area outside the part up to which it stays whole, and the share inside up to which it is dropped: a crumb is
/// no dot.
const WHOLE: f64 = 0.04;
const CRUMB: f64 = 0.12;

fn dot_within(dot: &Dot, region: &Region) -> Option<Dot> {
    let inside = clipped(&dot.path(), region);
    let share = inside.area().abs() / dot.path().area().abs().max(f64::MIN_POSITIVE);
    if share >= 1.0 - WHOLE {
        return Some(dot.clone());
    }
    let area = inside.area().abs();
    let left = inside.bounding_box();
    (share > CRUMB).then(|| Dot {
        centre: Point::new(dot.centre.x.clamp(left.x0, left.x1), dot.centre.y.clamp(left.y0, left.y1)),
        radius: (area / std::f64::consts::PI).sqrt(),
        outline: Some(Box::new(inside)),
        colour: dot.colour,
    })
}

/// Tolerance of cut outlines in millimetres.
const TOLERANCE: f64 = 0.004;

/// The part of an outline in a region, of which only what is near is looked at.
fn clipped(outline: &BezPath, region: &Region) -> BezPath {
    let whole = Region::new(outline, TOLERANCE);
    region.in_window(whole.bounds().inflate(TOLERANCE, TOLERANCE)).clip_area(&whole)
}

fn area_within(area: &Area, region: &Region) -> Option<Area> {
    let outline = clipped(&area.outline, region);
    (outline.area().abs() > 0.0).then_some(Area { outline, colour: area.colour })
}

/// A stroke whose ends are at most this share of its greatest width tapers.
const TAPERED: f64 = 0.5;
/// Pieces of strokes shorter than this share of their width are dropped.
const SPECK: f64 = 0.8;

fn stroke_within(stroke: &Stroke, region: &Region) -> Vec<Stroke> {
    let half = 0.5 * stroke.widest();
    let tapers = match stroke.width() {
        Width::Constant(_) => false,
        Width::Along(widths) => [widths.first(), widths.last()].into_iter().flatten().any(|w| *w <= TAPERED * 2.0 * half),
    };
    let pieces = stroke.pieces_within(region);
    pieces
        .into_iter()
        .filter_map(|(piece, is_cut)| {
            let piece = if tapers {
                tapered(piece, is_cut, half)
            } else {
                piece.shortened(is_cut.map(|cut| if cut { half } else { 0.0 }))?
            };
            (is_cut == [false; 2] || piece.length() > SPECK * half).then_some(piece)
        })
        .collect()
}

/// A cut end of a stroke that tapers does so over this many of its widths, to this share.
const TAPER: f64 = 3.0;
const TIP: f64 = 0.25;

/// A cut piece whose cut ends taper like the stroke's own.
fn tapered(piece: Stroke, is_cut: [bool; 2], half: f64) -> Stroke {
    let along: Vec<f64> = lengths_along(&piece.nodes().collect::<Vec<Point>>());
    let total = along.last().copied().unwrap_or(0.0);
    let reach = TAPER * 2.0 * half;
    let share = |cut: bool, distance: f64| if cut { TIP + (1.0 - TIP) * (distance / reach).min(1.0) } else { 1.0 };
    let mut shares = along.iter().map(|at| [share(is_cut[0], *at), share(is_cut[1], total - at)]);
    piece.map_widths(|width| shares.next().map_or(width, |[start, end]| width * start * end))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::{Layer, Page};
    use crate::geometry::Rect;
    use crate::raster::Raster;
    use crate::scene::Border;
    use crate::source::Placement;

    /// A page of 20 x 10 mm, its right half a region.
    fn halves(border: Border) -> Parts {
        let placement = Placement::new(Rect::new(0.0, 0.0, 20.0, 10.0), 8.0);
        let mask = Raster::from_fn(placement.columns, placement.rows, |x, _| f32::from(x >= placement.columns / 2));
        Parts::new(placement, &[(mask, border)])
    }

    fn one(mark: Mark) -> Drawing {
        let mut layer = Layer::new("marks", 1);
        layer.marks.push(mark);
        Drawing { page: Page::new(20.0, 10.0), layers: vec![layer] }
    }

    #[test]
    fn each_part_keeps_what_lies_in_it() {
        let parts = halves(Border::Butt);
        assert_eq!(parts.count(), 2);
        let dot = one(Mark::Dot(Dot::circle(Point::new(10.1, 5.0), 1.0)));
        let areas: Vec<f64> = (0..2).map(|i| parts.confined(i, &dot).marks().map(Mark::area).sum()).collect();
        assert!((areas[0] + areas[1] - std::f64::consts::PI).abs() < 0.02 && areas[1] > areas[0], "{areas:?}");
        let line = Stroke::even(kurbo::BezPath::from_svg("M2,5 L18,5").unwrap(), 0.4);
        let cut: Vec<Drawing> = (0..2).map(|i| parts.confined(i, &one(Mark::Stroke(line.clone())))).collect();
        let ends: Vec<f64> = cut.iter().map(|d| d.bounding_box().unwrap().x1).collect();
        assert!((ends[0] - 10.0).abs() < 0.05 && ends[1] > 18.0, "{ends:?}");
    }

    #[test]
    fn a_gap_lies_on_the_region_s_side() {
        let parts = halves(Border::Gap(1.0));
        let inside = |i: usize, x: f64| parts.outline(i).contains(Point::new(x, 5.0));
        assert!(inside(0, 9.8) && !inside(0, 10.2) && !inside(1, 10.8) && inside(1, 11.2));
    }

    #[test]
    fn shares_of_a_fade_are_the_whole() {
        let parts = halves(Border::Fade(4.0));
        let placement = Placement::new(Rect::new(0.0, 0.0, 20.0, 10.0), 5.0);
        let [rest, region] = [0, 1].map(|i| parts.drawn_share(i, &placement));
        assert!(rest.pixels().iter().zip(region.pixels()).all(|(a, b)| (a + b - 1.0).abs() < 1e-3));
        let middle = region.get(placement.columns / 2, 5);
        assert!((middle - 0.5).abs() < 0.1 && region.get(0, 5) < 0.01, "{middle}");
    }

    #[test]
    fn a_tapering_stroke_tapers_where_it_is_cut() {
        let parts = halves(Border::Butt);
        let curve = kurbo::BezPath::from_svg("M2,5 L6,5 L10,5 L14,5 L18,5").unwrap();
        let hair = Stroke::swelling(curve, vec![0.05, 0.4, 0.4, 0.4, 0.05]).unwrap();
        let cut = parts.confined(0, &one(Mark::Stroke(hair)));
        let Some(Mark::Stroke(stroke)) = cut.marks().next() else { panic!("a stroke") };
        let Width::Along(widths) = stroke.width() else { panic!("it swells") };
        assert!(widths[widths.len() - 1] < 0.15, "{widths:?}");
    }
}
