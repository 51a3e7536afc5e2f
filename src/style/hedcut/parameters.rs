//! The hedcut's parameters and their values.

use crate::source::MaskRole;
use crate::style::{Default, Kind, Need, Parameter, Settings};

/// Working pixels per pitch, as in the papers (`l = 6`).
const PIXELS_PER_PITCH: f64 = 6.0;
/// Minimum width in pixels of a lane in a detail region: with fewer, rows break up (errata).
const LEAST_LANE_PIXELS: f64 = 4.0;

/// Weights matter only if isophotes steer besides edges.
const BOTH_STEER: Need = Need::AnyOf(&[&[Need::Above("isophotes", 0.0)], &[Need::With(MaskRole::Isophotes)]]);

/// All parameters of the style.
pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "pitch",
        kind: Kind::Length { default: Default::Millimetres(0.6), least: 0.05, most: 50.0 },
        meaning: "distance between neighbouring dots; smaller gives finer detail and more dots",
        source: "Bruehl 3.2, l",
        needs: &[],
    },
    Parameter {
        name: "size",
        kind: Kind::Choice(&["exact", "paper"]),
        meaning: "dot size: exact matches the tone's ink in each dot's own cell; paper is s_max (1 - T)^gamma",
        source: "Bruehl 3.4 and 4.4",
        needs: &[],
    },
    Parameter {
        name: "size_max",
        kind: Kind::Length { default: Default::Pitches(0.56), least: 0.01, most: 50.0 },
        meaning: "with size=paper: radius of a dot at full ink",
        source: "Bruehl 3.4, s_max",
        needs: &[Need::Word("size", &["paper"])],
    },
    Parameter {
        name: "size_gamma",
        kind: Kind::Number { default: 1.2, least: 0.1, most: 5.0 },
        meaning: "with size=paper: exponent of 1 - tone",
        source: "Bruehl 3.4, gamma",
        needs: &[Need::Word("size", &["paper"])],
    },
    Parameter {
        name: "reversed_from",
        kind: Kind::Number { default: 0.76, least: 0.5, most: 1.0 },
        meaning: "with size=exact: ink from which dark regions are drawn black with white holes, as on scraperboard; 1 keeps dots everywhere, which close up there",
        source: "",
        needs: &[Need::Word("size", &["exact"])],
    },
    Parameter {
        name: "lines",
        kind: Kind::Choice(&["coherent", "canny"]),
        meaning: "edge detector: coherent finds lines along the edge tangent flow and draws them at their own width; canny is Canny's detector",
        source: "Bruehl 2.1 and 4.3.1; Kang et al. 2007",
        needs: &[Need::Without(MaskRole::Edges)],
    },
    Parameter {
        name: "line_width",
        // Wider lines take minutes: the filter is three times as long along a line as across.
        kind: Kind::Length { default: Default::Pitches(0.2), least: 0.01, most: 10.0 },
        meaning: "with lines=coherent: width of the lines to detect, standard deviation across them",
        source: "Kang et al. 2007, sigma_c",
        needs: &[Need::Word("lines", &["coherent"]), Need::Without(MaskRole::Edges)],
    },
    Parameter {
        name: "line_contrast",
        kind: Kind::Number { default: 0.07, least: 0.0, most: 1.0 },
        meaning: "with lines=coherent: minimum difference of lightness across a line",
        source: "",
        needs: &[Need::Word("lines", &["coherent"]), Need::Without(MaskRole::Edges)],
    },
    Parameter {
        name: "edge_blur",
        kind: Kind::Length { default: Default::Pitches(0.4), least: 0.0, most: 50.0 },
        meaning: "with lines=canny: blur before edge detection; larger finds only the large forms",
        source: "Bruehl 2.1",
        needs: &[Need::Word("lines", &["canny"]), Need::Without(MaskRole::Edges)],
    },
    Parameter {
        name: "edge_high",
        kind: Kind::Number { default: 0.30, least: 0.0, most: 5.0 },
        meaning: "with lines=canny: an edge must somewhere reach this change of lightness (0 to 1) per pitch",
        source: "Bruehl 2.1, maxVal",
        needs: &[Need::Word("lines", &["canny"]), Need::Without(MaskRole::Edges)],
    },
    Parameter {
        name: "edge_low",
        kind: Kind::Number { default: 0.12, least: 0.0, most: 5.0 },
        meaning: "with lines=canny: an edge ends where the change per pitch falls below this",
        source: "Bruehl 2.1, minVal",
        needs: &[Need::Word("lines", &["canny"]), Need::Without(MaskRole::Edges)],
    },
    Parameter {
        name: "edge_length",
        kind: Kind::Length { default: Default::Pitches(8.0), least: 0.0, most: 1000.0 },
        meaning: "edges shorter than this do not steer the dots",
        source: "Bruehl 2.1.1, threshold",
        needs: &[Need::AnyOf(&[&[Need::Without(MaskRole::Edges)], &[Need::Without(MaskRole::Isophotes)]])],
    },
    Parameter {
        name: "smoothing",
        kind: Kind::Length { default: Default::Pitches(1.0), least: 0.0, most: 50.0 },
        meaning: "smoothing along edges and isophotes, so that rows flow",
        source: "Bruehl 4.3.1 asks for smooth lines",
        needs: &[],
    },
    Parameter {
        name: "levels",
        kind: Kind::Count { default: 8, least: 2, most: 64 },
        meaning: "number of lightness levels; isophotes run between them",
        source: "Bruehl 2.2",
        needs: &[Need::AnyOf(&[
            &[Need::Word("highlights", &["on"])],
            &[Need::Above("isophotes", 0.0), Need::Without(MaskRole::Isophotes)],
        ])],
    },
    Parameter {
        name: "isophotes",
        kind: Kind::Count { default: 3, least: 0, most: 63 },
        meaning: "how many of the lightest levels are outlined by isophotes; 0 for none",
        source: "Bruehl 2.2, t",
        needs: &[Need::Without(MaskRole::Isophotes)],
    },
    Parameter {
        name: "edge_weight",
        kind: Kind::Number { default: 1.0, least: 0.01, most: 100.0 },
        meaning: "weight of edges relative to isophotes",
        source: "Bruehl 3.1.2, w_e",
        needs: &[BOTH_STEER],
    },
    Parameter {
        name: "isophote_weight",
        kind: Kind::Number { default: 2.0, least: 0.01, most: 100.0 },
        meaning: "weight of isophotes relative to edges",
        source: "Bruehl 3.1.2, w_i",
        needs: &[BOTH_STEER],
    },
    Parameter {
        name: "flow_reach",
        kind: Kind::Length { default: Default::Pitches(100.0 / 6.0), least: 0.01, most: 10_000.0 },
        meaning: "distance from a feature at which rows dissolve into an even scatter",
        source: "Kim et al. 2008, D_w = 100 px",
        needs: &[Need::Above("flow_rounds", 0.0)],
    },
    Parameter {
        name: "plain_rounds",
        kind: Kind::Count { default: 10, least: 0, most: 1000 },
        meaning: "rounds of relaxation that only spread the dots",
        source: "Kim et al. 2008, t1",
        needs: &[],
    },
    Parameter {
        name: "flow_rounds",
        kind: Kind::Count { default: 30, least: 0, most: 1000 },
        meaning: "further rounds, alternately pulling the dots into rows and spreading them",
        source: "Kim et al. 2008, t2",
        needs: &[],
    },
    Parameter {
        name: "highlights",
        kind: Kind::Choice(&["on", "off"]),
        meaning: "leave the lightest regions bare, with a fade",
        source: "Bruehl 4.3.2",
        needs: &[],
    },
    Parameter {
        name: "highlight_steps",
        kind: Kind::Number { default: 1.0, least: 0.0, most: 64.0 },
        meaning: "how many of the lightest levels are left bare",
        source: "Bruehl 4.3.2",
        needs: &[Need::Word("highlights", &["on"])],
    },
    Parameter {
        name: "highlight_fade",
        kind: Kind::Number { default: 0.12, least: 0.0, most: 1.0 },
        meaning: "range of lightness over which dots shrink and thin out towards a bare highlight",
        source: "Bruehl 4.4 asks for a fade",
        needs: &[Need::Word("highlights", &["on"])],
    },
    Parameter {
        name: "outline",
        kind: Kind::Choice(&["on", "off"]),
        meaning: "draw the longest edges as swelling strokes",
        source: "Bruehl 4.3.2",
        needs: &[],
    },
    Parameter {
        name: "outline_length",
        kind: Kind::Length { default: Default::Pitches(16.0), least: 0.0, most: 1000.0 },
        meaning: "minimum length of a drawn line; rows also follow shorter ones",
        source: "Bruehl 4.3.2",
        needs: &[Need::Word("outline", &["on"])],
    },
    Parameter {
        name: "outline_width",
        kind: Kind::Length { default: Default::Pitches(0.4), least: 0.01, most: 50.0 },
        meaning: "width of an outline at its widest",
        source: "",
        needs: &[Need::Word("outline", &["on"])],
    },
    Parameter {
        name: "detail",
        kind: Kind::Choice(&["auto", "even", "thesis", "off"]),
        meaning: "lanes in detail regions (the detail mask, else the detected eyes, brows, noses and mouths): auto and even make them sqrt(3) times as dense, so that three times the dots stay in square cells; thesis makes them three times as dense; off leaves them as everywhere",
        source: "Bruehl 4.3.2, corrected",
        needs: &[Need::With(MaskRole::Detail)],
    },
    Parameter {
        name: "blob",
        kind: Kind::Number { default: 0.0, least: 0.0, most: 1.0 },
        meaning: "irregularity of the dots: 0 draws circles, 1 ragged ink blobs of the same area",
        source: "Bruehl 4.4",
        needs: &[],
    },
];

