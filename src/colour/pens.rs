//! Pens as inks on a paper, checked.

use super::bands::{smoothest, xyz_of};
use super::space::{D65, Lab, rgb_to_xyz, srgb_to_linear};
use crate::drawing::Colour;
use crate::elementary::Elementary as _;
use thiserror::Error;

/// Most pens at once: with 8 there are 256 overprints.
pub const MOST_PENS: usize = 8;
/// Pens less different than this (CIEDE2000) do one pen's work; an ink less different from the paper does none.
const ALIKE: f64 = 4.0;
/// Without a pen darker than this L\*, relative to the paper's white, black stays grey.
const DARK: f64 = 45.0;
/// A black's chroma in L\*a\*b\*.
const NEUTRAL: f64 = 18.0;
/// A transparent ink reflects no more than its paper; above it by more than this share of white, one of the two was misread.
const MISREAD: f64 = 0.03;
/// A colour this far (CIEDE2000) from what any ink reflects is a slip of the pen; fluorescent inks go a little beyond.
const IMPOSSIBLE: f64 = 5.0;

/// What an ink does to what lies below it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Opacity {
    /// It filters the light: ink on ink multiplies. Fine-liners, most gel and ball pens.
    #[default]
    Transparent,
    /// It covers: white gel, paint markers.
    Opaque,
}

/// A pen: a width and the colour of its ink.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourPen {
    /// Its name, in errors and reports.
    pub name: String,
    /// Width of its line in mm, above 0.
    pub width_mm: f64,
    /// Colour of an area fully covered by it, on the paper in use: linear sRGB, where 1 is a perfect white. Saturated inks leave 0
    /// to 1.
    pub colour: [f64; 3],
    /// Whether it covers what lies below.
    pub opacity: Opacity,
}

impl ColourPen {
    /// A transparent pen by its colour on screen.
    pub fn new(name: impl Into<String>, width_mm: f64, colour: Colour) -> Self {
        Self { name: name.into(), width_mm, colour: light_of(colour), opacity: Opacity::Transparent }
    }

    /// A transparent pen by its measured colour: L\*a\*b\* under D65.
    pub fn measured(name: impl Into<String>, width_mm: f64, lab: Lab) -> Self {
        Self { name: name.into(), width_mm, colour: lab.to_rgb(), opacity: Opacity::Transparent }
    }

    /// The same pen with an ink that covers what lies below.
    #[must_use]
    pub fn opaque(self) -> Self {
        Self { opacity: Opacity::Opaque, ..self }
    }

    /// Its colour in L\*a\*b\* under D65.
    pub fn lab(&self) -> Lab {
        Lab::from_rgb(self.colour)
    }
}

/// A sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paper {
    /// Its colour: linear sRGB, where 1 is a perfect white.
    pub colour: [f64; 3],
}

impl Paper {
    /// White on screen.
    pub const WHITE: Self = Self { colour: [1.0; 3] };

    /// A sheet by its colour on screen.
    pub fn new(colour: Colour) -> Self {
        Self { colour: light_of(colour) }
    }

    /// A sheet by its measured colour: L\*a\*b\* under D65.
    pub fn measured(lab: Lab) -> Self {
        Self { colour: lab.to_rgb() }
    }
}

/// The measured colour of several pens on one another, each covering fully, drawn in the set's order.
#[derive(Clone, Debug, PartialEq)]
pub struct Overprint {
    /// Indices of the pens.
    pub pens: Vec<usize>,
    /// Its colour: linear sRGB, where 1 is a perfect white.
    pub colour: [f64; 3],
}

