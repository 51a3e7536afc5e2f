//! Pearls: earrings and necklaces, which are small, bright and round. By colour they are taken for the collar or the hair beside them.
//!
//! ```text
//!   ears and neck --> bright round spots at four sizes --> those on bare skin --> on strings, or firm pale ones below an ear --> circles
//! ```

use super::pearl_shape::{seen, strung};
use super::sight::Regions;
use crate::geometry::{Point, Region, Vec2};
use crate::parallel::collected;
use crate::raster::{Raster, fast_gaussian, median};
use crate::source::{Landmarks, byte_to_linear, lightness, luminance, outlines};
use kurbo::Circle;
use std::ops::Range;

/// Scales of the spots in widths of the face: a pearl has a radius of 1.41 scales.
const SCALES: [f64; 4] = [0.011, 0.015, 0.02, 0.027];
pub(super) const RADIUS: f64 = std::f64::consts::SQRT_2;
/// Narrower spots, in pixels, are grain.
const LEAST_SCALE: f64 = 1.2;
/// The least curvature of a spot, scaled, in lightness, and its least share of that across. On sixteen portraits pearls have 0.04 to 0.14;
/// collars and brooches have as much, but stand alone.
const CURVED: f32 = 0.04;
const ROUND: f32 = 0.4;
/// That of a spot that needs no company, below an ear.
const FIRM: f32 = 0.09;

/// The least share of skin around a pearl. Around those of the portraits it is 0.2 and more; around dotted ties, ribbons and prints, 0.06.
const LEAST_SKIN: f64 = 0.12;

/// Red over blue, as a share of red, of an earring, in those of the skin: lobes in light have more (1.2 to 2 where pearls have up to 0.6).
/// Skin with less has no colour: in black and white a lobe in light is as round and as bright.
const PALE: f64 = 0.8;
const COLOURED: f64 = 0.06;

/// A bright round spot in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spot {
    pub centre: Point,
    pub scale: f64,
    pub curved: f32,
}

/// The lightness of a part of the picture, and its upper left corner.
struct Near {
    light: Raster<f32>,
    from: Vec2,
}

/// Where a face may wear pearls.
struct Bust<'a> {
    face: &'a Landmarks,
    width: f64,
    up: Vec2,
    oval: Region,
}

/// The subject with the pearls, and its regions with them as detail, and with skin in place of the cloth and hair there: neither hatches nor strands run over them. And the
/// pearls of each face that are seen as circles.
pub(super) fn with_pearls(
    pixels: &Raster<[u8; 3]>,
    subject: &Raster<u8>,
    faces: &[Landmarks],
    mut regions: Regions,
) -> (Raster<u8>, Regions, Vec<Vec<Circle>>) {
    let busts: Vec<Option<Bust<'_>>> = faces.iter().map(Bust::of).collect();
    let is_face = |p: Point| busts.iter().flatten().any(|bust| bust.oval.contains(p));
    let worn_by = |bust: &Bust<'_>| {
        let Some(near) = bust.near(pixels) else { return (Vec::new(), Vec::new()) };
        let mut spots = bust.spots(&near, subject);
        spots.retain(|spot| !is_face(spot.centre) && skin_share(spot, &regions) > LEAST_SKIN);
        bust.pearls(&spots, &near, pixels)
    };
    let (spots, mut pearls): (Vec<Vec<Spot>>, Vec<Vec<Circle>>) =
        busts.iter().map(|bust| bust.as_ref().map_or_else(Default::default, worn_by)).unzip();
    spots.into_iter().flatten().for_each(|spot| paint(&mut regions, subject, spot));
    // People beside one another may be given the same pearl.
    let mut taken: Vec<Circle> = Vec::new();
    for worn in &mut pearls {
        worn.retain(|pearl| taken.iter().all(|other| other.center.distance(pearl.center) > other.radius));
        taken.extend_from_slice(worn);
    }
    // Those that hang beside the neck are part of the person.
    let mut whole = subject.clone();
    for pearl in &taken {
        for (x, y, away) in pixels_within(pearl.radius + 1.0, pearl.center, (subject.width(), subject.height())) {
            let own = (255.0 * (pearl.radius - away + 0.5).clamp(0.0, 1.0)) as u8;
            let more = own.saturating_sub(whole.get(x, y));
            whole.set(x, y, whole.get(x, y) + more);
            regions.skin.set(x, y, regions.skin.get(x, y).saturating_add(more));
        }
    }
    (whole, regions, pearls)
}

