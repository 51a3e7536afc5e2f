//! The painting's parameters and their values.

use crate::style::{Default, Kind, Need, Parameter, Settings};

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

/// All parameters of the style.
pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "pitch",
        kind: Kind::Length { default: Default::Millimetres(0.6), least: 0.1, most: 50.0 },
        meaning: "approximate width of a stroke; most lengths below default to multiples of it. Also the distance between the points of a discrete pattern",
        source: "Table 7.1 at 0.28 mm per pixel",
        needs: &[],
    },
    Parameter {
        name: "colors",
        kind: Kind::Choice(&["photo", "mono"]),
        meaning: "photo paints opaque strokes in the photograph's colours; mono draws lines for one pen, as dense as the tone requires",
        source: "",
        needs: &[CONTINUOUS],
    },
    Parameter {
        name: "pattern",
        kind: Kind::Choice(&["continuous", "discrete"]),
        meaning: "continuous paints strokes; discrete draws points, and where the flow moves them, as dots",
        source: "Papari 7.2",
        needs: &[],
    },
    Parameter {
        name: "length",
        kind: Kind::Length { default: Default::Pitches(25.0 / 3.0), least: 0.1, most: 200.0 },
        meaning: "length of the strokes, at most the picture's diagonal",
        source: "Papari 7.10, a = 18 px",
        needs: &[Need::AnyOf(&[&[CONTINUOUS], &[Need::Word("transform", &["photo"])]])],
    },
    Parameter {
        name: "grain",
        kind: Kind::Length { default: Default::Pitches(DEFAULT_GRAIN), least: 0.03, most: 20.0 },
        meaning: "blur of the noise that the strokes grow from; a stroke is about three times as wide. By default a sheet of 100 by 100 mm has 10,000 to 25,000 strokes, depending on its detail, counting pieces and the fine strokes on top; half the grain about doubles them",
        source: "Papari 7.8, sigma_z = 0.7 px",
        needs: &[CONTINUOUS, COLOURED],
    },
    Parameter {
        name: "whirls",
        kind: Kind::Length { default: Default::Pitches(17.0 / 6.0), least: 0.1, most: 100.0 },
        meaning: "blur of the picture whose gradient the strokes follow; larger gives smoother strokes and larger whirls",
        source: "Papari 7.9, sigma = 6 px",
        needs: &[PHOTO_FLOW],
    },
    Parameter {
        name: "angle",
        kind: Kind::Number { default: 90.0, least: -180.0, most: 180.0 },
        meaning: "angle between the strokes and the gradient, in degrees: 90 follows contours and whirls, 0 crosses them in stars",
        source: "Papari 7.10, theta_0",
        needs: &[PHOTO_FLOW],
    },
    Parameter {
        name: "gradient",
        kind: Kind::Choice(&["gaussian", "diffusion"]),
        meaning: "how the picture is blurred before its gradient is taken; diffusion keeps strokes from cutting corners but is slow",
        source: "Papari figure 7.14",
        needs: &[PHOTO_FLOW],
    },
    Parameter {
        name: "smoothing",
        kind: Kind::Length { default: Default::Pitches(0.6), least: 0.0, most: 50.0 },
        meaning: "reach of the smoothing that removes texture and sharpens edges; 0 for none",
        source: "Papari appendix A, sigma",
        needs: &[Need::AnyOf(&[&[CONTINUOUS, COLOURED], &[PHOTO_FLOW]])],
    },
    Parameter {
        name: "sharpness",
        kind: Kind::Number { default: 4.0, least: 0.0, most: 16.0 },
        meaning: "how sharp the smoothing leaves edges: 0 blurs them, 16 makes them hard",
        source: "Papari appendix A, q",
        needs: &[Need::Above("smoothing", 0.0), Need::AnyOf(&[&[CONTINUOUS, COLOURED], &[PHOTO_FLOW]])],
    },
    Parameter {
        name: "contrast",
        kind: Kind::Number { default: 0.3, least: 0.0, most: 1.0 },
        meaning: "range of lightness from the darkest stroke to the lightest over one colour",
        source: "Papari 7.12, lambda",
        needs: &[CONTINUOUS, COLOURED],
    },
    Parameter {
        name: "ribbons",
        kind: Kind::Count { default: 3, least: 1, most: 16 },
        meaning: "number of lightness steps in which each stroke is built up",
        source: "",
        needs: &[CONTINUOUS, COLOURED],
    },
    Parameter {
        name: "taper",
        kind: Kind::Number { default: 0.35, least: 0.0, most: 1.0 },
        meaning: "share of a stroke that tapers to a tip; 0 leaves its end round",
        source: "",
        needs: &[CONTINUOUS],
    },
    Parameter {
        name: "detail",
        kind: Kind::Number { default: 0.08, least: 0.01, most: 2.0 },
        meaning: "colour difference from which fine strokes are painted over the broad ones; 2 for none",
        source: "",
        needs: &[CONTINUOUS, COLOURED],
    },
    Parameter {
        name: "hairs",
        kind: Kind::Number { default: 0.0, least: 0.0, most: 1.0 },
        meaning: "strength of bristle marks on top of the strokes; 0 for none",
        source: "Papari figures 7.15 and 7.16",
        needs: &[CONTINUOUS, COLOURED],
    },
    Parameter {
        name: "line",
        kind: Kind::Length { default: Default::Millimetres(0.3), least: 0.05, most: 5.0 },
        meaning: "with colors=mono: width of the lines, ideally that of the pen",
        source: "",
        needs: &[CONTINUOUS, Need::Word("colors", &["mono"])],
    },
    Parameter {
        name: "transform",
        kind: Kind::Choice(&["photo", "rotation", "scaling", "hyperbolic", "spiral", "translation", "nonlinear"]),
        meaning: "flow that the strokes follow, or that moves the points of a discrete pattern: photo is the photograph's own flow, the others are centred on the picture",
        source: "Papari figures 7.1 to 7.4",
        needs: &[],
    },
    Parameter {
        name: "time",
        kind: Kind::Number { default: 0.087_266, least: -10.0, most: 10.0 },
        meaning: "with pattern=discrete: how long the points move; in a rotation this is the angle in radians (0.0873 is 5 degrees)",
        source: "Papari 7.3, t",
        needs: &[Need::Word("pattern", &["discrete"])],
    },
    Parameter {
        name: "points",
        kind: Kind::Choice(&["blue", "poisson"]),
        meaning: "with pattern=discrete: blue spreads the points evenly; poisson places them independently at random",
        source: "Papari 7.2.1",
        needs: &[Need::Word("pattern", &["discrete"])],
    },
];

