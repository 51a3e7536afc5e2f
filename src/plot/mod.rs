//! Plotting: from a [`Drawing`](crate::drawing::Drawing) to ordered tool paths for one machine.
//!
//! Input: marks with their ink. Output: a [`Plot`], the polylines that one nib per pen draws, in the page's millimetres. A
//! [`Mounting`] places the page on a machine. Nothing here depends on styles or fields.

mod budget;
mod calibration;
mod coverage;
mod drawn;
mod drying;
mod extras;
mod inkml;
mod job;
mod joining;
mod language;
mod lower;
mod mounting;
mod occlude;
mod ordering;
mod preview;
mod profile;
mod proof;
mod report;
mod seam;
mod time;
mod toolpath;

#[doc(hidden)]
pub use budget::{TooMuch, check_work};
#[doc(hidden)]
pub use calibration::{Calibration, CalibrationError, calibration_page, calibration_sheet};
#[doc(hidden)]
pub use coverage::{Coverage, coverage};
#[doc(hidden)]
pub use drying::delay_for_drying;
#[doc(hidden)]
pub use extras::{add_registration, add_touch_rests, pause_every};
pub use inkml::write_inkml;
#[doc(hidden)]
pub use job::home_of;
pub use job::{Cut, Job, JobError, JobOptions, MachineFeature, PlacingMarks, ReachPolicy};
#[doc(hidden)]
pub use joining::{chain, drop_duplicates};
#[doc(hidden)]
pub use language::{Act, Replayed};
#[doc(hidden)]
pub use language::{Comment, Dialect, GcodeDialect, Height, HpglDialect, Lift, PenLift, Protocol, SvgDialect, Travel};
pub use language::{GcodeError, HpglError, Language, MotionError, ResumeError, StopPlace, Strokes};
#[cfg(feature = "drive")]
pub(crate) use language::{is_instruction, word, words};
pub use lower::{InkModel, Nibs, lower};
pub use mounting::MountingError;
#[doc(hidden)]
pub use mounting::{Mounting, Room, Turn, clip_to, mount};
#[doc(hidden)]
pub use occlude::occluded_where;
pub use occlude::{Hides, occluded};
pub use ordering::{Course, DrawingCorner, Duplicates, Sequence};
pub use preview::ShownTravel;
#[doc(hidden)]
pub use profile::{Area, Axes, Corner, Limits, Link, Motion, Paper, PenChange, PenSlot, Pens, Planner, Swell, Way};
pub use profile::{KeyPlace, Profile, ProfileError, built_in, built_in_names};
#[doc(hidden)]
pub use report::report;
pub use report::{PenReport, PlotReport};
pub use seam::Seam;
#[doc(hidden)]
pub use time::{PenTime, clock, line_times, replayed};
pub use toolpath::Toolpath;

use crate::drawing::{Colour, Handling, Page};

/// Tool paths in drawing order.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// The sheet.
    pub page: Page,
    /// Pens in order of use.
    pub pens: Vec<PenPaths>,
}

/// What one pen draws.
#[derive(Clone, Debug, PartialEq)]
pub struct PenPaths {
    /// The pen's number, from 1.
    pub number: u32,
    /// What it draws, such as `dots`.
    pub name: String,
    /// The ink's colour, for previews.
    pub colour: Colour,
    /// The nib's width in millimetres.
    pub nib: f64,
    /// Pause, speed and delay set by its layer.
    pub handling: Handling,
    /// Paths in drawing order.
    pub paths: Vec<Toolpath>,
}
