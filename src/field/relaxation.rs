//! Lloyd's relaxation of weighted sites, free or in lanes (Kim et al. 2008; Bruehl 2023, section 3.3).

use super::{Lanes, Sites};
use crate::geometry::Point;
use crate::parallel::collected;
use crate::raster::Raster;

/// Bands of rows in which centroids are summed; a fixed number, so that sums do not depend on the number of threads.
const BANDS: usize = 16;

/// The constraint that keeps a dot in its lane in a constrained round.
#[derive(Clone, Copy, Debug)]
pub struct LaneConstraint<'a> {
    /// The lanes.
    pub lanes: &'a Lanes,
    /// Distance from the feature at which offset lines no longer count (`D_w`), in pixels.
    pub reach: f32,
}

impl LaneConstraint<'_> {
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

/// One round of Lloyd's relaxation: every site moves to the weighted centroid of its Voronoi cell. Sites and spacing are in pixels;
/// `spacing` is about the distance of neighbours. The density of the relaxed sites is proportional to the square root of the weight
/// (Du et al. 1999).
///
/// # Panics
/// If there is no site.
pub fn relaxed(sites: &[Point], weight: &Raster<f32>, spacing: f64) -> Vec<Point> {
    towards_centres(sites, weight, None, spacing)
}

/// As [`relaxed`], with each site drawn towards the middle of its lane (equation of Bruehl 3.3.2).
///
/// # Panics
/// If there is no site.
pub fn relaxed_in_lanes(sites: &[Point], weight: &Raster<f32>, spacing: f64, lanes: LaneConstraint<'_>) -> Vec<Point> {
    towards_centres(sites, weight, Some(lanes), spacing)
}

fn towards_centres(sites: &[Point], weight: &Raster<f32>, constraint: Option<LaneConstraint<'_>>, pitch: f64) -> Vec<Point> {
    let (width, height) = (weight.width(), weight.height());
    let nearest = Sites::new(sites, width as f64, height as f64, pitch).nearest(weight);
    let lane_of: Vec<i32> = match constraint {
        None => Vec::new(),
        Some(c) => {
            sites.iter().map(|p| c.lanes.lane.get((p.x as usize).min(width - 1), (p.y as usize).min(height - 1))).collect()
        }
    };
    let rows = height.div_ceil(BANDS);
    let sums: Vec<BandSums> = collected(BANDS, &|band| {
        let rows = (band * rows).min(height)..((band + 1) * rows).min(height);
        let mut sums = BandSums::new(&nearest.pixels()[rows.start * width..rows.end * width]);
        for y in rows {
            for (x, (&site, &base)) in nearest.row(y).iter().zip(weight.row(y)).enumerate() {
                if site == u32::MAX || base == 0.0 {
                    continue;
                }
                let w = base * constraint.map_or(1.0, |c| c.weight(y * width + x, lane_of[site as usize]));
                sums.add(site, w, x as f32 + 0.5, y as f32 + 0.5);
            }
        }
        sums
    });
    let mut totals = vec![[0.0_f64; 3]; sites.len()];
    for band in &sums {
        for (total, sum) in totals.iter_mut().skip(band.first).zip(&band.sums) {
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
        // `u32::MAX` is no site: the least label is a site's unless there is none, and one more than the greatest wraps to 0.
        let (mut first, mut end) = (u32::MAX, 0);
        for label in labels {
            first = first.min(*label);
            end = end.max(label.wrapping_add(1));
        }
        Self { first: first as usize, sums: vec![[0.0; 3]; (end as usize).saturating_sub(first as usize)] }
    }

    fn add(&mut self, site: u32, weight: f32, x: f32, y: f32) {
        let sum = &mut self.sums[site as usize - self.first];
        sum[0] += f64::from(weight);
        sum[1] += f64::from(weight * x);
        sum[2] += f64::from(weight * y);
    }
}
