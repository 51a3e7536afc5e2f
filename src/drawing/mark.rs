//! Dots, strokes and areas.

use super::Colour;
use crate::geometry::{
    Affine, BezPath, Ends, Point, Rect, clip_disc, clip_polygon, curve_length, flatten, polygon_area, sample_swelling,
    swelling_outline,
};
use kurbo::{PathEl, Shape};

/// Flattening tolerance for curves that become polygons to be cut, in millimetres: a few of the smallest written steps, so that a
/// cut blob stays a short path.
const CUT_TOLERANCE: f64 = 0.004;
/// Tolerance of a swelling stroke's outline, in millimetres. Half the written step (0.001 mm) would not be visible; this is a
/// hundredth of a hair.
pub(super) const OUTLINE_TOLERANCE: f64 = 0.002;

/// One mark of ink.
#[derive(Clone, Debug, PartialEq)]
pub enum Mark {
    /// A disc or a blob.
    Dot(Dot),
    /// A line with a width.
    Stroke(Stroke),
    /// A filled outline.
    Area(Area),
}

/// A disc, or a blob with an outline of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Dot {
    /// Its centre.
    pub centre: Point,
    /// The disc's radius in millimetres; for a blob, that of the disc of equal area.
    pub radius: f64,
    /// The outline, if it is not a circle.
    pub outline: Option<Box<BezPath>>,
    /// Its own colour, instead of the layer's.
    pub colour: Option<Colour>,
}

/// A line with a width, along one open or closed curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// One subpath of lines and cubics; closed if it ends with a close.
    pub curve: BezPath,
    /// Full width.
    pub width: Width,
    /// The shape of its two ends.
    pub ends: Ends,
    /// Pen pressure at the curve's nodes, 0 to 1, if the style gives it.
    pub pressure: Option<Vec<f64>>,
    /// Times at the curve's nodes, in seconds from the drawing's beginning, if the style gives them.
    pub times: Option<Vec<f64>>,
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

/// A filled outline, by the nonzero rule.
#[derive(Clone, Debug, PartialEq)]
pub struct Area {
    /// Closed subpaths.
    pub outline: BezPath,
    /// Its own colour, instead of the layer's.
    pub colour: Option<Colour>,
}

impl Dot {
    /// A disc in the layer's ink.
    pub const fn circle(centre: Point, radius: f64) -> Self {
        Self { centre, radius, outline: None, colour: None }
    }

    /// The outline as a closed curve.
    pub fn path(&self) -> BezPath {
        match &self.outline {
            Some(outline) => (**outline).clone(),
            None => kurbo::Circle::new(self.centre, self.radius).to_path(1e-4),
        }
    }

    fn area(&self) -> f64 {
        match &self.outline {
            Some(outline) => outline.area().abs(),
            None => std::f64::consts::PI * self.radius * self.radius,
        }
    }

    fn bounding_box(&self) -> Rect {
        match &self.outline {
            Some(outline) => outline.bounding_box(),
            None => kurbo::Circle::new(self.centre, self.radius).bounding_box(),
        }
    }

    fn clipped(&self, rect: Rect) -> Option<Self> {
        if contains(rect, self.bounding_box()) {
            return Some(self.clone());
        }
        let outline = match &self.outline {
            Some(outline) => clip_outline(outline, rect, (0.02 * self.radius).max(CUT_TOLERANCE)),
            None => clip_disc(self.centre, self.radius, rect),
        };
        let area = outline.area().abs();
        // The rest of a slanting blob may lie anywhere along the border.
        let left = outline.bounding_box();
        (area > 0.0).then(|| Self {
            centre: Point::new(self.centre.x.clamp(left.x0, left.x1), self.centre.y.clamp(left.y0, left.y1)),
            radius: (area / std::f64::consts::PI).sqrt(),
            outline: Some(Box::new(outline)),
            colour: self.colour,
        })
    }
}

impl Stroke {
    /// A stroke in the layer's ink with round ends.
    pub const fn new(curve: BezPath, width: Width) -> Self {
        Self { curve, width, ends: Ends::Round, pressure: None, times: None, colour: None, group: None }
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
    fn area(&self) -> f64 {
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
        let nodes = self.curve.segments().count() + 1;
        let samples = match &self.width {
            Width::Constant(width) => sample_swelling(&self.curve, &vec![*width; nodes], spacing),
            Width::Along(widths) => sample_swelling(&self.curve, widths, spacing),
        };
        samples.into_iter().unzip()
    }

    fn bounding_box(&self) -> Rect {
        let half = 0.5 * self.widest();
        let places = match (self.curve.segments().next(), self.curve.elements().first().and_then(PathEl::end_point)) {
            // A bare point, which has no segment.
            (None, Some(p)) => Rect::from_points(p, p),
            _ => self.curve.bounding_box(),
        };
        places.inflate(half, half)
    }
}

impl Area {
    fn clipped(&self, rect: Rect) -> Option<Self> {
        if contains(rect, self.outline.bounding_box()) {
            return Some(self.clone());
        }
        let outline = clip_outline(&self.outline, rect, CUT_TOLERANCE);
        (outline.area().abs() > 0.0).then_some(Self { outline, colour: self.colour })
    }
}

impl Mark {
    /// Area of the ink in square millimetres.
    pub fn area(&self) -> f64 {
        match self {
            Self::Dot(dot) => dot.area(),
            Self::Stroke(stroke) => stroke.area(),
            Self::Area(area) => area.outline.area().abs(),
        }
    }

