//! Interruptions of a line that keep its ink: dashes and dots in light tones, white crossing lines in an engraving.

use super::lines::Family;
use super::region_map::Grid;
use super::span::Span;
use super::widths::{LineReading, LineReadings};
use crate::geometry::{Point, Rect, radius_for_area};
use crate::raster::Raster;

/// Interruption of a family's lines.
#[derive(Clone, Copy)]
pub(super) struct LineBreaks<'a> {
    /// Dashes stand midway between the lines of this family.
    pub between: &'a Family,
    /// Number of those lines from one dash to the next.
    pub period: f64,
    /// True if the dashes of every second line are shifted by half a period.
    pub is_staggered: bool,
    /// Share of the paper that the other layer's lines cover; dashes stand in the gaps.
    pub cover: Option<&'a Raster<f32>>,
    pub grid: Grid,
    /// Width below which a line at full spacing breaks, in millimetres.
    pub thinnest: f64,
    /// Ink from which lines of an engraving are unbroken, and the maximum share of their length that is cut out.
    pub interruption: Option<(f64, f64)>,
    /// True if only dots are drawn.
    pub is_stippled: bool,
    pub dot_min: f64,
}

/// A piece of a line, by position along it.
#[derive(Clone, Debug)]
pub(super) enum Piece {
    /// A stroke through the given positions, with the full width at each.
    Dash {
        places: Vec<(f64, f64)>,
        tapers: [f64; 2],
    },
    Dot {
        at: f64,
        radius: f64,
    },
}

/// One reading of a line in a span.
struct Reading {
    at: f64,
    /// Width of the whole line.
    width: f64,
    room: f64,
    stretch: f64,
    strip: f64,
    /// Share of the length that is drawn, 0 to 1.
    duty: f64,
    /// Share of the line's ink that the dashes carry.
    carried: f64,
    /// Position in the dash pattern: dashes are centred on half-integers.
    phase: f64,
}

/// A drawn stretch of a line.
#[derive(Clone, Copy, Debug)]
struct Run {
    from: f64,
    to: f64,
}

impl Reading {
    /// Above 0 where the line is drawn.
    fn excess(&self) -> f64 {
        if self.duty >= 1.0 { 1.0 } else { self.duty - 2.0 * (self.phase.rem_euclid(1.0) - 0.5).abs() }
    }

    /// Ink of the line per millimetre of length.
    fn ink(&self) -> f64 {
        self.width * self.carried * self.stretch
    }

    /// Width of the dashes.
    fn dash_width(&self) -> f64 {
        if self.duty >= 1.0 { self.width } else { self.width * self.carried / self.duty.max(0.05) }
    }
}

