//! The direction of the lines at each place: on skin from the face, in hair along its locks, on cloth along its folds.
//!
//! ```text
//!   skin    the mean face's directions at the mesh's points, spread; over the scalp and down the neck round arches
//!   hair    the structure tensor's, spread by how clear they are, towards circles around the head where they are not
//!   beard   the same, towards the way in which beards grow
//!   cloth   slopes of shoulders, bent towards the folds where these are clear
//! ```
//! Each is one signed angle from the head's line between the ears, which interpolates as a plain number.

use super::canonical;
use super::growth::{Growth, growth_at};
use super::surfaces::{Surface, Surfaces};
use crate::elementary::Elementary as _;
use crate::field::spread;
use crate::geometry::Point;
use crate::raster::{Raster, fast_gaussian, filled_polygon, gaussian_gradient, median, reduce, structure_tensor};
use crate::source::{Landmarks, Placement, outlines};
use crate::style::Drawer;
use crate::style::drawer::Pitched;
use crate::style::head::Head;
use std::borrow::Cow;
use std::f64::consts::PI;

/// How much coarser than the working grid texture is looked at.
const HALF: usize = 2;

/// The directions of each surface, in radians on the page (y down), on the working grid.
pub(in crate::style) struct Directions {
    skin: Raster<f32>,
    hair: Raster<f32>,
    /// None without beards.
    beard: Option<Raster<f32>>,
    cloth: Raster<f32>,
}

impl Directions {
    pub(in crate::style) fn of(&self, surface: Surface) -> &Raster<f32> {
        match surface {
            Surface::Skin => &self.skin,
            Surface::Hair => &self.hair,
            Surface::Beard => self.beard.as_ref().unwrap_or(&self.hair),
            Surface::Cloth => &self.cloth,
        }
    }

    fn map(self, change: impl Fn(&Raster<f32>) -> Raster<f32>) -> Self {
        let [skin, hair, cloth] = [self.skin, self.hair, self.cloth].map(|found| change(&found));
        Self { skin, hair, beard: self.beard.map(|found| change(&found)), cloth }
    }

    /// Those of hair, and of beards where there are some; where the two meet their sign may change.
    pub(in crate::style) fn of_all_hair(&self, surfaces: &Surfaces) -> Cow<'_, Raster<f32>> {
        let Some(beard) = &self.beard else { return Cow::Borrowed(&self.hair) };
        let (hair, share) = (&self.hair, &surfaces.beard);
        let at = |x, y| if share.get(x, y) > 0.5 { beard.get(x, y) } else { hair.get(x, y) };
        Cow::Owned(Raster::from_fn(hair.width(), hair.height(), at))
    }
}

/// The coarse grid on which directions are spread.
struct Cells {
    columns: usize,
    rows: usize,
    /// Working pixels per cell.
    size: f64,
}

impl Cells {
    fn new(placement: &Placement, face_width: f64) -> Self {
        /// Cells of the grid on which directions are spread, per width of the largest face, and the most along the picture's
        /// longer side.
        const CELLS_PER_FACE: f64 = 60.0;
        const MOST_CELLS: f64 = 320.0;
        let longest = placement.columns.max(placement.rows) as f64;
        let size = (face_width / CELLS_PER_FACE).max(longest / MOST_CELLS).max(1.0);
        let count = |side: usize| ((side as f64 / size).ceil() as usize).max(2);
        Self { columns: count(placement.columns), rows: count(placement.rows), size }
    }

    /// The same cells in pixels of a grid twice as coarse.
    fn on_half(&self) -> Self {
        Self { size: self.size / HALF as f64, ..*self }
    }

    fn middle(&self, x: usize, y: usize) -> Point {
        Point::new((x as f64 + 0.5) * self.size, (y as f64 + 0.5) * self.size)
    }

    /// The mean of a working raster in each cell.
    fn mean(&self, raster: &Raster<f32>) -> Raster<f32> {
        let blurred = fast_gaussian(raster, (0.5 * self.size) as f32);
        self.fill(|p| blurred.sample(p.x, p.y))
    }

    fn fill(&self, value: impl Fn(Point) -> f32 + Sync) -> Raster<f32> {
        Raster::from_fn(self.columns, self.rows, |x, y| value(self.middle(x, y)))
    }

    fn at(&self, cells: &Raster<f32>, x: usize, y: usize) -> f32 {
        cells.sample((x as f64 + 0.5) / self.size, (y as f64 + 0.5) / self.size)
    }
}

