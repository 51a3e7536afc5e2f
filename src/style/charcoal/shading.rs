//! Hand shading of clothing and background (sections 6.2, 6.3.4 and 6.3.5). Where the thesis shades a garment in one tone, or a few found
//! by scale-space filtering, strokes here are as firm as each place is dark, so that folds, collars and lapels stay.

use super::Drawer;
use super::features::Features;
use super::patch::{LEAST_WIDTHS, Patch, Pressing};
use super::regions::Regions;
use super::strokes::pressure_for;
use crate::drawing::Mark;
use crate::geometry::{Point, Vec2};
use crate::raster::{Raster, fast_gaussian_within, gaussian_blur, paper_texture};
use crate::source::Landmarks;

/// Distance over which the background falls away from a subject without a face, in sheet widths; and from the middle of a head, in widths
/// of its face: there it has half of its pressure.
const FALL: f64 = 0.22;
const ABOUT_HEAD: f64 = 1.5;
/// By how much it is firmer on the side that the light comes from and fainter on the other, and how far it leans there in widths of the face.
const TO_LIGHT: f64 = 0.45;
const LEAN: f64 = 0.25;

/// A head before its background.
struct Head {
    middle: Point,
    width: f64,
    lit_side: f64,
}

impl Head {
    fn of(face: &Landmarks, lightness: &Raster<f32>) -> Self {
        /// The middle of a head above the middle of its face, in widths of the face.
        const ABOVE_FACE: f64 = 0.25;
        let up = face.point(10) - face.point(152);
        let up = up / up.hypot().max(1.0);
        let (width, lit_side) = (face.width(), face.lit_side(lightness));
        let middle = face.point(10).midpoint(face.point(152)) + ABOVE_FACE * width * up;
        Self { middle: middle + Vec2::new(LEAN * width * lit_side, 0.0), width, lit_side }
    }

    /// 1 at the head, half at `ABOUT_HEAD`, nothing far away; more on the lit side.
    fn nearness(&self, p: Point) -> f64 {
        let away = (p - self.middle) / (ABOUT_HEAD * self.width);
        let aside = away.x.clamp(-1.0, 1.0) * self.lit_side;
        let far = away.hypot2();
        (1.0 + TO_LIGHT * aside) / (1.0 + far * far)
    }
}

/// From 0 at 0 to 1 at 1, without a corner.
fn smoothstep(t: f32) -> f32 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// One set of strokes in clothing.
struct Hatch {
    from: f32,
    spacing: f64,
    turned: f64,
}

/// Pressure below which the background stays paper, and the range over which it ends.
const LEAST_BACKGROUND: f32 = 0.3;
const SOFT_BACKGROUND: f32 = 0.1;

