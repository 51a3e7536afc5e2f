//! What facial hair looks like: darker, greyer and more uneven than the cheeks.

use super::plate::Plate;
use crate::elementary::Elementary as _;
use crate::raster::{Raster, dilate, gaussian_blur, median};
use crate::source::outlines::LIPS;

/// Landmarks below the cheekbones, where no beard grows.
const CHEEKS: [usize; 6] = [50, 101, 205, 280, 330, 425];
/// The middle of the upper lip.
const PHILTRUM: usize = 2;
/// A zone is covered if both of its halves (the nose's shadow falls on one) are covered by the same sign: the median is below `DARK` times the
/// cheeks' lightness, uneven enough and below `SHADED` of their colour, which shadow has more of; or its colour is pale and L* above `BLACK`; or
/// its lightness is below `DARKEST`.
const DARK: f32 = 0.8;
const SHADED: f32 = 1.35;
const BLACK: f32 = 18.0;
const DARKEST: f32 = 0.45;
/// A dark zone more uneven than this is hair of any colour: a red-brown moustache has 11 to 13, the shade below a nose at most 5.
const BRISTLY: f32 = 9.0;
/// Without colour, grey beards are as light as cheeks but rougher: up to this lightness of theirs, from this unevenness on. Shaded lips and
/// noses of the sixteen portraits in grey that are no darker have at most 6.3.
const ROUGH_LIGHT: f32 = 0.9;
const ROUGH: f32 = 7.2;
/// Fewest pixels for which a half is measured.
const LEAST_HALF: usize = 8;
/// A pixel between the lips' borders that is below this fraction of the cheeks' lightness is hair hanging over them.
const OVER_LIPS: f32 = 0.55;

/// How strict the limits are: of the portraits' beards as they are, and of those in much or coloured light, which are asked only where the first find
/// no full beard. Tuned on sixteen portraits, four with beards or moustaches, as they are and lighter, darker, warmer and cooler, and on sixteen
/// faces in company, which have none. There no zone is as dark with more than 3.9 of unevenness in both halves, beards have at least
/// 5.5; in warm light a white beard has 0.71 of the cheeks' colour, shaven chins with a shine 0.81.
///
/// Soft beards are brown or thin: neither rough nor grey enough, but lip and chin are both darker than the cheek of their own side.
#[derive(Clone, Copy)]
pub(super) enum Limits {
    Sure,
    Faint,
    Soft,
}

impl Limits {
    /// The least unevenness of a dark zone; soft beards have signs of their own.
    const fn uneven(self) -> f32 {
        match self {
            Self::Sure => 6.6,
            Self::Faint | Self::Soft => 5.0,
        }
    }

    /// The most colour of a pale zone, in shares of the cheeks'.
    const fn pale(self) -> f32 {
        match self {
            Self::Sure => 0.7,
            Self::Faint | Self::Soft => 0.75,
        }
    }

    /// Most lightness and least unevenness of dark hairs, and most colour of pale ones.
    const fn hairs(self) -> [f32; 3] {
        match self {
            Self::Sure => [0.74, 5.5, 0.74],
            Self::Faint => [0.78, 5.0, 0.76],
            // Where there is a soft beard little roughness is enough; with 2 shaven jaws in shade are beard.
            Self::Soft => [DARK, 2.8, 0.7],
        }
    }
}

/// Lightness, colour and unevenness of each pixel relative to the cheeks.
pub(super) struct Face<'a> {
    plate: &'a Plate,
    /// L* divided by the cheeks'.
    light: Raster<f32>,
    /// Chroma relative to lightness, divided by the cheeks'.
    colour: Raster<f32>,
    uneven: Raster<f32>,
    pub(super) lips: Raster<bool>,
    limits: Limits,
}

impl<'a> Face<'a> {
    pub(super) fn new(plate: &'a Plate, limits: Limits) -> Option<Self> {
        let light = plate.lab.map(|c| c[0]);
        let colour = plate.lab.map(|c| c[1].hypotenuse(c[2]) / (c[0] + 8.0));
        let (light_there, colour_there) = match limits {
            Limits::Sure | Limits::Faint => (cheeks_level(plate, &light, 1.0)?, cheeks_level(plate, &colour, 0.01)?),
            Limits::Soft => (level_by_side(plate, &light, 1.0)?, level_by_side(plate, &colour, 0.01)?),
        };
        let smooth = gaussian_blur(&light, 0.02 * plate.face_width);
        let energy = gaussian_blur(&light.zip_map(&smooth, |v, s| (v - s) * (v - s)), 0.03 * plate.face_width);
        let uneven = energy.zip_map(&light, |e, l| 50.0 * e.max(0.0).sqrt() / (l + 8.0));
        let lips = dilate(&plate.hull(&LIPS).map(u8::from), 1).map(|v| v != 0);
        Some(Self {
            plate,
            light: light.zip_map(&light_there, |v, there| v / there),
            colour: colour.zip_map(&colour_there, |v, there| v / there),
            uneven,
            lips,
            limits,
        })
    }

