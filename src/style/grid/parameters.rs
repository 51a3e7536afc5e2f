//! The structure grid's parameters and their values.

use crate::source::MaskRole;
use crate::style::{Default, Kind, Need, Parameter, Settings};

/// Working pixels per pitch, as in the paper (`d = 6`).
const PIXELS_PER_PITCH: f64 = 6.0;
/// The same if dots stand closer in detail regions: four for each of their closer pitches.
const PIXELS_PER_PITCH_WITH_DETAIL: f64 = 7.0;

/// How many times closer rows stand in detail regions: sqrt(3), so that three times the dots stay in square cells.
pub(super) const DETAIL_CLOSENESS: f32 = 1.732_050_8;

/// Dots and hatching, not tiles.
const MIXED: Need = Need::Word("primitive", &["mixed"]);
/// From half a cell's diagonal on there are only dots.
const HAS_LINES: Need = Need::BelowPitches("size_max", std::f64::consts::FRAC_1_SQRT_2);
/// Lines are detected, not drawn by hand.
const FOUND: Need = Need::Without(MaskRole::Edges);
/// Maximum reach of the window in pitches. The work grows with its square: 17 pitches take 7 s on 100 x 100 mm, 170 would take minutes.
const WIDEST_WINDOW: f64 = 20.0;

