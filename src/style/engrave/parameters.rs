//! The engraving's parameters and their values.

use crate::source::MaskRole;
use crate::style::{Default, Kind, Need, Parameter, Settings};

/// Working pixels per pitch.
pub(super) const PIXELS_PER_PITCH: f64 = 6.0;

/// Depth bends the lines or gives the tone.
const DEPTH_COUNTS: Need = Need::AnyOf(&[&[Need::Nonzero("displacement")], &[Need::Word("tone_from", &["depth"])]]);
/// Lines that can break.
const NOT_STIPPLED: Need = Need::Word("look", &["crosshatch", "engraving", "hatch", "net", "contour"]);

/// All parameters of the style.
pub(super) const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "pitch",
        kind: Kind::Length { default: Default::Millimetres(0.6), least: 0.05, most: 50.0 },
        meaning: "distance between neighbouring lines where the depth is flat",
        source: "Galarza 3.5.1, delta_y",
        needs: &[],
    },
    Parameter {
        name: "look",
        kind: Kind::Choice(&["crosshatch", "engraving", "hatch", "net", "stipple", "contour"]),
        meaning: "crosshatch: swelling lines, crossed in dark tones, dots in light tones; engraving: the same, with white lines cut through them in half tones; hatch: one layer only; net: crossed everywhere; stipple: dots along the lines; contour: lines in shadows only",
        source: "Galarza 4.1 and 4.4",
        needs: &[],
    },
    Parameter {
        name: "displacement",
        kind: Kind::Length { default: Default::Pitches(14.0), least: -1000.0, most: 1000.0 },
        meaning: "how far the nearest depth shifts a line to its left (up at angle 0)",
        source: "Galarza 3.5.1, phi, equation 3.5",
        needs: &[],
    },
    Parameter {
        name: "sampling",
        kind: Kind::Length { default: Default::Pitches(0.5), least: 0.01, most: 100.0 },
        meaning: "distance between the depth samples that bend a line; larger draws rounder, simpler lines",
        source: "Galarza 3.5.1, delta_x",
        needs: &[],
    },
    Parameter {
        name: "width_max",
        kind: Kind::Length { default: Default::Pitches(1.5), least: 0.01, most: 100.0 },
        meaning: "maximum width of a line; too small a value loses the darkest tones",
        source: "Galarza 3.7, f_w",
        needs: &[],
    },
    Parameter {
        name: "threshold",
        kind: Kind::Number { default: 0.5, least: 0.0, most: 1.0 },
        meaning: "tone below which lines are crossed by a second layer (0 black, 1 white)",
        source: "Galarza 3.2, tau",
        needs: &[Need::Word("look", &["crosshatch", "engraving", "contour"])],
    },
    Parameter {
        name: "angle",
        kind: Kind::Number { default: 0.0, least: -360.0, most: 360.0 },
        meaning: "direction of the lines in degrees, anticlockwise from the right",
        source: "Galarza 3.6, Theta",
        needs: &[Need::AnyOf(&[
            &[Need::Word("angles", &["given", "hue"])],
            &[Need::Word("regions", &["one"]), Need::Word("angles", &["auto"])],
            &[Need::Without(MaskRole::Scribbles), Need::Word("regions", &["auto"]), Need::Word("angles", &["auto"])],
        ])],
    },
    Parameter {
        name: "cross_angle",
        kind: Kind::Number { default: 90.0, least: 10.0, most: 170.0 },
        meaning: "angle from the lines to the crossing lines, in degrees",
        source: "Galarza 3.6, alpha",
        needs: &[Need::AnyOf(&[
            &[Need::Word("look", &["crosshatch", "engraving", "net"])],
            &[Need::Above("thinnest", 0.0), Need::Word("look", &["hatch", "contour"])],
        ])],
    },
    Parameter {
        name: "regions",
        kind: Kind::Choice(&["auto", "one", "superpixels"]),
        meaning: "regions with a line direction of their own: auto takes the scribbles mask if given, else one region; superpixels are small regions of similar colour",
        source: "Galarza 3.3",
        needs: &[],
    },
    Parameter {
        name: "region_size",
        kind: Kind::Length { default: Default::Pitches(16.0), least: 0.5, most: 1000.0 },
        meaning: "side of a superpixel",
        source: "Galarza 2.3, SLIC",
        needs: &[Need::Word("regions", &["superpixels"])],
    },
    Parameter {
        name: "angles",
        kind: Kind::Choice(&["auto", "given", "flow", "random", "hue"]),
        meaning: "line direction in each region: given is the angle parameter; flow follows the edges; random; hue is half the hue of its scribble (red 0, yellow 30, green 60, cyan 90, blue 120, magenta 150 degrees); auto is flow for superpixels, hue for scribbles, else given",
        source: "Galarza 3.3.1 and 3.4",
        needs: &[],
    },
    Parameter {
        name: "overlap",
        kind: Kind::Length { default: Default::Millimetres(0.0), least: 0.0, most: 100.0 },
        meaning: "how far lines extend into a region with another line direction; 0.2 mm closes most seams, but lines cross there",
        source: "Galarza 3.7, dilation of the masks",
        needs: &[Need::AnyOf(&[
            &[Need::Word("regions", &["superpixels"])],
            &[Need::Word("regions", &["auto"]), Need::With(MaskRole::Scribbles)],
        ])],
    },
    Parameter {
        name: "min_gap",
        kind: Kind::Length { default: Default::Pitches(0.25), least: 0.001, most: 50.0 },
        meaning: "minimum distance between neighbouring lines of a layer, centre to centre; limited to between a tenth and three quarters of the pitch",
        source: "the thesis lists crossing lines as its limit (4.2.2)",
        needs: &[],
    },
    Parameter {
        name: "smoothing",
        kind: Kind::Length { default: Default::Pitches(0.6), least: 0.0, most: 100.0 },
        meaning: "edge-preserving smoothing of the depth",
        source: "Galarza 5.1 asks for depth without noise",
        needs: &[DEPTH_COUNTS],
    },
    Parameter {
        name: "depth_from",
        kind: Kind::Choice(&["shape", "inflate", "luminance"]),
        meaning: "source of depth without a depth map: shape inflates the regions and bends them by their shading, for portraits; inflate only inflates the regions (scribbles or subject mask, else the picture), for flat art and silhouettes; luminance treats light as near, for textures and reliefs",
        source: "Galarza 4.4 and 5.2",
        needs: &[Need::WithoutDepth, DEPTH_COUNTS],
    },
    Parameter {
        name: "tone_from",
        kind: Kind::Choice(&["photo", "depth"]),
        meaning: "source of the tone: photo is the photograph; depth is the depth map lit by a lamp, for use without a photograph",
        source: "Galarza 3.2",
        needs: &[],
    },
    Parameter {
        name: "light_azimuth",
        kind: Kind::Number { default: 135.0, least: -360.0, most: 360.0 },
        meaning: "direction of the lamp: degrees anticlockwise from the right (135: upper left); also the light that depth_from=shape assumes",
        source: "Galarza 3.2",
        needs: &[Need::AnyOf(&[
            &[Need::Word("tone_from", &["depth"])],
            &[Need::Word("depth_from", &["shape"]), Need::WithoutDepth, Need::Nonzero("displacement")],
        ])],
    },
    Parameter {
        name: "light_height",
        kind: Kind::Number { default: 45.0, least: 5.0, most: 90.0 },
        meaning: "height of the lamp, in degrees above the page",
        source: "Galarza 3.2",
        needs: &[Need::Word("tone_from", &["depth"])],
    },
    Parameter {
        name: "relief",
        kind: Kind::Length { default: Default::Pitches(40.0), least: 0.0, most: 10_000.0 },
        meaning: "with tone_from=depth: height of the nearest depth above the farthest",
        source: "",
        needs: &[Need::Word("tone_from", &["depth"])],
    },
    Parameter {
        name: "thinnest",
        kind: Kind::Length { default: Default::Pitches(0.14), least: 0.0, most: 50.0 },
        meaning: "width below which a line breaks into dashes and dots; 0 for never",
        source: "the engraver's dotted ends",
        needs: &[NOT_STIPPLED],
    },
    Parameter {
        name: "dash",
        kind: Kind::Length { default: Default::Pitches(1.5), least: 0.01, most: 1000.0 },
        meaning: "distance from one dash to the next along a broken line",
        source: "Galarza 4.1",
        needs: &[NOT_STIPPLED, Need::AnyOf(&[&[Need::Word("look", &["engraving"])], &[Need::Above("thinnest", 0.0)]])],
    },
    Parameter {
        name: "cut_out",
        kind: Kind::Number { default: 0.3, least: 0.0, most: 0.9 },
        meaning: "with look=engraving: share of a line's length that the white crossing lines remove in light tones",
        source: "Galarza 4.1: hatching less thick crosshatching",
        needs: &[Need::Word("look", &["engraving"])],
    },
    Parameter {
        name: "dot_min",
        kind: Kind::Length { default: Default::Pitches(0.12), least: 0.0, most: 50.0 },
        meaning: "diameter of the smallest dot; lighter tones have fewer dots instead of smaller ones",
        source: "",
        needs: &[],
    },
    Parameter {
        name: "ground",
        kind: Kind::Choice(&["white", "black"]),
        meaning: "paper colour; black draws white lines on black paper",
        source: "Galarza 4.4, figure 4.14",
        needs: &[],
    },
    Parameter {
        name: "outline",
        kind: Kind::Choice(&["off", "on"]),
        meaning: "draw the photograph's coherent lines on top; their ink adds to the tone",
        source: "Galarza 5.2; Kang et al. 2007",
        needs: &[],
    },
    Parameter {
        name: "outline_width",
        kind: Kind::Length { default: Default::Pitches(0.5), least: 0.01, most: 50.0 },
        meaning: "width of the outlines in their middle",
        source: "",
        needs: &[Need::Word("outline", &["on"])],
    },
];

