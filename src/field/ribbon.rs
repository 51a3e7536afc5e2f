//! A continuous Glass pattern as geometry: ribbons painted in ascending order.
//!
//! A noise value shows at every point whose downstream arc passes it, so the pattern is the set of upstream arcs of all noise
//! samples, the higher over the lower. What the noise has above a level `c` around one of its maxima is a small blob; swept
//! upstream by the arc's length it is a ribbon, and the pattern above `c` is the union of those ribbons:
//!
//! ```text
//!         tail                                    blob          s: along the flow from the maximum
//!        .-------------------------------------.-'''-.         n: across
//!       (  . . . . . . . . . . . . . . . . . . (   o  )   --> flow
//!        '-------------------------------------'-...-'
//! ```

use super::Flow;
use crate::geometry::{Point, Vec2};
use crate::raster::Raster;
use rayon::prelude::*;

/// Rays by which a blob is measured.
const RAYS: usize = 24;
/// Distance of samples along a ray, in pixels.
const RAY_STEP: f32 = 0.25;
/// Samples along a ray at most: a blob of coarse noise (sigma 12 px) ends long before.
const RAY_SAMPLES: usize = 240;
/// Rise along a ray, as a share of its fall so far, that is no valley's other side.
const RIPPLE: f32 = 0.03;
/// A side that has drifted this many widths from the ribbon's middle goes another way, and is followed no more.
const MOST_SPREAD: f64 = 2.0;
/// A thinner ribbon is not drawn, in pixels.
const LEAST_WIDTH: f64 = 0.1;
/// Distance of a ribbon's nodes in pixels where it has no end near; its curve bends over at least the flow's blur.
const NODE_SPACING: f64 = 5.0;

/// One ribbon, in pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Ribbon {
    /// Nodes of the middle line, from its downstream end (where the blob is) to its upstream end; at least two.
    pub nodes: Vec<Point>,
    /// Full width at each node; beyond the first and last node the ribbon ends in half discs.
    pub widths: Vec<f64>,
    /// The noise level above which the blob was taken.
    pub level: f32,
    /// The noise at the maximum.
    pub height: f32,
    /// Which maximum it belongs to, in row order.
    pub maximum: u32,
}

/// How a blob's sweep is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cut {
    /// As one ribbon.
    Whole,
    /// As strips side by side, none wider than this many pixels; the narrower, the nearer to the pattern, the more of them.
    Strips(f64),
}

/// The ribbons of all maxima of the noise, in painting order: by level, then by height, then by maximum. `levels` gives a maximum's
/// levels, ascending, for its height; `length` is the arc's, in pixels.
///
/// Noise blurred by `sigma` has `0.046 / sigma^2` maxima a pixel (`1 / (4 sqrt(3) pi sigma^2)`); an arc hides all lower ones within
/// about its `length` times three `sigma`, so that of the whole set some `1 / (sigma * length)` a pixel show, times the levels.
pub fn glass_ribbons(
    noise: &Raster<f32>,
    flow: &Flow,
    length: f64,
    cut: Cut,
    levels: impl Fn(f32) -> Vec<f32> + Sync,
) -> Vec<Ribbon> {
    let maxima = maxima(noise);
    let mut ribbons: Vec<Ribbon> = maxima
        .par_iter()
        .enumerate()
        .flat_map_iter(|(i, &(x, y))| {
            let height = noise.get(x, y);
            let from = Point::new(x as f64 + 0.5, y as f64 + 0.5);
            let levels = if flow.at(from) == Vec2::ZERO { Vec::new() } else { levels(height) };
            let bump = (!levels.is_empty()).then(|| Bump::new(noise, flow, from, length));
            levels.into_iter().flat_map(move |level| {
                let lines = bump.as_ref().map_or_else(Vec::new, |bump| match cut {
                    Cut::Whole => bump.ribbon(level).into_iter().collect(),
                    Cut::Strips(widest) => bump.strips(level, widest),
                });
                lines.into_iter().map(move |(nodes, widths)| Ribbon { nodes, widths, level, height, maximum: i as u32 })
            })
        })
        .collect();
    ribbons.sort_by(|a, b| a.level.total_cmp(&b.level).then(a.height.total_cmp(&b.height)).then(a.maximum.cmp(&b.maximum)));
    ribbons
}

