//! The best way through a raster from its first row to its last, by dynamic programming.

use super::Raster;

/// The column of each row on the way of the highest sum from the first row to the last. From row to row it moves by at most `most`
/// columns, and a move costs `price` times its square.
pub fn best_way(values: &Raster<f32>, most: usize, price: f32) -> Vec<usize> {
    let (columns, rows) = (values.width(), values.height());
    let mut sums: Vec<f32> = values.row(0).to_vec();
    let mut from: Vec<Vec<usize>> = vec![(0..columns).collect()];
    for row in 1..rows {
        let before = |column: usize| {
            let near = column.saturating_sub(most)..(column + most + 1).min(columns);
            let sum = |b: usize| sums[b] - price * (b.abs_diff(column) as f32).powi(2);
            near.map(|b| (b, sum(b))).fold((column, f32::NEG_INFINITY), |best, b| if b.1 > best.1 { b } else { best })
        };
        let best: Vec<(usize, f32)> = (0..columns).map(before).collect();
        sums = best.iter().zip(values.row(row)).map(|((_, sum), value)| sum + value).collect();
        from.push(best.into_iter().map(|(b, _)| b).collect());
    }
    let last = (0..columns).fold(0, |best, c| if sums[c] > sums[best] { c } else { best });
    let mut way = vec![last];
    for row in (1..rows).rev() {
        way.push(from[row][way[way.len() - 1]]);
    }
    way.reverse();
    way
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_way_bends_where_it_pays() {
        let values = Raster::from_fn(5, 4, |x, y| f32::from(u8::from(x == if y < 2 { 1 } else { 3 })));
        assert_eq!(best_way(&values, 2, 0.1), [1, 1, 3, 3]);
        assert_eq!(best_way(&values, 1, 0.1), [1, 1, 2, 3]);
        assert_eq!(best_way(&values, 2, 9.0), [1, 1, 1, 1]);
    }
}
