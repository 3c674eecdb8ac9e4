//! The most bridges that two piles side by side can have, whatever their strips: no two at one panel, so a greatest matching
//! of the cut edges between them, by augmenting paths (Berge 1957).

use crate::dual::Dual;

/// The bound for the panels of two piles.
pub(crate) fn between(dual: &Dual, own: &[usize], others: &[usize]) -> usize {
    let mut others = others.to_vec();
    others.sort_unstable();
    let across = |panel: &usize| -> Vec<usize> {
        let near = (0..4).filter_map(|edge| dual.across(*panel, edge));
        near.filter_map(|across| others.binary_search(&across.panel).ok()).collect()
    };
    let near: Vec<Vec<usize>> = own.iter().map(across).filter(|near| !near.is_empty()).collect();
    greatest(&near, others.len())
}

/// The size of a greatest matching of panels with others: of every panel the others it may go with.
fn greatest(near: &[Vec<usize>], others: usize) -> usize {
    let mut matching = Matching { near, mate: vec![None; others], seen: vec![0; others] };
    (0..near.len()).filter(|panel| matching.augment(*panel)).count()
}

/// An other that a search without success has seen. Later paths can't lead through it to a free one (Kuhn 1955), so it is
/// never looked at again: all searches that fail take linear time together.
const DEAD: usize = usize::MAX;

struct Matching<'a> {
    near: &'a [Vec<usize>],
    /// Of every other its panel.
    mate: Vec<Option<usize>>,
    /// Of every other the last search that saw it, each named by one more than its first panel.
    seen: Vec<usize>,
}

impl Matching<'_> {
    /// Gives a panel a mate, by giving others another one where needed.
    fn augment(&mut self, first: usize) -> bool {
        let name = first + 1;
        let mut reached = Vec::new();
        // The panels along the path, each with the number of the neighbour that is tried.
        let mut path = vec![(first, self.free(first).unwrap_or(0))];
        while let Some((panel, number)) = path.last_mut() {
            let Some(&other) = self.near[*panel].get(*number) else {
                path.pop();
                if let Some((_, number)) = path.last_mut() {
                    *number += 1;
                }
                continue;
            };
            if self.seen[other] == name || self.seen[other] == DEAD {
                *number += 1;
                continue;
            }
            self.seen[other] = name;
            reached.push(other);
            let Some(taken) = self.mate[other] else {
                for (panel, number) in path {
                    self.mate[self.near[panel][number]] = Some(panel);
                }
                return true;
            };
            path.push((taken, self.free(taken).unwrap_or(0)));
        }
        for other in reached {
            self.seen[other] = DEAD;
        }
        false
    }

    /// The number of a neighbour that has no mate: it ends the path at once.
    fn free(&self, panel: usize) -> Option<usize> {
        self.near[panel].iter().position(|other| self.mate[*other].is_none())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// The same by trying everything.
    fn tried(near: &[Vec<usize>], taken: &mut Vec<usize>) -> usize {
        let Some((first, rest)) = near.split_first() else { return 0 };
        let mut most = tried(rest, taken);
        for other in first {
            if !taken.contains(other) {
                taken.push(*other);
                most = most.max(1 + tried(rest, taken));
                taken.pop();
            }
        }
        most
    }

    #[test]
    fn small_borders_have_as_many_bridges_as_trying_everything_finds() {
        let mut random = Random::new(1, 1);
        let mut below_both = 0;
        for _ in 0..2000 {
            let (panels, others) = (1 + random.below(7), 1 + random.below(7));
            let near: Vec<Vec<usize>> =
                (0..panels).map(|_| (0..=random.below(3)).map(|_| random.below(others)).collect()).collect();
            let most = tried(&near, &mut Vec::new());
            assert_eq!(greatest(&near, others), most, "{near:?}");
            below_both += usize::from(most < panels.min(others));
        }
        assert!(below_both > 100, "hard ones are among them: {below_both}");
    }

    /// Counts the bridges of a border on a thread that has no room for a path on its stack.
    fn on_a_small_stack(near: Vec<Vec<usize>>, others: usize) -> usize {
        let thread = std::thread::Builder::new().stack_size(64 << 10);
        thread.spawn(move || greatest(&near, others)).unwrap().join().unwrap()
    }

    #[test]
    fn a_path_through_two_hundred_thousand_edges_fits_on_a_small_stack() {
        // Every panel takes its first other; the last panel moves them all on.
        let count = 100_000;
        let mut near: Vec<Vec<usize>> = (0..count).map(|panel| vec![panel, panel + 1]).collect();
        near.push(vec![0]);
        assert_eq!(on_a_small_stack(near, count + 1), count + 1);
    }

    #[test]
    fn thousands_of_searches_without_success_take_no_longer_than_one() {
        // As many others as panels along the chain, so that no panel beyond finds room: each would walk all of it.
        let count = 100_000;
        let mut near: Vec<Vec<usize>> =
            (0..count).map(|panel| vec![panel, (panel + 1).min(count - 1)]).collect();
        near.extend((0..count).map(|_| vec![0]));
        assert_eq!(on_a_small_stack(near, count), count);
    }
}
