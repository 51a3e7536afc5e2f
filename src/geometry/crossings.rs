//! Counts the crossings of an outline's borders, to estimate the work of untangling it beforehand.

use kurbo::Point;

/// The counts, up to where counting stopped.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Crossings {
    /// Pairs of edges that cross; touching ends do not count.
    pub crossings: usize,
    /// Pairs of edges that were compared.
    pub pairs: usize,
}

#[derive(Clone, Copy)]
struct Edge {
    a: Point,
    b: Point,
}

impl Edge {
    fn left(self) -> f64 {
        self.a.x.min(self.b.x)
    }

    fn right(self) -> f64 {
        self.a.x.max(self.b.x)
    }

    fn crosses(self, other: Self) -> bool {
        let side = |of: Self, p: Point| (of.b - of.a).cross(p - of.a);
        let apart = |of: Self, by: Self| side(of, by.a) * side(of, by.b) < 0.0;
        self.a.y.max(self.b.y) >= other.a.y.min(other.b.y)
            && other.a.y.max(other.b.y) >= self.a.y.min(self.b.y)
            && apart(self, other)
            && apart(other, self)
    }
}

/// Counts the crossings of closed polygons, in a sweep along x. Stops after more than `most` crossings or `500 * most` pairs.
pub fn crossings<'a>(polygons: impl IntoIterator<Item = &'a Vec<Point>>, most: usize) -> Crossings {
    let sides = |polygon: &'a Vec<Point>| (0..polygon.len()).map(|i| Edge { a: polygon[i], b: polygon[(i + 1) % polygon.len()] });
    let mut edges: Vec<Edge> = polygons.into_iter().flat_map(sides).collect();
    edges.sort_by(|a, b| a.left().total_cmp(&b.left()));
    let mut found = Crossings::default();
    let mut open: Vec<Edge> = Vec::new();
    for edge in edges {
        open.retain(|other| other.right() >= edge.left());
        found.pairs += open.len();
        found.crossings += open.iter().filter(|other| edge.crosses(**other)).count();
        if found.crossings > most || found.pairs > most.saturating_mul(500) {
            break;
        }
        open.push(edge);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::Elementary as _;

    #[test]
    fn a_star_crosses_itself_five_times_and_a_square_never() {
        let star: Vec<Point> = (0..5)
            .map(|i| f64::from(i) * 0.8 * std::f64::consts::PI)
            .map(|angle| Point::new(angle.cosine(), angle.sine()))
            .collect();
        let square = [(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0)].map(Point::from).to_vec();
        assert_eq!(crossings([&star], 1000).crossings, 5);
        assert_eq!(crossings([&square], 1000).crossings, 0);
        // Only its lower left corner overlaps the square, so two sides of the square pass through it.
        assert!(crossings([&star, &square], 1000).crossings > 5);
        assert!(crossings([&star, &star, &square], 3).crossings <= 10, "the count stops");
    }
}
