//! One patch shaded by hand: arcs to and fro in one direction (sections 6.2 and 6.3.4).

use super::Drawer;
use super::strokes::Touch;
use crate::drawing::Mark;
use crate::elementary::unit_at;
use crate::field::{contours, distance_within, pieces_inside};
use crate::geometry::{HandShading, Millimetres, Point, Rect, Vec2, polyline_length};
use crate::raster::Raster;
use crate::style::random::stream;
use rand::{Rng, RngExt};

/// A region to be shaded in one tone; lengths in millimetres, the orientation in radians.
pub(super) struct Patch {
    /// 0 to 1, in working pixels.
    pub region: Raster<f32>,
    pub width: Millimetres,
    pub spacing: Millimetres,
    /// Maximum length of an arc; narrower regions have shorter arcs.
    pub length: Millimetres,
    pub orientation: f64,
    pub pressure: f64,
    /// Inset of a stroke's centre line from the region's border.
    pub inset: Millimetres,
    pub pressing: Pressing,
    /// Pieces shorter than this are specks.
    pub least: Millimetres,
}

/// Pressure of the hand as it swings to and fro.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Pressing {
    /// Even, to fill a small form.
    Filling,
    /// Firm in the middle of a swing, light at its turns, where the hand often lifts: open hatching.
    Hatching,
}

/// Pieces shorter than this many widths are specks.
pub(super) const LEAST_WIDTHS: f64 = 1.5;
/// Share of a swing's length at either end over which the pressure grows, and the pressure that is left at a turn on the paper.
const TURN: f64 = 0.3;
const TURN_PRESSURE: f64 = 0.35;
impl Drawer<'_> {
    /// The strokes of a patch: chains of arcs side by side, cut to the region; `local` scales the pressure at a place.
    pub(super) fn shade_patch(&self, patch: &Patch, stage: &str, element: u64, local: impl Fn(Point) -> f64) -> Vec<Mark> {
        let is_hatching = patch.pressing == Pressing::Hatching;
        let touch = Touch {
            width: patch.width,
            pressure: patch.pressure,
            taper: 0.06,
            node: if is_hatching { 1.2 * self.parameters.pitch } else { 1.5 * patch.width },
        };
        let region = inset(&patch.region, self.pixels(patch.inset));
        let least = self.pixels(patch.least);
        let mut random = stream(self.seed, stage, element);
        let mut marks = Vec::new();
        for stroke in self.chains(patch, &mut random) {
            for piece in pieces_inside(&stroke, &region).iter().filter(|piece| polyline_length(piece) >= least) {
                let firm = if is_hatching { random.random_range(0.7..1.15) } else { 1.0 };
                let turns = if is_hatching { turns(piece) } else { Vec::new() };
                let ramp = TURN * self.pixels(patch.length);
                marks.extend(self.stroke(piece, touch, |p| firm * local(p) * lightened(p, &turns, ramp)));
            }
        }
        marks
    }

    /// Strokes that cover the region's bounds in its orientation: groups of arcs, one below another in swaths.
    fn chains(&self, patch: &Patch, random: &mut impl Rng) -> Vec<Vec<Point>> {
        /// Overlap of neighbouring swaths, as a share of an arc.
        const SWATH_OVERLAP: f64 = 0.2;
        /// Arcs drawn before the hand is set down anew, slightly displaced; and the displacement aside, along (shares of an arc's
        /// length) and in angle (radians). Without it the turns of all chains line up, and the background is one repeated wave.
        const ARCS_A_GROUP: std::ops::Range<usize> = 7..24;
        const ASIDE: f64 = 0.2;
        const LONGER: std::ops::Range<f64> = 0.8..1.2;
        const ASKEW: f64 = 0.07;
        let along = unit_at(patch.orientation);
        let across = Vec2::new(-along.y, along.x);
        let Some(bounds) = turned_bounds(&patch.region, along, across) else { return Vec::new() };
        let spacing = self.pixels(patch.spacing);
        let most = self.pixels(patch.length);
        let swaths = (bounds.width() / (most * (1.0 - SWATH_OVERLAP))).ceil().max(1.0);
        let swath = bounds.width() / swaths;
        let length = (swath / (1.0 - SWATH_OVERLAP)).max(2.0 * spacing);
        let radius = self.pixels(self.parameters.arc_radius).min(4.0 * length);
        let mut strokes = Vec::new();
        // A form that one swing spans is filled without interruption.
        let is_regular = patch.pressing == Pressing::Filling;
        for i in 0..swaths as usize {
            let mut down = bounds.y0 - spacing * random.random_range(1.0..4.0);
            while down < bounds.y1 + spacing {
                let count =
                    if is_regular { ((bounds.y1 - down) / spacing) as usize + 2 } else { random.random_range(ARCS_A_GROUP) };
                let mut vary = |size: f64| if is_regular { 0.0 } else { random.random_range(-size..size) };
                let middle = bounds.x0 + (i as f64 + 0.5 + vary(ASIDE)) * swath;
                let orientation = patch.orientation + vary(ASKEW);
                let longer = if is_regular { 1.0 } else { random.random_range(LONGER) };
                let centre = (along * middle + across * down).to_point();
                let shading = HandShading {
                    centre,
                    length: length * longer,
                    radius,
                    orientation,
                    spacing,
                    count,
                    skew: self.parameters.arc_skew,
                };
                strokes.extend(lifted(&shading.arcs(random), patch.pressing, random));
                down += (count as f64 + if is_regular { 0.0 } else { random.random_range(-0.5..0.8) }) * spacing;
            }
        }
        strokes
    }
}

