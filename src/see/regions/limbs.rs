//! Hands and bare arms: far from every head, what has a face's complexion and ends where another colour begins is skin, not cloth.

use super::head::Head;
use super::plate::{Grid, owner, share_of_usual};
use super::skin_model::shadeless;
use super::{CLOTHING_PLACE, KINDS, SKIN_PLACE};
use crate::geometry::Rect;
use crate::raster::{Raster, close, components, dilate, guided_enlargement, median, open, shares_of_bytes};
use crate::source::{lab, srgb_to_linear};

/// Width of the widest face in working pixels, and most of them on the longer side: fingers are 5 wide.
const FACE: f64 = 60.0;
const LONGEST: f64 = 700.0;
/// Squared deviation from a complexion up to which a pixel may be skin, and the most of a piece's median: hands and arms in nine photographs
/// have up to 2.2, a coral jacket 3.7.
const MAY_BE: f32 = 6.0;
const LIKE: f32 = 2.2;
/// L* of skin in fractions of a face's, for a pixel and for the median of a piece, and the L* that a pixel may have beside any face.
const LIGHT: [f32; 2] = [0.45, 1.35];
const LIGHT_OF_PIECE: [f32; 2] = [0.5, 1.5];
const BRIGHT: f32 = 85.0;
/// Least area of a piece, in squares on the face's width.
const LEAST: f32 = 0.03;
/// Around a piece, the least median of the squared deviation from skin and of the difference in L*a*b* from the piece. Wood, shirts and walls in
/// the light of a whole scene are like what is around them (up to 7); sleeves and dresses around hands and arms have 8 and more.
const UNLIKE_AROUND: f32 = 8.0;
const EDGE: f32 = 20.0;
/// The most of a piece that may lie at a head, where skin is told from cloth better.
const AT_HEAD: f32 = 0.5;
/// The distance in a* and b* from the mean of what is as light up to which a pixel has its colour, and the share of those from which a photograph
/// is toned: thirty in colour have at most 0.68, two toned brown 0.98. In a toned one all is skin that is as light.
const SAME: f32 = 4.0;
const TONED: f32 = 0.85;
/// Radius in working pixels of the filter that aligns pieces with the picture's edges, and its `eps`.
const REACH: usize = 3;
const EPS: f64 = 1.5e-3;

/// The regions with hands and bare arms as skin, for a picture in colour.
pub(super) fn with_limbs(pixels: &Raster<[u8; 3]>, regions: Raster<[u8; KINDS]>, heads: &[Head]) -> Raster<[u8; KINDS]> {
    let Some(scene) = Scene::new(pixels, &regions, heads) else { return regions };
    let limbs = scene.limbs();
    if limbs.pixels().iter().all(|v| *v == 0) {
        return regions;
    }
    let limbs = guided_enlargement(pixels, &scene.colours, &limbs.map(f32::from), REACH, EPS);
    regions.zip_map(&limbs, |mut kinds, limb| {
        let given = (f32::from(kinds[CLOTHING_PLACE]) * limb).round() as u8;
        kinds[CLOTHING_PLACE] -= given;
        kinds[SKIN_PLACE] += given;
        kinds
    })
}

/// A face's skin: its colour without shade, how that varies, and its L*.
struct Complexion {
    mean: [f32; 2],
    /// The inverse of the covariance: of the first, of both, of the second.
    inverse: [f32; 3],
    light: f32,
}

impl Complexion {
    /// `None` with too few pixels of skin, L*a*b*.
    fn of(skin: &[[f32; 3]]) -> Option<Self> {
        const FEWEST: usize = 30;
        /// Least deviation of a colour without shade.
        const LEAST_SPREAD: f32 = 0.02;
        let colours: Vec<[f32; 2]> = skin.iter().map(|c| colour(*c)).collect();
        let middle = |k: usize| median(colours.iter().map(|c| c[k]).collect());
        let (mean, light) = ([middle(0)?, middle(1)?], median(skin.iter().map(|c| c[0]).collect())?);
        let mut spread = [0.0_f64; 3];
        for c in &colours {
            let d = [0, 1].map(|k| f64::from(c[k] - mean[k]));
            spread = [spread[0] + d[0] * d[0], spread[1] + d[0] * d[1], spread[2] + d[1] * d[1]];
        }
        let least = f64::from(LEAST_SPREAD * LEAST_SPREAD);
        let [a, b, c] = spread.map(|v| v / colours.len() as f64);
        let (a, c) = (a + least, c + least);
        let determinant = a * c - b * b;
        let inverse = [c, -b, a].map(|v| (v / determinant) as f32);
        (skin.len() >= FEWEST).then_some(Self { mean, inverse, light })
    }

    /// Squared deviation of a colour, L*a*b*.
    fn distance(&self, pixel: [f32; 3]) -> f32 {
        let c = colour(pixel);
        let d = [c[0] - self.mean[0], c[1] - self.mean[1]];
        let [a, b, c] = self.inverse;
        a * d[0] * d[0] + 2.0 * b * d[0] * d[1] + c * d[1] * d[1]
    }
}

