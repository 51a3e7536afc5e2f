//! The painting's card, its parameters and their values.

use crate::geometry::Millimetres;
use crate::source::MaskRole;
use crate::style::declaration::{Radians, choices, count, millimetres, number, parameters, pitches};
use crate::style::{Kind, Need, StyleCard};

/// What the style is.
pub(super) const CARD: StyleCard = StyleCard {
    name: "glass",
    summary: "brush strokes that follow contours and whirl where there are none, as in impressionist paintings",
    source: "Papari 2009, Texture vs contours, chapter 7; Papari and Petkov 2009, Continuous Glass Patterns for Painterly Rendering",
    parameters: PARAMETERS,
    masks: &[
        MaskRole::Subject,
        MaskRole::Detail,
        MaskRole::Hair,
        MaskRole::Clothing,
        MaskRole::FacialHair,
        MaskRole::Headwear,
        MaskRole::Directions,
    ],
    uses_depth: false,
    leaves_out_background: false,
};

/// Working resolution in millimetres per pixel at the default grain: 320 x 480 px are a sheet of 90 x 134 mm, so that the defaults in
/// millimetres match those of Table 7.1 in pixels.
const MM_PER_PIXEL: f64 = 0.28;
/// Grain below which the working resolution grows with it, in millimetres: Table 7.1's 0.7 px.
const DEFAULT_GRAIN_MM: f64 = 0.2;
/// Default grain in pitches.
const DEFAULT_GRAIN: f64 = 1.0 / 3.0;

/// Strokes, not points.
const CONTINUOUS: Need = Need::Word("pattern", &["continuous"]);
/// Painted, not drawn with one pen.
const COLOURED: Need = Need::Word("colors", &["photo"]);
/// The photograph's own flow.
const PHOTO_FLOW: Need = Need::Word("transform", &["photo"]);

