//! Keeps ink inside a box, including half a line's width, while preserving the tone at the border.
//!
//! ```text
//!   dots, areas     cut along the border
//!   strokes         keep the inside part of each cross-section, with its midpoint as the new centre
//!
//!      border  ______________________
//!                ___----------_____        a line that runs along the border and half across it
//!              --                  --      continues inside at half its width
//! ```
//!
//! A stroke stays a stroke, so that a pen still draws it in one pass.

use super::{Drawing, Mark, Stroke, Width};
use crate::geometry::{BezPath, Ends, Point, Rect, Station, Stretch, Vec2, stations};
use crate::parallel::mapped;
use kurbo::Shape;

/// Distance that strokes keep from the box's border, in millimetres: the smallest written step.
const RIM: f64 = 0.001;
/// Maximum length of a stroke's pieces beside the border, in millimetres, coarse (`SPACING`) and fine (`FINEST`), and the number
/// of fine pieces (`NEAR`) around the point where its width begins to shrink. Between two points widths change smoothly, not
/// linearly, by less than [`RIM`] over the shorter ones.
const SPACING: f64 = 0.05;
const FINEST: f64 = 0.005;
const NEAR: usize = 4;

impl Drawing {
    /// The drawing without the ink outside `rect`. Dots and areas are cut; strokes are narrowed.
    #[must_use]
    pub fn confined_to(mut self, rect: Rect) -> Self {
        for layer in &mut self.layers {
            let lies_inside = mapped(&layer.marks, &|mark| mark.lies_in(rect));
            if lies_inside.iter().all(|is_inside| *is_inside) {
                continue;
            }
            let mut kept = Vec::with_capacity(layer.marks.len());
            for (mark, is_inside) in std::mem::take(&mut layer.marks).into_iter().zip(lies_inside) {
                if is_inside {
                    kept.push(mark);
                } else {
                    kept.extend(mark.cut_to(rect));
                }
            }
            layer.marks = kept;
        }
        self
    }
}

impl Mark {
    /// The part of its ink inside a rectangle.
    #[must_use]
    pub fn confined_to(self, rect: Rect) -> Vec<Self> {
        if self.lies_in(rect) { vec![self] } else { self.cut_to(rect) }
    }

    /// True if all of its ink lies inside a rectangle.
    fn lies_in(&self, rect: Rect) -> bool {
        /// Rounding tolerance in millimetres by which a mark may exceed the box and stay whole.
        const SLACK: f64 = 5e-7;
        let wide = rect.inflate(SLACK, SLACK);
        wide.union(self.bounding_box()) == wide
    }

    fn cut_to(self, rect: Rect) -> Vec<Self> {
        match self {
            Self::Stroke(stroke) => held_stroke(stroke, rect.inset(-RIM)),
            cut => cut.clipped(rect),
        }
    }
}

/// One point of a stroke kept inside the box; there is none if the cross-section lies outside.
#[derive(Clone, Copy)]
struct Held {
    at: Point,
    width: f64,
    node: f64,
    stretch: Stretch,
    is_moved: bool,
}

fn held_stroke(stroke: Stroke, rect: Rect) -> Vec<Mark> {
    let widths = stroke.widths().into_owned();
    let is_clear = |ink: Rect| rect.union(ink) == rect;
    let hold = |(station, stretch): &(Station, Stretch)| held(station, *stretch, stroke.ends, rect);
    let coarse = stations(stroke.curve(), &widths, SPACING, is_clear);
    if coarse.iter().all(|station| hold(station).is_some_and(|held| !held.is_moved)) {
        return vec![Mark::Stroke(stroke)];
    }
    let fine = stations(stroke.curve(), &widths, FINEST, is_clear);
    let places = thinned(&fine.iter().map(hold).collect::<Vec<_>>());
    let mut runs: Vec<Vec<Held>> =
        places.split(Option::is_none).filter(|run| run.len() > 1).map(|run| run.iter().copied().flatten().collect()).collect();
    let is_ring = stroke.is_closed() && runs.len() == 1 && runs[0].len() == places.len();
    if stroke.is_closed() && runs.len() > 1 && places[0].is_some() && places[places.len() - 1].is_some() {
        // The ring continues across its seam.
        let first = runs.remove(0);
        if let Some(last) = runs.last_mut() {
            last.extend(&first[1..]);
        }
    }
    runs.into_iter().filter_map(|run| piece(&stroke, run, is_ring, rect)).collect()
}

/// Widths below this, in millimetres, are not ink.
const NO_INK: f64 = 1e-4;

/// The centre and width of the part of a cross-section inside the box. Round ends and corners need that room on all sides.
fn held(station: &Station, stretch: Stretch, ends: Ends, rect: Rect) -> Option<Held> {
    let half = station.along.turn_90() * (0.5 * station.width);
    let (low, high) = inside(station.at, half, rect)?;
    let (at, width) = (station.at + half * (0.5 * (low + high)), 0.5 * (high - low) * station.width);
    let width = if ends == Ends::Flat { width } else { width.min(2.0 * room(at, rect)) };
    let is_moved = at.distance(station.at) > 1e-9 || (width - station.width).abs() > 1e-9;
    (width > NO_INK || !is_moved).then_some(Held { at, width, node: station.node, stretch, is_moved })
}

