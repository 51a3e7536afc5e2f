//! Charcoal's card, its parameters and their values.

use crate::field::HoughForm;
use crate::geometry::Millimetres;
use crate::source::MaskRole::{Clothing, Detail, Directions, Edges, Face, FacialHair, Hair, Headwear, Subject};
use crate::style::declaration::{ON, Radians, Setting, count, millimetres, number, parameters, pitches};
use crate::style::{Kind, Need, Places, Settings, StyleCard};

/// What the style is.
pub(super) const CARD: StyleCard = StyleCard {
    name: "charcoal",
    summary: "a portrait in charcoal: smudged tone, sketchy contours, flowing hair, clothing and background shaded by hand",
    source: "Wong 1999, Artistic Rendering of Portrait Photographs",
    parameters: PARAMETERS,
    masks: &[Subject, Hair, Face, Clothing, FacialHair, Headwear, Detail, Edges, Directions],
    uses_depth: false,
    leaves_out_background: true,
};

/// The background is shaded.
const BACKGROUND: &[Need] = &[Need::Word("background", &["on"]), Need::Above("background_ink", 0.0)];

parameters! {
    /// The parameters of a charcoal sketch; lengths in millimetres.
    pub(super) struct CharcoalParameters {
        pitch: Millimetres = "pitch": millimetres(0.6, 0.1..=50.0),
            "distance between neighbouring strokes; every other length defaults to a multiple of it",
            "";
        stroke_width: Millimetres = "stroke_width": pitches(0.7, 0.02..=50.0),
            "width of a stroke at full pressure",
            "";
        grain: Millimetres = "grain": pitches(0.35, 0.1..=50.0),
            "distance between the grains of the smudged tone",
            "Wong 6.3.1, the paper's texture";
        smudge: Millimetres = "smudge": pitches(1.5, 0.0..=100.0),
            "blur of the smudged tone",
            "Wong 3.1.5";
        brighten: f32 = "brighten": number(0.1, 0.0..=1.0),
            "how far the smudged tone is brightened: 0 keeps the photograph's tone, 1 removes 0.3 of ink everywhere and two fifths of the rest",
            "Wong 3.1.5";
        texture_bias: f32 = "texture_bias": number(1.0, 0.0..=20.0),
            "weight of the photograph against the paper's texture in middle tones",
            "Wong 6.3.1, n";
        edge_blur: Millimetres = "edge_blur": pitches(0.5, 0.0..=50.0),
            "blur before edge detection; larger finds only the large forms",
            "Wong 3.1.3";
        edge_high: f64 = "edge_high": number(0.15, 0.0..=5.0),
            "an edge must somewhere reach this change of lightness (0 to 1) per pitch",
            "Wong 3.1.3";
        edge_low: f64 = "edge_low": number(0.05, 0.0..=5.0),
            "an edge ends where the change per pitch falls below this",
            "Wong 3.1.3";
        edge_length: Millimetres = "edge_length": pitches(9.0, 0.0..=1000.0),
            "edges shorter than this are specks and are not drawn",
            "Wong 3.1.3; longer than its 10 to 15 px, since no hand removes the rest";
        sketch_passes: u32 = "sketch_passes": count(1, 0..=10),
            "passes of displaced strokes over each edge before its own line is drawn",
            "Wong 6.3.2";
        sketch_offset: Millimetres = "sketch_offset": pitches(0.8, 0.0..=50.0),
            "maximum displacement of the ends of the displaced strokes",
            "Wong 6.3.2", needs [Need::Above("sketch_passes", 0.0)];
        hough: HoughForm = "hough": Kind::Choice(&["round", "thesis"]),
            "how hair direction is detected: round uses a round window and counts beyond chance; thesis is as printed",
            "Wong 4.3; errata";
        hough_radius: Millimetres = "hough_radius": pitches(2.5, 0.1..=100.0),
            "radius of the window in which hair direction is detected",
            "Wong 4.4";
        hair_smoothing: Millimetres = "hair_smoothing": pitches(3.75, 0.0..=100.0),
            "smoothing of the hair direction",
            "Wong 3.1.2, sigma = 15 px";
        hair_length: Millimetres = "hair_length": pitches(14.0, 0.5..=1000.0),
            "mean length of a hair stroke",
            "Wong 6.3.3";
        hair_turn: Radians = "hair_turn": number(15.0, 0.0..=90.0),
            "maximum angle between a hair stroke and the hair's direction, in degrees",
            "Wong 6.3.3, pi/12";
        hair_ink: f32 = "hair_ink": number(1.0, 0.0..=3.0),
            "ink of the hair strokes relative to the photograph's darkness",
            "tone-aware, unlike the thesis";
        has_features: bool = "features": ON,
            "draw pupils, lashes and lips solid in the faces that are known; in others find and shade the eyebrows, eyes, nose and mouth",
            "Wong 5";
        skin: Places = "skin": Kind::Places { most: 5 },
            "places of plain skin from one edge of the face to the other, used to even out its light; by default the median skin of each column",
            "Wong 5.1, five points", needs [Need::Word("features", &["on"]), Need::WithoutFace];
        has_shading: bool = "shading": ON,
            "hand-shade the dark parts of clothing and of everything that is neither face nor hair",
            "";
        has_background: bool = "background": ON,
            "hand-shade the background",
            "Wong 6.3.5", needs [Need::Above("background_ink", 0.0)];
        background_ink: f64 = "background_ink": number(0.13, 0.0..=1.0),
            "ink of the background strokes where they are thickest",
            "", needs [Need::Word("background", &["on"])];
        arc_length: Millimetres = "arc_length": pitches(26.0, 0.5..=1000.0),
            "mean length of the shading arcs",
            "Wong 6.2", needs [Need::AnyOf(&[&[Need::Word("shading", &["on"])], BACKGROUND])];
        arc_radius: Millimetres = "arc_radius": pitches(50.0, 0.5..=10_000.0),
            "radius of the shading arcs",
            "Wong 6.2", needs [Need::AnyOf(&[&[Need::Word("features", &["on"])], &[Need::Word("shading", &["on"])], BACKGROUND])];
        arc_orient: Radians = "arc_orient": number(-52.0, -180.0..=180.0),
            "direction of the shading arcs in degrees, clockwise from the right",
            "Wong 6.2", needs [Need::AnyOf(&[&[Need::Word("shading", &["on"])], BACKGROUND])];
        arc_skew: f64 = "arc_skew": number(0.1, 0.0..=0.5),
            "random variation of the shading arcs in length and direction",
            "Wong 6.2", needs [Need::AnyOf(&[&[Need::Word("features", &["on"])], &[Need::Word("shading", &["on"])], BACKGROUND])];
    }
}

impl Setting for HoughForm {
    fn of(settings: &Settings, name: &str) -> Self {
        if settings.word(name) == "round" { Self::Round } else { Self::Thesis }
    }
}
