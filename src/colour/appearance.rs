//! What a sheet looks like, by the same model that separates.

use super::neugebauer::Model;
use super::pens::MOST_PENS;
use super::space::xyz_to_rgb;
use crate::raster::Raster;

/// Predicted linear sRGB light, 0 to 1 per channel, of a sheet with these coverages, one raster per pen in the set's order; the
/// paper has its own colour. `None` if the number of rasters is not that of the model's pens, or their sizes differ.
pub fn appearance(model: &Model, coverages: &[Raster<f32>]) -> Option<Raster<[f32; 3]>> {
    let (width, height) = coverages.first().map(|raster| (raster.width(), raster.height()))?;
    let is_whole = coverages.len() == model.pens() && coverages.iter().all(|r| (r.width(), r.height()) == (width, height));
    is_whole.then(|| {
        Raster::from_fn(width, height, |x, y| {
            let mut here = [0.0; MOST_PENS];
            here.iter_mut().zip(coverages).for_each(|(c, raster)| *c = raster.get(x, y));
            xyz_to_rgb(model.xyz(&here[..coverages.len()])).map(|v| v.clamp(0.0, 1.0) as f32)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::super::overlap::Overlap;
    use super::super::pens::{ColourPen, Paper, PenSet};
    use super::*;
    use crate::drawing::Colour;

    fn model() -> Model {
        let paper = Paper { colour: [0.9, 0.85, 0.7] };
        let red = ColourPen { colour: [0.6, 0.05, 0.04], ..ColourPen::new("red", 0.3, Colour::BLACK) };
        Model::new(&PenSet::new(vec![red], paper, Vec::new()).unwrap(), 1.4, Overlap::Random)
    }

    #[test]
    fn bare_paper_and_solid_ink_are_as_measured() {
        let coverages = Raster::from_vec(2, 1, vec![0.0, 1.0]);
        let seen = appearance(&model(), &[coverages]).unwrap();
        let near = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 2e-3);
        assert!(near(seen.get(0, 0), [0.9, 0.85, 0.7]), "{:?}", seen.get(0, 0));
        assert!(near(seen.get(1, 0), [0.6, 0.05, 0.04]), "{:?}", seen.get(1, 0));
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let raster = |width: usize| Raster::filled(width, 2, 0.5);
        assert!(appearance(&model(), &[]).is_none());
        assert!(appearance(&model(), &[raster(2), raster(2)]).is_none());
        assert!(appearance(&model(), &[Raster::filled(2, 2, f32::NAN)]).is_some());
    }
}
