//! The flow that strokes follow: a unit vector at each pixel, at a fixed angle to the gradient (Papari 2009, equation 7.10).

use crate::elementary::Elementary as _;
use crate::geometry::{Point, Vec2};
use crate::raster::{Raster, fast_gaussian};

/// Squared gradient (per pixel, of values 0 to 1) below which a pixel has no direction: rounding in the blur makes up to 1e-13,
/// the faintest sky that 16 bits can hold 1e-9.
const LEAST_SQUARED_GRADIENT: f32 = 1e-10;
/// Minimum luminance gradient, as a share of the colour gradient, that gives it a sign.
const LEAST_LUMINANCE_SHARE: f32 = 0.05;
/// Blurs, in pixels, that spread signs and directions over growing distances.
const SPREADING_BLURS: [f32; 5] = [1.0, 4.0, 16.0, 64.0, 256.0];

/// Unit vectors at the pixels' centres, zero where there is no direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Flow {
    directions: Raster<[f32; 2]>,
}

impl Flow {
    /// Vectors of any length; those shorter than 1e-12 count as none.
    pub fn new(vectors: &Raster<[f32; 2]>) -> Self {
        Self { directions: vectors.map(unit) }
    }

    /// A field given by its vector at a place in pixels.
    pub fn from_fn(width: usize, height: usize, vector: impl Fn(Point) -> Vec2 + Sync) -> Self {
        Self::new(&Raster::from_fn(width, height, |x, y| {
            let v = vector(Point::new(x as f64 + 0.5, y as f64 + 0.5));
            [v.x as f32, v.y as f32]
        }))
    }

    /// The direction of steepest change of a colour picture: the eigenvector of the structure tensor's larger eigenvalue (equation
    /// 7.14), pointing to growing luminance. Where luminance does not change along it, the sign comes from the surrounding pixels.
    pub fn steepest(tensor: &Raster<[f32; 3]>, luminance: &Raster<[f32; 2]>) -> Self {
        let axes = tensor.map(principal_axis);
        let mut signed = axes.zip_map(luminance, |axis, slope| {
            let along = axis[0] * slope[0] + axis[1] * slope[1];
            let is_clear = along.abs() > LEAST_LUMINANCE_SHARE * (axis[0] * axis[0] + axis[1] * axis[1]);
            if is_clear { [axis[0] * along.signum(), axis[1] * along.signum()] } else { [0.0; 2] }
        });
        // Missing signs come from a growing neighbourhood; if there are none at all, the axis stays as it is.
        for sigma in SPREADING_BLURS {
            let is_missing = |(axis, s): (&[f32; 2], &[f32; 2])| *axis != [0.0; 2] && *s == [0.0; 2];
            if !axes.pixels().iter().zip(signed.pixels()).any(is_missing) {
                break;
            }
            let around = blurred(&signed, sigma);
            let guess = axes.zip_map(&around, |axis, around| {
                let along = axis[0] * around[0] + axis[1] * around[1];
                if along == 0.0 { [0.0; 2] } else { [axis[0] * along.signum(), axis[1] * along.signum()] }
            });
            signed = signed.zip_map(&guess, |signed, guess| if signed == [0.0; 2] { guess } else { signed });
        }
        Self::new(&signed.zip_map(&axes, |signed, axis| if signed == [0.0; 2] { axis } else { signed }))
    }

    /// The field with every vector turned by an angle in radians, from x towards y.
    #[must_use]
    pub fn turned(&self, angle: f64) -> Self {
        let (sin, cos) = (angle.sine() as f32, angle.cosine() as f32);
        Self { directions: self.directions.map(|[x, y]| [cos * x - sin * y, sin * x + cos * y]) }
    }

    /// The field without directions outside a region (where its value is below 0.5).
    #[must_use]
    pub fn within(&self, region: &Raster<f32>) -> Self {
        Self { directions: self.directions.zip_map(region, |d, r| if r < 0.5 { [0.0; 2] } else { d }) }
    }

