//! Candidates for corner marks: a ring with a disc in its middle.

use super::blobs::Blob;
use crate::colour::sheet::grid::{DISC, HOLE, RING};
use crate::elementary::Elementary as _;

/// A ring with something round in its middle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mark {
    /// The ring.
    pub ring: Blob,
    /// Difference from the drawn mark, 0 for none.
    pub fault: f64,
}

/// Fullness of the ring, and of the discs with and without hole, by their radii.
const FULL_RING: f64 = fullness(RING[0], RING[1]);
const FULL_DISC: [f64; 2] = [fullness(DISC, 0.0), fullness(DISC, HOLE)];
/// How far fullness may lie off: blur and threshold widen or thin ink.
const RING_TOLERANCE: [f64; 2] = [0.5, 1.7];
const DISC_TOLERANCE: [f64; 2] = [0.75, 1.12];
/// Largest distance of the two centres, in standard deviations of the ring.
const OFF_CENTRE: f64 = 0.3;
/// Size of the ring relative to the disc, by their radii, and how far it may lie off.
const SIZES: [f64; 2] = [3.5, 22.0];
/// Most marks that are kept, those most like the drawn one.
const MOST: usize = 150;

const fn fullness(outer: f64, inner: f64) -> f64 {
    (outer * outer - inner * inner) / (outer * outer + inner * inner)
}

/// The marks among blobs, the best first.
pub(super) fn marks(blobs: &[Blob]) -> Vec<Mark> {
    let is_disc = |blob: &&Blob| {
        let full = blob.fullness();
        full > FULL_DISC[1] * DISC_TOLERANCE[0] && full < FULL_DISC[0] * DISC_TOLERANCE[1]
    };
    let mut discs: Vec<&Blob> = blobs.iter().filter(is_disc).collect();
    discs.sort_by(|a, b| a.centre.x.total_cmp(&b.centre.x));
    let rings = blobs.iter().filter(|blob| {
        let full = blob.fullness() / FULL_RING;
        full > RING_TOLERANCE[0] && full < RING_TOLERANCE[1]
    });
    let mut marks: Vec<Mark> = rings.filter_map(|ring| mark(ring, &discs)).collect();
    marks.sort_by(|a, b| a.fault.total_cmp(&b.fault));
    marks.truncate(MOST);
    marks
}

/// The ring with the best disc in it; `discs` from left to right.
fn mark(ring: &Blob, discs: &[&Blob]) -> Option<Mark> {
    let reach = OFF_CENTRE * ring.spread[0].max(ring.spread[2]).sqrt();
    let first = discs.partition_point(|disc| disc.centre.x < ring.centre.x - reach);
    let near = discs[first..].iter().take_while(|disc| disc.centre.x <= ring.centre.x + reach);
    let faults = near.filter_map(|disc| {
        let (off, sizes) = (ring.distance(disc.centre), ring.size() / disc.size().max(1e-9));
        let fits = off < OFF_CENTRE && (SIZES[0]..SIZES[1]).contains(&sizes);
        fits.then(|| {
            off / OFF_CENTRE
                + 0.5 * (sizes / expected_sizes()).logarithm().abs()
                + (ring.fullness() / FULL_RING).logarithm().abs()
        })
    });
    faults.reduce(f64::min).map(|fault| Mark { ring: *ring, fault })
}

/// Size of the ring relative to the full disc.
fn expected_sizes() -> f64 {
    (RING[0] * RING[0] + RING[1] * RING[1]) / (DISC * DISC)
}

#[cfg(test)]
mod tests {
    use super::super::blobs::{dark_blobs, local_mean};
    use super::*;
    use crate::raster::Raster;

    #[test]
    fn a_ring_with_a_disc_is_a_mark_and_others_are_not() {
        // A leaning mark, a ring alone, a disc alone, and a ring with a speck.
        let inked = |r: f64, disc: f64, ring: bool| r < disc || (ring && (RING[1]..RING[0]).contains(&r));
        let picture = Raster::from_fn(480, 120, |x, y| {
            let at =
                |cx: f64| ((x as f64 + 0.5 - cx - 0.3 * (y as f64 - 60.0)) / 90.0).hypotenuse((y as f64 + 0.5 - 60.0) / 90.0);
            let is_dark = inked(at(60.0), DISC, true)
                || inked(at(180.0), 0.0, true)
                || inked(at(300.0), DISC, false)
                || inked(at(420.0), 0.05, true);
            if is_dark { 0.2 } else { 0.9 }
        });
        let marks = marks(&dark_blobs(&picture, &local_mean(&picture, 60), 0.8));
        assert_eq!(marks.len(), 1);
        assert!((marks[0].ring.centre.x - 60.0).abs() < 0.5 && marks[0].fault < 0.2, "{marks:?}");
    }
}
