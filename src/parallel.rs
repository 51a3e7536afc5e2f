//! Work shared among threads by one driver, which is compiled once. With rayon's own iterators at each call, a tenth of the crate's
//! machine code was drivers.

use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};

/// Most shares into which values are divided: enough for the threads of a large machine, however unequal the work.
const SHARES: usize = 256;

/// Work on a number. A trait of its own, since the table of a `dyn Fn` has three copies of each closure.
trait Numbered: Sync {
    fn on(&self, i: usize);
}

impl<F: Fn(usize) + Sync> Numbered for F {
    fn on(&self, i: usize) {
        self(i);
    }
}

/// As [`Numbered`], with a result.
trait Valued<T>: Sync {
    fn of(&self, i: usize) -> T;
}

impl<T, F: Fn(usize) -> T + Sync> Valued<T> for F {
    fn of(&self, i: usize) -> T {
        self(i)
    }
}

/// As [`Numbered`], with the share of that number.
trait Shared<T>: Sync {
    fn on(&self, i: usize, share: &mut [T]);
}

impl<T, F: Fn(usize, &mut [T]) + Sync> Shared<T> for F {
    fn on(&self, i: usize, share: &mut [T]) {
        self(i, share);
    }
}

fn each(count: usize, work: &dyn Numbered) {
    (0..count).into_par_iter().for_each(|i| work.on(i));
}

/// What `value` makes of each number below `count`, in their order, made in parallel.
pub(crate) fn collected<T: Send>(count: usize, value: &(impl Fn(usize) -> T + Sync)) -> Vec<T> {
    collected_by(count, value)
}

fn collected_by<T: Send>(count: usize, value: &dyn Valued<T>) -> Vec<T> {
    let share = count.div_ceil(SHARES).max(1);
    let shares: Vec<Mutex<Vec<T>>> = (0..count.div_ceil(share)).map(|_| Mutex::default()).collect();
    each(shares.len(), &|i: usize| {
        let made = (i * share..((i + 1) * share).min(count)).map(|i| value.of(i)).collect();
        *shares[i].lock().unwrap_or_else(PoisonError::into_inner) = made;
    });
    let mut all = Vec::with_capacity(count);
    shares.into_iter().for_each(|share| all.append(&mut share.into_inner().unwrap_or_else(PoisonError::into_inner)));
    all
}

/// What `value` makes of each item, in their order, made in parallel.
pub(crate) fn mapped<T: Sync, U: Send>(items: &[T], value: &(impl Fn(&T) -> U + Sync)) -> Vec<U> {
    collected_by(items.len(), &|i: usize| value(&items[i]))
}

/// The results of two works that do not need each other, done at the same time.
#[cfg(feature = "see")]
pub(crate) fn both<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
    rayon::join(a, b)
}

/// Calls `work` with the number and the values of each share of `share` values (a row, some rows), in parallel.
pub(crate) fn shares<T: Send>(values: &mut [T], share: usize, work: &(impl Fn(usize, &mut [T]) + Sync)) {
    shares_by(values, share, work);
}

fn shares_by<T: Send>(values: &mut [T], share: usize, work: &dyn Shared<T>) {
    let parts: Vec<Mutex<Option<&mut [T]>>> = values.chunks_mut(share.max(1)).map(|part| Mutex::new(Some(part))).collect();
    each(parts.len(), &|i: usize| {
        let part = parts[i].lock().unwrap_or_else(PoisonError::into_inner).take();
        part.into_iter().for_each(|part| work.on(i, part));
    });
}

/// Rows that are given one scratch: it is then made seldom, and a small raster is still divided among threads.
const ROWS: usize = 8;

/// As [`shares`] by rows, each with a scratch that the rows before have used.
pub(crate) fn rows_with<T: Send, S>(
    values: &mut [T],
    width: usize,
    scratch: &(impl Fn() -> S + Sync),
    work: &(impl Fn(&mut S, usize, &mut [T]) + Sync),
) {
    shares(values, ROWS * width, &|part, rows| {
        let mut own = scratch();
        rows.chunks_mut(width).enumerate().for_each(|(j, row)| work(&mut own, ROWS * part + j, row));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn add_squares(first: usize, values: &mut [usize]) {
        values.iter_mut().enumerate().for_each(|(i, out)| *out += (first + i).pow(2));
    }

    #[test]
    fn values_keep_their_order_and_each_share_is_seen_once() {
        for count in [0, 1, 2, 255, 256, 257, 1000, 70_000] {
            let expected: Vec<usize> = (0..count).map(|i| i * i).collect();
            assert_eq!(collected(count, &|i| i * i), expected);
            assert_eq!(mapped(&expected, &|square| square + 1), expected.iter().map(|square| square + 1).collect::<Vec<_>>());
            let mut values = vec![0; count];
            shares(&mut values, 7, &|share, part| add_squares(7 * share, part));
            assert_eq!(values, expected);
            let mut by_rows = vec![0; count];
            rows_with(&mut by_rows, 7, &|| 0, &|_, y, row| add_squares(7 * y, row));
            assert_eq!(by_rows, expected);
        }
    }
}
