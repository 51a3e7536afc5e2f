//! The structure grid's parameters and their values.

use crate::source::MaskRole;
use crate::style::{Default, Kind, Need, Parameter, Settings};

/// Working pixels a pitch, as in the paper (`d = 6`).
const PIXELS_PER_PITCH: f64 = 6.0;
/// The same with closer dots somewhere: four for each of these.
const PIXELS_PER_PITCH_WITH_DETAIL: f64 = 7.0;

/// How many times closer rows stand in detail regions, where three times the dots stay in square cells.
pub(super) const DETAIL_CLOSENESS: f32 = 1.732_050_8;

/// Dots and hatching, not tiles.
const MIXED: Need = Need::Word("primitive", &["mixed"]);
/// Beyond the half diagonal of a cell all are dots.
const HAS_LINES: Need = Need::BelowPitches("size_max", std::f64::consts::FRAC_1_SQRT_2);
/// Lines that are found, not drawn by hand.
const FOUND: Need = Need::Without(MaskRole::Edges);
/// Greatest reach of the window in pitches. The work grows with its square: 17 take 7 s on 100 x 100 mm, ten times as many would take
/// minutes.
const WIDEST_WINDOW: f64 = 20.0;

/// All that a user can set.
pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "pitch",
        kind: Kind::Length { default: Default::Millimetres(0.6), least: 0.05, most: 50.0 },
        meaning: "distance of neighbouring dots and of hatching lines",
        source: "Son 5.1, d",
        needs: &[],
    },
    Parameter {
        name: "size_max",
        kind: Kind::Length { default: Default::Pitches(0.5), least: 0.0, most: 50.0 },
        meaning: "dots that would be larger than this radius become lines; 0 hatches everywhere, from 0.71 pitches on all are dots",
        source: "Son 6.3, s_max",
        needs: &[MIXED],
    },
    Parameter {
        name: "blend",
        kind: Kind::Number { default: 0.1, least: 0.001, most: 0.5 },
        meaning: "tones on either side of that change over which lines swell while dots give way",
        source: "Son 6.3, without its sudden border",
        needs: &[MIXED, HAS_LINES, Need::Above("size_max", 0.0)],
    },
    Parameter {
        name: "hatching",
        kind: Kind::Choice(&["both", "along", "across"]),
        meaning: "the lines that hatch: along the features, across them, or both",
        source: "Son 6.2",
        needs: &[MIXED, HAS_LINES],
    },
    Parameter {
        name: "reversed_from",
        kind: Kind::Number { default: 0.88, least: 0.5, most: 1.0 },
        meaning: "ink from which dark regions are black with a white hole in each mesh of the grid; 1 leaves lines and dots, which close up there",
        source: "",
        needs: &[MIXED, Need::Word("overlap", &["exact"])],
    },
    Parameter {
        name: "overlap",
        kind: Kind::Choice(&["exact", "paper"]),
        meaning: "dot size: exact puts the tone's ink into each dot's own cell; paper is the square cell's formula, too light where dots overlap",
        source: "Son 6.1 and appendix B, corrected",
        needs: &[MIXED],
    },
    Parameter {
        name: "blob",
        kind: Kind::Number { default: 0.0, least: 0.0, most: 1.0 },
        meaning: "irregularity of the dots: 0 draws circles, 1 ragged ink blobs of the same area",
        source: "Son 6.1, figure 7",
        needs: &[MIXED],
    },
    Parameter {
        name: "dot_shape",
        kind: Kind::Number { default: 0.0, least: 0.0, most: 1.0 },
        meaning: "how far a dot takes the shape of the bent grid around it: 0 circles, 1 all of the grid's distances",
        source: "Son 6.4, w",
        needs: &[MIXED, Need::Zero("blob")],
    },
    Parameter {
        name: "primitive",
        kind: Kind::Choice(&["mixed", "tile", "tile-lines"]),
        meaning: "what is drawn: dots and hatching; coloured tiles; or tiles as outlines hatched by tone, for a pen",
        source: "Son 7.3",
        needs: &[],
    },
    Parameter {
        name: "tile_gap",
        kind: Kind::Length { default: Default::Pitches(0.12), least: 0.0, most: 50.0 },
        meaning: "space between neighbouring tiles",
        source: "Son 7.3, s",
        needs: &[Need::Word("primitive", &["tile", "tile-lines"])],
    },
    Parameter {
        name: "lines",
        kind: Kind::Choice(&["on", "off"]),
        meaning: "draw the feature lines on top",
        source: "Son 3",
        needs: &[],
    },
    Parameter {
        name: "line_width",
        kind: Kind::Length { default: Default::Pitches(1.2 / 6.0), least: 0.01, most: 50.0 },
        meaning: "how fine the lines are that are looked for: standard deviation across them",
        source: "Kang et al. 2007, sigma_c",
        needs: &[FOUND],
    },
    Parameter {
        name: "line_length",
        kind: Kind::Length { default: Default::Pitches(4.5 / 6.0), least: 0.01, most: 50.0 },
        meaning: "how far lines are carried over gaps: standard deviation along them",
        source: "Kang et al. 2007, sigma_m",
        needs: &[FOUND],
    },
    Parameter {
        name: "line_contrast",
        kind: Kind::Number { default: 0.99, least: 0.5, most: 1.0 },
        meaning: "lower finds fewer lines, only those with more contrast",
        source: "Kang et al. 2007, rho",
        needs: &[FOUND],
    },
    Parameter {
        name: "line_threshold",
        kind: Kind::Number { default: 0.5, least: 0.01, most: 0.99 },
        meaning: "higher makes lines thicker and finds more of them",
        source: "Kang et al. 2007, tau",
        needs: &[FOUND],
    },
    Parameter {
        name: "line_rounds",
        kind: Kind::Count { default: 2, least: 1, most: 10 },
        meaning: "how often lines are sought, each time helped by those found",
        source: "Kang et al. 2007: 2 to 3",
        needs: &[FOUND],
    },
    Parameter {
        name: "line_least",
        kind: Kind::Length { default: Default::Pitches(2.0), least: 0.0, most: 1000.0 },
        meaning: "lines shorter than this are not drawn; eyes need short ones",
        source: "Bruehl 2.1.1, threshold",
        needs: &[FOUND],
    },
    Parameter {
        name: "line_widest",
        kind: Kind::Length { default: Default::Pitches(0.45), least: 0.01, most: 50.0 },
        meaning: "width beyond which lines are not drawn any wider",
        source: "",
        needs: &[FOUND, Need::Word("lines", &["on"])],
    },
    Parameter {
        name: "steer_least",
        kind: Kind::Length { default: Default::Pitches(5.0), least: 0.0, most: 1000.0 },
        meaning: "lines and isophotes shorter than this do not steer the grid",
        source: "Bruehl 2.1.1, threshold",
        needs: &[],
    },
    Parameter {
        name: "draw_contrast",
        kind: Kind::Number { default: 0.05, least: 0.0, most: 1.0 },
        meaning: "difference of lightness across a line below which it is not drawn",
        source: "",
        needs: &[FOUND],
    },
    Parameter {
        name: "steer_contrast",
        kind: Kind::Number { default: 0.07, least: 0.0, most: 1.0 },
        meaning: "difference of lightness across a line below which it does not steer the grid",
        source: "",
        needs: &[FOUND],
    },
    Parameter {
        name: "flow_reach",
        kind: Kind::Length { default: Default::Pitches(5.0 / 6.0), least: 0.0, most: 50.0 },
        meaning: "window in which directions of edges are smoothed",
        source: "Kang et al. 2007, mu = 5 px",
        needs: &[FOUND, Need::Above("flow_rounds", 0.0)],
    },
    Parameter {
        name: "flow_rounds",
        kind: Kind::Count { default: 3, least: 0, most: 20 },
        meaning: "rounds of that smoothing",
        source: "Kang et al. 2007: 2 to 3",
        needs: &[FOUND],
    },
    Parameter {
        name: "smoothing",
        kind: Kind::Length { default: Default::Pitches(1.0), least: 0.0, most: 50.0 },
        meaning: "smoothing along feature lines and isophotes",
        source: "",
        needs: &[],
    },
    Parameter {
        name: "isophotes",
        kind: Kind::Count { default: 3, least: 0, most: 16 },
        meaning: "levels of lightness whose borders steer the grid too, to show round forms; 0 or 1 for none",
        source: "Son 4.1, 0 to 4 quantization levels",
        needs: &[Need::Without(MaskRole::Isophotes)],
    },
    Parameter {
        name: "isophote_weight",
        kind: Kind::Number { default: 0.5, least: 0.001, most: 100.0 },
        meaning: "how much isophotes count where feature lines run close by",
        source: "Son 4.1 counts both alike",
        needs: &[Need::AnyOf(&[&[Need::Above("isophotes", 1.0)], &[Need::With(MaskRole::Isophotes)]])],
    },
    Parameter {
        name: "field_detail",
        kind: Kind::Length { default: Default::Pitches(3.0), least: 0.1, most: 1000.0 },
        meaning: "finest cell of the feature field: smaller follows every line, larger flows more calmly",
        source: "Son 4.2; Lee et al. 1997",
        needs: &[],
    },
    Parameter {
        name: "field_calm",
        kind: Kind::Length { default: Default::Pitches(2.0), least: 0.0, most: 1000.0 },
        meaning: "length over which the field turns where lines disagree; 0 leaves walls there",
        source: "",
        needs: &[],
    },
    Parameter {
        name: "window",
        kind: Kind::Length { default: Default::Pitches(2.0), least: 0.1, most: 100.0 },
        meaning: "reach of the window in which stripes are made regular; at most 20 pitches",
        source: "Son 5.2, r",
        needs: &[],
    },
    Parameter {
        name: "rounds",
        kind: Kind::Count { default: 5, least: 1, most: 200 },
        meaning: "rounds of that, on each of the lattices from coarse to fine",
        source: "Son 5.2, 3 to 8 iterations",
        needs: &[],
    },
    Parameter {
        name: "adaptive",
        kind: Kind::Number { default: 0.0, least: 0.0, most: 0.6 },
        meaning: "how much closer dots and lines stand where it is dark: 0 even everywhere, 0.5 half the pitch at full ink",
        source: "Son 5.2, scale factor of the window",
        needs: &[],
    },
    Parameter {
        name: "detail",
        kind: Kind::Choice(&["auto", "off"]),
        meaning: "dots and lines in detail regions, which are those of a mask detail, else the eyes, brows, noses and mouths that are found: auto sets them sqrt(3) as close, so that there are three times as many; off as everywhere",
        source: "Son 5.2, scale factor of the window; Bruehl 4.3.2",
        needs: &[Need::With(MaskRole::Detail)],
    },
    Parameter {
        name: "feature_rows",
        kind: Kind::Choice(&["beside", "on", "free"]),
        meaning: "the rows nearest to a feature line run half a pitch beside it, or on it, or where they fall",
        source: "Son 5.2 begins on it",
        needs: &[],
    },
];

