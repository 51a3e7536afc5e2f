//! Step 1 (section 3.1): background, hair, face and the rest; each pixel belongs to one of them.

use super::Drawer;
use super::seen_face;
use super::skin::may_be_skin;
use crate::elementary::Elementary as _;
use crate::field::{CROWN, FaceExpectation, FaceFrame, find_face, hair_over_face};
use crate::geometry::{Point, Rect, Vec2};
use crate::raster;
use crate::raster::{
    Raster, close, components, erode, flood_from_border, gaussian_blur, majority, remove_components, without_holes,
};
use crate::source::MaskRole;
use crate::style::Picture;

/// The regions, each 0 to 1, in working pixels; they do not overlap.
pub(super) struct Regions {
    pub subject: Raster<f32>,
    pub hair: Raster<f32>,
    pub face: Raster<f32>,
    /// Frames of the faces whose pattern was found.
    pub frames: Vec<FaceFrame>,
    /// Clothing if given; otherwise everything that is neither hair nor face.
    pub clothing: Raster<f32>,
    pub has_background: bool,
}

impl Regions {
    /// Bare skin: what is neither hair nor clothing.
    pub(super) fn skin(&self) -> Raster<f32> {
        let bare = self.subject.zip_map(&self.hair, |subject, hair| (subject - hair).max(0.0));
        bare.zip_map(&self.clothing, |bare, cloth| (bare - cloth).max(0.0))
    }
}

/// Why no hair is drawn.
const NO_HAIR: &str = "no hair was found: it is drawn like the rest, not in strokes";
const LIKE_SKIN: &str = "the area above the brow is too like the skin, in light or shade, to count as hair: it is drawn like the rest, not in strokes";

