//! Small solids for property tests.

use super::boundary::Voxel;
use std::collections::BTreeSet;

/// A solid that grows from one voxel: each number chooses a voxel that is there and a side to grow on.
pub(crate) fn solid(choices: &[(usize, usize)]) -> BTreeSet<Voxel> {
    let mut grown = vec![[0; 3]];
    for (which, side) in choices {
        let mut next = grown[which % grown.len()];
        next[side % 3] += if side % 2 == 0 { 1 } else { -1 };
        if !grown.contains(&next) {
            grown.push(next);
        }
    }
    grown.into_iter().collect()
}
