//! Random streams by stage and element, so that results do not depend on threads or the order of work.

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;

/// The stream of one element (a dot, a line, a cell) in one stage.
pub(super) fn stream(seed: u64, stage: &str, element: u64) -> ChaCha8Rng {
    // FNV-1a hash of the name: the order of stages in the code does not matter.
    let stage =
        stage.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
    let mut random = ChaCha8Rng::seed_from_u64(seed ^ stage);
    random.set_stream(element);
    random
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;

    #[test]
    fn streams_differ_and_repeat() {
        let draw = |seed, stage, element| stream(seed, stage, element).random::<u64>();
        assert_eq!(draw(1, "seeds", 2), draw(1, "seeds", 2));
        assert_ne!(draw(1, "seeds", 2), draw(1, "seeds", 3));
        assert_ne!(draw(1, "seeds", 2), draw(1, "blobs", 2));
        assert_ne!(draw(1, "seeds", 2), draw(2, "seeds", 2));
    }
}
