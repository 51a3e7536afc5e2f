//! Step 3: regions, each with its own line direction (Galarza 2017, sections 3.3 and 3.4).

use super::Drawer;
use super::lines::FIT_ROOM;
use super::merging::merge_similar;
use super::parameters::Division;
use super::region_map::{Grid, Region, RegionMap};
use super::relief::Relief;
use crate::elementary::Elementary as _;
use crate::field::{Curve, contours, distance_to_curves, superpixels, watershed};
use crate::geometry::{Rect, Vec2};
use crate::parallel::collected;
use crate::raster::{Raster, gaussian_blur, sobel};

/// Standard deviation of the smoothing of regions' borders, in pitches: less leaves pixel stairs, more rounds off corners.
const BORDER_SMOOTHING: f64 = 0.5;
/// SLIC's compactness for CIE Lab from 0 to 100, and its rounds (Achanta et al. 2012).
const COMPACTNESS: f32 = 10.0;
const ROUNDS: u32 = 10;

impl Drawer<'_> {
    pub(super) fn ground(&self, relief: &Relief) -> RegionMap {
        self.observer.begin("regions");
        let placement = &self.portrait.placement;
        let scale = placement.mm_per_pixel() as f32;
        let (parts, angles) = self.directed_parts(&relief.cover);
        let (labels, mut curves) = match &parts {
            Some(parts) => smooth_borders(parts, (BORDER_SMOOTHING * self.pitch()) as f32),
            None => (relief.cover.map(|_| 1), Vec::new()),
        };
        let labels = labels.zip_map(&relief.cover, drawn_label);
        curves.extend(relief.silhouette.iter().cloned());
        let border =
            distance_to_curves(&curves, placement.columns, placement.rows).map(|field| field.distance.map(|d| d * scale));
        // A single region has no neighbour to overlap.
        let overlap = if angles.len() > 1 { self.parameters.overlap.0 } else { 0.0 };
        let regions = bounds_of(&labels, angles.len() as i32)
            .into_iter()
            .zip(&angles)
            .enumerate()
            .filter_map(|(i, (bounds, angle))| {
                Some(Region { label: i as i32 + 1, angle: *angle, bounds: self.on_page(bounds?, overlap) })
            })
            .collect();
        let gap = self.parameters.min_gap.0 + 2.0 * FIT_ROOM;
        let near = 0.5 * self.parameters.width_max.0 + gap;
        let displacement = relief.nearness.map(|nearness| (self.parameters.displacement.0 * f64::from(nearness)) as f32);
        RegionMap { grid: Grid::new(placement), labels, border, regions, angles, displacement, overlap, gap, near }
    }

    /// Labels from 1, none for a single region, and the direction of each; superpixels of nearly the same direction are merged.
    fn directed_parts(&self, cover: &Raster<f32>) -> (Option<Raster<i32>>, Vec<f64>) {
        let Some(parts) = self.parts() else {
            return (None, self.angles(&cover.map(|_| 1).zip_map(cover, drawn_label), 1));
        };
        let count = parts.pixels().iter().copied().max().unwrap_or(0);
        let drawn = parts.zip_map(cover, drawn_label);
        let angles = self.angles(&drawn, count);
        if self.parameters.regions != Division::Superpixels {
            return (Some(parts), angles);
        }
        let (joined, angles) = merge_similar(&drawn, &angles);
        (Some(parts.map(|label| joined[label as usize - 1])), angles)
    }

    /// Labels from 1; none for a single region.
    fn parts(&self) -> Option<Raster<i32>> {
        match self.parameters.regions {
            Division::One => None,
            Division::Superpixels => {
                let colours = self.portrait.light.map(lab);
                let size = self.pixels(self.parameters.region_size).round() as usize;
                Some(superpixels(&colours, size, COMPACTNESS, ROUNDS).map(|label| label + 1))
            }
            Division::Auto => self.flooded_scribbles(),
        }
    }

    /// The scribbles' regions, grown along the photograph's edges.
    fn flooded_scribbles(&self) -> Option<Raster<i32>> {
        let scribbles = self.portrait.scribbles.as_ref()?;
        let smoothed = gaussian_blur(&self.portrait.lightness, 1.5);
        let slope = sobel(&smoothed).map(|[x, y]| x.hypotenuse(y));
        let steepest = slope.pixels().iter().copied().fold(1e-6, f32::max);
        // The root separates faint edges, which most of a face's are.
        Some(watershed(&slope.map(|s| (s / steepest).sqrt()), &scribbles.labels))
    }

    /// Regions to inflate without a depth map: the scribbles' regions, otherwise the subject; 0 is background.
    pub(super) fn great_regions(&self) -> Raster<i32> {
        let parts = self.flooded_scribbles().unwrap_or_else(|| self.portrait.subject.map(|_| 1));
        parts.zip_map(&self.portrait.subject, |label, subject| if subject >= 0.5 { label } else { 0 })
    }

    /// A rectangle of working pixels on the page, with a pixel and the overlap around it.
    fn on_page(&self, pixels: Rect, overlap: f64) -> Rect {
        let placement = &self.portrait.placement;
        let wide = pixels.inflate(1.0, 1.0);
        Rect::from_points(placement.to_page((wide.x0, wide.y0).into()), placement.to_page((wide.x1, wide.y1).into()))
            .inflate(overlap, overlap)
    }
}

