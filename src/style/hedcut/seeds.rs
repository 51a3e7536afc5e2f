//! Step 5: seeds, and constrained Lloyd relaxation (Kim et al. 2008; Bruehl 2023, section 3.3).

use super::Drawer;
use crate::field::{Lanes, Sites};
use crate::geometry::Point;
use crate::raster::Raster;
use crate::style::{StyleError, random};
use rand::RngExt;
use rayon::prelude::*;

/// Bands of rows in which centroids are summed; a fixed number, so that sums do not depend on the number of threads.
const BANDS: usize = 16;
/// Density of dots in a detail region (Bruehl 4.3.2: three times).
const DETAIL_DENSITY: f32 = 3.0;

/// Scatters and relaxes the dots; positions in working pixels.
pub(super) fn place(drawer: &Drawer<'_>, lanes: &Lanes) -> Result<Vec<Point>, StyleError> {
    drawer.observer.begin("seeds");
    let density = density(drawer);
    let mut sites = scatter(drawer, lanes, &density);
    if sites.is_empty() {
        return Err(StyleError::NothingToDraw(
            "the subject is smaller than one dot, or its mask is nowhere more than half white; use a smaller pitch or a whiter mask".to_owned(),
        ));
    }
    drawer.observer.picture("seeds", &|| drawer.dot_picture(&sites));
    drawer.observer.begin("relaxation");
    // The density of cells in a relaxed pattern is proportional to the square root of the weight (Du et al. 1999), so the weight is the
    // square.
    let weight = density.map(|d| d * d);
    let reach = drawer.pixels(drawer.parameters.flow_reach_mm) as f32;
    let rounds = drawer.parameters.plain_rounds + drawer.parameters.flow_rounds;
    for round in 0..rounds {
        if drawer.observer.is_interrupted() {
            return Err(StyleError::Interrupted);
        }
        // The last round is a constrained one: it centres the dots in their lanes.
        let constrained = round >= drawer.parameters.plain_rounds && (rounds - round) % 2 == 1;
        let lanes = constrained.then_some(Constraint { lanes, reach });
        sites = towards_centres(&sites, &weight, lanes, drawer.pitch());
        drawer.observer.progress(f64::from(round + 1) / f64::from(rounds));
    }
    drawer.observer.picture("relaxed", &|| drawer.dot_picture(&sites));
    Ok(sites)
}

/// Target dots per squared pitch: 1 in the subject, more in detail regions, 0 outside.
fn density(drawer: &Drawer<'_>) -> Raster<f32> {
    let subject = &drawer.portrait.subject;
    match drawer.detail() {
        // A soft mask gives a soft change, which hides the border.
        Some(detail) => subject.zip_map(detail, |s, d| if s < 0.5 { 0.0 } else { 1.0 + (DETAIL_DENSITY - 1.0) * d }),
        None => subject.map(|s| f32::from(s >= 0.5)),
    }
}

/// Random seeds with the target mean density. Each cell of one pitch gets its share; the rounding error carries over to the next cell.
/// Seeds are random pixels, off the offset lines if there are enough of them.
fn scatter(drawer: &Drawer<'_>, lanes: &Lanes, density: &Raster<f32>) -> Vec<Point> {
    let (width, height) = drawer.size();
    let pitch = drawer.pitch();
    let side = pitch.round().max(1.0) as usize;
    let per_pixel = 1.0 / (pitch * pitch);
    let mut sites = Vec::new();
    let mut owed = 0.5;
    let mut free = Vec::new();
    for (row, y0) in (0..height).step_by(side).enumerate() {
        for (column, x0) in (0..width).step_by(side).enumerate() {
            let pixels = (y0..(y0 + side).min(height)).flat_map(|y| (x0..(x0 + side).min(width)).map(move |x| (x, y)));
            free.clear();
            let mut on_line = Vec::new();
            for (x, y) in pixels {
                let wanted = density.get(x, y);
                owed += f64::from(wanted) * per_pixel;
                if wanted > 0.0 {
                    if lanes.line.get(x, y) == 0 { free.push((x, y)) } else { on_line.push((x, y)) }
                }
            }
            let mut random = random::stream(drawer.seed, "seeds", (row as u64) << 32 | column as u64);
            while owed >= 1.0 && !(free.is_empty() && on_line.is_empty()) {
                let from = if free.is_empty() { &mut on_line } else { &mut free };
                let (x, y) = from.swap_remove(random.random_range(0..from.len()));
                sites.push(Point::new(x as f64 + random.random::<f64>(), y as f64 + random.random::<f64>()));
                owed -= 1.0;
            }
        }
    }
    sites
}