/// All parameters of the style.
pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "pitch",
        kind: Kind::Length { default: Default::Millimetres(0.6), least: 0.05, most: 50.0 },
        meaning: "distance between neighbouring dots and between hatching lines",
        source: "Son 5.1, d",
        needs: &[],
    },
    Parameter {
        name: "size_max",
        kind: Kind::Length { default: Default::Pitches(0.5), least: 0.0, most: 50.0 },
        meaning: "largest dot radius; darker tones become lines. 0 hatches everywhere; from 0.71 pitches on there are only dots",
        source: "Son 6.3, s_max",
        needs: &[MIXED],
    },
    Parameter {
        name: "blend",
        kind: Kind::Number { default: 0.1, least: 0.001, most: 0.5 },
        meaning: "range of tone on either side of the size_max limit over which lines replace dots",
        source: "Son 6.3, without its sudden border",
        needs: &[MIXED, HAS_LINES, Need::Above("size_max", 0.0)],
    },
    Parameter {
        name: "hatching",
        kind: Kind::Choice(&["both", "along", "across"]),
        meaning: "hatching direction: along the features, across them, or both",
        source: "Son 6.2",
        needs: &[MIXED, HAS_LINES],
    },
    Parameter {
        name: "reversed_from",
        kind: Kind::Number { default: 0.88, least: 0.5, most: 1.0 },
        meaning: "ink from which dark regions are drawn black with a white hole in each mesh of the grid; 1 keeps lines and dots, which close up there",
        source: "",
        needs: &[MIXED, Need::Word("overlap", &["exact"])],
    },
    Parameter {
        name: "overlap",
        kind: Kind::Choice(&["exact", "paper"]),
        meaning: "dot size: exact matches the tone's ink in each dot's own cell; paper is the formula for a square cell, too light where dots overlap",
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
        meaning: "how far a dot takes the shape of the bent grid around it: 0 draws circles, 1 follows the grid's distances fully",
        source: "Son 6.4, w",
        needs: &[MIXED, Need::Zero("blob")],
    },
    Parameter {
        name: "primitive",
        kind: Kind::Choice(&["mixed", "tile", "tile-lines"]),
        meaning: "what is drawn: mixed is dots and hatching; tile is coloured tiles; tile-lines is tile outlines hatched by tone, for a pen",
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
        meaning: "width of the lines to detect: standard deviation across them",
        source: "Kang et al. 2007, sigma_c",
        needs: &[FOUND],
    },
    Parameter {
        name: "line_length",
        kind: Kind::Length { default: Default::Pitches(4.5 / 6.0), least: 0.01, most: 50.0 },
        meaning: "how far lines continue over gaps: standard deviation along them",
        source: "Kang et al. 2007, sigma_m",
        needs: &[FOUND],
    },
    Parameter {
        name: "line_contrast",
        kind: Kind::Number { default: 0.99, least: 0.5, most: 1.0 },
        meaning: "lower values find fewer lines, only those with more contrast",
        source: "Kang et al. 2007, rho",
        needs: &[FOUND],
    },
    Parameter {
        name: "line_threshold",
        kind: Kind::Number { default: 0.5, least: 0.01, most: 0.99 },
        meaning: "higher values find more and thicker lines",
        source: "Kang et al. 2007, tau",
        needs: &[FOUND],
    },
    Parameter {
        name: "line_rounds",
        kind: Kind::Count { default: 2, least: 1, most: 10 },
        meaning: "rounds of line detection; each builds on the lines found so far",
        source: "Kang et al. 2007: 2 to 3",
        needs: &[FOUND],
    },
    Parameter {
        name: "line_least",
        kind: Kind::Length { default: Default::Pitches(2.0), least: 0.0, most: 1000.0 },
        meaning: "lines shorter than this are not drawn; eyes need short lines",
        source: "Bruehl 2.1.1, threshold",
        needs: &[FOUND],
    },
    Parameter {
        name: "line_widest",
        kind: Kind::Length { default: Default::Pitches(0.45), least: 0.01, most: 50.0 },
        meaning: "maximum width of a drawn line",
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
        meaning: "minimum difference of lightness across a line that is drawn",
        source: "",
        needs: &[FOUND],
    },
    Parameter {
        name: "steer_contrast",
        kind: Kind::Number { default: 0.07, least: 0.0, most: 1.0 },
        meaning: "minimum difference of lightness across a line that steers the grid",
        source: "",
        needs: &[FOUND],
    },
    Parameter {
        name: "flow_reach",
        kind: Kind::Length { default: Default::Pitches(5.0 / 6.0), least: 0.0, most: 50.0 },
        meaning: "reach of the window in which edge directions are smoothed",
        source: "Kang et al. 2007, mu = 5 px",
        needs: &[FOUND, Need::Above("flow_rounds", 0.0)],
    },
    Parameter {
        name: "flow_rounds",
        kind: Kind::Count { default: 3, least: 0, most: 20 },
        meaning: "rounds of smoothing the edge directions",
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
        meaning: "number of lightness levels; their borders also steer the grid, to show round forms; 0 or 1 for none",
        source: "Son 4.1, 0 to 4 quantization levels",
        needs: &[Need::Without(MaskRole::Isophotes)],
    },
    Parameter {
        name: "isophote_weight",
        kind: Kind::Number { default: 0.5, least: 0.001, most: 100.0 },
        meaning: "weight of isophotes relative to nearby feature lines",
        source: "Son 4.1 counts both alike",
        needs: &[Need::AnyOf(&[&[Need::Above("isophotes", 1.0)], &[Need::With(MaskRole::Isophotes)]])],
    },
    Parameter {
        name: "field_detail",
        kind: Kind::Length { default: Default::Pitches(3.0), least: 0.1, most: 1000.0 },
        meaning: "finest cell of the feature field: smaller follows every line, larger gives a calmer flow",
        source: "Son 4.2; Lee et al. 1997",
        needs: &[],
    },
    Parameter {
        name: "field_calm",
        kind: Kind::Length { default: Default::Pitches(2.0), least: 0.0, most: 1000.0 },
        meaning: "length over which the field turns where lines disagree; 0 leaves abrupt borders there",
        source: "",
        needs: &[],
    },
    Parameter {
        name: "window",
        kind: Kind::Length { default: Default::Pitches(2.0), least: 0.1, most: 100.0 },
        meaning: "reach of the window in which the stripes are made regular; at most 20 pitches",
        source: "Son 5.2, r",
        needs: &[],
    },
    Parameter {
        name: "rounds",
        kind: Kind::Count { default: 5, least: 1, most: 200 },
        meaning: "rounds of making the stripes regular, on each lattice from coarse to fine",
        source: "Son 5.2, 3 to 8 iterations",
        needs: &[],
    },
    Parameter {
        name: "adaptive",
        kind: Kind::Number { default: 0.0, least: 0.0, most: 0.6 },
        meaning: "how much closer dots and lines stand in dark regions: 0 is even everywhere, 0.5 is half the pitch at full ink",
        source: "Son 5.2, scale factor of the window",
        needs: &[],
    },
    Parameter {
        name: "detail",
        kind: Kind::Choice(&["auto", "off"]),
        meaning: "dots and lines in detail regions (the detail mask, else the detected eyes, brows, noses and mouths): auto places them sqrt(3) times closer, so that there are three times as many dots; off leaves them as everywhere",
        source: "Son 5.2, scale factor of the window; Bruehl 4.3.2",
        needs: &[Need::With(MaskRole::Detail)],
    },
    Parameter {
        name: "feature_rows",
        kind: Kind::Choice(&["beside", "on", "free"]),
        meaning: "rows nearest to a feature line: beside keeps them half a pitch away, on puts one on the line, free leaves them where they fall",
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
pub(super) struct GridParameters {
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

impl GridParameters {
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

    /// The smallest spacing in the picture, in pitches.
    pub(super) fn narrowest(&self, is_given_detail: bool) -> f64 {
        let in_detail = if self.has_detail && is_given_detail { f64::from(DETAIL_CLOSENESS) } else { 1.0 };
        f64::from(1.0 - self.adaptive) / in_detail
    }

    /// True if this resolution is the one for detail regions.
    pub(super) fn is_for_detail(&self, pixels_per_mm: f64) -> bool {
        pixels_per_mm * self.pitch_mm > 0.5 * (PIXELS_PER_PITCH + PIXELS_PER_PITCH_WITH_DETAIL)
    }

    /// Working pixels per pitch.
    pub(super) const fn pixels_per_pitch(&self, is_given_detail: bool) -> f64 {
        if self.has_detail && is_given_detail { PIXELS_PER_PITCH_WITH_DETAIL } else { PIXELS_PER_PITCH }
    }
}
