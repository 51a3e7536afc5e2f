//! The upright picture, or a part of it, as bytes; and windows onto it, the networks' inputs.

use super::SeeError;
use super::turn::Turn;
use crate::elementary::{Elementary as _, unit_at};
use crate::geometry::{Point, Rect, Vec2};
use crate::raster::Raster;
use crate::source::{Crop, Photograph};

/// Number of precomputed halvings of the pixels: from 1024 pixels per side down to the 128 of the smallest window.
const HALVINGS: usize = 3;
/// Most samples of a window's pixel in one direction at the coarsest halving; larger steps skip pixels.
const MOST_SAMPLES: f64 = 8.0;

/// Pixels of the upright picture, or of a part of it.
pub(super) struct View {
    pub pixels: Raster<[u8; 3]>,
    /// The part, in pixels of the upright picture.
    pub part: Rect,
    /// The pixels at half size, quarter size, and so on.
    halves: Vec<Raster<[u8; 3]>>,
}

impl View {
    /// Wraps pixels that show `part` of the upright picture.
    pub(super) fn new(pixels: Raster<[u8; 3]>, part: Rect) -> Self {
        let mut halves: Vec<Raster<[u8; 3]>> = Vec::with_capacity(HALVINGS);
        for _ in 0..HALVINGS {
            halves.push(halved(halves.last().unwrap_or(&pixels)));
        }
        Self { pixels, part, halves }
    }

    /// The whole picture, at most `longest` pixels on its longer side, never enlarged.
    pub(super) fn whole(photograph: &Photograph, turn: Turn, longest: f64) -> Result<Self, SeeError> {
        let [width, height] = turn.upright_size();
        Self::of_part(photograph, turn, Rect::new(0.0, 0.0, width, height), longest)
    }

    /// A part of the picture, clipped to it.
    pub(super) fn of_part(photograph: &Photograph, turn: Turn, part: Rect, longest: f64) -> Result<Self, SeeError> {
        let [width, height] = turn.upright_size();
        let part = part.expand().intersect(Rect::new(0.0, 0.0, width, height));
        let stored = turn.box_back(part);
        let crop = Crop { x: stored.x0, y: stored.y0, width: stored.width(), height: stored.height() };
        let scale = (longest / part.width().max(part.height())).min(1.0);
        let count = |length: f64| (length * scale).round().max(1.0) as usize;
        let pixels = turn.raster(&photograph.encoded(crop, count(stored.width()), count(stored.height()))?);
        Ok(Self::new(pixels, part))
    }

    /// Size of a view pixel in pixels of the upright picture.
    pub(super) fn step(&self) -> Vec2 {
        Vec2::new(self.part.width() / self.pixels.width() as f64, self.part.height() / self.pixels.height() as f64)
    }

    /// The view through a window, resampled to `side` x `side` pixels, in byte values as floats.
    pub(super) fn through(&self, window: &Window, side: usize, outside: Outside) -> Raster<[f32; 3]> {
        self.resampled_to(window, [side, side], outside)
    }

    /// The view through a window, resampled to `size` columns and rows, in byte values as floats. Each pixel is the mean of
    /// bilinear samples, one per pixel that it covers, taken at the halving where it covers at most two by two.
    pub(super) fn resampled_to(&self, window: &Window, size: [usize; 2], outside: Outside) -> Raster<[f32; 3]> {
        let step = self.step();
        let in_view = |v: Vec2, count: usize| Vec2::new(v.x / step.x, v.y / step.y) / count as f64;
        let (across, down) = (in_view(window.across, size[0]), in_view(window.down, size[1]));
        let halvings = (across.hypot().max(down.hypot()).max(1.0).binary_logarithm() as usize).min(self.halves.len());
        let pixels = halvings.checked_sub(1).map_or(&self.pixels, |last| &self.halves[last]);
        let scale = 0.5_f64.powi(halvings as i32);
        let (across, down) = (across * scale, down * scale);
        let origin = window.origin - self.part.origin();
        let origin = Point::new(origin.x / step.x * scale, origin.y / step.y * scale);
        let samples = |v: Vec2| v.hypot().ceil().clamp(1.0, MOST_SAMPLES) as usize;
        let (columns, rows) = (samples(across), samples(down));
        Raster::from_fn(size[0], size[1], |x, y| {
            let mut sum = [0.0; 3];
            for (i, j) in (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))) {
                let u = x as f64 + (i as f64 + 0.5) / columns as f64;
                let v = y as f64 + (j as f64 + 0.5) / rows as f64;
                let colour = sample(pixels, origin + across * u + down * v, outside);
                sum = [sum[0] + colour[0], sum[1] + colour[1], sum[2] + colour[2]];
            }
            let count = (columns * rows) as f32;
            [sum[0] / count, sum[1] / count, sum[2] / count]
        })
    }
}