/// The range of `t` in -1 to 1 for which `at + half * t` lies in a rectangle.
fn inside(at: Point, half: Vec2, rect: Rect) -> Option<(f64, f64)> {
    let (mut low, mut high) = (-1.0_f64, 1.0_f64);
    for (at, half, least, most) in [(at.x, half.x, rect.x0, rect.x1), (at.y, half.y, rect.y0, rect.y1)] {
        if half.abs() < 1e-12 {
            if at < least || at > most {
                return None;
            }
            continue;
        }
        let (a, b) = ((least - at) / half, (most - at) / half);
        low = low.max(a.min(b));
        high = high.min(a.max(b));
    }
    (high >= low).then_some((low, high))
}

/// Distance of a point from the nearest side of a rectangle, positive inside.
fn room(p: Point, rect: Rect) -> f64 {
    (p.x - rect.x0).min(rect.x1 - p.x).min(p.y - rect.y0).min(rect.y1 - p.y)
}

/// Removes points that straight stretches of evenly changing width do not need: within a run of moved or of unmoved points, one
/// per [`SPACING`] is kept; at a transition, [`NEAR`] of them on either side.
fn thinned(places: &[Option<Held>]) -> Vec<Option<Held>> {
    let moved: Vec<Option<bool>> = places.iter().map(|place| place.map(|held| held.is_moved)).collect();
    let is_even = |i: usize| {
        let around = &moved[i.saturating_sub(NEAR)..(i + NEAR + 1).min(moved.len())];
        i > 0 && i + 1 < moved.len() && around.iter().all(|other| *other == moved[i])
    };
    let mut kept: Vec<Option<Held>> = Vec::new();
    for (i, place) in places.iter().enumerate() {
        let is_straight = |i: usize| matches!(places.get(i), Some(Some(Held { stretch: Stretch::Straight, .. })));
        let is_near = |last: &Held| place.is_some_and(|held| held.at.distance(last.at) < SPACING);
        if is_even(i)
            && is_straight(i)
            && is_straight(i + 1)
            && kept.last().is_some_and(|last| last.as_ref().is_some_and(is_near))
        {
            continue;
        }
        kept.push(*place);
    }
    kept
}

/// Rounds of thinning a piece whose outline still exceeds the box between its points, as where two borders alternate.
const ROUNDS: usize = 4;

/// One run of points as a mark.
fn piece(stroke: &Stroke, mut run: Vec<Held>, is_ring: bool, rect: Rect) -> Option<Mark> {
    if !is_ring && stroke.ends == Ends::Round {
        trim(&mut run);
        run.reverse();
        trim(&mut run);
        run.reverse();
    }
    if run.len() < 2 {
        return None;
    }
    if is_ring {
        // At a corner the seam has two normals.
        let (first, last) = (run[0], run.len() - 1);
        run[last] = Held { at: first.at, width: first.width, ..run[last] };
    }
    let mut curve = BezPath::new();
    curve.move_to(run[0].at);
    for held in &run[1..] {
        match held.stretch {
            Stretch::Curve(c) => curve.curve_to(c.p1, c.p2, held.at),
            Stretch::Straight => curve.line_to(held.at),
        }
    }
    if is_ring {
        curve.close_path();
    }
    let mut piece = stroke.along(curve, &run.iter().map(|held| held.node).collect::<Vec<_>>())?;
    let mut widths = fitted(&run, rect);
    for _ in 0..ROUNDS {
        piece = piece.with_width(match stroke.width() {
            Width::Constant(width) if widths.iter().all(|w| (w - width).abs() < 1e-9) => Width::Constant(*width),
            _ => Width::Along(widths.clone()),
        })?;
        let excess = beyond(piece.ink_outline(RIM).bounding_box(), rect.inflate(RIM, RIM));
        if excess <= 0.0 {
            break;
        }
        let moved = widths.iter_mut().zip(&run).filter(|(_, held)| held.is_moved);
        moved.for_each(|(width, _)| *width = (*width - 2.0 * (excess + RIM)).max(0.0));
    }
    Some(Mark::Stroke(piece))
}

/// How far a rectangle extends beyond another.
fn beyond(inner: Rect, outer: Rect) -> f64 {
    (outer.x0 - inner.x0).max(inner.x1 - outer.x1).max(outer.y0 - inner.y0).max(inner.y1 - outer.y1)
}

/// Steepest slope of the half width along a stroke that ends at the border: anything steeper lies within the round end before it.
const STEEPEST: f64 = 0.7;

/// Removes points at the end that lie within the round end before them.
fn trim(run: &mut Vec<Held>) {
    while let [_, .., before, last] = run[..] {
        let fall = 0.5 * (before.width - last.width);
        if !last.is_moved || fall < STEEPEST * before.at.distance(last.at) {
            break;
        }
        run.pop();
    }
}