/// Where a stroke turns back, and its ends.
fn turns(piece: &[Point]) -> Vec<Point> {
    let back = piece.windows(3).filter(|three| (three[1] - three[0]).dot(three[2] - three[1]) < 0.0).map(|three| three[1]);
    piece.first().copied().into_iter().chain(back).chain(piece.last().copied()).collect()
}

/// Share of the pressure left at a place of a swing, for the length over which it grows after a turn.
fn lightened(p: Point, turns: &[Point], ramp: f64) -> f64 {
    let away = turns.iter().map(|turn| turn.distance(p)).fold(ramp, f64::min);
    let t = away / ramp.max(1e-6);
    TURN_PRESSURE + (1.0 - TURN_PRESSURE) * t * t * (3.0 - 2.0 * t)
}

/// Share of the turns at which the hand keeps the stick on the paper, in open hatching.
const KEPT_TURNS: f64 = 0.85;

/// The arcs as strokes: a single one or, in open hatching, a new one after most turns.
fn lifted(arcs: &[Vec<Point>], pressing: Pressing, random: &mut impl Rng) -> Vec<Vec<Point>> {
    let mut strokes: Vec<Vec<Point>> = Vec::new();
    for arc in arcs {
        let goes_on = pressing == Pressing::Filling || random.random_bool(KEPT_TURNS);
        match strokes.last_mut() {
            Some(stroke) if goes_on => stroke.extend(&arc[1..]),
            _ => strokes.push(arc.clone()),
        }
    }
    strokes
}

/// A region inset by a number of pixels.
fn inset(region: &Raster<f32>, by: f64) -> Raster<f32> {
    if by <= 0.0 {
        return region.clone();
    }
    let Some(outside) = distance_within(&contours(region, 0.5), region.width(), region.height(), by + 1.0) else {
        return region.clone();
    };
    let within = region.zip_map(&outside.distance, |inside, distance| if inside >= 0.5 { distance } else { -distance });
    // 0.5 at distance `by` from the border, so that the inset's border lies there.
    within.map(|distance| (0.5 + distance - by as f32).clamp(0.0, 1.0))
}

/// Bounds of a region along and across a direction; none if it is empty.
fn turned_bounds(region: &Raster<f32>, along: Vec2, across: Vec2) -> Option<Rect> {
    let mut bounds: Option<Rect> = None;
    for y in 0..region.height() {
        for x in (0..region.width()).filter(|x| region.get(*x, y) >= 0.5) {
            let p = Vec2::new(x as f64 + 0.5, y as f64 + 0.5);
            let (u, v) = (p.dot(along), p.dot(across));
            let here = Rect::new(u - 0.7, v - 0.7, u + 0.7, v + 0.7);
            bounds = Some(bounds.map_or(here, |b| b.union(here)));
        }
    }
    bounds
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hand_that_hatches_keeps_most_turns_on_the_paper() {
        let arcs: Vec<Vec<Point>> = (0..400).map(|i| vec![Point::new(f64::from(i % 2), f64::from(i)); 2]).collect();
        let strokes = lifted(&arcs, Pressing::Hatching, &mut stream(1, "test", 0)).len();
        let kept = 1.0 - (strokes - 1) as f64 / 399.0;
        assert!(kept > 0.7 && kept < 1.0, "{kept}");
        assert_eq!(lifted(&arcs, Pressing::Filling, &mut stream(1, "test", 0)).len(), 1);
    }

    #[test]
    fn pressure_falls_at_turns() {
        let zigzag = [(0.0, 0.0), (50.0, 0.0), (100.0, 0.0), (50.0, 3.0), (0.0, 3.0)].map(Point::from);
        let turns = turns(&zigzag);
        assert_eq!(turns, [zigzag[0], zigzag[2], zigzag[4]]);
        assert!(lightened(zigzag[1], &turns, 30.0) > 0.99 && lightened(zigzag[2], &turns, 30.0) < 0.36);
    }
}
