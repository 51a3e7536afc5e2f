//! From lines to the pieces that are drawn: widths by ink, dots and dashes in the lights, tapered ends.

use super::families::Family;
use crate::drawing::{Dot, Mark, Stroke};
use crate::elementary::unit_at;
use crate::field::{over_the_border, pieces_inside};
use crate::geometry::{Ends, Point, Rect, Ring, catmull_rom, lengths_along, resample};
use crate::parallel::collected;
use crate::raster::Raster;
use crate::source::Placement;

/// Distance of readings along a line in pitches: the smallest dash between two of them is lost.
const READING: f64 = 0.1;
/// The widest line in distances of lines: a little more than all of it closes the slits between curved lines.
const WIDEST: f64 = 1.04;
/// The golden section: neighbouring multiples of it have parts far from one another.
const GOLDEN: f64 = 0.618_033_988_75;

/// One piece of a line, in working pixels; a piece of one node is a dot with its diameter.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub nodes: Vec<Point>,
    pub widths: Vec<f64>,
    /// The widest that it may become at each node.
    pub ceilings: Vec<f64>,
}

/// How a family is drawn.
pub(super) struct Course<'a> {
    pub family: &'a Family,
    /// The directions on the working grid, and the family's turn from them, in radians.
    pub directions: &'a Raster<f32>,
    pub turn: f64,
    /// Ink that it carries, 0 to 1.
    pub ink: &'a Raster<f32>,
    /// Where it is drawn: from 0.5 on.
    pub region: &'a Raster<f32>,
    /// The family at whose lines thin lines keep their dashes; without it this is a crossing family, whose lines end instead.
    pub breaks: Option<&'a Family>,
    /// Share of the spacing below which a line is not drawn thinner, but broken.
    pub thinnest: f64,
    /// Diameter of the smallest dot in pixels.
    pub dot_min: f64,
    pub pitch: f64,
    /// The picture in working pixels.
    pub picture: Rect,
    /// The soft silhouette on which strokes of hair end in tips; none for other lines.
    pub silhouette: Option<&'a Raster<f32>>,
}

/// How a piece ends.
#[derive(Clone, Copy, PartialEq)]
enum End {
    /// Cut by a border.
    Cut,
    /// Where the line or its family ends.
    Thin,
    /// As hair does.
    Tip,
}

/// What is read at one place of a line.
#[derive(Clone, Copy)]
struct Reading {
    place: Point,
    along: f64,
    width: f64,
    spacing: f64,
    /// Above 0 where the line is drawn.
    excess: f64,
}

