//! Machines as data: `plot-profiles/*.toml`, compiled in, or a file of the user's.

use include_dir::{Dir, include_dir};
use serde::Deserialize;
use thiserror::Error;

static BUILT_IN: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/plot-profiles");

/// One machine.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// Its name on the command line.
    pub name: String,
    /// One line for a list.
    pub description: String,
    /// What it understands.
    pub language: Language,
    /// Machine units a millimetre.
    pub units_per_mm: f64,
    /// Sheets that the machine knows; without any, the page lies with its lower left corner at machine zero.
    #[serde(default)]
    pub paper: Vec<Paper>,
    /// The machine's reach where it knows no sheets, in machine units.
    pub area: Option<Area>,
    /// Its pens.
    pub pens: Pens,
    /// Speeds and times.
    pub motion: Motion,
    /// How G-code is written for it.
    pub gcode: Option<GcodeDialect>,
    /// How HP-GL is written for it.
    pub hpgl: Option<HpglDialect>,
}

/// A plotter's language.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Language {
    /// HP-GL.
    Hpgl,
    /// G-code.
    Gcode,
}

/// A sheet with its own hard clip.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Paper {
    /// The page's name, such as `a4`.
    pub name: String,
    /// Along the machine's x axis, in millimetres.
    pub width: f64,
    /// Along the machine's y axis, in millimetres.
    pub height: f64,
    /// Hard clip along x, in machine units.
    pub x: [f64; 2],
    /// Hard clip along y, in machine units.
    pub y: [f64; 2],
    /// Machine zero in millimetres from the sheet's upper left corner, x right, y down.
    pub zero: [f64; 2],
    /// What the machine is told to use this sheet.
    #[serde(default)]
    pub setup: String,
}

/// A reach without sheets, in machine units.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Area {
    /// Along x.
    pub x: [f64; 2],
    /// Along y, up.
    pub y: [f64; 2],
}

/// Pens and how they are changed.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Pens {
    /// How many the machine holds.
    pub count: u32,
    /// How it gets another.
    pub change: PenChange,
    /// Time that the machine itself takes to fetch one.
    #[serde(default)]
    pub change_seconds: f64,
}

/// How a pen is changed.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum PenChange {
    /// The machine takes it from its carousel.
    Machine,
    /// The file pauses, and the user changes it.
    Pause,
}

/// Speeds and times.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Pen down, mm/s.
    pub draw_speed: f64,
    /// The fastest that the machine can be told to draw, mm/s.
    pub draw_speed_limit: Option<f64>,
    /// Pen up, mm/s; where limits hold for each axis, the rate of x and of y (GRBL's `$110` and `$111`).
    pub travel_speed: f64,
    /// mm/s^2, along the path or for each axis as `planner.limits` says.
    pub acceleration: f64,
    /// mm/s^2 with the pen up, where it differs.
    pub travel_acceleration: Option<f64>,
    /// GRBL's `$11` in millimetres: how far a corner may be rounded in thought, which sets its speed.
    pub junction_deviation: Option<f64>,
    /// The same as the `AxiDraw`'s driver counts it: in 5000ths of an inch.
    pub corner_factor: Option<f64>,
    /// Time to lift the pen.
    pub pen_up_seconds: f64,
    /// Time to lower the pen.
    pub pen_down_seconds: f64,
    /// How far the machine looks ahead, and what its limits hold for.
    #[serde(default)]
    pub planner: Planner,
}

/// Millimetres of junction deviation for a corner factor of 1: the `AxiDraw`'s driver divides the factor by 5000 and takes inches.
const MM_PER_CORNER_FACTOR: f64 = 25.4 / 5000.0;

impl Motion {
    /// How far a corner may be rounded in thought, in millimetres.
    pub fn corner_deviation(&self) -> f64 {
        self.junction_deviation.or(self.corner_factor.map(|factor| factor * MM_PER_CORNER_FACTOR)).unwrap_or(0.0)
    }
}

/// How a controller plans its motion.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Planner {
    /// Places of the controller's look-ahead buffer, of which one stays free (GRBL: 16); without it, all is planned that lies
    /// between two stops.
    pub block_buffer: Option<usize>,
    /// What speed and acceleration are limits of.
    pub limits: Limits,
    /// Greatest rates of x, y and z, mm/s (GRBL's `$110` to `$112`); those of x and y are `travel_speed` or less.
    pub axis_speed: Option<[f64; 3]>,
    /// Accelerations of x, y and z, mm/s^2 (GRBL's `$120` to `$122`); without it, `acceleration`.
    pub axis_acceleration: Option<[f64; 3]>,
    /// Motor steps a millimetre of x, y and z (GRBL's `$100` to `$102`): places are rounded to them before they are planned.
    pub steps_per_mm: Option<[f64; 3]>,
    /// Waits last a whole number of these.
    pub dwell_step_seconds: f64,
}

