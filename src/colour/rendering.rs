//! What the photograph's colours are to become on paper: white the lightest that there is, black the darkest.

use super::eye::{Oklab, look_of_light};
use crate::elementary::Elementary as _;

/// From the photograph's light to a look on paper.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rendering {
    /// Lightness of the darkest that ink reaches, 0 to 1.
    darkest: f32,
    /// Look of the bare paper.
    paper: Oklab,
}

impl Rendering {
    /// `darkest` is the look of the darkest overprint, `paper` that of the bare paper.
    pub fn new(darkest: Oklab, paper: Oklab) -> Self {
        Self { darkest: lightness(darkest[0]).clamp(0.0, 0.9), paper }
    }

    /// The look that linear sRGB light becomes.
    ///
    /// On toned paper, where a white ink is the lightest, greys lead from black over the paper's own colour to white, so that a grey
    /// as light as the paper is bare paper.
    pub fn look(&self, rgb: [f32; 3]) -> Oklab {
        /// A paper lighter than this is taken for white.
        const WHITE: f32 = 0.999;
        let [l, a, b] = look_of_light(rgb);
        let l = root(self.lifted(lightness(l)));
        if self.paper[0] > WHITE {
            return [l, a, b];
        }
        let near = if l < self.paper[0] { l / self.paper[0] } else { (1.0 - l) / (1.0 - self.paper[0]) };
        let near = near.clamp(0.0, 1.0);
        [l, a + near * self.paper[1], b + near * self.paper[2]]
    }

    /// Black becomes the darkest; up to the knee tones follow a parabola that ends in slope 1. If the knee would lie above white,
    /// all tones are compressed.
    fn lifted(&self, l: f32) -> f32 {
        /// Lightness (L\*) up to this multiple of the darkest is lifted; lighter tones stay as they are.
        const KNEE: f32 = 2.5;
        /// Slope of the lifted tones at black.
        const TOE: f32 = 0.2;
        let d = self.darkest;
        let knee = KNEE * d;
        if l >= knee || l >= 1.0 {
            return l;
        }
        if knee <= 1.0 {
            let t = l / knee;
            return d + t * (knee - 2.0 * d + d * t);
        }
        let toe = TOE.min(1.0 - d);
        d + l * (toe + (1.0 - d - toe) * l)
    }
}

/// L\*/100 of a grey by its lightness in Oklab, and back.
fn lightness(l: f32) -> f32 {
    let y = l.max(0.0).powi(3);
    if y > 216.0 / 24_389.0 { 1.16 * y.cube_root() - 0.16 } else { y * 24_389.0 / 2_700.0 }
}

fn root(l: f32) -> f32 {
    let y = if l > 0.08 { ((l + 0.16) / 1.16).powi(3) } else { l * 2_700.0 / 24_389.0 };
    y.max(0.0).cube_root()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHITE_PAPER: Oklab = [1.0, 0.0, 0.0];

    #[test]
    fn black_is_lifted_and_light_tones_stay() {
        for darkest in [0.1f32, 0.3, 0.5, 0.7, 0.95] {
            let rendering = Rendering::new([darkest, 0.01, 0.0], WHITE_PAPER);
            let greys: Vec<f32> = (0..=100).map(|i| rendering.look([(i as f32 / 100.0).powi(2); 3])[0]).collect();
            assert!((greys[0] - darkest).abs() < 0.02 || darkest > 0.9, "{darkest}: {}", greys[0]);
            assert!((greys[100] - 1.0).abs() < 1e-3);
            assert!(greys.windows(2).all(|pair| pair[1] > pair[0]), "{darkest}");
        }
        let rendering = Rendering::new([0.25, 0.0, 0.0], WHITE_PAPER);
        assert!((rendering.look([0.3; 3])[0] - look_of_light([0.3; 3])[0]).abs() < 1e-5);
    }

    #[test]
    fn a_grey_as_light_as_toned_paper_is_bare() {
        let paper = [0.8, 0.02, 0.05];
        let rendering = Rendering::new([0.2, 0.0, 0.0], paper);
        let grey = 0.8f32.powi(3);
        let look = rendering.look([grey; 3]);
        assert!((0..3).all(|i| (look[i] - paper[i]).abs() < 1e-3), "{look:?}");
        assert!(rendering.look([1.0; 3])[1].abs() < 1e-3);
    }
}
