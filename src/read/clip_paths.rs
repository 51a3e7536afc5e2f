//! Clip paths, honoured as geometry.

use super::budget::{Budget, POINT, TooMuchWork};
use super::curves::{affine, bez_path, with_closed_subpaths};
use crate::geometry::{
    Affine, BezPath, Point, Rect, Region, Winding, crossings, flatten, flattened_points, polygons_within, tamed,
    untangled_polygons,
};

/// Flattening where a path must be clipped or dashed, in millimetres.
pub(super) const CLIP_TOLERANCE: f64 = 0.005;
/// Coordinates beyond which nothing is drawn, and what a clip path covers there is of no use, in millimetres.
pub(super) const FARTHEST: f64 = 100_000.0;
const FRAME: Rect = Rect::new(-FARTHEST, -FARTHEST, FARTHEST, FARTHEST);

/// A line this near to the border of its clip path is on it: both were flattened, and came as single precision.
const ON_THE_BORDER: f64 = 2.0 * CLIP_TOLERANCE;
/// Single precision's part of a coordinate, with room for the transforms that it went through.
const ROUNDING: f64 = 1e-6;

/// A clip path on the page.
#[derive(Clone)]
pub(super) struct Clip {
    region: Region,
    /// How far outside a line still lies on its border.
    slack: f64,
}

impl Clip {
    fn new(region: Region) -> Self {
        let bounds = region.bounds();
        let farthest = [bounds.x0, bounds.y0, bounds.x1, bounds.y1].iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        Self { region, slack: ON_THE_BORDER + ROUNDING * farthest }
    }
}

/// Why a clip path gives no region.
pub(super) enum NoClip {
    /// Its coordinates are beyond all numbers.
    Endless,
    /// There is no work left for it.
    Work(TooMuchWork),
}

impl From<TooMuchWork> for NoClip {
    fn from(work: TooMuchWork) -> Self {
        Self::Work(work)
    }
}

/// A filled outline within its clip paths.
pub(super) fn clipped_outline(curve: &BezPath, clips: &[Clip], budget: &mut Budget) -> Result<BezPath, TooMuchWork> {
    let mut outline = with_closed_subpaths(curve);
    for clip in clips {
        budget.spend(POINT * flattened_points(&outline, CLIP_TOLERANCE), "clipped areas")?;
        let area = Region::new(&outline, CLIP_TOLERANCE);
        outline = overlaid(&clip.region, &area, budget)?;
    }
    Ok(outline)
}

fn overlaid(clip: &Region, area: &Region, budget: &mut Budget) -> Result<BezPath, TooMuchWork> {
    budget.overlay(clip.edge_count() + area.edge_count(), |most| clip.crossings_with(area, most))?;
    Ok(clip.clip_area(area))
}

/// An outline whose inside is that of the even-odd rule, by the nonzero rule.
pub(super) fn untangled_fill(curve: &BezPath, budget: &mut Budget) -> Result<BezPath, TooMuchWork> {
    budget.spend(POINT * flattened_points(curve, CLIP_TOLERANCE), "outlines")?;
    untangled(&flatten(curve, CLIP_TOLERANCE).into_iter().map(|(points, _)| points).collect::<Vec<_>>(), Winding::EvenOdd, budget)
}

fn untangled(polygons: &[Vec<Point>], winding: Winding, budget: &mut Budget) -> Result<BezPath, TooMuchWork> {
    budget.overlay(polygons.iter().map(Vec::len).sum(), |most| crossings(polygons, most))?;
    Ok(untangled_polygons(polygons, winding))
}

/// The union of a clip path's shapes on the page, as far as anything is drawn there.
pub(super) fn clip_region(clip: &usvg::ClipPath, user: Affine, budget: &mut Budget) -> Result<Clip, NoClip> {
    let own = user * affine(clip.transform());
    let mut shapes = Vec::new();
    gather(clip.root(), own, &mut shapes, budget)?;
    Ok(Clip::new(Region::new(&shapes.into_iter().flatten().collect(), CLIP_TOLERANCE)))
}

/// The outlines of a clip path's shapes, each within its own clip paths, all running the same way.
fn gather(group: &usvg::Group, own: Affine, shapes: &mut Vec<BezPath>, budget: &mut Budget) -> Result<(), NoClip> {
    let first = shapes.len();
    for node in group.children() {
        match node {
            usvg::Node::Group(group) => gather(group, own, shapes, budget)?,
            usvg::Node::Path(path) if path.is_visible() => {
                let placed = own * affine(path.abs_transform()) * bez_path(path.data());
                let is_even_odd = path.fill().is_some_and(|fill| fill.rule() == usvg::FillRule::EvenOdd);
                let winding = if is_even_odd { Winding::EvenOdd } else { Winding::NonZero };
                shapes.push(untangled(&within_frame(&placed, budget)?, winding, budget)?);
            }
            _ => {}
        }
    }
    let mut clip = group.clip_path();
    while let Some(path) = clip {
        let outer = clip_region(path, own * affine(group.abs_transform()), budget)?;
        for shape in &mut shapes[first..] {
            *shape = overlaid(&outer.region, &Region::new(shape, CLIP_TOLERANCE), budget)?;
        }
        clip = path.clip_path();
    }
    Ok(())
}

/// An outline's polygons up to [`FARTHEST`].
fn within_frame(outline: &BezPath, budget: &mut Budget) -> Result<Vec<Vec<Point>>, NoClip> {
    let tamed = tamed(outline, FRAME).ok_or(NoClip::Endless)?;
    budget.spend(POINT * flattened_points(&tamed, CLIP_TOLERANCE), "clip paths")?;
    Ok(polygons_within(&tamed, FRAME, CLIP_TOLERANCE))
}

/// A stroke's curve within a clip path.
pub(super) fn clip_curve(curve: &BezPath, clip: &Clip, budget: &mut Budget) -> Result<BezPath, TooMuchWork> {
    budget.cuts(flattened_points(curve, CLIP_TOLERANCE), clip.region.edge_count())?;
    let mut clipped = BezPath::new();
    for (mut points, closed) in flatten(curve, CLIP_TOLERANCE) {
        if closed {
            points.push(points[0]);
        }
        for piece in clip.region.clip_line(&points, clip.slack) {
            clipped.move_to(piece[0]);
            piece[1..].iter().for_each(|p| clipped.line_to(*p));
        }
    }
    Ok(clipped)
}