impl LineBreaks<'_> {
    /// The pieces of one line.
    pub(super) fn pieces(&self, courses: &LineReadings<'_>, k: usize) -> Vec<Piece> {
        /// Dashes shorter than this become dots, in pitches.
        const LEAST_DASH: f64 = 0.5;
        /// The golden section, which spreads the starting phases of lines.
        const GOLDEN: f64 = 0.618_033_988_749_895;
        let course = &courses.lines[k];
        let mut pieces = Vec::new();
        // Ink too small for a dot is carried over to the next one.
        let least_dot = std::f64::consts::FRAC_PI_4 * self.dot_min * self.dot_min;
        let mut carry = (k as f64 * GOLDEN).fract() * least_dot;
        for &span in &course.spans {
            let readings = self.readings(courses, k, span);
            let runs = self.runs(&readings, courses.family);
            let ink = Ink::new(&readings);
            for (i, run) in runs.iter().enumerate() {
                let before = i.checked_sub(1).map_or(span.from, |i| 0.5 * (runs[i].to + run.from));
                let after = runs.get(i + 1).map_or(span.to, |next| 0.5 * (run.to + next.from));
                let mut wanted = ink.between(before, after) + carry;
                // Ink of the gap left before a border goes to the adjacent piece.
                if i == 0 {
                    wanted += span.lacking[0] * readings[0].ink();
                }
                if i + 1 == runs.len() {
                    wanted += span.lacking[1] * readings[readings.len() - 1].ink();
                }
                let is_whole = run.to - run.from >= LEAST_DASH * courses.family.pitch && !self.is_stippled;
                if is_whole {
                    pieces.push(dash(&readings, *run, span, wanted, courses.family.pitch));
                    carry = 0.0;
                } else if wanted >= least_dot {
                    pieces.push(self.dot(&readings, *run, span, wanted, after - before));
                    carry = 0.0;
                } else {
                    carry = wanted;
                }
            }
        }
        pieces
    }

    fn readings(&self, courses: &LineReadings<'_>, k: usize, span: Span) -> Vec<Reading> {
        let (course, line) = (&courses.lines[k], &courses.family.lines[k]);
        let step = courses.step();
        let inner = courses.readings_in(span);
        let places = std::iter::once(span.from)
            .chain(inner.map(|r| courses.place(r)).filter(|u| *u > span.from + 0.05 * step && *u < span.to - 0.05 * step))
            .chain(std::iter::once(span.to));
        let mut hint = self.between.bases.len() / 2;
        let mut readings: Vec<Reading> = places
            .map(|at| {
                let value = |values: &[f32]| interpolate(course, values, (at - courses.place(course.first)) / step);
                let x = ((at - courses.family.first) / courses.family.step - line.first as f64).max(0.0);
                let height = between(&line.heights, x);
                let place = courses.family.frame.to_page(at, height);
                let ink = value(&course.ink);
                let cover = self.cover.map_or(0.0, |cover| f64::from(self.grid.read(cover, place)));
                let (duty, carried) = self.duty(ink, courses.family.pitch, cover);
                let phase = if duty < 1.0 && !self.is_stippled { self.phase(place, k, &mut hint) } else { 0.0 };
                let (width, room) = (value(&course.width), value(&course.room).min(courses.rim(line, at).width));
                Reading { at, width, room, stretch: value(&course.stretch), strip: value(&course.strip), duty, carried, phase }
            })
            .collect();
        if self.is_stippled {
            space_stipples(&mut readings, k, courses.family.pitch);
        }
        readings
    }

    /// The share of the length that is drawn, and the share of the line's ink that this carries.
    fn duty(&self, ink: f64, pitch: f64, cover: f64) -> (f64, f64) {
        if self.is_stippled {
            return (0.0, 1.0);
        }
        let mut duty = if self.thinnest > 0.0 { (ink * pitch / self.thinnest).min(1.0) } else { 1.0 };
        if let Some((whole, most)) = self.interruption {
            let t = ((whole - ink) / (0.5 * whole).max(1e-6)).clamp(0.0, 1.0);
            duty = duty.min(1.0 - most * t * t * (3.0 - 2.0 * t));
        }
        // Dashes in the gaps of the other layer do not overlap its lines, so they need less ink.
        if duty < 1.0 { (duty * (1.0 - cover), 1.0 - cover) } else { (1.0, 1.0) }
    }

    fn phase(&self, place: Point, k: usize, hint: &mut usize) -> f64 {
        let index = self.between.index_at(place, hint);
        let shift = if self.is_staggered && k % 2 == 1 { 0.5 } else { 0.0 };
        index / self.period + shift
    }

    /// Drawn stretches in order; a dot is a stretch of zero length.
    fn runs(&self, readings: &[Reading], family: &Family) -> Vec<Run> {
        let mut runs: Vec<Run> = Vec::new();
        let mut open: Option<f64> = (readings[0].excess() > 0.0).then_some(readings[0].at);
        for pair in readings.windows(2) {
            let (a, b) = (&pair[0], &pair[1]);
            let (ea, eb) = (a.excess(), b.excess());
            let crossing = a.at + (b.at - a.at) * ea / (ea - eb);
            match (ea > 0.0, eb > 0.0) {
                (false, true) => open = Some(crossing),
                (true, false) => runs.extend(open.take().map(|from| Run { from, to: crossing })),
                (false, false) => runs.extend(centre(a, b).filter(|_| a.width > 0.0).map(|at| Run { from: at, to: at })),
                (true, true) => {}
            }
        }
        runs.extend(open.map(|from| Run { from, to: readings[readings.len() - 1].at }));
        let gap = family.gap.distance;
        let mut joined: Vec<Run> = Vec::with_capacity(runs.len());
        for run in runs {
            match joined.last_mut() {
                Some(last) if run.from - last.to < gap && !self.is_stippled => last.to = run.to,
                _ => joined.push(run),
            }
        }
        joined
    }

    fn dot(&self, readings: &[Reading], run: Run, span: Span, area: f64, length: f64) -> Piece {
        let middle = 0.5 * (run.from + run.to);
        let nearest = &readings[readings.partition_point(|r| r.at < middle).min(readings.len() - 1)];
        let radius = if self.is_stippled {
            let (length, strip) = (length * nearest.stretch, nearest.strip);
            let cell = Rect::new(-0.5 * length, -0.5 * strip, 0.5 * length, 0.5 * strip);
            let corners = [(cell.x0, cell.y0), (cell.x1, cell.y0), (cell.x1, cell.y1), (cell.x0, cell.y1)].map(Point::from);
            radius_for_area(&corners, Point::ORIGIN, area.min(0.999 * cell.area())).min(0.75 * length.max(strip))
        } else {
            (area / std::f64::consts::PI).sqrt()
        };
        let room = (0.5 * (span.to - span.from)).min(radius);
        // The least and the greatest place may differ by rounding alone.
        Piece::Dot { at: middle.min(span.to - room).max(span.from + room), radius }
    }
}

