//! The picture's rim: no ink extends over it, not even half a line's width.
//!
//! ```text
//!      rim  ______________________________________________
//!             _____------------------------------|   |         a line that runs along the rim is as wide there as the
//!           --------                             | <-|  ends   room on both sides of its middle; one that meets
//!                   ----------___________________|   |         the rim ends where its square end's corner touches
//! ```

use super::lines::{Family, Line};
use super::widths::LineReadings;
use crate::geometry::Vec2;

/// The rim as a line meets it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rim {
    /// Width in millimetres at which its ink touches the rim.
    pub width: f64,
    /// How far the line is inside the drawable area, in millimetres; below 0 outside.
    pub inside: f64,
}

impl LineReadings<'_> {
    /// The rim at a place along a line.
    pub(super) fn rim(&self, line: &Line, u: f64) -> Rim {
        /// Minimum room in pitches, as half a line's width, for a line along the rim: with less it would be a hairline that
        /// leaves its strip white, with more the strip beside the rim stays white.
        const ALONG: f64 = 0.25;
        /// Share of a line's half width that points at a side of the picture: up to the first value the line ends flat before the
        /// side, with room for its maximum width (narrowing would leave a spike); from the second it runs along the side.
        const ENDS: f64 = 0.35;
        const RUNS: f64 = 0.7;
        /// Maximum width for which room is kept, in pitches; wider lines narrow at the rim.
        const WIDEST: f64 = 1.5;
        /// Tolerance of the fit of widths and ends, in pitches.
        const FITTED: f64 = 0.03;
        let Family { first, step, frame, pitch, .. } = *self.family;
        let x = ((u - first) / step - line.first as f64).clamp(0.0, (line.heights.len() - 1) as f64);
        let i = (x as usize).min(line.heights.len() - 2);
        let rise = line.heights[i + 1] - line.heights[i];
        let sides = self.wanted.ground.grid.inside_sides(frame.to_page(u, line.heights[i] + rise * (x - i as f64)));
        // Far from the rim, which is the usual case, it sets no limit.
        let nearest = sides[0].min(sides[1]);
        if nearest > self.wanted.width_max + FITTED * pitch {
            return Rim { width: f64::INFINITY, inside: nearest };
        }
        let along = frame.to_page(step, rise) - frame.to_page(0.0, 0.0);
        let across = Vec2::new(-along.y, along.x) / along.hypot().max(1e-12);
        let mut rim = Rim { width: f64::INFINITY, inside: f64::INFINITY };
        for (room, across) in sides.into_iter().zip([across.x.abs(), across.y.abs()]) {
            let room = room - across * FITTED * pitch;
            let t = ((across - ENDS) / (RUNS - ENDS)).clamp(0.0, 1.0);
            let widest = 0.5 * self.wanted.width_max.min(WIDEST * pitch);
            let half = widest * (1.0 - t) + widest.min(ALONG * pitch) * t;
            rim.width = rim.width.min((2.0 * room / across.max(1e-9)).max(0.0));
            rim.inside = rim.inside.min(room - across * half);
        }
        rim
    }
}
