//! The feature field: directions interpolated from lines (Son et al. 2011, section 4.2), and its singular points.

use super::b_spline::{Datum, multilevel_b_spline};
use super::curve::Curve;
use super::distance::distance_within;
use crate::elementary::Elementary as _;
use crate::geometry::{Point, resample};
use crate::raster::{Raster, gaussian_blur};

/// A direction without sign at each pixel.
#[derive(Clone, Debug)]
pub struct DirectionField {
    /// Unit vectors along the features.
    pub tangent: Raster<[f32; 2]>,
    /// Points without a direction, since it turns by half a circle or more around them.
    pub singularities: Vec<Singularity>,
}

/// A point around which the direction turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Singularity {
    /// In pixels.
    pub position: Point,
    /// Turns of the direction along a circuit: 1/2 (a loop's end), -1/2 (a triple point); 1 and -1 appear as pairs of these.
    pub index: f32,
}

/// Lines that steer the field, and their weight.
#[derive(Clone, Copy, Debug)]
pub struct Guides<'a> {
    /// In pixels.
    pub curves: &'a [Curve],
    /// Weight relative to other guides at the same place.
    pub weight: f32,
}

/// Distance between data samples along a line, in pixels: a third of the smallest stripe pitch in use.
const DATUM_SPACING: f64 = 2.0;

/// Parameters of the field; lengths in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldParameters {
    /// The finest cells of the splines.
    pub finest: f64,
    /// Standard deviation of the calming: where lines disagree, the direction turns over this length instead of abruptly.
    pub calm: f64,
    /// Distance from the lines within which there is less calming, so that the direction follows them; 0 calms everywhere alike.
    pub beside: f64,
}

/// Nodes per finest cell at which the field is evaluated; between them it is bilinear.
const NODES_PER_CELL: f64 = 6.0;
/// Rounds of calming. One leaves walls where the splines' tensor passes through 0.
const CALM_ROUNDS: usize = 2;