parameters! {
    /// The parameters of a glass painting; lengths in millimetres.
    pub(super) struct GlassParameters {
        pitch: Millimetres = "pitch": millimetres(0.6, 0.1..=50.0),
            "approximate width of a stroke; most lengths below default to multiples of it. Also the distance between the points of a discrete pattern",
            "Table 7.1 at 0.28 mm per pixel";
        colours: Colours = "colors": Kind::Choice(Colours::WORDS),
            "photo paints opaque strokes in the photograph's colours; mono draws lines for one pen, as dense as the tone requires",
            "", needs [CONTINUOUS];
        pattern: Pattern = "pattern": Kind::Choice(Pattern::WORDS),
            "continuous paints strokes; discrete draws points, and where the flow moves them, as dots",
            "Papari 7.2";
        length: Millimetres = "length": pitches(25.0 / 3.0, 0.1..=200.0),
            "length of the strokes, at most the picture's diagonal",
            "Papari 7.10, a = 18 px", needs [Need::AnyOf(&[&[CONTINUOUS], &[Need::Word("transform", &["photo"])]])];
        grain: Millimetres = "grain": pitches(DEFAULT_GRAIN, 0.03..=20.0),
            "blur of the noise that the strokes grow from; a stroke is about three times as wide. By default a sheet of 100 by 100 mm has 10,000 to 25,000 strokes, depending on its detail, counting pieces and the fine strokes on top; half the grain about doubles them",
            "Papari 7.8, sigma_z = 0.7 px", needs [CONTINUOUS, COLOURED];
        whirls: Millimetres = "whirls": pitches(17.0 / 6.0, 0.1..=100.0),
            "blur of the picture whose gradient the strokes follow; larger gives smoother strokes and larger whirls",
            "Papari 7.9, sigma = 6 px", needs [PHOTO_FLOW];
        strokes: Strokes = "strokes": Kind::Choice(Strokes::WORDS),
            "fitted follows the form of faces, hair and clothing, finer along eyes and mouth and broader behind people; even treats all places alike",
            "", needs [Need::WithFace, PHOTO_FLOW];
        angle: Radians = "angle": number(90.0, -180.0..=180.0),
            "angle between the strokes and the gradient, in degrees: 90 follows contours and whirls, 0 crosses them in stars",
            "Papari 7.10, theta_0", needs [PHOTO_FLOW];
        gradient: Gradient = "gradient": Kind::Choice(Gradient::WORDS),
            "how the picture is blurred before its gradient is taken; diffusion keeps strokes from cutting corners but is slow",
            "Papari figure 7.14", needs [PHOTO_FLOW];
        smoothing: Millimetres = "smoothing": pitches(0.6, 0.0..=50.0),
            "reach of the smoothing that removes texture and sharpens edges; 0 for none",
            "Papari appendix A, sigma", needs [Need::AnyOf(&[&[CONTINUOUS, COLOURED], &[PHOTO_FLOW]])];
        sharpness: f32 = "sharpness": number(4.0, 0.0..=16.0),
            "how sharp the smoothing leaves edges: 0 blurs them, 16 makes them hard",
            "Papari appendix A, q", needs [Need::Above("smoothing", 0.0), Need::AnyOf(&[&[CONTINUOUS, COLOURED], &[PHOTO_FLOW]])];
        contrast: f32 = "contrast": number(0.3, 0.0..=1.0),
            "range of lightness from the darkest stroke to the lightest over one colour",
            "Papari 7.12, lambda", needs [CONTINUOUS, COLOURED];
        ribbons: u32 = "ribbons": count(3, 1..=16),
            "number of lightness steps in which each stroke is built up",
            "", needs [CONTINUOUS, COLOURED];
        taper: f64 = "taper": number(0.35, 0.0..=1.0),
            "share of a stroke that tapers to a tip; 0 leaves its end round",
            "", needs [CONTINUOUS];
        detail: f32 = "detail": number(0.08, 0.01..=2.0),
            "colour difference from which fine strokes are painted over the broad ones; 2 for none",
            "", needs [CONTINUOUS, COLOURED];
        hairs: f32 = "hairs": number(0.0, 0.0..=1.0),
            "strength of bristle marks on top of the strokes; 0 for none",
            "Papari figures 7.15 and 7.16", needs [CONTINUOUS, COLOURED];
        line: Millimetres = "line": millimetres(0.3, 0.05..=5.0),
            "with colors=mono: width of the lines, ideally that of the pen",
            "", needs [CONTINUOUS, Need::Word("colors", &["mono"])];
        transform: Transform = "transform": Kind::Choice(Transform::WORDS),
            "flow that the strokes follow, or that moves the points of a discrete pattern: photo is the photograph's own flow, the others are centred on the picture",
            "Papari figures 7.1 to 7.4";
        time: f64 = "time": number(0.087_266, -10.0..=10.0),
            "with pattern=discrete: how long the points move; in a rotation this is the angle in radians (0.0873 is 5 degrees)",
            "Papari 7.3, t", needs [Need::Word("pattern", &["discrete"])];
        points: Points = "points": Kind::Choice(Points::WORDS),
            "with pattern=discrete: blue spreads the points evenly; poisson places them independently at random",
            "Papari 7.2.1", needs [Need::Word("pattern", &["discrete"])];
    }
}

choices! {
    /// Whose colours the strokes have.
    pub(super) enum Colours { Photo = "photo", Mono = "mono" }
    /// Strokes or points.
    pub(super) enum Pattern { Continuous = "continuous", Discrete = "discrete" }
    /// Whether strokes look at what they paint.
    pub(super) enum Strokes { Fitted = "fitted", Even = "even" }
    /// How the photograph is smoothed before its gradient is taken.
    pub(super) enum Gradient { Gaussian = "gaussian", Diffusion = "diffusion" }
    /// The transform that the pattern is made of.
    pub(super) enum Transform {
        Photograph = "photo", Rotation = "rotation", Scaling = "scaling", Hyperbolic = "hyperbolic",
        Spiral = "spiral", Translation = "translation", Nonlinear = "nonlinear",
    }
    /// How points are scattered.
    pub(super) enum Points { Blue = "blue", Poisson = "poisson" }
}

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Manner {
    Painting,
    OnePen,
    Discrete,
}

impl GlassParameters {
    /// What is drawn: a painting, lines of one pen, or points.
    pub(super) fn manner(&self) -> Manner {
        match (self.pattern, self.colours) {
            (Pattern::Discrete, _) => Manner::Discrete,
            (_, Colours::Mono) => Manner::OnePen,
            _ => Manner::Painting,
        }
    }

    /// Working pixels per millimetre.
    pub(super) fn pixels_per_mm(&self) -> f64 {
        // Only a painting has grain; lines and points use the resolution of the default grain.
        let grain = if self.manner() == Manner::Painting { self.grain } else { self.pitch * DEFAULT_GRAIN };
        (DEFAULT_GRAIN_MM / grain.0).max(1.0) / MM_PER_PIXEL
    }
}