/// Why pens cannot be used together.
#[derive(Debug, Error, PartialEq)]
pub enum PensError {
    /// No pens.
    #[error("there are no pens; name at least one, with its width and colour")]
    None,
    /// More pens than overprints can be kept of.
    #[error(
        "{0} pens are too many; at most {MOST_PENS} are used together: leave some out, or let the best for the picture be chosen"
    )]
    TooMany(usize),
    /// A number that is none, or out of range.
    #[error("{0}: its colour is not a number in each channel between -1 and 2; measure it again, or give a CSS colour")]
    Colour(String),
    /// Not a width.
    #[error("{0}: a width of {1} mm is none; give the width of its line, such as 0.3")]
    Width(String, f64),
    /// Two pens of one colour.
    #[error("{0} and {1} look alike on this paper (difference {2:.1}, {ALIKE} is needed); leave one out, or measure them again")]
    Alike(String, String, f64),
    /// A pen that nobody would see.
    #[error(
        "{0} can hardly be seen on this paper (difference {1:.1}, {ALIKE} is needed); leave it out, or draw on another paper"
    )]
    Unseen(String, f64),
    /// A transparent ink that is brighter than the paper.
    #[error(
        "{0} cannot have this colour on this paper: it has more {1} light than the paper, and a transparent ink only takes light away; \
         call it opaque, or measure the pen and the paper again"
    )]
    BrighterThanPaper(String, &'static str),
    /// A colour that nothing reflects.
    #[error(
        "{0} cannot have this colour: nothing reflects so much light and is so vivid; check the order and the signs of its L*, a*, b*, \
         or measure it again"
    )]
    Impossible(String),
    /// A paper that is no paper.
    #[error("the paper's colour must be between black and white, and lighter than black; got {0:?} in linear light")]
    Paper([f64; 3]),
    /// A measured overprint of pens that are not there.
    #[error("a measured overprint names pen {0}, but there are {1} pens")]
    Overprint(usize, usize),
}

/// What pens will not do, though they can be used.
#[derive(Debug, Error, PartialEq)]
pub enum PensWarning {
    /// No dark pen.
    #[error("no pen is dark: the darkest, {0}, has L* {1:.0}; shadows will be pale. Add a black or a dark blue or brown")]
    NoDark(String, f64),
}

/// Pens that are used together on one paper, in drawing order: the first lies lowest.
#[derive(Clone, Debug, PartialEq)]
pub struct PenSet {
    pens: Vec<ColourPen>,
    paper: Paper,
    overprints: Vec<Overprint>,
}

impl PenSet {
    /// Checks pens, in drawing order, on a paper; overprints may be measured in part, or not at all.
    pub fn new(pens: Vec<ColourPen>, paper: Paper, overprints: Vec<Overprint>) -> Result<Self, PensError> {
        if pens.is_empty() {
            return Err(PensError::None);
        }
        if pens.len() > MOST_PENS {
            return Err(PensError::TooMany(pens.len()));
        }
        let is_paper = paper.colour.iter().all(|v| (0.0..=1.1).contains(v)) && paper.colour.iter().any(|v| *v > 0.01);
        if !is_paper {
            return Err(PensError::Paper(paper.colour));
        }
        pens.iter().try_for_each(|pen| checked(pen, paper))?;
        for (i, one) in pens.iter().enumerate() {
            for two in &pens[i + 1..] {
                let off = difference_on(one.colour, two.colour, paper);
                if off < ALIKE {
                    return Err(PensError::Alike(one.name.clone(), two.name.clone(), off));
                }
            }
        }
        for overprint in &overprints {
            if let Some(pen) = overprint.pens.iter().find(|pen| **pen >= pens.len()) {
                return Err(PensError::Overprint(*pen, pens.len()));
            }
            if !is_colour(overprint.colour) {
                return Err(PensError::Colour("a measured overprint".to_owned()));
            }
        }
        Ok(Self { pens, paper, overprints })
    }

    /// The pens in drawing order.
    pub fn pens(&self) -> &[ColourPen] {
        &self.pens
    }

    /// The paper.
    pub fn paper(&self) -> Paper {
        self.paper
    }

    /// Measured overprints.
    pub fn overprints(&self) -> &[Overprint] {
        &self.overprints
    }

    /// What these pens will not do.
    pub fn warnings(&self) -> Vec<PensWarning> {
        let darkest = self.pens.iter().map(|pen| (pen, self.lab(pen).l)).min_by(|a, b| a.1.total_cmp(&b.1));
        let pale = darkest.filter(|(_, l)| *l > DARK);
        pale.map(|(pen, l)| PensWarning::NoDark(pen.name.clone(), l)).into_iter().collect()
    }

