//! The engraving's card, its parameters and their values.

use crate::geometry::Millimetres;
use crate::source::MaskRole::{self, Clothing, Detail, Directions, FacialHair, Hair, Headwear, Scribbles, Subject};
use crate::style::declaration::{OFF, choices, millimetres, number, parameters, pitches};
use crate::style::{Kind, Need, StyleCard};

/// What the style is.
pub(super) const CARD: StyleCard = StyleCard {
    name: "engrave",
    summary: "swelling lines bent over the form by a depth map, crossed in the dark, as on banknotes",
    source: "Galarza 2017, Image Stylization using Depth Information for Hatching and Engraving effects",
    parameters: PARAMETERS,
    masks: &[Subject, Detail, Hair, FacialHair, Clothing, Headwear, Directions, Scribbles],
    uses_depth: true,
    leaves_out_background: true,
};

/// Working pixels per pitch; and where masks show a person, whose lines follow the form: they are laid between pixels.
const PIXELS_PER_PITCH: f64 = 6.0;
const PIXELS_PER_PITCH_OF_FORM: f64 = 5.0;

/// Depth bends the lines or gives the tone.
const DEPTH_COUNTS: Need = Need::AnyOf(&[&[Need::Nonzero("displacement")], &[Need::Word("tone_from", &["depth"])]]);
/// Lines that are laid straight, and only bent by depth.
const STRAIGHT: Need = Need::AnyOf(&[
    &[Need::WithoutFace],
    &[Need::Word("directions", &["straight"])],
    &[Need::WithGivenDepth],
    &[Need::With(MaskRole::Scribbles)],
    &[Need::Word("regions", &["one", "superpixels"])],
    &[Need::Word("look", &["engraving", "net", "stipple", "contour"])],
    &[Need::Word("ground", &["black"])],
    &[Need::Word("tone_from", &["depth"])],
]);
/// Lines that can break.
const NOT_STIPPLED: Need = Need::Word("look", &["crosshatch", "engraving", "hatch", "net", "contour"]);

