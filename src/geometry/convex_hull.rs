//! The convex hull.

use super::Point;

/// The corners of the convex hull, in order (Andrew's monotone chain).
pub fn convex_hull(mut points: Vec<Point>) -> Vec<Point> {
    points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let half = |points: &mut dyn Iterator<Item = &Point>| {
        let mut chain: Vec<Point> = Vec::new();
        for &p in points {
            while let [.., a, b] = chain[..]
                && (b - a).cross(p - b) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let (mut lower, upper) = (half(&mut points.iter()), half(&mut points.iter().rev()));
    lower.extend(upper);
    lower
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_leaves_out_what_is_within() {
        let corners = [(0.0, 0.0), (4.0, 0.0), (2.0, 1.0), (4.0, 4.0), (0.0, 4.0)].map(Point::from).to_vec();
        let hull = convex_hull(corners);
        assert_eq!(hull.len(), 4);
        assert!(!hull.contains(&Point::new(2.0, 1.0)));
    }
}
