//! The Hough orientation filter (Wong 1999, chapter 4): the local direction of the lines in a one-bit picture.
//!
//! ```text
//!   window round a pixel      accumulator            what counts            orientation
//!     . . / . /               theta ->               cells above what       doubled angles,
//!     . / . / .      ---->   rho  . : . .    ---->   the density alone ---> weighted and
//!     / . / . .               |   . # . .            would give, top 5 %    summed
//! ```
//!
//! `rho` is anchored to the page, not to the window: a pixel then falls into the same cells for every window, and a window that moves by
//! one pixel only adds the points on one rim and drops those on the other.

use super::orientation::OrientationField;
use crate::elementary::Elementary as _;
use crate::parallel::rows_with;
use crate::raster::Raster;
use std::f64::consts::PI;

/// Maximum rank; larger excesses tie with it.
const RANKS: usize = 256;

/// The form of the filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HoughForm {
    /// A round window; counts in excess of those expected from the density of points, squared. Error of 0.6 degrees on clean lines, 1.2
    /// with a fifth of the pixels flipped.
    Round,
    /// As printed: a square window and plain counts, which are biased towards the window's diagonals.
    Thesis,
}

/// The filter's window and accumulator.
#[derive(Clone, Debug)]
pub struct HoughFilter {
    form: HoughForm,
    radius: usize,
    /// Half the window's width in each of its rows, from the uppermost.
    half_widths: Vec<usize>,
    /// Fixed-point cosine and sine of each normal's angle, from -90 degrees up.
    normals: Vec<(i32, i32)>,
    /// Cosine and sine of twice the angle of the lines themselves.
    doubled: Vec<[f32; 2]>,
    /// Cells that a window can touch at one angle.
    cells: usize,
    /// Cells stored per angle, a power of two; `rho` wraps around.
    ring: usize,
    /// For each position of the centre within its cell, the expected share of a window's points in each cell.
    expected: Vec<f32>,
}

/// One window's points: their number in total and in each cell.
struct Accumulator {
    counts: Vec<u16>,
    points: u32,
}

/// Fractional bits of the fixed-point sines and cosines; positions may then reach 60,000 pixels in either direction.
const FRACTION_BITS: u32 = 14;
/// Number of positions of a window's centre within a cell in the table of expected counts.
const CENTRE_STEPS: usize = 8;

impl HoughFilter {
    /// A window of `2 radius + 1` pixels and `angles` steps of 180 degrees; cells are one pixel wide in `rho`. The thesis makes the
    /// accumulator about as large as the window; `radius` 10 and 36 angles work well for 3 to 9 pixels between lines.
    pub fn new(form: HoughForm, radius: usize, angles: usize) -> Self {
        let reach = radius as isize;
        let half_width = |dy: isize| match form {
            HoughForm::Round => ((radius as f64 + 0.5).powi(2) - (dy * dy) as f64).sqrt() as usize,
            HoughForm::Thesis => radius,
        };
        let angle = |i: usize| -0.5 * PI + PI * i as f64 / angles as f64;
        let fixed = |v: f64| (v * f64::from(1 << FRACTION_BITS)).round() as i32;
        // A square window reaches to its corner.
        let far = match form {
            HoughForm::Round => radius as f64 + 0.5,
            HoughForm::Thesis => (radius as f64 + 0.5) * std::f64::consts::SQRT_2,
        };
        let cells = 2 * (far.ceil() as usize + 1) + 1;
        let mut filter = Self {
            form,
            radius,
            half_widths: (-reach..=reach).map(half_width).collect(),
            normals: (0..angles).map(|i| (fixed(angle(i).cosine()), fixed(angle(i).sine()))).collect(),
            doubled: (0..angles).map(|i| [-(2.0 * angle(i)).cosine() as f32, -(2.0 * angle(i)).sine() as f32]).collect(),
            cells,
            ring: cells.next_power_of_two(),
            expected: Vec::new(),
        };
        filter.expected = filter.expected_shares(far);
        filter
    }