/// Half the columns and rows; each pixel is the mean of four.
fn halved(pixels: &Raster<[u8; 3]>) -> Raster<[u8; 3]> {
    let (right, bottom) = (pixels.width() - 1, pixels.height() - 1);
    Raster::from_fn(pixels.width().div_ceil(2), pixels.height().div_ceil(2), |x, y| {
        let (x, y) = (2 * x, 2 * y);
        let (x2, y2) = ((x + 1).min(right), (y + 1).min(bottom));
        let four = [pixels.get(x, y), pixels.get(x2, y), pixels.get(x, y2), pixels.get(x2, y2)];
        let mean = |k: usize| ((four.iter().map(|colour| u32::from(colour[k])).sum::<u32>() + 2) / 4) as u8;
        [mean(0), mean(1), mean(2)]
    })
}

/// The colour at a point in pixels, bilinear.
fn sample(pixels: &Raster<[u8; 3]>, p: Point, outside: Outside) -> [f32; 3] {
    let (width, height) = (pixels.width() as f64, pixels.height() as f64);
    if let Outside::Grey(grey) = outside
        && !((0.0..width).contains(&p.x) && (0.0..height).contains(&p.y))
    {
        return [grey; 3];
    }
    let (x, y) = (p.x - 0.5, p.y - 0.5);
    let (tx, ty) = ((x - x.floor()) as f32, (y - y.floor()) as f32);
    let (x, y) = (x.floor() as isize, y.floor() as isize);
    let at = |x: isize, y: isize| pixels.clamped(x, y);
    let (a, b, c, d) = (at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1));
    let between = |a: u8, b: u8| f32::from(a) * (1.0 - tx) + f32::from(b) * tx;
    let channel = |k: usize| between(a[k], b[k]) * (1.0 - ty) + between(c[k], d[k]) * ty;
    [channel(0), channel(1), channel(2)]
}

/// What a window shows outside the picture.
#[derive(Clone, Copy, Debug)]
pub(super) enum Outside {
    /// The nearest border pixel.
    Repeated,
    /// A grey, 0 to 255.
    Grey(f32),
}

/// A parallelogram of the upright picture, the input of a network, in pixels of that picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    /// Its first corner.
    pub origin: Point,
    /// Its upper side, from the first corner.
    pub across: Vec2,
    /// Its left side.
    pub down: Vec2,
}

impl Window {
    /// An upright rectangle of any proportions.
    pub(super) fn stretched(part: Rect) -> Self {
        Self { origin: part.origin(), across: Vec2::new(part.width(), 0.0), down: Vec2::new(0.0, part.height()) }
    }

    /// A square rotated clockwise by an angle in radians.
    pub(super) fn square(centre: Point, side: f64, angle: f64) -> Self {
        let across = unit_at(angle) * side;
        let down = Vec2::new(-across.y, across.x);
        Self { origin: centre - 0.5 * (across + down), across, down }
    }

    /// The same window, mirrored left to right.
    pub(super) fn mirrored(self) -> Self {
        Self { origin: self.origin + self.across, across: -self.across, down: self.down }
    }

    /// Maps a point of the window (0 to 1 in both directions) to the upright picture.
    pub(super) fn place(&self, x: f64, y: f64) -> Point {
        self.origin + self.across * x + self.down * y
    }
}

/// The middle of a pixel of a grid that lies over a part of the photograph.
pub(super) fn on_view(part: Rect, (columns, rows): (usize, usize), (x, y): (usize, usize)) -> Point {
    let (x, y) = ((x as f64 + 0.5) / columns as f64, (y as f64 + 0.5) / rows as f64);
    Point::new(part.x0 + x * part.width(), part.y0 + y * part.height())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slope() -> View {
        let pixels = Raster::from_fn(40, 20, |x, y| [(2 * x + 3 * y) as u8, 7, 200]);
        View::new(pixels, Rect::new(0.0, 0.0, 80.0, 40.0))
    }

    #[test]
    fn a_turned_and_mirrored_window_shows_what_lies_there() {
        let view = slope();
        let window = Window::square(Point::new(40.0, 20.0), 16.0, 0.4).mirrored();
        let seen = view.through(&window, 8, Outside::Repeated);
        for (x, y) in [(0, 0), (3, 5), (7, 7)] {
            let p = window.place((x as f64 + 0.5) / 8.0, (y as f64 + 0.5) / 8.0);
            let expected = (p.x - 1.0) + 1.5 * (p.y - 1.0);
            assert!((f64::from(seen.get(x, y)[0]) - expected).abs() < 1e-3, "{:?} {expected}", seen.get(x, y));
        }
    }

    #[test]
    fn beyond_the_picture_there_is_grey() {
        let seen = slope().through(&Window::stretched(Rect::new(-80.0, 0.0, 80.0, 40.0)), 4, Outside::Grey(127.0));
        assert_eq!((seen.get(0, 1), seen.get(1, 2)), ([127.0; 3], [127.0; 3]));
        assert_eq!(seen.get(2, 2)[1], 7.0);
    }
}
