//! Sheets, the machine's reach and its axes.

use super::check::{above_zero, are_near};
use crate::geometry::{Point, Vec2};
use crate::plot::language::Refusal;
use serde::Deserialize;

/// A sheet with its own hard clip.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Paper {
    /// The page's name, such as `a4`.
    pub name: String,
    /// The side that is horizontal when the axes point as `axes` says, in millimetres.
    pub width: f64,
    /// The other side, in millimetres.
    pub height: f64,
    /// Hard clip along x, in machine units.
    pub x: [f64; 2],
    /// Hard clip along y, in machine units.
    pub y: [f64; 2],
    /// Machine zero in millimetres from the sheet's upper left corner, x right, y down.
    pub zero: [f64; 2],
    /// Command that makes the machine use this sheet.
    #[serde(default)]
    pub setup: String,
    /// Where the carriage waits at the end, in machine units. Default: the upper right corner of the reach.
    pub park: Option<[f64; 2]>,
}

impl Paper {
    pub(super) fn check(&self) -> Result<(), Refusal> {
        let key = |last: &str| format!("paper.{}.{last}", self.name);
        for (last, side) in [("width", self.width), ("height", self.height)] {
            above_zero(&key(last), side)?;
        }
        check_range(&key("x"), self.x)?;
        check_range(&key("y"), self.y)?;
        if !are_near(&self.zero) {
            return Err(Refusal::new(&key("zero"), "must be two numbers up to 10000000"));
        }
        let is_within = |[low, high]: [f64; 2], value: f64| (low..=high).contains(&value);
        if self.park.is_some_and(|[x, y]| !is_within(self.x, x) || !is_within(self.y, y)) {
            return Err(Refusal::new(&key("park"), "must lie within x and y"));
        }
        Ok(())
    }
}

/// A machine's reach if it has no sheets, in machine units.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Area {
    /// Along x.
    pub x: [f64; 2],
    /// Along y.
    pub y: [f64; 2],
}

impl Area {
    pub(super) fn check(&self) -> Result<(), Refusal> {
        check_range("area.x", self.x)?;
        check_range("area.y", self.y)
    }
}

fn check_range(key: &str, [low, high]: [f64; 2]) -> Result<(), Refusal> {
    if !are_near(&[low, high]) {
        return Err(Refusal::new(key, "must be two numbers up to 10000000"));
    }
    if low < high {
        return Ok(());
    }
    Err(Refusal::new(key, "must be [lower, upper] with lower < upper"))
}

/// Directions of the machine's axes on the sheet.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(deny_unknown_fields, default)]
pub struct Axes {
    /// Direction of increasing x.
    pub x: Way,
    /// Direction of increasing y.
    pub y: Way,
    /// Where machine zero lies on the page, for machines without sheets.
    pub zero: Corner,
}

impl Default for Axes {
    fn default() -> Self {
        Self { x: Way::Right, y: Way::Up, zero: Corner::LowerLeft }
    }
}

impl Axes {
    pub(super) fn check(self) -> Result<(), Refusal> {
        if self.x.vector().dot(self.y.vector()) == 0.0 {
            return Ok(());
        }
        Err(Refusal::new("axes.y", "must be at right angles to axes.x"))
    }
}

/// A direction on the sheet.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Way {
    /// To the right.
    Right,
    /// To the left.
    Left,
    /// To the sheet's upper edge.
    Up,
    /// To the sheet's lower edge.
    Down,
}

impl Way {
    /// As a unit vector on the page, y down.
    pub const fn vector(self) -> Vec2 {
        match self {
            Self::Right => Vec2::new(1.0, 0.0),
            Self::Left => Vec2::new(-1.0, 0.0),
            Self::Up => Vec2::new(0.0, -1.0),
            Self::Down => Vec2::new(0.0, 1.0),
        }
    }
}

/// A place on the page.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Corner {
    /// The lower left corner.
    LowerLeft,
    /// The upper left corner.
    UpperLeft,
    /// The lower right corner.
    LowerRight,
    /// The upper right corner.
    UpperRight,
    /// The middle.
    Centre,
}

impl Corner {
    /// Its position on a page of this size, in millimetres from the upper left corner.
    pub fn on(self, width: f64, height: f64) -> Point {
        match self {
            Self::LowerLeft => Point::new(0.0, height),
            Self::UpperLeft => Point::ORIGIN,
            Self::LowerRight => Point::new(width, height),
            Self::UpperRight => Point::new(width, 0.0),
            Self::Centre => Point::new(0.5 * width, 0.5 * height),
        }
    }
}