/// The structure tensor's direction along the lines of a picture, in radians, its coherence (0 to 1) and its energy, on a grid twice as
/// coarse as the working grid.
struct Texture {
    along: Raster<f32>,
    coherence: Raster<f32>,
    energy: Raster<f32>,
}

impl Texture {
    /// Of a working raster, with both blurs in its pixels.
    fn new(tone: &Raster<f32>, fine: f64, wide: f64) -> Self {
        let (tone, fine, wide) = (&reduce(tone, HALF), fine / HALF as f64, wide / HALF as f64);
        let tensor = structure_tensor(&[gaussian_gradient(tone, fine as f32)]).unwrap_or_else(|| tone.map(|_| [0.0; 3]));
        let [xx, xy, yy] = [0, 1, 2].map(|k| fast_gaussian(&tensor.map(|t| t[k]), wide as f32));
        let along = xx.zip_map(&yy, |xx, yy| xx - yy).zip_map(&xy, |d, xy| 0.5 * (2.0 * xy).angle_over(d) + 0.5 * PI as f32);
        let energy = xx.zip_map(&yy, |xx, yy| xx + yy);
        let strength = xx.zip_map(&yy, |xx, yy| xx - yy).zip_map(&xy, |d, xy| d.hypotenuse(2.0 * xy));
        Self { along, coherence: strength.zip_map(&energy, |s, e| s / (e + 2e-7)), energy }
    }

    /// How clear the direction is inside a region, 0 to 1. Texture counts by its strength among the region's: dark hair has faint
    /// locks.
    fn clear(&self, region: &Raster<f32>) -> Raster<f32> {
        let inside = self.energy.pixels().iter().zip(region.pixels()).filter(|(_, share)| **share > 0.5).map(|(e, _)| *e);
        let usual = median(inside.collect()).unwrap_or(0.0).max(1e-9);
        let strong = self.coherence.zip_map(&self.energy, |c, e| c * c * (e / usual).min(1.0));
        strong.zip_map(region, |strong, share| strong * share)
    }
}

/// Stiffness of the spread fields.
const SKIN_BENDING: f32 = 6.0;
const HAIR_BENDING: f32 = 2.0;
const CLOTH_BENDING: f32 = 8.0;
/// Weights of the guesses against clear texture: short beards have little that is clear. With 0.02 a chin has a whorl (04).
const HAIR_GUESS: f32 = 0.003;
const BEARD_GUESS: f32 = 0.03;

/// The head nearest to a place.
fn nearest_head(heads: &[Head], p: Point) -> Head {
    let by_distance = |a: &&Head, b: &&Head| a.away(p).total_cmp(&b.away(p));
    *heads.iter().min_by(by_distance).expect("directions of form need a face")
}

