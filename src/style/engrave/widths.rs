//! The width of each line so that its ink makes the tone (step 6 of the style).

use super::lines::{Family, Line};
use super::region_map::{Region, RegionMap};
use super::span::Span;
use crate::elementary::Elementary as _;
use crate::geometry::Point;
use crate::parallel::{collected, mapped};
use crate::raster::Raster;

/// Readings per pitch along a line.
pub(super) const READINGS: f64 = 8.0;

/// Target of a family: its region, turn and ink.
#[derive(Clone, Copy)]
pub(super) struct Wanted<'a> {
    pub ground: &'a RegionMap,
    pub region: Region,
    /// Angle from the region's own lines to the family's, in degrees anticlockwise.
    pub turn: f64,
    /// Ink, 0 to 1, as a fraction of the paper.
    pub ink: &'a Raster<f32>,
    pub width_max: f64,
}

/// Readings of one line at every few columns.
#[derive(Clone, Debug, Default)]
pub(super) struct LineReading {
    /// The first reading; readings are numbered from the family's first column.
    pub first: usize,
    pub spans: Vec<Span>,
    /// Distance inside the region, in millimetres.
    pub inside: Vec<f32>,
    /// Presence of the line, 0 to 1.
    pub weight: Vec<f32>,
    /// Ink of its strip, 0 to 1.
    pub ink: Vec<f32>,
    /// Full width in millimetres.
    pub width: Vec<f32>,
    /// Width at which it touches a neighbour.
    pub room: Vec<f32>,
    /// Length of the line per millimetre along the axis.
    pub stretch: Vec<f32>,
    /// Width of its strip, halfway to its neighbours on both sides, in millimetres.
    pub strip: Vec<f32>,
}

/// A family's lines with their widths.
pub(super) struct LineReadings<'a> {
    pub family: &'a Family,
    pub wanted: Wanted<'a>,
    /// Columns per reading.
    pub stride: usize,
    /// One for each line of the family.
    pub lines: Vec<LineReading>,
}

/// The neighbours of a reading: distance across to the strip's border and to the neighbour's own line, below and above.
#[derive(Clone, Copy, Default)]
struct Sides {
    border: [f32; 2],
    neighbour: [f32; 2],
    width: [f32; 2],
}

impl<'a> LineReadings<'a> {
    pub(super) fn new(family: &'a Family, wanted: Wanted<'a>) -> Self {
        let stride = (family.pitch / READINGS / family.step).round().max(1.0) as usize;
        let mut courses = Self { family, wanted, stride, lines: Vec::new() };
        courses.lines = mapped(&family.lines, &|line| courses.find(line));
        courses.set_widths();
        courses.limit();
        courses
    }

    /// Distance between readings.
    pub(super) fn step(&self) -> f64 {
        self.stride as f64 * self.family.step
    }

    /// Position of a reading along the lines.
    pub(super) fn place(&self, reading: usize) -> f64 {
        self.family.first + (reading * self.stride) as f64 * self.family.step
    }

    fn height(&self, line: &Line, reading: usize) -> f64 {
        line.heights[reading * self.stride - line.first]
    }

    pub(super) fn point(&self, line: &Line, reading: usize) -> Point {
        self.family.frame.to_page(self.place(reading), self.height(line, reading))
    }

    /// Sets each line's width from the ink of its strip.
    fn set_widths(&mut self) {
        /// Rounds of smoothing the widths along a line, each over a quarter of a pitch: with none fine texture makes lines
        /// shiver, with many the texture is lost.
        const SMOOTHING_ROUNDS: usize = 2;
        let sides = self.sides();
        let step = self.step();
        let courses = std::mem::take(&mut self.lines);
        self.lines = collected(courses.len(), &|k| {
            let (mut course, line, sides) = (courses[k].clone(), &self.family.lines[k], &sides[k]);
            let count = course.weight.len();
            course.ink = vec![0.0; count];
            course.width = vec![0.0; count];
            course.stretch = vec![1.0; count];
            course.strip = vec![0.0; count];
            for i in (0..count).filter(|&i| course.weight[i] > 0.0) {
                let r = course.first + i;
                let (a, b) = (i.saturating_sub(1), (i + 1).min(count - 1));
                let slope = (self.height(line, course.first + b) - self.height(line, course.first + a)) / ((b - a) as f64 * step);
                let stretch = slope.hypotenuse(1.0);
                let (area, within) = self.strip(self.place(r), self.height(line, r), sides[i], f64::from(course.inside[i]));
                course.ink[i] = (area / within.max(1e-9)) as f32;
                course.stretch[i] = stretch as f32;
                course.width[i] = (area / stretch) as f32;
                course.strip[i] = (sides[i].border[0] + sides[i].border[1]) / stretch as f32;
            }
            for _ in 0..SMOOTHING_ROUNDS {
                smooth(&mut course.width, &course.weight);
            }
            course
        });
    }

