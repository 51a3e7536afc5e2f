//! The surroundings of one head at a working size, with colour, texture and head coordinates.

use super::head::Head;
use crate::elementary::Elementary as _;
use crate::geometry::{Point, Rect, Vec2, convex_hull};
use crate::raster::{Raster, dilate, filled_polygon, gaussian_blur};
use crate::source::outlines::OVAL;
use crate::source::{Landmarks, lab, srgb_to_linear};

/// Lightness, green to red, blue to yellow, and texture, weighted so that a unit of each is equally significant.
pub(super) type Feature = [f32; 4];

/// Weight of L* (0 to 100) relative to a* and b*.
pub(super) const LIGHTNESS_WEIGHT: f32 = 2.2;

/// A head's surroundings.
pub(super) struct Plate {
    pub head: Head,
    /// The part of the view that the plate covers, in the view's pixels.
    pub part: Rect,
    /// Working pixels per pixel of the view.
    pub scale: f64,
    /// The width of the face in working pixels.
    pub face_width: f32,
    /// sRGB, 0 to 1.
    pub colours: Raster<[f32; 3]>,
    /// L*, a*, b*.
    pub lab: Raster<[f32; 3]>,
    pub features: Raster<Feature>,
    /// True for a photograph in black and white, or toned: only lightness, texture and place tell the regions.
    pub is_grey: bool,
    /// `u` and `v` of each pixel.
    pub at: Raster<[f32; 2]>,
    /// The pixels of this head's person.
    pub inside: Raster<bool>,
    /// The face's oval.
    pub oval: Raster<bool>,
    /// The oval without its rim, over which hair may hang.
    pub core: Raster<bool>,
    points: Vec<Point>,
}

impl Plate {
    /// The plate of `heads[which]`, `None` outside the picture; each pixel of the subject belongs to the nearest head.
    pub(super) fn new(
        pixels: &Raster<[u8; 3]>,
        subject: &Raster<u8>,
        face: &Landmarks,
        heads: &[Head],
        which: usize,
    ) -> Option<Self> {
        /// Width of the face in working pixels: at 60 braids and brows blur, at 200 single hairs matter and time grows fourfold.
        const FACE: f64 = 110.0;
        /// Most pixels on the longer side of the working picture.
        const LONGEST: f64 = 400.0;
        /// Width of the oval's rim, in widths of the face.
        const RIM: f32 = 0.05;
        /// Least share of the subject for a pixel to be inside.
        const SOLID: f32 = 0.5;
        let head = heads[which];
        let part = surroundings(&head, pixels.width() as f64, pixels.height() as f64)?;
        let scale = (FACE / head.width).min(LONGEST / part.width().max(part.height())).min(1.0);
        let count = |length: f64| ((length * scale).round() as usize).max(1);
        let (width, height) = (count(part.width()), count(part.height()));
        let grid = Grid::new(part, width, height);
        let colours = Raster::from_fn(width, height, |x, y| grid.mean(pixels, x, y, |c| c.map(f32::from)).map(|v| v / 255.0));
        let points: Vec<Point> = face.points.iter().map(|p| grid.to_working_pixels(Point::new(p[0], p[1]))).collect();
        let corners: Vec<[f64; 2]> = OVAL.iter().map(|&i| [points[i].x, points[i].y]).collect();
        let oval = filled_polygon(width, height, &corners).map(|v| v != 0);
        let inside = Raster::from_fn(width, height, |x, y| {
            let [share, ..] = grid.mean(subject, x, y, |v| [f32::from(v) / 255.0, 0.0, 0.0]);
            (share > SOLID || oval.get(x, y)) && owner(heads, grid.middle(x, y)) == Some(which)
        });
        let lab = colours.map(|encoded| lab(encoded.map(srgb_to_linear)));
        let is_grey = is_monochrome(&lab, &oval);
        let (lab, colours) = if is_grey {
            (lab.map(|c| [c[0], 0.0, 0.0]), colours.map(|[r, g, b]| [(r + g + b) / 3.0; 3]))
        } else {
            (lab, colours)
        };
        let features = features(&lab);
        let at = Raster::from_fn(width, height, |x, y| head.coordinates(grid.middle(x, y)));
        let face_width = (head.width * scale) as f32;
        let beyond = dilate(&oval.map(|is| u8::from(!is)), (RIM * face_width) as usize);
        let core = beyond.map(|v| v == 0);
        Some(Self { head, part, scale, face_width, colours, lab, features, is_grey, at, inside, oval, core, points })
    }

    pub(super) fn width(&self) -> usize {
        self.at.width()
    }

    pub(super) fn height(&self) -> usize {
        self.at.height()
    }

    /// A landmark in working pixels.
    pub(super) fn point(&self, index: usize) -> Point {
        self.points[index]
    }