impl Drawer<'_> {
    pub(super) fn new_regions(&self) -> Regions {
        self.observer.begin("regions");
        let mask = |role| self.portrait.masks.get(&role).cloned();
        let (subject, has_background) = self.subject();
        let (width, height) = self.size();
        let seen = &self.portrait.faces;
        let given_face = mask(MaskRole::Face);
        let head = if has_background { head(&subject) } else { None };
        let (frame, frames) = if seen.is_empty() {
            let frame = self.frame(&subject, head, given_face.as_ref());
            (frame, frame.into_iter().collect())
        } else {
            let frames: Vec<FaceFrame> = seen.iter().map(seen_face::frame).collect();
            (frames.first().copied(), frames)
        };
        let given_face = given_face.or_else(|| (!seen.is_empty()).then(|| seen_face::region(seen, width, height)));
        let given_hair = joined(mask(MaskRole::Hair), mask(MaskRole::FacialHair));
        let fringe = frame
            .filter(|_| seen.is_empty() || given_hair.is_none())
            .map(|frame| hair_over_face(&self.portrait.lightness, &subject, &frame));
        let hair = match (given_hair, &frame, &fringe) {
            (Some(given), ..) => Ok(given),
            (None, Some(frame), Some(fringe)) => self.found_hair(&subject, given_face.as_ref(), frame, fringe),
            _ => Err(NO_HAIR),
        };
        let nothing = || subject.map(|_| 0.0);
        if let Err(why) = hair {
            self.observer.want_mask(MaskRole::Hair, why);
        }
        let hair = hair.unwrap_or_else(|_| nothing()).zip_map(&subject, f32::min);
        let face = given_face
            .or_else(|| frame.zip(fringe).map(|(frame, fringe)| self.found_face(&frame, &fringe)))
            .unwrap_or_else(nothing);
        let face = face.zip_map(&subject, f32::min).zip_map(&hair, |face, hair| face.min(1.0 - hair));
        let rest = subject.zip_map(&hair, |s, hair| s.min(1.0 - hair)).zip_map(&face, |s, face| s.min(1.0 - face));
        let clothing = joined(mask(MaskRole::Clothing), mask(MaskRole::Headwear)).map_or_else(
            || if frame.is_some() { self.not_skin(&rest) } else { rest.clone() },
            |cloth| cloth.zip_map(&rest, f32::min),
        );
        let regions = Regions { subject, hair, face, frames, clothing, has_background };
        self.observer.picture("regions", &|| Picture::Labels(regions.labels()));
        regions
    }

    /// The rest of a person without neck and hands; like the face, those are drawn by the smudge alone.
    fn not_skin(&self, rest: &Raster<f32>) -> Raster<f32> {
        let skin = gaussian_blur(&may_be_skin(&self.portrait.light), 2.0);
        rest.zip_map(&skin, |rest, skin| rest * (1.0 - skin))
    }

    /// From the mask or alpha; otherwise the complement of a plain background; otherwise everything.
    fn subject(&self) -> (Raster<f32>, bool) {
        if self.portrait.subject.pixels().iter().any(|s| *s < 0.5) {
            return (self.portrait.subject.clone(), true);
        }
        if let Some(background) = self.plain_background() {
            let soft = gaussian_blur(&background.map(f32::from), 1.0);
            return (soft.map(|b| 1.0 - b), true);
        }
        let why = "the background is not plain enough to be separated from the subject, and there is no alpha channel: everything is drawn";
        self.observer.want_mask(MaskRole::Subject, why);
        (self.portrait.subject.clone(), false)
    }

    /// Flooded from the border through small steps of colour near the border's own (section 3.1.1's blue screen).
    fn plain_background(&self) -> Option<Raster<u8>> {
        /// Maximum colour step between neighbours within a plain background, in encoded light; even a blurred edge of a person is
        /// steeper.
        const BACKGROUND_STEP: f32 = 0.012;
        /// Maximum colour distance of a plain background from its border's median: a lit backdrop varies by a third.
        const BACKGROUND_SPREAD: f32 = 0.3;
        /// Range of shares of the picture in which a flooded background is accepted.
        const BACKGROUND_SHARE: (f64, f64) = (0.1, 0.9);
        let colour = self.colours();
        let (width, height) = self.size();
        // A person is cut by the picture's lower border.
        let lowest = height * 2 / 3;
        let mut border: Vec<[f32; 3]> = (0..width).map(|x| colour.get(x, 0)).collect();
        border.extend((0..lowest).flat_map(|y| [colour.get(0, y), colour.get(width - 1, y)]));
        let middle = median(&border);
        let pixels = colour.pixels();
        let is_near = |i: usize| distance(pixels[i], middle) < BACKGROUND_SPREAD;
        let plain = border.iter().filter(|c| distance(**c, middle) < BACKGROUND_SPREAD).count();
        if (plain as f64) < 0.75 * border.len() as f64 {
            return None;
        }
        let starts = |i: usize| i / width < lowest && is_near(i);
        let flooded = flood_from_border(width, height, starts, |from, to| {
            is_near(to) && distance(pixels[from], pixels[to]) < BACKGROUND_STEP
        });
        let subject = without_holes(&majority(&flooded, 2).map(|b| 1 - b));
        let subject = largest(&subject, 0.05);
        let background = subject.map(|s| 1 - s);
        let share = background.pixels().iter().map(|b| f64::from(*b)).sum::<f64>() / background.len() as f64;
        (BACKGROUND_SHARE.0..BACKGROUND_SHARE.1).contains(&share).then_some(background)
    }

    /// Encoded light, a little blurred.
    fn colours(&self) -> Raster<[f32; 3]> {
        let channel = |i: usize| gaussian_blur(&self.portrait.light.map(|rgb| rgb[i].cube_root()), 1.5);
        channel(0).zip_map(&channel(1), |r, g| [r, g]).zip_map(&channel(2), |[r, g], b| [r, g, b])
    }

    /// The face's pattern: inside the given mask; otherwise in the head, which is known only from a silhouette.
    fn frame(&self, subject: &Raster<f32>, head: Option<Rect>, given: Option<&Raster<f32>>) -> Option<FaceFrame> {
        /// Minimum score of a face found by search. In whole pictures the search finds faces in suits and coffee with scores as
        /// good as a real face's, so it is limited to the head of a silhouette.
        const LEAST_SCORE: f64 = 0.12;
        /// Position of the eyes in the box of a face (brow to chin) and of a head with its hair: how far down, the tolerances
        /// across and down, and the eye distance, as shares of the box.
        const IN_FACE: [f64; 4] = [0.39, 0.08, 0.07, 0.44];
        const IN_HEAD: [f64; 4] = [0.64, 0.1, 0.12, 0.36];
        let lightness = &self.portrait.lightness;
        if let Some(face) = given {
            return find_face(lightness, face, &expected_in(bounds(face)?, &IN_FACE));
        }
        let skin = gaussian_blur(&may_be_skin(&self.portrait.light).zip_map(subject, f32::min), 3.0);
        let frame = head.and_then(|head| find_face(lightness, &skin, &expected_in(head, &IN_HEAD)));
        let frame = frame.filter(|frame| frame.score >= LEAST_SCORE);
        if frame.is_none() {
            self.observer.want_mask(MaskRole::Face, "no face was found: its features are not drawn");
        }
        frame
    }

    /// The oval of a face around its pattern, less the hair that hangs into it.
    fn found_face(&self, frame: &FaceFrame, fringe: &Raster<u8>) -> Raster<f32> {
        let (width, height) = self.size();
        Raster::from_fn(width, height, |x, y| {
            let (across, down) = frame.relative(Point::new(x as f64 + 0.5, y as f64 + 0.5));
            // Egg-shaped: wider at the brow than at the chin.
            let breadth = if down < 0.3 { 1.12 } else { 1.12 - 0.2 * (down - 0.3) };
            let reach = ((across / breadth).powi(2) + ((down - 0.42) / 1.28).powi(2)).sqrt();
            let inside = ((1.0 - reach) as f32 * frame.eye_distance as f32 + 0.5).clamp(0.0, 1.0);
            inside * f32::from(1 - fringe.get(x, y))
        })
    }

    /// Pixels around the upper head that are nearer in colour to the crown than to the skin, with the hair hanging from them over the
    /// face; or the reason why there is none.
    fn found_hair(
        &self,
        subject: &Raster<f32>,
        face: Option<&Raster<f32>>,
        frame: &FaceFrame,
        fringe: &Raster<u8>,
    ) -> Result<Raster<f32>, &'static str> {
        /// Minimum of the colour distance within which a pixel is hair, if it is nearer to the hair's colour than to the skin's.
        const HAIR_REACH: f32 = 0.16;
        /// Minimum colour distance between hair and skin, and the distance from which colour alone identifies hair. On the dark
        /// bust it is smaller, and half of the face would become hair; blond hair has half as much, and only its crown and the
        /// hair hanging from it are taken.
        const LEAST_CONTRAST: f32 = 0.12;
        const CLEAR_CONTRAST: f32 = 0.3;
        /// Shares of its encoded light that skin has from its lit to its shaded side; hair differs from all of them.
        const SHADE: [f32; 5] = [1.0, 0.9, 0.8, 0.7, 0.6];
        /// How far down hair hangs beside a face, in eye distances.
        const LOWEST_FRINGE: f64 = 0.75;
        let colour = self.colours();
        let (hair, skin) = Self::hair_and_skin(&colour, subject, frame).ok_or(NO_HAIR)?;
        let contrast = distance(hair, skin);
        if contrast < LEAST_CONTRAST {
            return Err(LIKE_SKIN);
        }
        let reach = HAIR_REACH.max(0.5 * contrast);
        let (width, height) = self.size();
        let near = Raster::from_fn(width, height, |x, y| {
            let (across, down) = frame.relative(Point::new(x as f64 + 0.5, y as f64 + 0.5));
            let zone = (across / 1.9).powi(2) + ((down + 0.3) / 2.1).powi(2) < 1.0 && subject.get(x, y) >= 0.5;
            let is_face = across.abs() < 0.95 && (-0.62..1.5).contains(&down);
            let c = colour.get(x, y);
            let hangs = fringe.get(x, y) != 0 && down < LOWEST_FRINGE;
            let is_hair = distance(c, hair) < reach && SHADE.iter().all(|s| distance(c, hair) < distance(c, skin.map(|v| s * v)));
            // Above the brow a head has only hair or skin.
            let is_crown = down < CROWN && distance(c, hair) < distance(c, skin);
            u8::from(zone && (hangs || is_crown || (!is_face && is_hair && contrast >= CLEAR_CONTRAST)))
        });
        let near = face.map_or(near.clone(), |face| near.zip_map(face, |n, face| if face >= 0.5 { 0 } else { n }));
        let whole = without_holes(&largest(&majority(&without_partings(&near, subject, frame), 2), 0.2));
        let area: f64 = whole.pixels().iter().map(|v| f64::from(*v)).sum();
        if area <= 0.3 * frame.eye_distance.powi(2) {
            return Err(NO_HAIR);
        }
        // The shade of a shaved head and the gleam of a bald one also form regions.
        let is_hair = is_unlike_skin(hair, skin) || self.is_rough(&whole, frame);
        if is_hair { Ok(gaussian_blur(&whole.map(f32::from), 1.0)) } else { Err(LIKE_SKIN) }
    }

    /// True if a region has strands: compares its texture, relative to its light and away from its border, with that of the cheeks.
    fn is_rough(&self, region: &Raster<u8>, frame: &FaceFrame) -> bool {
        /// Width of a strand in eye distances, and the texture from which a skin-coloured region is hair, relative to the cheeks:
        /// two bald heads have 1.2 and 1.6, curls as light as skin 4.4. Cheeks in photographs have a texture of 0.024 to 0.08 of
        /// their light; drawn ones almost none.
        const STRAND: f64 = 0.03;
        const ROUGH: f64 = 2.5;
        const LEAST_TEXTURE: f64 = 0.02;
        let lightness = &self.portrait.lightness;
        let size = frame.eye_distance;
        let broad = gaussian_blur(lightness, (STRAND * size) as f32);
        let texture = lightness.zip_map(&broad, |fine, broad| (fine - broad).abs() / broad.max(0.02));
        let inside = erode(region, (2.0 * STRAND * size).ceil() as usize);
        let mean = |weight: &dyn Fn(usize) -> bool| {
            let values: Vec<f32> = texture.pixels().iter().enumerate().filter(|(i, _)| weight(*i)).map(|(_, v)| *v).collect();
            f64::from(values.iter().sum::<f32>()) / values.len().max(1) as f64
        };
        let width = lightness.width();
        let is_cheek = |i: usize| {
            let p = Point::new((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
            let (across, down) = frame.relative(p);
            (0.3..0.6).contains(&across.abs()) && (0.3..0.7).contains(&down)
        };
        let (hair, skin) = (mean(&|i| inside.pixels()[i] != 0), mean(&is_cheek));
        hair >= ROUGH * skin.max(LEAST_TEXTURE)
    }

    /// The colours of the crown and of the skin; none if the subject has only skin above its brow.
    fn hair_and_skin(colour: &Raster<[f32; 3]>, subject: &Raster<f32>, frame: &FaceFrame) -> Option<([f32; 3], [f32; 3])> {
        let at = |p: Point| colour.clamped(p.x as isize, p.y as isize);
        let inside = |p: Point| subject.contains(p.x as isize, p.y as isize) && subject.sample(p.x, p.y) >= 0.5;
        let cheeks = [(0.0, -0.25), (0.4, 0.5), (-0.4, 0.5), (0.0, 0.3), (0.3, 0.4), (-0.3, 0.4)];
        let skin = median(&cheeks.map(|(across, down)| at(frame.place(across, down))));
        // Upwards from the brow to the subject's end: the far half of the pixels that are not skin is hair.
        let crown: Vec<[f32; 3]> = (-3..=3)
            .flat_map(|column| (0..60).map(move |i| (0.2 * f64::from(column), -0.6 - 0.03 * f64::from(i))))
            .map(|(across, down)| frame.place(across, down))
            .filter(|p| inside(*p))
            .map(at)
            .filter(|c| distance(*c, skin) > 0.1)
            .collect();
        (crown.len() >= 20).then(|| (median(&crown), skin))
    }
}

/// Union of two masks.
fn joined(a: Option<Raster<f32>>, b: Option<Raster<f32>>) -> Option<Raster<f32>> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.zip_map(&b, f32::max)),
        (a, b) => a.or(b),
    }
}

