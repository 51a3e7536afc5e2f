//! How much ink each of three families of lines carries: the second and the third enter where it is darker, without a step.

use crate::elementary::Elementary as _;
use crate::raster::{Raster, fast_gaussian_within};
use crate::style::form::Surface;

/// From where to where in ink the second and the third family of lines enter, and their greatest ink. One that enters earlier makes
/// half tones a net, a later one leaves slits between the lines.
const SKIN: [Entry; 2] = [Entry { from: 0.36, to: 0.80, most: 0.62 }, Entry { from: 0.66, to: 0.95, most: 0.55 }];
const CLOTH: [Entry; 2] = [Entry { from: 0.30, to: 0.90, most: 0.72 }, Entry { from: 0.0, to: 1.0, most: 0.0 }];
const HAIR: [Entry; 2] = [Entry { from: 0.74, to: 1.0, most: 0.5 }, Entry { from: 0.0, to: 1.0, most: 0.0 }];
/// Ink below which an entering family is not drawn: its lines would be hairs.
const LEAST: f32 = 0.08;

#[derive(Clone, Copy)]
struct Entry {
    from: f32,
    to: f32,
    most: f32,
}

impl Entry {
    fn ink(self, ink: f32) -> f32 {
        let t = ((ink - self.from) / (self.to - self.from)).clamp(0.0, 1.0);
        let ink = self.most * t * t * (3.0 - 2.0 * t);
        if ink < LEAST { 0.0 } else { ink }
    }
}

/// The ink of each family on a surface for the ink wanted, of which the second and the third see no more than `entering`: what they leave
/// white together is the tone, since lines that cross overlap like independent events.
fn shares(ink: f32, entering: f32, surface: Surface) -> [f32; 3] {
    let [second, third] = match surface {
        Surface::Skin => SKIN,
        Surface::Hair | Surface::Beard => HAIR,
        Surface::Cloth => CLOTH,
    };
    let entering = entering.min(ink);
    let (second, third) = (second.ink(entering), third.ink(entering));
    let first = 1.0 - (1.0 - ink) / ((1.0 - second) * (1.0 - third));
    [first.clamp(0.0, 1.0), second, third]
}

/// The ink of each family over a region, 0 to 1; `pitch` in pixels. On skin lines cross in wide shadows alone: in one of a few pitches, as beside a nostril,
/// they would be a comb of ticks.
pub(super) fn shares_of(ink: &Raster<f32>, surface: Surface, region: &Raster<f32>, pitch: f64) -> [Raster<f32>; 3] {
    /// The blur in pitches that narrow shadows do not outlast.
    const NARROW: f64 = 2.5;
    let entering = if surface == Surface::Skin {
        fast_gaussian_within(ink, &region.map(|share| share + 1e-6), (NARROW * pitch) as f32)
    } else {
        ink.clone()
    };
    [0, 1, 2].map(|family| ink.zip_map(&entering, |ink, entering| shares(ink, entering, surface)[family]))
}

/// The ink of what has a share of the darkness, 0 to 1: together with the rest, over it, it leaves white what the tone does.
pub(super) fn part_of(ink: f32, share: f32) -> f32 {
    1.0 - (1.0 - ink).max(0.02).power(share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_cross_in_a_wide_shadow_and_not_in_a_narrow_one() {
        let shadow = |width: usize| Raster::from_fn(200, 80, |x, _| if x.abs_diff(100) <= width { 0.7 } else { 0.2 });
        let second = |width: usize| {
            let [first, second, _] = shares_of(&shadow(width), Surface::Skin, &Raster::filled(200, 80, 1.0), 5.0);
            (first.get(100, 40), second.get(100, 40))
        };
        assert!(second(50).1 > 0.3, "{:?}", second(50));
        assert!(second(4).1 < 0.1 && (second(4).0 - 0.7).abs() < 0.1, "{:?}", second(4));
    }

    #[test]
    fn what_is_left_white_is_the_tone() {
        for surface in [Surface::Skin, Surface::Hair, Surface::Cloth] {
            for ink in (0..=100).map(|i| i as f32 / 100.0) {
                let white: f32 = shares(ink, ink, surface).iter().map(|share| 1.0 - share).product();
                assert!((white - (1.0 - ink)).abs() < 1e-5, "{surface:?} {ink}: {white}");
            }
        }
    }
}
