//! What machines understand: one folder per language, with its dialect (a table of a profile), its writer, its reader and its resuming.
//!
//! A new language is a folder here, a variant of [`Language`] and of [`Dialect`], and the profiles that speak it.

mod gcode;
mod hpgl;
mod replayed;
mod stop;
mod svg;

pub use gcode::{Comment, GcodeDialect, GcodeError, Height, Lift, Protocol, Travel};
#[cfg(feature = "drive")]
pub(crate) use gcode::{word, words};
#[cfg(feature = "drive")]
pub(crate) use hpgl::is_instruction;
pub use hpgl::{HpglDialect, HpglError};
pub use replayed::{Act, Replayed};
pub use stop::{ResumeError, StopPlace};
pub(super) use svg::write_picture;
pub use svg::{PenLift, SvgDialect};

use super::{Mounting, Plot, Profile};
use crate::geometry::Point;
use crate::read::Budget;
use crate::write::SvgHead;
use serde::Deserialize;
use std::io;
use thiserror::Error;

/// A machine's language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Language {
    /// HP-GL.
    Hpgl,
    /// G-code.
    Gcode,
    /// SVG, for the plotter's own program.
    Svg,
}

impl Language {
    /// Every language.
    pub const ALL: [Self; 3] = [Self::Hpgl, Self::Gcode, Self::Svg];

    /// Its name in a profile, where its table bears the same.
    pub const fn key(self) -> &'static str {
        match self {
            Self::Hpgl => "hpgl",
            Self::Gcode => "gcode",
            Self::Svg => "svg",
        }
    }

    /// Its name in prose.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Hpgl => "HP-GL",
            Self::Gcode => "G-code",
            Self::Svg => "SVG",
        }
    }

    /// Endings of its files' names, the usual one first.
    pub const fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Hpgl => &["hpgl", "plt"],
            Self::Gcode => &["gcode", "nc", "ngc"],
            Self::Svg => &["svg", "svgz"],
        }
    }

    /// The language that a file begins in, if it is one of these.
    pub fn of_text(text: &str) -> Option<Self> {
        let start = text.trim_start_matches(['\u{feff}', ' ', '\n', '\r', '\t']);
        let begins = |language: &Self| match language {
            Self::Hpgl => hpgl::begins(start),
            Self::Gcode => gcode::begins(start),
            Self::Svg => svg::begins(start),
        };
        Self::ALL.into_iter().find(begins)
    }

    /// The rest of a file that a machine did not finish, safe to start in the middle: state, pen and position are restored, and the
    /// last `again` millimetres drawn again.
    pub fn resume(self, text: &str, stop: StopPlace, again: f64) -> Result<String, ResumeError> {
        match self {
            Self::Hpgl => hpgl::resume(text, stop, again),
            Self::Gcode => gcode::resume(text, stop, again),
            Self::Svg => Err(ResumeError::OwnProgram),
        }
    }
}

/// How one machine speaks its language.
// A profile has one of them.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Dialect {
    /// HP-GL.
    Hpgl(HpglDialect),
    /// G-code.
    Gcode(GcodeDialect),
    /// SVG.
    Svg(SvgDialect),
}

impl Dialect {
    pub(super) fn speech(&self) -> &dyn Speech {
        match self {
            Self::Hpgl(dialect) => dialect,
            Self::Gcode(dialect) => dialect,
            Self::Svg(dialect) => dialect,
        }
    }

    pub(super) fn speech_mut(&mut self) -> &mut dyn Speech {
        match self {
            Self::Hpgl(dialect) => dialect,
            Self::Gcode(dialect) => dialect,
            Self::Svg(dialect) => dialect,
        }
    }
}

