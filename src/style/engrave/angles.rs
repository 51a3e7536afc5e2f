//! The direction of the lines in each region (Galarza 2017, sections 3.3.1 and 3.4).

use super::Drawer;
use super::parameters::{AnglesFrom, Division};
use crate::elementary::Elementary as _;
use crate::field::edge_tangent_flow;
use crate::raster::Raster;
use crate::style::random::stream;
use rand::RngExt;
use std::collections::BTreeSet;
use std::f64::consts::PI;

/// Kang's window of 5 pixels, at the papers' 6 pixels per pitch, and number of rounds.
const FLOW_RADIUS: usize = 5;
const FLOW_ROUNDS: u32 = 3;
/// A region whose mean direction is weaker than this share of the strongest takes its neighbours'.
const WEAK: f64 = 0.05;
/// Rounds of filling weak regions from their neighbours.
const FILL_ROUNDS: usize = 200;

impl Drawer<'_> {
    /// Degrees for regions 1 to `count`; lines drawn by hand come first.
    pub(super) fn angles(&self, labels: &Raster<i32>, count: i32) -> Vec<f64> {
        let found = self.found_angles(labels, count);
        let Some(drawn) = self.drawn_directions() else { return found };
        let drawn = drawn.means_in(labels, count as usize);
        found.into_iter().zip(drawn).map(|(found, drawn)| drawn.map_or(found, |angle| upright(-angle))).collect()
    }

    fn found_angles(&self, labels: &Raster<i32>, count: i32) -> Vec<f64> {
        let p = &self.parameters;
        let is_scribbled = p.regions == Division::Auto && self.portrait.scribbles.is_some();
        match p.angles {
            AnglesFrom::Flow => self.flow_angles(labels, count),
            AnglesFrom::Random => {
                (1..=count).map(|label| stream(self.seed, "angles", label as u64).random_range(-90.0..90.0)).collect()
            }
            AnglesFrom::Auto if p.regions == Division::Superpixels => self.flow_angles(labels, count),
            AnglesFrom::Hue | AnglesFrom::Auto if is_scribbled => self.hue_angles(count),
            _ => vec![p.angle; count as usize],
        }
    }

    /// Half the hue of each scribble; grey scribbles take the parameter `angle`.
    fn hue_angles(&self, count: i32) -> Vec<f64> {
        let colours = self.portrait.scribbles.as_ref().map_or(&[][..], |s| &s.colours);
        let angle =
            |i: usize| colours.get(i).and_then(|c| hue(*c)).map_or(self.parameters.angle, |hue| upright(0.5 * hue.to_radians()));
        (0..count as usize).map(angle).collect()
    }

    /// The mean of the edge tangent flow in each region, by doubled angles weighted by edge strength; weak regions are filled from their
    /// neighbours.
    fn flow_angles(&self, labels: &Raster<i32>, count: i32) -> Vec<f64> {
        let flow = edge_tangent_flow(&self.portrait.lightness, FLOW_RADIUS, FLOW_ROUNDS);
        let mut sums = vec![[0.0_f64; 3]; count as usize + 1];
        for ((&label, &[x, y]), &strength) in labels.pixels().iter().zip(flow.tangent.pixels()).zip(flow.strength.pixels()) {
            let (x, y, strength) = (f64::from(x), f64::from(-y), f64::from(strength));
            let sum = &mut sums[label.max(0) as usize];
            sum[0] += strength * (x * x - y * y);
            sum[1] += strength * 2.0 * x * y;
            sum[2] += 1.0;
        }
        let mut directions: Vec<[f64; 2]> = sums[1..].iter().map(|s| [s[0] / s[2].max(1.0), s[1] / s[2].max(1.0)]).collect();
        fill_weak(&mut directions, &neighbours(labels, count));
        directions.iter().map(|[c, s]| upright(0.5 * s.angle_over(*c))).collect()
    }
}

/// Degrees from -90 to 90, so that left of the line is up.
pub(super) fn upright(angle: f64) -> f64 {
    let half = angle.rem_euclid(PI);
    if half > 0.5 * PI { half - PI } else { half }.to_degrees()
}

/// Hue in degrees; none for greys.
fn hue([r, g, b]: [u8; 3]) -> Option<f64> {
    let [r, g, b] = [r, g, b].map(f64::from);
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let range = most - least;
    if range < 8.0 {
        return None;
    }
    let sixth = if most == r {
        (g - b) / range
    } else if most == g {
        2.0 + (b - r) / range
    } else {
        4.0 + (r - g) / range
    };
    Some((60.0 * sixth).rem_euclid(360.0))
}

/// The neighbours of each region.
pub(super) fn neighbours(labels: &Raster<i32>, count: i32) -> Vec<Vec<usize>> {
    let mut touching = vec![BTreeSet::new(); count as usize];
    for y in 0..labels.height() {
        for x in 0..labels.width() {
            let a = labels.get(x, y);
            for b in [labels.clamped(x as isize + 1, y as isize), labels.clamped(x as isize, y as isize + 1)] {
                if a != b && a > 0 && b > 0 {
                    touching[a as usize - 1].insert(b as usize - 1);
                    touching[b as usize - 1].insert(a as usize - 1);
                }
            }
        }
    }
    touching.into_iter().map(|set| set.into_iter().collect()).collect()
}

/// Repeatedly replaces weak doubled directions by the mean of their neighbours', until all are filled.
fn fill_weak(directions: &mut [[f64; 2]], neighbours: &[Vec<usize>]) {
    let strongest = directions.iter().map(|d| d[0].hypotenuse(d[1])).fold(0.0, f64::max);
    let is_weak: Vec<bool> = directions.iter().map(|d| d[0].hypotenuse(d[1]) < WEAK * strongest).collect();
    for (direction, _) in directions.iter_mut().zip(&is_weak).filter(|(_, weak)| **weak) {
        *direction = [0.0, 0.0];
    }
    for _ in 0..FILL_ROUNDS {
        let before = directions.to_vec();
        for (i, direction) in directions.iter_mut().enumerate().filter(|(i, _)| is_weak[*i]) {
            let sum = neighbours[i].iter().fold([0.0, 0.0], |s, &j| [s[0] + before[j][0], s[1] + before[j][1]]);
            *direction = sum.map(|v| v / neighbours[i].len().max(1) as f64);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hues_are_angles() {
        assert_eq!(hue([255, 0, 0]), Some(0.0));
        assert_eq!(hue([0, 255, 0]), Some(120.0));
        assert_eq!(hue([90, 90, 92]), None);
        assert!((upright(PI * 0.75) + 45.0).abs() < 1e-9);
    }

    #[test]
    fn weak_regions_take_their_neighbours_direction() {
        let mut directions = vec![[1.0, 0.0], [0.001, 0.0], [0.0, 0.001], [1.0, 0.2]];
        fill_weak(&mut directions, &[vec![1], vec![0, 2], vec![1, 3], vec![2]]);
        assert!(directions[1][0] > 0.9 && directions[2][0] > 0.9 && directions[1][1] < directions[2][1]);
    }
}
