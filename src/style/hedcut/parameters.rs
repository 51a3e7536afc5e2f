//! The hedcut's card, its parameters and their values.

use crate::geometry::Millimetres;
use crate::source::MaskRole;
use crate::style::declaration::{ON, choices, count, millimetres, number, parameters, pitches};
use crate::style::{Kind, Need, StyleCard};

/// What the style is.
pub(super) const CARD: StyleCard = StyleCard {
    name: "hedcut",
    summary: "dots in rows along the features, as in the portraits of the Wall Street Journal",
    source: "Bruehl 2023, A Parameterized Approach for Hedcut Rendering; Kim et al. 2008, 2010",
    parameters: PARAMETERS,
    masks: &[
        MaskRole::Subject,
        MaskRole::Detail,
        MaskRole::Hair,
        MaskRole::FacialHair,
        MaskRole::Clothing,
        MaskRole::Headwear,
        MaskRole::Edges,
        MaskRole::Isophotes,
        MaskRole::Directions,
    ],
    uses_depth: false,
    leaves_out_background: true,
};

/// Working pixels per pitch, as in the papers (`l = 6`).
const PIXELS_PER_PITCH: f64 = 6.0;
/// Minimum width in pixels of a lane in a detail region: with fewer, rows break up (errata).
const LEAST_LANE_PIXELS: f64 = 4.0;

/// Weights matter only if isophotes steer besides edges.
const BOTH_STEER: Need = Need::AnyOf(&[&[Need::Above("isophotes", 0.0)], &[Need::With(MaskRole::Isophotes)]]);

/// There is a part to be drawn in other marks than dots.
const HAS_PARTS: Need = Need::AnyOf(&[
    &[Need::With(MaskRole::Hair)],
    &[Need::With(MaskRole::FacialHair)],
    &[Need::With(MaskRole::Clothing)],
    &[Need::With(MaskRole::Headwear)],
]);

