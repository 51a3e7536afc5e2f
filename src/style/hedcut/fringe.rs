//! The ends of hair on skin: strands that a border crosses run out beyond it, each as far as it likes. Cut along the border, hair is a cap.

use super::Drawer;
use super::parts::Parts;
use crate::drawing::{Mark, Stroke, Width};
use crate::geometry::{Point, Ring, Vec2, catmull_rom};
use crate::source::MaskRole;
use crate::style::random::stream;
use rand::RngExt;

/// How far strands run out, at most, in pitches.
const FARTHEST: f64 = 2.0;
/// Shorter ends are left as they are.
const LEAST: f64 = 0.4;
/// How far before its end a strand begins to taper anew, and how far beyond it lies what the strand runs into, in pitches.
const BEFORE: f64 = 1.2;
const AHEAD: f64 = 0.8;
/// The widest that a strand is where it leaves the hair, in pitches, and at its tip as a share of that.
const WIDEST: f64 = 0.4;
const TIP: f64 = 0.2;
/// Distance of the nodes in pitches.
const NODE: f64 = 0.4;
/// Values of masks from which a place is skin.
const LEAST_SUBJECT: f32 = 0.95;
const MOST_OTHER: f32 = 0.3;

impl Drawer<'_> {
    /// Strokes of hair with ends that run out on the skin.
    pub(super) fn with_fringe(&self, marks: Vec<Mark>, parts: &Parts) -> Vec<Mark> {
        let fringed = |(i, mark)| match mark {
            Mark::Stroke(stroke) => Mark::Stroke(self.fringed(stroke, parts, i as u64)),
            other => other,
        };
        marks.into_iter().enumerate().map(fringed).collect()
    }

    fn fringed(&self, stroke: Stroke, parts: &Parts, index: u64) -> Stroke {
        let Width::Along(widths) = stroke.width() else { return stroke };
        let mut strand = Strand { places: stroke.nodes().collect(), widths: widths.clone() };
        if strand.places.len() < 3 || strand.places.len() != strand.widths.len() {
            return stroke;
        }
        let mut random = stream(self.seed, "fringe", index);
        let mut is_longer = false;
        for _ in 0..2 {
            let length: f64 = FARTHEST * random.random_range(0.0..1.0);
            if length >= LEAST && self.runs_into_skin(&strand, length, parts) {
                strand.run_out(length * self.parameters.pitch.0, self.parameters.pitch.0);
                is_longer = true;
            }
            strand.places.reverse();
            strand.widths.reverse();
        }
        if !is_longer {
            return stroke;
        }
        let longer = Stroke::swelling(catmull_rom(&strand.places, Ring::Open), strand.widths);
        longer.map_or_else(|| stroke.clone(), |longer| longer.like(&stroke))
    }

    /// True if there is skin beyond the end of a strand, and at the end that it would have.
    fn runs_into_skin(&self, strand: &Strand, length: f64, parts: &Parts) -> bool {
        let end = strand.places[strand.places.len() - 1];
        let along = strand.heading();
        let detail = self.portrait.masks.get(&MaskRole::Detail);
        [AHEAD, length.max(AHEAD)].into_iter().all(|away| {
            let p = self.portrait.placement.to_grid(end + away * self.parameters.pitch.0 * along);
            self.portrait.subject.sample(p.x, p.y) > LEAST_SUBJECT
                && parts.hair_at(p) < MOST_OTHER
                && parts.cloth_at(p) < MOST_OTHER
                && detail.is_none_or(|detail| detail.sample(p.x, p.y) < MOST_OTHER)
        })
    }
}

/// A stroke of hair on the page, and its width at each node.
struct Strand {
    places: Vec<Point>,
    widths: Vec<f64>,
}

impl Strand {
    /// The direction of its last part.
    fn heading(&self) -> Vec2 {
        let count = self.places.len();
        let along = self.places[count - 1] - self.places[count.saturating_sub(4)];
        along / along.hypot().max(1e-9)
    }

    /// Goes on beyond its end, all in millimetres.
    fn run_out(&mut self, length: f64, pitch: f64) {
        let (end, along) = (self.places[self.places.len() - 1], self.heading());
        while self.places.len() > 2 && self.places[self.places.len() - 1].distance(end) < BEFORE * pitch {
            self.places.pop();
            self.widths.pop();
        }
        let (from, width) = (self.places[self.places.len() - 1], self.widths[self.widths.len() - 1].min(WIDEST * pitch));
        let to = end + length * along;
        let count = (from.distance(to) / (NODE * pitch)).ceil().max(2.0);
        for i in 1..=count as usize {
            let share = i as f64 / count;
            // By way of the former end, so that it bends as it did.
            let bent = from.lerp(end, share).lerp(end.lerp(to, share), share);
            self.places.push(bent);
            self.widths.push(width * (1.0 - (1.0 - TIP) * share));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strand_goes_on_as_it_ran_and_tapers() {
        let places: Vec<Point> = (0..10).map(|i| Point::new(f64::from(i), 0.0)).collect();
        let mut strand = Strand { places, widths: vec![0.3; 10] };
        strand.run_out(2.0, 1.0);
        let end = strand.places[strand.places.len() - 1];
        assert!((end.x - 11.0).abs() < 1e-9 && end.y.abs() < 1e-9 && strand.places.len() == strand.widths.len());
        let last = &strand.widths[strand.widths.len() - 5..];
        assert!(last.windows(2).all(|w| w[1] < w[0]) && (last[4] - 0.06).abs() < 1e-9, "{last:?}");
    }
}