/// How dots get their size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SizeRule {
    Exact,
    Paper,
}

/// The parameters' values; lengths in millimetres.
#[derive(Clone, Copy, Debug)]
pub(super) struct HedcutParameters {
    pub pitch_mm: f64,
    pub size: SizeRule,
    pub size_max_mm: f64,
    pub size_gamma: f64,
    pub reversed_from: f64,
    pub has_coherent_lines: bool,
    pub line_width_mm: f64,
    pub line_contrast: f64,
    pub edge_blur_mm: f64,
    pub edge_high: f64,
    pub edge_low: f64,
    pub edge_length_mm: f64,
    pub smoothing_mm: f64,
    pub levels: u32,
    pub isophotes: u32,
    pub edge_weight: f32,
    pub isophote_weight: f32,
    pub flow_reach_mm: f64,
    pub plain_rounds: u32,
    pub flow_rounds: u32,
    pub has_highlights: bool,
    pub highlight_steps: f64,
    pub highlight_fade: f64,
    pub has_outline: bool,
    pub outline_length_mm: f64,
    pub outline_width_mm: f64,
    /// Number of lanes per ordinary lane in a detail region; none if detail is off.
    pub detail_lanes: Option<f64>,
    pub blob: f64,
}

impl HedcutParameters {
    pub(super) fn new(settings: &Settings) -> Self {
        let count = |name| settings.number(name) as u32;
        Self {
            pitch_mm: settings.number("pitch"),
            size: if settings.word("size") == "exact" { SizeRule::Exact } else { SizeRule::Paper },
            size_max_mm: settings.number("size_max"),
            size_gamma: settings.number("size_gamma"),
            reversed_from: settings.number("reversed_from"),
            has_coherent_lines: settings.word("lines") == "coherent",
            line_width_mm: settings.number("line_width"),
            line_contrast: settings.number("line_contrast"),
            edge_blur_mm: settings.number("edge_blur"),
            edge_high: settings.number("edge_high"),
            edge_low: settings.number("edge_low"),
            edge_length_mm: settings.number("edge_length"),
            smoothing_mm: settings.number("smoothing"),
            levels: count("levels"),
            isophotes: count("isophotes"),
            edge_weight: settings.number("edge_weight") as f32,
            isophote_weight: settings.number("isophote_weight") as f32,
            flow_reach_mm: settings.number("flow_reach"),
            plain_rounds: count("plain_rounds"),
            flow_rounds: count("flow_rounds"),
            has_highlights: settings.word("highlights") == "on",
            highlight_steps: settings.number("highlight_steps"),
            highlight_fade: settings.number("highlight_fade"),
            has_outline: settings.word("outline") == "on",
            outline_length_mm: settings.number("outline_length"),
            outline_width_mm: settings.number("outline_width"),
            detail_lanes: match settings.word("detail") {
                "off" => None,
                "thesis" => Some(3.0),
                _ => Some(3.0_f64.sqrt()),
            },
            blob: settings.number("blob"),
        }
    }

    /// Working pixels per pitch: six as in the papers, more if detail lanes would be too narrow.
    pub(super) fn pixels_per_pitch(&self, has_detail: bool) -> f64 {
        let lanes = self.detail_lanes.filter(|_| has_detail).unwrap_or(1.0);
        if lanes > 1.0 { PIXELS_PER_PITCH.max(LEAST_LANE_PIXELS * lanes) } else { PIXELS_PER_PITCH }
    }
}
