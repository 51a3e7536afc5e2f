//! The visible part of each stroke and the picture's colours under it; strokes are visited from the top down.

use super::body::Body;
use crate::geometry::{Point, Rect};
use crate::raster::Raster;

/// Sub-pixels per working pixel in each direction: slivers narrower than half a pixel do not matter.
const FINE: usize = 2;
/// Not covered by anything.
const BARE: u32 = u32::MAX;
/// Beyond the picture or the subject.
const OUTSIDE: u32 = u32::MAX - 1;
/// Just covered; the owner is not yet set.
const TAKEN: u32 = u32::MAX - 2;

/// The canvas at twice the working resolution: for each sub-pixel, the number of its topmost owner.
pub(super) struct Canvas {
    owner: Raster<u32>,
    /// The picture without its frame: strokes are cut off along their centre line outside it, and cover nothing there.
    picture: Rect,
}

/// The visible part of a stretch of a stroke.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shown {
    count: u32,
    /// Sum of the picture's colours over it.
    sum: [f64; 3],
}

/// The sub-pixels newly covered by a stroke, each with its stretch between two nodes.
pub(super) type Fresh = Vec<(u32, u32)>;

impl Shown {
    /// Its area in working pixels.
    pub(super) fn area(&self) -> f64 {
        f64::from(self.count) / (FINE * FINE) as f64
    }

    /// Mean colour of the visible part.
    pub(super) fn colour(&self) -> [f32; 3] {
        self.sum.map(|sum| (sum / f64::from(self.count.max(1))) as f32)
    }

    /// The union of two visible parts.
    pub(super) fn with(&self, other: &Self) -> Self {
        Self { count: self.count + other.count, sum: [0, 1, 2].map(|i| self.sum[i] + other.sum[i]) }
    }
}

impl Canvas {
    /// An empty canvas; sub-pixels outside the region (below 0.5) never show.
    pub(super) fn new(region: &Raster<f32>, margin: usize) -> Self {
        let (width, height) = (region.width() * FINE, region.height() * FINE);
        let framed = Rect::new(0.0, 0.0, region.width() as f64, region.height() as f64);
        let bare = |x: usize, y: usize| if region.get(x / FINE, y / FINE) < 0.5 { OUTSIDE } else { BARE };
        Self { owner: Raster::from_fn(width, height, bare), picture: framed.inset(-(margin as f64)) }
    }

    /// Covers the canvas with a stroke (in working pixels) and returns the sub-pixels that were bare; [`Canvas::settle`] must follow.
    pub(super) fn cover(&mut self, body: &Body, planes: &[Raster<f32>]) -> (Fresh, Vec<Shown>) {
        let mut fresh = Fresh::new();
        let picture = self.picture;
        let is_inside = |pair: &[(Point, f64)]| picture.contains(pair[0].0) && picture.contains(pair[1].0);
        let pieces: Vec<(&[(Point, f64)], &usize)> =
            body.fine.windows(2).zip(&body.stretch_of).filter(|(pair, _)| is_inside(pair)).collect();
        for (pair, stretch) in pieces {
            self.cover_piece([pair[0].0, pair[1].0], [pair[0].1, pair[1].1], *stretch as u32, &mut fresh);
        }
        let mut shown = vec![Shown::default(); body.stretches()];
        let width = self.owner.width();
        for &(at, stretch) in &fresh {
            let (x, y) = (at as usize % width / FINE, at as usize / width / FINE);
            let shown = &mut shown[stretch as usize];
            shown.count += 1;
            for (sum, plane) in shown.sum.iter_mut().zip(planes) {
                *sum += f64::from(plane.get(x, y));
            }
        }
        (fresh, shown)
    }

    /// Sets the owner of the fresh sub-pixels by stretch; those without an owner become bare again.
    pub(super) fn settle(&mut self, fresh: &Fresh, owner: impl Fn(usize) -> Option<usize>) {
        for &(at, stretch) in fresh {
            self.owner.pixels_mut()[at as usize] = owner(stretch as usize).map_or(BARE, |owner| owner as u32);
        }
    }

    /// Bare places in one row of sub-pixels, in working pixels.
    pub(super) fn bare(&self, y: usize) -> impl Iterator<Item = Point> + '_ {
        let middle = move |x: usize| Point::new((x as f64 + 0.5) / FINE as f64, (y as f64 + 0.5) / FINE as f64);
        (0..self.owner.width()).filter(move |&x| self.owner.get(x, y) == BARE).map(middle)
    }

    /// Number of rows of sub-pixels.
    pub(super) const fn rows(&self) -> usize {
        self.owner.height()
    }

    /// True if the sub-pixel at a place in working pixels is bare.
    pub(super) fn is_bare(&self, p: Point) -> bool {
        self.owner.clamped((p.x * FINE as f64) as isize, (p.y * FINE as f64) as isize) == BARE
    }

    /// Mean visible colour of a working pixel, given the colour of each owner; none outside.
    pub(super) fn colour(&self, x: usize, y: usize, colours: &[[f32; 3]]) -> Option<[f32; 3]> {
        let mut sum = [0.0; 3];
        for i in 0..FINE * FINE {
            let owner = self.owner.get(x * FINE + i % FINE, y * FINE + i / FINE);
            let colour = colours.get(owner as usize)?;
            sum.iter_mut().zip(colour).for_each(|(sum, v)| *sum += v / (FINE * FINE) as f32);
        }
        Some(sum)
    }

    /// Covers a piece between two discs, by the distance of each sub-pixel from it.
    fn cover_piece(&mut self, ends: [Point; 2], widths: [f64; 2], stretch: u32, fresh: &mut Fresh) {
        let [a, b] = ends.map(|p| Point::new(p.x * FINE as f64, p.y * FINE as f64));
        let [ra, rb] = widths.map(|w| 0.5 * w * FINE as f64);
        let reach = ra.max(rb);
        let range = |low: f64, high: f64, most: usize| {
            let first = (low - reach).floor().max(0.0) as usize;
            first..((high + reach).ceil().max(0.0) as usize).min(most)
        };
        let along = b - a;
        let per_squared = 1.0 / along.hypot2().max(1e-12);
        let width = self.owner.width();
        let columns = range(a.x.min(b.x), a.x.max(b.x), width);
        for y in range(a.y.min(b.y), a.y.max(b.y), self.owner.height()) {
            for x in columns.clone() {
                let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
                let t = ((p - a).dot(along) * per_squared).clamp(0.0, 1.0);
                let radius = ra + (rb - ra) * t;
                if self.owner.get(x, y) == BARE && (p - (a + along * t)).hypot2() <= radius * radius {
                    self.owner.set(x, y, TAKEN);
                    fresh.push(((y * width + x) as u32, stretch));
                }
            }
        }
    }
}
