//! Strokes: lines with a width.

use super::Colour;
use crate::geometry::{Affine, BezPath, Ends, Point, Rect, curve_length, sample_swelling, swelling_outline};
use kurbo::{ParamCurve, PathEl, Shape};
use std::borrow::Cow;

/// Tolerance of a swelling stroke's outline, in millimetres. Half the written step (0.001 mm) would not be visible; this is a
/// hundredth of a hair.
const OUTLINE_TOLERANCE: f64 = 0.002;

/// A line with a width, along one open or closed curve.
///
/// The curve's nodes are its start and the end of each segment, of a closed curve the start again. There are as many widths,
/// pressures and times as nodes:
///
/// ```
/// use drypoint::drawing::Stroke;
/// use drypoint::geometry::BezPath;
///
/// let mut curve = BezPath::new();
/// curve.move_to((0.0, 0.0));
/// curve.line_to((5.0, 0.0));
/// curve.line_to((9.0, 3.0));
/// assert!(Stroke::swelling(curve.clone(), vec![0.1, 0.4]).is_none(), "it has three nodes");
/// let spindle = Stroke::swelling(curve, vec![0.1, 0.4, 0.1]).expect("a width for each node");
/// assert_eq!(spindle.widest(), 0.4);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    curve: BezPath,
    width: Width,
    /// The shape of its two ends.
    pub ends: Ends,
    pressure: Option<Vec<f64>>,
    times: Option<Vec<f64>>,
    /// Its own colour, instead of the layer's.
    pub colour: Option<Colour>,
    /// The group. Its strokes are drawn consecutively, in their given order and direction.
    pub group: Option<u32>,
}

/// The full width of a stroke in millimetres.
#[derive(Clone, Debug, PartialEq)]
pub enum Width {
    /// The same everywhere.
    Constant(f64),
    /// One width per node of the curve (its start, then the end of each segment), changing smoothly between them.
    Along(Vec<f64>),
}

impl Stroke {
    /// A stroke of one width in millimetres, in the layer's ink with round ends. The curve is one subpath of lines and cubics;
    /// closed if it ends with a close.
    pub const fn even(curve: BezPath, width: f64) -> Self {
        let width = Width::Constant(width);
        Self { curve, width, ends: Ends::Round, pressure: None, times: None, colour: None, group: None }
    }

    /// A stroke with a width in millimetres at each node, in the layer's ink with round ends. None unless there are as many widths
    /// as nodes.
    #[must_use]
    pub fn swelling(curve: BezPath, widths: Vec<f64>) -> Option<Self> {
        Self::even(curve, 0.0).with_width(Width::Along(widths))
    }

    /// The stroke with another width. None unless a width that changes has a value for each node.
    #[must_use]
    pub fn with_width(mut self, width: Width) -> Option<Self> {
        self.width = match width {
            Width::Constant(width) => Width::Constant(width),
            Width::Along(widths) => Width::Along(for_nodes(&self.curve, widths)?),
        };
        Some(self)
    }

    /// The stroke with the pen's pressure at each node, 0 to 1. None unless there are as many pressures as nodes.
    #[must_use]
    pub fn with_pressure(mut self, pressure: Vec<f64>) -> Option<Self> {
        self.pressure = Some(for_nodes(&self.curve, pressure)?);
        Some(self)
    }

    /// The stroke with the time at each node, in seconds from the drawing's beginning. None unless there are as many times as
    /// nodes.
    #[must_use]
    pub fn with_times(mut self, times: Vec<f64>) -> Option<Self> {
        self.times = Some(for_nodes(&self.curve, times)?);
        Some(self)
    }

    /// The stroke with other ends.
    #[must_use]
    pub const fn with_ends(mut self, ends: Ends) -> Self {
        self.ends = ends;
        self
    }

    /// The stroke in a colour of its own, or in the layer's.
    #[must_use]
    pub const fn with_colour(mut self, colour: Option<Colour>) -> Self {
        self.colour = colour;
        self
    }

    /// The stroke in a group, or in none.
    #[must_use]
    pub const fn in_group(mut self, group: Option<u32>) -> Self {
        self.group = group;
        self
    }

    /// The stroke with the ends, the colour and the group of another.
    #[must_use]
    pub const fn like(self, other: &Self) -> Self {
        self.with_ends(other.ends).with_colour(other.colour).in_group(other.group)
    }

    /// The stroke with each of its widths changed.
    #[must_use]
    pub fn map_widths(mut self, mut change: impl FnMut(f64) -> f64) -> Self {
        match &mut self.width {
            Width::Constant(width) => *width = change(*width),
            Width::Along(widths) => widths.iter_mut().for_each(|width| *width = change(*width)),
        }
        self
    }

