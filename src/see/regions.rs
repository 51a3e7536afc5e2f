//! The regions of the people: skin, hair, facial hair, headwear and clothing, segmented by the photograph's own colours.
//!
//! No network detects these. The face mesh shows where skin certainly is, where hair would begin and where shoulders would be.
//! Gaussian mixtures of colour and texture are fitted there, each pixel takes the class that suits it best at its position on the
//! head, and the picture's own edges decide the rest.
//!
//! ```text
//!   view, subject, points --> plate (face 110 px wide) --> a beard? is it bald? does hair fall past the jaw? --> parting: skin, hair, clothing
//!                         --> pieces that hang together, shaded necks --> facial hair and headwear taken out --> shares at the view's size
//! ```

mod baldness;
mod beard_signs;
mod ears;
mod facial_hair;
mod falling;
mod hair;
mod head;
mod headwear;
mod lighting;
mod limbs;
mod mane;
mod mixture;
mod neck;
mod path;
mod pieces;
mod plate;
mod scores;
mod segmentation;
mod skin_model;
mod slivers;
mod smoothing;

use super::detail::detail;
use super::ear_detail::with_ears;
use super::sight::Regions;
use crate::parallel::shares;
use crate::raster::{Raster, mean_of_corners, shares_of_bytes};
use crate::source::Landmarks;
use facial_hair::Beard;
use head::Head;
use headwear::headwear;
use neck::with_shaded_neck;
use plate::{Plate, owner};
use segmentation::{CLOTHING, HAIR, SKIN, Segmentation, Shares};
use slivers::without_slivers;
use smoothing::{Guide, Lines, value};

/// Number of regions: skin, hair, facial hair, headwear, clothing.
const KINDS: usize = 5;
const LAST: usize = KINDS - 1;
/// The places of skin and clothing among them.
const SKIN_PLACE: usize = 0;
const CLOTHING_PLACE: usize = LAST;
/// Radii in working pixels of the filters that align shares with the picture's edges (the second also at the view's size), and
/// their `eps`: at twice the radii fair hair blurs into the forehead.
const REACHES: [usize; 2] = [5, 3];
const EPS: f32 = 1.5e-3;

/// The result for one head: linear functions of colour for each region, on its plate.
struct HeadRegions {
    plate: Plate,
    lines: [Lines; KINDS],
}

/// The regions of the people in a view; the faces are in its pixels.
pub(super) fn regions(pixels: &Raster<[u8; 3]>, subject: &Raster<u8>, faces: &[Landmarks]) -> Regions {
    let (heads, with_heads): (Vec<Head>, Vec<&Landmarks>) =
        faces.iter().filter_map(|face| Some((Head::new(face)?, face))).unzip();
    let told: Vec<Option<HeadRegions>> = (0..heads.len()).map(|i| told(pixels, subject, with_heads[i], &heads, i)).collect();
    let planes = limbs::with_limbs(pixels, at_full_size(pixels, subject, &heads, &told), &heads);
    let [skin, hair, facial_hair, headwear, clothing] = [0, 1, 2, 3, 4].map(|k| planes.map(|p| p[k]));
    let detail = with_ears(detail(subject, faces), &skin, faces);
    Regions { skin, hair, facial_hair, headwear, clothing, detail }
}

fn told(pixels: &Raster<[u8; 3]>, subject: &Raster<u8>, face: &Landmarks, heads: &[Head], which: usize) -> Option<HeadRegions> {
    let plate = Plate::new(pixels, subject, face, heads, which)?;
    let beard = Beard::found(&plate);
    let parting = Segmentation::learned(&plate, beard.as_ref());
    let guides = REACHES.map(|radius| Guide::new(&plate.colours, radius, EPS));
    let shares = pieces::reassign_stray_pieces(&parting, &plate, parting.shares(&guides), beard.as_ref());
    let beard = beard.map(|beard| beard.shares(&plate, &shares));
    let shares = match &beard {
        Some(beard) => pieces::without_hair_under_beard(&plate, shares, beard),
        None => shares,
    };
    let shares = with_shaded_neck(&plate, without_slivers(&plate, shares), beard.as_ref());
    let hat = headwear(&plate, &shares);
    let kinds = kinds(&shares, beard.as_ref(), hat.as_ref());
    let lines = [0, 1, 2, 3, 4].map(|k| {
        let plane = kinds.map(|s| s[k]);
        let is_empty = plane.pixels().iter().all(|v| *v == 0.0);
        if is_empty { plane.map(|_| [0.0; 4]) } else { guides[1].lines(&plane) }
    });
    drop((guides, parting));
    Some(HeadRegions { plate, lines })
}