    /// The halves of a zone on both sides of the lip's middle that are large enough to measure.
    fn halves(&self, zone: &Raster<bool>) -> Vec<Raster<bool>> {
        let middle = self.plate.coordinates(self.plate.point(PHILTRUM))[0];
        let half = |sign: f32| self.plate.pixels_where(|[u, _], i| zone.pixels()[i] && sign * (u - middle) > 0.01);
        let is_measured = |half: &Raster<bool>| half.pixels().iter().filter(|is| **is).count() >= LEAST_HALF;
        [-1.0, 1.0].into_iter().map(half).filter(is_measured).collect()
    }

    /// True if both halves of a zone look covered with hair, by the same sign: one in light and one in shade are skin.
    pub(super) fn is_covered(&self, zone: &Raster<bool>) -> bool {
        let halves: Vec<Vec<bool>> = self.halves(zone).iter().filter_map(|half| self.signs(half)).map(Vec::from).collect();
        !halves.is_empty() && (0..halves[0].len()).any(|sign| halves.iter().all(|half| half[sign]))
    }

    /// Whether hair covers a half of a zone: by its darkness, by its paleness, by black, by roughness where there is no colour.
    fn signs(&self, half: &Raster<bool>) -> Option<[bool; 4]> {
        let [light, colour, uneven] = [&self.light, &self.colour, &self.uneven].map(|plane| median_in(plane, half));
        let (light, colour, uneven) = (light?, colour?, uneven?);
        let l = median_in(&self.plate.lab.map(|c| c[0]), half)?;
        let is_grey = self.plate.is_grey;
        Some([
            light < DARK && uneven > self.limits.uneven() && (is_grey || colour < SHADED),
            !is_grey && colour < self.limits.pale() && l > BLACK,
            light < DARKEST && ((uneven > 6.5 && colour < 1.3) || uneven > BRISTLY),
            is_grey && light < ROUGH_LIGHT && uneven > ROUGH,
        ])
    }

    /// True if both halves of the upper lip and of the chin are darker than the cheek beside them, and not smooth.
    ///
    /// Tuned on 63 people beside the sixteen portraits: of the brown or thin beards, four, the zones have at most 0.83 and 0.76 of the cheeks'
    /// lightness and at least 4.2 and 3.3 of unevenness. Of those without one, none is below 0.89 in both halves of the lip and 0.8 in those of
    /// the chin with more than 2.7. A goatee in a dark, noisy photograph (2.9) is left out: its border cannot be told from shade.
    pub(super) fn is_soft_beard(&self, chin: &Raster<bool>, moustache: &Raster<bool>) -> bool {
        /// Most lightness and least unevenness. Neither zone alone tells them from shade.
        const LIP: [f32; 2] = [0.84, 3.8];
        const CHIN: [f32; 2] = [0.78, 3.2];
        let is_dark = |zone: &Raster<bool>, [light, uneven]: [f32; 2]| {
            let halves = self.halves(zone);
            let is_hair = |half| {
                median_in(&self.light, half).is_some_and(|l| l < light)
                    && median_in(&self.uneven, half).is_some_and(|u| u > uneven)
            };
            halves.len() == 2 && halves.iter().all(is_hair)
        };
        is_dark(moustache, LIP) && is_dark(chin, CHIN)
    }

    /// True if a chin is white in both halves and the upper lip in one, as under a white beard whose other half lies in coloured light.
    pub(super) fn is_white_goatee(&self, chin: &Raster<bool>, moustache: &Raster<bool>) -> bool {
        /// The most colour of such a chin: white beards have 0.46 to 0.6, shaven chins with a shine 0.8, half of one in a poor photograph 0.63.
        const WHITE: f32 = 0.61;
        let is_pale = |half: &Raster<bool>, most: f32| median_in(&self.colour, half).is_some_and(|colour| colour < most);
        let chin = self.halves(chin);
        let is_chin = !chin.is_empty() && chin.iter().all(|half| is_pale(half, WHITE));
        is_chin && self.halves(moustache).iter().any(|half| is_pale(half, Limits::Faint.pale())) && !self.plate.is_grey
    }

