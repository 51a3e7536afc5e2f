//! Machine profiles: `plot-profiles/*.toml`, compiled in, or a user's file whose keys override those of a built-in one.

mod check;
mod document;
mod error;
mod motion;
mod paper;
mod pens;

pub(super) use check::{above_zero, are_near};
pub use error::{KeyPlace, ProfileError};
pub use motion::{Limits, Motion, Planner};
pub use paper::{Area, Axes, Corner, Paper, Way};
pub use pens::{PenChange, PenSlot, Pens, Swell};

use super::language::{Dialect, Height, Language, MotionError, Speech, Strokes};
use crate::read::Budget;
use document::Document;
use include_dir::{Dir, include_dir};
use serde::Deserialize;

static BUILT_IN: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/plot-profiles");
/// Maximum depth of `extends`; a deeper chain is a cycle.
const DEEPEST: usize = 8;

/// How a machine is connected to a computer.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Link {
    /// Bits per second of its serial line. Default: 115200, for HP-GL 9600.
    pub baud: Option<u32>,
}

/// One machine.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// Its name on the command line.
    pub name: String,
    /// One line for a list.
    pub description: String,
    /// Machine units per millimetre.
    #[doc(hidden)]
    pub units_per_mm: f64,
    /// Correction factor for lengths along x, from calibration.
    #[serde(default = "one")]
    #[doc(hidden)]
    pub scale_x: f64,
    /// Correction factor for lengths along y.
    #[serde(default = "one")]
    #[doc(hidden)]
    pub scale_y: f64,
    /// How its axes run, and where zero is.
    #[serde(default)]
    #[doc(hidden)]
    pub axes: Axes,
    /// Sheets that the machine knows.
    #[serde(default)]
    #[doc(hidden)]
    pub paper: Vec<Paper>,
    /// The machine's reach, in machine units, for pages that match none of those sheets.
    #[doc(hidden)]
    pub area: Option<Area>,
    /// Its pens.
    #[doc(hidden)]
    pub pens: Pens,
    /// Calibration results by pen.
    #[serde(default)]
    #[doc(hidden)]
    pub pen: Vec<PenSlot>,
    /// Speeds and times.
    #[doc(hidden)]
    pub motion: Motion,
    /// How it is connected.
    #[serde(default)]
    #[doc(hidden)]
    pub link: Link,
    /// The pen's height for each width of line.
    #[doc(hidden)]
    pub swell: Option<Swell>,
    /// What it understands, and how: the table named after the file's `language`.
    #[doc(hidden)]
    pub dialect: Dialect,
}

const fn one() -> f64 {
    1.0
}

impl Profile {
    /// Reads a profile from TOML. `name` identifies it in messages.
    pub fn parse(name: &str, text: &str) -> Result<Self, ProfileError> {
        Self::parse_with(name, text, &[])
    }

    /// Reads a profile from TOML and overrides keys, such as `motion.draw_speed` with `30`.
    pub fn parse_with(name: &str, text: &str, set: &[(String, String)]) -> Result<Self, ProfileError> {
        let mut document = Document::default();
        read_chain(&mut document, name, text, DEEPEST)?;
        for (key, value) in set {
            document.set_option(key, value);
        }
        document.choose_language(name)?;
        let profile: Self = document.resolve(name)?;
        profile.check().map_err(|refusal| ProfileError::Value {
            place: document.place_of(&refusal.key).unwrap_or_else(|| KeyPlace::File(name.to_owned())),
            key: refusal.key,
            problem: refusal.problem,
        })?;
        Ok(profile)
    }

    /// A profile that is compiled in.
    pub fn built_in(name: &str) -> Result<Self, ProfileError> {
        Self::parse(name, built_in(name)?)
    }

    /// Offset of a slot's ink from its nominal place, in millimetres along the machine's axes.
    pub fn offset_of(&self, slot: u32) -> [f64; 2] {
        self.pen.iter().find(|pen| pen.slot == slot).map_or([0.0; 2], |pen| pen.offset)
    }

    /// The language that its machine understands.
    pub fn language(&self) -> Language {
        self.speech().language()
    }

