//! Light and lightness.

use crate::elementary::Elementary as _;
#[cfg(feature = "see")]
use std::sync::LazyLock;

/// The linear light (0 to 1) of an sRGB-encoded value (0 to 1), IEC 61966-2-1.
pub fn srgb_to_linear(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).power(2.4) }
}

/// [`srgb_to_linear`] of a byte.
#[cfg(feature = "see")]
pub(crate) fn byte_to_linear(encoded: u8) -> f32 {
    static LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| std::array::from_fn(|v| srgb_to_linear(v as f32 / 255.0)));
    LINEAR[usize::from(encoded)]
}

/// The sRGB encoding (0 to 1) of linear light (0 to 1), IEC 61966-2-1.
pub fn linear_to_srgb(light: f32) -> f32 {
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.power(1.0 / 2.4) - 0.055 }
}

/// Luminance Y (0 to 1) of linear sRGB.
pub fn luminance([r, g, b]: [f32; 3]) -> f32 {
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// CIE L*/100 (0 to 1) of a luminance: `1.16 f(Y) - 0.16`, `f` the cube root above 0.008856, else `7.787 Y + 16/116`
/// (Bruehl 2023, appendix A, as corrected: the scan shows a power for the product).
pub fn lightness(luminance: f32) -> f32 {
    let f = if luminance > 0.008_856 { luminance.cube_root() } else { 7.787 * luminance + 16.0 / 116.0 };
    (1.16 * f - 0.16).clamp(0.0, 1.0)
}

/// CIE L*, a*, b* (0 to 100, about -100 to 100) of linear sRGB, for white D65.
pub fn lab(light: [f32; 3]) -> [f32; 3] {
    let [r, g, b] = light;
    let x = (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505;
    let y = luminance(light);
    let z = (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.0891;
    let f = |t: f32| if t > 0.008_856 { t.cube_root() } else { 7.787 * t + 16.0 / 116.0 };
    [100.0 * lightness(y), 500.0 * (f(x) - f(y)), 200.0 * (f(y) - f(z))]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lab_of_known_colours() {
        let near = |light: [f32; 3], expected: [f32; 3]| lab(light).into_iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.2);
        assert!(near([1.0; 3], [100.0, 0.0, 0.0]) && near([0.0; 3], [0.0; 3]) && near([1.0, 0.0, 0.0], [53.24, 80.09, 67.2]));
    }

    #[test]
    fn known_values() {
        assert!((srgb_to_linear(0.5) - 0.214_041).abs() < 1e-5);
        assert!((0..=255).map(|v| v as f32 / 255.0).all(|v| (linear_to_srgb(srgb_to_linear(v)) - v).abs() < 1e-5));
        assert!((lightness(0.184_187) - 0.5).abs() < 1e-4);
        assert!((lightness(1.0) - 1.0).abs() < 1e-6);
        assert!(lightness(0.0).abs() < 1e-4);
        assert!((lightness(0.008_855) - lightness(0.008_857)).abs() < 1e-4);
    }
}
