//! Hand shading: a chain of arcs drawn back and forth, as a hand swings about the wrist (Wong 1999, section 6.2).
//!
//! ```text
//!   start 1 ----------------> end 1       each arc begins at the end of the last one, turned about that
//!          <---------------- /            point by atan(2 spacing / chord); midpoints lie one spacing
//!   start 3 ----------------> end 3       apart on average
//! ```

use crate::elementary::{Elementary as _, unit_at};
use kurbo::{Point, Vec2};
use rand::{Rng, RngExt};

/// A chain of arcs. Lengths are in any one unit, angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandShading {
    /// The middle of the first arc (`arc_center`).
    pub centre: Point,
    /// Mean length of an arc (`arc_length`), above 0.
    pub length: f64,
    /// Radius of the arcs (`arc_radius`); at least a third of the length.
    pub radius: f64,
    /// Direction of the arcs' chords (`arc_orient`); the chain moves on towards this plus 90 degrees.
    pub orientation: f64,
    /// Mean distance between the midpoints of neighbouring arcs (`arc_dist`), above 0.
    pub spacing: f64,
    /// Number of arcs (`arc_number`).
    pub count: usize,
    /// Random variation of length and turn, as a fraction: 0 for a machine's regularity, 0.15 for a hand's.
    pub skew: f64,
}

/// Segments per arc: enough that the chord error is below a thousandth of the radius.
const SEGMENTS_PER_ARC: usize = 12;

impl HandShading {
    /// The arcs in drawing order, each from its start to its end, which is the start of the next.
    ///
    /// In the thesis the random skews add up, so a chain of a hundred arcs drifts by its own length. Here each end varies about
    /// its nominal position on the chain's border, so skews stay local and the mean spacing is exact.
    pub fn arcs(&self, random: &mut impl Rng) -> Vec<Vec<Point>> {
        let radius = self.radius.max(self.length / 3.0);
        let chord = 2.0 * radius * (0.5 * self.length / radius).sine();
        let along = unit_at(self.orientation);
        let across = Vec2::new(-along.y, along.x);
        // The thesis's turn moves an end by chord * sin(turn), two spacings to first order.
        let turn = (2.0 * self.spacing / chord).arc_tangent();
        let step = chord * turn.tangent();
        let mut vary = |size: f64| if self.skew > 0.0 { random.random_range(-self.skew..self.skew) * size } else { 0.0 };
        let mut from = self.centre - along * (0.5 * chord);
        // Distance of the ends along either border so far, the start's border first.
        let mut moved = [0.0, 0.0];
        (0..self.count)
            .map(|i| {
                let side = (i + 1) % 2;
                if i > 0 {
                    moved[side] += step;
                }
                let reach = if side == 1 { 0.5 } else { -0.5 } * chord + vary(chord);
                let to = self.centre + along * reach + across * (moved[side] + vary(step));
                let arc = arc(from, to, radius, across);
                from = to;
                arc
            })
            .collect()
    }
}

/// The minor arc of a radius between two points that bulges towards `side`.
fn arc(from: Point, to: Point, radius: f64, side: Vec2) -> Vec<Point> {
    let chord = to - from;
    let half = 0.5 * chord.hypot();
    let normal = Vec2::new(-chord.y, chord.x) / (2.0 * half).max(1e-12);
    let normal = if normal.dot(side) < 0.0 { -normal } else { normal };
    let radius = radius.max(half);
    let depth = (radius * radius - half * half).sqrt();
    let between = (1..SEGMENTS_PER_ARC).map(|i| {
        let t = i as f64 / SEGMENTS_PER_ARC as f64;
        let x = (2.0 * t - 1.0) * half;
        let rise = (radius * radius - x * x).max(0.0).sqrt() - depth;
        from + chord * t + normal * rise
    });
    std::iter::once(from).chain(between).chain([to]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand::rngs::ChaCha8Rng;

    const SHADING: HandShading = HandShading {
        centre: Point::new(20.0, 10.0),
        length: 12.0,
        radius: 20.0,
        orientation: 0.5,
        spacing: 0.8,
        count: 200,
        skew: 0.1,
    };

    fn midpoint(arc: &[Point]) -> Point {
        arc[arc.len() / 2]
    }

    #[test]
    fn arcs_share_their_ends_and_have_the_asked_spacing_and_length() {
        let arcs = SHADING.arcs(&mut ChaCha8Rng::seed_from_u64(4));
        assert_eq!(arcs.len(), 200);
        for pair in arcs.windows(2) {
            assert_eq!(pair[0].last(), pair[1].first());
        }
        let across = Vec2::new(-SHADING.orientation.sine(), SHADING.orientation.cosine());
        let way = (midpoint(&arcs[199]) - midpoint(&arcs[0])).dot(across);
        assert!((way / 199.0 / SHADING.spacing - 1.0).abs() < 0.01, "spacing {}", way / 199.0);
        let mean = arcs.iter().map(|arc| crate::geometry::polyline_length(arc)).sum::<f64>() / 200.0;
        assert!((mean / SHADING.length - 1.0).abs() < 0.02, "length {mean}");
    }

    #[test]
    fn without_skew_the_turn_is_the_printed_one() {
        let arcs = HandShading { skew: 0.0, ..SHADING }.arcs(&mut ChaCha8Rng::seed_from_u64(4));
        let chord = |arc: &[Point]| arc[arc.len() - 1] - arc[0];
        let (first, second) = (chord(&arcs[0]), -chord(&arcs[1]));
        let turn = (first.cross(second) / (first.hypot() * second.hypot())).arc_sine().abs();
        let printed = (2.0 * SHADING.spacing / first.hypot()).arc_tangent();
        assert!((turn - printed).abs() < 1e-9, "{turn} for {printed}");
    }
}