/// Share of its encoded light below which nothing is shaded skin, and the colour distance to skin in any light from which a colour is
/// not skin. Tuned on the busts and the portraits: a shaved head's shaded side has 0.72 and 0.08, a bald forehead's gleam 1.12 and 0.05;
/// black and brown hair has 0.3 to 0.57, white and grey hair 0.13 to 0.22.
const DARKEST_SKIN: f32 = 0.62;
const LEAST_STRANGE: f32 = 0.1;

/// True if a colour differs from this skin's colour in any light.
fn is_unlike_skin(hair: [f32; 3], skin: [f32; 3]) -> bool {
    let dot = |a: [f32; 3], b: [f32; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f32>();
    let share = dot(hair, skin) / dot(skin, skin).max(1e-6);
    share < DARKEST_SKIN || distance(hair, skin.map(|v| share * v)) > LEAST_STRANGE
}

impl Regions {
    /// 0 background, 1 hair, 2 face, 3 clothing, 4 the rest.
    fn labels(&self) -> Raster<i32> {
        let (width, height) = (self.subject.width(), self.subject.height());
        Raster::from_fn(width, height, |x, y| match (x, y) {
            _ if self.subject.get(x, y) < 0.5 => 0,
            _ if self.hair.get(x, y) >= 0.5 => 1,
            _ if self.face.get(x, y) >= 0.5 => 2,
            _ if self.clothing.get(x, y) >= 0.5 => 3,
            _ => 4,
        })
    }
}

/// The components with at least `share` of the pixels of the largest.
fn largest(mask: &Raster<u8>, share: f64) -> Raster<u8> {
    let (labels, count) = components(mask);
    let mut sizes = vec![0_usize; count + 1];
    labels.pixels().iter().for_each(|label| sizes[*label as usize] += 1);
    let most = sizes[1..].iter().copied().max().unwrap_or(0) as f64;
    remove_components(mask, &labels, |label| sizes[label as usize] as f64 >= share * most)
}

fn distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f32>().sqrt()
}

