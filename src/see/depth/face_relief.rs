//! A face's own relief, from the depths of its landmarks.

use super::centre;
use crate::elementary::Elementary as _;
use crate::field::{BSpline, Datum, multilevel_b_spline, nearest_seed};
use crate::geometry::{Point, Rect};
use crate::raster::{Raster, filled_polygon};
use crate::source::Landmarks;
use crate::source::outlines::OVAL;

/// The relief of one face, in pixels.
pub(super) struct FaceRelief {
    surface: BSpline,
    /// Where the relief is defined.
    bounds: Rect,
    oval: Vec<[f64; 2]>,
    seam: f64,
}

impl FaceRelief {
    pub(super) fn new(face: &Landmarks) -> Self {
        /// Spacing of the surface's finest knots in widths of the face. Landmarks are a tenth apart on cheeks and brow: finer
        /// knots leave a dimple at each.
        const FINEST: f64 = 0.07;
        /// Margin around the outline, in widths of the face.
        const ROOM: f64 = 0.1;
        /// Width of the fade-in from the outline inwards, in widths of the face.
        const SEAM: f64 = 0.12;
        let width = face.width().max(1.0);
        let outline = face.line(&OVAL);
        let first = Rect::from_points(outline[0], outline[0]);
        let bounds = outline.iter().fold(first, |bounds, p| bounds.union_pt(*p)).inset(ROOM * width).expand();
        let data: Vec<Datum> = seen(&face.points, width)
            .map(|[x, y, z]| Datum {
                position: Point::new(x - bounds.x0, y - bounds.y0),
                value: [-z as f32, 0.0, 0.0],
                weight: 1.0,
            })
            .collect();
        let surface = multilevel_b_spline(&data, bounds.width(), bounds.height(), (FINEST * width).max(1.0));
        let oval = outline.iter().map(|p| [p.x, p.y]).collect();
        Self { surface, bounds, oval, seam: SEAM * width }
    }

    /// Adds to `steps` the difference between the face's slopes and those of `base`: to the pixel on the right, and to the one
    /// below.
    pub(super) fn lay(&self, base: &Raster<f32>, steps: &mut Raster<[f32; 2]>) {
        let (width, height) = (base.width(), base.height());
        let inside = filled_polygon(width, height, &self.oval);
        let border = nearest_seed(&inside.map(|inside| 1 - inside));
        let share = Raster::from_fn(width, height, |x, y| {
            // A face that fills the whole picture has no border.
            let Some(border) = &border else { return 1.0 };
            let nearest = border.get(x, y) as usize;
            let away = (x as f64 - (nearest % width) as f64).hypotenuse(y as f64 - (nearest / width) as f64);
            let t = (away / self.seam).clamp(0.0, 1.0);
            (t * t * (3.0 - 2.0 * t)) as f32
        });
        let relief = Raster::from_fn(width, height, |x, y| if share.get(x, y) > 0.0 { self.at(centre(x, y)) } else { 0.0 });
        let lacking = Raster::from_fn(width, height, |x, y| {
            let here = share.get(x, y);
            let (right, below) = ((x + 1).min(width - 1), (y + 1).min(height - 1));
            let shares = [here.min(share.get(right, y)), here.min(share.get(x, below))];
            if shares == [0.0; 2] {
                return [0.0; 2];
            }
            let slope = |of: &Raster<f32>| [of.get(right, y) - of.get(x, y), of.get(x, below) - of.get(x, y)];
            let (wanted, has) = (bounded(slope(&relief)), slope(base));
            [shares[0] * (wanted[0] - has[0]), shares[1] * (wanted[1] - has[1])]
        });
        *steps = steps.zip_map(&lacking, |a, b| [a[0] + b[0], a[1] + b[1]]);
    }

    fn at(&self, p: Point) -> f32 {
        self.surface.at(Point::new(p.x - self.bounds.x0, p.y - self.bounds.y0))[0]
    }
}

/// A landmark is hidden if another within `BESIDE` is nearer by more than `BEHIND`, both in widths of the face.
const BESIDE: f64 = 0.06;
const BEHIND: f64 = 0.12;

/// The landmarks that no nearer part of the face hides.
fn seen(points: &[[f64; 3]], width: f64) -> impl Iterator<Item = [f64; 3]> {
    points.iter().copied().filter(move |[x, y, z]| {
        !points.iter().any(|[a, b, c]| *c < z - BEHIND * width && (a - x).hypotenuse(b - y) < BESIDE * width)
    })
}

/// Limit of the slopes (soft): a far cheek and the wings of a nose are steeper, which tears lines.
const STEEPEST: f32 = 1.6;

/// The slope in the same direction, limited to `STEEPEST`.
fn bounded(slope: [f32; 2]) -> [f32; 2] {
    let factor = 1.0 / (1.0 + (slope[0].powi(2) + slope[1].powi(2)) / STEEPEST.powi(2)).sqrt();
    slope.map(|v| factor * v)
}