/// The flow that strokes follow and that moves points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Transform {
    Photograph,
    Rotation,
    Scaling,
    Hyperbolic,
    Spiral,
    Translation,
    Nonlinear,
}

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Manner {
    GlassParameters,
    OnePen,
    Discrete,
}

/// The parameters' values; lengths in millimetres.
#[derive(Clone, Copy, Debug)]
pub(super) struct GlassParameters {
    pub manner: Manner,
    pub pitch_mm: f64,
    pub length_mm: f64,
    pub grain_mm: f64,
    pub whirls_mm: f64,
    /// Radians.
    pub angle: f64,
    pub diffuses: bool,
    pub smoothing_mm: f64,
    pub sharpness: f32,
    pub contrast: f32,
    pub ribbons: usize,
    pub taper: f64,
    pub detail: f32,
    pub hairs: f32,
    pub line_mm: f64,
    pub transform: Transform,
    pub time: f64,
    pub is_blue: bool,
}

impl GlassParameters {
    pub(super) fn new(settings: &Settings) -> Self {
        Self {
            manner: match (settings.word("pattern"), settings.word("colors")) {
                ("discrete", _) => Manner::Discrete,
                (_, "mono") => Manner::OnePen,
                _ => Manner::GlassParameters,
            },
            pitch_mm: settings.number("pitch"),
            length_mm: settings.number("length"),
            grain_mm: settings.number("grain"),
            whirls_mm: settings.number("whirls"),
            angle: settings.number("angle").to_radians(),
            diffuses: settings.word("gradient") == "diffusion",
            smoothing_mm: settings.number("smoothing"),
            sharpness: settings.number("sharpness") as f32,
            contrast: settings.number("contrast") as f32,
            ribbons: settings.number("ribbons") as usize,
            taper: settings.number("taper"),
            detail: settings.number("detail") as f32,
            hairs: settings.number("hairs") as f32,
            line_mm: settings.number("line"),
            transform: match settings.word("transform") {
                "rotation" => Transform::Rotation,
                "scaling" => Transform::Scaling,
                "hyperbolic" => Transform::Hyperbolic,
                "spiral" => Transform::Spiral,
                "translation" => Transform::Translation,
                "nonlinear" => Transform::Nonlinear,
                _ => Transform::Photograph,
            },
            time: settings.number("time"),
            is_blue: settings.word("points") == "blue",
        }
    }

    /// Working pixels per millimetre.
    pub(super) fn pixels_per_mm(&self) -> f64 {
        // Only a painting has grain; lines and points use the resolution of the default grain.
        let grain = if self.manner == Manner::GlassParameters { self.grain_mm } else { self.pitch_mm * DEFAULT_GRAIN };
        (DEFAULT_GRAIN_MM / grain).max(1.0) / MM_PER_PIXEL
    }
}