    /// The field with a direction everywhere: missing ones are the mean over a growing neighbourhood.
    #[must_use]
    pub fn completed(&self) -> Self {
        let mut directions = self.directions.clone();
        for sigma in SPREADING_BLURS {
            if !directions.pixels().contains(&[0.0; 2]) {
                break;
            }
            let around = blurred(&directions, sigma).map(unit);
            directions = directions.zip_map(&around, |d, around| if d == [0.0; 2] { around } else { d });
        }
        let default = |d: [f32; 2]| if d == [0.0; 2] { [1.0, 0.0] } else { d };
        Self { directions: directions.map(default) }
    }

    /// Between this field and another, by a weight of 0 to 1; where they oppose each other, the heavier one.
    #[must_use]
    pub fn mixed(&self, other: &Self, weight: &Raster<f32>) -> Self {
        let pairs = self.directions.zip_map(&other.directions, |a, b| (a, b));
        Self::new(&pairs.zip_map(weight, |(a, b), weight| {
            if a[0] * b[0] + a[1] * b[1] < 0.0 {
                if weight < 0.5 { a } else { b }
            } else {
                [0, 1].map(|i| a[i] * (1.0 - weight) + b[i] * weight)
            }
        }))
    }

    /// The field continued by `margin` pixels beyond each border.
    #[must_use]
    pub fn framed(&self, margin: usize) -> Self {
        Self { directions: self.directions.framed(margin) }
    }

    /// The field without `margin` pixels at each border.
    #[must_use]
    pub fn unframed(&self, margin: usize) -> Self {
        Self { directions: self.directions.unframed(margin) }
    }

    /// The vectors.
    pub const fn directions(&self) -> &Raster<[f32; 2]> {
        &self.directions
    }

    /// The unit vector at a place in pixels, bilinear between centres; the nearest pixel's where neighbours disagree, zero if that has
    /// none.
    pub fn at(&self, p: Point) -> Vec2 {
        let (fx, fy) = (p.x - 0.5, p.y - 0.5);
        let (x, y) = (fx.floor(), fy.floor());
        let (tx, ty) = (fx - x, fy - y);
        let vector = |dx: isize, dy: isize| {
            let [vx, vy] = self.directions.clamped(x as isize + dx, y as isize + dy);
            Vec2::new(f64::from(vx), f64::from(vy))
        };
        let nearest = vector(isize::from(tx >= 0.5), isize::from(ty >= 0.5));
        if nearest == Vec2::ZERO {
            return nearest;
        }
        let mean =
            (vector(0, 0) * (1.0 - tx) + vector(1, 0) * tx) * (1.0 - ty) + (vector(0, 1) * (1.0 - tx) + vector(1, 1) * tx) * ty;
        if mean.dot(nearest) > 0.3 { mean.normalize() } else { nearest }
    }

    /// True if a place lies on the raster.
    pub fn contains(&self, p: Point) -> bool {
        p.x >= 0.0 && p.y >= 0.0 && p.x < self.directions.width() as f64 && p.y < self.directions.height() as f64
    }

    /// Points `step` pixels apart along the field from `from` (included) until `length` is covered or the field ends; upstream if
    /// `length` is negative. Each step takes the direction half a step ahead (midpoint method).
    pub fn streamline(&self, from: Point, length: f64, step: f64) -> Vec<Point> {
        let count = (length.abs() / step).ceil().max(1.0);
        let stride = length / count;
        let mut points = Vec::with_capacity(count as usize + 1);
        points.push(from);
        let mut here = from;
        for _ in 0..count as usize {
            let middle = here + self.at(here) * (0.5 * stride);
            let direction = self.at(middle);
            let next = here + direction * stride;
            if direction == Vec2::ZERO || middle == here || !self.contains(next) {
                break;
            }
            points.push(next);
            here = next;
        }
        points
    }
}

fn unit([x, y]: [f32; 2]) -> [f32; 2] {
    let length = x.hypotenuse(y);
    if length > 1e-12 { [x / length, y / length] } else { [0.0; 2] }
}

