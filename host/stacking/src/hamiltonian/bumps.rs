//! Single voxels that stick out of a surface, or are missing in it, are five panels that a strip passes as if they were one: in
//! at any side, out at any other. So each is made one panel before the search, again and again (a rod shrinks to a cube),
//! and five afterwards. On a flat terrace a search from nearby can't do as much: around the bump it is coloured like a chess
//! board, and a strip that has passed by the bump would have to visit one more panel of one colour than of the other.

use super::Strip;
use crate::adjacency::Adjacency;

/// A panel with four sides around it, and the panel beyond each side where there is one.
struct Bump {
    top: usize,
    sides: [usize; 4],
    beyond: [Option<usize>; 4],
}

/// A graph with bumps made panels, and the way back.
pub(super) struct Flattened {
    /// The neighbours of every panel that is left, by new numbers.
    pub(super) neighbours: Adjacency,
    /// The old number of every panel that is left.
    left: Vec<usize>,
    /// The bumps in the order in which they went; each has become its top.
    bumps: Vec<Bump>,
    /// The number of panels before.
    panels: usize,
}

/// Makes panels of all bumps; none when there is no bump.
pub(super) fn flatten(neighbours: &Adjacency) -> Option<Flattened> {
    let mut waiting: Vec<usize> =
        (0..neighbours.len()).rev().filter(|top| bump(neighbours, *top).is_some()).collect();
    if waiting.is_empty() {
        return None;
    }
    let mut near = neighbours.clone();
    let mut gone = vec![false; near.len()];
    let mut bumps = Vec::new();
    while let Some(top) = waiting.pop() {
        let Some(bump) = Some(top).filter(|top| !gone[*top]).and_then(|top| bump(&near, top)) else {
            continue;
        };
        near.clear(top);
        for (side, beyond) in bump.sides.into_iter().zip(bump.beyond) {
            gone[side] = true;
            near.clear(side);
            if let Some(beyond) = beyond {
                near.push(top, beyond);
                near.replace(beyond, side, top);
            }
        }
        // What stands beside may be the top of a bump now, and so may this.
        waiting.extend(near[top].iter().chain([&top]));
        bumps.push(bump);
    }
    let left: Vec<usize> = (0..near.len()).filter(|panel| !gone[*panel]).collect();
    let mut number = vec![0; near.len()];
    for (new, old) in left.iter().enumerate() {
        number[*old] = new;
    }
    let kept = left.iter().map(|old| near[*old].iter().map(|near| number[*near])).collect();
    Some(Flattened { neighbours: kept, left, bumps, panels: near.len() })
}

impl Flattened {
    /// A strip of the graph as it was, of a strip of this one.
    pub(super) fn raised(&self, strip: &Strip) -> Strip {
        let Strip { order, closed } = strip;
        let (Some(first), Some(last)) = (order.first(), order.last()) else { return strip.clone() };
        let mut chain = Chain { next: vec![None; self.panels], before: vec![None; self.panels] };
        for pair in order.windows(2) {
            chain.link(Some(self.left[pair[0]]), Some(self.left[pair[1]]));
        }
        let mut first = self.left[*first];
        if *closed {
            chain.link(Some(self.left[*last]), Some(first));
        }
        for bump in self.bumps.iter().rev() {
            let (entry, exit) = (chain.before[bump.top], chain.next[bump.top]);
            let passage = bump.passage(entry, exit);
            if first == bump.top {
                first = passage[0];
            }
            chain.link(entry, Some(passage[0]));
            for pair in passage.windows(2) {
                chain.link(Some(pair[0]), Some(pair[1]));
            }
            chain.link(Some(passage[4]), exit);
        }
        let order = std::iter::successors(Some(first), |here| chain.next[*here]).take(self.panels).collect();
        Strip { order, closed: *closed }
    }
}

/// Panels in a row or a ring, each with the one before and the next.
struct Chain {
    next: Vec<Option<usize>>,
    before: Vec<Option<usize>>,
}

impl Chain {
    /// One after the other; none stands for an end.
    fn link(&mut self, u: Option<usize>, v: Option<usize>) {
        if let Some(u) = u {
            self.next[u] = v;
        }
        if let Some(v) = v {
            self.before[v] = u;
        }
    }
}

