//! Less ink than a nib can make: dots smaller than the nib are thinned out, so that their mean ink stays.

use crate::drawing::Mark;
use crate::geometry::{Point, blue_noise_order};

/// Which marks are drawn. A dot smaller than the nib would lay down a whole nib's disc; it stands for its neighbours with the share of
/// that disc which was asked for, in blue-noise order, so that what is left is evenly spread.
pub(super) fn keeps_tone(marks: &[Mark], nib: f64) -> Vec<bool> {
    let smallest = 0.5 * nib;
    let small: Vec<(usize, Point, f64)> = marks
        .iter()
        .enumerate()
        .filter_map(|(i, mark)| match mark {
            Mark::Dot(dot) if dot.radius < smallest => Some((i, dot.centre, (dot.radius / smallest).powi(2))),
            _ => None,
        })
        .collect();
    let mut kept = vec![true; marks.len()];
    let centres: Vec<Point> = small.iter().map(|(_, centre, _)| *centre).collect();
    let count = centres.len() as f64;
    for (rank, i) in blue_noise_order(&centres).into_iter().enumerate() {
        let (mark, _, share) = small[i];
        kept[mark] = (rank as f64 + 0.5) / count < share;
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Dot;

    #[test]
    fn as_much_ink_is_left_as_was_asked_for() {
        let marks: Vec<Mark> =
            (0..2500).map(|i| Mark::Dot(Dot::circle(Point::new(f64::from(i % 50), f64::from(i / 50)), 0.09))).collect();
        let kept = keeps_tone(&marks, 0.3).into_iter().filter(|k| *k).count();
        assert_eq!(kept, 900, "(0.09 / 0.15)^2 of 2500");
        assert!(keeps_tone(&marks, 0.18).into_iter().all(|k| k));
    }
}