impl Course<'_> {
    /// All pieces, line by line.
    pub(super) fn pieces(&self) -> Vec<Piece> {
        collected(self.family.lines.len(), &|i| self.of_line(i)).into_iter().flatten().collect()
    }

    fn of_line(&self, i: usize) -> Vec<Piece> {
        let line = &self.family.lines[i];
        let stagger = 2.0 * (GOLDEN * i as f64).fract() - 1.0;
        let mut points = line.points.clone();
        if line.closed {
            points.push(points[0]);
        }
        let own = [points[0], points[points.len() - 1]].map(|end| (!line.closed).then_some(end));
        let inside = pieces_inside(&points, self.region);
        inside.iter().flat_map(|points| self.of_piece(points, own, stagger)).collect()
    }

    /// The drawn runs of a line inside the region; `own` are the ends of the whole line, `stagger` (-1 to 1) is by how much it ends before
    /// or after its neighbours.
    fn of_piece(&self, points: &[Point], own: [Option<Point>; 2], stagger: f64) -> Vec<Piece> {
        /// Pieces that the surface's border cuts on both sides are left out below this length in pitches, and those of crossing
        /// families at all: they are crumbs and ticks.
        const CRUMB: f64 = 1.5;
        const TICK: f64 = 4.5;
        /// Strokes of hair on the silhouette that are shorter, in pitches, are crumbs beside it.
        const LEAST_HAIR: f64 = 4.0;
        /// How far a stroke of hair goes beyond the silhouette, in pitches, and by how much more or less from stroke to stroke.
        const BEYOND_TIP: f64 = 0.3;
        const UNEVEN_TIP: f64 = 0.8;
        let nodes = resample(points, READING * self.pitch);
        let along = lengths_along(&nodes);
        let mut readings: Vec<Reading> = nodes.iter().zip(&along).map(|(p, along)| self.read(*p, *along, stagger)).collect();
        self.cut_hooks(&mut readings);
        let is_own = |p: Point| own.iter().flatten().any(|end| end.distance(p) < self.pitch);
        let [over_first, over_last] = self.over_the_border(&readings);
        let end = readings.len();
        let mut pieces = Vec::new();
        let mut start = 0;
        for run in readings.chunk_by(|a, b| (a.excess > 0.0) == (b.excess > 0.0)) {
            let range = start..start + run.len();
            start += run.len();
            if run[0].excess <= 0.0 {
                continue;
            }
            let (first, last) = (&run[0], &run[run.len() - 1]);
            let before = range.start.checked_sub(1).map(|i| readings[i]);
            let after = readings.get(range.end).copied();
            let over = [over_first.filter(|_| range.start == 0), over_last.filter(|_| range.end == end)];
            let beyond = |end: &Reading, cut: bool, over: Option<f64>| match over {
                Some(over) => over,
                None if !cut && self.is_tip(end.place) => (BEYOND_TIP + UNEVEN_TIP * stagger) * self.pitch,
                None if !cut && is_own(end.place) => self.beyond(end),
                None => 0.0,
            };
            let from = before.map_or(first.along, |b| crossing(&b, first)) - beyond(first, before.is_some(), over[0]);
            let to = after.map_or(last.along, |a| crossing(last, &a)) + beyond(last, after.is_some(), over[1]);
            let end_of = |end: &Reading, cut: bool, over: Option<f64>| match over {
                None if !cut && self.is_tip(end.place) => End::Tip,
                None if cut || is_own(end.place) => End::Thin,
                _ => End::Cut,
            };
            let ends = [end_of(first, before.is_some(), over[0]), end_of(last, after.is_some(), over[1])];
            let least = if self.breaks.is_none() { TICK } else { CRUMB };
            let is_short = (self.breaks.is_none() || ends == [End::Cut; 2]) && to - from < least * self.pitch;
            if is_short || (ends.contains(&End::Tip) && to - from < LEAST_HAIR * self.pitch) {
                continue;
            }
            pieces.extend(self.piece(run, from, to, ends));
        }
        pieces
    }

    /// True where a stroke of hair ends on the silhouette.
    fn is_tip(&self, end: Point) -> bool {
        /// The silhouette's share within a pitch of it.
        const BESIDE: f32 = 0.85;
        self.silhouette.is_some_and(|soft| soft.sample(end.x, end.y) < BESIDE)
    }

    /// How far a line goes on beyond its end: between its neighbours, which close up behind it, a slit would shine in the darks.
    fn beyond(&self, end: &Reading) -> f64 {
        /// In pitches, in black, and the share of the spacing that is white from which nothing shines.
        const BEYOND: f64 = 1.6;
        const WHITE: f64 = 0.7;
        let white = 1.0 - end.width / end.spacing.max(1e-6);
        BEYOND * self.pitch * (1.0 - white / WHITE).clamp(0.0, 1.0)
    }

    /// How far a line goes straight on beyond its first and its last reading, where it runs over the picture's border: until all of
    /// its width is outside. The drawing is cut at the border.
    fn over_the_border(&self, readings: &[Reading]) -> [Option<f64>; 2] {
        /// Distance from the border, in pitches, within which a line runs over it.
        const REACH: f64 = 1.0;
        let [Some(first), Some(last)] = [readings.get(..2), readings.len().checked_sub(2).map(|i| &readings[i..])] else {
            return [None; 2];
        };
        // What ends before it, at the surface's own border, does not.
        let is_surface = |p: Point| self.region.clamped(p.x as isize, p.y as isize) >= 0.5;
        [[&first[1], &first[0]], [&last[0], &last[1]]].map(|[before, end]| {
            let reach = (REACH * self.pitch, 0.5 * end.spacing);
            over_the_border([before.place, end.place], self.picture, reach, &is_surface)
        })
    }

    /// Where two lines end side by side the phase joins them in a hook; what turns away from the directions is not drawn.
    fn cut_hooks(&self, readings: &mut [Reading]) {
        /// Length over which a line's own direction is measured, in pitches, and the sine of the angle from the directions at
        /// which it is a hook.
        const HOOK: f64 = 0.8;
        const MOST_OFF: f64 = 0.6;
        let reach = (0.5 * HOOK / READING) as usize;
        let places: Vec<Point> = readings.iter().map(|r| r.place).collect();
        let last = places.len() - 1;
        for (i, reading) in readings.iter_mut().enumerate() {
            let way = places[(i + reach).min(last)] - places[i.saturating_sub(reach)];
            let p = reading.place;
            let angle = f64::from(self.directions.clamped(p.x as isize, p.y as isize)) + self.turn;
            if way.cross(unit_at(angle)).abs() > MOST_OFF * way.hypot() {
                reading.excess = reading.excess.min(-0.5);
            }
        }
    }

    fn read(&self, place: Point, along: f64, stagger: f64) -> Reading {
        /// By how much the ink varies from line to line at which lines break into dashes, as a share, and at which crossing lines begin:
        /// where all do so at one tone, its border is the border of a plate, and crossing lines are a block with combs at its ends. With 0.3 single
        /// dashed lines run through whole ones on foreheads (07, 12).
        const BREAKS: f64 = 0.14;
        const BEGINS: f64 = 0.07;
        let ink = f64::from(self.ink.sample(place.x, place.y));
        let spacing = self.family.spacing(place).min(2.0 * self.pitch);
        let thinnest = self.thinnest * (1.0 + BREAKS * stagger);
        let (width, excess) = match self.breaks {
            Some(breaks) if ink < thinnest => (thinnest, ink / thinnest - breaks.away(place)),
            Some(_) => (ink, ink - 1e-3),
            None => (ink, ink - 1e-3 - BEGINS * (1.0 + stagger)),
        };
        Reading { place, along, width: width * spacing, spacing, excess }
    }

    fn piece(&self, run: &[Reading], from: f64, to: f64, ends: [End; 2]) -> Option<Piece> {
        /// Distance of a stroke's nodes in pitches.
        const NODE: f64 = 0.7;
        /// A line that ends of itself tapers over this many pitches to this share of its width; so does one where its family
        /// begins. A crossing line tapers over more.
        const TAPER: [f64; 2] = [1.5, 4.0];
        const TIP: f64 = 0.25;
        /// The same where hair ends on the silhouette: cut at their full width, its strokes are the teeth of a comb.
        const HAIR_TAPER: f64 = 4.0;
        const HAIR_TIP: f64 = 0.08;
        /// Pieces shorter than this many widths are dots.
        const DOT: f64 = 1.6;
        let widest = run.iter().map(|r| r.width).fold(0.0, f64::max);
        let length = to - from;
        if length < DOT * widest {
            let middle = run[run.len() / 2];
            let diameter = (4.0 / std::f64::consts::PI * length * widest).sqrt();
            let is_drawn = diameter >= self.dot_min;
            return is_drawn.then(|| Piece { nodes: vec![middle.place], widths: vec![diameter], ceilings: vec![middle.spacing] });
        }
        let count = (length / (NODE * self.pitch)).ceil().max(2.0) as usize;
        let taper = (TAPER[usize::from(self.breaks.is_none())] * self.pitch).min(0.45 * length);
        let hair_taper = (HAIR_TAPER * self.pitch).min(0.45 * length);
        let mut piece = Piece { nodes: Vec::new(), widths: Vec::new(), ceilings: Vec::new() };
        for i in 0..=count {
            let at = from + length * i as f64 / count as f64;
            let reading = between(run, at);
            let rise = |end: End, away: f64| match end {
                End::Cut => 1.0,
                End::Thin => TIP + (1.0 - TIP) * (away / taper).min(1.0),
                End::Tip => HAIR_TIP + (1.0 - HAIR_TIP) * (away / hair_taper).min(1.0),
            };
            piece.nodes.push(reading.place);
            piece.widths.push(reading.width * rise(ends[0], at - from).min(rise(ends[1], to - at)));
            piece.ceilings.push(WIDEST * reading.spacing);
        }
        Some(piece)
    }
}