    /// The chord of the round window over each cell, as a share of its area.
    fn expected_shares(&self, radius: f64) -> Vec<f32> {
        if self.form == HoughForm::Thesis {
            return vec![0.0; CENTRE_STEPS * self.cells];
        }
        let middle = (self.cells / 2) as f64;
        let chord = |offset: f64| 2.0 * (radius * radius - offset * offset).max(0.0).sqrt();
        let shares = |place: usize| {
            let centre = middle + (place as f64 + 0.5) / CENTRE_STEPS as f64;
            (0..self.cells).map(move |cell| {
                let strip: f64 = (0..8).map(|i| chord(cell as f64 + (f64::from(i) + 0.5) / 8.0 - centre) / 8.0).sum();
                (strip / (PI * radius * radius)) as f32
            })
        };
        (0..CENTRE_STEPS).flat_map(shares).collect()
    }

    /// `rho` of a pixel at an angle, in cells.
    fn rho(&self, angle: usize, x: isize, y: isize) -> i32 {
        let (cos, sin) = self.normals[angle];
        (x as i32 * cos + y as i32 * sin) >> FRACTION_BITS
    }

    /// The orientation of the lines around each pixel of `region`, as doubled-angle vectors whose length is the strength of the
    /// response; 0 outside the region and where there is no line. Time grows with the region and with its line pixels.
    pub fn orientations(&self, lines: &Raster<u8>, region: &Raster<u8>) -> OrientationField {
        OrientationField::new(self.in_blocks(lines, region, 1))
    }

    /// As [`HoughFilter::orientations`], once for each two by two pixels: in a quarter of the time, for a field that is smoothed.
    pub fn half_orientations(&self, lines: &Raster<u8>, region: &Raster<u8>) -> OrientationField {
        let blocks = self.in_blocks(lines, region, 2);
        OrientationField::new(Raster::from_fn(region.width(), region.height(), |x, y| {
            if region.get(x, y) != 0 { blocks.get(x / 2, y / 2) } else { [0.0; 2] }
        }))
    }

    /// The orientations at the first pixel of each block of `side` by `side` pixels in which there is any of the region.
    fn in_blocks(&self, lines: &Raster<u8>, region: &Raster<u8>, side: usize) -> Raster<[f32; 2]> {
        let (width, height) = (lines.width(), lines.height());
        let columns = width.div_ceil(side);
        let mut field = Raster::filled(columns, height.div_ceil(side), [0.0_f32; 2]);
        rows_with(
            field.pixels_mut(),
            columns,
            &|| (self.empty(), vec![0_u8; self.normals.len() * self.cells], vec![0_u32; RANKS]),
            &|(accumulator, ranks, histogram), j, row| {
                let y = side * j;
                let wanted = |i: usize| {
                    let mut rows = y..(y + side).min(height);
                    rows.any(|y| region.row(y)[side * i..(side * i + side).min(width)].iter().any(|v| *v != 0))
                };
                let (Some(first), Some(last)) = ((0..columns).find(|i| wanted(*i)), (0..columns).rfind(|i| wanted(*i))) else {
                    return;
                };
                self.fill(accumulator, lines, side * first, y);
                for (i, vector) in row.iter_mut().enumerate().take(last + 1).skip(first) {
                    if i > first {
                        (side * (i - 1) + 1..=side * i).for_each(|x| self.slide(accumulator, lines, x, y));
                    }
                    if wanted(i) && accumulator.points > 1 {
                        *vector = self.response(accumulator, side * i, y, ranks, histogram);
                    }
                }
            },
        );
        field
    }

    /// The counts of the window around a pixel, angle by angle, as held by a window that slid there along its row.
    pub fn counts(&self, lines: &Raster<u8>, x: usize, y: usize) -> Vec<u16> {
        let mut accumulator = self.empty();
        self.fill(&mut accumulator, lines, 0, y);
        (1..=x).for_each(|x| self.slide(&mut accumulator, lines, x, y));
        (0..self.normals.len()).flat_map(|angle| self.window_cells(&accumulator, angle, x, y).concat()).collect()
    }