/// Sets the phases of a line's stipples: as far apart as the line is from its neighbours, those of every second line shifted by half. At
/// the crossings of another family they would run together wherever the two families are sheared.
fn space_stipples(readings: &mut [Reading], k: usize, pitch: f64) {
    let spaces = |r: &Reading| r.stretch / r.strip.clamp(0.5 * pitch, 2.0 * pitch);
    readings[0].phase = readings[0].at / pitch + 0.5 * (k % 2) as f64;
    for i in 1..readings.len() {
        let (before, after) = (&readings[i - 1], &readings[i]);
        let gained = 0.5 * (spaces(before) + spaces(after)) * (after.at - before.at);
        readings[i].phase = before.phase + gained;
    }
}

/// Position of a dash's middle between two readings, if there is one.
fn centre(a: &Reading, b: &Reading) -> Option<f64> {
    let (low, high) = (a.phase.min(b.phase), a.phase.max(b.phase));
    let middle = (low - 0.5).floor() + 1.5;
    (middle <= high && high - low < 0.9).then(|| a.at + (b.at - a.at) * (middle - a.phase) / (b.phase - a.phase))
}

/// Longest taper of a dash, in pitches.
const DASH_TAPER: f64 = 0.6;

/// A dash over a run with `wanted` ink, as far as there is room.
fn dash(readings: &[Reading], run: Run, span: Span, wanted: f64, pitch: f64) -> Piece {
    let length = run.to - run.from;
    let taper = (0.45 * length).min(DASH_TAPER * pitch);
    let tapers = [
        if run.from <= span.from && span.is_cut[0] { 0.0 } else { taper },
        if run.to >= span.to && span.is_cut[1] { 0.0 } else { taper },
    ];
    let inner = readings.iter().filter(|r| r.at > run.from && r.at < run.to);
    let at = |place: f64| {
        let i = readings.partition_point(|r| r.at < place).clamp(1, readings.len() - 1);
        let (a, b) = (&readings[i - 1], &readings[i]);
        let t = ((place - a.at) / (b.at - a.at).max(1e-12)).clamp(0.0, 1.0);
        let mix = |x: f64, y: f64| x * (1.0 - t) + y * t;
        (place, mix(a.dash_width(), b.dash_width()), mix(a.room, b.room), mix(a.stretch, b.stretch))
    };
    let profile: Vec<(f64, f64, f64, f64)> = std::iter::once(at(run.from))
        .chain(inner.map(|r| (r.at, r.dash_width(), r.room, r.stretch)))
        .chain(std::iter::once(at(run.to)))
        .collect();
    let shaped = |&(u, width, ..): &(f64, f64, f64, f64)| width * taper_at(u, run.from, run.to, tapers);
    let laid: f64 = profile.windows(2).map(|p| 0.5 * (p[1].0 - p[0].0) * (shaped(&p[0]) * p[0].3 + shaped(&p[1]) * p[1].3)).sum();
    let factor = if laid > 0.0 { wanted / laid } else { 0.0 };
    let places = profile.iter().map(|&(u, width, room, _)| (u, (width * factor).min(room))).collect();
    Piece::Dash { places, tapers }
}