    /// True for a pixel as smooth as a neck: below the chin only rough places are a soft beard.
    pub(super) fn is_smooth(&self, i: usize) -> bool {
        self.uneven.pixels()[i] < Limits::Faint.uneven()
    }

    /// The pixels too dark for lips.
    pub(super) fn over_lips(&self) -> Raster<bool> {
        let light = gaussian_blur(&self.light, 0.012 * self.plate.face_width);
        self.plate.pixels_where(|_, i| light.pixels()[i] < OVER_LIPS)
    }

    /// The pixels that have more colour than a full beard or are far lighter: cheek and neck in its shade, collars. None in grey
    /// photographs.
    pub(super) fn beside_beard(&self, hairs: &Raster<bool>, chin: &Raster<bool>) -> Raster<bool> {
        /// The most colour of a grey beard, and where between its colour and the cheeks' the neck's begins.
        const GREY_BEARD: f32 = 0.8;
        const BETWEEN: f32 = 0.5;
        /// Where the neck's begins beside brown beards, at least and in shares of theirs: a shaded neck has 1.3 and more, a brown
        /// beard in light about 1.1 (portraits 04 and 11). Inside the oval that counts beside grey beards alone.
        const SHADED: f32 = 1.2;
        const ABOVE: f32 = 1.1;
        /// The lightness of collars, at least and in shares of the beard's: white beards differ less from place to place.
        const COLLAR: f32 = 1.1;
        const LIGHTER: f32 = 1.3;
        /// The distance of a garment's colour from a grey beard's in the plane of a* and b*: a blue shirt has 20, hairs of one beard up to 10.
        /// In black hair beside a brown chin there is as much: garments are not darker than this share of the beard's lightness.
        const OTHER_COLOUR: f32 = 15.0;
        const LEAST_LIGHT: f32 = 0.8;
        let blurred = |plane: &Raster<f32>| gaussian_blur(plane, 0.012 * self.plate.face_width);
        let (colour, light) = (blurred(&self.colour), blurred(&self.light));
        let on_chin = hairs.zip_map(chin, |hair, chin| hair && chin);
        let (Some(beard), Some(lightness)) = (median_in(&colour, &on_chin), median_in(&light, &on_chin)) else {
            return hairs.map(|_| false);
        };
        let [a, b] = [1, 2].map(|i| blurred(&self.plate.lab.map(|c| c[i])));
        let [a_there, b_there] = [&a, &b].map(|plane| median_in(plane, &on_chin).unwrap_or(0.0));
        let away = a.zip_map(&b, |a, b| (a - a_there).hypotenuse(b - b_there));
        let is_grey = beard < GREY_BEARD;
        let [inside, beside] = match beard {
            grey if grey < GREY_BEARD => [SHADED, grey + BETWEEN * (1.0 - grey)],
            brown if brown < SHADED => [f32::INFINITY, SHADED.max(ABOVE * brown)],
            // Red beards have more colour than any neck.
            _ => [f32::INFINITY; 2],
        };
        let collar = COLLAR.max(LIGHTER * lightness);
        self.plate.pixels_where(|_, i| {
            let colour = colour.pixels()[i];
            let light = light.pixels()[i];
            let is_garment = light > collar || (is_grey && away.pixels()[i] > OTHER_COLOUR && light > LEAST_LIGHT * lightness);
            let is_beside = !self.plate.oval.pixels()[i] && (colour > beside || is_garment);
            !self.plate.is_grey && (is_beside || colour > inside)
        })
    }

    /// With those of a full beard as light as the cheeks, where there is no colour to tell it by.
    pub(super) fn with_rough(&self, hairs: &Raster<bool>) -> Raster<bool> {
        if !self.plate.is_grey {
            return hairs.clone();
        }
        let blur = |plane: &Raster<f32>, width: f32| gaussian_blur(plane, width * self.plate.face_width);
        let (light, uneven) = (blur(&self.light, 0.012), blur(&self.uneven, 0.02));
        let is_rough = |i: usize| light.pixels()[i] < ROUGH_LIGHT && uneven.pixels()[i] > ROUGH;
        self.plate.pixels_where(|_, i| hairs.pixels()[i] || is_rough(i))
    }

