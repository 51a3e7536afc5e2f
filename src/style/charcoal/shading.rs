//! Hand shading of features, clothing and background (sections 6.2, 6.3.4 and 6.3.5).

use super::Drawer;
use super::features::Features;
use super::regions::Regions;
use super::strokes::Touch;
use crate::drawing::Mark;
use crate::field::{histogram_modes, pieces_inside};
use crate::geometry::{HandShading, Point, Rect, Vec2, polyline_length};
use crate::raster::{Raster, gaussian_blur, paper_texture};
use crate::style::random::stream;
use rand::Rng;

/// A region to be shaded in one tone; lengths in millimetres, the orientation in radians.
pub(super) struct Patch {
    /// 0 to 1, in working pixels.
    pub region: Raster<f32>,
    pub width_mm: f64,
    pub spacing_mm: f64,
    /// Greatest length of an arc; a narrower region has shorter ones.
    pub length_mm: f64,
    pub orientation: f64,
    pub pressure: f64,
}

/// Swaths of arcs overlap by this share of an arc, as a hand's do.
const SWATH_OVERLAP: f64 = 0.12;
/// Arcs per stroke after which the hand lifts.
const ARCS_A_STROKE: usize = 60;
/// Pieces shorter than this many widths are specks.
const LEAST_WIDTHS: f64 = 1.5;
/// Pressure of the background's strokes, and their width then as a share of the full one: lighter than anything in the portrait.
const BACKGROUND_PRESSURE: f64 = 0.2;
const BACKGROUND_WIDTH: f64 = 0.44;
/// Tones of clothing lighter than this are left to the smudge.
const LIGHT_CLOTH: f64 = 0.5;

impl Drawer<'_> {
    /// The strokes of a patch: chains of arcs side by side, cut to the region.
    pub(super) fn shade_patch(&self, patch: &Patch, stage: &str, element: u64) -> Vec<Mark> {
        let touch = Touch {
            width_mm: patch.width_mm,
            pressure: patch.pressure,
            taper: 0.04,
            node_mm: (0.08 * patch.length_mm).clamp(0.6 * patch.width_mm, 1.2 * self.parameters.pitch_mm),
        };
        let least = LEAST_WIDTHS * self.pixels(patch.width_mm);
        let mut random = stream(self.seed, stage, element);
        self.chains(patch, &mut random)
            .iter()
            .flat_map(|chain| pieces_inside(chain, &patch.region))
            .filter(|piece| polyline_length(piece) >= least)
            .filter_map(|piece| self.stroke(&piece, touch, |_| 1.0))
            .collect()
    }

    /// Chains of arcs that cover the region's bounds, turned to its orientation, each lifted now and then.
    fn chains(&self, patch: &Patch, random: &mut impl Rng) -> Vec<Vec<Point>> {
        let along = Vec2::from_angle(patch.orientation);
        let across = Vec2::new(-along.y, along.x);
        let Some(bounds) = turned_bounds(&patch.region, along, across) else { return Vec::new() };
        let spacing = self.pixels(patch.spacing_mm);
        let most = self.pixels(patch.length_mm);
        let swaths = (bounds.width() / (most * (1.0 - SWATH_OVERLAP))).ceil().max(1.0);
        let swath = bounds.width() / swaths;
        let length = (swath / (1.0 - SWATH_OVERLAP)).max(2.0 * spacing);
        let count = (bounds.height() / spacing).ceil() as usize + 2;
        let radius = self.pixels(self.parameters.arc_radius_mm).min(4.0 * length);
        (0..swaths as usize)
            .flat_map(|i| {
                let (u, v) = (bounds.x0 + (i as f64 + 0.5) * swath, bounds.y0 - spacing);
                let shading = HandShading {
                    centre: (along * u + across * v).to_point(),
                    length,
                    radius,
                    orientation: patch.orientation,
                    spacing,
                    count,
                    skew: self.parameters.arc_skew,
                };
                let arcs = shading.arcs(random);
                arcs.chunks(ARCS_A_STROKE).map(<[Vec<Point>]>::concat).collect::<Vec<_>>()
            })
            .collect()
    }

    /// Dark clothing, and all that is neither face nor hair: its tones by scale-space filtering, the darker ones shaded over the
    /// lighter ones, each a little turned.
    pub(super) fn shading(&self, regions: &Regions, features: &Features) -> Vec<Mark> {
        if !self.parameters.has_shading {
            return Vec::new();
        }
        self.observer.begin("shading");
        let cloth = regions.clothing.zip_map(&features.drawn, |c, drawn| c.min(1.0 - drawn));
        let tone = gaussian_blur(&self.portrait.tone, self.pixels(self.parameters.pitch_mm) as f32);
        let levels = dark_levels(&tone, &cloth);
        let mut marks = Vec::new();
        for (i, (limit, mean)) in levels.iter().enumerate() {
            let region = tone.zip_map(&cloth, |t, c| if f64::from(t) < *limit { c } else { 0.0 });
            let darkness = 1.0 - mean;
            let patch = Patch {
                region: gaussian_blur(&region, 1.0),
                width_mm: self.parameters.stroke_width_mm,
                spacing_mm: self.parameters.pitch_mm * (1.1 + 2.2 * (1.0 - darkness)),
                length_mm: 0.55 * self.parameters.arc_length_mm,
                orientation: self.parameters.arc_orient + 0.35 * i as f64,
                pressure: 0.25 + 0.6 * darkness,
            };
            marks.extend(self.shade_patch(&patch, "shading", i as u64));
        }
        marks
    }

    /// Section 6.3.5, firmer where the photograph is darker, with a ragged end some way from the sheet's border.
    pub(super) fn background(&self, regions: &Regions) -> Vec<Mark> {
        if !self.parameters.has_background || !regions.has_background || self.parameters.background_ink <= 0.0 {
            return Vec::new();
        }
        self.observer.begin("background");
        let region = self.ragged(&regions.subject);
        self.show("background", &region);
        let patch = Patch {
            region,
            width_mm: self.parameters.stroke_width_mm,
            // The ink of a stroke at the pressure below, spread over its spacing.
            spacing_mm: BACKGROUND_WIDTH * self.parameters.stroke_width_mm / self.parameters.background_ink,
            length_mm: self.parameters.arc_length_mm,
            orientation: self.parameters.arc_orient,
            pressure: BACKGROUND_PRESSURE,
        };
        self.shade_patch(&patch, "background", 0)
    }

    /// The background without a wavering margin.
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

