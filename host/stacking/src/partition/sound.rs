//! Cheap proofs that a part has no Hamiltonian cycle, before any search for one.

use super::{Neighbours, pieces};

/// What keeps a part from having a Hamiltonian cycle as far as cheap tests can tell, as a number that falls as it gets
/// nearer to having one: further pieces, panels with less than two neighbours, a surplus of one colour where it can be
/// coloured like a chess board, panels that hold it together.
pub(super) fn defects(part: &Neighbours) -> usize {
    let pieces = pieces(part, |_| true).len();
    let ends = part.iter().filter(|near| near.len() < 2).count();
    let defects = 4 * (pieces - 1) + 2 * ends;
    if defects > 0 {
        return defects + surplus(part);
    }
    surplus(part) + articulations(part)
}

/// By how much one colour outnumbers the other; 0 where the part can't be coloured.
fn surplus(part: &Neighbours) -> usize {
    let mut dark: Vec<Option<bool>> = vec![None; part.len()];
    dark[0] = Some(true);
    let mut reached = vec![0];
    let mut count = 0;
    while let Some(node) = reached.pop() {
        let other = dark[node].map(|dark| !dark);
        count += 1;
        for &next in &part[node] {
            if dark[next].is_none() {
                dark[next] = other;
                reached.push(next);
            } else if dark[next] != other {
                return 0;
            }
        }
    }
    (2 * dark.iter().filter(|dark| **dark == Some(true)).count()).abs_diff(count)
}

/// How many nodes the part falls apart without (Hopcroft and Tarjan 1973), without recursion.
fn articulations(part: &Neighbours) -> usize {
    let mut found = vec![usize::MAX; part.len()];
    let mut low = vec![usize::MAX; part.len()];
    let mut parts_off = vec![false; part.len()];
    (found[0], low[0]) = (0, 0);
    let mut time = 1;
    let mut children_of_root = 0;
    let mut way = vec![(0, usize::MAX, 0)];
    while let Some((node, parent, next)) = way.last_mut() {
        let (node, parent) = (*node, *parent);
        if let Some(&other) = part[node].get(*next) {
            *next += 1;
            if found[other] == usize::MAX {
                children_of_root += usize::from(node == 0);
                (found[other], low[other]) = (time, time);
                time += 1;
                way.push((other, node, 0));
            } else if other != parent {
                low[node] = low[node].min(found[other]);
            }
        } else {
            way.pop();
            if parent != usize::MAX {
                low[parent] = low[parent].min(low[node]);
                parts_off[parent] |= parent != 0 && low[node] >= found[parent];
            }
        }
    }
    parts_off[0] = children_of_root > 1;
    parts_off.into_iter().filter(|parts_off| *parts_off).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn graph(nodes: usize, edges: &[(usize, usize)]) -> Vec<Vec<usize>> {
        let mut graph = vec![Vec::new(); nodes];
        for (a, b) in edges {
            graph[*a].push(*b);
            graph[*b].push(*a);
        }
        graph
    }

    #[test]
    fn a_ring_may_have_a_cycle() {
        assert_eq!(0, defects(&graph(4, &[(0, 1), (1, 2), (2, 3), (3, 0)])));
        assert_eq!(0, defects(&graph(3, &[(0, 1), (1, 2), (2, 0)])));
    }

    #[test]
    fn two_rings_that_share_a_panel_have_none() {
        let bow = [(0, 1), (1, 2), (2, 0), (2, 3), (3, 4), (4, 2)];
        assert_ne!(0, defects(&graph(5, &bow)));
        // The same with the shared panel first, where the search begins.
        let turned = [(0, 1), (1, 2), (2, 0), (0, 3), (3, 4), (4, 0)];
        assert_ne!(0, defects(&graph(5, &turned)));
    }

    #[test]
    fn a_dead_end_two_pieces_and_unequal_colours_have_none() {
        assert_ne!(0, defects(&graph(4, &[(0, 1), (1, 2), (2, 0), (2, 3)])));
        assert_ne!(0, defects(&graph(6, &[(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3)])));
        let two_and_three = [(0, 2), (0, 3), (0, 4), (1, 2), (1, 3), (1, 4)];
        assert_ne!(0, defects(&graph(5, &two_and_three)));
    }
}