    /// `u` and `v` of a point in working pixels.
    pub(super) fn coordinates(&self, p: Point) -> [f32; 2] {
        self.head.coordinates(self.part.origin() + p.to_vec2() / self.scale)
    }

    /// The chin's position across the head, in `u`.
    pub(super) fn chin(&self) -> f32 {
        /// The lowest point of the chin.
        const CHIN_END: usize = 152;
        self.coordinates(self.point(CHIN_END))[0]
    }

    /// Whether a pixel lies below the lips.
    pub(super) fn is_below_lips(&self, i: usize) -> bool {
        /// The middle of the lower lip's lower border.
        const LIPS_END: usize = 17;
        self.at.pixels()[i][1] < self.coordinates(self.point(LIPS_END))[1]
    }

    /// The pixels within `radius` widths of the face, and at least two pixels, of some landmarks.
    pub(super) fn round(&self, indices: &[usize], radius: f32) -> Raster<bool> {
        let radius = f64::from((radius * self.face_width).max(2.0));
        let mut marked = Raster::filled(self.width(), self.height(), false);
        for p in indices.iter().map(|&i| self.point(i)) {
            let range = |centre: f64, count: usize| {
                let end = |v: f64| v.clamp(0.0, count as f64) as usize;
                end(centre - radius)..end(centre + radius + 1.0)
            };
            for (x, y) in range(p.y, self.height()).flat_map(|y| range(p.x, self.width()).map(move |x| (x, y))) {
                if (Point::new(x as f64 + 0.5, y as f64 + 0.5) - p).hypot() <= radius {
                    marked.set(x, y, true);
                }
            }
        }
        marked
    }

    /// The pixels inside the convex hull of some landmarks.
    pub(super) fn hull(&self, indices: &[usize]) -> Raster<bool> {
        let hull = convex_hull(indices.iter().map(|&i| self.point(i)).collect());
        let hull: Vec<[f64; 2]> = hull.iter().map(|p| [p.x, p.y]).collect();
        filled_polygon(self.width(), self.height(), &hull).map(|v| v != 0)
    }

    /// The features of the marked pixels.
    pub(super) fn samples(&self, marked: &Raster<bool>) -> Vec<Feature> {
        self.features.pixels().iter().zip(marked.pixels()).filter(|(_, marked)| **marked).map(|(f, _)| *f).collect()
    }

    /// The pixels for which `rule(coordinates (u, v), pixel index)` is true.
    pub(super) fn pixels_where(&self, rule: impl Fn([f32; 2], usize) -> bool + Sync) -> Raster<bool> {
        let width = self.width();
        Raster::from_fn(width, self.height(), |x, y| rule(self.at.get(x, y), y * width + x))
    }
}

/// True if colour follows from lightness: grey, or toned as a whole.
fn is_monochrome(lab: &Raster<[f32; 3]>, face: &Raster<bool>) -> bool {
    /// The distance in a* and b* from a step's mean up to which a pixel has its colour, and the least share of those: on sixteen portraits
    /// in colour it is at most 0.69. In a face the same, where dull skin before black might pass.
    const SAME: f32 = 4.0;
    const MOST: f32 = 0.98;
    const SAME_IN_FACE: f32 = 1.5;
    const MOST_IN_FACE: f32 = 0.9;
    let in_face: Vec<[f32; 3]> = lab.pixels().iter().zip(face.pixels()).filter(|(_, is)| **is).map(|(c, _)| *c).collect();
    share_of_usual(lab.pixels(), SAME) >= MOST && share_of_usual(&in_face, SAME_IN_FACE) >= MOST_IN_FACE
}

/// The share of pixels whose a* and b* lie within `same` of the mean of those as light; L*, a*, b*.
pub(super) fn share_of_usual(lab: &[[f32; 3]], same: f32) -> f32 {
    const STEPS: usize = 10;
    let step = |l: f32| ((l / 100.0 * STEPS as f32) as usize).min(STEPS - 1);
    let mut sums = [[0.0_f64; 3]; STEPS];
    for [l, a, b] in lab {
        let sum = &mut sums[step(*l)];
        *sum = [sum[0] + f64::from(*a), sum[1] + f64::from(*b), sum[2] + 1.0];
    }
    let means = sums.map(|[a, b, count]| [(a / count.max(1.0)) as f32, (b / count.max(1.0)) as f32]);
    let is_usual = |[l, a, b]: &[f32; 3]| (a - means[step(*l)][0]).hypotenuse(b - means[step(*l)][1]) < same;
    lab.iter().filter(|pixel| is_usual(pixel)).count() as f32 / lab.len().max(1) as f32
}

/// The index of the head that is nearest in widths of its face.
pub(super) fn owner(heads: &[Head], p: Point) -> Option<usize> {
    let nearest = heads.iter().enumerate().min_by(|a, b| a.1.distance(p).total_cmp(&b.1.distance(p)));
    nearest.map(|(i, _)| i)
}

