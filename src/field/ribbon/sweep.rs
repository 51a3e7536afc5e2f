//! A ribbon's centre line and widths, from cross-sections of the pattern's region above a level along a streamline.

use super::RibbonFit;
use super::blob::Blob;
use crate::elementary::Elementary as _;
use crate::field::Flow;
use crate::geometry::{Point, Vec2};
use crate::raster::Raster;

/// Distance between cross-sections along the streamline, and between samples along a cross-section, in pixels.
const STEP: f64 = 1.0;
const SAMPLE_STEP: f64 = 0.5;

/// Input for sweeping one blob, in pixels.
pub(super) struct Sweep<'a> {
    pub pattern: &'a Raster<f32>,
    pub flow: &'a Flow,
    pub blob: &'a Blob,
    /// The arc's length.
    pub length: f64,
    pub fit: RibbonFit,
    pub level: f32,
    /// The noise at the blob's maximum.
    pub height: f32,
}

/// Nodes and widths.
type Outline = (Vec<Point>, Vec<f64>);

/// The region across one place of the streamline.
struct Section {
    at: Point,
    beside: Vec2,
    /// Extent on the low and the high side of the place.
    low: f64,
    high: f64,
}

impl Sweep<'_> {
    /// Nodes and widths of the ribbon that covers most of the region and least beyond it; none if the flow ends at once.
    pub(super) fn best(&self) -> Option<Outline> {
        let line = self.line(0.0);
        let own = self.ribbon(&line);
        let starts = self.fit.other_starts();
        let others: Vec<f64> = starts.iter().flat_map(|n| [-n * self.blob.low, n * self.blob.high]).collect();
        if self.fit == RibbonFit::Brush && self.goes_one_way(&line, &others) {
            return own;
        }
        let with_gain = |ribbon: Outline| (self.gain(&ribbon), ribbon);
        let all = own.into_iter().chain(others.iter().filter_map(|n| self.ribbon(&self.line(*n))));
        all.map(with_gain).reduce(|best, other| if other.0 > best.0 { other } else { best }).map(|best| best.1)
    }

    /// True if the flow at these distances beside a line has the same direction as on the line.
    fn goes_one_way(&self, line: &[Point], beside: &[f64]) -> bool {
        /// Cosine of the angle between the flow on the line (in its middle and at its end) and beside it, from which a brush
        /// tries no other lines, since they would go the same way. Always trying them takes four times as long without a visible
        /// difference.
        const SAME_WAY: f64 = 0.98;
        let at = |p: Point| {
            let way = self.flow.at(p);
            beside.iter().all(|n| self.flow.at(p + way.turn_90() * *n).dot(way) > SAME_WAY)
        };
        at(line[line.len() / 2]) && at(line[line.len() - 1])
    }

    /// The streamline at distance `beside` from the maximum, from the blob's front to the swept end of its back.
    fn line(&self, beside: f64) -> Vec<Point> {
        let from = self.blob.maximum + self.blob.along.turn_90() * beside;
        let mut line = self.flow.streamline(from, self.blob.front.max(0.1), STEP);
        line.reverse();
        line.extend_from_slice(&self.flow.streamline(from, -(self.length + self.blob.back), STEP)[1..]);
        line
    }

    fn ribbon(&self, line: &[Point]) -> Option<Outline> {
        let mut sections = self.sections(line);
        smooth(&mut sections);
        let mut stations: Vec<(Point, f64)> = sections
            .iter()
            .filter(|s| s.high > s.low)
            .map(|s| (s.at + s.beside * (0.5 * (s.low + s.high)), s.high - s.low))
            .collect();
        if stations.len() < 2 {
            return None;
        }
        end(&mut stations);
        stations.reverse();
        end(&mut stations);
        stations.reverse();
        let (nodes, mut widths): (Vec<Point>, Vec<f64>) = thinned(&stations).into_iter().unzip();
        narrow_turns(&nodes, &mut widths);
        Some((nodes, widths))
    }

    /// Sections from the first to the last place inside the region.
    fn sections(&self, line: &[Point]) -> Vec<Section> {
        let mut sections = Vec::with_capacity(line.len());
        for &at in line {
            let beside = self.flow.at(at).turn_90();
            if beside == Vec2::ZERO {
                continue;
            }
            match self.section(at, beside) {
                Some(section) => sections.push(section),
                None if sections.len() < 2 => sections.clear(),
                None => break,
            }
        }
        sections
    }

    fn section(&self, at: Point, beside: Vec2) -> Option<Section> {
        let (most_low, most_high) = (self.fit.reach() * self.blob.low, self.fit.reach() * self.blob.high);
        let is_above = |n: &f64| self.value(at + beside * *n) >= self.level;
        let tries = (most_low.max(most_high) / SAMPLE_STEP) as usize;
        let inside = std::iter::once(0.0)
            .chain((1..=tries).flat_map(|i| [SAMPLE_STEP * i as f64, -SAMPLE_STEP * i as f64]))
            .find(is_above)?;
        let from = at + beside * inside;
        let high = inside + self.extent(from, beside, (most_high - inside).max(0.0));
        let low = inside - self.extent(from, -beside, (most_low + inside).max(0.0));
        Some(Section { at, beside, low, high })
    }

    /// How far the region extends from a place inside, limited to the raster and to places with flow.
    fn extent(&self, from: Point, direction: Vec2, most: f64) -> f64 {
        let mut before = self.value(from);
        for i in 1..=(most / SAMPLE_STEP).ceil() as usize {
            let at = SAMPLE_STEP * i as f64;
            let p = from + direction * at;
            if !self.flow.contains(p) || self.flow.directions().get(p.x as usize, p.y as usize) == [0.0; 2] {
                return at.min(most);
            }
            let value = self.value(p);
            if value < self.level {
                return (at - SAMPLE_STEP * f64::from((self.level - value) / (before - value).max(1e-12))).min(most);
            }
            before = value;
        }
        most
    }

    fn value(&self, p: Point) -> f32 {
        self.pattern.sample(p.x, p.y)
    }

    /// The area inside the region less that outside, by samples about a pixel apart along the ribbon and half a pixel across. Places
    /// higher than the blob belong to another ribbon on top of this one and do not count.
    fn gain(&self, (nodes, widths): &Outline) -> f64 {
        let mut gain = 0.0;
        for (p, w) in nodes.windows(2).zip(widths.windows(2)) {
            let along = p[1] - p[0];
            let (length, side) = (along.hypot(), along.normalize().turn_90());
            let steps = length.ceil().max(1.0);
            for i in 0..steps as usize {
                let t = i as f64 / steps;
                let (middle, width) = (p[0] + along * t, w[0] + (w[1] - w[0]) * t);
                let count = (width / SAMPLE_STEP).ceil().max(1.0);
                let worth = |j: usize| self.worth(middle + side * (width * (j as f64 / count - 0.5)));
                gain += (0..=count as usize).map(worth).sum::<f64>() / (count + 1.0) * width * length / steps;
            }
        }
        gain
    }

    fn worth(&self, p: Point) -> f64 {
        match self.value(p) {
            value if value < self.level => -1.0,
            value if value > self.height => 0.0,
            _ => 1.0,
        }
    }
}

