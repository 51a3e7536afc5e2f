//! The ground under the dashes of narrow parts: where ink is wanted, where it already lies, and where it would spill.

use crate::geometry::{OffsetOutline, Point, Region, Vec2, resample};

/// The region to be inked, and the part of it already inked where the nib fits.
pub(super) struct Ground {
    asked: Region,
    reached: Region,
}

impl Ground {
    pub fn new(asked: &OffsetOutline, reached: &OffsetOutline) -> Self {
        // The outlines are polygons, so the flattening tolerance has no effect.
        let region = |insets: &OffsetOutline| Region::new(&insets.path(), 1.0);
        Self { asked: region(asked), reached: region(reached) }
    }

    /// True if a dash may be drawn: it stands by itself, or covers more than it spills. Otherwise adjacent threads of a net would
    /// fill the holes.
    pub fn may_draw(&self, points: &[Point], nib: f64) -> bool {
        /// Sample points from the nib's centre to its edge; 5 are accurate to a tenth.
        const ACROSS: i32 = 5;
        /// Share of a dash on existing ink from which it must cover more than it spills. A dash that begins at a wide part's
        /// border has a tenth there; a thread of a net between two places where the nib fits, a third or more.
        const SHARED: f64 = 0.2;
        let half = 0.5 * nib;
        let grid = (-ACROSS..=ACROSS).flat_map(|j| (-ACROSS..=ACROSS).map(move |i| Vec2::new(f64::from(i), f64::from(j))));
        let under: Vec<Vec2> = grid.map(|v| v * (half / f64::from(ACROSS))).filter(|v| v.hypot() <= half).collect();
        let middles = if points.len() > 1 { resample(points, half) } else { points.to_vec() };
        let (mut shared, mut gained, mut all) = (0.0, 0.0, 0.0);
        for place in middles.iter().flat_map(|p| under.iter().map(|v| *p + *v)) {
            all += 1.0;
            if self.reached.contains(place) {
                shared += 1.0;
            } else {
                gained += if self.asked.contains(place) { 1.0 } else { -1.0 };
            }
        }
        shared < SHARED * all || gained > 0.0
    }

    /// True if ink is wanted at a point.
    pub fn is_asked(&self, place: Point) -> bool {
        self.asked.contains(place)
    }

    /// True if the point is inked where the nib fits.
    pub fn is_reached(&self, place: Point) -> bool {
        self.reached.contains(place)
    }
}