    /// The hairs with those of a white moustache that is thin in places: in its zone less colour is enough, where one half is surely white.
    pub(super) fn with_thin_moustache(&self, hairs: Raster<bool>, zone: &Raster<bool>) -> Raster<bool> {
        /// The colour of thin places, in shares of the cheeks': 0.8 in portrait 14; bare lips beside red cheeks have 0.9 and more.
        const THIN: f32 = 0.88;
        let is_white = |half: &Raster<bool>| {
            let [colour, light] = [&self.colour, &self.light].map(|plane| median_in(plane, half));
            colour.is_some_and(|colour| colour < self.limits.pale()) && light.is_some_and(|light| light > DARK)
        };
        if self.plate.is_grey || !self.halves(zone).iter().any(is_white) {
            return hairs;
        }
        let colour = gaussian_blur(&self.colour, 0.02 * self.plate.face_width);
        self.plate.pixels_where(|_, i| hairs.pixels()[i] || (zone.pixels()[i] && colour.pixels()[i] < THIN))
    }

    /// The pixels that look like facial hair. Beside a dark chin a pale cheek is a light, no white hair. In soft beards they are no nearer to the cheeks' lightness than to the chin's: shaded skin beside
    /// them is darker than cheeks too.
    pub(super) fn hairs(&self, chin: &Raster<bool>) -> Raster<bool> {
        /// The lightness of a pale place, in shares of the cheeks', from which it is a light.
        const LIT: f32 = 0.95;
        /// Where cheeks begin: aside from the chin, in `u`, and above it, in `v`.
        const CHEEK: [f32; 2] = [0.25, 0.12];
        let blur = |plane: &Raster<f32>, width: f32| gaussian_blur(plane, width * self.plate.face_width);
        let (light, colour, uneven) = (blur(&self.light, 0.012), blur(&self.colour, 0.012), blur(&self.uneven, 0.02));
        let [dark, rough, pale] = self.limits.hairs();
        let on_chin = median_in(&self.light, chin);
        let dark = match self.limits {
            Limits::Soft => on_chin.map_or(dark, |chin| dark.min(0.5 + 0.5 * chin)),
            Limits::Sure | Limits::Faint => dark,
        };
        let has_dark_chin = on_chin.is_some_and(|light| light < DARK);
        let middle = self.plate.chin();
        self.plate.pixels_where(|_, i| {
            let (l, c) = (light.pixels()[i], colour.pixels()[i]);
            let is_dark = l < dark && uneven.pixels()[i] > rough;
            let [u, v] = self.plate.at.pixels()[i];
            let is_lit_cheek = has_dark_chin && l > LIT && v > CHEEK[1] && (u - middle).abs() > CHEEK[0];
            let is_pale = !self.plate.is_grey && c < pale && !is_lit_cheek;
            is_dark || is_pale || (l < 0.42 && self.colour.pixels()[i] < 1.35 && self.uneven.pixels()[i] > 3.5)
        })
    }
}

/// The cheeks' median everywhere.
fn cheeks_level(plate: &Plate, plane: &Raster<f32>, least: f32) -> Option<Raster<f32>> {
    let level = median_in(plane, &plate.round(&CHEEKS, 0.06))?.max(least);
    Some(plane.map(|_| level))
}

/// The median of the cheek of each side, and between them what lies between: light from one side makes no half darker.
fn level_by_side(plate: &Plate, plane: &Raster<f32>, least: f32) -> Option<Raster<f32>> {
    /// Cheeks nearer than this, in widths of the face, are those of a profile: there is no other side.
    const CLOSE: f32 = 0.15;
    let across = plate.at.map(|[u, _]| u);
    let (right, left) = CHEEKS.split_at(CHEEKS.len() / 2);
    let level = |cheek: &[usize]| {
        // The far cheek of a turned head lies at the border.
        let zone = plate.round(cheek, 0.06).zip_map(&plate.oval, |near, face| near && face);
        Some([median_in(&across, &zone)?, median_in(plane, &zone)?.max(least)])
    };
    let (Some([from, first]), Some([to, last])) = (level(right), level(left)) else { return cheeks_level(plate, plane, least) };
    let width = to - from;
    if width.abs() < CLOSE {
        return cheeks_level(plate, plane, least);
    }
    Some(across.map(|u| first + ((u - from) / width).clamp(0.0, 1.0) * (last - first)))
}

/// The median over a zone.
fn median_in(plane: &Raster<f32>, zone: &Raster<bool>) -> Option<f32> {
    median(plane.pixels().iter().zip(zone.pixels()).filter(|(_, is)| **is).map(|(v, _)| *v).collect())
}

#[cfg(test)]
mod tests {
    use super::super::tests::plate_with;
    use super::*;

