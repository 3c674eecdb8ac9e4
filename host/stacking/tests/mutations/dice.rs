//! Seeded choices of a mutation.

use proptest::prelude::Rng;
use proptest::test_runner::{RngAlgorithm, TestRng};

/// The choices that belong to one seed.
pub(crate) struct Dice(TestRng);

impl Dice {
    /// The choices of a seed.
    pub(crate) fn new(seed: u64) -> Self {
        let mut bytes = [0; 32];
        bytes[..8].copy_from_slice(&seed.to_le_bytes());
        Self(TestRng::from_seed(RngAlgorithm::ChaCha, &bytes))
    }

    /// A number below a limit, which is not 0.
    pub(crate) fn below(&mut self, limit: usize) -> usize {
        usize::try_from(self.0.next_u64() % limit as u64).unwrap()
    }

    /// One of several.
    pub(crate) fn of<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }

    /// Two different numbers below a limit of at least 2.
    pub(crate) fn two_below(&mut self, limit: usize) -> [usize; 2] {
        let first = self.below(limit);
        [first, (first + 1 + self.below(limit - 1)) % limit]
    }
}