    /// The black pen: the darkest that is dark and nearly neutral.
    pub fn black(&self) -> Option<usize> {
        let labs = self.pens.iter().map(|pen| self.lab(pen)).enumerate();
        let black = labs.filter(|(_, lab)| lab.l < DARK && lab.a.hypotenuse(lab.b) < NEUTRAL);
        black.min_by(|(_, one), (_, two)| one.l.total_cmp(&two.l)).map(|(i, _)| i)
    }

    /// A pen's colour beside the paper's white.
    fn lab(&self, pen: &ColourPen) -> Lab {
        Lab::from_xyz(rgb_to_xyz(pen.colour), white_of(self.paper))
    }
}

/// The order in which pens are drawn: light before dark, so that no nib carries dark ink into a light one; covering inks last.
pub fn drawing_order(pens: &[ColourPen]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..pens.len()).collect();
    let key = |i: usize| (pens[i].opacity == Opacity::Opaque, -pens[i].lab().l);
    order.sort_by(|a, b| {
        let ((a_covers, a), (b_covers, b)) = (key(*a), key(*b));
        a_covers.cmp(&b_covers).then(a.total_cmp(&b))
    });
    order
}

/// XYZ that looks white beside this paper: the paper's hue, but not darker than a light grey.
fn white_of(paper: Paper) -> [f64; 3] {
    let xyz = rgb_to_xyz(paper.colour);
    if xyz.iter().all(|v| *v > 0.3) { xyz } else { D65 }
}

fn difference_on(one: [f64; 3], two: [f64; 3], paper: Paper) -> f64 {
    let white = white_of(paper);
    Lab::from_xyz(rgb_to_xyz(one), white).difference(Lab::from_xyz(rgb_to_xyz(two), white))
}

fn is_colour(colour: [f64; 3]) -> bool {
    colour.iter().all(|v| (-1.0..=2.0).contains(v))
}

fn checked(pen: &ColourPen, paper: Paper) -> Result<(), PensError> {
    if !is_colour(pen.colour) {
        return Err(PensError::Colour(pen.name.clone()));
    }
    if !(pen.width_mm.is_finite() && pen.width_mm > 0.0) {
        return Err(PensError::Width(pen.name.clone(), pen.width_mm));
    }
    let unseen = difference_on(pen.colour, paper.colour, paper);
    if unseen < ALIKE {
        return Err(PensError::Unseen(pen.name.clone(), unseen));
    }
    // In XYZ, whose curves are nowhere below 0: taking blue light away raises sRGB's red.
    let (ink, bare) = (rgb_to_xyz(pen.colour), rgb_to_xyz(paper.colour));
    let brighter = (0..3).find(|i| ink[*i] > bare[*i] + MISREAD);
    if let (Some(i), Opacity::Transparent) = (brighter, pen.opacity) {
        return Err(PensError::BrighterThanPaper(pen.name.clone(), ["red", "green", "blue"][i]));
    }
    let is_possible = Lab::from_xyz(ink, D65).difference(Lab::from_xyz(xyz_of(&smoothest(ink)), D65)) <= IMPOSSIBLE;
    if is_possible { Ok(()) } else { Err(PensError::Impossible(pen.name.clone())) }
}

/// Linear light of a colour on screen.
pub(super) fn light_of(colour: Colour) -> [f64; 3] {
    [colour.r, colour.g, colour.b].map(|v| srgb_to_linear(f64::from(v) / 255.0))
}