/// Margin around the face, in widths to either side and in heights above and below the chin.
const ASIDE: f64 = 2.6;
const ABOVE: f64 = 2.4;
const BELOW: f64 = 2.4;

/// The part of the view around a head, in whole pixels; `None` outside the picture.
fn surroundings(head: &Head, width: f64, height: f64) -> Option<Rect> {
    let corners = [(-ASIDE, ABOVE), (ASIDE, ABOVE), (-ASIDE, -BELOW), (ASIDE, -BELOW)].map(|(u, v)| head.place(u, v));
    let round = corners.iter().fold(Rect::from_points(corners[0], corners[3]), |round, p| round.union_pt(*p));
    let part = round.expand().intersect(Rect::new(0.0, 0.0, width, height));
    (part.width() >= 1.0 && part.height() >= 1.0).then_some(part)
}

/// The working pixels over a part of the view.
pub(super) struct Grid {
    part: Rect,
    x_step: f64,
    y_step: f64,
}

impl Grid {
    pub(super) fn new(part: Rect, width: usize, height: usize) -> Self {
        Self { part, x_step: part.width() / width as f64, y_step: part.height() / height as f64 }
    }

    /// The centre of a working pixel, in the view's pixels.
    pub(super) fn middle(&self, x: usize, y: usize) -> Point {
        self.part.origin() + Vec2::new((x as f64 + 0.5) * self.x_step, (y as f64 + 0.5) * self.y_step)
    }

    /// A point of the view in working pixels.
    fn to_working_pixels(&self, p: Point) -> Point {
        Point::new((p.x - self.part.x0) / self.x_step, (p.y - self.part.y0) / self.y_step)
    }

    /// The mean of the view's pixels whose centres are in a working pixel, at least one pixel.
    pub(super) fn mean<T: Copy + Send + Sync>(
        &self,
        raster: &Raster<T>,
        x: usize,
        y: usize,
        value: impl Fn(T) -> [f32; 3],
    ) -> [f32; 3] {
        let range = |from: f64, step: f64, i: usize, count: usize| {
            let start = ((from + i as f64 * step).round() as usize).min(count - 1);
            start..((from + (i + 1) as f64 * step).round() as usize).clamp(start + 1, count.max(start + 1))
        };
        let rows = range(self.part.y0, self.y_step, y, raster.height());
        let columns = range(self.part.x0, self.x_step, x, raster.width());
        let count = (rows.len() * columns.len()) as f32;
        let mut sum = [0.0; 3];
        for v in rows.flat_map(|y| raster.row(y)[columns.clone()].iter()) {
            let v = value(*v);
            sum = [sum[0] + v[0], sum[1] + v[1], sum[2] + v[2]];
        }
        sum.map(|v| v / count)
    }
}

/// Texture is the deviation from a blur of `TEXTURE_BLUR` pixels, averaged over `TEXTURE_REACH`, on a logarithmic scale of this
/// weight.
const TEXTURE_BLUR: f32 = 2.0;
const TEXTURE_REACH: f32 = 2.5;
const TEXTURE_WEIGHT: f32 = 9.0;

fn features(lab: &Raster<[f32; 3]>) -> Raster<Feature> {
    let light = lab.map(|c| LIGHTNESS_WEIGHT * c[0]);
    let smooth = gaussian_blur(&light, TEXTURE_BLUR);
    let energy = gaussian_blur(&light.zip_map(&smooth, |v, s| (v - s) * (v - s)), TEXTURE_REACH);
    lab.zip_map(&energy, |c, e| [LIGHTNESS_WEIGHT * c[0], c[1], c[2], TEXTURE_WEIGHT * e.max(0.0).sqrt().logarithm_above_1()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn toned_photographs_are_monochrome_and_a_face_before_grey_is_not() {
        let light = |x: usize| 5.0 + 90.0 * x as f32 / 99.0;
        let is_face = |x: usize, y: usize| (30..60).contains(&x) && (10..30).contains(&y);
        let face = Raster::from_fn(100, 50, is_face);
        assert!(is_monochrome(&Raster::from_fn(100, 50, |x, _| [light(x), 0.0, 0.0]), &face));
        assert!(is_monochrome(&Raster::from_fn(100, 50, |x, _| [light(x), 0.02 * light(x), 0.1 * light(x)]), &face));
        let before_grey = |x, y| [light(x), 0.0, if is_face(x, y) { 12.0 } else { 0.0 }];
        assert!(!is_monochrome(&Raster::from_fn(100, 50, before_grey), &face));
        let before_black = |x, y| if is_face(x, y) { [50.0, if y > 25 { 14.0 } else { 6.0 }, 9.0] } else { [5.0, 0.0, 0.0] };
        assert!(!is_monochrome(&Raster::from_fn(100, 50, before_black), &face));
    }
}
