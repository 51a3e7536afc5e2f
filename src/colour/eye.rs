//! What a tint looks like to an eye that takes the lightest of the sheet for white, and how far two looks are apart.

use super::bands::{BANDS, Bands, TO_LMS};
use super::overlap::Mixed;
use super::pens::MOST_PENS;
use super::space::{ROOTS_TO_OKLAB, XYZ_TO_LMS, rgb_to_xyz, times};
use crate::elementary::Elementary as _;

/// A colour in Oklab: lightness 0 to 1, a, b.
pub(super) type Oklab = [f32; 3];

/// An eye adapted to a white.
#[derive(Clone, Debug)]
pub(super) struct Eye {
    to_lms: [[f32; BANDS]; 3],
}

impl Eye {
    /// Adapted to the light of a reflectance (von Kries, in the cones' responses of Oklab).
    pub fn adapted_to(white: &Bands) -> Self {
        let to_lms = TO_LMS.map(|row| {
            let response: f32 = row.iter().zip(white).map(|(w, r)| w * r).sum();
            row.map(|w| w / response.max(1e-4))
        });
        Self { to_lms }
    }

    /// The look of a reflectance.
    pub fn look(&self, bands: &Bands) -> Oklab {
        let roots = self.to_lms.map(|row| dot(&row, bands).max(0.0).cube_root());
        ROOTS_TO_OKLAB.map(|row| (0..3).map(|i| row[i] as f32 * roots[i]).sum())
    }

    /// The look of a tint, and its slopes along each coverage.
    pub fn look_and_slopes(&self, tint: &Mixed, pens: usize) -> (Oklab, [Oklab; MOST_PENS]) {
        let roots = self.to_lms.map(|row| dot(&row, &tint.value).max(1e-7).cube_root());
        let matrix = ROOTS_TO_OKLAB.map(|row| row.map(|v| v as f32));
        let look = matrix.map(|row| row[0] * roots[0] + row[1] * roots[1] + row[2] * roots[2]);
        let mut slopes = [[0.0; 3]; MOST_PENS];
        for (slope, bands) in slopes.iter_mut().zip(&tint.slopes[..pens]) {
            let mut rise = [0.0; 3];
            (0..3).for_each(|i| rise[i] = dot(&self.to_lms[i], bands) / (3.0 * roots[i] * roots[i]));
            *slope = matrix.map(|row| row[0] * rise[0] + row[1] * rise[1] + row[2] * rise[2]);
        }
        (look, slopes)
    }
}

/// The look of linear sRGB light on a screen whose white is taken for white.
pub(super) fn look_of_light(rgb: [f32; 3]) -> Oklab {
    let lms = times(&XYZ_TO_LMS, rgb_to_xyz(rgb.map(f64::from)));
    times(&ROOTS_TO_OKLAB, lms.map(|v| v.max(0.0).cube_root())).map(|v| v as f32)
}

/// A look to come near to, with the weights of differences from it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aim {
    pub look: Oklab,
    /// Weighted axes: lightness, chroma, hue.
    axes: [[f32; 3]; 3],
}

impl Aim {
    /// `hue` multiplies the weight of differences in hue, `chroma` that of chroma.
    pub fn new(look: Oklab, chroma: f32, hue: f32) -> Self {
        /// Visible differences per unit of Oklab's lightness, and of its other two at neutral colours; these fall with chroma,
        /// along it faster than across. So weighted, distances are about those of CIEDE2000.
        const LIGHTNESS: f32 = 110.0;
        const COLOUR: f32 = 350.0;
        const ALONG: f32 = 16.0;
        const ACROSS: f32 = 5.0;
        /// Chroma from which a hue is fully seen.
        const HAS_HUE: f32 = 0.08;
        let c = look[1].hypotenuse(look[2]);
        let (x, y) = if c > 1e-6 { (look[1] / c, look[2] / c) } else { (1.0, 0.0) };
        // Neutral colours have no hue: both weights are those of colour.
        let certain = (c / HAS_HUE).min(1.0);
        let along = COLOUR / (1.0 + ALONG * c) * (1.0 + certain * (chroma - 1.0));
        let across = COLOUR / (1.0 + ACROSS * c) * (1.0 + certain * (hue - 1.0));
        Self { look, axes: [[LIGHTNESS, 0.0, 0.0], [0.0, along * x, along * y], [0.0, -across * y, across * x]] }
    }

    /// A difference along the weighted axes.
    pub fn weighted(&self, difference: Oklab) -> [f32; 3] {
        self.axes.map(|axis| axis[0] * difference[0] + axis[1] * difference[1] + axis[2] * difference[2])
    }

    /// The weighted difference of a look from this.
    pub fn miss(&self, look: Oklab) -> [f32; 3] {
        self.weighted([0, 1, 2].map(|i| look[i] - self.look[i]))
    }
}

fn dot(a: &Bands, b: &Bands) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