fn colour([l, a, b]: [f32; 3]) -> [f32; 2] {
    shadeless([super::plate::LIGHTNESS_WEIGHT * l, a, b, 0.0])
}

/// A picture of people at the working size.
struct Scene {
    colours: Raster<[f32; 3]>,
    lab: Raster<[f32; 3]>,
    /// Shares of skin, of clothing and of all people.
    shares: Raster<[f32; 3]>,
    /// Squared deviation of each pixel from the complexion of the nearest head.
    from_skin: Raster<f32>,
    /// Where a head's own regions are sure.
    at_head: Raster<bool>,
    /// L* of the darkest and the lightest face, and of their median.
    light: [f32; 3],
    /// The area of a square on the widest face.
    square: f32,
}

impl Scene {
    /// `None` if no face shows its skin, or if colour follows from lightness, as in a toned photograph.
    fn new(pixels: &Raster<[u8; 3]>, regions: &Raster<[u8; KINDS]>, heads: &[Head]) -> Option<Self> {
        let widest = heads.iter().map(|head| head.width).max_by(f64::total_cmp)?;
        let (width, height) = (pixels.width() as f64, pixels.height() as f64);
        let scale = (FACE / widest).min(LONGEST / width.max(height)).min(1.0);
        let [columns, rows] = [width, height].map(|length| ((length * scale).round() as usize).max(1));
        let grid = Grid::new(Rect::new(0.0, 0.0, width, height), columns, rows);
        let colours = Raster::from_fn(columns, rows, |x, y| grid.mean(pixels, x, y, shares_of_bytes));
        let shares = Raster::from_fn(columns, rows, |x, y| {
            grid.mean(regions, x, y, |kinds| {
                let all: f32 = kinds.iter().map(|v| f32::from(*v)).sum();
                [f32::from(kinds[SKIN_PLACE]), f32::from(kinds[CLOTHING_PLACE]), all].map(|v| v / 255.0)
            })
        });
        let lab = colours.map(|encoded| lab(encoded.map(srgb_to_linear)));
        if share_of_usual(lab.pixels(), SAME) > TONED {
            return None;
        }
        let places = |head: &Head| Raster::from_fn(columns, rows, |x, y| head.coordinates(grid.middle(x, y)));
        let (mut complexions, mut at_head) = (Vec::new(), Raster::filled(columns, rows, false));
        for places in heads.iter().map(places) {
            at_head = at_head.zip_map(&places, |is, [u, v]| is || (u.abs() < 0.75 && v > -0.6));
            let is_face = shares.zip_map(&places, |[skin, ..], [u, v]| skin > 0.8 && u.abs() < 0.45 && (0.05..0.9).contains(&v));
            let skin: Vec<[f32; 3]> = lab.pixels().iter().zip(is_face.pixels()).filter(|(_, is)| **is).map(|(c, _)| *c).collect();
            complexions.push(Complexion::of(&skin));
        }
        let from_skin = Raster::from_fn(columns, rows, |x, y| {
            let own = owner(heads, grid.middle(x, y)).and_then(|i| complexions[i].as_ref());
            own.map_or(f32::INFINITY, |face| face.distance(lab.get(x, y)))
        });
        let lights: Vec<f32> = complexions.iter().flatten().map(|face| face.light).collect();
        let ends = lights.iter().fold([f32::INFINITY, 0.0], |[least, most], l| [l.min(least), l.max(most)]);
        let light = [ends[0], ends[1], median(lights)?];
        let square = (scale * widest) as f32;
        Some(Self { colours, lab, shares, from_skin, at_head, light, square: square * square })
    }

    /// Hands and arms, 0 or 1.
    fn limbs(&self) -> Raster<u8> {
        let like_skin = open(&self.like_skin(), 1);
        let (labels, count) = components(&like_skin);
        let mut pieces = vec![Vec::new(); count + 1];
        for (i, label) in labels.pixels().iter().enumerate().filter(|(_, label)| **label != 0) {
            pieces[*label as usize].push(i);
        }
        let mut limbs = like_skin.map(|_| 0);
        for piece in pieces.iter().filter(|piece| piece.len() as f32 >= LEAST * self.square && self.may_be_limb(piece)) {
            let mut own = like_skin.map(|_| 0);
            piece.iter().for_each(|&i| own.pixels_mut()[i] = 1);
            if self.ends_at_another_colour(&own) {
                limbs = limbs.zip_map(&own, Ord::max);
            }
        }
        // Shade between fingers.
        close(&limbs, 2)
    }

