//! The structure grid's card, its parameters and their values.

use crate::geometry::Millimetres;
use crate::source::MaskRole;
use crate::style::declaration::{ON, choices, count, millimetres, number, parameters, pitches};
use crate::style::{Kind, Need, StyleCard};

/// What the style is.
pub(super) const CARD: StyleCard = StyleCard {
    name: "grid",
    summary: "dots lined up along and across the features, turning into hatching where it is dark",
    source: "Son, Lee, Kang and Lee 2011, Structure grid for directional stippling; Kang, Lee and Chui 2007",
    parameters: PARAMETERS,
    masks: &[MaskRole::Subject, MaskRole::Detail, MaskRole::Edges, MaskRole::Isophotes, MaskRole::Directions],
    uses_depth: false,
    leaves_out_background: true,
};

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

parameters! {
    /// The parameters of a structure grid; lengths in millimetres.
    pub(super) struct GridParameters {
        pitch: Millimetres = "pitch": millimetres(0.6, 0.1..=50.0),
            "distance between neighbouring dots and between hatching lines",
            "Son 5.1, d";
        size_max: Millimetres = "size_max": pitches(0.5, 0.0..=50.0),
            "largest dot radius; darker tones become lines. 0 hatches everywhere; from 0.71 pitches on there are only dots",
            "Son 6.3, s_max", needs [MIXED];
        blend: f64 = "blend": number(0.1, 0.001..=0.5),
            "range of tone on either side of the size_max limit over which lines replace dots",
            "Son 6.3, without its sudden border", needs [MIXED, HAS_LINES, Need::Above("size_max", 0.0)];
        hatching: Hatching = "hatching": Kind::Choice(Hatching::WORDS),
            "hatching direction: along the features, across them, or both",
            "Son 6.2", needs [MIXED, HAS_LINES];
        reversed_from: f64 = "reversed_from": number(0.88, 0.5..=1.0),
            "ink from which dark regions are drawn black with a white hole in each mesh of the grid; 1 keeps lines and dots, which close up there",
            "", needs [MIXED, Need::Word("overlap", &["exact"])];
        overlap: Overlap = "overlap": Kind::Choice(Overlap::WORDS),
            "dot size: exact matches the tone's ink in each dot's own cell; paper is the formula for a square cell, too light where dots overlap",
            "Son 6.1 and appendix B, corrected", needs [MIXED];
        blob: f64 = "blob": number(0.0, 0.0..=1.0),
            "irregularity of the dots: 0 draws circles, 1 ragged ink blobs of the same area",
            "Son 6.1, figure 7", needs [MIXED];
        dot_shape: f64 = "dot_shape": number(0.0, 0.0..=1.0),
            "how far a dot takes the shape of the bent grid around it: 0 draws circles, 1 follows the grid's distances fully",
            "Son 6.4, w", needs [MIXED, Need::Zero("blob")];
        primitive: Primitive = "primitive": Kind::Choice(Primitive::WORDS),
            "what is drawn: mixed is dots and hatching; tile is coloured tiles; tile-lines is tile outlines hatched by tone, for a pen",
            "Son 7.3";
        tile_gap: Millimetres = "tile_gap": pitches(0.12, 0.0..=50.0),
            "space between neighbouring tiles",
            "Son 7.3, s", needs [Need::Word("primitive", &["tile", "tile-lines"])];
        has_lines: bool = "lines": ON,
            "draw the feature lines on top, and pupils, lashes and nostrils of detected faces solid",
            "Son 3";
        line_width: Millimetres = "line_width": pitches(1.2 / 6.0, 0.01..=50.0),
            "width of the lines to detect: standard deviation across them",
            "Kang et al. 2007, sigma_c", needs [FOUND];
        line_length: Millimetres = "line_length": pitches(4.5 / 6.0, 0.01..=50.0),
            "how far lines continue over gaps: standard deviation along them",
            "Kang et al. 2007, sigma_m", needs [FOUND];
        line_contrast: f64 = "line_contrast": number(0.99, 0.5..=1.0),
            "lower values find fewer lines, only those with more contrast",
            "Kang et al. 2007, rho", needs [FOUND];
        line_threshold: f64 = "line_threshold": number(0.5, 0.01..=0.99),
            "higher values find more and thicker lines",
            "Kang et al. 2007, tau", needs [FOUND];
        line_rounds: u32 = "line_rounds": count(2, 1..=10),
            "rounds of line detection; each builds on the lines found so far",
            "Kang et al. 2007: 2 to 3", needs [FOUND];
        line_least: Millimetres = "line_least": pitches(2.0, 0.0..=1000.0),
            "lines shorter than this are not drawn; eyes need short lines",
            "Bruehl 2.1.1, threshold", needs [FOUND];
        line_widest: Millimetres = "line_widest": pitches(0.45, 0.01..=50.0),
            "maximum width of a drawn line",
            "", needs [FOUND, Need::Word("lines", &["on"])];
        steer_least: Millimetres = "steer_least": pitches(5.0, 0.0..=1000.0),
            "lines and isophotes shorter than this do not steer the grid",
            "Bruehl 2.1.1, threshold";
        draw_contrast: f64 = "draw_contrast": number(0.05, 0.0..=1.0),
            "minimum difference of lightness across a line that is drawn",
            "", needs [FOUND];
        steer_contrast: f64 = "steer_contrast": number(0.07, 0.0..=1.0),
            "minimum difference of lightness across a line that steers the grid",
            "", needs [FOUND];
        flow_reach: Millimetres = "flow_reach": pitches(5.0 / 6.0, 0.0..=50.0),
            "reach of the window in which edge directions are smoothed",
            "Kang et al. 2007, mu = 5 px", needs [FOUND, Need::Above("flow_rounds", 0.0)];
        flow_rounds: u32 = "flow_rounds": count(3, 0..=20),
            "rounds of smoothing the edge directions",
            "Kang et al. 2007: 2 to 3", needs [FOUND];
        smoothing: Millimetres = "smoothing": pitches(1.0, 0.0..=50.0),
            "smoothing along feature lines and isophotes",
            "";
        isophotes: u32 = "isophotes": count(3, 0..=16),
            "number of lightness levels; their borders also steer the grid, to show round forms; 0 or 1 for none",
            "Son 4.1, 0 to 4 quantization levels", needs [Need::Without(MaskRole::Isophotes)];
        isophote_weight: f32 = "isophote_weight": number(0.5, 0.001..=100.0),
            "weight of isophotes relative to nearby feature lines",
            "Son 4.1 counts both alike", needs [Need::AnyOf(&[&[Need::Above("isophotes", 1.0)], &[Need::With(MaskRole::Isophotes)]])];
        field_detail: Millimetres = "field_detail": pitches(3.0, 0.1..=1000.0),
            "finest cell of the feature field: smaller follows every line, larger gives a calmer flow",
            "Son 4.2; Lee et al. 1997";
        field_calm: Millimetres = "field_calm": pitches(2.0, 0.0..=1000.0),
            "length over which the field turns where lines disagree; 0 leaves abrupt borders there",
            "";
        field_beside: Millimetres = "field_beside": pitches(0.0, 0.0..=1000.0),
            "distance from feature lines within which the field is calmed less, so that rows run along them; 0 calms it everywhere alike",
            "", needs [Need::Above("field_calm", 0.0)];
        window: Millimetres = "window": pitches(2.0, 0.1..=100.0),
            "reach of the window in which the stripes are made regular; at most 20 pitches",
            "Son 5.2, r";
        rounds: u32 = "rounds": count(5, 1..=200),
            "rounds of making the stripes regular, on each lattice from coarse to fine",
            "Son 5.2, 3 to 8 iterations";
        adaptive: f32 = "adaptive": number(0.0, 0.0..=0.6),
            "how much closer dots and lines stand in dark regions: 0 is even everywhere, 0.5 is half the pitch at full ink",
            "Son 5.2, scale factor of the window";
        detail: Detail = "detail": Kind::Choice(Detail::WORDS),
            "dots and lines in detail regions (the detail mask, else the detected eyes, brows, noses, mouths and pearls): auto places them sqrt(3) times closer, so that there are three times as many dots; off leaves them as everywhere",
            "Son 5.2, scale factor of the window; Bruehl 4.3.2", needs [Need::With(MaskRole::Detail)];
        feature_rows: FeatureRows = "feature_rows": Kind::Choice(FeatureRows::WORDS),
            "rows nearest to a feature line: beside keeps them half a pitch away, on puts one on the line, free leaves them where they fall",
            "Son 5.2 begins on it";
    }
    adjusted by with_bounded_window
}

