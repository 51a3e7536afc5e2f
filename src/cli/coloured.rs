//! A drawing in the colours of the photograph, by several pens.
//!
//! ```text
//!   photograph --separation--> coverage of each pen --together--> the style draws them as one tone
//!                                       \---------------------> each mark is dealt to a pen
//! ```
//!
//! What does not fit beside one another, in the darkest colours, is drawn over it in a second round.

use super::exact_ink::{grown, with_exact_ink};
use super::failure::Failure;
use super::palette::{APART, AT_ONCE, Palette};
use super::task::Task;
use crate::colour::{Candidate, deal};
use crate::drawing::{Drawing, Layer, Mark};
use crate::geometry::Point;
use crate::parallel::{collected, shares};
use crate::raster::Raster;
use crate::source::{MaskRole, Placement, Portrait};
use crate::style::{Observer, Parameter, Picture, Settings, StyleError};

/// Most of the paper that marks beside one another cover: above it round dots run together.
const MOST_BESIDE: f32 = 0.75;
/// The style of parallel lines.
const LINES: &str = "engrave";
/// Direction of the first pen's lines in degrees.
const FIRST_ANGLE: f64 = 15.0;
/// How fast the second round takes over where more is needed, until it draws half.
const RISE: f32 = 1.5;
/// A second round is drawn if it adds this much ink anywhere.
const LEAST_SECOND: f32 = 0.04;
/// Layers that draw features, not tone, by style.
const FEATURES: [(&str, &[&str]); 4] = [
    ("hedcut", &["outline", "solids"]),
    ("grid", &["lines", "solids"]),
    ("charcoal", &["edges", "features"]),
    ("engrave", &["contour", "solids"]),
];
/// Parameters that fill areas with black, leave lights bare, draw long strokes, whose whole length would be of one pen, or give marks
/// colours of their own; and what they are set to instead.
const SOLID: [(&str, &str); 4] = [("reversed_from", "1"), ("highlights", "off"), ("parts", "dots"), ("colors", "mono")];
/// Lengths in pitches, by style. A line is of one pen, so that dark tones made of lines miss the colour: `grid` takes dots alone (tuned on
/// four samples in three sets of pens: 4.8, 3.9 and 3.8 CIEDE2000 with lines, 3.1, 2.2 and 2.4 without). Its black feature lines add to
/// what the pens cover; thinner ones bring 3.1 to 3.0.
const SIZES: [(&str, &str, f64); 2] = [("grid", "size_max", 0.7072), ("grid", LINE_WIDTH, 0.24)];
/// The width of lines that are found, not given.
const LINE_WIDTH: &str = "line_widest";
/// Each round takes other random choices, so that the marks of the second lie across those of the first.
const SEEDS: [u64; 2] = [0, 0x5eed];

