//! A monotone curve through points.

/// The shape-preserving cubic (Fritsch and Carlson 1980) through points of ascending x and y; linear beyond its ends.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    points: Vec<[f32; 2]>,
    slopes: Vec<f32>,
}

impl Curve {
    pub(super) fn through(points: &[[f32; 2]]) -> Self {
        let last = points.len() - 1;
        let slope = |i: usize| (points[i + 1][1] - points[i][1]) / (points[i + 1][0] - points[i][0]);
        let slopes = (0..points.len())
            .map(|i| {
                if i == 0 || i == last {
                    return slope(i.min(last - 1));
                }
                let (before, after) = (slope(i - 1), slope(i));
                if before * after <= 0.0 {
                    return 0.0;
                }
                let (left, right) = (points[i][0] - points[i - 1][0], points[i + 1][0] - points[i][0]);
                let (a, b) = (2.0 * right + left, right + 2.0 * left);
                (a + b) / (a / before + b / after)
            })
            .collect();
        Self { points: points.to_vec(), slopes }
    }

    pub(super) fn at(&self, x: f32) -> f32 {
        let last = self.points.len() - 1;
        let ([x0, y0], [x1, y1]) = (self.points[0], self.points[last]);
        if x <= x0 {
            return y0 + self.slopes[0] * (x - x0);
        }
        if x >= x1 {
            return y1 + self.slopes[last] * (x - x1);
        }
        let i = self.points.partition_point(|p| p[0] <= x) - 1;
        let ([xa, ya], [xb, yb]) = (self.points[i], self.points[i + 1]);
        let (width, t) = (xb - xa, (x - xa) / (xb - xa));
        let (t2, t3) = (t * t, t * t * t);
        (2.0 * t3 - 3.0 * t2 + 1.0) * ya
            + (t3 - 2.0 * t2 + t) * width * self.slopes[i]
            + (3.0 * t2 - 2.0 * t3) * yb
            + (t3 - t2) * width * self.slopes[i + 1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_passes_its_points_and_never_falls() {
        let points = [[0.0, 0.06], [0.1, 0.19], [0.35, 0.54], [0.5, 0.955], [0.56, 1.0]];
        let curve = Curve::through(&points);
        assert!(points.iter().all(|p| (curve.at(p[0]) - p[1]).abs() < 1e-6));
        let values: Vec<f32> = (-20..120).map(|i| curve.at(i as f32 / 100.0)).collect();
        assert!(values.windows(2).all(|pair| pair[1] >= pair[0]));
    }
}
