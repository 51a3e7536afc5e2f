//! How fast a machine moves, and how it plans.

use super::check::above_zero;
use crate::plot::language::Refusal;
use serde::Deserialize;

/// Speeds and times.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Speed with the pen down, mm/s.
    pub draw_speed: f64,
    /// Maximum programmable drawing speed, mm/s.
    pub draw_speed_limit: Option<f64>,
    /// Speed with the pen up, mm/s. With per-axis limits, the rate of x and of y (GRBL's `$110` and `$111`).
    pub travel_speed: f64,
    /// Maximum programmable travel speed, mm/s.
    pub travel_speed_limit: Option<f64>,
    /// Acceleration in mm/s^2, along the path or per axis as `planner.limits` says.
    pub acceleration: f64,
    /// Acceleration with the pen up in mm/s^2, if it differs.
    pub travel_acceleration: Option<f64>,
    /// Junction deviation in millimetres (GRBL's `$11`): the virtual rounding of a corner, which sets its speed.
    pub junction_deviation: Option<f64>,
    /// Junction deviation in the `AxiDraw` driver's unit: 5000ths of an inch.
    pub corner_factor: Option<f64>,
    /// Time to lift the pen.
    pub pen_up_seconds: f64,
    /// Time to lower the pen.
    pub pen_down_seconds: f64,
    /// How long a touch rests on the paper after that.
    #[serde(default)]
    pub touch_seconds: f64,
    /// Look-ahead, and what the limits apply to.
    #[serde(default)]
    pub planner: Planner,
}

/// Junction deviation in millimetres for a corner factor of 1: the `AxiDraw`'s driver divides the factor by 5000 and takes
/// inches.
const MM_PER_CORNER_FACTOR: f64 = 25.4 / 5000.0;

/// GRBL's default for `$112`, 500 mm/min.
const USUAL_Z_SPEED: f64 = 500.0 / 60.0;

impl Motion {
    /// Maximum rates of x, y and z in mm/s, with per-axis limits.
    pub fn axis_speeds(&self) -> [f64; 3] {
        let [x, y, z] = self.planner.axis_speed.unwrap_or([self.travel_speed, self.travel_speed, USUAL_Z_SPEED]);
        [x.min(self.travel_speed), y.min(self.travel_speed), self.planner.z_speed.unwrap_or(z)]
    }

    /// Accelerations of x, y and z in mm/s^2; `all` applies to axes without their own.
    pub fn axis_accelerations(&self, all: f64) -> [f64; 3] {
        let [x, y, z] = self.planner.axis_acceleration.unwrap_or([all; 3]);
        [x, y, self.planner.z_acceleration.unwrap_or(z)]
    }

    /// Maximum drawing speed in mm/s. Without a limit, the greater of drawing and travel speed.
    pub fn fastest_drawing(&self) -> f64 {
        self.draw_speed_limit.unwrap_or(self.draw_speed.max(self.travel_speed))
    }

    /// Maximum travel speed in mm/s. Without a limit, the greater of the travel speed and the maximum programmable drawing speed.
    pub fn fastest_travel(&self) -> f64 {
        self.travel_speed_limit.unwrap_or(self.travel_speed.max(self.draw_speed_limit.unwrap_or(self.draw_speed)))
    }

    /// Junction deviation in millimetres.
    pub fn corner_deviation(&self) -> f64 {
        self.junction_deviation.or(self.corner_factor.map(|factor| factor * MM_PER_CORNER_FACTOR)).unwrap_or(0.0)
    }
}

/// How a controller plans its motion.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Planner {
    /// Size of the look-ahead buffer in blocks, of which one stays free (GRBL: 16). Without it, everything between two stops is
    /// planned as a whole.
    pub block_buffer: Option<usize>,
    /// What the limits of speed and acceleration apply to.
    pub limits: Limits,
    /// Maximum rates of x, y and z, mm/s (GRBL's `$110` to `$112`); those of x and y are capped at `travel_speed`.
    pub axis_speed: Option<[f64; 3]>,
    /// Accelerations of x, y and z, mm/s^2 (GRBL's `$120` to `$122`). Default: `acceleration`.
    pub axis_acceleration: Option<[f64; 3]>,
    /// Maximum rate of z, mm/s (GRBL's `$112`). Default: that of `axis_speed`, else GRBL's default.
    pub z_speed: Option<f64>,
    /// Acceleration of z, mm/s^2 (GRBL's `$122`). Default: that of `axis_acceleration`, else `acceleration`.
    pub z_acceleration: Option<f64>,
    /// Motor steps per millimetre of x, y and z (GRBL's `$100` to `$102`). Positions are rounded to steps before planning.
    pub steps_per_mm: Option<[f64; 3]>,
    /// Maximum deviation of an arc's chords from it, mm (GRBL's `$12`). Without it, arcs are timed as the chords that they
    /// replace.
    pub arc_tolerance: Option<f64>,
    /// Duration of one speed step on a ramp, in seconds (GRBL: 0.01). Together with `steps_per_mm`, it makes a start from rest as
    /// slow as GRBL's.
    pub segment_seconds: Option<f64>,
    /// Waits are rounded up to a multiple of this, in seconds.
    pub dwell_step_seconds: f64,
}

