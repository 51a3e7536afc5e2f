//! The structure grid (Son et al. 2011, section 5): two families of stripes, their lines and crossings.

use super::Drawer;
use super::features::Features;
use super::parameters::{DETAIL_CLOSENESS, FeatureRows};
use crate::drawing::{Colour, Dot, Layer, Mark};
use crate::elementary::Elementary as _;
use crate::field::{
    Curve, DirectionField, FeatureDistance, StripeLattice, StripeParameters, Wave, crossings, distance_to_curves, holes,
    stripe_lines, stripes,
};
use crate::geometry::{Point, Rect, Vec2, smooth_polyline};
use crate::raster::{Raster, gaussian_blur};
use crate::style::{Picture, random};
use rand::RngExt;
use std::f64::consts::TAU;

/// Both families: 0 runs along the features, 1 across them. In working pixels.
pub(super) struct StructureGrid {
    pub stripes: [StripeLattice; 2],
    /// Lines of each family, smooth.
    pub lines: [Vec<Curve>; 2],
    /// Density of each family at the lattice's nodes, lines per pixel.
    pub density: [Raster<f32>; 2],
    /// Crossings of both families, followed by the points that fill holes between them.
    pub crossings: Vec<Point>,
    /// How many of `crossings` are true crossings.
    pub true_crossings: usize,
    pub field: DirectionField,
    pub spacing: Spacing,
}

/// Target spacing of dots and lines.
#[derive(Clone)]
pub(super) struct Spacing {
    /// Factor by which the spacing is closer than a pitch, at each pixel.
    closeness: Raster<f32>,
    /// The pitch in pixels.
    pitch: f64,
}

impl Spacing {
    /// Spacing at a place in pixels.
    pub(super) fn at(&self, p: Point) -> f64 {
        self.pitch / f64::from(self.closeness.clamped(p.x.floor() as isize, p.y.floor() as isize))
    }
}

impl StructureGrid {
    /// Lines per pixel of one family at a place.
    pub(super) fn density_at(&self, family: usize, p: Point) -> f64 {
        f64::from(self.stripes[family].read(&self.density[family], p)).max(1e-6)
    }

    /// The direction of the features at a place.
    pub(super) fn tangent(&self, p: Point) -> Vec2 {
        let tangent = &self.field.tangent;
        let x = (p.x.max(0.0) as usize).min(tangent.width() - 1);
        let y = (p.y.max(0.0) as usize).min(tangent.height() - 1);
        let [x, y] = tangent.get(x, y);
        Vec2::new(f64::from(x), f64::from(y))
    }
}