/// How lines are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    EngraveParameters,
    Crosshatch,
    Hatch,
    Net,
    Stipple,
    Contour,
}

/// Source of depth without a depth map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DepthFrom {
    Shape,
    Inflate,
    Luminance,
}

/// The values of one drawing, lengths in millimetres, angles in degrees.
#[derive(Clone, Debug)]
pub(super) struct EngraveParameters {
    pub pitch: f64,
    pub look: Look,
    pub displacement: f64,
    pub sampling: f64,
    pub width_max: f64,
    pub threshold: f64,
    pub angle: f64,
    pub cross_angle: f64,
    pub regions: &'static str,
    pub region_size: f64,
    pub angles: &'static str,
    pub overlap: f64,
    pub min_gap: f64,
    pub smoothing: f64,
    pub depth_from: DepthFrom,
    pub is_lit: bool,
    pub light_azimuth: f64,
    pub light_height: f64,
    pub relief: f64,
    pub thinnest: f64,
    pub dash: f64,
    pub cut_out: f64,
    pub dot_min: f64,
    pub is_on_black: bool,
    pub has_outline: bool,
    pub outline_width: f64,
}

impl EngraveParameters {
    pub(super) fn new(settings: &Settings) -> Self {
        let pitch = settings.number("pitch");
        Self {
            pitch,
            look: match settings.word("look") {
                "engraving" => Look::EngraveParameters,
                "hatch" => Look::Hatch,
                "net" => Look::Net,
                "stipple" => Look::Stipple,
                "contour" => Look::Contour,
                _ => Look::Crosshatch,
            },
            displacement: settings.number("displacement"),
            sampling: settings.number("sampling").max(0.05 * pitch),
            width_max: settings.number("width_max"),
            threshold: settings.number("threshold"),
            angle: settings.number("angle"),
            cross_angle: settings.number("cross_angle"),
            regions: settings.word("regions"),
            region_size: settings.number("region_size").max(2.0 * pitch),
            angles: settings.word("angles"),
            overlap: settings.number("overlap"),
            min_gap: settings.number("min_gap").clamp(0.1 * pitch, 0.75 * pitch),
            smoothing: settings.number("smoothing"),
            depth_from: match settings.word("depth_from") {
                "inflate" => DepthFrom::Inflate,
                "luminance" => DepthFrom::Luminance,
                _ => DepthFrom::Shape,
            },
            is_lit: settings.word("tone_from") == "depth",
            light_azimuth: settings.number("light_azimuth"),
            light_height: settings.number("light_height"),
            relief: settings.number("relief"),
            thinnest: settings.number("thinnest"),
            dash: settings.number("dash"),
            cut_out: settings.number("cut_out"),
            dot_min: settings.number("dot_min"),
            is_on_black: settings.word("ground") == "black",
            has_outline: settings.word("outline") == "on",
            outline_width: settings.number("outline_width"),
        }
    }
}