/// What a machine's limits of speed and acceleration apply to.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Limits {
    /// The motion along the path, whatever its direction.
    #[default]
    Path,
    /// Each axis by itself, so that a diagonal is faster.
    Axis,
}

impl Motion {
    pub(super) fn check(&self) -> Result<(), Refusal> {
        for (key, value) in [
            ("motion.draw_speed", self.draw_speed),
            ("motion.draw_speed_limit", self.draw_speed_limit.unwrap_or(1.0)),
            ("motion.travel_speed", self.travel_speed),
            ("motion.travel_speed_limit", self.travel_speed_limit.unwrap_or(1.0)),
            ("motion.acceleration", self.acceleration),
            ("motion.travel_acceleration", self.travel_acceleration.unwrap_or(1.0)),
            ("motion.junction_deviation", self.junction_deviation.unwrap_or(1.0)),
            ("motion.corner_factor", self.corner_factor.unwrap_or(1.0)),
        ] {
            above_zero(key, value)?;
        }
        if self.junction_deviation.is_some() == self.corner_factor.is_some() {
            return Err(Refusal::new("motion.junction_deviation", "or motion.corner_factor must be given, and not both"));
        }
        if self.travel_acceleration.is_some() && self.planner.limits == Limits::Axis {
            return Err(Refusal::new("motion.travel_acceleration", "cannot be set where motion.planner.limits is \"axis\""));
        }
        for (key, seconds) in [
            ("motion.pen_up_seconds", self.pen_up_seconds),
            ("motion.pen_down_seconds", self.pen_down_seconds),
            ("motion.touch_seconds", self.touch_seconds),
        ] {
            if !(0.0..=60.0).contains(&seconds) {
                return Err(Refusal::new(key, "must be from 0 to 60 seconds"));
            }
        }
        self.planner.check()
    }
}

impl Planner {
    fn check(&self) -> Result<(), Refusal> {
        // The running block is fixed and one place stays free: with fewer than four there would be nothing to look ahead to.
        if self.block_buffer.is_some_and(|places| !(4..=4096).contains(&places)) {
            return Err(Refusal::new("motion.planner.block_buffer", "must be from 4 to 4096"));
        }
        if self.arc_tolerance.is_some_and(|mm| !(1e-6..=1.0).contains(&mm)) {
            return Err(Refusal::new("motion.planner.arc_tolerance", "must be from 0.000001 to 1 mm"));
        }
        if self.segment_seconds.is_some_and(|seconds| !(1e-4..=1.0).contains(&seconds)) {
            return Err(Refusal::new("motion.planner.segment_seconds", "must be from 0.0001 to 1 second"));
        }
        if !(0.0..=1.0).contains(&self.dwell_step_seconds) {
            return Err(Refusal::new("motion.planner.dwell_step_seconds", "must be from 0 to 1 second"));
        }
        for (key, values) in [
            ("motion.planner.axis_speed", self.axis_speed),
            ("motion.planner.axis_acceleration", self.axis_acceleration),
            ("motion.planner.steps_per_mm", self.steps_per_mm),
        ] {
            values.into_iter().flatten().try_for_each(|value| above_zero(key, value))?;
        }
        for (key, value) in [("motion.planner.z_speed", self.z_speed), ("motion.planner.z_acceleration", self.z_acceleration)] {
            value.into_iter().try_for_each(|value| above_zero(key, value))?;
        }
        let has_axes = self.axis_speed.is_some() || self.axis_acceleration.is_some();
        if self.limits == Limits::Path && (has_axes || self.z_speed.is_some() || self.z_acceleration.is_some()) {
            return Err(Refusal::new("motion.planner.limits", "must be \"axis\" where axes have limits of their own"));
        }
        Ok(())
    }
}