/// What a machine can be told in its dialect. The defaults are a language without a word for the thing.
pub(crate) trait Speech {
    /// The language.
    fn language(&self) -> Language;
    /// Refuses values that the machine cannot use.
    fn check(&self) -> Result<(), Refusal>;
    /// The nearest speed that can be said, mm/s; `limit` is the machine's greatest drawing speed. A language without a word for speed
    /// keeps what is wanted.
    fn nearest_speed(&self, wanted: f64, _limit: f64) -> f64 {
        wanted
    }
    /// True if the machine can wait for its user.
    fn can_pause(&self) -> bool {
        false
    }
    /// True if the machine can wait for a time.
    fn can_dwell(&self) -> bool {
        false
    }
    /// True if a layer can have a pause or a delay of its own.
    fn has_layer_handling(&self) -> bool {
        true
    }
    /// True if the file itself traces a frame; else the plotter's own program does.
    fn traces_frame(&self) -> bool {
        true
    }
    /// True if the file lifts the pen at its start and parks it for each change.
    fn parks_for_pens(&self) -> bool {
        false
    }
    /// True if the controller cuts arcs into chords, which takes time of its own.
    fn sends_arcs(&self) -> bool {
        false
    }
    /// True if no line of a file waits for the pen: lifting and lowering take the profile's times.
    fn pen_takes_time(&self) -> bool {
        false
    }
    /// Places per machine unit in the file.
    fn places_per_unit(&self) -> f64 {
        1.0
    }
    /// The pen's heights, where the z axis lifts it.
    fn height(&self) -> Option<Height> {
        None
    }
    /// What lifting or lowering the pen makes the machine do.
    fn pen_actions(&self, _pen: PenMove) -> Vec<PenAction> {
        vec![PenAction::Rest]
    }
    /// Where the pen waits at the end, in machine units; else at the far corner of its reach.
    fn park(&self) -> Option<[f64; 2]> {
        None
    }
    /// True if the plotter's program turns a portrait page onto the machine's long side.
    fn turns_portrait(&self) -> bool {
        false
    }
    /// Millimetres per second of one percent in a layer's label, where the plotter's program reads it.
    fn speed_of_percent(&self) -> Option<f64> {
        None
    }
    /// Makes moves with the pen up run at the profile's speed, not at the machine's greatest.
    fn feed_travel(&mut self) {}
    /// Writes a checked plot.
    fn write(&self, orders: &Orders<'_>, out: &mut dyn io::Write) -> io::Result<()>;
    /// What each line of a file makes the machine do; `rate` is the drawing speed at its start in machine units per minute, `per_mm`
    /// the machine units per millimetre. `None` if the file is a drawing.
    fn replay<'a>(&self, _text: &'a str, _rate: f64, _per_mm: f64) -> Option<Vec<Replayed<'a>>> {
        None
    }
    /// Reads a file as the motion that it orders.
    fn read(&self, text: &str, lightest: Option<f64>, budget: &mut Budget) -> Result<Strokes, MotionError>;
}

/// What is written for a machine.
#[derive(Clone, Copy)]
pub(crate) struct Orders<'a> {
    pub plot: &'a Plot,
    pub profile: &'a Profile,
    pub mounting: &'a Mounting,
    /// What stands at the head of an SVG.
    pub head: &'a SvgHead,
}

/// Which way the pen goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PenMove {
    Up,
    Down,
}

/// One part of a command that moves the pen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum PenAction {
    /// The motion comes to rest: a servo, a spindle, whatever is not a move.
    Rest,
    /// A wait of its own, in seconds.
    Wait(f64),
    /// A move, such as a Z axis's.
    Move {
        /// Where to, in machine units; an axis without a word stays.
        target: [Option<f64>; 3],
        /// How fast.
        rate: Rate,
    },
}

/// How fast a pen command moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Rate {
    /// As fast as the axes go.
    Greatest,
    /// Machine units per second.
    Given(f64),
    /// As the last drawn line.
    Last,
}

/// A key of a profile and what is wrong with its value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Refusal {
    pub key: String,
    pub problem: String,
}

impl Refusal {
    pub(super) fn new(key: &str, problem: &str) -> Self {
        Self { key: key.to_owned(), problem: problem.to_owned() }
    }
}

/// The motion that a machine's file orders, in machine units.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Strokes {
    /// Each pen-down path with its pen's number; a single point is a touch.
    pub paths: Vec<(u32, Vec<Point>)>,
    /// Every place that the carriage visits, pen up or down, in order.
    pub visited: Vec<Point>,
    /// Pauses for the user.
    pub pauses: usize,
    /// True if the pen is up at the end.
    pub ends_up: bool,
}

impl Strokes {
    /// The carriage goes to a place, along the last path if the pen is down.
    fn visit(&mut self, to: Point, is_down: bool) {
        self.visited.push(to);
        if let Some((_, path)) = self.paths.last_mut().filter(|_| is_down) {
            path.push(to);
        }
    }
}

/// Why a machine's file could not be read.
#[derive(Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MotionError {
    /// G-code.
    #[error(transparent)]
    Gcode(#[from] GcodeError),
    /// HP-GL.
    #[error(transparent)]
    Hpgl(#[from] HpglError),
    /// An SVG, which is a drawing.
    #[error("SVG is read as a drawing, not as motion")]
    Drawing,
}

/// A plot's file for a machine.
#[cfg(test)]
pub(in crate::plot) fn written(plot: &Plot, profile: &Profile) -> String {
    let (mounting, head) = (super::mount(profile, &plot.page).unwrap(), SvgHead::default());
    let mut bytes = Vec::new();
    profile.speech().write(&Orders { plot, profile, mounting: &mounting, head: &head }, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}
