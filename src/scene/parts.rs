//! The parts of a picture: which point of the page belongs to which region.

use super::Border;
use crate::field::contours;
use crate::geometry::{BezPath, Millimetres, OffsetOutline, Point, Region};
use crate::raster::{Raster, gaussian_blur};
use crate::source::Placement;
use std::ops::Range;

/// Blur of masks in millimetres: their pixels' steps vanish, corners of a collar stay.
const SMOOTH: f64 = 0.25;
/// How far a part is drawn beyond its border before it is cut there, in millimetres: the spacing of its marks does not know the
/// border.
const BEYOND: f64 = 2.5;
/// Slivers, as between two masks that do not quite meet: at this blur in millimetres less than this share of a place is the part's, which is
/// so for what is narrower than 0.3 mm, half a dot.
const SLIVER: f64 = 0.4;
const LEAST_SUBSTANCE: f32 = 0.3;
/// Share of a fading part from which it is drawn at all.
const LEAST_SHARE: f32 = 0.02;
/// Tolerance of shrunken outlines in millimetres.
const TOLERANCE: f64 = 0.01;

/// Where the parts of a picture lie. Part 0 is the rest, which no region covers.
#[derive(Clone, Debug)]
pub struct Parts {
    placement: Placement,
    /// How much of each pixel is a part's own, 0 to 1; all parts together are 1.
    shares: Vec<Raster<f32>>,
    outlines: Vec<Region>,
    borders: Vec<Border>,
}

impl Parts {
    /// The parts of masks on one grid, each 0 to 1, later ones over earlier ones, each with its border.
    ///
    /// ```
    /// use drypoint::{geometry::Rect, raster::Raster, scene::{Border, Parts}, source::Placement};
    ///
    /// let placement = Placement::new(Rect::new(0.0, 0.0, 40.0, 40.0), 5.0);
    /// let left = Raster::from_fn(200, 200, |x, _| if x < 100 { 1.0 } else { 0.0 });
    /// let parts = Parts::new(placement, &[(left, Border::Butt)]);
    /// assert_eq!(parts.count(), 2);
    /// let inside = parts.drawn_share(1, &placement);
    /// assert!(inside.get(50, 100) > 0.9 && inside.get(190, 100) < 0.1);
    /// ```
    pub fn new(placement: Placement, masks: &[(Raster<f32>, Border)]) -> Self {
        let sigma = placement.pixels(Millimetres(SMOOTH)) as f32;
        let smooth: Vec<Raster<f32>> = masks.iter().map(|(mask, _)| gaussian_blur(mask, sigma)).collect();
        let whole = Raster::filled(placement.columns, placement.rows, 1.0_f32);
        // What regions further up leave free.
        let mut free_share = whole.clone();
        let mut covered: Option<BezPath> = None;
        let (mut shares, mut outlines) = (Vec::new(), Vec::new());
        for (mask, (_, border)) in smooth.iter().zip(masks).rev() {
            let own =
                if let Border::Fade(band) = border { faded(mask, *band, &placement) } else { mask.map(|v| f32::from(v > 0.5)) };
            shares.push(own.zip_map(&free_share, |own, free| own * free));
            free_share = free_share.zip_map(&own, |free, own| free * (1.0 - own));
            let outline = outline(mask, &placement);
            outlines.push(minus(&outline, covered.as_ref()));
            covered = Some(match covered {
                Some(mut above) => {
                    above.extend(outline);
                    above
                }
                None => outline,
            });
        }
        shares.push(free_share);
        outlines.push(minus(&outline_of_all(&placement), covered.as_ref()));
        shares.reverse();
        outlines.reverse();
        let borders = std::iter::once(Border::Butt).chain(masks.iter().map(|(_, border)| *border)).collect();
        let mut parts = Self { placement, shares, outlines: Vec::new(), borders };
        parts.outlines = outlines.iter().enumerate().map(|(i, outline)| parts.cut(i, outline)).collect();
        parts
    }

    /// The outline at which a part's marks are cut.
    fn cut(&self, part: usize, outline: &BezPath) -> Region {
        let fades = self.borders.iter().any(|border| matches!(border, Border::Fade(_)));
        match self.borders[part] {
            Border::Gap(gap) => Region::new(&OffsetOutline::new(outline, TOLERANCE).grown(-gap).path(), TOLERANCE),
            // A fading part, or one beside it, ends where its share does.
            _ if fades => Region::new(&self::outline_at(&self.shares[part], &self.placement, LEAST_SHARE), TOLERANCE),
            _ => Region::new(outline, TOLERANCE),
        }
    }

    /// Number of parts, the rest included.
    pub fn count(&self) -> usize {
        self.outlines.len()
    }

    /// The inside of a part on the page, in millimetres.
    pub fn outline(&self, part: usize) -> &Region {
        &self.outlines[part]
    }

