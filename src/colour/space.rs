//! Colour spaces: sRGB, CIE XYZ, CIE L\*a\*b\* and Oklab, and the difference of two colours as it is seen.
//!
//! All of XYZ is relative: white paper, or whatever is taken as white, has Y = 1.

use crate::elementary::Elementary as _;

/// CIE XYZ of the illuminant D65 for the 2 degree observer.
pub const D65: [f64; 3] = [0.950_47, 1.0, 1.088_83];

/// sRGB's primaries in XYZ (IEC 61966-2-1).
const RGB_TO_XYZ: [[f64; 3]; 3] =
    [[0.412_456_4, 0.357_576_1, 0.180_437_5], [0.212_672_9, 0.715_152_2, 0.072_175_0], [0.019_333_9, 0.119_192_0, 0.950_304_1]];
const XYZ_TO_RGB: [[f64; 3]; 3] = [
    [3.240_454_2, -1.537_138_5, -0.498_531_4],
    [-0.969_266_0, 1.876_010_8, 0.041_556_0],
    [0.055_643_4, -0.204_025_9, 1.057_225_2],
];

/// From XYZ to the cones' responses of Oklab, and from their cube roots to L, a, b (Ottosson 2020).
pub(super) const XYZ_TO_LMS: [[f64; 3]; 3] = [
    [0.818_933_010_1, 0.361_866_742_4, -0.128_859_713_7],
    [0.032_984_543_6, 0.929_311_871_5, 0.036_145_638_7],
    [0.048_200_301_8, 0.264_366_269_1, 0.633_851_707_0],
];
pub(super) const ROOTS_TO_OKLAB: [[f64; 3]; 3] = [
    [0.210_454_255_3, 0.793_617_785_0, -0.004_072_046_8],
    [1.977_998_495_1, -2.428_592_205_0, 0.450_593_709_9],
    [0.025_904_037_1, 0.782_771_766_2, -0.808_675_766_0],
];

/// CIE's exact bounds of the linear part of L\*.
const EPSILON: f64 = 216.0 / 24_389.0;
const KAPPA: f64 = 24_389.0 / 27.0;

/// A colour in CIE L\*a\*b\*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lab {
    /// Lightness, 0 (black) to 100 (white).
    pub l: f64,
    /// From green (below 0) to red.
    pub a: f64,
    /// From blue (below 0) to yellow.
    pub b: f64,
}

impl Lab {
    /// From XYZ, seen beside `white` (in XYZ too).
    pub fn from_xyz(xyz: [f64; 3], white: [f64; 3]) -> Self {
        let f = |i: usize| {
            let t = xyz[i] / white[i];
            if t > EPSILON { t.cube_root() } else { (KAPPA * t + 16.0) / 116.0 }
        };
        let [x, y, z] = [f(0), f(1), f(2)];
        Self { l: 116.0 * y - 16.0, a: 500.0 * (x - y), b: 200.0 * (y - z) }
    }

    /// To XYZ, seen beside `white`.
    pub fn to_xyz(self, white: [f64; 3]) -> [f64; 3] {
        let y = (self.l + 16.0) / 116.0;
        let roots = [y + self.a / 500.0, y, y - self.b / 200.0];
        let back = |t: f64| if t * t * t > EPSILON { t * t * t } else { (116.0 * t - 16.0) / KAPPA };
        [0, 1, 2].map(|i| back(roots[i]) * white[i])
    }

    /// From linear sRGB light beside its own white (D65).
    pub fn from_rgb(rgb: [f64; 3]) -> Self {
        Self::from_xyz(rgb_to_xyz(rgb), D65)
    }

    /// To linear sRGB light; outside of sRGB, values leave 0 to 1.
    pub fn to_rgb(self) -> [f64; 3] {
        xyz_to_rgb(self.to_xyz(D65))
    }

    /// The visible difference of two colours by CIEDE2000 (Sharma, Wu and Dalal 2005, with all factors 1): about 1 is just
    /// noticeable side by side.
    pub fn difference(self, other: Self) -> f64 {
        ciede2000(self, other)
    }
}

/// The linear light of an encoded sRGB value, both 0 to 1.
pub fn srgb_to_linear(v: f64) -> f64 {
    if v <= 0.040_45 { v / 12.92 } else { ((v + 0.055) / 1.055).power(2.4) }
}

/// The encoded sRGB value of linear light, both 0 to 1.
pub fn linear_to_srgb(v: f64) -> f64 {
    if v <= 0.003_130_8 { v * 12.92 } else { 1.055 * v.power(1.0 / 2.4) - 0.055 }
}

