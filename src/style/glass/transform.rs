//! Flows that replace a picture's own (Papari 2009, figures 7.1 to 7.4).

use super::parameters::Transform;
use crate::geometry::Vec2;

/// Half the picture's shorter side in units of the nonlinear field: shows its two singular points at y = -1 and 1 and their
/// surroundings.
const NONLINEAR_REACH: f64 = 2.5;

impl Transform {
    /// Velocity in millimetres per unit of time at an offset `from_centre` from the picture's middle; the shorter side is twice `half`.
    /// None for the photograph's own flow.
    pub(super) fn velocity(self, from_centre: Vec2, half: f64) -> Option<Vec2> {
        let Vec2 { x, y } = from_centre;
        Some(match self {
            Self::Photograph => return None,
            Self::Rotation => Vec2::new(-y, x),
            Self::Scaling => from_centre,
            Self::Hyperbolic => Vec2::new(x, -y),
            Self::Spiral => Vec2::new(x - y, x + y),
            Self::Translation => Vec2::new(half, 0.0),
            Self::Nonlinear => {
                let unit = half / NONLINEAR_REACH;
                let (x, y) = (x / unit, y / unit);
                Vec2::new(y * y - 1.0 + x * y / 3.0, (y * y - 1.0) / 3.0 - x * y) * unit
            }
        })
    }
}