impl Drawer<'_> {
    pub(super) fn structure(&self, features: &Features, ink: &Raster<f32>) -> StructureGrid {
        self.observer.begin("stripes");
        let spacing = Spacing { closeness: self.closeness(ink), pitch: self.pitch() };
        let stripes = self.families(features, &spacing.closeness);
        self.observer.begin("grid");
        let (crossings, true_crossings) = self.points(&stripes[0], &stripes[1], &spacing);
        let lines = [0, 1].map(|family| self.smooth_lines(&stripes[family]));
        let density = [0, 1].map(|family| {
            let stripes: &StripeLattice = &stripes[family];
            gaussian_blur(&stripes.frequency(), (self.pitch() / stripes.step) as f32)
        });
        let grid = StructureGrid { stripes, lines, density, crossings, true_crossings, field: features.field.clone(), spacing };
        self.show(&grid);
        grid
    }

    /// Section 5.2: the stripes along the features start from the distance to them, those across from random phases.
    fn families(&self, features: &Features, closeness: &Raster<f32>) -> [StripeLattice; 2] {
        let parameters = self.stripe_parameters();
        let by_chance = |stage: &'static str| move |node: u64| random::stream(self.seed, stage, node).random::<f32>();
        let waves = self.waves(features, closeness);
        let (width, height) = self.size();
        let distance = distance_to_curves(&features.guides, width, height);
        let hold = distance.as_ref().and_then(|distance| self.hold(distance, &waves[0], closeness, parameters.step));
        let (along, across) = rayon::join(
            || {
                let random = by_chance("along");
                let start = |node: u64, p: Point, wave: Wave| match &distance {
                    Some(distance) => (signed_distance(distance, wave, p) / self.pitch()) as f32,
                    None => random(node),
                };
                stripes(&waves[0], parameters, &start, hold.as_ref())
            },
            || {
                let random = by_chance("across");
                stripes(&waves[1], parameters, &|node, _, _| random(node), None)
            },
        );
        [along, across]
    }

    fn stripe_parameters(&self) -> StripeParameters {
        /// Lattice nodes per narrowest pitch: with fewer, a stripe between two nodes could be lost.
        const NODES_PER_PITCH: f64 = 2.0;
        /// Levels from coarse to fine: the coarsest nodes are eight pitches apart. With three levels parallel rows keep breaks
        /// (0.7 degrees instead of 0.2); more than five change nothing on faces.
        const LEVELS: u32 = 5;
        let step = self.pitch() / NODES_PER_PITCH * self.parameters.narrowest(self.detail().is_some());
        StripeParameters {
            step,
            window: self.pixels(self.parameters.window) / step,
            rounds: self.parameters.rounds,
            levels: LEVELS,
        }
    }

    /// The waves of both families; the wave of the family along the features points across them.
    fn waves(&self, features: &Features, closeness: &Raster<f32>) -> [Raster<Wave>; 2] {
        let pitch = self.pitch() as f32;
        let across =
            features.field.tangent.zip_map(closeness, |[x, y], closeness| [-y * closeness / pitch, x * closeness / pitch]);
        let along = across.map(|[x, y]| [y, -x]);
        [across, along]
    }

    /// Crossings of two families, followed by the points that fill holes between them; and the number of true crossings.
    pub(super) fn points(&self, along: &StripeLattice, across: &StripeLattice, spacing: &Spacing) -> (Vec<Point>, usize) {
        /// Minimum distance of two dots, in pitches. At 0.5 twin dots appear at the ends of rows, at 0.7 holes show there.
        const LEAST_DISTANCE: f64 = 0.6;
        /// Radius of an empty place that gets an extra dot, in pitches; an even grid has 0.71. At 0.85 dots crowd where rows end,
        /// at 1.1 white spots show there.
        const HOLE: f64 = 0.95;
        let (width, height) = self.size();
        let least = |p: Point| LEAST_DISTANCE * spacing.at(p);
        let mut points: Vec<Point> = crossings(along, across, &least).into_iter().filter(|p| self.contains(*p)).collect();
        let true_points = points.len();
        let reach = |p: Point| HOLE * spacing.at(p);
        points.extend(holes(&points, Rect::new(0.0, 0.0, width as f64, height as f64), &reach, HOLE * self.pitch()));
        (points, true_points)
    }

    fn contains(&self, p: Point) -> bool {
        let (width, height) = self.size();
        p.x >= 0.0 && p.y >= 0.0 && p.x < width as f64 && p.y < height as f64
    }

    /// Factor by which lines stand closer than a pitch, at each pixel.
    fn closeness(&self, ink: &Raster<f32>) -> Raster<f32> {
        /// Blur of a detail region's border, in pitches: rows end one by one over it, and no border was visible on six portraits
        /// at full size. Eyes in a portrait of 90 mm are five pitches high; a wider blur would leave little of them.
        const DETAIL_BLUR: f64 = 1.0;
        let adaptive = self.parameters.adaptive;
        let by_tone = if adaptive == 0.0 {
            ink.map(|_| 1.0)
        } else {
            // Spacing must change slowly, or rows break at every step of the tone.
            gaussian_blur(ink, 3.0 * self.pitch() as f32).map(|ink| 1.0 / (1.0 - adaptive * ink.clamp(0.0, 1.0)))
        };
        let Some(detail) = self.detail() else { return by_tone };
        let detail = gaussian_blur(detail, (DETAIL_BLUR * self.pitch()) as f32);
        by_tone.zip_map(&detail, |closeness, detail| closeness * (1.0 + (DETAIL_CLOSENESS - 1.0) * detail.clamp(0.0, 1.0)))
    }

    /// The phases at which nodes near feature lines are held, so that rows run along them.
    fn hold(
        &self,
        distance: &FeatureDistance,
        wave: &Raster<Wave>,
        closeness: &Raster<f32>,
        step: f64,
    ) -> Option<Raster<[f32; 2]>> {
        let offset = match self.parameters.feature_rows {
            FeatureRows::Free => return None,
            FeatureRows::On => 0.0,
            FeatureRows::Beside => 0.5,
        };
        let (width, height) = self.size();
        let (columns, rows) = StripeLattice::bare(width, height, step);
        Some(Raster::from_fn(columns, rows, |i, j| {
            let p = StripeLattice::bare_position(i, j, step);
            if !self.contains(p) {
                return [0.0, 0.0];
            }
            let (x, y) = (p.x as usize, p.y as usize);
            let spacing = self.pitch() / f64::from(closeness.get(x, y));
            held(distance, wave.get(x, y), p, spacing, offset)
        }))
    }

    fn smooth_lines(&self, family: &StripeLattice) -> Vec<Curve> {
        let pitch = self.pitch();
        stripe_lines(family)
            .into_iter()
            .map(|line| Curve {
                points: smooth_polyline(&line.points, line.closed.into(), 0.4 * pitch, 0.25 * pitch),
                closed: line.closed,
            })
            .filter(|line| line.points.len() > 1)
            .collect()
    }

    fn show(&self, grid: &StructureGrid) {
        for (name, family) in ["stripes-along", "stripes-across"].iter().zip(&grid.stripes) {
            self.observer.picture(name, &|| Picture::Grey(self.stripe_picture(family)));
        }
        self.observer.picture("grid", &|| {
            let mut dots = Layer::new("crossings", 3);
            let radius = 0.15 * self.parameters.pitch.0;
            dots.marks =
                grid.crossings.iter().map(|p| Mark::Dot(Dot::circle(self.portrait.placement.to_page(*p), radius))).collect();
            self.picture_of(vec![
                self.thin_layer("along", &grid.lines[0], Colour { r: 200, g: 60, b: 40 }),
                self.thin_layer("across", &grid.lines[1], Colour { r: 40, g: 100, b: 200 }),
                dots,
            ])
        });
    }

    /// Distance from the nearest line, black on the line (Son et al. 2011, figure 5).
    fn stripe_picture(&self, family: &StripeLattice) -> Raster<f32> {
        let (width, height) = self.size();
        Raster::from_fn(width, height, |x, y| {
            let phase = family.phase_at(Point::new(x as f64 + 0.5, y as f64 + 0.5)) / TAU;
            (2.0 * (phase - phase.round()).abs()) as f32
        })
    }
}

