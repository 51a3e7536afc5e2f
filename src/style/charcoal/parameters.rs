//! Charcoal's parameters and their values.

use crate::field::HoughForm;
use crate::style::{Default, Kind, Parameter, Places, Settings};

/// All that a user can set.
pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "pitch",
        kind: Kind::Length { default: Default::Millimetres(0.6), least: 0.1, most: 50.0 },
        meaning: "distance of neighbouring strokes; every other length follows it, so that it sets the size of the hand",
        source: "",
    },
    Parameter {
        name: "stroke_width",
        kind: Kind::Length { default: Default::Pitches(0.7), least: 0.02, most: 50.0 },
        meaning: "width of a stroke at full pressure",
        source: "",
    },
    Parameter {
        name: "grain",
        kind: Kind::Length { default: Default::Pitches(0.5), least: 0.1, most: 50.0 },
        meaning: "distance from one grain of the smudged tone to the next",
        source: "Wong 6.3.1, the paper's texture",
    },
    Parameter {
        name: "smudge",
        kind: Kind::Length { default: Default::Pitches(1.5), least: 0.0, most: 100.0 },
        meaning: "blur of the smudged tone",
        source: "Wong 3.1.5",
    },
    Parameter {
        name: "brighten",
        kind: Kind::Number { default: 0.5, least: 0.0, most: 1.0 },
        meaning: "how far the smudged tone is brightened: 0 keeps the photograph's tone, 1 takes off 0.3 of ink everywhere and two fifths of the rest",
        source: "Wong 3.1.5",
    },
    Parameter {
        name: "texture_bias",
        kind: Kind::Number { default: 1.0, least: 0.0, most: 20.0 },
        meaning: "how far the photograph outweighs the paper's texture in middle tones",
        source: "Wong 6.3.1, n",
    },
    Parameter {
        name: "edge_blur",
        kind: Kind::Length { default: Default::Pitches(0.5), least: 0.0, most: 50.0 },
        meaning: "blur before edges are sought; larger finds only the great forms",
        source: "Wong 3.1.3",
    },
    Parameter {
        name: "edge_high",
        kind: Kind::Number { default: 0.15, least: 0.0, most: 5.0 },
        meaning: "an edge needs somewhere this change of lightness (0 to 1) a pitch",
        source: "Wong 3.1.3",
    },
    Parameter {
        name: "edge_low",
        kind: Kind::Number { default: 0.05, least: 0.0, most: 5.0 },
        meaning: "an edge ends where the change a pitch falls below this",
        source: "Wong 3.1.3",
    },
    Parameter {
        name: "edge_length",
        kind: Kind::Length { default: Default::Pitches(9.0), least: 0.0, most: 1000.0 },
        meaning: "shorter edges are specks and are not drawn",
        source: "Wong 3.1.3; longer than its 10 to 15 px, since no hand removes the rest",
    },
    Parameter {
        name: "sketch_passes",
        kind: Kind::Count { default: 1, least: 0, most: 10 },
        meaning: "how often displaced strokes go over each edge before its own line is drawn",
        source: "Wong 6.3.2",
    },
    Parameter {
        name: "sketch_offset",
        kind: Kind::Length { default: Default::Pitches(0.8), least: 0.0, most: 50.0 },
        meaning: "greatest displacement of those strokes' ends",
        source: "Wong 6.3.2",
    },
    Parameter {
        name: "hough",
        kind: Kind::Choice(&["round", "thesis"]),
        meaning: "how the direction of hair is read: round window and counts beyond chance, or as the thesis prints it",
        source: "Wong 4.3; errata",
    },
    Parameter {
        name: "hough_radius",
        kind: Kind::Length { default: Default::Pitches(2.5), least: 0.1, most: 100.0 },
        meaning: "radius of the window in which the direction of hair is read",
        source: "Wong 4.4",
    },
    Parameter {
        name: "hair_smoothing",
        kind: Kind::Length { default: Default::Pitches(3.75), least: 0.0, most: 100.0 },
        meaning: "smoothing of the direction of hair",
        source: "Wong 3.1.2, sigma = 15 px",
    },
    Parameter {
        name: "hair_length",
        kind: Kind::Length { default: Default::Pitches(14.0), least: 0.5, most: 1000.0 },
        meaning: "mean length of a stroke of hair",
        source: "Wong 6.3.3",
    },
    Parameter {
        name: "hair_turn",
        kind: Kind::Number { default: 15.0, least: 0.0, most: 90.0 },
        meaning: "greatest angle, in degrees, between a stroke of hair and the hair's direction",
        source: "Wong 6.3.3, pi/12",
    },
    Parameter {
        name: "hair_ink",
        kind: Kind::Number { default: 1.0, least: 0.0, most: 3.0 },
        meaning: "ink of the hair's strokes against the photograph's darkness",
        source: "tone-aware, unlike the thesis",
    },
    Parameter {
        name: "features",
        kind: Kind::Choice(&["on", "off"]),
        meaning: "find and draw the eyebrows, eyes, nose and mouth",
        source: "Wong 5",
    },
    Parameter {
        name: "skin",
        kind: Kind::Places { most: 5 },
        meaning: "places of plain skin, from one edge of the face to the other, by which its light is evened out; without them the median skin by column",
        source: "Wong 5.1, five points",
    },
    Parameter {
        name: "shading",
        kind: Kind::Choice(&["on", "off"]),
        meaning: "shade the dark parts of clothing and of all that is neither face nor hair by hand",
        source: "",
    },
    Parameter {
        name: "background",
        kind: Kind::Choice(&["on", "off"]),
        meaning: "shade the background by hand",
        source: "Wong 6.3.5",
    },
    Parameter {
        name: "background_ink",
        kind: Kind::Number { default: 0.2, least: 0.0, most: 1.0 },
        meaning: "ink of the background's strokes where they are thickest",
        source: "",
    },
    Parameter {
        name: "arc_length",
        kind: Kind::Length { default: Default::Pitches(26.0), least: 0.5, most: 1000.0 },
        meaning: "mean length of the background's arcs",
        source: "Wong 6.2",
    },
    Parameter {
        name: "arc_radius",
        kind: Kind::Length { default: Default::Pitches(50.0), least: 0.5, most: 10_000.0 },
        meaning: "radius of the background's arcs",
        source: "Wong 6.2",
    },
    Parameter {
        name: "arc_orient",
        kind: Kind::Number { default: -52.0, least: -180.0, most: 180.0 },
        meaning: "direction of the background's arcs in degrees, clockwise from the right",
        source: "Wong 6.2",
    },
    Parameter {
        name: "arc_skew",
        kind: Kind::Number { default: 0.1, least: 0.0, most: 0.5 },
        meaning: "how far arcs differ in length and turn",
        source: "Wong 6.2",
    },
];