    fn empty(&self) -> Accumulator {
        Accumulator { counts: vec![0; self.normals.len() * self.ring], points: 0 }
    }

    /// Fills the accumulator with a window's whole content.
    fn fill(&self, accumulator: &mut Accumulator, lines: &Raster<u8>, x: usize, y: usize) {
        accumulator.counts.fill(0);
        accumulator.points = 0;
        for (row, py) in self.rows(lines, y) {
            let half = self.half_widths[row];
            for px in x.saturating_sub(half)..=(x + half).min(lines.width() - 1) {
                if lines.get(px, py) != 0 {
                    self.count(accumulator, px, py, 1);
                }
            }
        }
    }

    /// Moves from the window around `(x - 1, y)` to that around `(x, y)`.
    #[inline]
    fn slide(&self, accumulator: &mut Accumulator, lines: &Raster<u8>, x: usize, y: usize) {
        for (row, py) in self.rows(lines, y) {
            let half = self.half_widths[row];
            if x + half < lines.width() && lines.get(x + half, py) != 0 {
                self.count(accumulator, x + half, py, 1);
            }
            if x > half && lines.get(x - half - 1, py) != 0 {
                self.count(accumulator, x - half - 1, py, u16::MAX);
            }
        }
    }

    /// The window's rows that lie on the raster.
    fn rows(&self, lines: &Raster<u8>, y: usize) -> impl Iterator<Item = (usize, usize)> + use<> {
        let (radius, height) = (self.radius, lines.height());
        (0..=2 * radius).filter_map(move |row| (y + row).checked_sub(radius).filter(|py| *py < height).map(|py| (row, py)))
    }

    /// Adds `change` (1, or -1 wrapped) in the cell of a point at every angle.
    #[inline]
    fn count(&self, accumulator: &mut Accumulator, x: usize, y: usize, change: u16) {
        let mask = self.ring - 1;
        let mut ring = 0;
        for &(cos, sin) in &self.normals {
            let rho = (x as i32 * cos + y as i32 * sin) >> FRACTION_BITS;
            let cell = &mut accumulator.counts[ring + (rho as usize & mask)];
            *cell = cell.wrapping_add(change);
            ring += self.ring;
        }
        accumulator.points = accumulator.points.wrapping_add_signed(i32::from(change.cast_signed()));
    }

    /// The window's cells at an angle, in two pieces of its ring.
    #[inline]
    fn window_cells<'a>(&self, accumulator: &'a Accumulator, angle: usize, x: usize, y: usize) -> [&'a [u16]; 2] {
        let first = self.rho(angle, x as isize, y as isize) - (self.cells / 2) as i32;
        let ring = &accumulator.counts[angle * self.ring..(angle + 1) * self.ring];
        let start = first as usize & (self.ring - 1);
        let whole = self.cells.min(self.ring - start);
        [&ring[start..start + whole], &ring[..self.cells - whole]]
    }

    /// The doubled-angle vector of the cells that count.
    fn response(&self, accumulator: &Accumulator, x: usize, y: usize, ranks: &mut [u8], histogram: &mut [u32]) -> [f32; 2] {
        /// The share of the highest cells that counts (Wong 1999, section 4.3).
        const TOP_SHARE: f64 = 0.05;
        /// Ranks per count of excess over the expected count.
        const RANKS_A_COUNT: f32 = 4.0;
        let points = accumulator.points as f32;
        histogram.fill(0);
        for (angle, ranks) in ranks.chunks_exact_mut(self.cells).enumerate() {
            let (cos, sin) = self.normals[angle];
            let centre = x as i32 * cos + y as i32 * sin;
            let place = ((centre >> (FRACTION_BITS - 3)) as usize) & (CENTRE_STEPS - 1);
            let expected = &self.expected[place * self.cells..(place + 1) * self.cells];
            let mut cell = 0;
            for piece in self.window_cells(accumulator, angle, x, y) {
                for count in piece {
                    // The cast makes negative values 0: a cell emptier than expected carries no information.
                    let rank = ((f32::from(*count) - points * expected[cell]) * RANKS_A_COUNT) as u8;
                    ranks[cell] = rank;
                    histogram[usize::from(rank)] += 1;
                    cell += 1;
                }
            }
        }
        let least = least_of_the_top(histogram, (TOP_SHARE * ranks.len() as f64) as u32);
        let mut sum = [0.0_f32; 2];
        for (ranks, doubled) in ranks.chunks_exact(self.cells).zip(&self.doubled) {
            let mut strength = 0;
            for rank in ranks {
                if *rank >= least {
                    strength += self.weight(*rank);
                }
            }
            sum[0] += strength as f32 * doubled[0];
            sum[1] += strength as f32 * doubled[1];
        }
        sum
    }

    fn weight(&self, rank: u8) -> u32 {
        let rank = u32::from(rank);
        if self.form == HoughForm::Round { rank * rank } else { rank }
    }
}

