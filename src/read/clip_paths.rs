//! Clip paths, honoured as geometry.

use super::curves::{affine, bez_path, with_closed_subpaths};
use crate::geometry::{Affine, BezPath, Region, Winding, flatten, untangled};

/// Flattening where a path must be clipped or dashed, in millimetres.
pub(super) const CLIP_TOLERANCE: f64 = 0.005;

/// A filled outline within its clip paths.
pub(super) fn clipped_outline(curve: &BezPath, clips: &[Region]) -> BezPath {
    clips.iter().fold(with_closed_subpaths(curve), |outline, clip| clip.clip_area(&Region::new(&outline, CLIP_TOLERANCE)))
}

/// The union of a clip path's shapes on the page.
pub(super) fn clip_region(clip: &usvg::ClipPath, user: Affine) -> Region {
    let own = user * affine(clip.transform());
    let mut shapes = Vec::new();
    gather(clip.root(), own, &mut shapes);
    Region::new(&shapes.into_iter().flatten().collect(), CLIP_TOLERANCE)
}

/// The outlines of a clip path's shapes, each within its own clip paths, all running the same way.
fn gather(group: &usvg::Group, own: Affine, shapes: &mut Vec<BezPath>) {
    let first = shapes.len();
    for node in group.children() {
        match node {
            usvg::Node::Group(group) => gather(group, own, shapes),
            usvg::Node::Path(path) if path.is_visible() => {
                let placed = own * affine(path.abs_transform()) * bez_path(path.data());
                let is_even_odd = path.fill().is_some_and(|fill| fill.rule() == usvg::FillRule::EvenOdd);
                let winding = if is_even_odd { Winding::EvenOdd } else { Winding::NonZero };
                shapes.push(untangled(&placed, winding, CLIP_TOLERANCE));
            }
            _ => {}
        }
    }
    let mut clip = group.clip_path();
    while let Some(path) = clip {
        let region = clip_region(path, own * affine(group.abs_transform()));
        for shape in &mut shapes[first..] {
            *shape = region.clip_area(&Region::new(shape, CLIP_TOLERANCE));
        }
        clip = path.clip_path();
    }
}

pub(super) fn clip_curve(curve: &BezPath, clip: &Region) -> BezPath {
    let mut clipped = BezPath::new();
    for (mut points, closed) in flatten(curve, CLIP_TOLERANCE) {
        if closed {
            points.push(points[0]);
        }
        for piece in clip.clip_line(&points) {
            clipped.move_to(piece[0]);
            piece[1..].iter().for_each(|p| clipped.line_to(*p));
        }
    }
    clipped
}
