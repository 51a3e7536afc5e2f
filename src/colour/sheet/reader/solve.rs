//! Small systems of linear equations.

/// The solution of a square system by elimination with pivots; `None` if it has none. Up to a few dozen unknowns.
pub(super) fn solved(mut left: Vec<Vec<f64>>, mut right: Vec<f64>) -> Option<Vec<f64>> {
    let count = right.len();
    for i in 0..count {
        let pivot = (i..count).max_by(|a, b| left[*a][i].abs().total_cmp(&left[*b][i].abs()))?;
        left.swap(i, pivot);
        right.swap(i, pivot);
        let lead = left[i][i];
        if !lead.is_finite() || lead.abs() < 1e-13 {
            return None;
        }
        for row in i + 1..count {
            let factor = left[row][i] / lead;
            let (upper, lower) = left.split_at_mut(row);
            lower[0][i..].iter_mut().zip(&upper[i][i..]).for_each(|(v, above)| *v -= factor * above);
            right[row] -= factor * right[i];
        }
    }
    for i in (0..count).rev() {
        let known: f64 = (i + 1..count).map(|j| left[i][j] * right[j]).sum();
        right[i] = (right[i] - known) / left[i][i];
    }
    right.iter().all(|v| v.is_finite()).then_some(right)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn systems_are_solved_or_refused() {
        let x = solved(vec![vec![0.0, 2.0], vec![3.0, 1.0]], vec![4.0, 5.0]).unwrap();
        assert!((x[0] - 1.0).abs() < 1e-12 && (x[1] - 2.0).abs() < 1e-12);
        assert_eq!(solved(vec![vec![1.0, 2.0], vec![2.0, 4.0]], vec![1.0, 1.0]), None);
    }
}