impl<P: Pitched + Sync> Drawer<'_, P> {
    /// The directions of lines on skin alone, in radians on the page (y down), on the working grid.
    pub(in crate::style) fn directions_on_skin(&self) -> Raster<f32> {
        let (heads, cells) = self.heads();
        let skin = self.skin_directions(&cells, &heads, &|p| nearest_head(&heads, p));
        match self.drawn_directions() {
            Some(drawn) => drawn.over_angles(&skin),
            None => skin,
        }
    }

    fn heads(&self) -> (Vec<Head>, Cells) {
        let heads: Vec<Head> = self.portrait.faces.iter().map(Head::new).collect();
        let widest = heads.iter().map(|head| head.width).fold(1.0, f64::max);
        (heads, Cells::new(&self.portrait.placement, widest))
    }

    pub(in crate::style) fn directions(&self, surfaces: &Surfaces) -> Directions {
        let (heads, cells) = self.heads();
        let nearest = |p: Point| nearest_head(&heads, p);
        let growth: Vec<Growth> = self.portrait.faces.iter().map(Growth::of).collect();
        let grown = |p: Point| growth_at(&growth, p);
        let has_beard = surfaces.beard.pixels().iter().any(|share| *share > 0.5);
        let ((skin, cloth), (hair, beard)) = rayon::join(
            || {
                rayon::join(
                    || self.skin_directions(&cells, &heads, &nearest),
                    || self.cloth_directions(&cells, surfaces, &nearest),
                )
            },
            || {
                rayon::join(
                    || self.strand_directions(&cells, &surfaces.hair, &|p| around(&nearest(p), p), HAIR_GUESS),
                    || has_beard.then(|| self.strand_directions(&cells, &surfaces.beard, &grown, BEARD_GUESS)),
                )
            },
        );
        let found = Directions { skin, hair, beard, cloth };
        match self.drawn_directions() {
            Some(drawn) => found.map(|found| drawn.over_angles(found)),
            None => found,
        }
    }

    fn skin_directions(&self, cells: &Cells, heads: &[Head], nearest: &(impl Fn(Point) -> Head + Sync)) -> Raster<f32> {
        let (guess, guess_weight) = (cells.fill(|p| guessed(&nearest(p), p).0), cells.fill(|p| guessed(&nearest(p), p).1));
        let inside = self.inside_faces(cells);
        let mut weight = guess_weight.zip_map(&inside, |weight, inside| if inside > 0.02 { 0.0 } else { weight });
        let mut known = guess;
        let mut sums = known.map(|_| [0.0_f32; 2]);
        for (face, head) in self.portrait.faces.iter().zip(heads) {
            for (p, angle) in canonical::directions(face, head) {
                let (x, y) = (p.x / cells.size, p.y / cells.size);
                if x >= 0.0 && y >= 0.0 && x < cells.columns as f64 && y < cells.rows as f64 {
                    let [sum, count] = sums.get(x as usize, y as usize);
                    sums.set(x as usize, y as usize, [sum + (angle + head.roll()) as f32, count + 1.0]);
                }
            }
        }
        for (i, [sum, count]) in sums.pixels().iter().enumerate().filter(|(_, [_, count])| *count > 0.0) {
            known.pixels_mut()[i] = sum / count;
            weight.pixels_mut()[i] = *count;
        }
        let angles = spread(&[known], &weight, SKIN_BENDING);
        self.fine(|x, y| cells.at(&angles[0], x, y))
    }

    /// The directions of strands in a region, towards a guess of some weight.
    fn strand_directions(
        &self,
        cells: &Cells,
        region: &Raster<f32>,
        guess: &(impl Fn(Point) -> f64 + Sync),
        guess_weight: f32,
    ) -> Raster<f32> {
        let unit = self.pitch() / 4.5;
        let texture = Texture::new(&self.portrait.lightness, 1.4 * unit, 5.0 * unit);
        let clear = texture.clear(&reduce(region, HALF)).map(|clear| 0.25 * clear);
        let (half, inside) = (cells.on_half(), cells.mean(region));
        let (edge, edge_weight) = self.along_silhouette(region);
        let double = |turn: fn(f32) -> f32| {
            let seen = clear.zip_map(&texture.along, |clear, along| clear * turn(2.0 * along));
            let edge = edge.zip_map(&edge_weight, |edge, weight| weight * turn(2.0 * edge));
            let seen = seen.zip_map(&edge, |seen, edge| seen + edge);
            let guess = cells.fill(|p| turn(2.0 * guess(p) as f32));
            let known = half
                .mean(&seen)
                .zip_map(&guess.zip_map(&inside, |g, inside| (guess_weight * inside + 1e-5) * g), |seen, guess| seen + guess);
            let clear = clear.zip_map(&edge_weight, |clear, edge| clear + edge);
            let weight = half.mean(&clear).zip_map(&inside, |clear, inside| clear + guess_weight * inside + 1e-5);
            (known.zip_map(&weight, |k, w| k / w), weight)
        };
        let ((cos, weight), (sin, _)) = (double(f32::cosine), double(f32::sine));
        let planes = spread(&[cos, sin], &weight, HAIR_BENDING);
        self.fine(|x, y| {
            let angle = 0.5 * f64::from(cells.at(&planes[1], x, y)).angle_over(f64::from(cells.at(&planes[0], x, y)));
            let way = guess(Point::new(x as f64 + 0.5, y as f64 + 0.5));
            (angle + PI * ((way - angle) / PI).round()) as f32
        })
    }

    /// The course of the silhouette near it inside a region, in radians, and its weight, on the grid of textures: lines of hair that end on it
    /// side by side are a frayed edge.
    fn along_silhouette(&self, region: &Raster<f32>) -> (Raster<f32>, Raster<f32>) {
        /// Reach of the silhouette as a blur in pitches, and its weight.
        const REACH: f64 = 1.6;
        const WEIGHT: f32 = 0.04;
        let sigma = (REACH * self.pitch() / HALF as f64) as f32;
        let slope = gaussian_gradient(&reduce(&self.portrait.subject, HALF), sigma);
        let along = slope.map(|[x, y]| y.angle_over(x) + 0.5 * PI as f32);
        // At a straight border a blur's greatest slope is 0.4 per sigma.
        let near = slope.map(|[x, y]| (2.5 * sigma * x.hypotenuse(y)).min(1.0).powi(2));
        (along, near.zip_map(&reduce(region, HALF), |near, share| WEIGHT * near * share))
    }

    fn cloth_directions(&self, cells: &Cells, surfaces: &Surfaces, nearest: &(impl Fn(Point) -> Head + Sync)) -> Raster<f32> {
        /// Slope of the shoulders, and how far from the middle they reach it, in face widths.
        const SHOULDER: f64 = 0.733;
        const SHOULDER_REACH: f64 = 0.22;
        /// How far folds turn the lines of cloth at most.
        const MOST_TURN: f64 = 0.9;
        let unit = self.pitch() / 4.5;
        let texture = Texture::new(&self.portrait.lightness, 3.0 * unit, 10.0 * unit);
        let slope = |p: Point| {
            let head = nearest(p);
            SHOULDER * (head.relative(p).0 / SHOULDER_REACH).hyperbolic_tangent() + head.roll()
        };
        let clear = texture.clear(&reduce(&surfaces.cloth, HALF));
        let half = cells.on_half();
        let turn = Raster::from_fn(clear.width(), clear.height(), |x, y| {
            let p = Point::new((x as f64 + 0.5) * HALF as f64, (y as f64 + 0.5) * HALF as f64);
            let turn = (f64::from(texture.along.get(x, y)) - slope(p) + 0.5 * PI).rem_euclid(PI) - 0.5 * PI;
            (turn.clamp(-MOST_TURN, MOST_TURN) * f64::from(texture.coherence.get(x, y)).powi(2)) as f32
        });
        let guess = cells.fill(|p| slope(p) as f32);
        let known = guess.zip_map(&half.mean(&turn), |slope, turn| slope + turn);
        let weight = half.mean(&clear).map(|clear| 0.1 * clear + 0.004);
        let angles = spread(&[known], &weight, CLOTH_BENDING);
        self.fine(|x, y| cells.at(&angles[0], x, y))
    }

    /// How much of each cell lies inside a face.
    fn inside_faces(&self, cells: &Cells) -> Raster<f32> {
        let corners = |face: &Landmarks| -> Vec<[f64; 2]> {
            face.line(&outlines::OVAL).iter().map(|p| [p.x / cells.size, p.y / cells.size]).collect()
        };
        let nothing = Raster::filled(cells.columns, cells.rows, 0.0_f32);
        self.portrait.faces.iter().fold(nothing, |all, face| {
            all.zip_map(&filled_polygon(cells.columns, cells.rows, &corners(face)), |all, inside| all.max(f32::from(inside)))
        })
    }

    /// A raster of the working grid.
    fn fine(&self, value: impl Fn(usize, usize) -> f32 + Sync) -> Raster<f32> {
        let (columns, rows) = self.size();
        Raster::from_fn(columns, rows, value)
    }
}

