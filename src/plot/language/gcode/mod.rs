//! G-code.

mod dialect;
mod numbers;
mod pen_action;
mod read;
mod replay;
mod resume;
mod words;
mod write;

pub use dialect::{Comment, GcodeDialect, Height, Lift, Protocol, Travel};
pub use read::GcodeError;
pub(super) use resume::resume;
#[cfg(feature = "drive")]
pub(crate) use words::{word, words};

use super::{Language, MotionError, Orders, PenAction, PenMove, Rate, Refusal, Replayed, Speech, Strokes};
use crate::read::Budget;
use pen_action::pen_actions;
use read::PenLift;
use std::io;

/// Decimals of a place in a file.
const PLACES_PER_UNIT: f64 = 1000.0;

/// True if a text without leading blanks begins as G-code.
pub(super) fn begins(text: &str) -> bool {
    text.starts_with(['G', 'M', '(', '%', ';'])
}

impl Speech for GcodeDialect {
    fn language(&self) -> Language {
        Language::Gcode
    }

    fn check(&self) -> Result<(), Refusal> {
        self.check()
    }

    /// `F` takes whole millimetres per minute.
    fn nearest_speed(&self, wanted: f64, _limit: f64) -> f64 {
        (wanted * 60.0).round().max(1.0) / 60.0
    }

    fn can_pause(&self) -> bool {
        self.pause.is_some()
    }

    fn can_dwell(&self) -> bool {
        true
    }

    fn parks_for_pens(&self) -> bool {
        true
    }

    fn sends_arcs(&self) -> bool {
        self.arcs
    }

    fn places_per_unit(&self) -> f64 {
        PLACES_PER_UNIT
    }

    fn height(&self) -> Option<Height> {
        self.height.filter(|_| self.lift == Lift::Height)
    }

    fn pen_actions(&self, pen: PenMove) -> Vec<PenAction> {
        let to = |z, rate| vec![PenAction::Move { target: [None, None, Some(z)], rate }];
        match (Speech::height(self), pen) {
            (Some(height), PenMove::Up) if self.travel == Travel::Rapid => to(height.up, Rate::Greatest),
            (Some(height), PenMove::Up) => to(height.up, Rate::Given(height.plunge_speed)),
            (Some(height), PenMove::Down) => to(height.down, Rate::Given(height.plunge_speed)),
            (None, PenMove::Up) => pen_actions(self.pen_up.as_deref().unwrap_or(""), &self.dwell),
            (None, PenMove::Down) => pen_actions(self.pen_down.as_deref().unwrap_or(""), &self.dwell),
        }
    }

    fn replay<'a>(&self, text: &'a str, rate: f64, _per_mm: f64) -> Option<Vec<Replayed<'a>>> {
        Some(replay::replay(self, text, rate))
    }

    fn park(&self) -> Option<[f64; 2]> {
        Some(self.park)
    }

    /// `G0` runs at the machine's own rate; a speed needs a feed.
    fn feed_travel(&mut self) {
        if self.travel == Travel::Rapid {
            self.travel = Travel::Feed;
        }
    }

    fn write(&self, orders: &Orders<'_>, out: &mut dyn io::Write) -> io::Result<()> {
        write::write(self, orders, out)
    }

    fn read(&self, text: &str, lightest: Option<f64>, budget: &mut Budget) -> Result<Strokes, MotionError> {
        let lift = match Speech::height(self) {
            Some(height) => PenLift::Heights { up: height.up, down: lightest.unwrap_or(height.down) },
            None => PenLift::Commands { up: self.pen_up.as_deref().unwrap_or(""), down: self.pen_down.as_deref().unwrap_or("") },
        };
        Ok(read::read(text, &lift, budget)?)
    }
}
