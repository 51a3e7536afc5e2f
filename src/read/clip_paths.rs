//! Clip paths, applied as geometry.

use super::budget::{Budget, POINT, TooMuchWork};
use super::curves::{affine, bez_path, with_closed_subpaths};
use crate::geometry::{
    Affine, BezPath, Point, Rect, Region, Winding, crossings, flatten, flattened_points, polygons_within, straightened_outside,
    untangled_polygons,
};

/// Flattening tolerance of paths that are clipped or dashed, in millimetres.
pub(super) const CLIP_TOLERANCE: f64 = 0.005;
/// Largest absolute coordinate that is drawn, in millimetres. Clip paths are cut to it too.
pub(super) const FARTHEST: f64 = 100_000.0;
const FRAME: Rect = Rect::new(-FARTHEST, -FARTHEST, FARTHEST, FARTHEST);

/// Distance within which a line counts as on the border of its clip path, in millimetres: both were flattened, and come in single
/// precision.
const ON_THE_BORDER: f64 = 2.0 * CLIP_TOLERANCE;
/// Relative rounding error of a single-precision coordinate, with a margin for its transforms.
const ROUNDING: f64 = 1e-6;

/// A clip path on the page.
#[derive(Clone)]
pub(super) struct Clip {
    region: Region,
    /// Maximum distance outside at which a line still counts as on the border, in millimetres.
    slack: f64,
}

impl Clip {
    fn new(region: Region) -> Self {
        let bounds = region.bounds();
        let farthest = [bounds.x0, bounds.y0, bounds.x1, bounds.y1].iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        Self { region, slack: ON_THE_BORDER + ROUNDING * farthest }
    }
}

/// Reason that a clip path gives no region.
pub(super) enum NoClip {
    /// Its coordinates are not finite.
    Endless,
    /// The work limit is reached.
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

/// Converts an even-odd outline to one with the same inside by the nonzero rule.
pub(super) fn untangled_fill(curve: &BezPath, budget: &mut Budget) -> Result<BezPath, TooMuchWork> {
    budget.spend(POINT * flattened_points(curve, CLIP_TOLERANCE), "outlines")?;
    untangled(&flatten(curve, CLIP_TOLERANCE).into_iter().map(|(points, _)| points).collect::<Vec<_>>(), Winding::EvenOdd, budget)
}

fn untangled(polygons: &[Vec<Point>], winding: Winding, budget: &mut Budget) -> Result<BezPath, TooMuchWork> {
    budget.overlay(polygons.iter().map(Vec::len).sum(), |most| crossings(polygons, most))?;
    Ok(untangled_polygons(polygons, winding))
}

/// The union of a clip path's shapes on the page, up to [`FARTHEST`].
pub(super) fn clip_region(clip: &usvg::ClipPath, user: Affine, budget: &mut Budget) -> Result<Clip, NoClip> {
    let own = user * affine(clip.transform());
    let mut shapes = Vec::new();
    gather(clip.root(), own, &mut shapes, budget)?;
    Ok(Clip::new(Region::new(&shapes.into_iter().flatten().collect(), CLIP_TOLERANCE)))
}

/// Collects the outlines of a clip path's shapes, each cut to its own clip paths, all in the same direction.
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
    let straightened_outside = straightened_outside(outline, FRAME).ok_or(NoClip::Endless)?;
    budget.spend(POINT * flattened_points(&straightened_outside, CLIP_TOLERANCE), "clip paths")?;
    Ok(polygons_within(&straightened_outside, FRAME, CLIP_TOLERANCE))
}

/// A stroke's curve within a clip path.
pub(super) fn clip_curve(curve: &BezPath, clip: &Clip, budget: &mut Budget) -> Result<BezPath, TooMuchWork> {
    budget.cuts(flattened_points(curve, CLIP_TOLERANCE), clip.region.edge_count())?;
    let mut clipped = BezPath::new();
    for (mut points, closed) in flatten(curve, CLIP_TOLERANCE) {
        if closed {
            points.push(points[0]);
        }
        // Each piece between two cuts is tested for being inside.
        budget.cuts(clip.region.cut_count(&points) as f64, clip.region.edge_count())?;
        for piece in clip.region.clip_line(&points, clip.slack) {
            clipped.move_to(piece[0]);
            piece[1..].iter().for_each(|p| clipped.line_to(*p));
        }
    }
    Ok(clipped)
}