fn median(colours: &[[f32; 3]]) -> [f32; 3] {
    [0, 1, 2].map(|i| raster::median(colours.iter().map(|c| c[i]).collect()).unwrap_or(0.0))
}

/// The box around a silhouette's head, from its top to where it narrows to a neck; none if it never does.
fn head(subject: &Raster<f32>) -> Option<Rect> {
    let extent = |y: usize| {
        let inside = |x: &usize| subject.get(*x, y) >= 0.5;
        let columns = 0..subject.width();
        Some((columns.clone().find(inside)? as f64, columns.rev().find(inside)? as f64 + 1.0))
    };
    let mut head: Option<Rect> = None;
    for y in 0..subject.height() {
        let Some((left, right)) = extent(y) else { continue };
        let row = Rect::new(left, y as f64, right, y as f64 + 1.0);
        let grown = head.map_or(row, |head| head.union(row));
        if let Some(head) = head
            && head.height() > 0.5 * head.width()
            && right - left < 0.8 * head.width()
        {
            return Some(head);
        }
        head = Some(grown);
    }
    None
}

fn expected_in(bounds: Rect, [down, across_tolerance, down_tolerance, distance]: &[f64; 4]) -> FaceExpectation {
    FaceExpectation {
        between_eyes: Point::new(bounds.center().x, bounds.y0 + down * bounds.height()),
        tolerance: Vec2::new(across_tolerance * bounds.width(), down_tolerance * bounds.height()),
        eye_distance: distance * bounds.width(),
    }
}

/// The box around a region; none if it is empty.
fn bounds(region: &Raster<f32>) -> Option<Rect> {
    let inside = region.pixels().iter().enumerate().filter(|(_, v)| **v >= 0.5);
    inside
        .map(|(i, _)| ((i % region.width()) as f64, (i / region.width()) as f64))
        .map(|(x, y)| Rect::new(x, y, x + 1.0, y + 1.0))
        .reduce(|a, b| a.union(b))
}

/// The hair with its partings, where the scalp is lit, in the crown.
fn without_partings(hair: &Raster<u8>, subject: &Raster<f32>, frame: &FaceFrame) -> Raster<u8> {
    /// Half the width of a gap in the crown that is closed: a lit parting is as light as skin.
    const CLOSED: f64 = 0.3;
    let gap = (CLOSED * frame.eye_distance).round() as usize;
    let closed = close(&majority(hair, 2), gap);
    Raster::from_fn(hair.width(), hair.height(), |x, y| {
        let down = frame.relative(Point::new(x as f64 + 0.5, y as f64 + 0.5)).1;
        if down < CROWN && subject.get(x, y) >= 0.5 { closed.get(x, y) } else { hair.get(x, y) }
    })
}
