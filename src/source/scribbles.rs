//! Scribbles: regions marked by hand, one colour each.

use super::decode::Photograph;
use super::error::SourceError;
use super::placement::{Crop, Placement};
use crate::raster::Raster;
use image::GenericImageView;
use std::collections::BTreeMap;
use std::ops::Range;

/// Least share of the picture that a colour must cover to be a region; smaller shares are the soft edges of brushes.
const LEAST_SHARE: f64 = 5e-5;
/// Greatest number of regions.
const MOST_REGIONS: usize = 1000;
/// A pixel whose channels are all below this is black: unmarked.
const BLACK: u8 = 24;

/// Regions marked by hand, on the working grid.
#[derive(Clone, Debug)]
pub struct Scribbles {
    /// 0 where unmarked, else the region's number, from 1.
    pub labels: Raster<i32>,
    /// The sRGB colour of each region, in the order of its numbers.
    pub colours: Vec<[u8; 3]>,
}

impl Scribbles {
    /// Each working pixel takes the colour of the mask's pixel at its centre. Black pixels and those more than half transparent
    /// are unmarked.
    pub(super) fn read(mask: &Photograph, crop: Crop, placement: Placement) -> Result<Self, SourceError> {
        let marked = |x: u32, y: u32| {
            let [r, g, b, alpha] = mask.pixels.get_pixel(x, y).0;
            (alpha >= 128 && r.max(g).max(b) >= BLACK).then_some([r, g, b])
        };
        let mut counts: BTreeMap<[u8; 3], u64> = BTreeMap::new();
        for (x, y) in (0..mask.height()).flat_map(|y| (0..mask.width()).map(move |x| (x, y))) {
            if let Some(colour) = marked(x, y) {
                *counts.entry(colour).or_default() += 1;
            }
        }
        let least = (LEAST_SHARE * f64::from(mask.width()) * f64::from(mask.height())).max(4.0);
        let colours: Vec<[u8; 3]> =
            counts.into_iter().filter(|(_, count)| *count as f64 >= least).map(|(colour, _)| colour).collect();
        if colours.is_empty() || colours.len() > MOST_REGIONS {
            return Err(SourceError::Scribbles { colours: colours.len(), most: MOST_REGIONS });
        }
        let step = (crop.width / placement.columns as f64, crop.height / placement.rows as f64);
        let labels = Raster::from_fn(placement.columns, placement.rows, |x, y| {
            let at = |from: f64, step: f64, i: usize, end: u32| ((from + (i as f64 + 0.5) * step) as u32).min(end - 1);
            let colour = marked(at(crop.x, step.0, x, mask.width()), at(crop.y, step.1, y, mask.height()));
            colour.and_then(|c| colours.binary_search(&c).ok()).map_or(0, |i| i as i32 + 1)
        });
        Ok(Self { labels, colours })
    }

    /// Some columns and rows; the colours stay.
    pub(super) fn part(&self, columns: &Range<usize>, rows: &Range<usize>) -> Self {
        Self { labels: self.labels.part(columns, rows), colours: self.colours.clone() }
    }
}
