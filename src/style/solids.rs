//! What is drawn solid in a face whatever the style's marks: pupils, lashes, nostrils, lines of lips, lids and jaw, frames of spectacles,
//! pearls.

use super::drawn_irises::{DrawnIris, light_irises};
use super::ears::beside_faces;
use super::jaw::Jaws;
use super::lids::Lids;
use super::mouth::Mouths;
use super::pearls::Pearls;
use super::spectacles;
use crate::drawing::{Area, Layer, Mark};
use crate::elementary::Elementary as _;
use crate::field::contours;
use crate::geometry::{BezPath, Point, Rect, Region, Ring, catmull_rom, polygon_area, smooth_polyline};
use crate::raster::{Raster, filled_polygon, gaussian_blur};
use crate::source::{Landmarks, MaskRole, Portrait, outlines};

/// Reach of a detail region's finer lines, in pitches.
const DETAIL_BLUR: f64 = 1.0;
/// Ink from which details are solid, and by how much less in eyes: lips and brows stay lines. The blur before that and the side of the
/// smallest solid, in pitches.
const SOLID: f32 = 0.9;
const EYE_LIFT: f32 = 0.14;
const SOLID_BLUR: f64 = 0.2;
const LEAST_SOLID: f64 = 0.4;
/// Distance of their outlines' nodes in pitches: nearer ones cost more than they show.
const NODE: f64 = 0.35;
/// Reach of the mean from which frames of spectacles differ, how much darker they are, and the least length of their parts, in widths
/// of the face and ink.
const THIN: f64 = 0.03;
const THIN_DARK: f32 = 0.16;
const LONG: f64 = 0.09;
/// Tolerance of solid shapes in millimetres.
pub(super) const TOLERANCE: f64 = 0.01;

/// Where details are finer, 0 to 1; `pitch` in working pixels.
pub(super) fn detail_zone(portrait: &Portrait, pitch: f64) -> Raster<f32> {
    portrait.masks.get(&MaskRole::Detail).map_or_else(
        || portrait.subject.map(|_| 0.0),
        |mask| gaussian_blur(mask, (DETAIL_BLUR * pitch) as f32).map(|v| (1.3 * v).min(1.0)),
    )
}

/// Eyes and mouths, 0 to 1, whose lights stay paper; all details where no face is known.
pub(super) fn eyes_and_mouths(portrait: &Portrait, pitch: f64) -> Raster<f32> {
    if portrait.faces.is_empty() {
        return detail_zone(portrait, pitch);
    }
    let size = (portrait.subject.width(), portrait.subject.height());
    let eyes = inside_outlines(&portrait.faces, [&outlines::LEFT_EYE, &outlines::RIGHT_EYE], size);
    let mouths = inside_outlines(&portrait.faces, [&outlines::LIPS, &outlines::MOUTH], size);
    gaussian_blur(&eyes.zip_map(&mouths, f32::max), (DETAIL_BLUR * pitch) as f32).map(|v| (1.3 * v).min(1.0))
}

/// The inside of two closed outlines of all faces, 0 or 1.
pub(super) fn inside_outlines(faces: &[Landmarks], of: [&[usize]; 2], (columns, rows): (usize, usize)) -> Raster<f32> {
    let lines = faces.iter().flat_map(|face| of.map(|outline| face.line(outline)));
    lines.fold(Raster::filled(columns, rows, 0.0_f32), |all, outline| {
        let corners: Vec<[f64; 2]> = outline.iter().map(|p| [p.x, p.y]).collect();
        all.zip_map(&filled_polygon(columns, rows, &corners), |all, inside| all.max(f32::from(inside)))
    })
}

/// The solid shapes of a portrait's faces.
pub(super) struct Solids {
    /// On the page; empty without faces.
    pub outline: BezPath,
    /// Frames of spectacles that were found as lines, and lines of mouths, lids and jaws.
    pub lines: Vec<Mark>,
    /// Light irises: their ground on the page, and the spokes that take the place of dots there.
    irises: (BezPath, Vec<Mark>),
    pearls: Pearls,
}

impl Solids {
    /// By the ink wanted on the working grid; `pitch` in its pixels.
    pub(super) fn new(portrait: &Portrait, ink: &Raster<f32>, pitch: f64) -> Self {
        if portrait.faces.is_empty() {
            return Self { outline: BezPath::new(), lines: Vec::new(), irises: Default::default(), pearls: Pearls::default() };
        }
        let darks = Darks { portrait, ink, pitch };
        let mut solids = Self::of_features(portrait, ink, pitch);
        solids.outline.extend(darks.rims());
        Self { lines: spectacles::frames(portrait, pitch), ..solids }
    }