/// Maximum widening of a side per pixel along the line. At 2 and at 0.4 the correlation with the pattern is about 0.015 lower: outlines
/// get horns where other ribbons branch off, or ends are cut off.
const MOST_SLOPE: f64 = 1.0;

/// Narrows sections that widen too fast along the line; never widens them.
fn smooth(sections: &mut [Section]) {
    let narrow = |sections: &mut [Section], i: usize, next: usize| {
        let most = MOST_SLOPE * sections[i].at.distance(sections[next].at);
        let (low, high) = (sections[i].low - most, sections[i].high + most);
        sections[next].low = sections[next].low.max(low);
        sections[next].high = sections[next].high.min(high);
    };
    for i in 1..sections.len() {
        narrow(sections, i - 1, i);
    }
    for i in (1..sections.len()).rev() {
        narrow(sections, i, i - 1);
    }
}

/// Distance of an end's half disc from the region's end, as a share of its radius: less than 1, since the region ends more squarely. At
/// 1 the correlation with the pattern is 0.02 lower, at 0.25 no higher.
const END_INSET: f64 = 0.35;

/// Shortens the end to make room for its half disc.
fn end(stations: &mut Vec<(Point, f64)>) {
    let tip = stations[stations.len() - 1].0;
    let room = |station: &(Point, f64)| tip.distance(station.0);
    while stations.len() > 2 && room(&stations[stations.len() - 1]) < END_INSET * 0.5 * stations[stations.len() - 1].1 {
        stations.pop();
    }
    if let Some(last) = stations.last_mut() {
        last.1 = last.1.min(2.0 * (room(last) + 0.5) / END_INSET);
    }
}

/// Nodes are dropped within this distance of the line between their neighbours, or nearer to a neighbour than this share of the maximum
/// width (otherwise wide ribbons have rugged sides).
const TOLERANCE: f64 = 0.15;
const LEAST_SPACING: f64 = 0.4;
/// Maximum distance between nodes, in cross-sections.
const MOST_SPACING: usize = 8;

/// Thins the stations: from each one, goes to the farthest whose straight connection passes near all between.
fn thinned(stations: &[(Point, f64)]) -> Vec<(Point, f64)> {
    let widest = stations.iter().map(|s| s.1).fold(0.0, f64::max);
    let least = ((LEAST_SPACING * widest / STEP) as usize).max(1);
    let is_near = |i: usize, k: usize, m: usize| {
        let t = (m - i) as f64 / (k - i) as f64;
        let ((a, wa), (b, wb), (p, w)) = (stations[i], stations[k], stations[m]);
        a.lerp(b, t).distance(p) < TOLERANCE && (wa + (wb - wa) * t - w).abs() < TOLERANCE
    };
    let mut kept = vec![stations[0]];
    let mut i = 0;
    while i + 1 < stations.len() {
        let mut next = (i + least).min(stations.len() - 1);
        while next + 1 < stations.len() && next + 1 - i <= MOST_SPACING && (i + 1..=next).all(|m| is_near(i, next + 1, m)) {
            next += 1;
        }
        kept.push(stations[next]);
        i = next;
    }
    kept
}

/// Maximum width in radii of the line's curvature; at 2 the inner side shrinks to a point.
const WIDEST_TURN: f64 = 1.9;

/// Narrows the ribbon where the line's radius of curvature is smaller than its width allows: an outline beyond its own centre of
/// curvature has holes.
fn narrow_turns(nodes: &[Point], widths: &mut [f64]) {
    for (triple, width) in nodes.windows(3).zip(&mut widths[1..]) {
        let (a, b) = (triple[1] - triple[0], triple[2] - triple[1]);
        let turn = a.cross(b).angle_over(a.dot(b)).abs();
        *width = width.min(WIDEST_TURN * a.hypot().min(b.hypot()) / turn.max(1e-9));
    }
}