/// The five regions within the person: facial hair takes from skin and clothing, headwear from hair.
fn kinds(shares: &Raster<Shares>, beard: Option<&Raster<f32>>, hat: Option<&Raster<f32>>) -> Raster<[f32; KINDS]> {
    Raster::from_fn(shares.width(), shares.height(), |x, y| {
        let s = shares.get(x, y);
        let beard = beard.map_or(0.0, |b| b.get(x, y));
        let hat = hat.map_or(0.0, |h| h.get(x, y).min(s[HAIR]));
        let rest = 1.0 - beard;
        let under = s[SKIN] + s[HAIR] - hat + s[CLOTHING];
        let kinds = [s[SKIN] * rest, (s[HAIR] - hat) * rest, beard * under.max(0.5), hat, s[CLOTHING] * rest];
        let kinds = kinds.map(|v| v.max(0.0) * v.max(0.0));
        let sum: f32 = kinds.iter().sum();
        kinds.map(|v| if sum > 1e-4 { v / sum } else { 0.0 })
    })
}

/// The regions at the view's size, each pixel from its nearest head; pixels outside all plates are clothing.
fn at_full_size(
    pixels: &Raster<[u8; 3]>,
    subject: &Raster<u8>,
    heads: &[Head],
    told: &[Option<HeadRegions>],
) -> Raster<[u8; KINDS]> {
    let width = pixels.width();
    let mut out = Raster::filled(width, pixels.height(), [0_u8; KINDS]);
    shares(out.pixels_mut(), width, &|y, row| {
        for (x, out) in row.iter_mut().enumerate() {
            let whole = subject.get(x, y);
            if whole == 0 {
                continue;
            }
            let p = crate::geometry::Point::new(x as f64 + 0.5, y as f64 + 0.5);
            let own = owner(heads, p).and_then(|i| told[i].as_ref());
            let colour = shares_of_bytes(pixels.get(x, y));
            let shares = own.and_then(|own| shares_at(own, p.x, p.y, colour));
            *out = apportioned(whole, shares.unwrap_or([0.0, 0.0, 0.0, 0.0, 1.0]));
        }
    });
    out
}

/// A plate's shares for a colour at a point of the view; `None` outside the plate.
fn shares_at(told: &HeadRegions, x: f64, y: f64, colour: [f32; 3]) -> Option<[f32; KINDS]> {
    let plate = &told.plate;
    if !plate.part.contains(crate::geometry::Point::new(x, y)) {
        return None;
    }
    let place =
        |v: f64, from: f64, length: f64, count: usize| ((v - from) / length * count as f64 - 0.5).clamp(0.0, count as f64 - 1.0);
    let (fx, fy) = (
        place(x, plate.part.x0, plate.part.width(), plate.width()),
        place(y, plate.part.y0, plate.part.height(), plate.height()),
    );
    let (x0, y0) = (fx as usize, fy as usize);
    let (x1, y1) = ((x0 + 1).min(plate.width() - 1), (y0 + 1).min(plate.height() - 1));
    let (tx, ty) = (fx.fract() as f32, fy.fract() as f32);
    let mut shares = [0.0; KINDS];
    for (share, lines) in shares.iter_mut().zip(&told.lines) {
        let corners = [lines.get(x0, y0), lines.get(x1, y0), lines.get(x0, y1), lines.get(x1, y1)];
        *share = value(mean_of_corners(corners, tx, ty), colour);
    }
    Some(shares)
}