/// Pixels higher than all around them; of equal neighbours the first in row order.
fn maxima(noise: &Raster<f32>) -> Vec<(usize, usize)> {
    let is_maximum = |x: usize, y: usize| {
        let here = noise.get(x, y);
        (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy))).filter(|d| *d != (0, 0)).all(|(dx, dy)| {
            let (nx, ny) = (x as isize + dx, y as isize + dy);
            if !noise.contains(nx, ny) {
                return true;
            }
            let there = noise.get(nx as usize, ny as usize);
            here > there || (here == there && (dy, dx) > (0, 0))
        })
    };
    (0..noise.height())
        .into_par_iter()
        .flat_map_iter(|y| (0..noise.width()).filter(move |&x| is_maximum(x, y)).map(move |x| (x, y)))
        .collect()
}

/// One maximum of the noise with what is needed to draw its ribbons.
struct Bump<'a> {
    flow: &'a Flow,
    from: Point,
    length: f64,
    /// Noise along each ray from the maximum to where it begins to rise again.
    rays: Vec<Vec<f32>>,
    /// Direction of the flow at the maximum.
    along: Vec2,
}

/// The blob above a level: half its length downstream and upstream and its reach to both sides.
struct Blob {
    /// Corners (s, n).
    corners: Vec<(f64, f64)>,
}

impl<'a> Bump<'a> {
    fn new(noise: &Raster<f32>, flow: &'a Flow, from: Point, length: f64) -> Self {
        let along = flow.at(from);
        let rays = (0..RAYS)
            .map(|k| {
                let angle = std::f64::consts::TAU * k as f64 / RAYS as f64;
                falling_ray(noise, from, along * angle.cos() + along.turn_90() * angle.sin())
            })
            .collect();
        Self { flow, from, length, rays, along }
    }

    fn blob(&self, level: f32) -> Blob {
        let corner = |(k, ray): (usize, &Vec<f32>)| {
            let reach = f64::from(reach_above(ray, level));
            let angle = std::f64::consts::TAU * k as f64 / RAYS as f64;
            (reach * angle.cos(), reach * angle.sin())
        };
        Blob { corners: self.rays.iter().enumerate().map(corner).collect() }
    }

    /// Nodes and widths of the ribbon above a level; none where the blob is thinner than a tenth of a pixel or the flow ends at
    /// once.
    fn ribbon(&self, level: f32) -> Option<(Vec<Point>, Vec<f64>)> {
        let blob = self.blob(level);
        let (low, high) = blob.across(f64::NEG_INFINITY, f64::INFINITY);
        let spine = Spine::new(self.flow, self.from, self.length, (low, high));
        let gone = spine.gone();
        if high - low < LEAST_WIDTH || gone < 1.0 {
            return None;
        }
        let (front, back) = (blob.front_cap(), blob.back_cap());
        let mut stations = vec![front];
        if front.s > 0.35 * (high - low) {
            stations.push(Station { s: 0.0, low, high });
        }
        let from = stations.last().map_or(0.0, |s| s.s);
        let tail = Station { s: back.s - gone, ..back };
        let to = if -back.s > 0.35 * (high - low) { -gone } else { tail.s };
        let steps = ((from - to) / NODE_SPACING).round().max(1.0);
        for i in 1..=steps as usize {
            stations.push(Station { s: from + (to - from) * i as f64 / steps, low, high });
        }
        if to > tail.s {
            stations.push(tail);
        } else if let Some(last) = stations.last_mut() {
            (last.low, last.high) = (tail.low, tail.high);
        }
        Some(stations.iter().map(|station| spine.node(station)).unzip())
    }

    /// The ribbon cut lengthwise into strips no wider than `widest`, each with ends and a way of its own.
    fn strips(&self, level: f32, widest: f64) -> Vec<(Vec<Point>, Vec<f64>)> {
        let blob = self.blob(level);
        let (low, high) = blob.across(f64::NEG_INFINITY, f64::INFINITY);
        if high - low < LEAST_WIDTH {
            return Vec::new();
        }
        let count = ((high - low) / widest).ceil().max(1.0);
        let width = (high - low) / count;
        let strip = |i: usize| {
            let n = low + (i as f64 + 0.5) * width;
            let (back, front) = blob.along(n)?;
            // A half disc reaches as far as a square end of the same area would, less this.
            let inset = (0.5 * std::f64::consts::FRAC_PI_4 * width).min(0.5 * (front - back));
            let start = self.from + self.along * (front - inset) + self.along.turn_90() * n;
            let spine = Spine::new(self.flow, start, self.length + front - back - 2.0 * inset, (-0.5 * width, 0.5 * width));
            let steps = (spine.gone() / NODE_SPACING).round().max(1.0);
            let station = |i: usize| Station { s: -spine.gone() * i as f64 / steps, low: -0.5 * width, high: 0.5 * width };
            (spine.gone() >= 1.0).then(|| (0..=steps as usize).map(|i| spine.node(&station(i))).unzip())
        };
        (0..count as usize).filter_map(strip).collect()
    }
}

