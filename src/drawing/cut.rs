//! Pieces of strokes, with the widths, pressures and times that they had there.

use super::Stroke;
use super::mark::contains;
use super::stroke::interpolate;
use crate::geometry::{BezPath, Point, Rect, Region, clip_polyline, lengths_along, segment_length};
use kurbo::Shape;

impl Stroke {
    /// The pieces whose centre line is inside, with their original widths.
    pub(super) fn clipped(&self, rect: Rect) -> Vec<Self> {
        if contains(rect, self.curve().bounding_box()) {
            return vec![self.clone()];
        }
        let (points, position) = self.flattened();
        clip_polyline(&points, rect).into_iter().filter_map(|piece| self.piece(&piece, &position)).collect()
    }

    /// The pieces whose centre line is inside a region, with their original widths, and for both ends whether they were cut.
    pub fn pieces_within(&self, region: &Region) -> Vec<(Self, [bool; 2])> {
        let (points, position) = self.flattened();
        let last = points.len().saturating_sub(1) as f64;
        let pieces = region.inside_of_line(&points).into_iter().filter(|piece| piece.len() > 1 || points.len() == 1);
        pieces
            .filter_map(|piece| {
                let is_whole = [piece[0].1 <= 0.0, piece[piece.len() - 1].1 >= last];
                let stroke = if is_whole == [true; 2] { self.clone() } else { self.piece(&piece, &position)? };
                Some((stroke, is_whole.map(|is_whole| !is_whole)))
            })
            .collect()
    }

    /// The stroke without a length at its start and at its end; none if nothing is left.
    pub fn shortened(&self, by: [f64; 2]) -> Option<Self> {
        if by == [0.0; 2] {
            return Some(self.clone());
        }
        let (points, position) = self.flattened();
        let along: Vec<f64> = lengths_along(&points);
        let (from, to) = (by[0], along.last()? - by[1]);
        if to <= from {
            return None;
        }
        let at = |length: f64| {
            let i = along.partition_point(|l| *l < length).clamp(1, along.len() - 1);
            let t = ((length - along[i - 1]) / (along[i] - along[i - 1]).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            (points[i - 1].lerp(points[i], t), (i - 1) as f64 + t)
        };
        let inner = (0..points.len()).filter(|i| along[*i] > from && along[*i] < to).map(|i| (points[i], i as f64));
        let piece: Vec<(Point, f64)> = std::iter::once(at(from)).chain(inner).chain(std::iter::once(at(to))).collect();
        self.piece(&piece, &position)
    }

    /// A piece of the flattened centre line: its points with their indices plus fractions.
    fn piece(&self, piece: &[(Point, f64)], position: &[f64]) -> Option<Self> {
        let mut curve = BezPath::new();
        curve.move_to(piece.first()?.0);
        piece[1..].iter().for_each(|(p, _)| curve.line_to(*p));
        let places: Vec<f64> = piece.iter().map(|&(_, at)| interpolate(position, at)).collect();
        self.along(curve, &places)
    }

    /// The centre line as points, and for each its position along the curve's nodes (segment index plus fraction).
    fn flattened(&self) -> (Vec<Point>, Vec<f64>) {
        use kurbo::ParamCurve;
        let (mut points, mut position) = (Vec::new(), Vec::new());
        for (i, segment) in self.curve().segments().enumerate() {
            let steps = if matches!(segment, kurbo::PathSeg::Line(_)) {
                1
            } else {
                (segment_length(segment, 1e-3) / 0.05).ceil().clamp(4.0, 256.0) as usize
            };
            if points.is_empty() {
                points.push(segment.start());
                position.push(0.0);
            }
            for step in 1..=steps {
                let t = step as f64 / steps as f64;
                points.push(segment.eval(t));
                position.push(i as f64 + t);
            }
        }
        (points, position)
    }
}