    /// The darkest places of features alone: neither rims of spectacles nor irises.
    pub(super) fn of_darkest(portrait: &Portrait, ink: &Raster<f32>, pitch: f64) -> Self {
        let darks = Darks { portrait, ink, pitch };
        let outline = darks.shapes_of(&darks.darkness(0.0));
        let pearls = Pearls::of(portrait, pitch);
        Self { outline, lines: spectacles::frames(portrait, pitch), irises: Default::default(), pearls }
    }

    /// The shapes of eyes, nostrils and mouths alone, for a style that draws lines and frames of its own.
    pub(super) fn of_features(portrait: &Portrait, ink: &Raster<f32>, pitch: f64) -> Self {
        let darks = Darks { portrait, ink, pitch };
        let irises = light_irises(portrait, ink, pitch);
        let mut dark = darks.darkness(EYE_LIFT);
        irises.iter().for_each(|iris| iris.draw(&mut dark, ink));
        let grounds = irises.iter().map(DrawnIris::ground).reduce(|all, each| all.zip_map(&each, f32::max));
        let ground = grounds.map_or_else(BezPath::new, |ground| shapes(portrait, pitch, &ground, 0.5, |_| true));
        let spokes = irises.iter().flat_map(|iris| iris.spokes(&portrait.placement, ink, pitch)).collect();
        let pearls = Pearls::of(portrait, pitch);
        Self { outline: darks.shapes_of(&dark), lines: Vec::new(), irises: (ground, spokes), pearls }
    }

    /// The solids with the lines of the mouths, whose widths count by `share`.
    pub(super) fn with_mouths(mut self, portrait: &Portrait, pitch: f64, share: f64) -> Self {
        self.lines.extend(Mouths::of(portrait, pitch).strokes(&portrait.placement, share));
        self
    }

    /// The solids with the lines between teeth.
    pub(super) fn with_gaps_of_teeth(mut self, portrait: &Portrait, pitch: f64) -> Self {
        self.lines.extend(Mouths::of(portrait, pitch).between_teeth(&portrait.placement));
        self
    }

    /// The solids with all lines of the mouths: those of [`Self::with_mouths`], between teeth, and along the lips' outer borders.
    pub(super) fn with_whole_mouths(mut self, portrait: &Portrait, pitch: f64, share: f64) -> Self {
        let mouths = Mouths::of(portrait, pitch);
        self.lines.extend(mouths.strokes(&portrait.placement, share));
        self.lines.extend(mouths.between_teeth(&portrait.placement));
        self.lines.extend(mouths.around_lips(&portrait.placement));
        self
    }

    /// The solids with the lines of the lids, whose widths count by `share`.
    pub(super) fn with_lids(mut self, portrait: &Portrait, pitch: f64, share: f64) -> Self {
        self.lines.extend(Lids::of(portrait, pitch).strokes(&portrait.placement, share));
        self
    }

    /// The solids with the lines of the jaws, whose widths count by `share`.
    pub(super) fn with_jaws(mut self, portrait: &Portrait, pitch: f64, share: f64) -> Self {
        self.lines.extend(Jaws::of(portrait, pitch).strokes(&portrait.placement, share));
        self
    }

    /// Their layer, in place of the dots inside them and in pearls, and the spokes of light irises in place of theirs.
    pub(super) fn over(mut self, layers: &mut [Layer]) -> Layer {
        let (irises, spokes) = std::mem::take(&mut self.irises);
        let pearls = std::mem::take(&mut self.pearls.ground);
        let mut solids = self.layer();
        let outlines = solids.marks.iter().filter_map(|mark| match mark {
            Mark::Area(area) => Some(area.outline.clone()),
            Mark::Stroke(stroke) => Some(stroke.ink_outline(TOLERANCE)),
            Mark::Dot(_) => None,
        });
        let inside: Vec<Region> = outlines.chain([irises, pearls]).map(|outline| Region::new(&outline, TOLERANCE)).collect();
        for layer in layers {
            layer.marks.retain(|mark| !matches!(mark, Mark::Dot(dot) if inside.iter().any(|solid| solid.contains(dot.centre))));
        }
        solids.marks.extend(spokes);
        solids
    }

    /// One area; no mark if there are no shapes.
    pub(super) fn layer(self) -> Layer {
        let mut layer = Layer::new("solids", 1);
        if !self.outline.is_empty() {
            layer.marks.push(Mark::Area(Area { outline: self.outline, colour: None }));
        }
        layer.marks.extend(self.lines);
        layer.marks.extend(self.pearls.marks);
        layer
    }
}

/// The darkest places of faces.
struct Darks<'a> {
    portrait: &'a Portrait,
    ink: &'a Raster<f32>,
    pitch: f64,
}