    /// The smallest rectangle around the ink.
    pub fn bounding_box(&self) -> Rect {
        match self {
            Self::Dot(dot) => dot.bounding_box(),
            Self::Stroke(stroke) => stroke.bounding_box(),
            Self::Area(area) => area.outline.bounding_box(),
        }
    }

    /// Its own colour, if it has one.
    pub const fn colour(&self) -> Option<Colour> {
        match self {
            Self::Dot(dot) => dot.colour,
            Self::Stroke(stroke) => stroke.colour,
            Self::Area(area) => area.colour,
        }
    }

    /// The mark moved, rotated or uniformly scaled; widths and radii scale by the root of the determinant.
    #[must_use]
    pub fn transformed(&self, transform: Affine) -> Self {
        let scale = transform.determinant().abs().sqrt();
        match self {
            Self::Dot(dot) => Self::Dot(Dot {
                centre: transform * dot.centre,
                radius: dot.radius * scale,
                outline: dot.outline.as_ref().map(|outline| Box::new(transform * (**outline).clone())),
                colour: dot.colour,
            }),
            Self::Stroke(stroke) => Self::Stroke(Stroke {
                curve: transform * stroke.curve.clone(),
                width: match &stroke.width {
                    Width::Constant(width) => Width::Constant(width * scale),
                    Width::Along(widths) => Width::Along(widths.iter().map(|w| w * scale).collect()),
                },
                ..stroke.clone()
            }),
            Self::Area(area) => Self::Area(Area { outline: transform * area.outline.clone(), colour: area.colour }),
        }
    }

    /// The parts inside a rectangle: a dot or area is cut along the border, a stroke where its centre line crosses it.
    pub fn clipped(&self, rect: Rect) -> Vec<Self> {
        match self {
            Self::Dot(dot) => dot.clipped(rect).map(Self::Dot).into_iter().collect(),
            Self::Stroke(stroke) => stroke.clipped(rect).into_iter().map(Self::Stroke).collect(),
            Self::Area(area) => area.clipped(rect).map(Self::Area).into_iter().collect(),
        }
    }
}

pub(super) fn contains(rect: Rect, inner: Rect) -> bool {
    inner.x0 >= rect.x0 && inner.y0 >= rect.y0 && inner.x1 <= rect.x1 && inner.y1 <= rect.y1
}

/// Cuts each subpath of a filled outline to a rectangle, as polygons.
fn clip_outline(outline: &BezPath, rect: Rect, tolerance: f64) -> BezPath {
    let mut cut = BezPath::new();
    for (polygon, _) in flatten(outline, tolerance) {
        let inside = clip_polygon(&polygon, rect);
        if inside.len() < 3 || polygon_area(&inside) == 0.0 {
            continue;
        }
        cut.move_to(inside[0]);
        inside[1..].iter().for_each(|p| cut.line_to(*p));
        cut.close_path();
    }
    cut
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_stroke_s_area_counts_its_round_ends() {
        let stroke = Mark::Stroke(Stroke::new(BezPath::from_svg("M0,0 L10,0").unwrap(), Width::Constant(1.0)));
        assert!((stroke.area() - (10.0 + std::f64::consts::FRAC_PI_4)).abs() < 1e-9);
        assert_eq!(stroke.bounding_box(), Rect::new(-0.5, -0.5, 10.5, 0.5));
    }

    #[test]
    fn clipping_a_stroke_keeps_its_width_there() {
        let stroke = Stroke::new(BezPath::from_svg("M0,0 L10,0").unwrap(), Width::Along(vec![0.0, 1.0]));
        let pieces = stroke.clipped(Rect::new(5.0, -1.0, 20.0, 1.0));
        assert_eq!(pieces.len(), 1);
        let Width::Along(widths) = &pieces[0].width else { panic!("it swells") };
        assert!((widths[0] - 0.5).abs() < 1e-9 && (widths[1] - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_clipped_blob_s_middle_lies_in_what_is_left_of_it() {
        let slanting = BezPath::from_svg("M-4,-4 L4,3 L4,4 L-4,-3 Z").unwrap();
        let blob = Dot { outline: Some(Box::new(slanting)), ..Dot::circle(Point::ORIGIN, 1.6) };
        let left = blob.clipped(Rect::new(2.0, -9.0, 9.0, 9.0)).unwrap();
        assert!(left.bounding_box().contains(left.centre) && left.centre.y > 1.0, "{:?}", left.centre);
    }
}