/// The lines that hatch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Hatching {
    Both,
    Along,
    Across,
}

/// How dots get their size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Overlap {
    Exact,
    Paper,
}

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Primitive {
    Mixed,
    Tile,
    TileLines,
}

/// Where the rows nearest to a feature line run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FeatureRows {
    Beside,
    On,
    Free,
}

/// The parameters' values; lengths in millimetres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gridding {
    pub pitch_mm: f64,
    pub size_max_mm: f64,
    pub blend: f64,
    pub hatching: Hatching,
    pub reversed_from: f64,
    pub overlap: Overlap,
    pub blob: f64,
    pub dot_shape: f64,
    pub primitive: Primitive,
    pub tile_gap_mm: f64,
    pub has_lines: bool,
    pub line_width_mm: f64,
    pub line_length_mm: f64,
    pub line_contrast: f64,
    pub line_threshold: f64,
    pub line_rounds: u32,
    pub line_least_mm: f64,
    pub line_widest_mm: f64,
    pub steer_least_mm: f64,
    pub draw_contrast: f64,
    pub steer_contrast: f64,
    pub field_calm_mm: f64,
    pub flow_reach_mm: f64,
    pub flow_rounds: u32,
    pub smoothing_mm: f64,
    pub isophotes: u32,
    pub isophote_weight: f32,
    pub field_detail_mm: f64,
    pub window_mm: f64,
    pub rounds: u32,
    pub adaptive: f32,
    pub has_detail: bool,
    pub feature_rows: FeatureRows,
}

