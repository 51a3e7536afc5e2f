//! Which strokes show, and in what colours they lie: the painting is gone through from the top.

use crate::drawing::Stroke;
use crate::geometry::Point;
use crate::raster::Raster;

/// Sub-pixels a working pixel each way: slivers narrower than half a pixel are nobody's loss.
const FINE: f64 = 2.0;

/// The canvas at twice the working resolution, with what is covered so far.
pub(super) struct Canvas {
    covered: Raster<bool>,
}

/// What a stroke shows of itself.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shown {
    /// Its area in working pixels.
    pub area: f64,
    /// Sums of the picture's colours there.
    sum: [f64; 3],
}

impl Shown {
    /// The mean colour of what shows.
    pub(super) fn colour(&self) -> [f32; 3] {
        self.sum.map(|sum| (sum / (self.area * FINE * FINE).max(1.0)) as f32)
    }
}

impl Canvas {
    /// Nothing is covered yet, but what lies outside the region (below one half) never shows.
    pub(super) fn new(region: &Raster<f32>) -> Self {
        let (width, height) = (region.width() * FINE as usize, region.height() * FINE as usize);
        Self { covered: Raster::from_fn(width, height, |x, y| region.get(x / FINE as usize, y / FINE as usize) < 0.5) }
    }

    /// Covers what a stroke covers (in working pixels) and tells what of it had not been.
    pub(super) fn cover(&mut self, stroke: &Stroke, planes: &[Raster<f32>]) -> Shown {
        let (points, widths) = stroke.sampled(1.0);
        let mut shown = Shown::default();
        let mut fresh = 0_u32;
        for (pair, widths) in points.windows(2).zip(widths.windows(2)) {
            self.cover_piece([pair[0], pair[1]], [widths[0], widths[1]], |x, y| {
                fresh += 1;
                for (sum, plane) in shown.sum.iter_mut().zip(planes) {
                    *sum += f64::from(plane.get(x, y));
                }
            });
        }
        shown.area = f64::from(fresh) / (FINE * FINE);
        shown
    }

    /// A piece between two discs, by the distance of each sub-pixel from it.
    fn cover_piece(&mut self, ends: [Point; 2], widths: [f64; 2], mut fresh: impl FnMut(usize, usize)) {
        let [a, b] = ends.map(|p| Point::new(p.x * FINE, p.y * FINE));
        let [ra, rb] = widths.map(|w| 0.5 * w * FINE);
        let reach = ra.max(rb);
        let range = |low: f64, high: f64, most: usize| {
            let first = (low - reach).floor().max(0.0) as usize;
            first..((high + reach).ceil().max(0.0) as usize).min(most)
        };
        let along = b - a;
        let squared = along.hypot2().max(1e-12);
        for y in range(a.y.min(b.y), a.y.max(b.y), self.covered.height()) {
            for x in range(a.x.min(b.x), a.x.max(b.x), self.covered.width()) {
                let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
                let t = ((p - a).dot(along) / squared).clamp(0.0, 1.0);
                let radius = ra + (rb - ra) * t;
                if (p - (a + along * t)).hypot2() <= radius * radius && !self.covered.get(x, y) {
                    self.covered.set(x, y, true);
                    fresh(x / FINE as usize, y / FINE as usize);
                }
            }
        }
    }
}