/// From linear sRGB to XYZ.
pub fn rgb_to_xyz(rgb: [f64; 3]) -> [f64; 3] {
    times(&RGB_TO_XYZ, rgb)
}

/// From XYZ to linear sRGB; outside of sRGB, values leave 0 to 1.
pub fn xyz_to_rgb(xyz: [f64; 3]) -> [f64; 3] {
    times(&XYZ_TO_RGB, xyz)
}

/// Oklab (L 0 to 1, a, b) of XYZ beside D65 (Ottosson 2020).
#[cfg(test)]
pub fn xyz_to_oklab(xyz: [f64; 3]) -> [f64; 3] {
    times(&ROOTS_TO_OKLAB, times(&XYZ_TO_LMS, xyz).map(f64::cube_root))
}

/// Matrix times vector.
pub(super) fn times(matrix: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

fn ciede2000(one: Lab, two: Lab) -> f64 {
    let mean_chroma = 0.5 * (one.a.hypotenuse(one.b) + two.a.hypotenuse(two.b));
    let stretch = 1.5 - 0.5 * (chroma_share(mean_chroma)).sqrt();
    let (a1, a2) = (one.a * stretch, two.a * stretch);
    let (c1, c2) = (a1.hypotenuse(one.b), a2.hypotenuse(two.b));
    let hue = |a: f64, b: f64| if a == 0.0 && b == 0.0 { 0.0 } else { b.angle_over(a).to_degrees().rem_euclid(360.0) };
    let (h1, h2) = (hue(a1, one.b), hue(a2, two.b));
    let is_grey = c1 * c2 == 0.0;
    let turn = match h2 - h1 {
        _ if is_grey => 0.0,
        turn if turn > 180.0 => turn - 360.0,
        turn if turn < -180.0 => turn + 360.0,
        turn => turn,
    };
    let mean_hue = match h1 + h2 {
        sum if is_grey => sum,
        sum if (h1 - h2).abs() <= 180.0 => 0.5 * sum,
        sum if sum < 360.0 => 0.5 * (sum + 360.0),
        sum => 0.5 * (sum - 360.0),
    };
    let (lightness, chroma) = (0.5 * (one.l + two.l), 0.5 * (c1 + c2));
    let cosine = |degrees: f64| degrees.to_radians().cosine();
    let t = 1.0 - 0.17 * cosine(mean_hue - 30.0) + 0.24 * cosine(2.0 * mean_hue) + 0.32 * cosine(3.0 * mean_hue + 6.0)
        - 0.20 * cosine(4.0 * mean_hue - 63.0);
    let off = (lightness - 50.0) * (lightness - 50.0);
    let by_lightness = (two.l - one.l) / (1.0 + 0.015 * off / (20.0 + off).sqrt());
    let by_chroma = (c2 - c1) / (1.0 + 0.045 * chroma);
    let by_hue = 2.0 * (c1 * c2).sqrt() * (0.5 * turn).to_radians().sine() / (1.0 + 0.015 * chroma * t);
    let bend = (-((mean_hue - 275.0) / 25.0) * ((mean_hue - 275.0) / 25.0)).exponential();
    let rotation = -2.0 * chroma_share(chroma).sqrt() * (60.0 * bend).to_radians().sine();
    (by_lightness * by_lightness + by_chroma * by_chroma + by_hue * by_hue + rotation * by_chroma * by_hue).max(0.0).sqrt()
}

/// C^7 / (C^7 + 25^7).
fn chroma_share(chroma: f64) -> f64 {
    let seventh = chroma.powi(7);
    seventh / (seventh + 25.0f64.powi(7))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The published test data of Sharma, Wu and Dalal 2005: L1 a1 b1, L2 a2 b2, difference.
    const PAIRS: [[f64; 7]; 34] = [
        [50.0000, 2.6772, -79.7751, 50.0000, 0.0000, -82.7485, 2.0425],
        [50.0000, 3.1571, -77.2803, 50.0000, 0.0000, -82.7485, 2.8615],
        [50.0000, 2.8361, -74.0200, 50.0000, 0.0000, -82.7485, 3.4412],
        [50.0000, -1.3802, -84.2814, 50.0000, 0.0000, -82.7485, 1.0000],
        [50.0000, -1.1848, -84.8006, 50.0000, 0.0000, -82.7485, 1.0000],
        [50.0000, -0.9009, -85.5211, 50.0000, 0.0000, -82.7485, 1.0000],
        [50.0000, 0.0000, 0.0000, 50.0000, -1.0000, 2.0000, 2.3669],
        [50.0000, -1.0000, 2.0000, 50.0000, 0.0000, 0.0000, 2.3669],
        [50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0009, 7.1792],
        [50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0010, 7.1792],
        [50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0011, 7.2195],
        [50.0000, 2.4900, -0.0010, 50.0000, -2.4900, 0.0012, 7.2195],
        [50.0000, -0.0010, 2.4900, 50.0000, 0.0009, -2.4900, 4.8045],
        [50.0000, -0.0010, 2.4900, 50.0000, 0.0010, -2.4900, 4.8045],
        [50.0000, -0.0010, 2.4900, 50.0000, 0.0011, -2.4900, 4.7461],
        [50.0000, 2.5000, 0.0000, 50.0000, 0.0000, -2.5000, 4.3065],
        [50.0000, 2.5000, 0.0000, 73.0000, 25.0000, -18.0000, 27.1492],
        [50.0000, 2.5000, 0.0000, 61.0000, -5.0000, 29.0000, 22.8977],
        [50.0000, 2.5000, 0.0000, 56.0000, -27.0000, -3.0000, 31.9030],
        [50.0000, 2.5000, 0.0000, 58.0000, 24.0000, 15.0000, 19.4535],
        [50.0000, 2.5000, 0.0000, 50.0000, 3.1736, 0.5854, 1.0000],
        [50.0000, 2.5000, 0.0000, 50.0000, 3.2972, 0.0000, 1.0000],
        [50.0000, 2.5000, 0.0000, 50.0000, 1.8634, 0.5757, 1.0000],
        [50.0000, 2.5000, 0.0000, 50.0000, 3.2592, 0.3350, 1.0000],
        [60.2574, -34.0099, 36.2677, 60.4626, -34.1751, 39.4387, 1.2644],
        [63.0109, -31.0961, -5.8663, 62.8187, -29.7946, -4.0864, 1.2630],
        [61.2901, 3.7196, -5.3901, 61.4292, 2.2480, -4.9620, 1.8731],
        [35.0831, -44.1164, 3.7933, 35.0232, -40.0716, 1.5901, 1.8645],
        [22.7233, 20.0904, -46.6940, 23.0331, 14.9730, -42.5619, 2.0373],
        [36.4612, 47.8580, 18.3852, 36.2715, 50.5065, 21.2231, 1.4146],
        [90.8027, -2.0831, 1.4410, 91.1528, -1.6435, 0.0447, 1.4441],
        [90.9257, -0.5406, -0.9208, 88.6381, -0.8985, -0.7239, 1.5381],
        [6.7747, -0.2908, -2.4247, 5.8714, -0.0985, -2.2286, 0.6377],
        [2.0776, 0.0795, -1.1350, 0.9033, -0.0636, -0.5514, 0.9082],
    ];

    #[test]
    fn differences_are_the_published_ones() {
        for [l1, a1, b1, l2, a2, b2, difference] in PAIRS {
            let (one, two) = (Lab { l: l1, a: a1, b: b1 }, Lab { l: l2, a: a2, b: b2 });
            assert!((one.difference(two) - difference).abs() < 5e-5, "{one:?} {two:?} {}", one.difference(two));
            assert!((one.difference(two) - two.difference(one)).abs() < 1e-9);
        }
    }

    #[test]
    fn spaces_are_left_and_entered_again() {
        for rgb in [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [0.9, 0.1, 0.002], [0.001, 0.5, 0.3], [0.2, 0.0, 0.7]] {
            let back = Lab::from_rgb(rgb).to_rgb();
            assert!(rgb.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-5), "{rgb:?} {back:?}");
            assert!(rgb.iter().all(|v| (srgb_to_linear(linear_to_srgb(*v)) - v).abs() < 1e-6));
        }
    }

    #[test]
    fn known_colours() {
        let red = Lab::from_rgb([1.0, 0.0, 0.0]);
        assert!((red.l - 53.24).abs() < 0.01 && (red.a - 80.09).abs() < 0.02 && (red.b - 67.20).abs() < 0.02, "{red:?}");
        // The pairs of Ottosson 2020.
        let near = |one: [f64; 3], two: [f64; 3]| one.iter().zip(two).all(|(a, b)| (a - b).abs() < 6e-4);
        assert!(near(xyz_to_oklab([0.950, 1.0, 1.089]), [1.0, 0.0, 0.0]));
        assert!(near(xyz_to_oklab([1.0, 0.0, 0.0]), [0.450, 1.236, -0.019]));
        assert!(near(xyz_to_oklab([0.0, 1.0, 0.0]), [0.922, -0.671, 0.263]));
        assert!(near(xyz_to_oklab([0.0, 0.0, 1.0]), [0.153, -1.415, -0.449]));
    }
}
