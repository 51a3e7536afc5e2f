//! Dark blobs of a picture, by moments.

use crate::geometry::Point;
use crate::parallel::collected;
use crate::raster::{Raster, box_blur, reduce};

/// Smallest blob in pixels.
const LEAST_PIXELS: f64 = 9.0;
/// Side in pixels of the blocks on which the local mean is computed.
const BLOCK: usize = 8;

/// A connected dark region.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blob {
    /// Number of pixels.
    pub area: f64,
    pub centre: Point,
    /// Covariance of its pixels: xx, xy, yy.
    pub spread: [f64; 3],
}

impl Blob {
    /// Square root of the covariance's determinant: in an affine picture, in proportion to the true one.
    pub(super) fn size(&self) -> f64 {
        let [xx, xy, yy] = self.spread;
        (xx * yy - xy * xy).max(0.0).sqrt()
    }

    /// Area relative to an ellipse of the same covariance: 1 for a disc, less for a ring.
    pub(super) fn fullness(&self) -> f64 {
        self.area / (4.0 * std::f64::consts::PI * self.size()).max(1e-9)
    }

    /// Distance of a point from the centre, in standard deviations.
    pub(super) fn distance(&self, p: Point) -> f64 {
        let ([xx, xy, yy], d) = (self.spread, p - self.centre);
        let whole = (xx * yy - xy * xy).max(1e-9);
        ((yy * d.x * d.x - 2.0 * xy * d.x * d.y + xx * d.y * d.y) / whole).max(0.0).sqrt()
    }

    /// The blob in a picture larger by this factor.
    pub(super) fn enlarged(&self, factor: f64) -> Self {
        let square = factor * factor;
        let centre = (self.centre.to_vec2() * factor).to_point();
        Self { area: self.area * square, centre, spread: self.spread.map(|v| v * square) }
    }
}

/// Mean of a picture within `radius` pixels, in blocks of 8 pixels.
pub(super) fn local_mean(grey: &Raster<f32>, radius: usize) -> Raster<f32> {
    box_blur(&reduce(grey, BLOCK), (radius / BLOCK).max(1))
}

/// The connected regions (four neighbours) darker than `share` of the local mean.
pub(super) fn dark_blobs(grey: &Raster<f32>, mean: &Raster<f32>, share: f32) -> Vec<Blob> {
    let rows: Vec<Vec<[u32; 2]>> = collected(grey.height(), &|y| runs(grey.row(y), mean.row(y / BLOCK), share));
    let mut joined: Vec<u32> = Vec::new();
    let mut sums: Vec<[f64; 6]> = Vec::new();
    let mut above: &[[u32; 2]] = &[];
    for (y, row) in rows.iter().enumerate() {
        let first = sums.len() - above.len();
        let mut touching = 0;
        for run in row {
            let this = sums.len() as u32;
            joined.push(this);
            sums.push(moments(*run, y));
            while touching < above.len() && above[touching][1] <= run[0] {
                touching += 1;
            }
            for (i, _) in above.iter().enumerate().skip(touching).take_while(|(_, other)| other[0] < run[1]) {
                join(&mut joined, this, (first + i) as u32);
            }
        }
        above = row;
    }
    for i in (0..sums.len()).rev() {
        let root = joined[i] as usize;
        if root != i {
            let part = sums[i];
            sums[root].iter_mut().zip(part).for_each(|(sum, v)| *sum += v);
            sums[i][0] = 0.0;
        }
    }
    sums.into_iter().filter(|sum| sum[0] >= LEAST_PIXELS).map(blob).collect()
}

/// The dark pixels of a row as first and last plus one.
fn runs(row: &[f32], mean: &[f32], share: f32) -> Vec<[u32; 2]> {
    let mut runs: Vec<[u32; 2]> = Vec::new();
    let mut is_open = false;
    for (k, block) in row.chunks(BLOCK).enumerate() {
        let level = share * mean[k];
        for (i, v) in block.iter().enumerate() {
            let x = (k * BLOCK + i) as u32;
            match (*v < level, is_open) {
                (true, false) => runs.push([x, x + 1]),
                (true, true) => runs.iter_mut().last().into_iter().for_each(|run| run[1] = x + 1),
                _ => {}
            }
            is_open = *v < level;
        }
    }
    runs
}

/// Joins the regions of two runs. A run always points to an earlier one or itself.
fn join(joined: &mut [u32], a: u32, b: u32) {
    let mut least = |mut i: u32| {
        while joined[i as usize] != i {
            joined[i as usize] = joined[joined[i as usize] as usize];
            i = joined[i as usize];
        }
        i
    };
    let (a, b) = (least(a), least(b));
    joined[a.max(b) as usize] = a.min(b);
}

/// Number of pixels, then sums of x, y, xx, xy, yy over the pixels' centres.
fn moments([from, to]: [u32; 2], y: usize) -> [f64; 6] {
    let (n, y) = (f64::from(to - from), y as f64 + 0.5);
    let middle = 0.5 * f64::from(from + to);
    // A pixel is a square of variance 1/12, a run of n pixels has n^2/12 along it.
    [n, n * middle, n * y, n * (middle * middle + n * n / 12.0), n * middle * y, n * (y * y + 1.0 / 12.0)]
}

fn blob([area, x, y, xx, xy, yy]: [f64; 6]) -> Blob {
    let (mx, my) = (x / area, y / area);
    Blob { area, centre: Point::new(mx, my), spread: [xx / area - mx * mx, xy / area - mx * my, yy / area - my * my] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::Elementary as _;

    #[test]
    fn a_disc_is_full_and_a_ring_is_not() {
        let picture = Raster::from_fn(203, 101, |x, y| {
            let r = |cx: f64| (x as f64 + 0.5 - cx).hypotenuse(y as f64 + 0.5 - 50.0);
            let is_dark = r(50.0) < 20.0 || (14.0..20.0).contains(&r(150.0));
            if is_dark { 0.1 } else { 0.8 }
        });
        let blobs = dark_blobs(&picture, &local_mean(&picture, 40), 0.7);
        assert_eq!(blobs.len(), 2);
        assert!((blobs[0].fullness() - 1.0).abs() < 0.01 && blobs[0].centre.distance(Point::new(50.0, 50.0)) < 0.01);
        assert!((blobs[1].fullness() - (400.0 - 196.0) / (400.0 + 196.0)).abs() < 0.01);
        assert!((blobs[0].distance(Point::new(60.0, 50.0)) - 1.0).abs() < 0.01);
    }

    #[test]
    fn regions_that_meet_late_are_one() {
        let rows = ["#.#.#..#", "#.#.#...", "###.#.##", "....##..", "#......."];
        let picture = Raster::from_fn(80, 50, |x, y| if rows[y / 10].as_bytes()[x / 10] == b'#' { 0.0 } else { 1.0 });
        let areas: Vec<f64> = dark_blobs(&picture, &Raster::filled(10, 7, 1.0), 0.5).iter().map(|blob| blob.area).collect();
        // A comb, a hook, a square, and two squares side by side that touch the hook by a corner only.
        assert_eq!(areas, [700.0, 500.0, 100.0, 200.0, 100.0]);
    }
}