/// True for two spots that are not one.
fn is_apart(a: &Spot, b: &Spot) -> bool {
    a.centre.distance(b.centre) > 1.2 * RADIUS * a.scale.max(b.scale)
}

impl<'a> Bust<'a> {
    fn of(face: &'a Landmarks) -> Option<Self> {
        /// The face's outline shrinks by this share: earrings hang beside it.
        const SHRUNK: f64 = 0.93;
        let width = face.width();
        let height = face.point(10) - face.point(152);
        if width * SCALES[SCALES.len() - 1] < LEAST_SCALE || height.hypot() <= 0.0 {
            return None;
        }
        let oval = face.line(&outlines::OVAL);
        let middle = (oval.iter().fold(Vec2::ZERO, |sum, p| sum + p.to_vec2()) / oval.len() as f64).to_point();
        let oval = Region::of_polygons(vec![oval.iter().map(|p| middle.lerp(*p, SHRUNK)).collect()]);
        Some(Self { face, width, up: height / height.hypot(), oval })
    }

    /// How far a place lies beside the chin and below it, in widths of the face.
    fn off_chin(&self, p: Point) -> [f64; 2] {
        let from = (p - self.face.point(152)) / self.width;
        [from.cross(self.up), -from.dot(self.up)]
    }

    /// Those of the spots that are pearls, and those of them that are seen as circles.
    fn pearls(&self, spots: &[Spot], near: &Near, pixels: &Raster<[u8; 3]>) -> (Vec<Spot>, Vec<Circle>) {
        let mut string = on_strings(spots);
        let red_of_skin = self.red_of_skin(pixels);
        let is_pale =
            |spot: &Spot| red_of_skin >= COLOURED && red_at(pixels, spot.centre, RADIUS * spot.scale) < PALE * red_of_skin;
        let earrings: Vec<Spot> =
            spots.iter().filter(|spot| self.is_earring(spot) && !string.contains(spot) && is_pale(spot)).copied().collect();
        let moved = |spot: &Spot| Spot { centre: spot.centre - near.from, ..*spot };
        let mut pearls = strung(&near.light, &string.iter().map(moved).collect::<Vec<_>>(), self.width);
        pearls.extend(earrings.iter().filter_map(|spot| seen(&near.light, &moved(spot), self.width)));
        pearls.iter_mut().for_each(|pearl| pearl.center += near.from);
        string.extend(earrings);
        (string, pearls)
    }

    /// How red the cheeks are.
    fn red_of_skin(&self, pixels: &Raster<[u8; 3]>) -> f64 {
        const CHEEKS: [usize; 4] = [50, 280, 205, 425];
        const RADIUS: f64 = 0.015;
        CHEEKS.iter().map(|cheek| red_at(pixels, self.face.point(*cheek), RADIUS * self.width)).sum::<f64>() / CHEEKS.len() as f64
    }

    /// True for a firm spot at the height of the lobes, beside the face.
    fn is_earring(&self, spot: &Spot) -> bool {
        /// Heights above the chin and distances from the middle, in widths of the face.
        const HEIGHTS: Range<f64> = 0.25..0.75;
        const BESIDE: Range<f64> = 0.35..0.7;
        let [beside, below] = self.off_chin(spot.centre);
        spot.curved >= FIRM && HEIGHTS.contains(&-below) && BESIDE.contains(&beside.abs())
    }

    /// The lightness around a head and its neck.
    fn near(&self, pixels: &Raster<[u8; 3]>) -> Option<Near> {
        let [columns, rows] = self.extent(pixels)?;
        let light = Raster::from_fn(columns.len(), rows.len(), |x, y| {
            lightness(luminance(pixels.get(columns.start + x, rows.start + y).map(byte_to_linear)))
        });
        Some(Near { light, from: Vec2::new(columns.start as f64, rows.start as f64) })
    }

    /// Bright round spots beside the face and below it, each where it is roundest, the firmest first.
    fn spots(&self, near: &Near, subject: &Raster<u8>) -> Vec<Spot> {
        let Near { light, from } = near;
        let scales: Vec<f64> = SCALES.into_iter().map(|scale| scale * self.width).filter(|s| *s >= LEAST_SCALE).collect();
        let mut found: Vec<Spot> = collected(scales.len(), &|i| spots_of(light, scales[i])).into_iter().flatten().collect();
        found.iter_mut().for_each(|spot| spot.centre += *from);
        found.retain(|spot| self.may_be_worn_at(spot.centre, subject));
        found.sort_by(|a, b| b.curved.total_cmp(&a.curved));
        let mut kept: Vec<Spot> = Vec::new();
        for spot in found {
            if kept.iter().all(|other| is_apart(other, &spot)) {
                kept.push(spot);
            }
        }
        kept
    }

