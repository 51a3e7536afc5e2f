//! Hatching along the grid's lines, with widths that make the tone (Son et al. 2011, section 6.2; errata).

use super::darks::Darks;
use super::mixing::Mixing;
use super::structure::StructureGrid;
use super::{Drawer, LineEnds};
use crate::drawing::{Layer, Mark, Stroke};
use crate::field::{Curve, over_the_border};
use crate::geometry::{Ends, Point, Rect, Ring, catmull_rom, resample};
use crate::parallel::mapped;
use crate::raster::Raster;

/// Distance of a stroke's nodes in pitches: half a cell, so that its width can follow the tone from dot to dot.
const NODE_SPACING: f64 = 0.5;
/// Nodes over which a line becomes thinner before its ends, and by which it goes on beyond them: one and a half pitches, over which a gap
/// between two lines closes.
const POINT_NODES: usize = 3;
/// Width in pitches below which no line is drawn.
const LEAST_WIDTH: f64 = 0.002;
/// Width in pitches from which a line's end does not look like a hair.
const WHISKER: f64 = 0.25;

pub(super) fn layer(drawer: &Drawer<'_>, grid: &StructureGrid, darks: &Darks, ink: &Raster<f32>, ends: LineEnds) -> Layer {
    drawer.observer.begin("hatching");
    let mixing = Mixing::new(drawer);
    let mut layer = Layer::new("hatching", 1);
    for family in (0..2).filter(|&family| mixing.hatches(family)) {
        let strokes: Vec<Vec<Mark>> = mapped(&grid.lines[family], &|line| strokes(drawer, grid, darks, (line, ends), ink));
        layer.marks.extend(strokes.into_iter().flatten());
    }
    layer
}

/// The parts of one grid line where there is ink to draw.
fn strokes(
    drawer: &Drawer<'_>,
    grid: &StructureGrid,
    darks: &Darks,
    (line, ends): (&Curve, LineEnds),
    ink: &Raster<f32>,
) -> Vec<Mark> {
    let mixing = Mixing::new(drawer);
    let mut points = line.points.clone();
    if line.closed {
        points.push(points[0]);
    }
    let nodes = resample(&points, NODE_SPACING * drawer.pitch());
    // Blurred ink extends beyond the subject and would draw a hairline around it.
    let is_bare = |p: Point| darks.cover(p) || drawer.portrait.subject.sample(p.x, p.y) < 0.5;
    let wide = |p: Point| if is_bare(p) { 0.0 } else { width(grid, &mixing, p, ink) };
    let least = LEAST_WIDTH * drawer.pitch();
    let (nodes, shares) = match ends {
        LineEnds::Pointed if !line.closed => pointed(nodes, &|last| over(drawer, last, &|p| wide(p) > least)),
        _ => whole(nodes),
    };
    let widths: Vec<f64> = nodes.iter().zip(shares).map(|(p, share)| share * wide(*p)).collect();
    let is_whole = line.closed && nodes.len() > 3 && widths.iter().all(|&w| w > least);
    if is_whole {
        return stroke(drawer, &nodes[..nodes.len() - 1], widths, Ring::Closed).into_iter().collect();
    }
    let mut out = Vec::new();
    let mut start = 0;
    for run in widths.chunk_by(|a, b| (*a > least) == (*b > least)) {
        let range = start..start + run.len();
        start += run.len();
        if run[0] > least {
            let kept = without_whiskers(&widths, range, WHISKER * drawer.pitch());
            if kept.len() > 1 {
                out.extend(stroke(drawer, &nodes[kept.clone()], widths[kept].to_vec(), Ring::Open));
            }
        }
    }
    out
}

/// A line of its full width from end to end.
fn whole(nodes: Vec<Point>) -> (Vec<Point>, Vec<f64>) {
    let shares = vec![1.0; nodes.len()];
    (nodes, shares)
}

