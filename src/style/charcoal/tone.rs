//! Step 5: smudged tone (sections 3.1.5 and 6.3.1), as grains on the tooth of the paper.

use super::Drawer;
use super::features::Features;
use super::regions::Regions;
use crate::drawing::{Area, Mark};
use crate::elementary::Elementary as _;
use crate::field::{Curve, grain_areas};
use crate::geometry::{BezPath, Point, simplify};
use crate::raster::{Raster, gaussian_blur, paper_texture};
use std::f32::consts::PI;

/// Pixels per grain: with fewer, small grains lose their shape; more cost time and bytes.
const PIXELS_A_GRAIN: f64 = 5.0;
/// Scale of the coarser texture that the thesis blends in, in grains: clumps of two or three grains make a middle tone gritty.
const CLUMP: f32 = 2.0;
/// Tolerance of a grain's outline, in grains.
const OUTLINE_TOLERANCE: f64 = 0.04;
/// Maximum effect of `brighten`: ink removed everywhere, so that lit skin is bare paper, and a share of the rest. Tuned on the busts:
/// with less lifted, light skin is grey all over; with more, dark skin is washed out.
const LIFTED: f32 = 0.3;
const THINNED: f32 = 0.4;
/// Ink below which paper is left clean, as smudging does; half a grain in a hundred would look like dust.
const CLEAN: f32 = 0.012;

impl Drawer<'_> {
    pub(super) fn tone(&self, regions: &Regions, features: &Features) -> Vec<Mark> {
        self.observer.begin("tone");
        let smudged = self.smudged(regions, features);
        self.show("smudged", &smudged);
        let grain = self.parameters.grain.0;
        let picture = self.portrait.placement.picture;
        let count = |length: f64| ((length / grain * PIXELS_A_GRAIN).round() as usize).max(4);
        let (width, height) = (count(picture.width()), count(picture.height()));
        let tooth = paper_texture(width, height, PIXELS_A_GRAIN as f32, self.seed ^ 0x7007);
        let clumps = paper_texture(width, height, CLUMP * PIXELS_A_GRAIN as f32, self.seed ^ 0xc1a9);
        let (fx, fy) = (smudged.width() as f64 / width as f64, smudged.height() as f64 / height as f64);
        let wanted = Raster::from_fn(width, height, |x, y| {
            let s = smudged.sample((x as f64 + 0.5) * fx, (y as f64 + 0.5) * fy);
            if s > 1.0 - CLEAN { 1.0 } else { on_texture(s, clumps.get(x, y), self.parameters.texture_bias) }
        });
        let place = |p: &Point| {
            let (tx, ty) = (p.x / width as f64, p.y / height as f64);
            Point::new(picture.x0 + tx * picture.width(), picture.y0 + ty * picture.height())
        };
        grain_areas(&wanted, &tooth)
            .iter()
            .filter_map(|outlines| area(outlines, OUTLINE_TOLERANCE * PIXELS_A_GRAIN, place))
            .collect()
    }

    /// Blurred inside the visible region, brightened, blurred again over its border (section 3.1.5).
    fn smudged(&self, regions: &Regions, features: &Features) -> Raster<f32> {
        let visible = regions.unmasked().zip_map(&features.tones.share, |v, theirs| v.min(1.0 - theirs));
        let blur = self.pixels(self.parameters.smudge) as f32;
        let ink = self.darkness().zip_map(&visible, |ink, v| ink * v);
        let (ink, weight) = (gaussian_blur(&ink, blur), gaussian_blur(&visible, blur));
        let washed =
            ink.zip_map(&weight, |ink, w| if w > 0.01 { self.washed(ink / w) } else { 0.0 }).zip_map(&visible, |i, v| i * v);
        // The eyes' whites stay clean.
        gaussian_blur(&washed, 0.5 * blur).zip_map(&features.tones.share, |ink, theirs| 1.0 - ink * (1.0 - theirs))
    }

    /// Brightened ink of the smudge.
    pub(super) fn washed(&self, ink: f32) -> f32 {
        let wash = self.parameters.brighten;
        (ink - LIFTED * wash).max(0.0) * (1.0 - THINNED * wash)
    }
}

/// The tone `d(s, t)` of section 6.3.1, with the texture shifted so that its mean, and with it the mean of `d`, is `s` (errata).
fn on_texture(s: f32, t: f32, bias: f32) -> f32 {
    let weight = f32::midpoint(1.0, (2.0 * PI * (s - 0.5)).cosine());
    let t = t - 0.5 + s;
    ((t * weight + s * (1.0 - weight) + bias * s) / (bias + 1.0)).clamp(0.0, 1.0)
}

/// One grain on the page: its border and its holes.
fn area(outlines: &[Curve], tolerance: f64, place: impl Fn(&Point) -> Point) -> Option<Mark> {
    let mut outline = BezPath::new();
    for curve in outlines {
        // The first point is repeated so that the simplification keeps the whole ring.
        let mut ring = curve.points.clone();
        ring.push(*curve.points.first()?);
        let mut ring = simplify(&ring, tolerance);
        ring.pop();
        if ring.len() < 3 {
            continue;
        }
        outline.move_to(place(&ring[0]));
        ring[1..].iter().for_each(|p| outline.line_to(place(p)));
        outline.close_path();
    }
    (!outline.is_empty()).then_some(Mark::Area(Area { outline, colour: None }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_blend_keeps_the_mean_and_is_rough_in_the_middle() {
        for s in [0.0_f32, 0.1, 0.3, 0.5, 0.8, 1.0] {
            let values: Vec<f32> = (0..1000).map(|i| on_texture(s, (i as f32 + 0.5) / 1000.0, 1.0)).collect();
            let mean = values.iter().sum::<f32>() / 1000.0;
            assert!((mean - s).abs() < 1e-3, "{mean} for {s}");
        }
        let spread = |s| on_texture(s, 1.0, 1.0) - on_texture(s, 0.0, 1.0);
        assert!(spread(0.5) > 0.45 && spread(0.05) < 0.03 && spread(0.95) < 0.03);
    }
}
