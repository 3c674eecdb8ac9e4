//! Transitive reduction: of what a task waits for, only what nothing else that it waits for implies.

/// Ancestors are kept for so many tasks at a time, a bit each: the memory stays small for 100,000 tasks.
const BLOCK: usize = 4096;
const WORDS: usize = BLOCK / 64;

/// The reduction of `before`, each entry rising; `topological` has each task after those before it.
pub(super) fn of(mut before: Vec<Vec<usize>>, topological: &[usize]) -> Vec<Vec<usize>> {
    for before in &mut before {
        before.sort_unstable();
        before.dedup();
    }
    if before.iter().all(|before| before.len() < 2) {
        return before;
    }
    let mut needed: Vec<Vec<bool>> = before.iter().map(|before| vec![true; before.len()]).collect();
    let mut ancestors = vec![[0_u64; WORDS]; before.len()];
    for first in (0..before.len()).step_by(BLOCK) {
        let here = first..first + BLOCK;
        for &task in topological {
            // First without those before it themselves: what is found here is implied by another of them.
            let mut bits = [0; WORDS];
            for b in &before[task] {
                bits.iter_mut().zip(&ancestors[*b]).for_each(|(bits, more)| *bits |= more);
            }
            for (b, needed) in before[task].iter().zip(&mut needed[task]).filter(|(b, _)| here.contains(b)) {
                let (word, bit) = ((b - first) / 64, 1 << ((b - first) % 64));
                *needed &= bits[word] & bit == 0;
            }
            for b in before[task].iter().filter(|b| here.contains(b)) {
                bits[(b - first) / 64] |= 1 << ((b - first) % 64);
            }
            ancestors[task] = bits;
        }
    }
    for (before, needed) in before.iter_mut().zip(needed) {
        let mut needed = needed.into_iter();
        before.retain(|_| needed.next().unwrap_or(true));
    }
    before
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_implied_is_left_out() {
        let before = vec![vec![], vec![0], vec![0, 1, 1], vec![0, 2], vec![2, 1, 0]];
        let reduced = of(before, &[0, 1, 2, 3, 4]);
        assert_eq!(reduced, [vec![], vec![0], vec![1], vec![2], vec![2]]);
    }

    #[test]
    fn a_long_chain_with_everything_named_is_a_chain_across_blocks() {
        let tasks = BLOCK + 100;
        let before: Vec<Vec<usize>> = (0..tasks)
            .map(|task| (task.saturating_sub(3)..task).chain((task > 0).then_some(0)).collect())
            .collect();
        let order: Vec<_> = (0..tasks).collect();
        let reduced = of(before, &order);
        assert!((1..tasks).all(|task| reduced[task] == [task - 1]));
    }
}