    /// A face in light from the picture's right, and its lip and chin that are `dark` times as light as the skin around and have grain; without
    /// grain the whole lower face is.
    fn face(dark: f32, grain: f32) -> (Plate, [Raster<bool>; 2]) {
        let is_in = |y: usize, rows: std::ops::Range<usize>, x: usize| (80..120).contains(&x) && rows.contains(&y);
        let [lip, chin] = [78..92, 96..116];
        let pixels = Raster::from_fn(200, 200, |x, y| {
            let skin = 90.0 + 90.0 * ((x as f32 - 75.0) / 50.0).clamp(0.0, 1.0);
            let rough = 1.0 + if (x / 2 + y / 2) % 2 == 0 { grain } else { -grain };
            let is_dark = is_in(y, lip.clone(), x) || is_in(y, chin.clone(), x) || (grain == 0.0 && y > 74);
            let hair = if is_dark { dark * rough } else { 1.0 };
            [1.0, 0.8, 0.7].map(|share| (share * skin * hair) as u8)
        });
        let cheeks = CHEEKS.iter().enumerate().map(|(i, index)| (*index, [if i < 3 { 75.0 } else { 125.0 }, 70.0]));
        let landmarks: Vec<(usize, [f64; 2])> = cheeks.chain([(PHILTRUM, [100.0, 80.0])]).collect();
        let plate = plate_with(&pixels, &landmarks);
        let origin = plate.point(PHILTRUM) - crate::geometry::Point::new(100.0, 80.0);
        let zone = |rows: &std::ops::Range<usize>| {
            Raster::from_fn(plate.width(), plate.height(), |x, y| {
                let [x, y] = [x as f64 - origin.x, y as f64 - origin.y].map(|v| v.round().max(0.0) as usize);
                is_in(y, rows.clone(), x)
            })
        };
        let zones = [zone(&lip), zone(&chin)];
        (plate, zones)
    }

    #[test]
    fn lip_and_chin_darker_and_rougher_than_their_side_are_a_soft_beard() {
        let is_beard = |dark, grain| {
            let (plate, [lip, chin]) = face(dark, grain);
            Face::new(&plate, Limits::Soft).expect("a face").is_soft_beard(&chin, &lip)
        };
        assert!(is_beard(0.5, 0.3));
        assert!(!is_beard(0.5, 0.0), "shade");
        assert!(!is_beard(0.97, 0.3), "pores");
    }

    #[test]
    fn light_from_one_side_makes_no_side_darker() {
        let (plate, [lip, _]) = face(1.0, 0.0);
        let of = |limits| Face::new(&plate, limits).expect("a face");
        let halves =
            |face: &Face<'_>| face.halves(&lip).iter().filter_map(|half| median_in(&face.light, half)).collect::<Vec<f32>>();
        assert!(halves(&of(Limits::Sure)).iter().any(|light| *light < 0.9));
        assert!(halves(&of(Limits::Soft)).iter().all(|light| (light - 1.0).abs() < 0.1), "{:?}", halves(&of(Limits::Soft)));
    }

    #[test]
    fn a_pale_cheek_is_a_light_beside_a_dark_chin_and_white_hair_beside_a_light_one() {
        let is_chin = |x: usize, y: usize| (85..115).contains(&x) && (100..116).contains(&y);
        let is_pale = |x: usize, y: usize| (60..78).contains(&x) && (80..100).contains(&y);
        let is_hair = |chin: f32| {
            let pixels = Raster::from_fn(200, 200, |x, y| match (is_chin(x, y), is_pale(x, y)) {
                (true, _) => [180.0, 144.0, 126.0].map(|v| (chin * v) as u8),
                (_, true) => [205, 200, 195],
                // A wall as light as the skin, so that the picture has colours.
                _ if x < 50 => [110, 160, 150],
                _ => [180, 144, 126],
            });
            let plate = plate_with(&pixels, &CHEEKS.map(|i| (i, [if i < 250 { 80.0 } else { 120.0 }, 60.0])));
            let origin = plate.point(CHEEKS[0]) - crate::geometry::Point::new(80.0, 60.0);
            let at = |v: usize, away: f64| (v as f64 + away).round() as usize;
            let chin = Raster::from_fn(plate.width(), plate.height(), |x, y| is_chin(at(x, -origin.x), at(y, -origin.y)));
            Face::new(&plate, Limits::Sure).expect("a face").hairs(&chin).get(at(69, origin.x), at(90, origin.y))
        };
        assert_eq!([is_hair(0.4), is_hair(1.0)], [false, true]);
    }
}
