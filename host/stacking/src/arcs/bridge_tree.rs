//! How deep the tree path of piles and bridges is, reckoned with the ends of the piles and of the bridges alone. The planner
//! compares thousands of layouts by it.

/// The depth from the middle of the tree, in hinges, of unbroken piles joined by bridges: piles and height of each.
pub(super) fn depth(piles: usize, height: usize, bridges: &[([usize; 2], usize)]) -> usize {
    // The stops: both ends of every pile, and the ends of the bridges.
    let mut stops: Vec<(usize, usize)> =
        (0..piles).flat_map(|pile| [(pile, 0), (pile, height - 1)]).collect();
    stops.extend(bridges.iter().flat_map(|([a, b], at)| [(*a, *at), (*b, *at)]));
    stops.sort_unstable();
    stops.dedup();
    let mut ways = vec![Vec::new(); stops.len()];
    let mut join = |a: usize, b: usize, length: usize| {
        ways[a].push((b, length));
        ways[b].push((a, length));
    };
    for (number, pair) in stops.windows(2).enumerate().filter(|(_, pair)| pair[0].0 == pair[1].0) {
        join(number, number + 1, pair[1].1 - pair[0].1);
    }
    for ([a, b], at) in bridges {
        let stop = |pile: usize| stops.binary_search(&(pile, *at)).unwrap_or_default();
        join(stop(*a), stop(*b), 1);
    }
    let (one_end, _) = farthest(&ways, 0);
    let (_, longest) = farthest(&ways, one_end);
    longest.div_ceil(2)
}

/// The stop farthest from another, and how far that is.
fn farthest(ways: &[Vec<(usize, usize)>], start: usize) -> (usize, usize) {
    let mut best = (start, 0);
    let mut open = vec![(start, usize::MAX, 0)];
    while let Some((stop, from, length)) = open.pop() {
        if length > best.1 {
            best = (stop, length);
        }
        open.extend(
            ways[stop].iter().filter(|(to, _)| *to != from).map(|(to, step)| (*to, stop, length + step)),
        );
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_single_pile_is_as_deep_as_half_of_it() {
        assert_eq!(depth(1, 8, &[]), 4);
        assert_eq!(depth(1, 1, &[]), 0);
    }

    #[test]
    fn piles_bridged_at_the_ends_are_deeper_than_in_the_middle() {
        assert_eq!(depth(2, 9, &[([0, 1], 0)]), 9);
        assert_eq!(depth(2, 9, &[([0, 1], 4)]), 5);
        assert_eq!(depth(3, 9, &[([0, 1], 4), ([1, 2], 4)]), 5);
    }
}