/// How strongly a row is held at its place beside a feature line; at 1 rows break beside short lines.
const HOLD: f64 = 0.25;
/// Distance from a feature line at which the hold ends, in pitches.
const HOLD_REACH: f64 = 1.5;

/// The held phase at one place: the distance from the feature line in cycles, growing along the wave. Zero far away and where the field
/// runs across the line.
fn held(distance: &FeatureDistance, wave: Wave, p: Point, spacing: f64, offset: f64) -> [f32; 2] {
    let away = distance.distance.sample(p.x, p.y);
    let strength = HOLD * (1.0 - f64::from(away) / (HOLD_REACH * spacing));
    // The distance grows by one per pixel straight across the line; 0.8 is 37 degrees off.
    if strength <= 0.0 || slope_along(distance, wave, p).abs() < 0.8 {
        return [0.0, 0.0];
    }
    let phase = TAU * (signed_distance(distance, wave, p) / spacing + offset);
    [(strength * phase.cosine()) as f32, (strength * phase.sine()) as f32]
}

/// The distance from the nearest feature line, negative on one side.
fn side_distance(distance: &FeatureDistance, p: Point) -> f64 {
    let (x, y) = (p.x.floor() as isize, p.y.floor() as isize);
    f64::from(distance.distance.clamped(x, y)) * f64::from(distance.side.clamped(x, y))
}

/// Growth of that distance per pixel along the wave's direction.
fn slope_along(distance: &FeatureDistance, wave: Wave, p: Point) -> f64 {
    let along = Vec2::new(f64::from(wave[0]), f64::from(wave[1])).normalize();
    0.25 * (side_distance(distance, p + along * 2.0) - side_distance(distance, p - along * 2.0))
}

/// Distance signed to grow along the wave (Son et al. 2011, section 5.2, start with the unsigned distance).
fn signed_distance(distance: &FeatureDistance, wave: Wave, p: Point) -> f64 {
    slope_along(distance, wave, p).signum() * side_distance(distance, p)
}
