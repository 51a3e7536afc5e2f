//! A photograph or scan of the sheet.

use super::chroma::Chroma;
use super::curve::Curve;
use crate::geometry::Point;
use crate::raster::{Raster, shares_of_bytes};

/// A photograph or scan of the sheet, in any orientation.
#[derive(Clone, Copy, Debug)]
pub enum Picture<'a> {
    /// sRGB values as files hold them.
    Encoded(&'a Raster<[u8; 3]>),
    /// Linear light in sRGB's primaries, 0 to 1.
    Linear(&'a Raster<[f32; 3]>),
}

/// Values from which a channel counts as clipped.
const CLIPPED: [f32; 2] = [254.0, 0.995];
/// Pixels of the reduced picture in which marks are sought.
const SOUGHT_PIXELS: f64 = 2.4e6;

impl Picture<'_> {
    pub(super) const fn width(&self) -> usize {
        match self {
            Self::Encoded(raster) => raster.width(),
            Self::Linear(raster) => raster.width(),
        }
    }

    pub(super) const fn height(&self) -> usize {
        match self {
            Self::Encoded(raster) => raster.height(),
            Self::Linear(raster) => raster.height(),
        }
    }

    /// Whole factor by which the picture is reduced for the search.
    pub(super) fn reduction(&self) -> usize {
        ((self.width() as f64 * self.height() as f64 / SOUGHT_PIXELS).sqrt().round() as usize).max(1)
    }

    /// The picture in grey, sRGB-encoded, 0 to 1, each pixel the mean of `factor x factor`; of the darkest channel if `darkest`, else luma.
    /// The last columns and rows that fill no block are left out.
    pub(super) fn grey(&self, factor: usize, darkest: bool) -> Raster<f32> {
        let (width, height) = (self.width() / factor, self.height() / factor);
        let weigh = |[r, g, b]: [f32; 3]| if darkest { r.min(g).min(b) } else { 0.299 * r + 0.587 * g + 0.114 * b };
        let scale = 1.0 / (factor * factor) as f32;
        match self {
            Self::Encoded(raster) => Raster::from_fn(width, height, |x, y| {
                let mut sum = [0_u32; 3];
                for row in 0..factor {
                    for v in &raster.row(y * factor + row)[x * factor..(x + 1) * factor] {
                        sum = [sum[0] + u32::from(v[0]), sum[1] + u32::from(v[1]), sum[2] + u32::from(v[2])];
                    }
                }
                weigh(sum.map(|v| v as f32 * scale / 255.0))
            }),
            Self::Linear(raster) => Raster::from_fn(width, height, |x, y| {
                let mut sum = [0.0_f32; 3];
                for row in 0..factor {
                    for v in &raster.row(y * factor + row)[x * factor..(x + 1) * factor] {
                        let v = tame(*v);
                        sum = [sum[0] + v[0], sum[1] + v[1], sum[2] + v[2]];
                    }
                }
                weigh(sum.map(|v| (v * scale).sqrt()))
            }),
        }
    }
}

/// Neither NaN nor infinite nor negative.
fn tame(v: [f32; 3]) -> [f32; 3] {
    v.map(|v| if v.is_finite() { v.clamp(0.0, 16.0) } else { 0.0 })
}

/// Takes linear light from a picture, through the inverse of a camera's curve.
pub(super) struct Probe<'a> {
    picture: Picture<'a>,
    curve: Curve,
    /// Linear light of each sRGB value.
    table: [f32; 256],
}

impl<'a> Probe<'a> {
    pub(super) fn new(picture: Picture<'a>, curve: Curve) -> Self {
        Self { picture, curve, table: std::array::from_fn(|v| curve.light(v as f32 / 255.0)) }
    }

    /// Linear light of a pixel, or of the pixel at the border nearest to it.
    #[inline]
    fn pixel(&self, x: isize, y: isize) -> [f32; 3] {
        match self.picture {
            Picture::Encoded(raster) => raster.clamped(x, y).map(|v| self.table[usize::from(v)]),
            Picture::Linear(raster) => self.curve.corrected(tame(raster.clamped(x, y))),
        }
    }

    /// Linear light at a point in pixels, bilinear between the pixels' centres.
    #[inline]
    pub(super) fn at(&self, p: Point) -> [f32; 3] {
        bilinear(p, |x, y| self.pixel(x, y))
    }

    /// The same with colour put back by luma; for files only.
    #[inline]
    pub(super) fn restored_at(&self, p: Point, chroma: &Chroma) -> [f32; 3] {
        bilinear(p, |x, y| match self.picture {
            Picture::Encoded(raster) => chroma.restored(shares_of_bytes(raster.clamped(x, y))).map(|v| self.light(v)),
            Picture::Linear(_) => self.pixel(x, y),
        })
    }

    /// The value of a file at a point, 0 to 1; `None` for linear light.
    pub(super) fn encoded_at(&self, p: Point) -> Option<[f32; 3]> {
        match self.picture {
            Picture::Encoded(raster) => Some(bilinear(p, |x, y| shares_of_bytes(raster.clamped(x, y)))),
            Picture::Linear(_) => None,
        }
    }

    /// The curve that is undone.
    pub(super) const fn curve(&self) -> Curve {
        self.curve
    }

    /// Linear light of a value between those of the table.
    #[inline]
    fn light(&self, value: f32) -> f32 {
        let place = value * 255.0;
        let low = (place as usize).min(254);
        let t = place - low as f32;
        self.table[low] * (1.0 - t) + self.table[low + 1] * t
    }

    /// Whether a channel of the pixel around a point is as bright as the file can tell.
    pub(super) fn is_clipped(&self, p: Point) -> bool {
        let (x, y) = (p.x.clamp(-2.0, 1e9) as isize, p.y.clamp(-2.0, 1e9) as isize);
        match self.picture {
            Picture::Encoded(raster) => raster.clamped(x, y).into_iter().any(|v| f32::from(v) >= CLIPPED[0]),
            Picture::Linear(raster) => tame(raster.clamped(x, y)).into_iter().any(|v| v >= CLIPPED[1]),
        }
    }
}

/// Values of the four pixels around a point, by its distances from their centres.
#[inline]
fn bilinear(p: Point, pixel: impl Fn(isize, isize) -> [f32; 3]) -> [f32; 3] {
    let (fx, fy) = (p.x - 0.5, p.y - 0.5);
    let (x0, y0) = (fx.floor(), fy.floor());
    let (tx, ty) = ((fx - x0) as f32, (fy - y0) as f32);
    // Casts of numbers beyond the range, and of NaN, end at the border.
    let (x, y) = (x0.clamp(-2.0, 1e9) as isize, y0.clamp(-2.0, 1e9) as isize);
    let [a, b, c, d] = [pixel(x, y), pixel(x + 1, y), pixel(x, y + 1), pixel(x + 1, y + 1)];
    std::array::from_fn(|i| {
        let (top, bottom) = (a[i] + (b[i] - a[i]) * tx, c[i] + (d[i] - c[i]) * tx);
        top + (bottom - top) * ty
    })
}