/// The nearest colour on screen.
pub fn on_screen(rgb: [f64; 3]) -> Colour {
    let [r, g, b] = rgb.map(|v| (super::space::linear_to_srgb(v.clamp(0.0, 1.0)) * 255.0).round() as u8);
    Colour { r, g, b }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pen(name: &str, css: &str) -> ColourPen {
        ColourPen::new(name, 0.3, css.parse().unwrap())
    }

    fn set(pens: Vec<ColourPen>) -> Result<PenSet, PensError> {
        PenSet::new(pens, Paper::new("#f4f1e8".parse().unwrap()), Vec::new())
    }

    fn told(pens: Vec<ColourPen>) -> String {
        set(pens).unwrap_err().to_string()
    }

    #[test]
    fn bad_pens_are_told_with_what_to_do() {
        assert_eq!(set(Vec::new()), Err(PensError::None));
        let grey = |i: usize| ColourPen { colour: [0.02 + 0.08 * i as f64; 3], ..pen(&format!("grey {i}"), "black") };
        assert_eq!(set((0..9).map(grey).collect()), Err(PensError::TooMany(9)));
        assert!(told(vec![pen("navy", "#1a2b5c"), pen("dark blue", "#1c2a5e")]).contains("navy and dark blue look alike"));
        assert!(told(vec![pen("ivory", "#f2eee4")]).contains("hardly be seen"));
        assert!(told(vec![pen("sky", "#e0f4ff")]).contains("more blue light than the paper"));
        assert!(set(vec![pen("sky", "#e0f4ff").opaque()]).is_ok());
        let bad = ColourPen { colour: [f64::NAN, 0.0, 0.0], ..pen("broken", "black") };
        assert!(told(vec![bad]).contains("broken: its colour is not a number"));
        assert!(told(vec![ColourPen { width_mm: 0.0, ..pen("thin", "black") }]).contains("give the width"));
        assert!(told(vec![ColourPen { width_mm: f64::INFINITY, ..pen("wide", "black") }]).contains("give the width"));
        let nowhere = Overprint { pens: vec![0, 3], colour: [0.1; 3] };
        assert_eq!(PenSet::new(vec![pen("k", "black")], Paper::WHITE, vec![nowhere]), Err(PensError::Overprint(3, 1)));
        let dark = Paper { colour: [0.0; 3] };
        assert_eq!(PenSet::new(vec![pen("k", "#222").opaque()], dark, Vec::new()), Err(PensError::Paper([0.0; 3])));
    }

    #[test]
    fn colours_that_nothing_reflects_are_told() {
        let measured = |l: f64, a: f64, b: f64| vec![ColourPen::measured("green", 0.3, Lab { l, a, b })];
        assert!(
            told(measured(50.0, -90.0, -60.0)).contains("check the order and the signs"),
            "{}",
            told(measured(50.0, -90.0, -60.0))
        );
        assert!(set(measured(60.0, -70.0, 30.0)).is_ok());
        // What a screen shows is possible.
        for css in ["lime", "yellow", "cyan", "magenta", "red", "blue"] {
            assert!(PenSet::new(vec![pen(css, css)], Paper::WHITE, Vec::new()).is_ok(), "{css}");
        }
    }

    #[test]
    fn saturated_inks_are_possible() {
        // Without blue light, yellow has more of sRGB's red than the paper.
        assert!(set(vec![ColourPen { colour: [0.95, 0.74, -0.02], ..pen("yellow", "yellow") }]).is_ok());
        assert!(set(vec![ColourPen { colour: [-0.08, 0.35, 0.72], ..pen("cyan", "cyan") }]).is_ok());
    }

    #[test]
    fn no_dark_pen_is_a_warning() {
        let pale = set(vec![pen("yellow", "#f0dc30"), pen("orange", "#f08030")]).unwrap();
        assert!(matches!(&pale.warnings()[..], [PensWarning::NoDark(name, l)] if name == "orange" && *l > 60.0));
        assert_eq!(pale.black(), None);
        let dark = set(vec![pen("yellow", "#f0dc30"), pen("navy", "#20306c"), pen("black", "#333")]).unwrap();
        assert!(dark.warnings().is_empty());
        assert_eq!(dark.black(), Some(2));
    }

    #[test]
    fn light_pens_are_drawn_first_and_covering_ones_last() {
        let pens = [pen("white", "white").opaque(), pen("black", "#222"), pen("yellow", "#f0dc30"), pen("red", "#d03030")];
        assert_eq!(drawing_order(&pens), [2, 3, 1, 0]);
    }
}