/// Divides a whole of at most 255 without remainder.
fn apportioned(whole: u8, shares: [f32; KINDS]) -> [u8; KINDS] {
    let sum: f32 = shares.iter().sum();
    let (shares, sum) = if sum > 0.02 { (shares, sum) } else { ([0.0, 0.0, 0.0, 0.0, 1.0], 1.0) };
    let (mut given, mut upto) = (0_u8, 0.0_f32);
    let mut out = [0; KINDS];
    for (k, share) in shares.into_iter().enumerate() {
        upto += share / sum;
        let reached = if k == LAST { whole } else { ((upto * f32::from(whole)).round() as u8).clamp(given, whole) };
        out[k] = reached - given;
        given = reached;
    }
    out
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::elementary::{Elementary as _, unit_at};
    use crate::geometry::Point;
    use crate::source::Iris;
    use crate::source::outlines::OVAL;

    /// A face `width` pixels wide, turned by `yaw` radians; only the landmarks that heads are measured by are in place.
    pub(in crate::see) fn face(centre: Point, width: f64, yaw: f64) -> Landmarks {
        let mut points = vec![[centre.x, centre.y, 0.0]; 468];
        let (sin, cos) = yaw.sine_and_cosine();
        let mut put = |i: usize, x: f64, y: f64, z: f64| {
            points[i] = [centre.x + width * (x * cos + z * sin), centre.y + width * y, width * (z * cos - x * sin)];
        };
        put(10, 0.0, -0.6, -0.3);
        put(152, 0.0, 0.6, -0.3);
        put(234, -0.5, 0.0, 0.0);
        put(454, 0.5, 0.0, 0.0);
        Landmarks { points, irises: [Iris { centre, radius: 0.04 * width }; 2], spectacles: None, pearls: Vec::new() }
    }

    /// The plate of an oval face, 80 by 100 pixels around (100, 70), the only landmarks in place but for the eyes' outer corners.
    pub(super) fn plate(pixels: &Raster<[u8; 3]>) -> Plate {
        plate_with(pixels, &[])
    }

    /// The same with more landmarks, at places in the picture.
    pub(super) fn plate_with(pixels: &Raster<[u8; 3]>, landmarks: &[(usize, [f64; 2])]) -> Plate {
        let centre = Point::new(100.0, 70.0);
        let mut points = vec![[centre.x, centre.y, 0.0]; 468];
        for (i, &index) in OVAL.iter().enumerate() {
            let out = unit_at(std::f64::consts::TAU * i as f64 / OVAL.len() as f64 - std::f64::consts::FRAC_PI_2);
            points[index] = [centre.x + 40.0 * out.x, centre.y + 50.0 * out.y, 0.0];
        }
        (points[33], points[263]) = ([80.0, 65.0, 0.0], [120.0, 65.0, 0.0]);
        for &(index, [x, y]) in landmarks {
            points[index] = [x, y, 0.0];
        }
        let face = Landmarks { points, irises: [Iris { centre, radius: 3.0 }; 2], spectacles: None, pearls: Vec::new() };
        let heads = [Head::new(&face).expect("a head")];
        let subject = pixels.map(|_| 255_u8);
        Plate::new(pixels, &subject, &face, &heads, 0).expect("a plate")
    }

    #[test]
    fn a_whole_is_shared_out_without_remainder() {
        for whole in [0, 1, 7, 254, 255] {
            let out = apportioned(whole, [0.2, 0.31, 0.02, 0.0, 0.4]);
            assert_eq!(out.iter().map(|v| u32::from(*v)).sum::<u32>(), u32::from(whole));
        }
    }

    #[test]
    fn faces_out_of_the_picture_or_of_one_point_do_no_harm() {
        let pixels = Raster::from_fn(40, 30, |x, y| [(6 * x) as u8, (8 * y) as u8, 90]);
        let subject = Raster::filled(40, 30, 200_u8);
        for (x, y, width) in [(20.0, 15.0, 20.0), (-500.0, 15.0, 30.0), (39.0, 29.0, 300.0), (20.0, 15.0, 1.0), (20.0, 15.0, 0.0)]
        {
            let found = regions(&pixels, &subject, &[face(Point::new(x, y), width, 0.3)]);
            let sum = |x: usize, y: usize| {
                let all = [&found.skin, &found.hair, &found.facial_hair, &found.headwear, &found.clothing];
                all.iter().map(|r| u32::from(r.get(x, y))).sum::<u32>()
            };
            assert!((0..30).all(|y| (0..40).all(|x| sum(x, y) == 200)));
        }
        assert_eq!(regions(&pixels, &subject, &[]).clothing, subject);
    }
}