    /// Reads one of its machine's files as the motion that it orders.
    pub fn read(&self, text: &str, budget: &mut Budget) -> Result<Strokes, MotionError> {
        self.speech().read(text, self.lightest(), budget)
    }

    /// What its machine can be told.
    pub(crate) fn speech(&self) -> &dyn Speech {
        self.dialect.speech()
    }

    /// The pen's heights in machine units, where the z axis lifts it.
    pub fn height(&self) -> Option<Height> {
        self.speech().height()
    }

    /// The z, in machine units, of the lightest touch of a pen on the z axis: lowered, or at the least width that it swells from.
    pub fn lightest(&self) -> Option<f64> {
        let height = self.height()?;
        let swelling = self.swell.iter().flat_map(|swell| &swell.table).map(|row| row[1]);
        swelling.chain([height.down]).min_by(|a, b| (a - height.up).abs().total_cmp(&(b - height.up).abs()))
    }

    /// The line that lifts the pen and the one that lowers it, where a line of G-code does.
    pub fn pen_commands(&self) -> Option<[String; 2]> {
        let Dialect::Gcode(gcode) = &self.dialect else { return None };
        match (self.height(), &gcode.pen_up, &gcode.pen_down) {
            (Some(height), ..) => {
                Some([format!("G0 Z{}", height.up), format!("G1 Z{} F{:.0}", height.down, height.plunge_speed * 60.0)])
            }
            (None, Some(up), Some(down)) => Some([up.clone(), down.clone()]),
            _ => None,
        }
    }

    /// The line of G-code that waits for a time.
    pub fn wait_command(&self, seconds: f64) -> Option<String> {
        let Dialect::Gcode(gcode) = &self.dialect else { return None };
        (seconds > 0.0).then(|| gcode.wait(seconds))
    }

    /// The drawing speed in mm/s nearest to the one wanted that its language can say.
    pub fn nearest_speed(&self, wanted: f64) -> f64 {
        self.speech().nearest_speed(wanted, self.motion.draw_speed_limit.unwrap_or(self.motion.draw_speed))
    }

    /// True if a file can make its machine wait for its user.
    pub fn can_pause(&self) -> bool {
        self.speech().can_pause()
    }

    /// True if its machine can wait for a time.
    pub fn can_dwell(&self) -> bool {
        self.speech().can_dwell()
    }

    /// Millimetres per second of one percent in a layer's label, where the plotter's own program reads it.
    pub fn speed_of_percent(&self) -> Option<f64> {
        self.speech().speed_of_percent()
    }

    /// Makes moves with the pen up run at `motion.travel_speed`, not at the machine's own greatest.
    pub fn feed_travel(&mut self) {
        self.dialect.speech_mut().feed_travel();
    }

    /// Metres that the pen in a slot draws before it wears out, if known.
    pub fn life_of(&self, slot: u32) -> Option<f64> {
        self.pen.iter().find(|pen| pen.slot == slot).and_then(|pen| pen.pen_life).or(self.pens.pen_life)
    }
}

/// Reads the profile's base, then the profile's own keys over it.
fn read_chain(document: &mut Document, name: &str, text: &str, depth: usize) -> Result<(), ProfileError> {
    let mut own = Document::default();
    if let Some(base) = own.read(name, text)? {
        if depth == 0 {
            return Err(ProfileError::Syntax { place: KeyPlace::File(name.to_owned()), message: "extends itself".to_owned() });
        }
        read_chain(document, &base, built_in(&base)?, depth - 1)?;
    }
    document.read(name, text).map(|_| ())
}

/// Names of the profiles that are compiled in, sorted.
pub fn built_in_names() -> Vec<&'static str> {
    let mut names: Vec<&str> = BUILT_IN.files().filter_map(|f| f.path().file_stem()?.to_str()).collect();
    names.sort_unstable();
    names
}

/// The TOML of a profile that is compiled in.
pub fn built_in(name: &str) -> Result<&'static str, ProfileError> {
    BUILT_IN
        .get_file(format!("{name}.toml"))
        .and_then(include_dir::File::contents_utf8)
        .ok_or_else(|| ProfileError::Unknown { name: name.to_owned(), known: built_in_names().join(", ") })
}

#[cfg(test)]
mod tests;
