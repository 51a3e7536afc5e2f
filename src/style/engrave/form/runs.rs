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
                None if !cut && is_own(end.place) => self.beyond(end),
                None => 0.0,
            };
            let from = before.map_or(first.along, |b| crossing(&b, first)) - beyond(first, before.is_some(), over[0]);
            let to = after.map_or(last.along, |a| crossing(last, &a)) + beyond(last, after.is_some(), over[1]);
            let ends = |end: &Reading, cut: bool, over: Option<f64>| over.is_none() && (cut || is_own(end.place));
            let tapers = [ends(first, before.is_some(), over[0]), ends(last, after.is_some(), over[1])];
            let least = if self.breaks.is_none() { TICK } else { CRUMB };
            if (self.breaks.is_none() || tapers == [false; 2]) && to - from < least * self.pitch {
                continue;
            }
            pieces.extend(self.piece(run, from, to, tapers));
        }
        pieces
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
        /// where all do so at one tone, its border is the border of a plate, and crossing lines are a block with combs at its ends.
        const BREAKS: f64 = 0.3;
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

    fn piece(&self, run: &[Reading], from: f64, to: f64, tapers: [bool; 2]) -> Option<Piece> {
        /// Distance of a stroke's nodes in pitches.
        const NODE: f64 = 0.7;
        /// A line that ends of itself tapers over this many pitches to this share of its width; so does one where its family
        /// begins. A crossing line tapers over more.
        const TAPER: [f64; 2] = [1.5, 4.0];
        const TIP: f64 = 0.25;
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
        let mut piece = Piece { nodes: Vec::new(), widths: Vec::new(), ceilings: Vec::new() };
        for i in 0..=count {
            let at = from + length * i as f64 / count as f64;
            let reading = between(run, at);
            let rise = |is_tapered: bool, away: f64| if is_tapered { TIP + (1.0 - TIP) * (away / taper).min(1.0) } else { 1.0 };
            piece.nodes.push(reading.place);
            piece.widths.push(reading.width * rise(tapers[0], at - from).min(rise(tapers[1], to - at)));
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