parameters! {
    /// The parameters of an engraving; angles in degrees; lengths in millimetres.
    pub(super) struct EngraveParameters {
        pitch: Millimetres = "pitch": millimetres(0.36, 0.1..=50.0),
            "distance between neighbouring lines where the depth is flat",
            "Galarza 3.5.1, delta_y";
        look: Look = "look": Kind::Choice(Look::WORDS),
            "crosshatch: swelling lines, crossed in dark tones, dots in light tones; engraving: the same, with white lines cut through them in half tones; hatch: one layer only; net: crossed everywhere; stipple: dots along the lines; contour: lines in shadows only",
            "Galarza 4.1 and 4.4";
        way: Way = "directions": Kind::Choice(Way::WORDS),
            "direction of the lines: form follows the face, its hair and clothing, where a face is known and no depth map is given; straight lines are only bent by depth",
            "Galarza 3.4; Ostromoukhov 1999", needs [ Need::WithFace, Need::WithoutGivenDepth, Need::Without(MaskRole::Scribbles), Need::Word("regions", &["auto"]), Need::Word("look", &["crosshatch", "hatch"]), Need::Word("ground", &["white"]), Need::Word("tone_from", &["photo"]), ];
        displacement: Millimetres = "displacement": pitches(14.0, -1000.0..=1000.0),
            "how far the nearest depth shifts a line to its left (up at angle 0)",
            "Galarza 3.5.1, phi, equation 3.5", needs [STRAIGHT];
        sampling: Millimetres = "sampling": pitches(0.5, 0.01..=100.0),
            "distance between the depth samples that bend a line; larger draws rounder, simpler lines",
            "Galarza 3.5.1, delta_x", needs [STRAIGHT];
        width_max: Millimetres = "width_max": pitches(1.5, 0.01..=100.0),
            "maximum width of a line; too small a value loses the darkest tones",
            "Galarza 3.7, f_w", needs [STRAIGHT];
        threshold: f64 = "threshold": number(0.5, 0.0..=1.0),
            "tone below which lines are crossed by a second layer (0 black, 1 white)",
            "Galarza 3.2, tau", needs [STRAIGHT, Need::Word("look", &["crosshatch", "engraving", "contour"])];
        angle: f64 = "angle": number(0.0, -360.0..=360.0),
            "direction of the lines in degrees, anticlockwise from the right",
            "Galarza 3.6, Theta", needs [STRAIGHT, Need::AnyOf(&[ &[Need::Word("angles", &["given", "hue"])], &[Need::Word("regions", &["one"]), Need::Word("angles", &["auto"])], &[Need::Without(MaskRole::Scribbles), Need::Word("regions", &["auto"]), Need::Word("angles", &["auto"])], ])];
        cross_angle: f64 = "cross_angle": number(90.0, 10.0..=170.0),
            "angle from the lines to the crossing lines, in degrees",
            "Galarza 3.6, alpha", needs [STRAIGHT, Need::AnyOf(&[ &[Need::Word("look", &["crosshatch", "engraving", "net"])], &[Need::Above("thinnest", 0.0), Need::Word("look", &["hatch", "contour"])], ])];
        regions: Division = "regions": Kind::Choice(Division::WORDS),
            "regions with a line direction of their own: auto takes the scribbles mask if given, else one region; superpixels are small regions of similar colour",
            "Galarza 3.3";
        region_size: Millimetres = "region_size": pitches(16.0, 0.5..=1000.0),
            "side of a superpixel",
            "Galarza 2.3, SLIC", needs [Need::Word("regions", &["superpixels"])];
        angles: AnglesFrom = "angles": Kind::Choice(AnglesFrom::WORDS),
            "line direction in each region: given is the angle parameter; flow follows the edges; random; hue is half the hue of its scribble (red 0, yellow 30, green 60, cyan 90, blue 120, magenta 150 degrees); auto is flow for superpixels, hue for scribbles, else given",
            "Galarza 3.3.1 and 3.4";
        overlap: Millimetres = "overlap": millimetres(0.0, 0.0..=100.0),
            "how far lines extend into a region with another line direction; 0.2 mm closes most seams, but lines cross there",
            "Galarza 3.7, dilation of the masks", needs [STRAIGHT, Need::AnyOf(&[ &[Need::Word("regions", &["superpixels"])], &[Need::Word("regions", &["auto"]), Need::With(MaskRole::Scribbles)], ])];
        min_gap: Millimetres = "min_gap": pitches(0.25, 0.001..=50.0),
            "minimum distance between neighbouring lines of a layer, centre to centre; limited to between a tenth and three quarters of the pitch",
            "the thesis lists crossing lines as its limit (4.2.2)", needs [STRAIGHT];
        smoothing: Millimetres = "smoothing": pitches(0.6, 0.0..=100.0),
            "edge-preserving smoothing of the depth",
            "Galarza 5.1 asks for depth without noise", needs [STRAIGHT, DEPTH_COUNTS];
        depth_from: DepthFrom = "depth_from": Kind::Choice(DepthFrom::WORDS),
            "source of depth without a depth map: shape inflates the regions and bends them by their shading, for portraits; inflate only inflates the regions (scribbles or subject mask, else the picture), for flat art and silhouettes; luminance treats light as near, for textures and reliefs",
            "Galarza 4.4 and 5.2", needs [STRAIGHT, Need::WithoutDepth, DEPTH_COUNTS];
        tone_from: ToneFrom = "tone_from": Kind::Choice(ToneFrom::WORDS),
            "source of the tone: photo is the photograph; depth is the depth map lit by a lamp, for use without a photograph",
            "Galarza 3.2";
        light_azimuth: f64 = "light_azimuth": number(135.0, -360.0..=360.0),
            "direction of the lamp: degrees anticlockwise from the right (135: upper left); also the light that depth_from=shape assumes",
            "Galarza 3.2", needs [STRAIGHT, Need::AnyOf(&[ &[Need::Word("tone_from", &["depth"])], &[Need::Word("depth_from", &["shape"]), Need::WithoutDepth, Need::Nonzero("displacement")], ])];
        light_height: f64 = "light_height": number(45.0, 5.0..=90.0),
            "height of the lamp, in degrees above the page",
            "Galarza 3.2", needs [Need::Word("tone_from", &["depth"])];
        relief: Millimetres = "relief": pitches(40.0, 0.0..=10_000.0),
            "with tone_from=depth: height of the nearest depth above the farthest",
            "", needs [Need::Word("tone_from", &["depth"])];
        thinnest: Millimetres = "thinnest": pitches(0.14, 0.0..=50.0),
            "width below which a line breaks into dashes and dots; 0 for never",
            "the engraver's dotted ends", needs [NOT_STIPPLED];
        dash: Millimetres = "dash": pitches(1.5, 0.01..=1000.0),
            "distance from one dash to the next along a broken line",
            "Galarza 4.1", needs [STRAIGHT, NOT_STIPPLED, Need::AnyOf(&[&[Need::Word("look", &["engraving"])], &[Need::Above("thinnest", 0.0)]])];
        cut_out: f64 = "cut_out": number(0.3, 0.0..=0.9),
            "with look=engraving: share of a line's length that the white crossing lines remove in light tones",
            "Galarza 4.1: hatching less thick crosshatching", needs [Need::Word("look", &["engraving"])];
        dot_min: Millimetres = "dot_min": pitches(0.12, 0.0..=50.0),
            "diameter of the smallest dot; lighter tones have fewer dots instead of smaller ones",
            "";
        ground: GroundColour = "ground": Kind::Choice(GroundColour::WORDS),
            "paper colour; black draws white lines on black paper",
            "Galarza 4.4, figure 4.14";
        has_outline: bool = "outline": OFF,
            "draw the photograph's coherent lines on top; their ink adds to the tone",
            "Galarza 5.2; Kang et al. 2007";
        outline_width: Millimetres = "outline_width": pitches(0.5, 0.01..=50.0),
            "width of the outlines in their middle",
            "", needs [Need::Word("outline", &["on"])];
    }
    adjusted by in_proportion
}

