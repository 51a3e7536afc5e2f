//! A continuous Glass pattern as geometry: ribbons painted in ascending order.
//!
//! A noise value shows at every point whose downstream arc passes it, so the pattern consists of the upstream arcs of all noise samples,
//! higher ones over lower ones. Around a maximum, the noise above a level `c` is a small blob. Swept upstream by the arc's length it is
//! a ribbon, and the pattern above `c` is the union of these ribbons:
//!
//! ```text
//!         tail                                    blob          s: along the flow from the maximum
//!        .-------------------------------------.-'''-.         n: across
//!       (  . . . . . . . . . . . . . . . . . . (   o  )   --> flow
//!        '-------------------------------------'-...-'
//! ```
//!
//! The blob gives a ribbon's extent along the flow. Its width at each place is read from the pattern, so that it is right where the flow
//! spreads, converges and turns.

mod blob;
mod sweep;

use super::Flow;
use crate::geometry::{Point, Vec2};
use crate::parallel::collected;
use crate::raster::Raster;
use blob::Blob;
use sweep::Sweep;

/// One ribbon, in pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Ribbon {
    /// Nodes of the centre line, from its downstream end (where the blob is) to its upstream end; at least two.
    pub nodes: Vec<Point>,
    /// Full width at each node; beyond the first and last node the ribbon ends in half discs.
    pub widths: Vec<f64>,
    /// The noise level that bounds the blob.
    pub level: f32,
    /// The noise at the maximum.
    pub height: f32,
    /// Index of its maximum, in row order.
    pub maximum: u32,
}

/// Method of fitting ribbons to the pattern.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RibbonFit {
    /// Like a brush: hardly wider than the blob, and along the maximum's own streamline unless the flow parts.
    Brush,
    /// As close to the pattern as possible: wider, along the best of seven streamlines.
    Faithful,
}

impl RibbonFit {
    /// Limit of a cross-section, as a multiple of the blob's reach to the side: beyond it the region belongs to another ribbon. Brushes
    /// of 1.5 run into one another and lose their form (judged on the astronaut). With 2.5 the faithful fit's correlation with the
    /// pattern is 0.006 lower for one ribbon per maximum; so it is with 4 for nested ones.
    const fn reach(self) -> f64 {
        match self {
            Self::Brush => 1.0,
            Self::Faithful => 3.5,
        }
    }

    /// Starts of other centre lines across the blob, to either side, as shares of its reach. Near a saddle of the flow the ribbon
    /// continues on one side only, which the maximum's own line may miss.
    const fn other_starts(self) -> &'static [f64] {
        match self {
            Self::Brush => &[0.5],
            Self::Faithful => &[0.3, 0.6, 0.9],
        }
    }
}

/// The ribbons of all maxima of the noise, in painting order: by level, then by height, then by maximum. `pattern` is the noise's
/// [`super::glass_pattern`] for arcs of `length` pixels; `levels` returns the ascending levels of a maximum for its height.
///
/// Noise blurred by `sigma` has `0.046 / sigma^2` maxima per pixel (`1 / (4 sqrt(3) pi sigma^2)`). A ribbon hides lower ones within its
/// length times its width. So the number of visible ribbons grows with the page, falls with `sigma` (measured on photographs: to the
/// power 1.1) and only slightly with `length` (power 0.3, since longer ribbons hide each other only in part).
pub fn glass_ribbons(
    noise: &Raster<f32>,
    pattern: &Raster<f32>,
    flow: &Flow,
    length: f64,
    fit: RibbonFit,
    levels: impl Fn(f32) -> Vec<f32> + Sync,
) -> Vec<Ribbon> {
    let maxima = maxima(noise);
    let of_maximum = |i: usize| {
        let (x, y) = maxima[i];
        let height = noise.get(x, y);
        let from = Point::new(x as f64 + 0.5, y as f64 + 0.5);
        let along = flow.at(from);
        let levels = if along == Vec2::ZERO { Vec::new() } else { levels(height) };
        let ribbon = |level: f32| {
            let blob = Blob::new(noise, from, along, level);
            let sweep = Sweep { pattern, flow, blob: &blob, length, fit, level, height };
            let (nodes, widths) = sweep.best()?;
            Some(Ribbon { nodes, widths, level, height, maximum: i as u32 })
        };
        levels.into_iter().filter_map(ribbon).collect()
    };
    let ribbons: Vec<Vec<Ribbon>> = collected(maxima.len(), &of_maximum);
    let mut ribbons: Vec<Ribbon> = ribbons.into_iter().flatten().collect();
    ribbons
        .sort_unstable_by(|a, b| a.level.total_cmp(&b.level).then(a.height.total_cmp(&b.height)).then(a.maximum.cmp(&b.maximum)));
    ribbons
}