/// What a machine's speed and acceleration are limits of.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Limits {
    /// The motion along the path, whatever its direction.
    #[default]
    Path,
    /// Each axis by itself, so that a diagonal is faster.
    Axis,
}

/// G-code for one machine.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct GcodeDialect {
    /// Comment lines at the top.
    #[serde(default)]
    pub header: Vec<String>,
    /// Lines before anything moves.
    pub start: Vec<String>,
    /// Lifts the pen.
    pub pen_up: String,
    /// Lowers the pen.
    pub pen_down: String,
    /// Where the pen waits at the end, in machine units.
    pub park: [f64; 2],
    /// Waits for the user.
    pub pause: String,
    /// Waits for a time; `{seconds}` or `{milliseconds}` is replaced.
    pub dwell: String,
    /// Greatest length of a line.
    pub line_length: usize,
}

/// HP-GL for one machine.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq)]
#[serde(deny_unknown_fields)]
pub struct HpglDialect {
    /// Greatest length of one instruction in bytes.
    pub chunk: usize,
}

/// Why a profile could not be used.
#[derive(Debug, Error, PartialEq)]
pub enum ProfileError {
    /// No such name.
    #[error("there is no plotter profile '{name}'; there are {known}, or give the path of a .toml file")]
    Unknown {
        /// What was asked for.
        name: String,
        /// All built-in names.
        known: String,
    },
    /// Not TOML, or a key or value that is not a profile's.
    #[error("{name}, line {line}: {message}")]
    Syntax {
        /// The profile's file or name.
        name: String,
        /// Line, from 1.
        line: usize,
        /// What is wrong there.
        message: String,
    },
    /// A value that cannot be.
    #[error("{name}: {key} {problem}")]
    Value {
        /// The profile's file or name.
        name: String,
        /// The key.
        key: &'static str,
        /// What is wrong with it.
        problem: String,
    },
}

impl Profile {
    /// Reads a profile from TOML; `name` stands in messages.
    pub fn parse(name: &str, text: &str) -> Result<Self, ProfileError> {
        let profile: Self = toml::from_str(text).map_err(|error| {
            let line = error.span().map_or(1, |span| text[..span.start.min(text.len())].matches('\n').count() + 1);
            ProfileError::Syntax { name: name.to_owned(), line, message: error.message().to_owned() }
        })?;
        profile.check(name)?;
        Ok(profile)
    }

    fn check(&self, name: &str) -> Result<(), ProfileError> {
        let refuse = |key, problem: &str| Err(ProfileError::Value { name: name.to_owned(), key, problem: problem.to_owned() });
        let positive = |value: f64| value.is_finite() && value > 0.0;
        let motion = &self.motion;
        if !positive(self.units_per_mm) {
            return refuse("units_per_mm", "must be above 0");
        }
        if self.paper.is_empty() == self.area.is_none() {
            return refuse("paper", "or area must be given, and not both");
        }
        for (key, value) in [
            ("motion.draw_speed", motion.draw_speed),
            ("motion.travel_speed", motion.travel_speed),
            ("motion.acceleration", motion.acceleration),
            ("motion.travel_acceleration", motion.travel_acceleration.unwrap_or(1.0)),
            ("motion.junction_deviation", motion.junction_deviation.unwrap_or(1.0)),
            ("motion.corner_factor", motion.corner_factor.unwrap_or(1.0)),
        ] {
            if !positive(value) {
                return refuse(key, "must be above 0");
            }
        }
        if motion.junction_deviation.is_some() == motion.corner_factor.is_some() {
            return refuse("motion.junction_deviation", "or motion.corner_factor must be given, and not both");
        }
        if motion.travel_acceleration.is_some() && motion.planner.limits == Limits::Axis {
            return refuse("motion.travel_acceleration", "cannot differ where limits are the axes' own");
        }
        motion.planner.check(refuse)?;
        if self.pens.count == 0 {
            return refuse("pens.count", "must be at least 1");
        }
        for (key, seconds) in [
            ("motion.pen_up_seconds", motion.pen_up_seconds),
            ("motion.pen_down_seconds", motion.pen_down_seconds),
            ("pens.change_seconds", self.pens.change_seconds),
        ] {
            if !(0.0..=60.0).contains(&seconds) {
                return refuse(key, "must be from 0 to 60 seconds");
            }
        }
        let ranges = self.paper.iter().flat_map(|p| [p.x, p.y]).chain(self.area.iter().flat_map(|a| [a.x, a.y]));
        if ranges.into_iter().any(|[low, high]| low.partial_cmp(&high) != Some(std::cmp::Ordering::Less)) {
            return refuse("x", "and y need their lower limit first");
        }
        if let Some(gcode) = &self.gcode {
            self.check_gcode(gcode, refuse)?;
        }
        if self.hpgl.as_ref().is_some_and(|hpgl| hpgl.chunk < 40) {
            return refuse("hpgl.chunk", "must be at least 40 bytes, which hold two points");
        }
        match self.language {
            Language::Gcode if self.gcode.is_none() => refuse("gcode", "is missing, and the language is gcode"),
            Language::Hpgl if self.hpgl.is_none() => refuse("hpgl", "is missing, and the language is hpgl"),
            _ => Ok(()),
        }
    }
}