impl Drawer<'_> {
    /// Clothing and everything that is neither face nor hair, in the tones of its folds: strokes as firm as the cloth is dark, crossed in
    /// the darks; the grain makes up the rest.
    pub(super) fn shading(&self, regions: &Regions, features: &Features, wanted: &Raster<f32>) -> Vec<Mark> {
        /// Sets of strokes in clothing: ink from which they are drawn, distance in pitches, and angle against the shading's
        /// direction.
        const CLOTH_HATCHES: [Hatch; 2] =
            [Hatch { from: 0.3, spacing: 1.5, turned: 0.0 }, Hatch { from: 0.6, spacing: 1.6, turned: 0.22 }];
        /// Share of the ink that each set aims at; with more the cloth is a net, with less it is grain alone.
        const CLOTH_SHARE: f64 = 0.38;
        if !self.parameters.has_shading {
            return Vec::new();
        }
        self.observer.begin("shading");
        let soft = self.pixels(0.5 * self.parameters.pitch) as f32;
        let ink = gaussian_blur(wanted, soft);
        let cloth = regions.clothing.zip_map(&features.drawn, |c, drawn| c.min(1.0 - drawn));
        let width = self.parameters.stroke_width;
        let is_cloth = cloth.map(|share| i32::from(share > 0.5));
        let drawn = self.drawn_directions().and_then(|drawn| drawn.means_in(&is_cloth, 1)[0]);
        let direction = drawn.unwrap_or(self.parameters.arc_orient.0);
        let mut marks = Vec::new();
        for (i, Hatch { from, spacing, turned }) in CLOTH_HATCHES.into_iter().enumerate() {
            let spacing = spacing * self.parameters.pitch;
            let region = ink.zip_map(&cloth, |ink, cloth| if ink > from { cloth } else { 0.0 });
            let patch = Patch {
                region: gaussian_blur(&region, soft),
                width,
                spacing,
                length: 0.8 * self.parameters.arc_length,
                orientation: direction + turned,
                pressure: 1.0,
                inset: 0.5 * width,
                pressing: Pressing::Hatching,
                least: LEAST_WIDTHS * width,
            };
            let press = |p: Point| {
                let asked = f64::from(ink.sample(p.x, p.y) - 0.5 * from) * CLOTH_SHARE;
                pressure_for(asked * (spacing / width)).clamp(0.0, 1.0)
            };
            marks.extend(self.shade_patch(&patch, "shading", i as u64, press));
        }
        marks
    }

    /// Pressure of the background's strokes, 0 to 1 and a little above: none on the subject, with a ragged end before the sheet's border.
    pub(super) fn background_pressure(&self, regions: &Regions) -> Raster<f32> {
        if !self.parameters.has_background || !regions.has_background || self.parameters.background_ink <= 0.0 {
            return regions.subject.map(|_| 0.0);
        }
        self.ragged(&regions.subject).zip_map(&self.nearness(&regions.subject), |inside, near| {
            inside * near * ((near - LEAST_BACKGROUND) / SOFT_BACKGROUND + 0.5).clamp(0.0, 1.0)
        })
    }

    /// Section 6.3.5: firmer beside the light parts of the subject.
    pub(super) fn background(&self, regions: &Regions, pressure: &Raster<f32>) -> Vec<Mark> {
        /// Pressure of the background's strokes, and their width at it as a share of the full width: lighter than anything in the
        /// portrait.
        const BACKGROUND_PRESSURE: [f64; 2] = [0.2, 0.3];
        const BACKGROUND_WIDTH: f64 = 0.44;
        /// Distance of the strokes over what their ink asks for, behind a person and else: the broad side of the stick makes the rest.
        const APART: [f64; 2] = [0.9, 1.3];
        /// Least length of a background stroke in arcs: shorter ones are ticks far from the head.
        const LEAST_BEHIND: f64 = 0.6;
        /// Width of a background stroke as a share of the stick's.
        const BACKGROUND_STROKE: f64 = 0.4;
        if pressure.pixels().iter().all(|p| *p <= 0.0) {
            return Vec::new();
        }
        self.observer.begin("background");
        let region = self.hatched(regions, pressure);
        self.show("background", &region);
        let width = BACKGROUND_STROKE * self.parameters.stroke_width;
        let patch = Patch {
            region,
            width,
            // Spreads a stroke's ink, at the pressure below, over its spacing.
            spacing: APART[usize::from(self.portrait.faces.is_empty())] * BACKGROUND_WIDTH * width
                / self.parameters.background_ink,
            length: self.parameters.arc_length,
            orientation: self.parameters.arc_orient.0,
            pressure: BACKGROUND_PRESSURE[usize::from(self.portrait.faces.is_empty())],
            inset: 0.5 * width,
            pressing: Pressing::Hatching,
            least: LEAST_BEHIND * self.parameters.arc_length,
        };
        self.shade_patch(&patch, "background", 0, |p| f64::from(pressure.sample(p.x, p.y)))
    }

    /// Where the background has strokes, 0 to 1: behind people only where it is pressed firmly, as behind a lit cheek. Over the whole smudge
    /// strokes are needles around a head.
    fn hatched(&self, regions: &Regions, pressure: &Raster<f32>) -> Raster<f32> {
        /// The pressure, and the range over which strokes set in.
        const FIRM: [f32; 2] = [0.75, 0.25];
        /// Blur in pitches, and the firm share of the background around a place from which there are strokes: a stroke or two are
        /// scratches.
        const PATCH: f64 = 5.0;
        const LEFT: f32 = 0.7;
        let outside = regions.subject.map(|subject| 1.0 - subject);
        if self.portrait.faces.is_empty() {
            return pressure.zip_map(&outside, |p, outside| outside * (p / (0.5 * LEAST_BACKGROUND)).min(1.0));
        }
        let firm = pressure.zip_map(&outside, |p, outside| outside * ((p - FIRM[0]) / FIRM[1] + 0.5).clamp(0.0, 1.0));
        let wide = fast_gaussian_within(&firm, &outside.map(|v| v + 1e-6), self.pixels(PATCH * self.parameters.pitch) as f32);
        firm.zip_map(&wide, |firm, wide| if wide > LEFT { firm } else { 0.0 })
    }

    /// Pressure of the background at a place: it fades away from the head, or without a face from the subject, and towards the sheet's
    /// border; firm beside light parts of the subject and faint beside dark ones, so that both stand out.
    fn nearness(&self, subject: &Raster<f32>) -> Raster<f32> {
        /// Width of the airy rim within the sheet's border, as a share of the sheet's short side.
        const AIRY: f64 = 0.2;
        /// By how much of that it wavers, so that the strokes have no straight border.
        const WAVER: f32 = 0.8;
        /// Shares of the pressure beside black and beside white parts of the subject.
        const AGAINST: [f32; 2] = [0.25, 1.5];
        let (width, height) = self.size();
        let short = width.min(height) as f64;
        let reach = (FALL * short) as f32;
        let (wide, beside) = (gaussian_blur(subject, reach), gaussian_blur(subject, 0.5 * reach));
        let dark = gaussian_blur(&self.darkness().zip_map(subject, |ink, subject| ink * subject), 0.5 * reach);
        let cloud = paper_texture(width / 8 + 2, height / 8 + 2, 14.0, self.seed ^ 0xc10d);
        let waver = paper_texture(width / 8 + 2, height / 8 + 2, 9.0, self.seed ^ 0xa1e5);
        let heads: Vec<Head> = self.portrait.faces.iter().map(|face| Head::of(face, &self.portrait.lightness)).collect();
        Raster::from_fn(width, height, |x, y| {
            let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
            let near = (2.2 * wide.get(x, y)).min(1.0);
            let about = heads.iter().map(|head| head.nearness(p)).fold(0.0, f64::max) as f32;
            let about = if heads.is_empty() { near } else { about };
            let edge = p.x.min(p.y).min(width as f64 - p.x).min(height as f64 - p.y) / short;
            let airy = smoothstep((edge / AIRY) as f32 - WAVER * waver.sample(x as f64 / 8.0 + 0.5, y as f64 / 8.0 + 0.5));
            let light = (1.0 - dark.get(x, y) / beside.get(x, y).max(0.02)).clamp(0.0, 1.0);
            let against = AGAINST[0] + (AGAINST[1] - AGAINST[0]) * light;
            about * airy * against * (0.55 + 0.9 * cloud.sample(x as f64 / 8.0 + 0.5, y as f64 / 8.0 + 0.5))
        })
    }

    /// The background without an irregular margin.
    fn ragged(&self, subject: &Raster<f32>) -> Raster<f32> {
        let (width, height) = self.size();
        let margin = 0.05 * width.min(height) as f64;
        let waver = paper_texture(width / 8 + 2, height / 8 + 2, 10.0, self.seed ^ 0xba5e);
        Raster::from_fn(width, height, |x, y| {
            let edge = x.min(y).min(width - 1 - x).min(height - 1 - y) as f64;
            let wanted = margin * (0.5 + 1.6 * f64::from(waver.sample(x as f64 / 8.0 + 0.5, y as f64 / 8.0 + 0.5)));
            let inner = ((edge - wanted) as f32 + 0.5).clamp(0.0, 1.0);
            inner.min(1.0 - subject.get(x, y))
        })
    }
}