choices! {
    /// What is engraved.
    pub(super) enum Look {
        Crosshatch = "crosshatch", Engraving = "engraving", Hatch = "hatch",
        Net = "net", Stipple = "stipple", Contour = "contour",
    }
    /// Where lines run.
    pub(super) enum Way { Form = "form", Straight = "straight" }
    /// How the picture is divided into regions with a direction each.
    pub(super) enum Division { Auto = "auto", One = "one", Superpixels = "superpixels" }
    /// Where the regions' directions come from.
    pub(super) enum AnglesFrom { Auto = "auto", Given = "given", Flow = "flow", Random = "random", Hue = "hue" }
    /// Where depth comes from when no map is given.
    pub(super) enum DepthFrom { Shape = "shape", Inflate = "inflate", Luminance = "luminance" }
    /// Where tone comes from.
    pub(super) enum ToneFrom { Photo = "photo", Depth = "depth" }
    /// The paper's colour.
    pub(super) enum GroundColour { White = "white", Black = "black" }
}

impl EngraveParameters {
    /// Working pixels per pitch, given the masks that are known.
    pub(super) fn pixels_per_pitch(&self, masks: &[MaskRole]) -> f64 {
        let has_person = masks.iter().any(|role| matches!(role, Hair | Clothing));
        if self.may_follow_form() && has_person { PIXELS_PER_PITCH_OF_FORM } else { PIXELS_PER_PITCH }
    }

    /// True if nothing asks for lines other than those that follow the form of a face.
    pub(super) fn may_follow_form(&self) -> bool {
        self.way == Way::Form
            && self.regions == Division::Auto
            && matches!(self.look, Look::Crosshatch | Look::Hatch)
            && self.ground == GroundColour::White
            && self.tone_from == ToneFrom::Photo
    }

    /// Keeps lengths in proportion to the pitch.
    fn in_proportion(self) -> Self {
        let pitch = self.pitch;
        Self {
            sampling: self.sampling.max(0.05 * pitch),
            region_size: self.region_size.max(2.0 * pitch),
            min_gap: self.min_gap.max(0.1 * pitch).min(0.75 * pitch),
            ..self
        }
    }
}
