//! What is drawn solid in a face whatever the style's marks: pupils, lashes, nostrils, the line between the lips, frames of spectacles.

use super::head::Head;
use super::spectacles;
use crate::drawing::{Area, Layer, Mark};
use crate::elementary::Elementary as _;
use crate::field::contours;
use crate::geometry::{BezPath, Point, Rect, Region, Ring, Vec2, catmull_rom, polygon_area, smooth_polyline};
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
/// Where frames are looked for: in heights of the face above its chin, between nostrils and brows.
const BAND: std::ops::Range<f64> = -0.75..-0.47;
/// How far inside the face's outline a frame that was not found as lines must lie, as a share of its size: the shadow between cheek and
/// hair is as thin and dark.
const INNER: f64 = 0.93;
/// The wings of the nose and its tip in the mesh, and how near to them, in widths of the face, nothing is a frame.
const NOSE_WINGS: [usize; 3] = [129, 358, 1];
const AT_NOSE: f64 = 0.14;

/// Where details are finer, 0 to 1; `pitch` in working pixels.
pub(super) fn detail_zone(portrait: &Portrait, pitch: f64) -> Raster<f32> {
    portrait.masks.get(&MaskRole::Detail).map_or_else(
        || portrait.subject.map(|_| 0.0),
        |mask| gaussian_blur(mask, (DETAIL_BLUR * pitch) as f32).map(|v| (1.3 * v).min(1.0)),
    )
}

/// The solid shapes of a portrait's faces.
pub(super) struct Solids {
    /// On the page; empty without faces.
    pub outline: BezPath,
    /// Frames of spectacles that were found as lines.
    pub frames: Vec<Mark>,
}

impl Solids {
    /// By the ink wanted on the working grid; `pitch` in its pixels.
    pub(super) fn new(portrait: &Portrait, ink: &Raster<f32>, pitch: f64) -> Self {
        if portrait.faces.is_empty() {
            return Self { outline: BezPath::new(), frames: Vec::new() };
        }
        let darks = Darks { portrait, ink, pitch };
        let mut outline = darks.features(EYE_LIFT);
        outline.extend(darks.rims());
        Self { outline, frames: spectacles::frames(portrait, pitch) }
    }

    /// The darkest places of features alone: neither rims of spectacles nor irises.
    pub(super) fn of_darkest(portrait: &Portrait, ink: &Raster<f32>, pitch: f64) -> Self {
        let has_faces = !portrait.faces.is_empty();
        let outline = if has_faces { Darks { portrait, ink, pitch }.features(0.0) } else { BezPath::new() };
        Self { outline, frames: spectacles::frames(portrait, pitch) }
    }