/// The label of a drawn pixel; 0 if it is not drawn.
fn drawn_label(label: i32, cover: f32) -> i32 {
    if cover >= 0.5 { label } else { 0 }
}

/// Regions with smooth borders: each pixel goes to the region whose blurred area is largest there. Also returns the borders as curves.
fn smooth_borders(labels: &Raster<i32>, sigma: f32) -> (Raster<i32>, Vec<Curve>) {
    let count = labels.pixels().iter().copied().max().unwrap_or(0);
    let pad = (3.5 * sigma).ceil() + 1.0;
    let bounds = bounds_of(labels, count);
    let blurred: Vec<Option<Patch>> = collected(bounds.len(), &|i| {
        let page = Rect::new(0.0, 0.0, labels.width() as f64, labels.height() as f64);
        let patch = Patch::of(labels, i as i32 + 1, bounds[i]?.inflate(f64::from(pad), f64::from(pad)).intersect(page));
        Some(Patch { area: gaussian_blur(&patch.area, sigma), ..patch })
    });
    // The largest and second largest area at each pixel, and the label of the largest.
    let mut best = labels.map(|_| (0.0_f32, 0.0_f32, 0_i32));
    for (i, patch) in blurred.iter().enumerate() {
        let Some(patch) = patch else { continue };
        patch.each(|x, y, area| {
            let (first, second, label) = best.get(x, y);
            best.set(x, y, if area > first { (area, first, i as i32 + 1) } else { (first, second.max(area), label) });
        });
    }
    let borders = |i: usize| blurred[i].iter().flat_map(|patch| patch.borders(&best, i as i32 + 1)).collect();
    let curves: Vec<Vec<_>> = collected(blurred.len(), &borders);
    (best.map(|(_, _, label)| label), curves.into_iter().flatten().collect())
}

/// The part of the raster around a region.
struct Patch {
    left: usize,
    top: usize,
    area: Raster<f32>,
}

impl Patch {
    fn of(labels: &Raster<i32>, label: i32, bounds: Rect) -> Self {
        let (left, top) = (bounds.x0 as usize, bounds.y0 as usize);
        let (width, height) = ((bounds.x1 as usize).max(left + 1) - left, (bounds.y1 as usize).max(top + 1) - top);
        let area = Raster::from_fn(width, height, |x, y| if labels.get(left + x, top + y) == label { 1.0 } else { 0.0 });
        Self { left, top, area }
    }

    fn each(&self, mut visit: impl FnMut(usize, usize, f32)) {
        for y in 0..self.area.height() {
            for (x, &area) in self.area.row(y).iter().enumerate() {
                visit(self.left + x, self.top + y, area);
            }
        }
    }

    /// Curves where the region's blurred area equals the largest of the others'.
    fn borders(&self, best: &Raster<(f32, f32, i32)>, label: i32) -> Vec<Curve> {
        let lead = Raster::from_fn(self.area.width(), self.area.height(), |x, y| {
            let (first, second, owner) = best.get(self.left + x, self.top + y);
            self.area.get(x, y) - if owner == label { second } else { first }
        });
        let shift = Vec2::new(self.left as f64, self.top as f64);
        let moved = |curve: Curve| Curve { points: curve.points.iter().map(|p| *p + shift).collect(), closed: curve.closed };
        contours(&lead, 0.0).into_iter().map(moved).collect()
    }
}

/// The bounding box of each label from 1 to `count`, in pixels; none if the label does not occur.
fn bounds_of(labels: &Raster<i32>, count: i32) -> Vec<Option<Rect>> {
    let mut bounds: Vec<Option<Rect>> = vec![None; count.max(0) as usize];
    for y in 0..labels.height() {
        let mut x = 0;
        for run in labels.row(y).chunk_by(|a, b| a == b) {
            let pixels = Rect::new(x as f64, y as f64, (x + run.len()) as f64, y as f64 + 1.0);
            x += run.len();
            if run[0] > 0 {
                let bounds = &mut bounds[run[0] as usize - 1];
                *bounds = Some(bounds.map_or(pixels, |b| b.union(pixels)));
            }
        }
    }
    bounds
}

/// CIE Lab (white D65, L from 0 to 100) of linear sRGB.
fn lab([r, g, b]: [f32; 3]) -> [f32; 3] {
    let f = |t: f32| if t > 0.008_856 { t.cube_root() } else { 7.787 * t + 16.0 / 116.0 };
    let x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
    let y = f(0.2126 * r + 0.7152 * g + 0.0722 * b);
    let z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}
