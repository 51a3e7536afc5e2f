//! Random numbers that are the same everywhere.

/// The numbers from 0 up to `count` in an order that follows from the seed (Fisher and Yates 1938).
pub(in crate::plot) fn shuffled(count: usize, seed: u64) -> Vec<usize> {
    let mut random = SplitMix::new(seed);
    let mut order: Vec<usize> = (0..count).collect();
    for last in (1..count).rev() {
        order.swap(last, random.below(last + 1));
    }
    order
}

/// The generator known as `SplitMix64`: one addition and some mixing a number.
pub(super) struct SplitMix(u64);

impl SplitMix {
    /// The sequence of this number; sequences of different numbers have nothing to do with each other.
    pub(super) fn new(sequence: u64) -> Self {
        let mut start = Self(sequence);
        Self(start.next())
    }

    /// A number below `limit`, all equally likely but for one part in 2^32 or so.
    pub(super) fn below(&mut self, limit: usize) -> usize {
        ((u128::from(self.next()) * limit as u128) >> 64) as usize
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
}