    /// Cloth that may be skin, 0 or 1.
    fn like_skin(&self) -> Raster<u8> {
        let [darkest, lightest, _] = self.light;
        let lights = LIGHT[0] * darkest..(LIGHT[1] * lightest).max(BRIGHT);
        let is_like = self.from_skin.zip_map(&self.lab, |d, [l, ..]| d < MAY_BE && lights.contains(&l));
        is_like.zip_map(&self.shares, |is, [_, clothing, all]| u8::from(is && clothing > 0.5 && all > 0.5))
    }

    /// Whether a piece has skin's colour and light, away from heads.
    fn may_be_limb(&self, piece: &[usize]) -> bool {
        let middle = |value: &dyn Fn(usize) -> f32| median(piece.iter().map(|i| value(*i)).collect()).unwrap_or(f32::INFINITY);
        let light = middle(&|i| self.lab.pixels()[i][0]) / self.light[2];
        let at_head = piece.iter().filter(|i| self.at_head.pixels()[**i]).count() as f32;
        let is_light_as_skin = (LIGHT_OF_PIECE[0]..LIGHT_OF_PIECE[1]).contains(&light);
        is_light_as_skin && middle(&|i| self.from_skin.pixels()[i]) < LIKE && at_head < AT_HEAD * piece.len() as f32
    }

    /// Whether other colours begin around a piece, 0 or 1, but for skin and what is no person.
    fn ends_at_another_colour(&self, piece: &Raster<u8>) -> bool {
        /// How far around, in pixels: the first may be mixed.
        const AROUND: [usize; 2] = [1, 3];
        let (near, far) = (dilate(piece, AROUND[0]), dilate(piece, AROUND[1]));
        let within = |i: &usize| piece.pixels()[*i] == 1;
        let is_around = |i: &usize| {
            let [skin, _, all] = self.shares.pixels()[*i];
            far.pixels()[*i] == 1 && near.pixels()[*i] == 0 && skin <= 0.5 && all > 0.5
        };
        let own = |k: usize| median((0..piece.len()).filter(within).map(|i| self.lab.pixels()[i][k]).collect());
        let (Some(l), Some(a), Some(b)) = (own(0), own(1), own(2)) else { return false };
        let around: Vec<usize> = (0..piece.len()).filter(is_around).collect();
        let middle = |value: &dyn Fn(usize) -> f32| median(around.iter().map(|i| value(*i)).collect()).unwrap_or(0.0);
        let edge = middle(&|i| {
            let c = self.lab.pixels()[i];
            ((c[0] - l).powi(2) + (c[1] - a).powi(2) + (c[2] - b).powi(2)).sqrt()
        });
        edge > EDGE && middle(&|i| self.from_skin.pixels()[i]) > UNLIKE_AROUND
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::face;
    use super::*;
    use crate::geometry::Point;

    const SKIN: [u8; 3] = [200, 150, 120];
    const JACKET: [u8; 3] = [40, 45, 70];

    /// The share of skin in the middle of a hand of a colour, 20 pixels wide, on cloth of another; a wall beside it has the light of skin.
    fn skin_of_hand(hand: [u8; 3], cloth: [u8; 3]) -> u8 {
        skin_before(hand, cloth, [130, 170, 160])
    }

    /// The same before a wall of a colour.
    fn skin_before(hand: [u8; 3], cloth: [u8; 3], wall: [u8; 3]) -> u8 {
        let is_face = |x: usize, y: usize| (70..130).contains(&x) && (20..90).contains(&y);
        let is_hand = |x: usize, y: usize| (90..110).contains(&x) && (240..260).contains(&y);
        let pixels = Raster::from_fn(200, 300, |x, y| match (is_face(x, y), is_hand(x, y)) {
            (true, _) => SKIN,
            (_, true) => hand,
            _ if x < 50 => wall,
            _ => cloth,
        });
        let regions = Raster::from_fn(200, 300, |x, y| match (is_face(x, y), x < 50) {
            (true, _) => [255, 0, 0, 0, 0],
            (_, true) => [0; KINDS],
            _ => [0, 0, 0, 0, 255],
        });
        let heads = [Head::new(&face(Point::new(100.0, 55.0), 60.0, 0.0)).expect("a head")];
        let after = with_limbs(&pixels, regions, &heads);
        assert!((60..200).all(|x| after.row(200)[x] == [0, 0, 0, 0, 255]), "the cloth between");
        after.get(100, 250)[SKIN_PLACE]
    }

    #[test]
    fn hands_on_a_jacket_are_skin_and_what_the_cloth_resembles_or_has_another_hue_is_not() {
        assert!(skin_of_hand(SKIN, JACKET) > 240);
        assert!(skin_of_hand([145, 107, 85], JACKET) > 240, "in shade");
        assert_eq!(skin_of_hand([200, 60, 60], JACKET), 0, "a red handkerchief");
        assert_eq!(skin_of_hand(SKIN, [150, 110, 85]), 0, "on cloth of the same hue");
        assert_eq!(skin_before(SKIN, JACKET, SKIN), 0, "colour follows from lightness");
    }
}