/// Bounds of a region along and across a direction, or none when it is empty.
fn turned_bounds(region: &Raster<f32>, along: Vec2, across: Vec2) -> Option<Rect> {
    let mut bounds: Option<Rect> = None;
    for y in 0..region.height() {
        for x in (0..region.width()).filter(|x| region.get(*x, y) >= 0.5) {
            let p = Vec2::new(x as f64 + 0.5, y as f64 + 0.5);
            let (u, v) = (p.dot(along), p.dot(across));
            let here = Rect::new(u - 0.7, v - 0.7, u + 0.7, v + 0.7);
            bounds = Some(bounds.map_or(here, |b| b.union(here)));
        }
    }
    bounds
}

/// The dark tones of a region, the lightest first: the tone below which each is shaded, and its own.
fn dark_levels(tone: &Raster<f32>, region: &Raster<f32>) -> Vec<(f64, f64)> {
    let mut histogram = vec![0_u32; 256];
    for (t, _) in tone.pixels().iter().zip(region.pixels()).filter(|(_, r)| **r >= 0.5) {
        histogram[((t * 255.0) as usize).min(255)] += 1;
    }
    let total: u32 = histogram.iter().sum();
    let modes = histogram_modes(&histogram, total / 16);
    let mut levels: Vec<(f64, f64)> = modes
        .iter()
        .enumerate()
        .map(|(i, mode)| (modes.get(i + 1).map_or(1.0, |next| 0.5 * (mode.at + next.at) / 255.0), mode.at / 255.0))
        .filter(|(_, mean)| *mean < LIGHT_CLOTH)
        .collect();
    for level in &mut levels {
        level.0 = level.0.min(LIGHT_CLOTH + 0.08);
    }
    levels.reverse();
    levels
}
