//! A small single-stroke font, so that a test sheet needs no other: digits, `. + %` and the capitals that the sheet uses.

use super::Point;

/// Height of the grid on which letters are drawn; its width is 4.
const GRID: f64 = 6.0;
/// Width of a letter, as a share of its height.
const WIDTH: f64 = 0.55;
/// Advance from one letter to the next, as a share of their height.
const ADVANCE: f64 = 0.85;

/// The strokes of each letter on a grid of 4 x 6, y down. Spaces separate strokes; each pair of digits is the x and y of a point.
const LETTERS: [(char, &str); 27] = [
    ('0', "103041453616050110"),
    ('1', "112026"),
    ('2', "01103041420646"),
    ('3', "004023334445361605"),
    ('4', "36300444"),
    ('5', "400003334445361605"),
    ('6', "3010010516364544331304"),
    ('7', "004016"),
    ('8', "103041423313020110 1304051636454433"),
    ('9', "1636454130100102133342"),
    ('.', "2526"),
    ('+', "2125 0343"),
    ('%', "4006 0010110100 3545463635"),
    ('B', "06003041423303 3344453606"),
    ('D', "00204244260600"),
    ('E', "40000646 0333"),
    ('F', "400006 0333"),
    ('I', "2026"),
    ('L', "000646"),
    ('M', "0600234046"),
    ('N', "06004640"),
    ('P', "06003041423303"),
    ('S', "413010010213334445361605"),
    ('W', "0016233640"),
    ('X', "0046 4006"),
    ('Y', "0023 402326"),
    ('Z', "00400646"),
];

/// Lines that write a text from its upper left corner, in millimetres. Letters missing from the font leave a gap.
pub(crate) fn written(text: &str, at: Point, height: f64) -> Vec<Vec<Point>> {
    let letters = text.chars().enumerate();
    letters.flat_map(|(i, letter)| strokes(letter, Point::new(at.x + i as f64 * ADVANCE * height, at.y), height)).collect()
}

/// Width of a text.
pub(crate) fn width(text: &str, height: f64) -> f64 {
    (text.chars().count() as f64 * ADVANCE - (ADVANCE - WIDTH)).max(0.0) * height
}

fn strokes(letter: char, at: Point, height: f64) -> Vec<Vec<Point>> {
    let drawn = LETTERS.iter().find(|(known, _)| *known == letter).map_or("", |(_, strokes)| strokes);
    let place = |pair: &[u8]| {
        let [x, y] = [pair[0], pair[1]].map(|digit| f64::from(digit - b'0'));
        Point::new(at.x + x * WIDTH * height / 4.0, at.y + y * height / GRID)
    };
    drawn.split_whitespace().map(|stroke| stroke.as_bytes().chunks_exact(2).map(place).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_stay_in_their_box() {
        for (letter, drawn) in LETTERS {
            assert!(drawn.split(' ').all(|stroke| stroke.len() >= 4 && stroke.len() % 2 == 0), "{letter}");
            let lines = written(&letter.to_string(), Point::new(10.0, 20.0), 2.0);
            assert!(!lines.is_empty());
            for p in lines.iter().flatten() {
                assert!(
                    (10.0..=10.0 + 2.0 * WIDTH + 1e-9).contains(&p.x) && (20.0..=22.0 + 1e-9).contains(&p.y),
                    "{letter} {p:?}"
                );
            }
        }
    }

    #[test]
    fn texts_are_as_wide_as_they_say() {
        let right = written("100%", Point::ORIGIN, 2.0).into_iter().flatten().fold(0.0, |most: f64, p| most.max(p.x));
        assert!((right - width("100%", 2.0)).abs() < 1e-9);
        assert!(written("", Point::ORIGIN, 2.0).is_empty() && width("", 2.0) < 1e-9);
    }
}
