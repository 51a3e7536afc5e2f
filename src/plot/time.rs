//! How long a plot takes: trapezoidal speed profiles with look-ahead over junctions, as GRBL plans them.
//!
//! ```text
//!   speed |    ______        v_junction^2 = a d sin(t/2) / (1 - sin(t/2)), t the angle between the legs, d the junction deviation
//!         |   /      \   __  v_exit^2    <= v_entry^2 + 2 a length, forwards and backwards
//!         |  /        \_/  \
//!         +--------------------> time
//! ```

use super::profile::Motion;
use super::{PenPaths, Plot};
use crate::geometry::{Point, Vec2};

/// Times in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Clock {
    /// Pen down, moving.
    pub drawing: f64,
    /// Pen up, moving.
    pub travelling: f64,
    /// Lifting and lowering the pen.
    pub lifting: f64,
}

impl Clock {
    /// All of it.
    pub fn total(&self) -> f64 {
        self.drawing + self.travelling + self.lifting
    }
}

/// The time of each pen of a plot that starts at `home` (page millimetres) with the pen up.
pub fn clock(plot: &Plot, home: Point, motion: &Motion) -> Vec<Clock> {
    let mut at = home;
    plot.pens.iter().map(|pen| clock_pen(pen, &mut at, motion)).collect()
}

fn clock_pen(pen: &PenPaths, at: &mut Point, motion: &Motion) -> Clock {
    let mut clock = Clock { lifting: pen.handling.delay_seconds, ..Clock::default() };
    for path in &pen.paths {
        clock.travelling += move_time(&[*at, path.points[0]], motion.travel_speed, motion);
        clock.drawing += move_time(&path.points, pen.handling.speed(motion.draw_speed), motion);
        clock.lifting += motion.pen_down_seconds + motion.pen_up_seconds;
        *at = path.ends().end;
    }
    clock
}

/// Time along a polyline from rest to rest.
fn move_time(points: &[Point], speed: f64, motion: &Motion) -> f64 {
    let legs: Vec<Vec2> = points.windows(2).map(|w| w[1] - w[0]).filter(|leg| leg.hypot() > 1e-9).collect();
    let mut entry = vec![0.0; legs.len() + 1];
    for i in 1..legs.len() {
        entry[i] = junction_speed(legs[i - 1], legs[i], motion).min(speed);
    }
    let reachable = |from: f64, leg: Vec2| (from * from + 2.0 * motion.acceleration * leg.hypot()).sqrt();
    for i in (0..legs.len()).rev() {
        entry[i] = entry[i].min(reachable(entry[i + 1], legs[i]));
    }
    for i in 0..legs.len() {
        entry[i + 1] = entry[i + 1].min(reachable(entry[i], legs[i]));
    }
    legs.iter().enumerate().map(|(i, leg)| trapezoid(leg.hypot(), entry[i], entry[i + 1], speed, motion.acceleration)).sum()
}

fn junction_speed(before: Vec2, after: Vec2, motion: &Motion) -> f64 {
    let cosine = -before.dot(after) / (before.hypot() * after.hypot());
    let half_sine = (0.5 * (1.0 - cosine)).max(0.0).sqrt();
    if half_sine > 0.999_999 {
        return f64::INFINITY;
    }
    (motion.acceleration * motion.corner_deviation() * half_sine / (1.0 - half_sine)).sqrt()
}

/// Time over a length with given speeds at both ends and a greatest speed between.
fn trapezoid(length: f64, from: f64, to: f64, speed: f64, acceleration: f64) -> f64 {
    let peak = (0.5 * (from * from + to * to) + acceleration * length).sqrt().min(speed.max(from).max(to));
    let ramps = (2.0 * peak * peak - from * from - to * to) / (2.0 * acceleration);
    (2.0 * peak - from - to) / acceleration + (length - ramps).max(0.0) / peak
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTION: Motion = Motion {
        draw_speed: 50.0,
        draw_speed_limit: None,
        travel_speed: 100.0,
        acceleration: 250.0,
        travel_acceleration: None,
        junction_deviation: Some(0.01),
        corner_factor: None,
        pen_up_seconds: 0.15,
        pen_down_seconds: 0.2,
        touch_seconds: 0.0,
        planner: crate::plot::Planner {
            block_buffer: None,
            limits: crate::plot::Limits::Path,
            axis_speed: None,
            axis_acceleration: None,
            steps_per_mm: None,
            dwell_step_seconds: 0.0,
        },
    };

    #[test]
    fn a_long_line_is_a_trapezoid_and_a_short_one_a_triangle() {
        let line = |length| move_time(&[Point::ORIGIN, Point::new(length, 0.0)], 50.0, &MOTION);
        assert!((line(100.0) - (100.0 / 50.0 + 50.0 / 250.0)).abs() < 1e-9);
        assert!((line(1.0) - 2.0 * (1.0_f64 / 250.0).sqrt()).abs() < 1e-9);
    }

    #[test]
    fn points_on_a_straight_line_cost_nothing_and_a_reversal_stops() {
        let straight: Vec<Point> = (0..=100).map(|i| Point::new(f64::from(i), 0.0)).collect();
        let whole = move_time(&[straight[0], straight[100]], 50.0, &MOTION);
        assert!((move_time(&straight, 50.0, &MOTION) - whole).abs() < 1e-6);
        let back = [Point::ORIGIN, Point::new(100.0, 0.0), Point::ORIGIN];
        assert!((move_time(&back, 50.0, &MOTION) - 2.0 * whole).abs() < 1e-9);
    }
}