/// The constraint that keeps a dot in its lane in a constrained round.
#[derive(Clone, Copy)]
struct Constraint<'a> {
    lanes: &'a Lanes,
    /// Distance from the feature at which offset lines no longer count (`D_w`), in pixels.
    reach: f32,
}

impl Constraint<'_> {
    /// The weight of a pixel for a dot in `lane`: 1 in its own lane, 0 in another, `min(D / D_w, 1)` on offset lines. The border of a
    /// detail region is not a lane border: a wall there leaves a bare ring (seen).
    fn weight(&self, pixel: usize, lane: i32) -> f32 {
        if self.lanes.line.pixels()[pixel] != 0 {
            (self.lanes.distance.pixels()[pixel] / self.reach).min(1.0)
        } else {
            let its = self.lanes.lane.pixels()[pixel];
            f32::from(its == lane || Lanes::region(its) != Lanes::region(lane))
        }
    }
}

/// One round: every site moves to the weighted centroid of its Voronoi cell (equation of Bruehl 3.3.2).
fn towards_centres(sites: &[Point], weight: &Raster<f32>, constraint: Option<Constraint<'_>>, pitch: f64) -> Vec<Point> {
    let (width, height) = (weight.width(), weight.height());
    let nearest = Sites::new(sites, width as f64, height as f64, pitch).nearest(weight);
    let lane_of: Vec<i32> = match constraint {
        None => Vec::new(),
        Some(c) => {
            sites.iter().map(|p| c.lanes.lane.get((p.x as usize).min(width - 1), (p.y as usize).min(height - 1))).collect()
        }
    };
    let rows = height.div_ceil(BANDS);
    let sums: Vec<BandSums> = (0..BANDS)
        .into_par_iter()
        .map(|band| {
            let range = (band * rows * width).min(width * height)..((band + 1) * rows * width).min(width * height);
            let mut sums = BandSums::new(&nearest.pixels()[range.clone()]);
            for pixel in range {
                let site = nearest.pixels()[pixel];
                let base = weight.pixels()[pixel];
                if site == u32::MAX || base == 0.0 {
                    continue;
                }
                let w = base * constraint.map_or(1.0, |c| c.weight(pixel, lane_of[site as usize]));
                sums.add(site, w, (pixel % width) as f32 + 0.5, (pixel / width) as f32 + 0.5);
            }
            sums
        })
        .collect();
    let mut totals = vec![[0.0_f64; 3]; sites.len()];
    for band in &sums {
        for (total, sum) in totals[band.first..].iter_mut().zip(&band.sums) {
            total.iter_mut().zip(sum).for_each(|(t, s)| *t += s);
        }
    }
    sites.iter().zip(&totals).map(|(site, &[w, x, y])| if w > 0.0 { Point::new(x / w, y / w) } else { *site }).collect()
}

/// Sums of weight, weight times x and weight times y for the sites that occur in one band.
struct BandSums {
    first: usize,
    sums: Vec<[f64; 3]>,
}

impl BandSums {
    fn new(labels: &[u32]) -> Self {
        let present = || labels.iter().filter(|&&l| l != u32::MAX);
        let first = present().min().copied().unwrap_or(0) as usize;
        let last = present().max().copied().map_or(first, |l| l as usize + 1);
        Self { first, sums: vec![[0.0; 3]; last - first] }
    }

    fn add(&mut self, site: u32, weight: f32, x: f32, y: f32) {
        let sum = &mut self.sums[site as usize - self.first];
        sum[0] += f64::from(weight);
        sum[1] += f64::from(weight * x);
        sum[2] += f64::from(weight * y);
    }
}

impl Drawer<'_> {
    /// Sites as equal dots, for `stages`.
    fn dot_picture(&self, sites: &[Point]) -> crate::style::Picture {
        let radius = 0.15 * self.pitch();
        let dots: Vec<super::SizedDot> = sites.iter().map(|&centre| super::SizedDot { centre, radius }).collect();
        let drawing = crate::drawing::Drawing { page: self.page(), layers: vec![self.plain_dots(&dots)] };
        crate::style::Picture::Drawing(Box::new(drawing))
    }

    fn plain_dots(&self, dots: &[super::SizedDot]) -> crate::drawing::Layer {
        use crate::drawing::{Dot, Layer, Mark};
        let scale = self.portrait.placement.mm_per_pixel();
        let mut layer = Layer::new("dots", 1);
        layer.marks = dots
            .iter()
            .map(|dot| Mark::Dot(Dot::circle(self.portrait.placement.to_page(dot.centre), dot.radius * scale)))
            .collect();
        layer
    }
}