impl Gridding {
    pub(super) fn new(settings: &Settings) -> Self {
        let count = |name| settings.number(name) as u32;
        Self {
            pitch_mm: settings.number("pitch"),
            size_max_mm: settings.number("size_max"),
            blend: settings.number("blend"),
            hatching: match settings.word("hatching") {
                "along" => Hatching::Along,
                "across" => Hatching::Across,
                _ => Hatching::Both,
            },
            reversed_from: settings.number("reversed_from"),
            overlap: if settings.word("overlap") == "exact" { Overlap::Exact } else { Overlap::Paper },
            blob: settings.number("blob"),
            dot_shape: settings.number("dot_shape"),
            primitive: match settings.word("primitive") {
                "tile" => Primitive::Tile,
                "tile-lines" => Primitive::TileLines,
                _ => Primitive::Mixed,
            },
            tile_gap_mm: settings.number("tile_gap"),
            has_lines: settings.word("lines") == "on",
            line_width_mm: settings.number("line_width"),
            line_length_mm: settings.number("line_length"),
            line_contrast: settings.number("line_contrast"),
            line_threshold: settings.number("line_threshold"),
            line_rounds: count("line_rounds"),
            line_least_mm: settings.number("line_least"),
            line_widest_mm: settings.number("line_widest"),
            steer_least_mm: settings.number("steer_least"),
            draw_contrast: settings.number("draw_contrast"),
            steer_contrast: settings.number("steer_contrast"),
            field_calm_mm: settings.number("field_calm"),
            flow_reach_mm: settings.number("flow_reach"),
            flow_rounds: count("flow_rounds"),
            smoothing_mm: settings.number("smoothing"),
            isophotes: count("isophotes"),
            isophote_weight: settings.number("isophote_weight") as f32,
            field_detail_mm: settings.number("field_detail"),
            window_mm: settings.number("window").min(WIDEST_WINDOW * settings.number("pitch")),
            rounds: count("rounds"),
            adaptive: settings.number("adaptive") as f32,
            has_detail: settings.word("detail") == "auto",
            feature_rows: match settings.word("feature_rows") {
                "on" => FeatureRows::On,
                "free" => FeatureRows::Free,
                _ => FeatureRows::Beside,
            },
        }
    }

    /// The least spacing anywhere, in pitches.
    pub(super) fn narrowest(&self, is_given_detail: bool) -> f64 {
        let in_detail = if self.has_detail && is_given_detail { f64::from(DETAIL_CLOSENESS) } else { 1.0 };
        f64::from(1.0 - self.adaptive) / in_detail
    }

    /// Whether a picture has this resolution for the sake of its detail regions.
    pub(super) fn is_for_detail(&self, pixels_per_mm: f64) -> bool {
        pixels_per_mm * self.pitch_mm > 0.5 * (PIXELS_PER_PITCH + PIXELS_PER_PITCH_WITH_DETAIL)
    }

    /// Working pixels a pitch.
    pub(super) const fn pixels_per_pitch(&self, is_given_detail: bool) -> f64 {
        if self.has_detail && is_given_detail { PIXELS_PER_PITCH_WITH_DETAIL } else { PIXELS_PER_PITCH }
    }
}
