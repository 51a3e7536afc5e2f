//! A profile's values are checked before anything is drawn with them.

use super::{Language, Profile};

/// A key and what is wrong with its value.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Refusal {
    pub key: String,
    pub problem: String,
}

impl Refusal {
    pub(super) fn new(key: &str, problem: &str) -> Self {
        Self { key: key.to_owned(), problem: problem.to_owned() }
    }
}

impl Profile {
    pub(super) fn check(&self) -> Result<(), Refusal> {
        for (key, value) in [("units_per_mm", self.units_per_mm), ("scale_x", self.scale_x), ("scale_y", self.scale_y)] {
            if !value.is_finite() || value <= 0.0 {
                return Err(Refusal::new(key, "must be above 0"));
            }
        }
        for (key, scale) in [("scale_x", self.scale_x), ("scale_y", self.scale_y)] {
            if !(0.8..=1.25).contains(&scale) {
                return Err(Refusal::new(
                    key,
                    "must be from 0.8 to 1.25: it corrects what was measured; units_per_mm sets the unit",
                ));
            }
        }
        if self.paper.is_empty() && self.area.is_none() {
            return Err(Refusal::new("paper", "or area must be given"));
        }
        self.paper.iter().try_for_each(super::Paper::check)?;
        self.area.iter().try_for_each(super::Area::check)?;
        self.pen.iter().try_for_each(super::PenSlot::check)?;
        self.swell.iter().try_for_each(super::Swell::check)?;
        self.axes.check()?;
        self.pens.check()?;
        self.motion.check()?;
        self.check_language()
    }

    fn check_language(&self) -> Result<(), Refusal> {
        match (self.language, &self.gcode, &self.hpgl, &self.svg) {
            (Language::Gcode, Some(gcode), ..) => {
                gcode.check()?;
                self.check_park(gcode.park)
            }
            (Language::Hpgl, _, Some(hpgl), _) => hpgl.check(),
            (Language::Svg, _, _, Some(svg)) => svg.check(),
            (Language::Gcode, ..) => Err(Refusal::new("gcode", "is missing, and the language is gcode")),
            (Language::Hpgl, ..) => Err(Refusal::new("hpgl", "is missing, and the language is hpgl")),
            (Language::Svg, ..) => Err(Refusal::new("svg", "is missing, and the language is svg")),
        }
    }

    fn check_park(&self, [x, y]: [f64; 2]) -> Result<(), Refusal> {
        let is_within = |[low, high]: [f64; 2], value: f64| (low..=high).contains(&value);
        if self.area.is_some_and(|area| !is_within(area.x, x) || !is_within(area.y, y)) {
            return Err(Refusal::new("gcode.park", "must lie in the area"));
        }
        Ok(())
    }
}
