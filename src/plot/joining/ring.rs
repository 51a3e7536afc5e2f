//! Loops that may be entered anywhere, and their rotation to another start.

use kurbo::Point;

use crate::plot::Toolpath;

/// True if a path is a loop that may be entered anywhere: closed, of finite extent, with equal heights at both ends.
pub(in crate::plot) fn is_free(path: &Toolpath) -> bool {
    let is_level = path.heights.as_ref().is_none_or(|heights| heights.first() == heights.last());
    path.is_closed() && is_level && path.points.iter().any(|p| *p != path.points[0]) && path.length().is_finite()
}

/// The same loop drawn from a point on one of its edges, given by its first vertex. The point becomes a vertex if it is not one.
pub(in crate::plot) fn rotated(mut path: Toolpath, edge: usize, at: Point) -> Toolpath {
    let around = path.points.len() - 1;
    let (from, to) = (path.points[edge], path.points[edge + 1]);
    // Both ends of the edge may equal the point.
    let first = if at == from { edge } else { edge + 1 };
    let is_vertex = at == from || at == to;
    let turn = |len: usize| (0..len).map(move |i| (first + i) % around);
    let height = path.heights.as_ref().map(|heights| {
        let along = if from == to { 0.0 } else { from.distance(at) / from.distance(to) };
        if is_vertex { heights[first] } else { heights[edge] + (heights[edge + 1] - heights[edge]) * along }
    });
    let mut points = Vec::with_capacity(path.points.len() + 2);
    let mut heights = path.heights.as_ref().map(|_| Vec::with_capacity(path.points.len() + 2));
    if !is_vertex {
        points.push(at);
    }
    points.extend(turn(around).map(|i| path.points[i]));
    points.push(at);
    if let (Some(all), Some(old), Some(height)) = (&mut heights, &path.heights, height) {
        all.extend((!is_vertex).then_some(height));
        all.extend(turn(around).map(|i| old[i]));
        all.push(height);
    }
    path.points = points;
    path.heights = heights;
    path
}