choices! {
    /// Which hatching is drawn.
    pub(super) enum Hatching { Both = "both", Along = "along", Across = "across" }
    /// How dots get their size.
    pub(super) enum Overlap { Exact = "exact", Paper = "paper" }
    /// What is drawn.
    pub(super) enum Primitive { Mixed = "mixed", Tile = "tile", TileLines = "tile-lines" }
    /// Whether rows stand closer in detail regions.
    pub(super) enum Detail { Auto = "auto", Off = "off" }
    /// Where the rows nearest to a feature line run.
    pub(super) enum FeatureRows { Beside = "beside", On = "on", Free = "free" }
}

impl GridParameters {
    /// Keeps the window within its reach in pitches.
    fn with_bounded_window(self) -> Self {
        Self { window: self.window.min(WIDEST_WINDOW * self.pitch), ..self }
    }

    /// The smallest spacing in the picture, in pitches.
    pub(super) fn narrowest(&self, is_given_detail: bool) -> f64 {
        let in_detail = if self.detail == Detail::Auto && is_given_detail { f64::from(DETAIL_CLOSENESS) } else { 1.0 };
        f64::from(1.0 - self.adaptive) / in_detail
    }

    /// True if this resolution is the one for detail regions.
    pub(super) fn is_for_detail(&self, pixels_per_mm: f64) -> bool {
        pixels_per_mm * self.pitch.0 > 0.5 * (PIXELS_PER_PITCH + PIXELS_PER_PITCH_WITH_DETAIL)
    }

    /// Working pixels per pitch.
    pub(super) fn pixels_per_pitch(&self, is_given_detail: bool) -> f64 {
        if self.detail == Detail::Auto && is_given_detail { PIXELS_PER_PITCH_WITH_DETAIL } else { PIXELS_PER_PITCH }
    }
}