    /// One area; no mark if there are no shapes.
    pub(super) fn layer(self) -> Layer {
        let mut layer = Layer::new("solids", 1);
        if !self.outline.is_empty() {
            layer.marks.push(Mark::Area(Area { outline: self.outline, colour: None }));
        }
        layer.marks.extend(self.frames);
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
    /// The inside of two closed outlines of all faces, 0 or 1.
    fn filled(&self, of: [&[usize]; 2]) -> Raster<f32> {
        self.inside(self.portrait.faces.iter().flat_map(|face| of.map(|outline| face.line(outline))))
    }

    /// The inside of closed lines, 0 or 1.
    fn inside(&self, lines: impl Iterator<Item = Vec<Point>>) -> Raster<f32> {
        let (columns, rows) = (self.ink.width(), self.ink.height());
        lines.fold(Raster::filled(columns, rows, 0.0_f32), |all, lids| {
            let corners: Vec<[f64; 2]> = lids.iter().map(|p| [p.x, p.y]).collect();
            all.zip_map(&filled_polygon(columns, rows, &corners), |all, inside| all.max(f32::from(inside)))
        })
    }

    /// How much darker thin dark lines between brows and cheeks are than what lies around them: frames of spectacles.
    fn thin_darks(&self) -> Raster<f32> {
        let widest = self.portrait.faces.iter().map(Landmarks::width).fold(1.0, f64::max);
        let around = gaussian_blur(self.ink, (THIN * widest) as f32);
        let near = gaussian_blur(self.ink, (0.15 * self.pitch) as f32);
        let brows = self.filled([&outlines::LEFT_BROW, &outlines::RIGHT_BROW]);
        let brows = gaussian_blur(&brows, (THIN * widest) as f32);
        let frames = spectacles::zone(&self.portrait.faces, around.width(), around.height());
        // Where the frame was found as lines, other thin darks are crumbs.
        let unknown = || self.portrait.faces.iter().filter(|face| face.spectacles.is_none());
        let heads: Vec<Head> = unknown().map(Head::new).collect();
        let inner = self.inside(unknown().map(inner_oval));
        Raster::from_fn(around.width(), around.height(), |x, y| {
            let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
            // The folds beside a nose are as thin and dark as frames.
            let is_at_nose = self
                .portrait
                .faces
                .iter()
                .any(|face| NOSE_WINGS.iter().any(|wing| face.point(*wing).distance(p) < AT_NOSE * face.width()));
            let is_before = |head: &Head| BAND.contains(&head.relative(p).1);
            let is_unknown = inner.get(x, y) > 0.0 && heads.iter().any(is_before);
            let is_in_band = !is_at_nose && (frames.get(x, y) == 1 || is_unknown);
            if is_in_band { (near.get(x, y) - around.get(x, y)) * (1.0 - (3.0 * brows.get(x, y)).min(1.0)) } else { 0.0 }
        })
    }

    /// The darkest places of eyes, nostrils and mouth as shapes with smooth borders: pupils, lashes, the line between the lips; eyes
    /// count as darker by `eye_lift`.
    fn features(&self, eye_lift: f32) -> BezPath {
        let pitch = self.pitch;
        let detail = detail_zone(self.portrait, pitch);
        let eyes = gaussian_blur(&self.filled([&outlines::LEFT_EYE, &outlines::RIGHT_EYE]), (0.5 * pitch) as f32);
        let lifted = self.ink.zip_map(&eyes, |ink, eyes| ink + eye_lift * (2.0 * eyes).min(1.0));
        let dark =
            gaussian_blur(&lifted.zip_map(&detail, |ink, detail| ink * (2.0 * detail).min(1.0)), (SOLID_BLUR * pitch) as f32);
        self.shapes(&dark, SOLID, |curve| polygon_area(curve).abs() >= (LEAST_SOLID * pitch).powi(2))
    }

    /// Thin dark lines before eyes.
    fn rims(&self) -> BezPath {
        let longest = |curve: &[Point]| {
            let bounds = curve.iter().fold(Rect::from_points(curve[0], curve[0]), |bounds, p| bounds.union_pt(*p));
            bounds.width().hypotenuse(bounds.height())
        };
        let widest = self.portrait.faces.iter().map(Landmarks::width).fold(1.0, f64::max);
        self.shapes(&self.thin_darks(), THIN_DARK, |curve| longest(curve) > LONG * widest)
    }

    /// The smooth outlines of what lies above a level: the shapes that are wanted, with their holes.
    fn shapes(&self, dark: &Raster<f32>, level: f32, is_wanted: impl Fn(&[Point]) -> bool) -> BezPath {
        let pitch = self.pitch;
        let curves = contours(dark, level).into_iter().filter(|curve| curve.closed).map(|curve| curve.points);
        let (shapes, holes): (Vec<Vec<Point>>, Vec<Vec<Point>>) = curves.partition(|curve| polygon_area(curve) < 0.0);
        let shapes: Vec<Vec<Point>> = shapes.into_iter().filter(|shape| is_wanted(shape)).collect();
        let inside = Region::of_polygons(shapes.clone());
        let mut outline = BezPath::new();
        for curve in shapes.into_iter().chain(holes.into_iter().filter(|hole| inside.contains(hole[0]))) {
            let smooth = smooth_polyline(&curve, Ring::Closed, 0.1 * pitch, NODE * pitch);
            let places: Vec<Point> = smooth.iter().map(|p| self.portrait.placement.to_page(*p)).collect();
            outline.extend(catmull_rom(&places, Ring::Closed));
        }
        outline
    }
}

/// The outline of a face, shrunk.
fn inner_oval(face: &Landmarks) -> Vec<Point> {
    let oval = face.line(&outlines::OVAL);
    let centre = (oval.iter().fold(Vec2::ZERO, |sum, p| sum + p.to_vec2()) / oval.len() as f64).to_point();
    oval.iter().map(|p| centre.lerp(*p, INNER)).collect()
}