impl Task<'_> {
    /// The photograph in the colours of the pens: a layer for each, light ones first.
    pub(super) fn coloured(
        &self,
        settings: &Settings,
        placement: Placement,
        observer: &dyn Observer,
    ) -> Result<Drawing, Failure> {
        let Some(palette) = &self.palette else { return Err(Failure::Work("there are no pens".to_owned())) };
        let portrait = self.portrait(&self.manner.known, placement)?;
        observer.begin("separation");
        let coverages = palette.separate(&portrait);
        let mut layers: Vec<Layer> = palette.layers();
        if APART.contains(&self.manner.style.name()) {
            self.apart(&portrait, &coverages, &mut layers, observer)?;
            return palette.drawing(self.layout.page, layers).ok_or_else(|| self.nothing());
        }
        let (mut marks, mut candidates, mut outlines) = (Vec::new(), Vec::new(), Vec::new());
        for (round, tone) in rounds(&total(&coverages)).into_iter().enumerate() {
            let mut together = portrait.clone();
            together.tone = tone;
            if round > 0 && self.manner.style.card().masks.contains(&MaskRole::Edges) {
                // Lines belong to the first round alone; they need not be looked for again.
                let nothing = together.tone.map(|_| 0.0);
                together.masks.insert(MaskRole::Edges, nothing);
            }
            let settings = &self.without_solids(settings, &together)?;
            let drawn = match self.manner.style.draw(&together, settings, self.manner.seed ^ SEEDS[round], observer) {
                Err(StyleError::NothingToDraw(_) | StyleError::NothingLeft { .. }) => continue,
                drawn => drawn.map_err(|error| self.undrawn(&error))?,
            };
            let (features, tones): (Vec<Layer>, Vec<Layer>) = drawn.layers.into_iter().partition(|layer| self.is_features(layer));
            let tones: Vec<Mark> = tones.into_iter().flat_map(|layer| layer.marks).collect();
            if round == 0 {
                outlines.extend(features.into_iter().flat_map(|layer| layer.marks));
            }
            candidates.extend(tones.iter().map(|mark| candidate(mark, &portrait, &coverages, round as u8)));
            marks.extend(tones);
        }
        observer.begin("pens");
        for (mark, dealt) in marks.into_iter().zip(deal(&candidates)) {
            let way = dealt.at - middle(&mark);
            layers[dealt.pen].marks.push(grown(&mark, dealt.ink_factor, way));
        }
        shares(&mut layers, 1, &|pen, layers| {
            let (layer, coverage) = (&mut layers[0], &coverages[pen]);
            let outlines = if pen == palette.line_pen() { &outlines[..] } else { &[] };
            layer.marks = with_exact_ink(std::mem::take(&mut layer.marks), outlines, coverage, &portrait.placement);
            layer.marks.splice(0..0, outlines.iter().cloned());
        });
        palette.drawing(self.layout.page, layers).ok_or_else(|| self.nothing())
    }

    /// A drawing for each pen. Parallel lines have a direction of their own: those of two pens then cross evenly, without moire.
    fn apart(
        &self,
        portrait: &Portrait,
        coverages: &[Raster<f32>],
        layers: &mut [Layer],
        observer: &dyn Observer,
    ) -> Result<(), Failure> {
        let line_pen = self.palette.as_ref().map_or(0, Palette::line_pen);
        let manner = &self.manner;
        let settings: Vec<Settings> =
            (0..coverages.len()).map(|pen| self.settings_of_pen(pen, coverages.len(), portrait)).collect::<Result<_, _>>()?;
        let mut portrait = portrait.clone();
        manner.style.prepare(&mut portrait, &settings[0], manner.seed, observer);
        let draw = |pen: usize| {
            let mut own = portrait.clone();
            own.tone = coverages[pen].map(|ink| 1.0 - ink);
            if pen != line_pen && manner.style.card().masks.contains(&MaskRole::Edges) {
                // Its lines would not be drawn; they need not be looked for.
                own.masks.insert(MaskRole::Edges, own.tone.map(|_| 0.0));
            }
            let beside = Beside(observer);
            let observer = if pen == 0 { observer } else { &beside };
            manner.style.draw(&own, &settings[pen], manner.seed ^ pen as u64, observer)
        };
        let mut drawings: Vec<Result<Drawing, StyleError>> = Vec::new();
        while drawings.len() < coverages.len() {
            let first = drawings.len();
            drawings.extend(collected(AT_ONCE.min(coverages.len() - first), &|pen| draw(first + pen)));
        }
        for (pen, drawn) in drawings.into_iter().enumerate() {
            let drawn = match drawn {
                Err(StyleError::NothingToDraw(_) | StyleError::NothingLeft { .. }) => continue,
                drawn => drawn.map_err(|error| self.undrawn(&error))?,
            };
            let wanted = drawn.layers.into_iter().filter(|layer| pen == line_pen || !self.is_features(layer));
            layers[pen].marks.extend(wanted.flat_map(|layer| layer.marks));
        }
        Ok(())
    }

    /// The style's settings for one of several pens.
    fn settings_of_pen(&self, pen: usize, pens: usize, portrait: &Portrait) -> Result<Settings, Failure> {
        let style = self.manner.style;
        let mut given = self.given().to_vec();
        let mut set = |key: &str, value: String| {
            if style.parameters().iter().any(|parameter| parameter.name == key) {
                given.push((key.to_owned(), value));
            }
        };
        if pen != self.palette.as_ref().map_or(0, Palette::line_pen) {
            // One pen's background is enough.
            set("background", "off".to_owned());
        }
        if style.name() == LINES {
            set("angle", angle(pen, pens).to_string());
            set("look", "hatch".to_owned());
            if !portrait.faces.is_empty() {
                set("directions", "straight".to_owned());
            }
        }
        Ok(Settings::resolve(style.name(), style.parameters(), &given)?)
    }

    /// True for layers that draw features, not tone.
    fn is_features(&self, layer: &Layer) -> bool {
        let names = FEATURES.iter().find(|(style, _)| *style == self.manner.style.name()).map_or(&[][..], |(_, names)| names);
        names.contains(&layer.name.as_str())
    }

    fn nothing(&self) -> Failure {
        self.undrawn(&StyleError::NothingToDraw("no pen has anything to draw".to_owned()))
    }

    /// The settings without black areas, which would hide the other pens.
    fn without_solids(&self, settings: &Settings, portrait: &Portrait) -> Result<Settings, Failure> {
        let style = self.manner.style;
        let mut given = self.given().to_vec();
        for (key, value) in SOLID {
            // Without regions there are no strokes in them.
            let has_effect =
                |parameter: &Parameter| key != "parts" || parameter.needs.iter().all(|need| need.is_met(settings, portrait));
            if style.parameters().iter().any(|parameter| parameter.name == key && has_effect(parameter))
                && !given.iter().any(|(known, _)| known == key)
            {
                given.push((key.to_owned(), value.to_owned()));
            }
        }
        if let Some(pitch) = settings.pitch() {
            for (_, key, pitches) in SIZES.into_iter().filter(|(of, ..)| *of == style.name()) {
                let has_effect = key != LINE_WIDTH || !portrait.masks.contains_key(&MaskRole::Edges);
                if has_effect && !given.iter().any(|(known, _)| known == key) {
                    given.push((key.to_owned(), (pitches * pitch).to_string()));
                }
            }
            given.push(("pitch".to_owned(), pitch.to_string()));
        }
        Ok(Settings::resolve(style.name(), style.parameters(), &given)?)
    }
}

