//! The code row: version, number of pens, size of a cell, check.

use super::grid::{BITS, MOST_PENS, VERSION};

/// Smallest and step of the sizes of a cell that a code can tell, in millimetres.
const FIRST_SIZE: f64 = 10.0;
const SIZE_STEP: f64 = 0.5;
const SIZES: u32 = 64;
/// The check is the rest of a division by this prime, so that it finds every wrong bit and every two wrong neighbours.
const PRIME: u32 = 31;

/// What a sheet says of itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Code {
    pub version: u32,
    pub pens: usize,
    /// Side of a cell in millimetres.
    pub cell: f64,
}

/// The largest side of a cell up to this one that a code can tell, in millimetres.
pub(super) fn size_within(cell: f64) -> f64 {
    let most = FIRST_SIZE + SIZE_STEP * f64::from(SIZES - 1);
    (((cell + 1e-9) / SIZE_STEP).floor() * SIZE_STEP).min(most)
}

/// The bits of a code, the first one leftmost.
pub(super) fn bits(pens: usize, cell: f64) -> [bool; BITS] {
    let size = (((cell - FIRST_SIZE) / SIZE_STEP).round().max(0.0) as u32).min(SIZES - 1);
    let payload = (VERSION & 3) << 9 | ((pens.clamp(1, MOST_PENS) - 1) as u32) << 6 | size;
    let word = payload << 5 | (PRIME - payload % PRIME);
    std::array::from_fn(|i| word >> (BITS - 1 - i) & 1 == 1)
}

/// What the bits say, if their check holds.
pub(super) fn read(bits: &[bool; BITS]) -> Option<Code> {
    let word = bits.iter().fold(0_u32, |word, bit| word << 1 | u32::from(*bit));
    let (payload, check) = (word >> 5, word & 31);
    let size = payload & (SIZES - 1);
    (check == PRIME - payload % PRIME).then(|| Code {
        version: payload >> 9,
        pens: (payload >> 6 & 7) as usize + 1,
        cell: FIRST_SIZE + SIZE_STEP * f64::from(size),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_read_and_wrong_bits_found() {
        for pens in 1..=MOST_PENS {
            let bits = bits(pens, 13.5);
            assert_eq!(read(&bits), Some(Code { version: VERSION, pens, cell: 13.5 }));
            for i in 0..BITS {
                let mut wrong = bits;
                wrong[i] = !wrong[i];
                assert_eq!(read(&wrong), None, "{i}");
            }
        }
    }

    #[test]
    fn sizes_are_rounded_down() {
        assert_eq!((size_within(13.49), size_within(13.5), size_within(99.0)), (13.0, 13.5, 41.5));
    }
}