/// How far a line goes on over the picture's border, in nodes; `inner` is a place before its last two. One that has no ink there is a crumb.
fn over(drawer: &Drawer<'_>, [inner, before, end]: [Point; 3], has_ink: &dyn Fn(Point) -> bool) -> Option<usize> {
    /// Distance from the border within which a line runs over it, in pitches, and half of a line's most width.
    const REACH: f64 = 1.0;
    const HALF_WIDTH: f64 = 0.5;
    let pitch = drawer.pitch();
    if !has_ink(inner) {
        return None;
    }
    let length = over_the_border([before, end], picture(drawer), (REACH * pitch, HALF_WIDTH * pitch), has_ink)?;
    Some((length / (NODE_SPACING * pitch)).ceil() as usize)
}

/// The picture in working pixels.
fn picture(drawer: &Drawer<'_>) -> Rect {
    let size = &drawer.portrait.subject;
    Rect::new(0.0, 0.0, size.width() as f64, size.height() as f64)
}

/// An open line carried on beyond its ends, where its neighbours close up, and the share of its width that each node has: a line with
/// blunt ends leaves white nicks in dark cloth. It loses as much ink before its end as it gains after it. Where it runs `over` the
/// picture's border it is carried on with its whole width.
fn pointed(nodes: Vec<Point>, over: &dyn Fn([Point; 3]) -> Option<usize>) -> (Vec<Point>, Vec<f64>) {
    let count = nodes.len();
    if count <= 2 * POINT_NODES {
        return whole(nodes);
    }
    let ends = [[2 * POINT_NODES, 1, 0], [1 + 2 * POINT_NODES, 2, 1].map(|back| count - back)].map(|last| last.map(|i| nodes[i]));
    let overs = ends.map(over);
    let added = overs.map(|over| over.unwrap_or(POINT_NODES));
    let on = |[_, before, end]: [Point; 3], i: usize| end + (end - before) * i as f64;
    let ahead = (1..=added[0]).rev().map(|i| on(ends[0], i));
    let after = (1..=added[1]).map(|i| on(ends[1], i));
    let longer: Vec<Point> = ahead.chain(nodes.iter().copied()).chain(after).collect();
    let from_tips = |i: usize| [i + 1, longer.len() - i];
    let share = |i: usize| {
        let tips = from_tips(i).into_iter().zip(overs).filter(|(_, over)| over.is_none());
        tips.map(|(from, _)| from as f64 / (2 * POINT_NODES + 2) as f64).fold(1.0, f64::min)
    };
    let shares = (0..longer.len()).map(share).collect();
    (longer, shares)
}

/// A run of nodes without ends where the width falls by more than half from one node to the next: such ends stand out like hairs at the
/// border of a dark shape.
fn without_whiskers(widths: &[f64], mut run: std::ops::Range<usize>, thin: f64) -> std::ops::Range<usize> {
    let is_whisker = |end: f64, inner: f64| end < thin && end < 0.5 * inner;
    while run.len() > 1 && is_whisker(widths[run.start], widths[run.start + 1]) {
        run.start += 1;
    }
    while run.len() > 1 && is_whisker(widths[run.end - 1], widths[run.end - 2]) {
        run.end -= 1;
    }
    run
}

fn width(grid: &StructureGrid, mixing: &Mixing, p: Point, ink: &Raster<f32>) -> f64 {
    let tone = 1.0 - f64::from(ink.sample(p.x, p.y));
    let share = mixing.line_share(tone);
    if share <= 0.0 || tone >= 1.0 {
        return 0.0;
    }
    share * mixing.full_width(tone, [0, 1].map(|family| grid.density_at(family, p)))
}

fn stroke(drawer: &Drawer<'_>, nodes: &[Point], widths: Vec<f64>, ring: Ring) -> Option<Mark> {
    let placement = &drawer.portrait.placement;
    let page: Vec<Point> = nodes.iter().map(|p| placement.to_page(*p)).collect();
    let scale = placement.mm_per_pixel();
    let widths = widths.into_iter().map(|w| w * scale).collect();
    // What runs over the border is cut along it.
    let is_over = [nodes.first(), nodes.last()].into_iter().flatten().any(|end| !picture(drawer).contains(*end));
    let ends = if is_over { Ends::Flat } else { Ends::Round };
    Stroke::swelling(catmull_rom(&page, ring), widths).map(|stroke| Mark::Stroke(stroke.with_ends(ends)))
}