impl Darks<'_> {
    fn inside(&self, of: [&[usize]; 2]) -> Raster<f32> {
        inside_outlines(&self.portrait.faces, of, (self.ink.width(), self.ink.height()))
    }

    /// How much darker the thin dark parts of a frame of spectacles are than what lies around them.
    fn thin_darks(&self) -> Raster<f32> {
        let widest = self.portrait.faces.iter().map(Landmarks::width).fold(1.0, f64::max);
        let around = gaussian_blur(self.ink, (THIN * widest) as f32);
        let near = gaussian_blur(self.ink, (0.15 * self.pitch) as f32);
        let brows = self.inside([&outlines::LEFT_BROW, &outlines::RIGHT_BROW]);
        let brows = gaussian_blur(&brows, (THIN * widest) as f32);
        let frames = spectacles::zone(&self.portrait.faces, around.width(), around.height());
        Raster::from_fn(around.width(), around.height(), |x, y| {
            // Elsewhere thin darks are folds, lids, and shadows between cheek and hair: as parts of a frame they are crumbs.
            if frames.get(x, y) == 0 {
                return 0.0;
            }
            (near.get(x, y) - around.get(x, y)) * (1.0 - (3.0 * brows.get(x, y)).min(1.0))
        })
    }

    /// The ink of details, smoothed, with more in eyes.
    fn darkness(&self, eye_lift: f32) -> Raster<f32> {
        let pitch = self.pitch;
        let ears = beside_faces(self.portrait, pitch);
        let detail = detail_zone(self.portrait, pitch).zip_map(&ears, |detail, ear| detail * (1.0 - ear));
        let detail = match self.portrait.masks.get(&MaskRole::FacialHair) {
            Some(beard) => {
                let hair = beard.zip_map(&self.inside([&outlines::LIPS, &outlines::MOUTH]), |beard, mouth| beard * (1.0 - mouth));
                detail.zip_map(&hair, |detail, hair| detail * (1.0 - hair))
            }
            None => detail,
        };
        let eyes = gaussian_blur(&self.inside([&outlines::LEFT_EYE, &outlines::RIGHT_EYE]), (0.5 * pitch) as f32);
        let lifted = self.ink.zip_map(&eyes, |ink, eyes| ink + eye_lift * (2.0 * eyes).min(1.0));
        gaussian_blur(&lifted.zip_map(&detail, |ink, detail| ink * (2.0 * detail).min(1.0)), (SOLID_BLUR * pitch) as f32)
    }

    /// The darkest places of eyes, nostrils and mouth as shapes with smooth borders: pupils, lashes, the line between the lips. Empty without faces.
    fn shapes_of(&self, dark: &Raster<f32>) -> BezPath {
        if self.portrait.faces.is_empty() {
            return BezPath::new();
        }
        let least = (LEAST_SOLID * self.pitch).powi(2);
        shapes(self.portrait, self.pitch, dark, SOLID, |curve| polygon_area(curve).abs() >= least)
    }

    /// Thin dark lines before eyes.
    fn rims(&self) -> BezPath {
        let longest = |curve: &[Point]| {
            let bounds = curve.iter().fold(Rect::from_points(curve[0], curve[0]), |bounds, p| bounds.union_pt(*p));
            bounds.width().hypotenuse(bounds.height())
        };
        let widest = self.portrait.faces.iter().map(Landmarks::width).fold(1.0, f64::max);
        shapes(self.portrait, self.pitch, &self.thin_darks(), THIN_DARK, |curve| longest(curve) > LONG * widest)
    }
}

/// The smooth outlines on the page of what lies above a level: the shapes that are wanted, with their holes.
pub(super) fn shapes(
    portrait: &Portrait,
    pitch: f64,
    dark: &Raster<f32>,
    level: f32,
    is_wanted: impl Fn(&[Point]) -> bool,
) -> BezPath {
    let curves = contours(dark, level).into_iter().filter(|curve| curve.closed).map(|curve| curve.points);
    let (shapes, holes): (Vec<Vec<Point>>, Vec<Vec<Point>>) = curves.partition(|curve| polygon_area(curve) < 0.0);
    let shapes: Vec<Vec<Point>> = shapes.into_iter().filter(|shape| is_wanted(shape)).collect();
    let inside = Region::of_polygons(shapes.clone());
    let mut outline = BezPath::new();
    for curve in shapes.into_iter().chain(holes.into_iter().filter(|hole| inside.contains(hole[0]))) {
        let smooth = smooth_polyline(&curve, Ring::Closed, 0.1 * pitch, NODE * pitch);
        let places: Vec<Point> = smooth.iter().map(|p| portrait.placement.to_page(*p)).collect();
        outline.extend(catmull_rom(&places, Ring::Closed));
    }
    outline
}