impl Bump {
    /// The five panels in the order of a strip that comes from one panel beyond and leaves to another, or ends here.
    fn passage(&self, entry: Option<usize>, exit: Option<usize>) -> [usize; 5] {
        let side_of = |panel: Option<usize>| {
            panel.and_then(|panel| self.beyond.iter().position(|beyond| *beyond == Some(panel)))
        };
        let side = |turns: usize| self.sides[turns % 4];
        match (side_of(entry), side_of(exit)) {
            (Some(a), Some(b)) if (a + 1) % 4 == b => [side(a), side(a + 3), side(a + 2), self.top, side(b)],
            (Some(a), Some(b)) if (a + 3) % 4 == b => [side(a), side(a + 1), side(a + 2), self.top, side(b)],
            (Some(a), Some(b)) => [side(a), side(a + 1), self.top, side(a + 3), side(b)],
            (Some(a), None) => [side(a), side(a + 1), side(a + 2), side(a + 3), self.top],
            (None, Some(b)) => [self.top, side(b + 3), side(b + 2), side(b + 1), side(b)],
            (None, None) => [self.top, side(0), side(1), side(2), side(3)],
        }
    }
}

/// The bump of which a panel is the top.
fn bump(near: &Adjacency, top: usize) -> Option<Bump> {
    let Ok([a, b, c, d]) = <[usize; 4]>::try_from(&near[top]) else { return None };
    let joins = |u: usize, v: usize| near[u].contains(&v);
    // In the order in which they stand around the top.
    let sides = match (joins(a, b), joins(a, c), joins(a, d)) {
        (true, false, true) => [a, b, c, d],
        (true, true, false) => [a, b, d, c],
        (false, true, true) => [a, c, b, d],
        _ => return None,
    };
    let mut beyond = [None; 4];
    for turn in 0..4 {
        let (side, next, before) = (sides[turn], sides[(turn + 1) % 4], sides[(turn + 3) % 4]);
        if !joins(side, next) || !joins(side, before) || joins(side, sides[(turn + 2) % 4]) {
            return None;
        }
        beyond[turn] = near[side].iter().copied().find(|other| ![top, next, before].contains(other));
    }
    let distinct = (0..4).all(|i| (0..i).all(|j| beyond[i].is_none() || beyond[i] != beyond[j]));
    // A strip comes in at one side and leaves at another.
    (distinct && beyond.iter().flatten().count() >= 2).then_some(Bump { top, sides, beyond })
}

#[cfg(test)]
mod tests {
    use super::super::tests::{assert_strip, sheet};
    use super::*;
    use crate::hamiltonian::find;
    use crate::random::Random;

    /// Puts a voxel on a panel.
    fn raise(neighbours: &mut Adjacency, panel: usize) {
        let beyond = neighbours[panel].to_vec();
        neighbours.clear(panel);
        let first = neighbours.len();
        for (turn, out) in beyond.iter().enumerate() {
            let sides = beyond.len();
            neighbours.add([panel, *out, first + (turn + 1) % sides, first + (turn + sides - 1) % sides]);
            neighbours.push(panel, first + turn);
            neighbours.replace(*out, panel, first + turn);
        }
    }

    #[test]
    fn a_terrace_full_of_bumps_and_towers_has_a_cycle() {
        let (width, depth) = (60, 50);
        let mut neighbours = sheet(width, depth);
        let mut random = Random::new(3, 0);
        for _ in 0..400 {
            let panel = random.below(neighbours.len());
            if neighbours[panel].len() == 4 {
                raise(&mut neighbours, panel);
            }
        }
        let strip = find(&neighbours, 1).unwrap();
        assert!(strip.closed);
        assert_strip(&neighbours, &strip);
    }

    #[test]
    fn bumps_become_panels_and_a_tower_goes_storey_by_storey() {
        let mut neighbours = sheet(5, 5);
        for _ in 0..3 {
            // The top keeps its number, so this is a tower of three.
            raise(&mut neighbours, 12);
        }
        let flat = flatten(&neighbours).unwrap();
        assert_eq!(flat.neighbours.len(), 25);
        assert_eq!(flat.bumps.len(), 3);
        assert!(flatten(&sheet(5, 5)).is_none());
    }

    #[test]
    fn a_path_may_begin_or_end_in_a_bump() {
        let mut neighbours = sheet(3, 3);
        raise(&mut neighbours, 4);
        let flat = flatten(&neighbours).unwrap();
        let order = [4, 1, 0, 3, 6, 7, 8, 5, 2];
        assert_strip(&neighbours, &flat.raised(&Strip { order: order.to_vec(), closed: false }));
        let back: Vec<usize> = order.into_iter().rev().collect();
        assert_strip(&neighbours, &flat.raised(&Strip { order: back, closed: false }));
    }
}