/// Of a drawing that is made beside another one, whose steps are shown.
struct Beside<'a>(&'a dyn Observer);

impl Observer for Beside<'_> {
    fn begin(&self, _: &str) {}
    fn progress(&self, _: f64) {}
    fn picture(&self, _: &str, _: &dyn Fn() -> Picture) {}
    fn warn(&self, message: &str) {
        self.0.warn(message);
    }
    fn want_mask(&self, role: MaskRole, message: &str) {
        self.0.want_mask(role, message);
    }
    fn is_interrupted(&self) -> bool {
        self.0.is_interrupted()
    }
}

/// The direction of a pen's lines in degrees: turned evenly, but no three of them by 60 degrees. The frequencies of three such sets
/// cancel, and where form bends the lines a little, the rest is a coarse moire. Three sets 36 degrees apart have no sum or difference,
/// of two or of all, below 0.6 of their frequency.
fn angle(pen: usize, pens: usize) -> f64 {
    let directions = match pens {
        3 => 5,
        6 => 7,
        other => other,
    };
    FIRST_ANGLE + 180.0 * pen as f64 / directions as f64
}

/// The tone of what lies beside one another and, where that is not enough, of as much that lies over it.
fn rounds(ink: &Raster<f32>) -> Vec<Raster<f32>> {
    let over = ink.map(|ink| ((ink - MOST_BESIDE) * RISE).clamp(0.0, 0.5 * ink));
    let most = over.pixels().iter().copied().fold(0.0, f32::max);
    let first = ink.zip_map(&over, |ink, over| 1.0 - (ink - over));
    if most < LEAST_SECOND { vec![first] } else { vec![first, over.map(|ink| 1.0 - ink)] }
}

/// The ink of all pens.
fn total(coverages: &[Raster<f32>]) -> Raster<f32> {
    let mut sum = coverages[0].clone();
    for pen in &coverages[1..] {
        sum = sum.zip_map(pen, |a, b| a + b);
    }
    sum
}

/// A mark with the shares of the pens where it lies.
fn candidate(mark: &Mark, portrait: &Portrait, coverages: &[Raster<f32>], round: u8) -> Candidate {
    let at = middle(mark);
    let place = portrait.placement.to_grid(at);
    let inks: Vec<f32> = coverages.iter().map(|pen| pen.sample(place.x, place.y).max(0.0)).collect();
    let sum: f32 = inks.iter().sum();
    let even = 1.0 / inks.len() as f32;
    let shares = inks.iter().map(|ink| if sum > 0.0 { ink / sum } else { even }).collect();
    Candidate { at, ink: mark.area().max(1e-6), shares, round }
}

/// Where a mark lies.
fn middle(mark: &Mark) -> Point {
    match mark {
        Mark::Dot(dot) => dot.centre,
        _ => mark.bounding_box().center(),
    }
}
