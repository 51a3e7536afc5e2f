//! Random numbers that are the same on every platform.

/// The numbers from 0 to `count - 1`, shuffled by the seed (Fisher and Yates 1938).
pub(crate) fn shuffled(count: usize, seed: u64) -> Vec<usize> {
    let mut random = SplitMix::new(seed);
    let mut order: Vec<usize> = (0..count).collect();
    for last in (1..count).rev() {
        order.swap(last, random.below(last + 1));
    }
    order
}

/// The `SplitMix64` generator: one addition and some mixing per number.
pub(super) struct SplitMix(u64);

impl SplitMix {
    /// The sequence with this number; different sequences are unrelated.
    pub(super) fn new(sequence: u64) -> Self {
        let mut start = Self(sequence);
        Self(start.next())
    }

    /// A number below `limit`, uniform to about one part in 2^32.
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