/// Where along the line it begins or ends to be drawn.
fn crossing(a: &Reading, b: &Reading) -> f64 {
    a.along + (b.along - a.along) * (a.excess / (a.excess - b.excess)).clamp(0.0, 1.0)
}

/// The reading at a length along the line, straight between readings and beyond the run's ends.
fn between(run: &[Reading], along: f64) -> Reading {
    if run.len() == 1 {
        return run[0];
    }
    let i = run.partition_point(|r| r.along < along).clamp(1, run.len() - 1);
    let (a, b) = (run[i - 1], run[i]);
    let t = (along - a.along) / (b.along - a.along).max(1e-9);
    let inner = t.clamp(0.0, 1.0);
    let mix = |x: f64, y: f64| x + (y - x) * inner;
    Reading { place: a.place.lerp(b.place, t), along, width: mix(a.width, b.width), spacing: mix(a.spacing, b.spacing), ..a }
}

impl Piece {
    /// The mark on the page; none without ink.
    pub(super) fn mark(&self, placement: &Placement) -> Option<Mark> {
        let scale = placement.mm_per_pixel();
        let places: Vec<Point> = self.nodes.iter().map(|p| placement.to_page(*p)).collect();
        if let [place] = places.as_slice() {
            return (self.widths[0] > 0.0).then(|| Mark::Dot(Dot::circle(*place, 0.5 * self.widths[0] * scale)));
        }
        let widths: Vec<f64> = self.widths.iter().map(|w| w * scale).collect();
        let stroke = Stroke::swelling(catmull_rom(&places, Ring::Open), widths)?;
        Some(Mark::Stroke(stroke.with_ends(Ends::Flat)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::Drawer;
    use super::super::super::parameters::EngraveParameters;
    use crate::geometry::Point;
    use crate::raster::{Raster, gaussian_blur};
    use crate::source::MaskRole;
    use crate::style::form::mean_portrait;
    use crate::style::{Settings, Silent};

    #[test]
    fn strokes_of_hair_end_on_the_silhouette_in_tips() {
        let mut portrait = mean_portrait(10.0, 0.0, |_| 60);
        let (brow, middle) = (portrait.faces[0].point(9).y, portrait.faces[0].point(4));
        let radius = 0.6 * portrait.faces[0].width();
        portrait.subject = Raster::from_fn(portrait.subject.width(), portrait.subject.height(), |x, y| {
            f32::from(u8::from(middle.distance(Point::new(x as f64, y as f64)) < radius))
        });
        let hair = Raster::from_fn(portrait.subject.width(), portrait.subject.height(), |x, y| {
            if (y as f64) < brow { portrait.subject.get(x, y) } else { 0.0 }
        });
        portrait.masks.insert(MaskRole::Hair, hair);
        let parameters = crate::style::find("engrave").expect("a style").parameters();
        let settings = Settings::resolve("engrave", parameters, &[]).expect("defaults");
        let drawer = Drawer { portrait: &portrait, parameters: EngraveParameters::new(&settings), seed: 0, observer: &Silent };
        let surfaces = drawer.surfaces(&portrait.subject);
        let directions = drawer.directions(&surfaces);
        let ink = portrait.subject.map(|subject| 0.8 * subject);
        let [first, ..] = drawer.lines(&surfaces, &directions, &ink.map(|_| 0.0), &ink).expect("it is not cancelled");
        let soft = gaussian_blur(&portrait.subject, drawer.pitch() as f32);
        let ends = first.iter().filter(|piece| piece.nodes.len() > 4).flat_map(|piece| {
            let last = piece.nodes.len() - 1;
            let widest = piece.widths.iter().copied().fold(0.0, f64::max);
            [0, last].map(|i| (piece.nodes[i], piece.widths[i] / widest))
        });
        let tips: Vec<f64> = ends.filter(|(p, _)| p.y < brow && soft.sample(p.x, p.y) < 0.6).map(|(_, width)| width).collect();
        assert!(tips.len() > 5, "{}", tips.len());
        let thin = tips.iter().filter(|width| **width < 0.1).count();
        assert!(4 * thin >= 3 * tips.len(), "{tips:?}");
    }
}
