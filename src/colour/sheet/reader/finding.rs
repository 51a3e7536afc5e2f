//! Finds the sheet in a picture.

use super::blobs::{Blob, dark_blobs, local_mean};
use super::curve::Curve;
use super::error::ReadError;
use super::marks::{Mark, marks};
use super::picture::{Picture, Probe};
use super::quad::{has_three, quads};
use super::spotting::Grey;
use super::tuning::{Row, Tuned, has_neighbours, tuned};
use super::view::View;
use crate::colour::sheet::code::Code;
use crate::colour::sheet::grid::{CORNERS, VERSION};
use crate::raster::{Raster, reduce};

/// Smallest side of a picture in pixels.
const LEAST_SIDE: usize = 240;
/// Largest ratio of a picture's sides: a photograph of a sheet, not a strip.
const MOST_ASPECT: usize = 12;
/// Windows of the threshold as shares of the picture's longer side, and what is dark relative to their mean.
const WINDOWS: [(f64, &[f32]); 3] = [(0.06, &[0.8, 0.9]), (0.03, &[0.85]), (0.1, &[0.62])];
/// Reductions beyond the first: on the coarse picture the search is quick, and table and noise are smooth.
const COARSER: [usize; 2] = [2, 1];
/// Largest error of a sheet's marks, in cells.
const MOST_ERROR: f64 = 0.05;

/// A sheet in a picture.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub tuned: Tuned,
    pub code: Code,
    /// By which its marks stand out.
    pub grey: Grey,
}

/// Finds the sheet, whatever its turn.
pub(super) fn find(picture: Picture<'_>) -> Result<Found, ReadError> {
    let (width, height) = (picture.width(), picture.height());
    let (long, short) = (width.max(height), width.min(height));
    if short < LEAST_SIDE || long > MOST_ASPECT * short {
        return Err(ReadError::Size { width, height, least: LEAST_SIDE });
    }
    let mut search =
        Search { probe: Probe::new(picture, Curve::default()), width, height, is_unreadable: false, is_cut_off: false };
    let factor = picture.reduction();
    for darkest in [false, true] {
        let fine = picture.grey(factor, darkest);
        for coarser in COARSER {
            let grey = reduce(&fine, coarser);
            if let Some(found) = search.among(&grey, factor * coarser, Grey { darkest })? {
                return Ok(found);
            }
        }
    }
    Err(match search {
        Search { is_unreadable: true, .. } => ReadError::CodeUnreadable,
        Search { is_cut_off: true, .. } => ReadError::CutOff,
        _ => ReadError::NoSheet,
    })
}

/// A search, and how near it came.
struct Search<'a> {
    probe: Probe<'a>,
    width: usize,
    height: usize,
    /// A quad's dots were in their places, but its code could not be read.
    is_unreadable: bool,
    /// Three marks fit together, but there is no fourth.
    is_cut_off: bool,
}

impl Search<'_> {
    /// The sheet by the marks of a reduced picture.
    fn among(&mut self, reduced: &Raster<f32>, factor: usize, grey: Grey) -> Result<Option<Found>, ReadError> {
        for (share, levels) in WINDOWS {
            let radius = share * reduced.width().max(reduced.height()) as f64;
            let mean = local_mean(reduced, radius.ceil() as usize);
            for level in levels {
                let blobs: Vec<Blob> =
                    dark_blobs(reduced, &mean, *level).iter().map(|blob| blob.enlarged(factor as f64)).collect();
                if let Some(found) = self.verified(&marks(&blobs), grey)? {
                    return Ok(Some(found));
                }
            }
        }
        Ok(None)
    }

    /// The first quad that has a sheet's dots and code.
    fn verified(&mut self, marks: &[Mark], grey: Grey) -> Result<Option<Found>, ReadError> {
        let (width, height) = (self.width, self.height);
        for quad in quads(marks, width, height, |view| has_neighbours(view, &self.probe, grey)) {
            let Some(tuned) = tuned(quad.view, &self.probe, grey) else { continue };
            if tuned.error > MOST_ERROR * resolution(&tuned.view) {
                continue;
            }
            let turned = tuned.turned(width, height);
            let read = [Some(tuned), turned].into_iter().flatten().map(|way| (way.code(&self.probe, grey), way));
            match read.max_by(|a, b| a.0.contrast.total_cmp(&b.0.contrast)) {
                Some((Row { code: Some(code), .. }, _)) if code.version != VERSION => {
                    return Err(ReadError::OtherVersion { version: code.version });
                }
                Some((Row { is_mirrored: true, .. }, _)) => return Err(ReadError::Mirrored),
                Some((Row { code: Some(code), .. }, tuned)) => return Ok(Some(Found { tuned, code, grey })),
                _ => self.is_unreadable = true,
            }
        }
        self.is_cut_off |= has_three(marks);
        Ok(None)
    }
}

/// Pixels per cell at the sheet's coarsest corner.
pub(super) fn resolution(view: &View) -> f64 {
    CORNERS.iter().map(|p| view.scale(*p)).fold(f64::INFINITY, f64::min)
}
