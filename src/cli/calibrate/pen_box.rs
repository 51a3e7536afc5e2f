//! The pens of a colour sheet, in the order in which they are drawn there.

use crate::cli::arguments::CalibrateOptions;
use crate::cli::failure::Failure;
use crate::cli::messages::warning;
use crate::cli::output;
use crate::cli::palette::{numbers, pen_of};
use crate::cli::pen_file::{PenEntry, read_pens};
use crate::colour::{ColourPen, Paper, PenSet, PensError, drawing_order};

/// Most light that the pen of the marks may leave in the channel that it darkens most, relative to paper.
const MARKS: f64 = 0.5;

/// A file of pens.
pub(super) struct PenBox {
    pub file: String,
    pub text: String,
    /// Light pens first. The sheet numbers them from 1.
    pub pens: Vec<BoxedPen>,
    pub paper: Paper,
}

/// A pen of the box.
pub(super) struct BoxedPen {
    pub entry: PenEntry,
    /// As the file gives it.
    pub ink: ColourPen,
    /// Where the machine holds it.
    pub number: u32,
}

impl PenBox {
    pub(super) fn read(options: &CalibrateOptions, file: &str) -> Result<Self, Failure> {
        let paper = options.paper.map_or(Paper::WHITE, Paper::new);
        let text = output::read_settings(file)?;
        let entries = read_pens(file, &text)?;
        let ink = |entry: &PenEntry| {
            let ink = pen_of(entry, paper).map_err(|why| Failure::Work(format!("{file}: {why}; a guess will do")))?;
            Ok(ColourPen { width_mm: entry.width.unwrap_or(options.pen), ..ink })
        };
        let inks: Vec<ColourPen> = entries.iter().map(ink).collect::<Result<_, Failure>>()?;
        let order = drawing_order(&inks);
        let mut given: Vec<Option<(PenEntry, ColourPen)>> = entries.into_iter().zip(inks).map(Some).collect();
        let given: Vec<(PenEntry, ColourPen)> = order.into_iter().filter_map(|pen| given[pen].take()).collect();
        let numbers = numbers(given.iter().map(|(entry, _)| entry));
        let pens = given.into_iter().zip(numbers).map(|((entry, ink), number)| BoxedPen { entry, ink, number }).collect();
        Ok(Self { file: file.to_owned(), text, pens, paper })
    }

    /// Widths of the nibs in millimetres.
    pub(super) fn nibs(&self) -> Vec<f64> {
        self.pens.iter().map(|pen| pen.ink.width_mm).collect()
    }

    /// The pen of a number on the sheet, from 0.
    pub(super) fn name(&self, pen: usize) -> &str {
        self.pens.get(pen).map_or("", |pen| pen.ink.name.as_str())
    }

    /// The pens as they were numbered on the sheet, such as `1 yellow, 2 black`.
    pub(super) fn legend(&self) -> String {
        let pens = self.pens.iter().enumerate().map(|(i, pen)| format!("{} {}", i + 1, pen.ink.name));
        pens.collect::<Vec<_>>().join(", ")
    }

    /// Refuses pens of which no sheet can be drawn, or whose sheet could not be read; returns the pen that draws the marks.
    pub(super) fn checked(&self) -> Result<usize, Failure> {
        let about = |problem: &dyn std::fmt::Display| Failure::Work(format!("{}: {problem}", self.file));
        let inks: Vec<ColourPen> = self.pens.iter().map(|pen| pen.ink.clone()).collect();
        let doubts: Vec<String> = match PenSet::new(inks, self.paper, Vec::new()) {
            Ok(set) => set.warnings().iter().map(ToString::to_string).collect(),
            // The colours may be guesses; the sheet tells whether they are alike.
            Err(PensError::Alike(one, two, _)) => {
                vec![format!("{one} and {two} have nearly the same colour; the sheet will show whether one of them is enough")]
            }
            Err(error) => return Err(about(&error)),
        };
        for (i, pen) in self.pens.iter().enumerate() {
            if let Some(twin) = self.pens[..i].iter().find(|other| other.number == pen.number) {
                let (one, two, slot) = (&twin.ink.name, &pen.ink.name, pen.number);
                return Err(about(&format_args!("{one} and {two} are both in slot {slot}; give each pen a slot of its own")));
            }
        }
        let lightness = |i: &usize| self.pens[*i].ink.lab().l;
        let darkest = (0..self.pens.len()).min_by(|a, b| lightness(a).total_cmp(&lightness(b))).unwrap_or(0);
        let (ink, bare) = (self.pens[darkest].ink.colour, self.paper.colour);
        if !(0..3).any(|i| ink[i] < MARKS * bare[i]) {
            let name = self.name(darkest);
            return Err(about(&format_args!(
                "no pen is dark enough on this paper for the sheet's marks, by which a picture is read; the darkest is {name}: add a darker one"
            )));
        }
        doubts.iter().for_each(|told| warning!("{}: {told}", self.file));
        Ok(darkest)
    }

    /// Warns of slots in whose order a dark pen is drawn before a light one.
    pub(super) fn warn_of_order(&self) {
        let mut neighbours = self.pens.iter().zip(self.pens.iter().skip(1));
        if let Some((one, two)) = neighbours.find(|(one, two)| one.number > two.number) {
            warning!(
                "{}: {} (slot {}) is drawn before {} (slot {}), which is lighter or covers less; number the slots in the order {}, \
                 so that no nib carries dark ink into a light one",
                self.file,
                two.ink.name,
                two.number,
                one.ink.name,
                one.number,
                self.pens.iter().map(|pen| pen.ink.name.as_str()).collect::<Vec<_>>().join(", ")
            );
        }
    }
}
