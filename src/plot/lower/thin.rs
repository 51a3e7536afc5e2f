//! Thins out dots smaller than the nib, so that their mean ink is kept.

use crate::drawing::Mark;
use crate::geometry::{Point, thinned};
use crate::interrupt::Interrupt;

/// True for each mark that is drawn. A dot smaller than the nib would lay down a full nib's disc, so its area over that disc is its
/// share, and of neighbouring dots as many are drawn as their shares add up to.
pub(super) fn thin_small_dots(marks: &[Mark], nib: f64, interrupt: &Interrupt) -> Vec<bool> {
    let smallest = 0.5 * nib;
    let is_small = |mark: &Mark| matches!(mark, Mark::Dot(dot) if dot.radius < smallest && dot.centre.is_finite());
    let small: Vec<usize> = (0..marks.len()).filter(|&i| is_small(&marks[i])).collect();
    let asked = |&i: &usize| match &marks[i] {
        Mark::Dot(dot) => (dot.centre, (dot.radius / smallest).powi(2)),
        _ => (Point::ORIGIN, 1.0),
    };
    let (places, shares): (Vec<Point>, Vec<f64>) = small.iter().map(asked).unzip();
    let mut kept = vec![true; marks.len()];
    for (mark, stays) in small.into_iter().zip(thinned(&places, &shares, interrupt)) {
        kept[mark] = stays;
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drawing::Dot;

    fn grid(radius: impl Fn(i32) -> f64) -> Vec<Mark> {
        (0..2500).map(|i| Mark::Dot(Dot::circle(Point::new(f64::from(i % 50), f64::from(i / 50)), radius(i)))).collect()
    }

    #[test]
    fn as_much_ink_is_left_as_was_asked_for() {
        let kept = thin_small_dots(&grid(|_| 0.09), 0.3, &Interrupt::never()).into_iter().filter(|k| *k).count();
        assert!((880..=920).contains(&kept), "{kept}: (0.09 / 0.15)^2 of 2500 is 900");
        assert!(thin_small_dots(&grid(|_| 0.09), 0.18, &Interrupt::never()).into_iter().all(|k| k));
    }

    #[test]
    fn every_passage_keeps_its_own_share_even_where_dots_are_dense() {
        // A quarter of the page has nine times the dots.
        let mut marks = grid(|_| 0.09);
        let step = 1.0 / 3.0;
        marks.extend((0..5625).map(|i| {
            let (x, y) = (f64::from(i % 75) * step, f64::from(i / 75) * step);
            Mark::Dot(Dot::circle(Point::new(x + 0.1, y + 0.1), 0.09))
        }));
        let kept = thin_small_dots(&marks, 0.3, &Interrupt::never());
        let is_dense = |i: &usize| *i >= 2500 || (i % 50 < 26 && i / 50 < 26);
        for (of, name) in [(true, "dense"), (false, "sparse")] {
            let members: Vec<usize> = (0..marks.len()).filter(|i| is_dense(i) == of).collect();
            let share = members.iter().filter(|i| kept[**i]).count() as f64 / members.len() as f64;
            assert!((share - 0.36).abs() < 0.03, "{name}: {share}");
        }
    }

    #[test]
    fn small_windows_keep_their_tone() {
        let share = |i: i32| f64::from(i % 50) / 60.0;
        let marks = grid(|i| 0.15 * share(i).sqrt());
        let kept = thin_small_dots(&marks, 0.3, &Interrupt::never());
        let mut worst: f64 = 0.0;
        for row in 0..44 {
            for column in 0..44 {
                let inside = (0..36).map(|k| (row + k / 6) * 50 + column + k % 6);
                let error: f64 = inside.map(|i| f64::from(u8::from(kept[i as usize])) - share(i)).sum();
                worst = worst.max(error.abs());
            }
        }
        assert!(worst < 3.0, "{worst} dots of 36");
    }

    #[test]
    fn few_or_coincident_dots_do_no_harm() {
        for count in [0, 1, 2, 5, 300] {
            let marks = vec![Mark::Dot(Dot::circle(Point::new(1.0, 1.0), 0.1)); count];
            assert_eq!(thin_small_dots(&marks, 0.3, &Interrupt::never()).len(), count);
        }
    }
}
