//! Guided filtering of several planes by one picture (He, Sun and Tang 2010), also to a finer size (He and Sun 2015): the linear
//! functions of colour are fitted on the small picture and evaluated at the large one's colours.

use crate::raster::{Raster, box_blur_each};

/// For each pixel the least-squares slopes for red, green and blue, then the offset.
pub(super) type Lines = Raster<[f32; 4]>;

/// Window statistics of a picture's colours, for one window size.
pub(super) struct Guide<'a> {
    colours: &'a Raster<[f32; 3]>,
    radius: usize,
    means: Raster<[f32; 3]>,
    /// The upper triangle of the inverse covariance of the colours in the window.
    inverse: Raster<[f32; 6]>,
}

impl<'a> Guide<'a> {
    /// Colours are 0 to 1. Edges of a contrast well below the root of `eps` are ignored.
    pub(super) fn new(colours: &'a Raster<[f32; 3]>, radius: usize, eps: f32) -> Self {
        let means = box_blur_each(colours, radius);
        let squares = box_blur_each(&colours.map(|c| PAIRS.map(|(i, j)| c[i] * c[j])), radius);
        let inverse = means.zip_map(&squares, |m, squares| {
            let mut spread = [0.0; 6];
            for (k, (i, j)) in PAIRS.into_iter().enumerate() {
                let own = if i == j { eps } else { 0.0 };
                spread[k] = f64::from(squares[k] - m[i] * m[j] + own);
            }
            inverse(spread)
        });
        Self { colours, radius, means, inverse }
    }

    /// The linear functions of colour closest to a plane, each averaged over the windows that contain the pixel.
    pub(super) fn lines(&self, plane: &Raster<f32>) -> Lines {
        let with_colour = box_blur_each(&self.colours.zip_map(plane, |[r, g, b], v| [r * v, g * v, b * v, v]), self.radius);
        let lines = Raster::from_fn(plane.width(), plane.height(), |x, y| {
            let (m, s) = (self.means.get(x, y), self.inverse.get(x, y));
            let [.., mean] = with_colour.get(x, y);
            let beyond_means = |k: usize| with_colour.get(x, y)[k] - m[k] * mean;
            let c = [beyond_means(0), beyond_means(1), beyond_means(2)];
            let slope = [
                s[0] * c[0] + s[1] * c[1] + s[2] * c[2],
                s[1] * c[0] + s[3] * c[1] + s[4] * c[2],
                s[2] * c[0] + s[4] * c[1] + s[5] * c[2],
            ];
            [slope[0], slope[1], slope[2], mean - slope[0] * m[0] - slope[1] * m[1] - slope[2] * m[2]]
        });
        box_blur_each(&lines, self.radius)
    }

    /// A plane of values 0 to 1, smoothed along the picture's edges.
    pub(super) fn filtered(&self, plane: &Raster<f32>) -> Raster<f32> {
        self.lines(plane).zip_map(self.colours, value)
    }
}

/// The value of a linear function at a colour, clamped to 0 to 1.
#[inline]
pub(super) fn value(line: [f32; 4], colour: [f32; 3]) -> f32 {
    (line[0] * colour[0] + line[1] * colour[1] + line[2] * colour[2] + line[3]).clamp(0.0, 1.0)
}

/// Rows and columns of a symmetric matrix's upper triangle.
const PAIRS: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];

/// The upper triangle of the inverse of a symmetric matrix, from its upper triangle.
fn inverse([rr, rg, rb, gg, gb, bb]: [f64; 6]) -> [f32; 6] {
    let cofactors = [gg * bb - gb * gb, gb * rb - rg * bb, rg * gb - gg * rb];
    let determinant = rr * cofactors[0] + rg * cofactors[1] + rb * cofactors[2];
    if determinant.abs() < f64::MIN_POSITIVE {
        return [0.0; 6];
    }
    let rest = [rr * bb - rb * rb, rg * rb - rr * gb, rr * gg - rg * rg];
    [cofactors[0], cofactors[1], cofactors[2], rest[0], rest[1], rest[2]].map(|v| (v / determinant) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::guided_filter;

    #[test]
    fn it_is_the_guided_filter() {
        let guide = Raster::from_fn(40, 30, |x, y| [x as f32 / 40.0, ((x * y) % 7) as f32 / 7.0, f32::from(u8::from(y > 12))]);
        let plane = Raster::from_fn(40, 30, |x, y| f32::from(u8::from(x + y > 30)));
        let (ours, theirs) = (Guide::new(&guide, 3, 1e-3).filtered(&plane), guided_filter(&guide, &plane, 3, 1e-3));
        assert!(ours.pixels().iter().zip(theirs.pixels()).all(|(a, b)| (a - b).abs() < 2e-3));
    }
}
