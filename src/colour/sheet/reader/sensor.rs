//! White balance as cameras do it: in the sensor's own channels.

use super::solve::solved;

/// Response of a sensor to linear sRGB, each row's sum 1: about the mean of the published DNG matrices of five cameras (Canon 5D III, Nikon
/// D800, Sony A7 III, Olympus E-M5, Fujifilm X-T2). They differ by less than a tenth, and a wrong one matters only as far as the picture has
/// a cast.
const SENSOR: [[f64; 3]; 3] = [[0.62, 0.25, 0.13], [0.07, 0.71, 0.22], [0.01, 0.22, 0.77]];

/// A colour under light in which `white` is seen, as it would look were `white` seen as `wanted`. All are linear sRGB.
pub(super) fn balanced(colour: [f64; 3], white: [f64; 3], wanted: [f64; 3]) -> [f64; 3] {
    let [colour, white, wanted] = [colour, white, wanted].map(sensed);
    let right: Vec<f64> = (0..3).map(|c| colour[c] / white[c].max(1e-9) * wanted[c]).collect();
    let rows = SENSOR.iter().map(|row| row.to_vec()).collect();
    solved(rows, right).map_or([0.0; 3], |v| [v[0], v[1], v[2]])
}

fn sensed(v: [f64; 3]) -> [f64; 3] {
    SENSOR.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_becomes_what_is_wanted_and_without_a_cast_nothing_changes() {
        let (white, wanted) = ([0.8, 0.6, 0.4], [0.9, 0.88, 0.8]);
        let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|c| (a[c] - b[c]).abs() < 1e-9);
        assert!(near(balanced(white, white, wanted), wanted));
        let red = [0.5, 0.05, 0.1];
        assert!(near(balanced(red, [0.5; 3], [1.0; 3]), red.map(|v| 2.0 * v)));
        // Under warm light a blue is seen too dark, and balanced against the cast.
        assert!(balanced([0.1, 0.1, 0.2], white, [1.0; 3])[2] > 0.45);
    }
}