/// Round a head.
fn around(head: &Head, p: Point) -> f64 {
    let (u, v) = head.relative(p);
    (v + 0.75).angle_over(u) + 0.5 * PI + head.roll()
}

/// Where the scalp begins and the neck, in heights of the face below the chin; how round lines are there; and the weights of these
/// guesses, and of those beside the face, against the mesh's points.
const SCALP: f64 = -0.45;
const NECK: f64 = 0.05;
const SCALP_ROUND: f64 = 1.5;
const NECK_ROUND: f64 = 1.1;
const BESIDE_ROUND: f64 = 0.35;
const SCALP_WEIGHT: f32 = 0.004;
const NECK_WEIGHT: f32 = 0.01;
const BESIDE_WEIGHT: f32 = 0.0005;

/// The direction on skin away from the mesh, in radians on the page, and its weight.
fn guessed(head: &Head, p: Point) -> (f32, f32) {
    let (u, v) = head.relative(p);
    let (angle, weight) = if v < SCALP {
        (-(SCALP_ROUND * u).arc_tangent(), SCALP_WEIGHT)
    } else if v > NECK {
        ((NECK_ROUND * u).arc_tangent(), NECK_WEIGHT)
    } else {
        (BESIDE_ROUND * u, BESIDE_WEIGHT)
    };
    ((angle + head.roll()) as f32, weight)
}