/// The directions of the lines' tangents, as tensors `(c^2, cs, s^2)`, interpolated by multi-level B-splines, and the eigenvector of the
/// larger eigenvalue. Without lines the field is diagonal, like a printer's screen.
///
/// Splines alone turn abruptly where the tensor is nearly isotropic. Calming normalises every tensor before averaging it with its
/// neighbours, so that the turn spreads.
pub fn direction_field(guides: &[Guides<'_>], width: usize, height: usize, parameters: FieldParameters) -> DirectionField {
    let data: Vec<Datum> =
        guides.iter().flat_map(|guide| guide.curves.iter().flat_map(|curve| tensors(curve, guide.weight))).collect();
    let surface = multilevel_b_spline(&data, width as f64, height as f64, parameters.finest);
    let step = (parameters.finest / NODES_PER_CELL).max(1.0);
    let count = |length: usize| (length as f64 / step).ceil().max(1.0) as usize + 1;
    let mut nodes = Raster::from_fn(count(width), count(height), |i, j| {
        let [a, b, c] = surface.at(Point::new(i as f64 * step, j as f64 * step));
        unit([a - c, 2.0 * b])
    });
    if parameters.calm > 0.0 {
        let found = nodes.clone();
        for _ in 0..CALM_ROUNDS {
            nodes = calmed(&nodes, (parameters.calm / step) as f32);
        }
        nodes = with_found_beside(guides, (width, height), (step, parameters.beside), (&found, nodes));
    }
    let mut singularities = singularities(&nodes, 2);
    for found in &mut singularities {
        found.position = Point::new(found.position.x * step, found.position.y * step);
    }
    let planes = [0, 1].map(|c| nodes.map(|d| d[c]));
    let tangent = Raster::from_fn(width, height, |x, y| {
        // Nodes lie at whole steps from the corner, pixel centres half a pixel further.
        let (u, v) = ((x as f64 + 0.5) / step + 0.5, (y as f64 + 0.5) / step + 0.5);
        eigenvector([planes[0].sample(u, v), planes[1].sample(u, v)])
    });
    DirectionField { tangent, singularities }
}

/// Doubled angles normalised to length 1; zero where there is no direction.
fn unit([x, y]: [f32; 2]) -> [f32; 2] {
    let length = x.hypotenuse(y);
    if length < 1e-12 { [0.0, 0.0] } else { [x / length, y / length] }
}

fn calmed(nodes: &Raster<[f32; 2]>, sigma: f32) -> Raster<[f32; 2]> {
    let plane = |c: usize| gaussian_blur(&nodes.map(|d| d[c]), sigma);
    plane(0).zip_map(&plane(1), |x, y| unit([x, y]))
}

/// The calmed directions, and beside the lines those that were found: on the lines in full, `beside` pixels away not at all.
fn with_found_beside(
    guides: &[Guides<'_>],
    (width, height): (usize, usize),
    (step, beside): (f64, f64),
    (found, calmed): (&Raster<[f32; 2]>, Raster<[f32; 2]>),
) -> Raster<[f32; 2]> {
    if beside <= 0.0 {
        return calmed;
    }
    let curves: Vec<Curve> = guides.iter().flat_map(|guide| guide.curves.iter().cloned()).collect();
    let Some(lines) = distance_within(&curves, width, height, beside) else { return calmed };
    Raster::from_fn(calmed.width(), calmed.height(), |i, j| {
        let away = lines.distance.clamped((i as f64 * step) as isize, (j as f64 * step) as isize);
        let near = (1.0 - away / beside as f32).clamp(0.0, 1.0);
        let share = near * near * (3.0 - 2.0 * near);
        let ([x0, y0], [x1, y1]) = (calmed.get(i, j), found.get(i, j));
        unit([x0 + share * (x1 - x0), y0 + share * (y1 - y0)])
    })
}

/// The unit tangent's tensor along a line.
fn tensors(curve: &Curve, weight: f32) -> Vec<Datum> {
    let mut points = curve.points.clone();
    if curve.closed
        && let Some(&first) = points.first()
    {
        points.push(first);
    }
    let points = resample(&points, DATUM_SPACING);
    points
        .windows(2)
        .filter(|pair| pair[0] != pair[1])
        .map(|pair| {
            let tangent = (pair[1] - pair[0]).normalize();
            let (c, s) = (tangent.x as f32, tangent.y as f32);
            Datum { position: pair[0].midpoint(pair[1]), value: [c * c, c * s, s * s], weight }
        })
        .collect()
}

/// The larger eigenvalue's vector from the tensor's deviator `(a - c, 2b)`, which is the direction's doubled angle.
fn eigenvector([x, y]: [f32; 2]) -> [f32; 2] {
    let length = x.hypotenuse(y);
    if length < 1e-9 {
        return [std::f32::consts::FRAC_1_SQRT_2; 2];
    }
    let cosine = (0.5 * (1.0 + x / length)).max(0.0).sqrt();
    let sine = (0.5 * (1.0 - x / length)).max(0.0).sqrt();
    [cosine, if y < 0.0 { -sine } else { sine }]
}

/// Squares of `side` nodes around which the doubled angle makes a full turn; positions in nodes.
fn singularities(deviator: &Raster<[f32; 2]>, side: usize) -> Vec<Singularity> {
    let mut found = Vec::new();
    for y in (0..deviator.height().saturating_sub(side)).step_by(side) {
        for x in (0..deviator.width().saturating_sub(side)).step_by(side) {
            let corners = [(0, 0), (side, 0), (side, side), (0, side)].map(|(dx, dy)| deviator.get(x + dx, y + dy));
            let turn: f32 = (0..4)
                .map(|k| {
                    let (a, b) = (corners[k], corners[(k + 1) % 4]);
                    (a[0] * b[1] - a[1] * b[0]).angle_over(a[0] * b[0] + a[1] * b[1])
                })
                .sum();
            let turns = (turn / std::f32::consts::TAU).round();
            if turns != 0.0 {
                let middle = 0.5 * side as f64;
                found.push(Singularity { position: Point::new(x as f64 + middle, y as f64 + middle), index: 0.5 * turns });
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::elementary::unit_at;
    use crate::geometry::Vec2;

    fn circle(centre: Point, radius: f64) -> Curve {
        let at = |i: u32| centre + unit_at(f64::from(i) * std::f64::consts::TAU / 90.0) * radius;
        Curve { points: (0..90).map(at).collect(), closed: true }
    }

    #[test]
    fn rings_make_a_field_of_circles_with_one_turn_at_the_centre() {
        let centre = Point::new(80.0, 70.0);
        let rings = [15.0, 35.0, 60.0].map(|r| circle(centre, r));
        let field = direction_field(
            &[Guides { curves: &rings, weight: 1.0 }],
            160,
            140,
            FieldParameters { finest: 6.0, calm: 3.0, beside: 0.0 },
        );
        for y in (5..135).step_by(10) {
            for x in (5..155).step_by(10) {
                let away = Point::new(x as f64 + 0.5, y as f64 + 0.5) - centre;
                let [tx, ty] = field.tangent.get(x, y);
                if (10.0..65.0).contains(&away.hypot()) {
                    let across = Vec2::new(f64::from(tx), f64::from(ty)).dot(away.normalize()).abs();
                    assert!(across < 0.12, "{across} at {x}, {y}");
                }
            }
        }
        let turns: f32 = field.singularities.iter().filter(|s| s.position.distance(centre) < 14.0).map(|s| s.index).sum();
        assert_eq!(turns, 1.0, "{:?}", field.singularities);
    }

    #[test]
    fn beside_a_line_much_calming_leaves_its_direction() {
        let post = Curve { points: (0..30).map(|i| Point::new(80.0, 55.0 + f64::from(i))).collect(), closed: false };
        let level = |y: f64| Curve { points: (0..160).map(|i| Point::new(f64::from(i), y)).collect(), closed: false };
        let lines = [post, level(20.0), level(120.0)];
        let upright = |beside: f64, x: usize| {
            let parameters = FieldParameters { finest: 6.0, calm: 30.0, beside };
            let field = direction_field(&[Guides { curves: &lines, weight: 1.0 }], 160, 140, parameters);
            field.tangent.get(x, 70)[1].abs()
        };
        assert!(upright(0.0, 80) < 0.5, "{}", upright(0.0, 80));
        assert!(upright(10.0, 80) > 0.95, "{}", upright(10.0, 80));
        assert!((upright(10.0, 100) - upright(0.0, 100)).abs() < 1e-3, "farther away all is calmed");
    }

    #[test]
    fn without_lines_it_is_the_diagonal() {
        let field = direction_field(&[], 30, 20, FieldParameters { finest: 6.0, calm: 3.0, beside: 0.0 });
        assert!(field.tangent.pixels().iter().all(|t| (t[0] - t[1]).abs() < 1e-6));
        assert!(field.singularities.is_empty());
    }
}
