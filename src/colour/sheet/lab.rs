//! sRGB and CIE L*a*b*.

use crate::elementary::Elementary as _;

/// The linear light (0 to 1) of an sRGB-encoded value (0 to 1), IEC 61966-2-1.
pub(super) fn srgb_to_linear(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).power(2.4) }
}

/// The sRGB encoding (0 to 1) of linear light (0 to 1), IEC 61966-2-1.
pub(super) fn linear_to_srgb(light: f32) -> f32 {
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.power(1.0 / 2.4) - 0.055 }
}

/// CIE L*, a*, b* of linear sRGB (1 is white), for white D65.
pub(super) fn lab([r, g, b]: [f64; 3]) -> [f64; 3] {
    let x = (0.412_456 * r + 0.357_576 * g + 0.180_437 * b) / 0.950_47;
    let y = 0.212_673 * r + 0.715_152 * g + 0.072_175 * b;
    let z = (0.019_334 * r + 0.119_192 * g + 0.950_304 * b) / 1.088_83;
    let f = |t: f64| if t > 216.0 / 24_389.0 { t.cube_root() } else { (24_389.0 / 27.0 * t + 16.0) / 116.0 };
    [116.0 * f(y) - 16.0, 500.0 * (f(x) - f(y)), 200.0 * (f(y) - f(z))]
}
