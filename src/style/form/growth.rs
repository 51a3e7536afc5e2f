//! How beards grow: down the cheeks and off the chin, apart to both sides; moustaches from the middle to the corners of the mouth.

use crate::elementary::Elementary as _;
use crate::geometry::Point;
use crate::source::Landmarks;
use crate::style::head::Head;
use std::f64::consts::FRAC_PI_2;

/// How far beards part, as the slope of their hairs per width of the face from its middle, and moustaches.
const PARTED: f64 = 0.9;
const MOUSTACHE: f64 = 4.5;
/// Half the width of a moustache, in widths of the face, and the height over which it begins above the line of the lips, in heights of the face.
const HALF_WIDTH: f64 = 0.2;
const SOFT: f64 = 0.05;
/// The middle of the lips' line.
const LIPS: usize = 13;

/// The growth of one face's beard.
pub(in crate::style) struct Growth {
    head: Head,
    /// Of the lips, in heights of the face below the chin.
    lips: f64,
}

impl Growth {
    pub(in crate::style) fn of(face: &Landmarks) -> Self {
        let head = Head::new(face);
        Self { lips: head.relative(face.point(LIPS)).1, head }
    }

    /// How far a place is from the face.
    fn away(&self, p: Point) -> f64 {
        self.head.away(p)
    }

    /// The direction at a place, in radians on the page.
    fn angle(&self, p: Point) -> f64 {
        let (u, v) = self.head.relative(p);
        let above = ((self.lips - v) / SOFT + 0.5).clamp(0.0, 1.0);
        let beside = (2.0 - u.abs() / HALF_WIDTH).clamp(0.0, 1.0);
        let parted = PARTED + (MOUSTACHE - PARTED) * above * beside;
        FRAC_PI_2 - (parted * u).arc_tangent() + self.head.roll()
    }
}

/// The direction in which the nearest face's beard grows at a place, in radians on the page.
pub(in crate::style) fn growth_at(growth: &[Growth], p: Point) -> f64 {
    growth.iter().min_by(|a, b| a.away(p).total_cmp(&b.away(p))).map_or(0.0, |growth| growth.angle(p))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::form::mean_portrait;

    #[test]
    fn hairs_run_down_and_apart_and_a_moustaches_more() {
        let portrait = mean_portrait(6.0, 0.0, |_| 100);
        let face = &portrait.faces[0];
        let growth = Growth::of(face);
        let at = |index: usize| growth.angle(face.point(index)).to_degrees();
        let (chin, left, right, above) = (at(152), at(364), at(135), at(391));
        assert!((chin - 90.0).abs() < 3.0, "{chin}");
        assert!((45.0..88.0).contains(&left) && (92.0..135.0).contains(&right), "{left} {right}");
        assert!(above < 75.0, "{above}");
    }
}
