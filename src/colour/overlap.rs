//! How much of the paper each combination of pens covers, given how much each pen covers.

use super::bands::{BANDS, Bands};
use super::pens::MOST_PENS;

/// How marks of different pens lie to one another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Overlap {
    /// Independently of one another, as lines in a direction of their own for each pen: by chance (Demichel's equations).
    Random,
    /// Apart from one another as far as there is room, as dots that are placed together.
    Apart {
        /// How much of chance remains when the paper is just full: 0 for marks that tile it without gaps, 0.6 for round dots.
        crowded: f32,
        /// How much of chance comes back because the machine misses, 0 to 1.
        moved: f32,
    },
}

/// What remains of chance between round dots that are placed together, each where it covers the least ink, when the paper is just
/// full, and the share of it that is lost again in second layers: measured on flat patches of two to four pens.
const ROUND: f32 = 0.6;
const LAYERED: f32 = 0.35;
/// Coverage above a full paper at which it is lost.
const SECOND: f32 = 0.7;

impl Overlap {
    /// Round dots of `mark_mm` placed together, drawn by a machine whose pens miss each other by up to `registration_mm`: where
    /// marks are moved by their own width, chance rules; half of that is expected.
    pub fn round_dots(mark_mm: f64, registration_mm: f64) -> Self {
        let moved = registration_mm / mark_mm;
        let moved = if moved.is_finite() { moved.clamp(0.0, 1.0) } else { 0.0 };
        Self::Apart { crowded: ROUND, moved: 0.5 * moved as f32 }
    }
}

/// A sum over overprints, weighted by their shares of the paper, and its slopes along each pen's coverage.
#[derive(Clone, Debug)]
pub(super) struct Mixed {
    pub value: Bands,
    pub slopes: [Bands; MOST_PENS],
}

const ZERO: Bands = [0.0; BANDS];

impl Overlap {
    /// Mixes `colours` (of all overprints) at `coverages`, one per pen.
    pub(super) fn mix(self, coverages: &[f32], colours: &[Bands]) -> Mixed {
        let random = by_chance(coverages, colours);
        let Self::Apart { crowded, moved } = self else { return random };
        let apart = apart(coverages, colours);
        let total: f32 = coverages.iter().sum();
        let (placed, slope) = chance(crowded.clamp(0.0, 1.0), total);
        let still = 1.0 - moved.clamp(0.0, 1.0);
        let (chance, slope) = (1.0 - still * (1.0 - placed), still * slope);
        let mut mixed = Mixed { value: ZERO, slopes: [ZERO; MOST_PENS] };
        for band in 0..BANDS {
            mixed.value[band] = apart.value[band] + chance * (random.value[band] - apart.value[band]);
        }
        for pen in 0..coverages.len() {
            for band in 0..BANDS {
                let (a, r) = (apart.slopes[pen][band], random.slopes[pen][band]);
                mixed.slopes[pen][band] = a + chance * (r - a) + slope * (random.value[band] - apart.value[band]);
            }
        }
        mixed
    }

    /// Share of the paper under each overprint; the sum is 1, and each pen's shares add up to its coverage.
    pub fn shares(self, coverages: &[f32]) -> Vec<f32> {
        let count = coverages.len().min(MOST_PENS);
        let coverages: Vec<f32> = coverages[..count].iter().map(|c| c.clamp(0.0, 1.0)).collect();
        // One overprint at a time has the colour 1; eight fit in the bands at once.
        let mut shares = vec![0.0; 1 << count];
        for start in (0..shares.len()).step_by(BANDS) {
            let colours: Vec<Bands> =
                (0..shares.len()).map(|s| std::array::from_fn(|band| f32::from(u8::from(s == start + band)))).collect();
            let mixed = self.mix(&coverages, &colours);
            shares.iter_mut().skip(start).zip(mixed.value).for_each(|(share, v)| *share = v);
        }
        shares
    }
}

/// Share of chance at a total coverage, and its slope: none while there is little ink, `crowded` at a full paper, less beyond.
fn chance(crowded: f32, total: f32) -> (f32, f32) {
    let (filled, filling) = step(total);
    let (layered, layering) = step((total - 1.0) / SECOND);
    let rest = 1.0 - LAYERED * layered;
    (crowded * filled * rest, crowded * (filling * rest - filled * LAYERED * layering / SECOND))
}

/// A smooth step from 0 to 1, and its slope.
fn step(t: f32) -> (f32, f32) {
    let t = t.clamp(0.0, 1.0);
    (t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t))
}

/// Demichel's equations: the product of each pen's coverage, or of what it leaves bare.
fn by_chance(coverages: &[f32], colours: &[Bands]) -> Mixed {
    if coverages.len() <= 4 { folded::<8>(coverages, colours) } else { folded::<{ 1 << (MOST_PENS - 1) }>(coverages, colours) }
}

/// Folds pen by pen: with a pen's mixture taken out, half as many overprints remain, at most `HALF` after the first.
fn folded<const HALF: usize>(coverages: &[f32], colours: &[Bands]) -> Mixed {
    let mut mixed = Mixed { value: colours[0], slopes: [ZERO; MOST_PENS] };
    // Weights of the overprints of the pens that are not yet taken out.
    let mut weights = [0.0f32; 1 << MOST_PENS];
    weights[0] = 1.0;
    for (pen, c) in coverages.iter().enumerate() {
        for s in 0..1usize << pen {
            weights[s | 1 << pen] = weights[s] * c;
            weights[s] *= 1.0 - c;
        }
    }
    let mut left = [ZERO; HALF];
    for (pen, c) in coverages.iter().enumerate().rev() {
        let half = 1usize << pen;
        let is_first = pen + 1 == coverages.len();
        let slope = &mut mixed.slopes[pen];
        for s in 0..half {
            weights[s] += weights[s | half];
            let (without, with) = if is_first { (colours[s], colours[s | half]) } else { (left[s], left[s | half]) };
            for band in 0..BANDS {
                let step = with[band] - without[band];
                slope[band] += weights[s] * step;
                left[s][band] = without[band] + c * step;
            }
        }
        mixed.value = left[0];
    }
    mixed
}