/// Pixels higher than all their neighbours; of equal ones the first in row order.
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
    let of_row = |y: usize| (0..noise.width()).filter(|&x| is_maximum(x, y)).map(|x| (x, y)).collect();
    let rows: Vec<Vec<(usize, usize)>> = collected(noise.height(), &of_row);
    rows.concat()
}

#[cfg(test)]
mod tests {
    use super::super::glass_pattern;
    use super::*;
    use crate::elementary::Elementary as _;
    use crate::geometry::{Ends, Ring, catmull_rom, swelling_outline};
    use kurbo::Shape;
    use std::f64::consts::PI;

    fn bump(sx: f32, sy: f32) -> Raster<f32> {
        Raster::from_fn(80, 60, |x, y| {
            let (dx, dy) = ((x as f32 - 60.0) / sx, (y as f32 - 30.0) / sy);
            (-0.5 * (dx * dx + dy * dy)).exponential()
        })
    }

    fn only(noise: &Raster<f32>, flow: &Flow) -> Ribbon {
        let pattern = glass_pattern(noise, flow, 30.0);
        let ribbons = glass_ribbons(noise, &pattern, flow, 30.0, RibbonFit::Faithful, |_| vec![(-0.5_f32).exponential()]);
        assert_eq!(ribbons.len(), 1);
        ribbons[0].clone()
    }

    fn area(ribbon: &Ribbon) -> f64 {
        swelling_outline(&catmull_rom(&ribbon.nodes, Ring::Open), &ribbon.widths, Ends::Round, 0.01).area().abs()
    }

    #[test]
    fn a_bump_is_a_ribbon_of_its_width_and_length() {
        let flow = Flow::from_fn(80, 60, |_| Vec2::new(1.0, 0.0));
        for (sx, sy) in [(4.0_f32, 4.0_f32), (6.0, 2.5), (2.5, 6.0)] {
            let ribbon = only(&bump(sx, sy), &flow);
            let (sx, sy) = (f64::from(sx), f64::from(sy));
            let swept = 60.0 * sy + PI * sx * sy;
            assert!(
                (area(&ribbon) / swept - 1.0).abs() < 0.2,
                "ends wider than long lose their corners: {} of {swept}",
                area(&ribbon)
            );
            assert!((ribbon.widths.iter().copied().fold(0.0, f64::max) - 2.0 * sy).abs() < 0.4, "{:?}", ribbon.widths);
            let (first, last) = (ribbon.nodes[0].x, ribbon.nodes[ribbon.nodes.len() - 1].x);
            assert!(first < 60.5 + sx && last > 30.5 - sx, "{first} {last}");
        }
    }

    #[test]
    fn it_narrows_where_the_flow_gathers() {
        // Outwards from (0, 30): upstream is towards there.
        let flow = Flow::from_fn(80, 60, |p| p - Point::new(0.0, 30.5));
        let ribbon = only(&bump(3.0, 6.0), &flow);
        let at = |x: f64| {
            let i = (0..ribbon.nodes.len()).min_by_key(|&i| ((ribbon.nodes[i].x - x).abs() * 1e3) as i64).unwrap();
            (ribbon.nodes[i].x, ribbon.widths[i])
        };
        for x in [55.0, 45.0, 38.0] {
            let (x, width) = at(x);
            assert!((width - 12.0 * x / 60.5).abs() < 1.0, "{width} at {x}");
        }
    }
}