/// The eigenvector of the larger eigenvalue, with the root of the eigenvalues' difference as its length; zero if they are equal.
fn principal_axis([xx, xy, yy]: [f32; 3]) -> [f32; 2] {
    let (across, along) = (xx - yy, 2.0 * xy);
    let gap = across.hypotenuse(along);
    if gap < LEAST_SQUARED_GRADIENT {
        return [0.0; 2];
    }
    let angle = 0.5 * along.angle_over(across);
    [gap.sqrt() * angle.cosine(), gap.sqrt() * angle.sine()]
}

fn blurred(vectors: &Raster<[f32; 2]>, sigma: f32) -> Raster<[f32; 2]> {
    let x = fast_gaussian(&vectors.map(|v| v[0]), sigma);
    let y = fast_gaussian(&vectors.map(|v| v[1]), sigma);
    x.zip_map(&y, |x, y| [x, y])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::raster::{gaussian_gradient, structure_tensor};

    fn flow_of(planes: &[Raster<f32>]) -> Flow {
        let gradients: Vec<_> = planes.iter().map(|plane| gaussian_gradient(plane, 3.0)).collect();
        let sum = gradients.clone().into_iter().reduce(|a, b| a.zip_map(&b, |a, b| [a[0] + b[0], a[1] + b[1]])).unwrap();
        Flow::steepest(&structure_tensor(&gradients).unwrap(), &sum)
    }

    #[test]
    fn it_points_to_the_light() {
        let ramp = Raster::from_fn(50, 50, |x, y| 0.01 * x as f32 + 0.005 * y as f32);
        let flow = flow_of(&[ramp]);
        let expected = Vec2::new(2.0, 1.0).normalize();
        assert!((flow.at(Point::new(25.2, 24.7)) - expected).hypot() < 1e-3);
        assert!((flow.turned(std::f64::consts::FRAC_PI_2).at(Point::new(25.2, 24.7)) - expected.turn_90()).hypot() < 1e-3);
    }

    #[test]
    fn on_every_side_of_a_faint_spot_it_points_to_the_light() {
        let spot = Raster::from_fn(80, 80, |x, y| {
            let (dx, dy) = ((x as f32 - 40.0) / 12.0, (y as f32 - 40.0) / 12.0);
            0.02 * (-0.5 * (dx * dx + dy * dy)).exponential()
        });
        let flow = flow_of(&[spot]);
        for k in 0..16 {
            let (sin, cos) = (f64::from(k) * std::f64::consts::PI / 8.0).sine_and_cosine();
            let outwards = Vec2::new(cos, sin);
            let direction = flow.at(Point::new(40.5, 40.5) + outwards * 14.0);
            assert!(direction.dot(outwards) < -0.97, "{outwards:?}: {direction:?}");
        }
    }

    #[test]
    fn flat_parts_have_none_until_they_are_completed() {
        let disc = Raster::from_fn(160, 160, |x, y| f32::from((x as f32 - 80.0).hypotenuse(y as f32 - 80.0) < 20.0));
        let flow = flow_of(&[disc]);
        assert_eq!(flow.at(Point::new(5.0, 5.0)), Vec2::ZERO);
        let full = flow.turned(std::f64::consts::FRAC_PI_2).completed();
        assert!(full.directions().pixels().iter().all(|v| (v[0].hypotenuse(v[1]) - 1.0).abs() < 1e-3));
        let away = Vec2::new(-1.0, -1.0).normalize();
        assert!(full.at(Point::new(30.0, 30.0)).dot(away).abs() < 0.1, "rings go on outside");
    }

    #[test]
    fn streamlines_keep_their_circle() {
        let flow = Flow::from_fn(200, 200, |p| Vec2::new(-(p.y - 100.0), p.x - 100.0));
        let line = flow.streamline(Point::new(140.0, 100.0), 200.0, 1.0);
        assert_eq!(line.len(), 201);
        assert!(line.iter().all(|p| (p.distance(Point::new(100.0, 100.0)) - 40.0).abs() < 0.1));
        let out = Flow::from_fn(50, 50, |_| Vec2::new(1.0, 0.0)).streamline(Point::new(40.0, 5.0), 100.0, 1.0);
        assert!(out.len() == 10, "it ends at the border: {}", out.len());
    }
}