    /// The share of its tone with which a part is drawn, on another grid: 1 inside and some way beyond its border, 0 far from it;
    /// in a fading band what is its own.
    pub fn drawn_share(&self, part: usize, placement: &Placement) -> Raster<f32> {
        let share = &self.shares[part];
        let is_fading = self.borders.iter().any(|border| matches!(border, Border::Fade(_)));
        let drawn = if is_fading {
            share.clone()
        } else {
            let beyond = self.placement.pixels(Millimetres(BEYOND)) as f32;
            gaussian_blur(share, 0.5 * beyond).map(|v| (v * 20.0).min(1.0))
        };
        self.on(&drawn, placement)
    }

    /// The columns and rows of another grid in which a part has something to draw of what is drawn at all (0 to 1), with the room that it is
    /// drawn beyond its border; none if it has nothing. Slivers do not count.
    pub fn extent(&self, part: usize, drawn: &Raster<f32>, placement: &Placement) -> Option<[Range<usize>; 2]> {
        let pixels = |reach: f64| placement.pixels(Millimetres(reach));
        let is_fading = self.borders.iter().any(|border| matches!(border, Border::Fade(_)));
        let least = if is_fading { LEAST_SHARE } else { LEAST_SUBSTANCE };
        let own = self.share_on(part, placement).zip_map(drawn, |share, drawn| share * drawn);
        gaussian_blur(&own, pixels(SLIVER) as f32).extent_with_room(least, pixels(BEYOND).ceil() as usize)
    }

    /// How much of each pixel of another grid is a part's own.
    pub(super) fn share_on(&self, part: usize, placement: &Placement) -> Raster<f32> {
        self.on(&self.shares[part], placement)
    }

    /// A raster of this grid on another one.
    fn on(&self, raster: &Raster<f32>, placement: &Placement) -> Raster<f32> {
        Raster::from_fn(placement.columns, placement.rows, |x, y| {
            let p = placement.to_page(Point::new(x as f64 + 0.5, y as f64 + 0.5));
            let p = self.placement.to_grid(p);
            raster.sample(p.x, p.y)
        })
    }
}

/// A mask that changes from 0 to 1 within a band about its border.
fn faded(mask: &Raster<f32>, band: f64, placement: &Placement) -> Raster<f32> {
    let hard = mask.map(|v| f32::from(v > 0.5));
    gaussian_blur(&hard, placement.pixels(Millimetres(0.4 * band)) as f32)
}

fn minus(outline: &BezPath, above: Option<&BezPath>) -> BezPath {
    let Some(above) = above else { return outline.clone() };
    Region::new(above, TOLERANCE).outside_of_area(&Region::new(outline, TOLERANCE))
}

fn outline(mask: &Raster<f32>, placement: &Placement) -> BezPath {
    outline_at(mask, placement, 0.5)
}

/// The closed lines about the places where a mask is above a level. At the picture's border they run outside of it.
fn outline_at(mask: &Raster<f32>, placement: &Placement, level: f32) -> BezPath {
    const PAD: usize = 3;
    let padded = Raster::from_fn(mask.width() + 2 * PAD, mask.height() + 2 * PAD, |x, y| {
        let is_rim = x == 0 || y == 0 || x == mask.width() + 2 * PAD - 1 || y == mask.height() + 2 * PAD - 1;
        let at = |i: usize, most: usize| i.saturating_sub(PAD).min(most - 1);
        if is_rim { 0.0 } else { mask.get(at(x, mask.width()), at(y, mask.height())) }
    });
    let mut path = BezPath::new();
    for curve in contours(&padded, level) {
        let to_page = |p: &Point| placement.to_page(Point::new(p.x - PAD as f64, p.y - PAD as f64));
        for (i, p) in curve.points.iter().map(to_page).enumerate() {
            if i == 0 { path.move_to(p) } else { path.line_to(p) }
        }
        path.close_path();
    }
    path
}

/// The picture's box and what lies outside of it as far as outlines reach.
fn outline_of_all(placement: &Placement) -> BezPath {
    use kurbo::Shape;
    let around = placement.mm(4.0).0;
    placement.picture.inflate(around, around).to_path(TOLERANCE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Rect;

    #[test]
    fn slivers_do_not_count_to_what_a_part_has_to_draw() {
        let placement = Placement::new(Rect::new(0.0, 0.0, 40.0, 40.0), 5.0);
        // The rest is a square of 10 mm, and a line 0.2 mm wide between two regions.
        let left = Raster::from_fn(200, 200, |x, y| f32::from(u8::from(x < 120 && !(x < 50 && y < 50))));
        let right = Raster::from_fn(200, 200, |x, _| f32::from(u8::from(x > 120)));
        let parts = Parts::new(placement, &[(left, Border::Butt), (right, Border::Butt)]);
        let subject = Raster::filled(200, 200, 1.0_f32);
        let [columns, rows] = parts.extent(0, &subject, &placement).expect("the square");
        assert!(columns.start == 0 && (50..75).contains(&columns.end) && (50..75).contains(&rows.end), "{columns:?} {rows:?}");
        assert_eq!(parts.extent(0, &subject.map(|_| 0.0), &placement), None);
    }
}