/// A streamline upstream, and how far beside it the flow carries what began beside its start.
struct Spine {
    line: Vec<Point>,
    /// Reach to both sides at the start.
    reach: (f64, f64),
    low_side: Vec<Point>,
    high_side: Vec<Point>,
}

impl Spine {
    fn new(flow: &Flow, from: Point, length: f64, reach: (f64, f64)) -> Self {
        let beside = flow.at(from).turn_90();
        let upstream = |from: Point| flow.streamline(from, -length, 1.0);
        Self {
            line: upstream(from),
            reach,
            low_side: upstream(from + beside * reach.0),
            high_side: upstream(from + beside * reach.1),
        }
    }

    /// How far upstream it goes, in pixels.
    fn gone(&self) -> f64 {
        (self.line.len() - 1) as f64
    }

    /// The middle and the width at a station.
    fn node(&self, station: &Station) -> (Point, f64) {
        let (low, high) = (self.place(station.s, station.low), self.place(station.s, station.high));
        (low.midpoint(high), low.distance(high))
    }

    /// The point at `s` along the flow and `n` beside the line: as far between the sides as it was at the start. Straight on
    /// beyond the start and the end.
    fn place(&self, s: f64, n: f64) -> Point {
        let at = -s;
        let i = (at.max(0.0) as usize).min(self.line.len() - 2);
        let step = self.line[i + 1] - self.line[i];
        let beside = -step.normalize().turn_90();
        let middle = self.line[i] + step * (at - i as f64);
        let along = |side: &[Point], reach: f64| {
            let straight = middle + beside * reach;
            let (Some(&before), Some(&after)) = (side.get(i), side.get(i + 1)) else { return straight };
            let there = before + (after - before) * (at - i as f64);
            if there.distance(middle) > MOST_SPREAD * (self.reach.1 - self.reach.0) { straight } else { there }
        };
        let share = (n - self.reach.0) / (self.reach.1 - self.reach.0);
        along(&self.low_side, self.reach.0).lerp(along(&self.high_side, self.reach.1), share)
    }
}

/// Where a ribbon's sides are at one place along it.
#[derive(Clone, Copy, Debug)]
struct Station {
    s: f64,
    low: f64,
    high: f64,
}

impl Blob {
    /// Where it begins and ends along the flow, at one place across.
    fn along(&self, n: f64) -> Option<(f64, f64)> {
        let mut range = (f64::INFINITY, f64::NEG_INFINITY);
        for (i, &(s, at)) in self.corners.iter().enumerate() {
            let (next_s, next_at) = self.corners[(i + 1) % self.corners.len()];
            if (at - n) * (next_at - n) <= 0.0 && at != next_at {
                let cut = s + (next_s - s) * (n - at) / (next_at - at);
                range = (range.0.min(cut), range.1.max(cut));
            }
        }
        (range.0 <= range.1).then_some(range)
    }

    /// The reach to both sides of what lies between two places along the flow.
    fn across(&self, from: f64, to: f64) -> (f64, f64) {
        let mut range = (f64::INFINITY, f64::NEG_INFINITY);
        let mut add = |n: f64| range = (range.0.min(n), range.1.max(n));
        for (i, &(s, n)) in self.corners.iter().enumerate() {
            let (next_s, next_n) = self.corners[(i + 1) % self.corners.len()];
            if s >= from && s <= to {
                add(n);
            }
            for cut in [from, to] {
                if (s - cut) * (next_s - cut) < 0.0 {
                    add(n + (next_n - n) * (cut - s) / (next_s - s));
                }
            }
        }
        range
    }

    /// Where the downstream half disc must stand so that it ends where the blob does, and the sides there.
    fn front_cap(&self) -> Station {
        let end = self.corners.iter().map(|c| c.0).fold(f64::NEG_INFINITY, f64::max);
        self.cap(end, 1.0)
    }

    fn back_cap(&self) -> Station {
        let end = self.corners.iter().map(|c| c.0).fold(f64::INFINITY, f64::min);
        self.cap(end, -1.0)
    }