    /// The stroke moved, rotated or uniformly scaled; widths scale by the root of the determinant.
    #[must_use]
    pub fn transformed(&self, transform: Affine) -> Self {
        let scale = transform.determinant().abs().sqrt();
        let mut moved = self.clone().map_widths(|width| width * scale);
        moved.curve.apply_affine(transform);
        // Rounding may bring the two ends of a closing line together.
        let nodes = node_count(&moved.curve);
        let widths = if let Width::Along(widths) = &mut moved.width { Some(widths) } else { None };
        for values in [widths, moved.pressure.as_mut(), moved.times.as_mut()].into_iter().flatten() {
            values.resize(nodes, values.last().copied().unwrap_or_default());
        }
        moved
    }

    /// Along another curve, whose nodes lie at `places` of this one (a node's index plus the fraction of the way to the next),
    /// with the width, pressure and time there. None unless there are as many places as nodes.
    pub(super) fn along(&self, curve: BezPath, places: &[f64]) -> Option<Self> {
        let there = |values: &[f64]| places.iter().map(|at| interpolate(values, *at)).collect();
        let mut piece = match &self.width {
            Width::Constant(width) => Self::even(curve, *width),
            Width::Along(widths) => Self::swelling(curve, there(widths))?,
        };
        if let Some(pressure) = &self.pressure {
            piece = piece.with_pressure(there(pressure))?;
        }
        if let Some(times) = &self.times {
            piece = piece.with_times(there(times))?;
        }
        Some(piece.like(self))
    }

    /// The centre line: one subpath of lines and cubics; closed if it ends with a close.
    pub const fn curve(&self) -> &BezPath {
        &self.curve
    }

    /// The full width; if it changes, a value for each node.
    pub const fn width(&self) -> &Width {
        &self.width
    }

    /// The pen's pressure at each node, 0 to 1, if the style gives it.
    pub fn pressure(&self) -> Option<&[f64]> {
        self.pressure.as_deref()
    }

    /// The time at each node, in seconds from the drawing's beginning, if the style gives it.
    pub fn times(&self) -> Option<&[f64]> {
        self.times.as_deref()
    }

    /// The curve's nodes: its start, then the end of each segment.
    pub fn nodes(&self) -> impl Iterator<Item = Point> {
        let start = self.curve.elements().first().and_then(PathEl::end_point);
        start.into_iter().chain(self.curve.segments().map(|segment| segment.end()))
    }

    /// A width for each node, of a constant width too.
    pub(super) fn widths(&self) -> Cow<'_, [f64]> {
        match &self.width {
            Width::Constant(width) => Cow::Owned(vec![*width; node_count(&self.curve)]),
            Width::Along(widths) => Cow::Borrowed(widths),
        }
    }

    /// True if the curve is closed.
    pub fn is_closed(&self) -> bool {
        matches!(self.curve.elements().last(), Some(PathEl::ClosePath))
    }

    /// Length of the centre line in millimetres.
    pub fn length(&self) -> f64 {
        curve_length(&self.curve)
    }

    /// The outline of a stroke with varying width; none for a constant width, which the renderer strokes itself.
    pub fn outline(&self) -> Option<BezPath> {
        match &self.width {
            Width::Constant(_) => None,
            Width::Along(widths) => Some(swelling_outline(&self.curve, widths, self.ends, OUTLINE_TOLERANCE)),
        }
    }

    /// The outline of its ink for any width, accurate to `tolerance` millimetres.
    pub fn ink_outline(&self, tolerance: f64) -> BezPath {
        match &self.width {
            Width::Along(widths) => swelling_outline(&self.curve, widths, self.ends, tolerance),
            Width::Constant(width) => {
                let cap = if self.ends == Ends::Flat { kurbo::Cap::Butt } else { kurbo::Cap::Round };
                let style = kurbo::Stroke::new(*width).with_caps(cap).with_join(kurbo::Join::Round);
                kurbo::stroke(self.curve.iter(), &style, &kurbo::StrokeOpts::default(), tolerance)
            }
        }
    }

    /// Length times width plus the half discs of round ends; for a swelling stroke, the area of its outline.
    pub(super) fn area(&self) -> f64 {
        match &self.width {
            Width::Constant(width) => {
                let ends =
                    if self.is_closed() || self.ends == Ends::Flat { 0.0 } else { std::f64::consts::FRAC_PI_4 * width * width };
                self.length() * width + ends
            }
            Width::Along(_) => self.outline().map_or(0.0, |outline| outline.area().abs()),
        }
    }

    /// The greatest width.
    pub fn widest(&self) -> f64 {
        match &self.width {
            Width::Constant(width) => *width,
            Width::Along(widths) => widths.iter().copied().fold(0.0, f64::max),
        }
    }

    /// Points along the centre line at most `spacing` apart, with the full width at each.
    pub fn sampled(&self, spacing: f64) -> (Vec<Point>, Vec<f64>) {
        sample_swelling(&self.curve, &self.widths(), spacing).into_iter().unzip()
    }

    pub(super) fn bounding_box(&self) -> Rect {
        let half = 0.5 * self.widest();
        let places = match (self.curve.segments().next(), self.curve.elements().first().and_then(PathEl::end_point)) {
            // A bare point, which has no segment.
            (None, Some(p)) => Rect::from_points(p, p),
            _ => self.curve.bounding_box(),
        };
        places.inflate(half, half)
    }
}