/// The lowest rank, at least 1, reached by at most `wanted` cells.
fn least_of_the_top(histogram: &[u32], wanted: u32) -> u8 {
    let mut above = 0;
    for rank in (1..RANKS).rev() {
        above += histogram[rank];
        if above > wanted {
            return (rank + 1).min(RANKS - 1) as u8;
        }
    }
    1
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Each window counted anew from the definition.
    fn plain_counts(filter: &HoughFilter, lines: &Raster<u8>, x: usize, y: usize) -> Vec<u16> {
        let mut counts = vec![0; filter.normals.len() * filter.cells];
        for angle in 0..filter.normals.len() {
            let first = filter.rho(angle, x as isize, y as isize) - (filter.cells / 2) as i32;
            for (row, half) in filter.half_widths.iter().enumerate() {
                for dx in -(*half as isize)..=*half as isize {
                    let (px, py) = (x as isize + dx, y as isize + row as isize - filter.radius as isize);
                    if lines.contains(px, py) && lines.get(px as usize, py as usize) != 0 {
                        counts[angle * filter.cells + (filter.rho(angle, px, py) - first) as usize] += 1;
                    }
                }
            }
        }
        counts
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(12))]
        #[test]
        fn sliding_counts_are_the_plain_ones(seed in 0_u64..1000, x in 0_usize..50, y in 0_usize..40, thesis in any::<bool>()) {
            let noise = crate::raster::paper_texture(50, 40, 3.0, seed);
            let lines = noise.map(|v| u8::from(v > 0.7));
            let form = if thesis { HoughForm::Thesis } else { HoughForm::Round };
            let filter = HoughFilter::new(form, 7, 24);
            prop_assert_eq!(filter.counts(&lines, x, y), plain_counts(&filter, &lines, x, y));
        }
    }

    #[test]
    fn half_orientations_are_those_of_every_other_pixel() {
        let lines = crate::raster::paper_texture(51, 41, 3.0, 7).map(|v| u8::from(v > 0.7));
        let region = Raster::from_fn(51, 41, |x, y| u8::from(x > 4 && (y > 9 || x > 30)));
        let filter = HoughFilter::new(HoughForm::Round, 7, 24);
        let (all, half) = (filter.orientations(&lines, &lines.map(|_| 1)), filter.half_orientations(&lines, &region));
        for (x, y) in (0..41).flat_map(|y| (0..51).map(move |x| (x, y))) {
            let expected = if region.get(x, y) == 1 { all.doubled().get(x & !1, y & !1) } else { [0.0; 2] };
            assert_eq!(half.doubled().get(x, y), expected, "{x} {y}");
        }
    }

    #[test]
    fn no_line_no_orientation() {
        let filter = HoughFilter::new(HoughForm::Round, 5, 12);
        let field = filter.orientations(&Raster::filled(20, 10, 0), &Raster::filled(20, 10, 1));
        assert!(field.doubled().pixels().iter().all(|v| *v == [0.0; 2]));
    }
}