impl Planner {
    fn check(&self, refuse: impl Fn(&'static str, &str) -> Result<(), ProfileError>) -> Result<(), ProfileError> {
        // The block that runs is fixed and one place stays free: with less than four there would be nothing to look ahead to.
        if self.block_buffer.is_some_and(|places| !(4..=4096).contains(&places)) {
            return refuse("motion.planner.block_buffer", "must be from 4 to 4096");
        }
        if !(0.0..=1.0).contains(&self.dwell_step_seconds) {
            return refuse("motion.planner.dwell_step_seconds", "must be from 0 to 1 second");
        }
        for (key, values) in [
            ("motion.planner.axis_speed", self.axis_speed),
            ("motion.planner.axis_acceleration", self.axis_acceleration),
            ("motion.planner.steps_per_mm", self.steps_per_mm),
        ] {
            if values.into_iter().flatten().any(|value| !value.is_finite() || value <= 0.0) {
                return refuse(key, "must be above 0 for x, y and z");
            }
        }
        if self.limits == Limits::Path && (self.axis_speed.is_some() || self.axis_acceleration.is_some()) {
            return refuse("motion.planner.limits", "must be \"axis\" where axes have limits of their own");
        }
        Ok(())
    }
}

impl Profile {
    /// What would draw where it should travel, or leave the machine.
    fn check_gcode(
        &self,
        gcode: &GcodeDialect,
        refuse: impl Fn(&'static str, &str) -> Result<(), ProfileError>,
    ) -> Result<(), ProfileError> {
        if gcode.pen_up.trim().is_empty() || gcode.pen_down.trim().is_empty() {
            return refuse("gcode.pen_up", "and gcode.pen_down must each be a command");
        }
        if gcode.pen_up == gcode.pen_down {
            return refuse("gcode.pen_up", "must differ from gcode.pen_down");
        }
        if !gcode.dwell.contains("{seconds}") && !gcode.dwell.contains("{milliseconds}") {
            return refuse("gcode.dwell", "must hold {seconds} or {milliseconds}");
        }
        if gcode.line_length < 40 {
            return refuse("gcode.line_length", "must be at least 40");
        }
        let is_within = |[low, high]: [f64; 2], value: f64| (low..=high).contains(&value);
        if self.area.is_some_and(|area| !is_within(area.x, gcode.park[0]) || !is_within(area.y, gcode.park[1])) {
            return refuse("gcode.park", "must lie in the area");
        }
        Ok(())
    }
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
mod tests {
    use super::*;

    #[test]
    fn every_built_in_profile_is_sound_and_named_like_its_file() {
        for name in built_in_names() {
            assert_eq!(Profile::parse(name, built_in(name).unwrap()).unwrap().name, name);
        }
    }

    #[test]
    fn a_wrong_profile_says_where() {
        let text = built_in("grbl-servo").unwrap().replace("travel_speed", "travelspeed");
        let line = text.lines().position(|l| l.starts_with("travelspeed")).unwrap() + 1;
        match Profile::parse("mine.toml", &text) {
            Err(ProfileError::Syntax { line: found, message, .. }) => {
                assert_eq!(found, line);
                assert!(message.contains("travelspeed"), "{message}");
            }
            other => panic!("{other:?}"),
        }
        for (from, to, wrong) in [
            ("block_buffer = 16", "block_buffer = 3", "motion.planner.block_buffer"),
            ("junction_deviation = 0.01", "", "motion.junction_deviation"),
            ("junction_deviation = 0.01", "junction_deviation = 0.01\ncorner_factor = 10", "motion.junction_deviation"),
            ("limits = \"axis\"", "axis_speed = [1, 1, 1]", "motion.planner.limits"),
            ("steps_per_mm = [80, 80, 400]", "steps_per_mm = [80, 0, 400]", "motion.planner.steps_per_mm"),
        ] {
            let found = Profile::parse("mine.toml", &built_in("grbl-servo").unwrap().replace(from, to));
            assert!(matches!(&found, Err(ProfileError::Value { key, .. }) if *key == wrong), "{from}: {found:?}");
        }
        let text = built_in("grbl-servo").unwrap().replace("acceleration = 250", "acceleration = 0");
        assert!(matches!(Profile::parse("mine.toml", &text), Err(ProfileError::Value { key: "motion.acceleration", .. })));
    }
}
