//! What a picture of the sheet tells of the pens.

use thiserror::Error;

/// A colour measured on the sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Linear light in sRGB's primaries, relative to the paper: 1 is as light as paper.
    pub relative: [f64; 3],
    /// CIE L*a*b* (D65) of the ink on this paper.
    pub lab: [f64; 3],
    /// Difference of the patch's copies on the sheet, in Lab: the largest distance from their mean.
    pub spread: f64,
}

/// A step of a pen's ramp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RampStep {
    /// Coverage if lines were as wide as the nib, 0 to 1.
    pub nominal: f64,
    /// Coverage that explains its colour as a mixture of paper and the solid patch, 0 to 1 (Murray and Davies): more than nominal where
    /// ink spreads.
    pub effective: f64,
    /// Its mean colour, paper between the lines included.
    pub colour: Measured,
}

/// One pen.
#[derive(Clone, Debug, PartialEq)]
pub struct PenReading {
    /// The filled patch, without the hairlines of paper between strokes.
    pub solid: Measured,
    /// Share of the filled patch that has ink, 0 to 1; the rest are hairlines, so far as the picture resolves them.
    pub filled: f64,
    /// Paler steps, from light to dark.
    pub ramp: Vec<RampStep>,
}

/// Two pens, one over the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairReading {
    /// The pens, from 0; the first lies below.
    pub pens: [usize; 2],
    /// Their filled patches' overprint.
    pub colour: Measured,
}

/// A sheet, read.
#[derive(Clone, Debug, PartialEq)]
pub struct SheetReading {
    /// The pens in the sheet's order.
    pub pens: Vec<PenReading>,
    /// All pairs: (0, 1), (0, 2), ..., (1, 2), ...
    pub pairs: Vec<PairReading>,
    /// All pens over each other, if there are more than two.
    pub all: Option<Measured>,
    /// The paper's colour, linear: as given, or measured by the grey card, or 1 in each channel.
    pub paper: [f64; 3],
    /// How good the picture is.
    pub quality: Quality,
    /// What is doubtful.
    pub warnings: Vec<ReadWarning>,
}

/// Figures of a picture's quality.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Pixels per millimetre at the sheet's coarsest corner.
    pub pixels_per_mm: f64,
    /// Typical error of the marks' places, in millimetres.
    pub registration_mm: f64,
    /// Standard deviation of the blur of edges, in millimetres.
    pub blur_mm: f64,
    /// Share of the dots between the patches that were seen, 0 to 1.
    pub marks_seen: f64,
    /// Fall-off of light over the sheet, 0 to 1.
    pub fall_off: f64,
    /// Robust deviation of bare paper from smooth light, relative.
    pub residual: f64,
    /// Standard deviation of a pixel on paper, relative.
    pub noise: f64,
    /// sRGB level of the paper's brightest channel at its median, 0 to 255.
    pub paper_level: f64,
    /// Share of bare paper that is clipped, 0 to 1.
    pub clipped: f64,
    /// Cast of the light: the largest of the paper's channels over the least, relative to the paper's true colour; 1 for none.
    pub cast: f64,
    /// Contrast of the camera's curve that was undone, 0 for plain sRGB.
    pub contrast: f64,
}

/// What is doubtful about a reading, and what to do.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ReadWarning {
    /// Some paper is clipped.
    #[error("{:.1} % of the bare paper is clipped, which makes pens too dark; take the picture a step darker", 100.0 * share)]
    Clipped {
        /// Share of bare paper, 0 to 1.
        share: f64,
    },
    /// Light is not smooth.
    #[error("light on the sheet is uneven (bare paper differs by {:.1} % from smooth light); keep shadows and reflections off it", 100.0 * residual)]
    Uneven {
        /// Robust deviation, relative.
        residual: f64,
    },
    /// Pixels are noisy.
    #[error("the picture is noisy ({:.0} % of a pixel's light on paper), which falsifies dark inks; take it in more light", 100.0 * noise)]
    Noisy {
        /// Standard deviation of a pixel on paper, relative.
        noise: f64,
    },
    /// Edges are soft.
    #[error("the picture is soft (edges are blurred by {blur_mm:.2} mm); ramps may be read too even")]
    Soft {
        /// Standard deviation of the blur in millimetres.
        blur_mm: f64,
    },
    /// Paper is dark in the picture, so that noise and rounding count.
    #[error("paper has a level of only {level:.0} of 255; take the picture in more light or a step brighter")]
    Dark {
        /// sRGB level.
        level: f64,
    },
    /// Marks lie off.
    #[error("the sheet's marks lie {error_mm:.1} mm off a plane; lay the sheet flat, and check that the plotter is true to size")]
    Unflat {
        /// Typical error in millimetres.
        error_mm: f64,
    },
    /// The light is coloured.
    #[error(
        "the light is strongly coloured (by a factor of {cast:.1}); take the picture by daylight, or set the camera's white balance to the light"
    )]
    Cast {
        /// The largest of the paper's channels over the least.
        cast: f64,
    },
    /// A filled patch has bare paper in it.
    #[error("pen {} leaves {:.0} % of its filled patches bare: is its nib narrower than given, or the pen dry?", pen + 1, 100.0 * bare)]
    Bare {
        /// The pen, from 0.
        pen: usize,
        /// Share of bare paper, 0 to 1.
        bare: f64,
    },
    /// Copies of a patch differ.
    #[error("copies of pen {}'s patch differ by {spread:.1} (CIE Lab): was one damp, smudged, or in a reflection?", pen + 1)]
    Differs {
        /// The pen, from 0.
        pen: usize,
        /// Largest distance from the copies' mean, in Lab.
        spread: f64,
    },
    /// A pen's patch hardly differs from paper.
    #[error("pen {} hardly differs from the paper: is it empty, or missing from the drawing?", pen + 1)]
    Pale {
        /// The pen, from 0.
        pen: usize,
    },
    /// Two pens look alike.
    #[error("pens {} and {} look alike on this paper: one of them is enough", pens[0] + 1, pens[1] + 1)]
    Alike {
        /// The pens, from 0.
        pens: [usize; 2],
    },
    /// A channel has no light left.
    #[error("pen {} is more vivid than sRGB can hold, so that its colour is an estimate; a 16-bit picture in a wide colour space would tell more", pen + 1)]
    BeyondGamut {
        /// The pen, from 0.
        pen: usize,
    },
    /// Ramps are not what lines of the nib would make.
    #[error("the ramp of pen {} does not rise from step to step: did the pen run dry, or skip?", pen + 1)]
    Ramp {
        /// The pen, from 0.
        pen: usize,
    },
    /// Nothing was found in the field for a grey card.
    #[error(
        "a grey card was announced, but its field holds nothing even and unlike the paper, or not of this reflectance; the picture is read without it"
    )]
    NoCard,
}
