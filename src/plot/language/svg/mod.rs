//! SVG in the layer conventions of a plotter's own program.

mod write;

pub(in crate::plot) use write::write_picture;

use super::{Language, MotionError, Orders, Refusal, Speech, Strokes};
use crate::plot::profile::above_zero;
use crate::read::Budget;
use serde::Deserialize;
use std::io;

/// SVG for one machine.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct SvgDialect {
    /// Millimetres per second of one percent in a label's `+S`.
    pub speed_of_percent: f64,
    /// True if the program turns a portrait page onto the machine's long side.
    #[serde(default)]
    pub turns_portrait: bool,
    /// What lifts the pen, for sending.
    #[serde(default)]
    pub pen_lift: PenLift,
}

/// The motor that lifts an `AxiDraw`'s pen. The two stand at different plugs of the board and take different signals.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum PenLift {
    /// The servo that it comes with.
    #[default]
    Servo,
    /// The brushless motor, an upgrade: quieter, and twice as fast.
    Brushless,
}

/// True if a text without leading blanks begins as SVG.
pub(super) fn begins(text: &str) -> bool {
    text.starts_with('<')
}

impl Speech for SvgDialect {
    fn language(&self) -> Language {
        Language::Svg
    }

    fn check(&self) -> Result<(), Refusal> {
        above_zero("svg.speed_of_percent", self.speed_of_percent)
    }

    fn can_pause(&self) -> bool {
        true
    }

    fn traces_frame(&self) -> bool {
        false
    }

    fn turns_portrait(&self) -> bool {
        self.turns_portrait
    }

    fn speed_of_percent(&self) -> Option<f64> {
        Some(self.speed_of_percent)
    }

    fn write(&self, orders: &Orders<'_>, out: &mut dyn io::Write) -> io::Result<()> {
        write::write(*self, orders, out)
    }

    fn read(&self, _text: &str, _lightest: Option<f64>, _budget: &mut Budget) -> Result<Strokes, MotionError> {
        Err(MotionError::Drawing)
    }
}