/// Number of a curve's nodes: its start, then the end of each segment.
fn node_count(curve: &BezPath) -> usize {
    curve.segments().count() + 1
}

/// The values if there is one for each node.
fn for_nodes(curve: &BezPath, values: Vec<f64>) -> Option<Vec<f64>> {
    (values.len() == node_count(curve)).then_some(values)
}

/// The interpolated value at `at`, a node's index plus the fraction of the way to the next.
pub(super) fn interpolate(values: &[f64], at: f64) -> f64 {
    let last = values.len() - 1;
    let i = (at.floor().max(0.0) as usize).min(last);
    let t = at - i as f64;
    values[i] * (1.0 - t) + values[(i + 1).min(last)] * t
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Mark;

    #[test]
    fn a_stroke_has_as_many_widths_as_nodes() {
        let nodes = |path: &str| Stroke::even(BezPath::from_svg(path).unwrap(), 0.3).nodes().count();
        for (path, count) in [("M1,1", 1), ("M0,0 L5,0 L5,5", 3), ("M0,0 L5,0 L5,5 Z", 4), ("M0,0 L5,0 L5,5 L0,0 Z", 4)] {
            let curve = BezPath::from_svg(path).unwrap();
            assert_eq!(nodes(path), count, "{path}");
            for wrong in [0, count - 1, count + 1] {
                let few = vec![0.2; wrong];
                assert_eq!(Stroke::swelling(curve.clone(), few.clone()), None, "{path}");
                assert_eq!(Stroke::even(curve.clone(), 0.3).with_pressure(few.clone()), None, "{path}");
                assert_eq!(Stroke::even(curve.clone(), 0.3).with_times(few), None, "{path}");
            }
            let stroke =
                Stroke::swelling(curve, vec![0.2; count]).and_then(|stroke| stroke.with_times(vec![1.0; count])).unwrap();
            assert_eq!(stroke.sampled(0.5).0.is_empty(), count == 1);
        }
    }

    #[test]
    fn a_gap_that_rounding_closes_takes_its_width_with_it() {
        let curve = BezPath::from_svg("M1,0 L5,0 L5,5 L1.0000000000000002,0 Z").unwrap();
        let stroke = Stroke::swelling(curve, vec![0.1, 0.2, 0.3, 0.4, 0.1]).unwrap();
        let far = stroke.transformed(Affine::translate((1e3, 0.0)));
        assert_eq!(far.width(), &Width::Along(vec![0.1, 0.2, 0.3, 0.4]));
        assert_eq!(far.nodes().count(), 4);
    }

    #[test]
    fn a_constant_stroke_s_area_counts_its_round_ends() {
        let stroke = Mark::Stroke(Stroke::even(BezPath::from_svg("M0,0 L10,0").unwrap(), 1.0));
        assert!((stroke.area() - (10.0 + std::f64::consts::FRAC_PI_4)).abs() < 1e-9);
        assert_eq!(stroke.bounding_box(), Rect::new(-0.5, -0.5, 10.5, 0.5));
    }

    #[test]
    fn clipping_a_stroke_keeps_its_width_there() {
        let stroke = Stroke::swelling(BezPath::from_svg("M0,0 L10,0").unwrap(), vec![0.0, 1.0]).unwrap();
        let pieces = stroke.clipped(Rect::new(5.0, -1.0, 20.0, 1.0));
        assert_eq!(pieces.len(), 1);
        let Width::Along(widths) = pieces[0].width() else { panic!("it swells") };
        assert!((widths[0] - 0.5).abs() < 1e-9 && (widths[1] - 1.0).abs() < 1e-9);
    }
}
