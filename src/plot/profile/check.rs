//! Validation of a profile's values before anything is drawn with them.

use super::Profile;
use crate::plot::language::Refusal;

/// Minimum and maximum of a scale, a speed or the like, and maximum coordinate: a factor of a thousand beyond any machine, yet
/// small enough that all computed values are finite and fit the grid of a file.
const LEAST: f64 = 1e-6;
const MOST: f64 = 1e7;

/// Refuses a value that is not above 0 or outside `LEAST` to `MOST`.
pub(in crate::plot) fn above_zero(key: &str, value: f64) -> Result<(), Refusal> {
    if (LEAST..=MOST).contains(&value) {
        return Ok(());
    }
    let is_in_sight = value.is_finite() && value > 0.0;
    Err(Refusal::new(key, if is_in_sight { "must be from 0.000001 to 10000000" } else { "must be above 0" }))
}

/// True if all coordinates are at most `MOST` in magnitude.
pub(in crate::plot) fn are_near(places: &[f64]) -> bool {
    places.iter().all(|place| place.abs() <= MOST)
}

impl Profile {
    pub(super) fn check(&self) -> Result<(), Refusal> {
        for (key, value) in [("units_per_mm", self.units_per_mm), ("scale_x", self.scale_x), ("scale_y", self.scale_y)] {
            above_zero(key, value)?;
        }
        for (key, scale) in [("scale_x", self.scale_x), ("scale_y", self.scale_y)] {
            if !(0.8..=1.25).contains(&scale) {
                return Err(Refusal::new(
                    key,
                    "must be from 0.8 to 1.25: it corrects a measured length; units_per_mm sets the unit",
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
        self.check_heights()?;
        self.axes.check()?;
        self.pens.check()?;
        self.motion.check()?;
        self.speech().check()?;
        self.check_park()
    }

    /// Checks that a swelling pen touches the paper at every height of its table.
    fn check_heights(&self) -> Result<(), Refusal> {
        let (Some(swell), Some(height)) = (&self.swell, self.height()) else {
            return Ok(());
        };
        let touches = |row: &[f64; 2]| (row[1] - height.up) * (height.down - height.up) > 0.0;
        if swell.table.iter().all(touches) {
            return Ok(());
        }
        Err(Refusal::new("swell.table", "must contain only heights on the paper's side of gcode.height.up"))
    }

    fn check_park(&self) -> Result<(), Refusal> {
        let Some([x, y]) = self.speech().park() else { return Ok(()) };
        let key = format!("{}.park", self.language().key());
        if !are_near(&[x, y]) {
            return Err(Refusal::new(&key, "must be two numbers up to 10000000"));
        }
        let is_within = |[low, high]: [f64; 2], value: f64| (low..=high).contains(&value);
        if self.area.is_some_and(|area| !is_within(area.x, x) || !is_within(area.y, y)) {
            return Err(Refusal::new(&key, "must lie in the area"));
        }
        Ok(())
    }
}
