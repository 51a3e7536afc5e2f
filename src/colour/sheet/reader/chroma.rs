//! Colour of fine lines in JPEG files, which hold colour at half their resolution.
//!
//! Between thin lines, luma is sharp and colour is not: ink is too grey and paper too coloured. Their encoded mean is right, but that of
//! their light is not. On a mixture of one ink and paper, colour follows luma; so it is put back by luma, with the same encoded mean.

use super::curve::Curve;

/// Least difference in luma of ink and paper from which colour can follow it.
const LEAST_LUMA: f32 = 0.06;

/// Red and blue less luma as linear functions of luma; encoded values, 0 to 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chroma {
    offset: [f32; 2],
    slope: [f32; 2],
}

impl Chroma {
    /// The colour of mixtures of paper and ink, both in linear light as the picture has them, with an encoded mean; `None` if ink and paper are
    /// about as light.
    pub(super) fn of(paper: [f64; 3], ink: [f64; 3], curve: Curve, mean: [f32; 3]) -> Option<Self> {
        let [paper, ink] = [paper, ink].map(|light| apart(light.map(|v| curve.encoded(v as f32))));
        let step = ink[0] - paper[0];
        let slope = [1, 2].map(|i| (ink[i] - paper[i]) / step);
        let [luma, red, blue] = apart(mean);
        (step.abs() >= LEAST_LUMA).then(|| Self { offset: [red - slope[0] * luma, blue - slope[1] * luma], slope })
    }

    /// An encoded colour with the colour that belongs to its luma.
    #[inline]
    pub(super) fn restored(&self, colour: [f32; 3]) -> [f32; 3] {
        let luma = luma(colour);
        let (red, blue) = (self.offset[0] + self.slope[0] * luma, self.offset[1] + self.slope[1] * luma);
        // What is left of luma is green's.
        [luma + red, luma - (0.299 * red + 0.114 * blue) / 0.587, luma + blue].map(|v| v.clamp(0.0, 1.0))
    }
}

/// Luma of BT.601, as in JPEG.
#[inline]
fn luma([r, g, b]: [f32; 3]) -> f32 {
    0.299 * r + 0.587 * g + 0.114 * b
}

/// Luma, red less luma, blue less luma.
fn apart(colour: [f32; 3]) -> [f32; 3] {
    let luma = luma(colour);
    [luma, colour[0] - luma, colour[2] - luma]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colour_at_half_resolution_is_put_back() {
        let curve = Curve::default();
        let (paper, ink) = ([0.8, 0.8, 0.75], [0.05, 0.3, 0.5]);
        let encoded = |light: [f64; 3]| light.map(|v| curve.encoded(v as f32));
        // Pixels of ink and paper by turns, whose colour is their mean.
        let ([p, i], mean) = ([paper, ink].map(encoded), [paper, ink].map(encoded));
        let mean: [f32; 3] = std::array::from_fn(|c| 0.5 * (mean[0][c] + mean[1][c]));
        let dull = |colour: [f32; 3]| {
            let [_, red, blue] = apart(mean);
            let luma = luma(colour);
            [luma + red, luma - (0.299 * red + 0.114 * blue) / 0.587, luma + blue]
        };
        let chroma = Chroma::of(paper, ink, curve, mean).unwrap();
        for colour in [p, i] {
            assert!((0..3).all(|c| (chroma.restored(dull(colour))[c] - colour[c]).abs() < 1e-4));
            assert!((0..3).any(|c| (dull(colour)[c] - colour[c]).abs() > 0.05));
        }
        assert!(Chroma::of(paper, paper, curve, mean).is_none());
    }
}