    /// By bisection: the farther back, the wider the blob is up to its end, and the farther the half disc reaches.
    fn cap(&self, end: f64, sign: f64) -> Station {
        let sides = |s: f64| if sign > 0.0 { self.across(s, f64::INFINITY) } else { self.across(f64::NEG_INFINITY, s) };
        let (low, high) = self.across(f64::NEG_INFINITY, f64::INFINITY);
        let (mut near, mut far) = (end, end - sign * 0.5 * (high - low));
        for _ in 0..12 {
            let middle = 0.5 * (near + far);
            let (low, high) = sides(middle);
            if 0.5 * (high - low) > (end - middle).abs() { near = middle } else { far = middle }
        }
        let (low, high) = sides(far);
        Station { s: far, low, high }
    }
}

/// Noise samples from a point outwards as far as they fall; a ripple on the way (of bilinear interpolation) does not end it.
fn falling_ray(noise: &Raster<f32>, from: Point, direction: Vec2) -> Vec<f32> {
    let mut samples = vec![noise.sample(from.x, from.y)];
    let mut lowest = 0;
    for i in 1..RAY_SAMPLES {
        let p = from + direction * f64::from(RAY_STEP * i as f32);
        let value = noise.sample(p.x, p.y);
        samples.push(value);
        if value <= samples[lowest] {
            lowest = i;
        } else if value > samples[lowest] + RIPPLE * (samples[0] - samples[lowest]) {
            break;
        }
    }
    samples.truncate(lowest + 1);
    samples
}

/// How far from its start a falling ray stays above a level, in pixels.
fn reach_above(ray: &[f32], level: f32) -> f32 {
    let Some(below) = ray.iter().position(|&v| v < level) else { return RAY_STEP * (ray.len() - 1) as f32 };
    if below == 0 {
        return 0.0;
    }
    let (before, after) = (ray[below - 1], ray[below]);
    RAY_STEP * (below as f32 - 1.0 + (before - level) / (before - after).max(1e-12))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bump(sx: f32, sy: f32) -> Raster<f32> {
        Raster::from_fn(80, 40, |x, y| {
            let (dx, dy) = ((x as f32 - 60.0) / sx, (y as f32 - 20.0) / sy);
            (-0.5 * (dx * dx + dy * dy)).exp()
        })
    }

    fn flow() -> Flow {
        Flow::from_fn(80, 40, |_| Vec2::new(1.0, 0.0))
    }

    #[test]
    fn a_round_bump_is_a_ribbon_of_its_width_with_round_ends() {
        let level = (-0.5_f32).exp();
        let ribbons = glass_ribbons(&bump(4.0, 4.0), &flow(), 30.0, Cut::Whole, |_| vec![level]);
        let ribbon = &ribbons[0];
        assert_eq!(ribbons.len(), 1);
        let strips = glass_ribbons(&bump(4.0, 4.0), &flow(), 30.0, Cut::Strips(2.0), |_| vec![level]);
        assert!((4..=5).contains(&strips.len()) && strips.iter().all(|strip| strip.widths.iter().all(|w| *w <= 2.0)));
        assert!(ribbon.widths.iter().all(|w| (w - 8.0).abs() < 0.3), "{:?}", ribbon.widths);
        let (first, last) = (ribbon.nodes[0], ribbon.nodes[ribbon.nodes.len() - 1]);
        assert!(first.distance(Point::new(60.5, 20.5)) < 0.5 && last.distance(Point::new(30.5, 20.5)) < 0.5, "{first} {last}");
    }

    #[test]
    fn the_ends_of_long_and_flat_bumps_are_where_the_pattern_ends() {
        for (sx, sy) in [(6.0, 2.5), (2.5, 6.0)] {
            let ribbons = glass_ribbons(&bump(sx, sy), &flow(), 30.0, Cut::Whole, |_| vec![(-0.5_f32).exp()]);
            let ribbon = &ribbons[0];
            let tip = ribbon.nodes[0].x + 0.5 * ribbon.widths[0];
            let tail = ribbon.nodes[ribbon.nodes.len() - 1].x - 0.5 * ribbon.widths[ribbon.widths.len() - 1];
            assert!((tip - 60.5 - f64::from(sx)).abs() < 0.4, "{tip}");
            assert!((tail - 30.5 + f64::from(sx)).abs() < 0.4, "{tail}");
            assert!(ribbon.widths.iter().copied().fold(0.0, f64::max) - 2.0 * f64::from(sy) < 0.3);
        }
    }
}