    fn may_be_worn_at(&self, p: Point, subject: &Raster<u8>) -> bool {
        /// How far beside the chin, above and below it, in widths of the face.
        const BESIDE: f64 = 0.7;
        const HEIGHTS: Range<f64> = -0.75..1.2;
        let [beside, below] = self.off_chin(p);
        subject.get(p.x as usize, p.y as usize) > 127 && beside.abs() < BESIDE && HEIGHTS.contains(&below)
    }

    /// The columns and rows around a head and its neck.
    fn extent(&self, pixels: &Raster<[u8; 3]>) -> Option<[Range<usize>; 2]> {
        const REACH: f64 = 1.6;
        let chin = self.face.point(152);
        let range = |at: f64, count: usize| {
            let end = |v: f64| v.clamp(0.0, count as f64) as usize;
            end(at - REACH * self.width)..end(at + REACH * self.width)
        };
        let [columns, rows] = [range(chin.x, pixels.width()), range(chin.y, pixels.height())];
        (!columns.is_empty() && !rows.is_empty()).then_some([columns, rows])
    }
}

/// Peaks of the smaller curvature at a scale, in pixels.
fn spots_of(light: &Raster<f32>, scale: f64) -> Vec<Spot> {
    let blurred = fast_gaussian(light, scale as f32);
    let square = (scale * scale) as f32;
    let curvatures = Raster::from_fn(light.width(), light.height(), |x, y| {
        let (x, y) = (x as isize, y as isize);
        let at = |dx: isize, dy: isize| blurred.clamped(x + dx, y + dy);
        let xx = at(1, 0) + at(-1, 0) - 2.0 * at(0, 0);
        let yy = at(0, 1) + at(0, -1) - 2.0 * at(0, 0);
        let xy = 0.25 * (at(1, 1) + at(-1, -1) - at(1, -1) - at(-1, 1));
        let (mean, spread) = (0.5 * (xx + yy), (0.25 * (xx - yy) * (xx - yy) + xy * xy).sqrt());
        [-square * (mean + spread), -square * (mean - spread)]
    });
    let is_peak = |x: usize, y: usize| {
        let [least, most] = curvatures.get(x, y);
        least > CURVED
            && least > ROUND * most
            && (-1..=1).all(|dy| (-1..=1).all(|dx| curvatures.clamped(x as isize + dx, y as isize + dy)[0] <= least))
    };
    let rows = collected(light.height(), &|y| {
        let peaks = (0..light.width()).filter(|x| is_peak(*x, y));
        let spot = |x: usize| Spot { centre: Point::new(x as f64 + 0.5, y as f64 + 0.5), scale, curved: curvatures.get(x, y)[0] };
        peaks.map(spot).collect::<Vec<Spot>>()
    });
    rows.into_iter().flatten().collect()
}

/// Those of the spots that lie on a string: between two others at about equal distances, with a neighbour of which that is also true, and
/// their neighbours.
fn on_strings(spots: &[Spot]) -> Vec<Spot> {
    /// Sizes and firmnesses of neighbours, as shares; their distance at most, in scales; and how much nearer one may be.
    const ALIKE: Range<f64> = 0.5..2.0;
    const AS_FIRM: Range<f32> = 0.3..1.0 / 0.3;
    const NEAR: f64 = 7.5;
    const EVEN: Range<f64> = 0.6..1.0 / 0.6;
    /// The cosine of the angle in a string.
    const BENT: f64 = -0.7;
    let are_next = |a: &Spot, b: &Spot| {
        a != b
            && ALIKE.contains(&(b.scale / a.scale))
            && AS_FIRM.contains(&(b.curved / a.curved))
            && a.centre.distance(b.centre) < NEAR * a.scale.max(b.scale)
    };
    let is_between = |spot: &Spot| {
        let next: Vec<Vec2> =
            spots.iter().filter(|other| are_next(spot, other)).map(|other| other.centre - spot.centre).collect();
        let are_opposite =
            |a: &Vec2, b: &Vec2| EVEN.contains(&(a.hypot() / b.hypot())) && a.dot(*b) < BENT * a.hypot() * b.hypot();
        next.iter().enumerate().any(|(i, a)| next[i + 1..].iter().any(|b| are_opposite(a, b)))
    };
    let between: Vec<&Spot> = spots.iter().filter(|spot| is_between(spot)).collect();
    let inner: Vec<&Spot> = between.iter().copied().filter(|spot| between.iter().any(|other| are_next(spot, other))).collect();
    spots.iter().filter(|spot| inner.contains(spot) || inner.iter().any(|other| are_next(spot, other))).copied().collect()
}

