//! The curve of a camera: sRGB with more or less contrast.

use crate::colour::sheet::lab;

/// Encoding of light by a camera: sRGB's, then `v + s (3 v^2 - 2 v^3 - v)`; s is 0 for plain sRGB.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Curve {
    pub contrast: f32,
}

impl Curve {
    /// Linear light of an encoded value, both 0 to 1.
    pub(super) fn light(self, encoded: f32) -> f32 {
        lab::srgb_to_linear(self.straightened(encoded))
    }

    /// The encoded value of linear light, both 0 to 1.
    pub(super) fn encoded(self, light: f32) -> f32 {
        let v = lab::linear_to_srgb(light.clamp(0.0, 1.0));
        v + self.contrast * v * (3.0 * v - 2.0 * v * v - 1.0)
    }

    /// Linear light that was decoded by plain sRGB, decoded rightly.
    pub(super) fn corrected(self, light: [f32; 3]) -> [f32; 3] {
        if self.contrast == 0.0 { light } else { light.map(|v| if v > 1.0 { v } else { self.light(lab::linear_to_srgb(v)) }) }
    }

    /// The sRGB value that the curve took to this one.
    fn straightened(self, value: f32) -> f32 {
        let s = self.contrast;
        if s == 0.0 {
            return value;
        }
        // Newton's method; the curve rises for |s| < 0.5.
        (0..6).fold(value, |v, _| {
            let rest = v + s * v * (3.0 * v - 2.0 * v * v - 1.0) - value;
            v - rest / (1.0 + s * (6.0 * v - 6.0 * v * v - 1.0))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_undone() {
        for contrast in [-0.2, 0.0, 0.1, 0.4] {
            for i in 0..=20 {
                let v = i as f32 / 20.0;
                let (curve, light) = (Curve { contrast }, lab::srgb_to_linear(v));
                let bent = v + contrast * (v * v * (3.0 - 2.0 * v) - v);
                assert!((curve.light(bent) - light).abs() < 1e-5, "{contrast} {v}");
                assert!((curve.encoded(light) - bent).abs() < 1e-5, "{contrast} {v}");
            }
        }
    }
}
