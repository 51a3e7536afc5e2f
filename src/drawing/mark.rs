//! Marks of ink: dots, areas, and any mark.

use super::{Colour, Stroke};
use crate::geometry::{Affine, BezPath, Point, Rect, clip_disc, clip_polygon, flatten, polygon_area};
use kurbo::Shape;

/// Flattening tolerance for curves that become polygons to be cut, in millimetres: a few of the smallest written steps, so that a
/// cut blob stays a short path.
const CUT_TOLERANCE: f64 = 0.004;

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
            Self::Stroke(stroke) => Self::Stroke(stroke.transformed(transform)),
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
    fn a_clipped_blob_s_middle_lies_in_what_is_left_of_it() {
        let slanting = BezPath::from_svg("M-4,-4 L4,3 L4,4 L-4,-3 Z").unwrap();
        let blob = Dot { outline: Some(Box::new(slanting)), ..Dot::circle(Point::ORIGIN, 1.6) };
        let left = blob.clipped(Rect::new(2.0, -9.0, 9.0, 9.0)).unwrap();
        assert!(left.bounding_box().contains(left.centre) && left.centre.y > 1.0, "{:?}", left.centre);
    }
}