    /// Ink of a line's strip at one place and how much of it lies inside the region, in millimetres across.
    fn strip(&self, u: f64, height: f64, sides: Sides, inside: f64) -> (f64, f64) {
        /// Tone samples from a line to the border of its strip.
        const DEPTHS: usize = 3;
        let ground = self.wanted.ground;
        let soft = ground.grid.pixel_mm();
        let (mut area, mut within) = (0.0, 0.0);
        for (side, extent) in [(-1.0, f64::from(sides.border[0])), (1.0, f64::from(sides.border[1]))] {
            let slice = extent / DEPTHS as f64;
            for i in 0..DEPTHS {
                let p = self.family.frame.to_page(u, height + side * slice * (i as f64 + 0.5));
                // Shortcut deep inside a region, which is the usual case.
                let inside = if inside > extent + soft {
                    1.0
                } else {
                    (0.5 + ground.cover(self.wanted.region.label, self.wanted.turn, p) / soft).clamp(0.0, 1.0)
                };
                within += slice * inside;
                if inside > 0.0 {
                    area += slice * inside * f64::from(ground.grid.read(self.wanted.ink, p)).clamp(0.0, 1.0);
                }
            }
        }
        (area, within)
    }

    /// The neighbours below and above, for every reading of every line.
    fn sides(&self) -> Vec<Vec<Sides>> {
        /// Maximum half-width of a line's strip on a side without a neighbour, in pitches: with less the picture's rim is too
        /// light, with more, lines that end at a slanted border end in knobs.
        const REACH: f64 = 0.7;
        /// Maximum distance of a neighbouring line, in pitches.
        const NEIGHBOURHOOD: f64 = 4.0;
        let mut sides: Vec<Vec<Sides>> = self.lines.iter().map(|c| vec![Sides::default(); c.weight.len()]).collect();
        let columns = self.family.columns / self.stride + 1;
        let upwards: Vec<usize> = (0..self.lines.len()).collect();
        let downwards: Vec<usize> = upwards.iter().rev().copied().collect();
        let (reach, neighbourhood) = (REACH * self.family.pitch, NEIGHBOURHOOD * self.family.pitch);
        for (side, order) in [upwards, downwards].into_iter().enumerate() {
            // The last line met in each column: height, weight, width.
            let mut met = vec![(f64::INFINITY, 0.0_f32, 0.0_f32); columns + 1];
            for k in order {
                let course = &self.lines[k];
                for (i, &weight) in course.weight.iter().enumerate().filter(|(_, w)| **w > 0.0) {
                    let r = course.first + i;
                    let height = self.height(&self.family.lines[k], r);
                    let width = course.width.get(i).copied().unwrap_or(0.0);
                    let (other, other_weight, other_width) = met[r];
                    let distance = (height - other).abs();
                    let share = f64::from(weight / (weight + other_weight));
                    let out = &mut sides[k][i];
                    out.border[side] = if distance < neighbourhood { (distance * share) as f32 } else { reach as f32 };
                    out.neighbour[side] = distance.min(1e6) as f32;
                    out.width[side] = other_width;
                    met[r] = (height, weight, width);
                }
            }
        }
        sides
    }

    /// Width at which a line's side touches a slanted border: the line ends there in a point, not in a protruding square end.
    fn border_room(&self, line: &Line, course: &LineReading, i: usize) -> f32 {
        /// Minimum share of a line's side that a border takes: along a border half the distance counts.
        const LEAST_ACROSS: f64 = 0.1;
        let Wanted { ground, region, turn, width_max, .. } = self.wanted;
        if f64::from(course.inside[i]) > ground.near.max(0.5 * width_max) {
            return f32::INFINITY;
        }
        let r = course.first + i;
        let (a, b) = (i.saturating_sub(1), (i + 1).min(course.weight.len() - 1));
        let along = self.point(line, course.first + b) - self.point(line, course.first + a);
        let here = self.point(line, r);
        let across = along.cross(ground.inwards(region.label, here)).abs() / along.hypot().max(1e-9);
        if across < LEAST_ACROSS {
            return f32::INFINITY;
        }
        (2.0 * ground.cover(region.label, turn, here).max(0.0) / across) as f32
    }

    /// Limits widths so that neighbours at most touch.
    fn limit(&mut self) {
        let sides = self.sides();
        let borders: Vec<Vec<f32>> = collected(self.lines.len(), &|k| {
            let (course, line) = (&self.lines[k], &self.family.lines[k]);
            let is_there = |i: usize| course.weight[i] > 0.0;
            (0..course.width.len()).map(|i| if is_there(i) { self.border_room(line, course, i) } else { 0.0 }).collect()
        });
        for ((course, sides), borders) in self.lines.iter_mut().zip(sides).zip(borders) {
            course.room = (0..course.width.len())
                .map(|i| {
                    let (own, side, stretch) = (course.width[i], sides[i], course.stretch[i]);
                    let room = |j: usize| {
                        // The gap is shared in proportion to both target widths.
                        let share = if own + side.width[j] > 0.0 { own / (own + side.width[j]) } else { 0.5 };
                        2.0 * side.neighbour[j] / stretch * share
                    };
                    room(0).min(room(1)).min(self.wanted.width_max as f32).min(borders[i])
                })
                .collect();
            course.width.iter_mut().zip(&course.room).for_each(|(width, room)| *width = width.min(*room));
        }
    }
}

/// One round of 1-2-1 smoothing among existing readings; the sum is preserved.
fn smooth(values: &mut [f32], weight: &[f32]) {
    let mut carried = 0.0;
    for i in 1..values.len() {
        let flow = if weight[i - 1] > 0.0 && weight[i] > 0.0 { 0.25 * (values[i] - values[i - 1]) } else { 0.0 };
        values[i - 1] += flow - carried;
        carried = flow;
    }
    if let Some(last) = values.last_mut() {
        *last -= carried;
    }
}
