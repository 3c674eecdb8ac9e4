//! The tree path as a graph: how deep it is, and where its middle lies.

use crate::adjacency::Adjacency;
use crate::plan::Hinge;

/// For every panel the panels that a hinge joins it to.
pub(crate) fn joined(panels: usize, hinges: &[Hinge]) -> Adjacency {
    let mut joined = Adjacency::without_edges(panels);
    for hinge in hinges {
        let [a, b] = hinge.panels;
        joined.join(a, b);
    }
    joined
}

/// The panel from which no other is farther than needs be, and that distance in hinges.
pub(crate) fn centre(joined: &Adjacency) -> (usize, usize) {
    let one_end = farthest(joined, 0).pop().unwrap_or(0);
    // The longest way in a tree begins at the panel farthest from any panel; the tree's middle is the middle of that way.
    let way = farthest(joined, one_end);
    let middle = way.len() / 2;
    (way[middle], middle.max(way.len() - 1 - middle))
}

/// The way from a panel to the one farthest from it.
fn farthest(joined: &Adjacency, start: usize) -> Vec<usize> {
    let mut from = vec![usize::MAX; joined.len()];
    from[start] = start;
    let mut reached = vec![start];
    let mut next = 0;
    while next < reached.len() {
        let panel = reached[next];
        next += 1;
        for &other in &joined[panel] {
            if from[other] == usize::MAX {
                from[other] = panel;
                reached.push(other);
            }
        }
    }
    let mut way = vec![reached[reached.len() - 1]];
    while way[way.len() - 1] != start {
        way.push(from[way[way.len() - 1]]);
    }
    way.reverse();
    way
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_centre_of_a_strip_is_its_middle() {
        let strip: Adjacency =
            (0..7).map(|n: usize| [n.wrapping_sub(1), n + 1].into_iter().filter(|m| *m < 7)).collect();
        assert_eq!(centre(&strip), (3, 3));
        assert_eq!(centre(&Adjacency::without_edges(1)), (0, 0));
    }

    #[test]
    fn the_centre_of_a_star_with_one_long_arm_is_on_the_arm() {
        let star = [vec![1, 2, 3], vec![0], vec![0], vec![0, 4], vec![3, 5], vec![4]].into_iter().collect();
        assert_eq!(centre(&star), (3, 2));
    }
}