/// The pixels of a picture within a reach of a place, and how far away their middles are.
fn pixels_within(reach: f64, of: Point, (width, height): (usize, usize)) -> impl Iterator<Item = (usize, usize, f64)> {
    let range = move |at: f64, count: usize| ((at - reach).max(0.0) as usize)..((at + reach + 1.0).max(0.0) as usize).min(count);
    let pixels = range(of.y, height).flat_map(move |y| range(of.x, width).map(move |x| (x, y)));
    let away = move |(x, y): (usize, usize)| (x, y, of.distance(Point::new(x as f64 + 0.5, y as f64 + 0.5)));
    pixels.map(away).filter(move |(_, _, away)| *away < reach)
}

/// How red a place is: its median red less blue, as a share of red.
fn red_at(pixels: &Raster<[u8; 3]>, centre: Point, radius: f64) -> f64 {
    let within = pixels_within(radius.max(1.0), centre, (pixels.width(), pixels.height()));
    let red = within.map(|(x, y, _)| pixels.get(x, y)).map(|[r, _, b]| (f32::from(r) - f32::from(b)) / f32::from(r).max(1.0));
    median(red.collect()).map_or(0.0, f64::from)
}

/// The share of skin around a spot.
fn skin_share(spot: &Spot, regions: &Regions) -> f64 {
    /// The radius looked at, in those of the pearl.
    const AROUND: f64 = 3.5;
    let skin = &regions.skin;
    let around = pixels_within(AROUND * RADIUS * spot.scale, spot.centre, (skin.width(), skin.height()));
    let (sum, count) = around.fold((0.0, 0.0), |(sum, count), (x, y, _)| (sum + f64::from(skin.get(x, y)) / 255.0, count + 1.0));
    sum / f64::max(count, 1.0)
}

/// Marks a pearl as detail and gives what is cloth or hair there to the skin.
fn paint(regions: &mut Regions, subject: &Raster<u8>, pearl: Spot) {
    /// Radius of the detail and of the skin, in those of the pearl, and the soft edge, in pixels.
    const DETAIL: f64 = 1.25;
    const SOFT: f64 = 1.5;
    let radius = DETAIL * RADIUS * pearl.scale;
    for (x, y, away) in pixels_within(radius + SOFT, pearl.centre, (subject.width(), subject.height())) {
        let share = ((radius - away) / SOFT + 0.5).clamp(0.0, 1.0);
        let detail = (255.0 * share).round() as u8;
        regions.detail.set(x, y, regions.detail.get(x, y).max(detail.min(subject.get(x, y))));
        let mut given = 0;
        for plane in [&mut regions.hair, &mut regions.clothing, &mut regions.headwear] {
            let left = ((1.0 - share) * f64::from(plane.get(x, y))).round() as u8;
            given += plane.get(x, y) - left;
            plane.set(x, y, left);
        }
        regions.skin.set(x, y, regions.skin.get(x, y) + given);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lit(spots: &[(f64, f64)], radius: f64) -> Raster<f32> {
        Raster::from_fn(120, 60, |x, y| {
            let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
            let is_lit = spots.iter().any(|(x, y)| p.distance(Point::new(*x, *y)) < radius);
            if is_lit { 0.9 } else { 0.4 }
        })
    }

    #[test]
    fn a_string_of_pearls_is_found_and_a_button_or_a_line_is_not() {
        let string: Vec<(f64, f64)> = (0..6).map(|i| (20.0 + 10.0 * f64::from(i), 30.0)).collect();
        let spots = spots_of(&lit(&string, 4.5), 3.2);
        assert_eq!(on_strings(&spots).len(), 6, "{spots:?}");
        let button = spots_of(&lit(&[(60.0, 30.0)], 4.5), 3.2);
        assert!(button.len() == 1 && on_strings(&button).is_empty(), "{button:?}");
        let line = Raster::from_fn(120, 60, |_, y| if (28..33).contains(&y) { 0.9 } else { 0.4 });
        assert!(spots_of(&line, 3.2).is_empty());
    }
}