/// The widths, reduced where a segment that turned with its moved centre would put a corner outside.
fn fitted(run: &[Held], rect: Rect) -> Vec<f64> {
    let mut widths: Vec<f64> = run.iter().map(|held| held.width).collect();
    for i in 1..run.len() {
        let way = run[i].at - run[i - 1].at;
        if !(run[i].is_moved || run[i - 1].is_moved) || way.hypot() < 1e-9 {
            continue;
        }
        let beside = way.normalize().turn_90();
        for k in [i - 1, i] {
            let half = beside * (0.5 * run[k].width);
            let share = inside(run[k].at, half, rect).map_or(0.0, |(low, high)| (-low).min(high));
            widths[k] = widths[k].min(run[k].width * share.max(0.0));
        }
    }
    widths
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOX: Rect = Rect::new(0.0, 0.0, 20.0, 20.0);

    fn stroke(path: &str, width: f64, ends: Ends) -> Mark {
        Mark::Stroke(Stroke::even(BezPath::from_svg(path).unwrap(), width).with_ends(ends))
    }

    fn outline(mark: &Mark) -> BezPath {
        match mark {
            Mark::Dot(dot) => dot.path(),
            Mark::Stroke(stroke) => stroke.ink_outline(1e-4),
            Mark::Area(area) => area.outline.clone(),
        }
    }

    /// The ink of one stroke kept in the box, checked to lie inside.
    fn held_ink(mark: Mark) -> f64 {
        let held = mark.confined_to(BOX);
        for mark in &held {
            let bounds = outline(mark).bounding_box();
            assert!(BOX.inflate(1e-6, 1e-6).union(bounds) == BOX.inflate(1e-6, 1e-6), "{bounds:?}");
        }
        held.iter().map(Mark::area).sum()
    }

    #[test]
    fn a_line_along_the_border_keeps_the_half_inside() {
        for ends in [Ends::Round, Ends::Flat] {
            let ink = held_ink(stroke("M2,0.1 L18,0.1", 1.0, ends));
            assert!((ink / (16.0 * 0.6) - 1.0).abs() < 0.03, "{ink}");
        }
    }

    #[test]
    fn a_line_that_crosses_the_border_ends_there() {
        let flat = held_ink(stroke("M10,-5 L10,10", 1.0, Ends::Flat));
        assert!((flat - 10.0).abs() < 0.01, "{flat}");
        let round = held_ink(stroke("M10,-5 L10,10", 1.0, Ends::Round));
        // A half disc at the lower end; at the border the corners beside another are lost.
        let expected = 10.0 + std::f64::consts::FRAC_PI_8 - 0.5 * (1.0 - std::f64::consts::FRAC_PI_4);
        assert!((round - expected).abs() < 0.02, "{round} of {expected}");
    }

    #[test]
    fn an_engraving_line_is_cut_along_the_border() {
        let slanting = Stroke::swelling(BezPath::from_svg("M5,-5 L15,5").unwrap(), vec![1.0, 1.0]).unwrap();
        let ink = held_ink(Mark::Stroke(slanting.with_ends(Ends::Flat)));
        // Turning towards the border it loses a little.
        assert!((ink - 50.0_f64.sqrt()).abs() < 0.1, "{ink}");
    }

    #[test]
    fn slanting_lines_rings_and_corners_stay_inside() {
        for path in ["M-3,4 L9,-2", "M-3,-3 L6,6", "M15,21 C18,21 21,18 21,15", "M-1,10 L21,10.5", "M1,1 L19,1 L19,19 L1,19 Z"] {
            for (ends, width) in [(Ends::Round, 0.4), (Ends::Flat, 0.4), (Ends::Round, 3.0), (Ends::Flat, 3.0)] {
                held_ink(stroke(path, width, ends));
            }
        }
        let ring = kurbo::Circle::new((10.0, 10.0), 9.9).to_path(1e-3);
        let mark = Mark::Stroke(Stroke::even(ring, 0.6));
        let held = mark.confined_to(BOX);
        assert!(matches!(&held[..], [Mark::Stroke(ring)] if ring.is_closed()), "it stays a ring");
    }

    #[test]
    fn pressure_and_times_go_with_their_places() {
        let stroke = Stroke::even(BezPath::from_svg("M10,10 L10,-10").unwrap(), 0.5);
        let stroke = stroke.with_pressure(vec![0.0, 1.0]).and_then(|stroke| stroke.with_times(vec![4.0, 6.0]));
        let held = Mark::Stroke(stroke.unwrap()).confined_to(BOX);
        let [Mark::Stroke(held)] = &held[..] else { panic!("one stroke") };
        let (pressure, times) = (held.pressure().unwrap(), held.times().unwrap());
        assert_eq!(pressure.len(), held.nodes().count());
        assert!((pressure[pressure.len() - 1] - 0.4875).abs() < 0.005 && (times[times.len() - 1] - 4.975).abs() < 0.01);
    }

    #[test]
    fn what_is_inside_is_not_touched() {
        let mark = stroke("M2,2 C5,9 9,5 12,12", 1.0, Ends::Round);
        assert_eq!(mark.clone().confined_to(BOX), [mark]);
    }
}