/// The parameters' values; lengths in millimetres, angles in radians.
#[derive(Clone, Copy, Debug)]
pub(super) struct Charcoaling {
    pub pitch_mm: f64,
    pub stroke_width_mm: f64,
    pub grain_mm: f64,
    pub smudge_mm: f64,
    pub brighten: f32,
    pub texture_bias: f32,
    pub edge_blur_mm: f64,
    pub edge_high: f64,
    pub edge_low: f64,
    pub edge_length_mm: f64,
    pub sketch_passes: u32,
    pub sketch_offset_mm: f64,
    pub hough: HoughForm,
    pub hough_radius_mm: f64,
    pub hair_smoothing_mm: f64,
    pub hair_length_mm: f64,
    pub hair_turn: f64,
    pub hair_ink: f32,
    pub has_features: bool,
    pub skin: Places,
    pub has_shading: bool,
    pub has_background: bool,
    pub background_ink: f64,
    pub arc_length_mm: f64,
    pub arc_radius_mm: f64,
    pub arc_orient: f64,
    pub arc_skew: f64,
}

impl Charcoaling {
    pub(super) fn new(settings: &Settings) -> Self {
        let number = |name| settings.number(name);
        Self {
            pitch_mm: number("pitch"),
            stroke_width_mm: number("stroke_width"),
            grain_mm: number("grain"),
            smudge_mm: number("smudge"),
            brighten: number("brighten") as f32,
            texture_bias: number("texture_bias") as f32,
            edge_blur_mm: number("edge_blur"),
            edge_high: number("edge_high"),
            edge_low: number("edge_low"),
            edge_length_mm: number("edge_length"),
            sketch_passes: number("sketch_passes") as u32,
            sketch_offset_mm: number("sketch_offset"),
            hough: if settings.word("hough") == "round" { HoughForm::Round } else { HoughForm::Thesis },
            hough_radius_mm: number("hough_radius"),
            hair_smoothing_mm: number("hair_smoothing"),
            hair_length_mm: number("hair_length"),
            hair_turn: number("hair_turn").to_radians(),
            hair_ink: number("hair_ink") as f32,
            skin: settings.places("skin"),
            has_features: settings.word("features") == "on",
            has_shading: settings.word("shading") == "on",
            has_background: settings.word("background") == "on",
            background_ink: number("background_ink"),
            arc_length_mm: number("arc_length"),
            arc_radius_mm: number("arc_radius"),
            arc_orient: number("arc_orient").to_radians(),
            arc_skew: number("arc_skew"),
        }
    }
}