/// Width of a dash's end as a fraction of the dash's width.
const END_WIDTH: f64 = 0.25;

/// Share of its width that a dash keeps near its ends.
pub(super) fn taper_at(u: f64, from: f64, to: f64, tapers: [f64; 2]) -> f64 {
    let rise = |away: f64, length: f64| {
        if length <= 0.0 || away >= length {
            return 1.0;
        }
        // A cubic: steep at the end's width and level at the full width.
        let t = (away / length).max(0.0);
        let (t2, t3) = (t * t, t * t * t);
        let (low, slope) = (END_WIDTH, 1.0 - END_WIDTH);
        (2.0 * t3 - 3.0 * t2 + 1.0) * low + (t3 - 2.0 * t2 + t) * slope + (3.0 * t2 - 2.0 * t3)
    };
    rise(u - from, tapers[0]).min(rise(to - u, tapers[1]))
}

fn between(values: &[f64], x: f64) -> f64 {
    let i = (x as usize).min(values.len() - 1);
    let t = x - i as f64;
    values[i] * (1.0 - t) + values[(i + 1).min(values.len() - 1)] * t
}

/// Interpolates between existing readings; beyond them takes the nearest.
fn interpolate(course: &LineReading, values: &[f32], x: f64) -> f64 {
    let last = values.len() - 1;
    let i = (x.max(0.0) as usize).min(last);
    let j = (i + 1).min(last);
    let t = (x - i as f64).clamp(0.0, 1.0);
    match (course.weight[i] > 0.0, course.weight[j] > 0.0) {
        (true, false) => f64::from(values[i]),
        (false, true) => f64::from(values[j]),
        _ => f64::from(values[i]) * (1.0 - t) + f64::from(values[j]) * t,
    }
}

/// Cumulative ink along a span.
struct Ink {
    at: Vec<f64>,
    sum: Vec<f64>,
}

impl Ink {
    fn new(readings: &[Reading]) -> Self {
        let mut sum = vec![0.0];
        for pair in readings.windows(2) {
            let piece = 0.5 * (pair[1].at - pair[0].at) * (pair[0].ink() + pair[1].ink());
            sum.push(sum[sum.len() - 1] + piece);
        }
        Self { at: readings.iter().map(|r| r.at).collect(), sum }
    }

    fn upto(&self, place: f64) -> f64 {
        let i = self.at.partition_point(|&at| at < place).clamp(1, self.at.len() - 1);
        let t = ((place - self.at[i - 1]) / (self.at[i] - self.at[i - 1]).max(1e-12)).clamp(0.0, 1.0);
        self.sum[i - 1] + (self.sum[i] - self.sum[i - 1]) * t
    }

    fn between(&self, from: f64, to: f64) -> f64 {
        self.upto(to) - self.upto(from)
    }
}