parameters! {
    /// The parameters of a hedcut; lengths in millimetres.
    pub(super) struct HedcutParameters {
        pitch: Millimetres = "pitch": millimetres(0.6, 0.1..=50.0),
            "distance between neighbouring dots; smaller gives finer detail and more dots",
            "Bruehl 3.2, l";
        size: SizeRule = "size": Kind::Choice(SizeRule::WORDS),
            "dot size: exact matches the tone's ink in each dot's own cell; paper is s_max (1 - T)^gamma",
            "Bruehl 3.4 and 4.4";
        size_max: Millimetres = "size_max": pitches(0.56, 0.01..=50.0),
            "with size=paper: radius of a dot at full ink",
            "Bruehl 3.4, s_max", needs [Need::Word("size", &["paper"])];
        size_gamma: f64 = "size_gamma": number(1.2, 0.1..=5.0),
            "with size=paper: exponent of 1 - tone",
            "Bruehl 3.4, gamma", needs [Need::Word("size", &["paper"])];
        reversed_from: f64 = "reversed_from": number(0.76, 0.5..=1.0),
            "with size=exact: ink from which dark regions are drawn black with white holes, as on scraperboard; 1 keeps dots everywhere, which close up there",
            "", needs [Need::Word("size", &["exact"])];
        lines: Lines = "lines": Kind::Choice(Lines::WORDS),
            "edge detector: coherent finds lines along the edge tangent flow and draws them at their own width; canny is Canny's detector",
            "Bruehl 2.1 and 4.3.1; Kang et al. 2007", needs [Need::Without(MaskRole::Edges)];
        // Wider lines take minutes: the filter is three times as long along a line as across.
        line_width: Millimetres = "line_width": pitches(0.2, 0.01..=10.0),
            "with lines=coherent: width of the lines to detect, standard deviation across them",
            "Kang et al. 2007, sigma_c", needs [Need::Word("lines", &["coherent"]), Need::Without(MaskRole::Edges)];
        line_contrast: f64 = "line_contrast": number(0.07, 0.0..=1.0),
            "with lines=coherent: minimum difference of lightness across a line",
            "", needs [Need::Word("lines", &["coherent"]), Need::Without(MaskRole::Edges)];
        edge_blur: Millimetres = "edge_blur": pitches(0.4, 0.0..=50.0),
            "with lines=canny: blur before edge detection; larger finds only the large forms",
            "Bruehl 2.1", needs [Need::Word("lines", &["canny"]), Need::Without(MaskRole::Edges)];
        edge_high: f64 = "edge_high": number(0.30, 0.0..=5.0),
            "with lines=canny: an edge must somewhere reach this change of lightness (0 to 1) per pitch",
            "Bruehl 2.1, maxVal", needs [Need::Word("lines", &["canny"]), Need::Without(MaskRole::Edges)];
        edge_low: f64 = "edge_low": number(0.12, 0.0..=5.0),
            "with lines=canny: an edge ends where the change per pitch falls below this",
            "Bruehl 2.1, minVal", needs [Need::Word("lines", &["canny"]), Need::Without(MaskRole::Edges)];
        edge_length: Millimetres = "edge_length": pitches(8.0, 0.0..=1000.0),
            "edges shorter than this do not steer the dots",
            "Bruehl 2.1.1, threshold", needs [Need::AnyOf(&[&[Need::Without(MaskRole::Edges)], &[Need::Without(MaskRole::Isophotes)]])];
        smoothing: Millimetres = "smoothing": pitches(1.0, 0.0..=50.0),
            "smoothing along edges and isophotes, so that rows flow",
            "Bruehl 4.3.1 asks for smooth lines";
        levels: u32 = "levels": count(8, 2..=64),
            "number of lightness levels; isophotes run between them",
            "Bruehl 2.2", needs [Need::AnyOf(&[ &[Need::Word("highlights", &["on"])], &[Need::Above("isophotes", 0.0), Need::Without(MaskRole::Isophotes)], ])];
        isophotes: u32 = "isophotes": count(3, 0..=63),
            "how many of the lightest levels are outlined by isophotes; 0 for none",
            "Bruehl 2.2, t", needs [Need::Without(MaskRole::Isophotes)];
        edge_weight: f32 = "edge_weight": number(1.0, 0.01..=100.0),
            "weight of edges relative to isophotes",
            "Bruehl 3.1.2, w_e", needs [BOTH_STEER];
        isophote_weight: f32 = "isophote_weight": number(2.0, 0.01..=100.0),
            "weight of isophotes relative to edges",
            "Bruehl 3.1.2, w_i", needs [BOTH_STEER];
        flow_reach: Millimetres = "flow_reach": pitches(100.0 / 6.0, 0.01..=10_000.0),
            "distance from a feature at which rows dissolve into an even scatter",
            "Kim et al. 2008, D_w = 100 px", needs [Need::Above("flow_rounds", 0.0)];
        plain_rounds: u32 = "plain_rounds": count(10, 0..=1000),
            "rounds of relaxation that only spread the dots",
            "Kim et al. 2008, t1";
        flow_rounds: u32 = "flow_rounds": count(30, 0..=1000),
            "further rounds, alternately pulling the dots into rows and spreading them",
            "Kim et al. 2008, t2";
        has_highlights: bool = "highlights": ON,
            "leave the lightest regions bare, with a fade",
            "Bruehl 4.3.2";
        highlight_steps: f64 = "highlight_steps": number(1.0, 0.0..=64.0),
            "how many of the lightest levels are left bare",
            "Bruehl 4.3.2", needs [Need::Word("highlights", &["on"])];
        highlight_fade: f64 = "highlight_fade": number(0.12, 0.0..=1.0),
            "range of lightness over which dots shrink and thin out towards a bare highlight",
            "Bruehl 4.4 asks for a fade", needs [Need::Word("highlights", &["on"])];
        has_outline: bool = "outline": ON,
            "draw the longest edges as swelling strokes",
            "Bruehl 4.3.2";
        outline_length: Millimetres = "outline_length": pitches(16.0, 0.0..=1000.0),
            "minimum length of a drawn line; rows also follow shorter ones",
            "Bruehl 4.3.2", needs [Need::Word("outline", &["on"])];
        outline_width: Millimetres = "outline_width": pitches(0.4, 0.01..=50.0),
            "width of an outline at its widest",
            "", needs [Need::Word("outline", &["on"])];
        detail: Detail = "detail": Kind::Choice(Detail::WORDS),
            "lanes in detail regions (the detail mask, else the detected eyes, brows, noses, mouths and pearls): auto and even make them sqrt(3) times as dense, so that three times the dots stay in square cells; thesis makes them three times as dense; off leaves them as everywhere",
            "Bruehl 4.3.2, corrected", needs [Need::With(MaskRole::Detail)];
        parts: PartsRule = "parts": Kind::Choice(PartsRule::WORDS),
            "what is drawn in dots: auto draws hair, beards and brows in flowing strokes and clothing and hats in hatches, where they were detected or their masks are given; dots draws everything in dots",
            "Bruehl 0.1.1", needs [HAS_PARTS];
        blob: f64 = "blob": number(0.0, 0.0..=1.0),
            "irregularity of the dots: 0 draws circles, 1 ragged ink blobs of the same area",
            "Bruehl 4.4";
    }
}

choices! {
    /// How dots get their size.
    pub(super) enum SizeRule { Exact = "exact", Paper = "paper" }
    /// What detects edges.
    pub(super) enum Lines { Coherent = "coherent", Canny = "canny" }
    /// How dense lanes are in detail regions.
    pub(super) enum Detail { Auto = "auto", Even = "even", Thesis = "thesis", Off = "off" }
    /// Which parts are drawn in marks of their own.
    pub(super) enum PartsRule { Auto = "auto", Dots = "dots" }
}

impl HedcutParameters {
    /// Lanes of a detail region in the place of one; none where detail is off.
    pub(super) fn detail_lanes(&self) -> Option<f64> {
        match self.detail {
            Detail::Off => None,
            Detail::Thesis => Some(3.0),
            Detail::Auto | Detail::Even => Some(3.0_f64.sqrt()),
        }
    }

    /// Working pixels per pitch: six as in the papers, more if detail lanes would be too narrow.
    pub(super) fn pixels_per_pitch(&self, has_detail: bool) -> f64 {
        let lanes = self.detail_lanes().filter(|_| has_detail).unwrap_or(1.0);
        if lanes > 1.0 { PIXELS_PER_PITCH.max(LEAST_LANE_PIXELS * lanes) } else { PIXELS_PER_PITCH }
    }
}