/// As far apart as possible: coverages are laid end to end around a circle of length 1, so that a second layer begins only where
/// the first is full. The mean over all pens as the first.
fn apart(coverages: &[f32], colours: &[Bands]) -> Mixed {
    let count = coverages.len();
    let mut mixed = Mixed { value: ZERO, slopes: [ZERO; MOST_PENS] };
    for first in 0..count {
        add_circle(coverages, colours, first, &mut mixed);
    }
    let share = 1.0 / count as f32;
    mixed.value.iter_mut().for_each(|v| *v *= share);
    mixed.slopes[..count].iter_mut().flatten().for_each(|v| *v *= share);
    mixed
}

fn add_circle(coverages: &[f32], colours: &[Bands], first: usize, mixed: &mut Mixed) {
    let count = coverages.len();
    let mut starts = [0.0f32; MOST_PENS];
    let mut cuts = [1.0f32; MOST_PENS + 1];
    let mut end: f32 = 0.0;
    for (j, cut) in cuts[..count].iter_mut().enumerate() {
        let pen = (first + j) % count;
        starts[pen] = end - end.floor();
        end += coverages[pen];
        *cut = end - end.floor();
    }
    let ends = cuts;
    cuts[..=count].sort_unstable_by(f32::total_cmp);
    let covering = |at: f32| {
        let is_over = |pen: usize| {
            let way = at - starts[pen];
            (if way < 0.0 { way + 1.0 } else { way }) < coverages[pen]
        };
        (0..count).filter(|pen| is_over(*pen)).fold(0usize, |bits, pen| bits | 1 << pen)
    };
    let mut from = 0.0;
    for to in &cuts[..=count] {
        let length = to - from;
        if length > 0.0 {
            let colour = &colours[covering(0.5 * (from + to))];
            mixed.value.iter_mut().zip(colour).for_each(|(v, c)| *v += length * c);
        }
        from = *to;
    }
    // A longer arc moves its own end and all that follow.
    let mut moved = ZERO;
    for j in (0..count).rev() {
        let pen = (first + j) % count;
        let next = if j + 1 < count { 1usize << ((first + j + 1) % count) } else { 0 };
        let others = covering(ends[j]) & !(1 << pen) & !next;
        let (before, after) = (&colours[others | 1 << pen], &colours[others | next]);
        for band in 0..BANDS {
            moved[band] += before[band] - after[band];
            mixed.slopes[pen][band] += moved[band];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAWS: [Overlap; 3] =
        [Overlap::Random, Overlap::Apart { crowded: 0.6, moved: 0.25 }, Overlap::Apart { crowded: 0.0, moved: 0.0 }];

    #[test]
    fn shares_add_up() {
        for law in LAWS {
            for coverages in [&[0.3, 0.2, 0.1][..], &[0.9, 0.8, 0.4, 0.7], &[1.0, 0.0, 1.0], &[0.2], &[0.25; 8], &[0.0, 0.0]] {
                let shares = law.shares(coverages);
                assert!((shares.iter().sum::<f32>() - 1.0).abs() < 1e-5 && shares.iter().all(|v| *v > -1e-6));
                for (pen, c) in coverages.iter().enumerate() {
                    let own: f32 = (0..shares.len()).filter(|s| s >> pen & 1 == 1).map(|s| shares[s]).sum();
                    assert!((own - c).abs() < 1e-5, "{law:?} {coverages:?} {pen} {own}");
                }
            }
        }
    }

    #[test]
    fn marks_apart_overlap_only_where_they_must() {
        let tiles = Overlap::Apart { crowded: 0.0, moved: 0.0 };
        assert!(tiles.shares(&[0.5, 0.4])[3] < 1e-6);
        assert!((tiles.shares(&[0.7, 0.7])[3] - 0.4).abs() < 1e-6);
        assert!((Overlap::Random.shares(&[0.5, 0.4])[3] - 0.2).abs() < 1e-6);
        let round = Overlap::round_dots(0.3, 0.0).shares(&[0.5, 0.4])[3];
        assert!(round > 0.05 && round < 0.15);
    }

    #[test]
    fn slopes_are_those_of_the_value() {
        let colours: Vec<Bands> =
            (0..16u32).map(|s| std::array::from_fn(|b| ((s * 7 + b as u32 * 3) % 11) as f32 / 11.0)).collect();
        for law in LAWS {
            for at in [[0.3, 0.1, 0.2, 0.15], [0.6, 0.5, 0.33, 0.21], [0.05, 0.02, 0.9, 0.4]] {
                let here = law.mix(&at, &colours);
                for pen in 0..4 {
                    let (mut up, mut down) = (at, at);
                    up[pen] += 1e-3;
                    down[pen] -= 1e-3;
                    let (up, down) = (law.mix(&up, &colours), law.mix(&down, &colours));
                    for band in 0..BANDS {
                        let slope = (up.value[band] - down.value[band]) / 2e-3;
                        assert!((slope - here.slopes[pen][band]).abs() < 5e-3, "{law:?} {at:?} {pen}");
                    }
                }
            }
        }
    }
}
