//! Brings more neighbours of different piles to equal heights, by small changes of the strips within the piles. Two panels
//! that a strip goes out of its way for, can be left out there and taken in where the strip passes on their other side: all
//! heights in between change by two.
//!
//! ```text
//! ... a x y b ... u u' ...   with a beside b, u beside x, u' beside y   ->   ... a b ... u x y u' ...
//! ```

use super::Matched;
use super::border::{BorderEdge, borders, places};
use crate::dual::Dual;
use crate::folding_map::Facing;

/// Sweeps over all piles.
const SWEEPS: usize = 6;
/// Panels looked at in a pile over all changes of it.
const EFFORT: usize = 1_000_000;
/// What neighbours at one height are worth that face each other, and others, which a break can turn to face each other.
const FACING: i32 = 3;
const LEVEL: i32 = 1;

/// Two panels change their place in the pile: those at `from` and the height above go between `to` and the height above,
/// counted before they leave.
#[derive(Clone, Copy)]
struct Move {
    from: usize,
    to: usize,
    reversed: bool,
}

/// Changes the strips as long as that brings more neighbours to equal heights.
pub(super) fn align(dual: &Dual, matched: &mut Matched) {
    let mut aligner = Aligner::new(dual, matched);
    let mut left: Vec<usize> = aligner.piles.iter().map(|pile| EFFORT / pile.len().max(1)).collect();
    for _ in 0..SWEEPS {
        let mut bettered = false;
        for (pile, left) in left.iter_mut().enumerate() {
            while *left > 0 && aligner.improve(pile) {
                bettered = true;
                *left -= 1;
            }
        }
        if !bettered {
            break;
        }
    }
    matched.piles = aligner.piles;
    matched.facing = aligner.facing;
    matched.turns.fill(0);
}

struct Aligner<'a> {
    dual: &'a Dual,
    piles: Vec<Vec<usize>>,
    borders: Vec<Vec<BorderEdge>>,
    /// Of every panel its pile and its height there.
    place: Vec<(usize, usize)>,
    /// Of every panel how it lies on its cell.
    facing: Vec<Facing>,
}

impl<'a> Aligner<'a> {
    fn new(dual: &'a Dual, matched: &Matched) -> Self {
        let mut facing = matched.facing.clone();
        for (pile, turn) in matched.piles.iter().zip(&matched.turns) {
            for panel in pile {
                facing[*panel] = facing[*panel].turned(*turn);
            }
        }
        let place = places(matched.piles.iter(), facing.len());
        let borders = borders(dual, matched.piles.iter(), &place, &matched.cells);
        Self { dual, borders, piles: matched.piles.clone(), place, facing }
    }

    /// Makes the move that seems best; says whether it did better.
    fn improve(&mut self, pile: usize) -> bool {
        let Some(best) = self.best_move(pile) else { return false };
        let before = self.worth(pile);
        let old = self.piles[pile].clone();
        best.apply(&mut self.piles[pile]);
        self.settle(pile);
        // Around corners of the surface facings may have changed as well.
        let better = self.worth(pile) > before;
        if !better {
            self.piles[pile] = old;
            self.settle(pile);
        }
        better
    }

    /// What the cut edges of a pile are worth: whether each bridge that exists stays is not looked at, only their number.
    fn worth(&self, pile: usize) -> i32 {
        let level = |cut: &&BorderEdge| self.place[cut.panel].1 == self.place[cut.other].1;
        self.borders[pile].iter().filter(level).map(|cut| self.value(cut)).sum()
    }

    fn value(&self, cut: &BorderEdge) -> i32 {
        let faces = self.facing[cut.panel].side(cut.edge) == cut.towards
            && self.facing[cut.other].side(cut.other_edge) == cut.towards.opposite();
        if faces { FACING } else { LEVEL }
    }

    /// The facings and heights of a pile after a change; the bottom panel lies as it did.
    fn settle(&mut self, pile: usize) {
        for height in 0..self.piles[pile].len() {
            let panel = self.piles[pile][height];
            self.place[panel].1 = height;
            if height > 0 {
                let below = self.piles[pile][height - 1];
                // Neighbours in a strip are neighbours in the graph, so the edges are there.
                if let Some([edge, other]) = self.dual.common_edges(below, panel) {
                    self.facing[panel] = self.facing[below].folded(edge, other);
                }
            }
        }
    }

    /// The move that gains most, if any gains.
    fn best_move(&self, pile: usize) -> Option<Move> {
        let panels = &self.piles[pile];
        let count = panels.len();
        // Sums from the bottom up of what is gained when a panel comes two lower or two higher, and of what there is.
        let mut lower = vec![0; count + 1];
        let mut higher = vec![0; count + 1];
        let mut now = vec![0; count];
        for cut in &self.borders[pile] {
            let (height, other) = (self.place[cut.panel].1, self.place[cut.other].1);
            let value = self.value(cut);
            if other == height {
                now[height] += value;
                lower[height + 1] -= value;
                higher[height + 1] -= value;
            } else if other + 2 == height {
                lower[height + 1] += value;
            } else if other == height + 2 {
                higher[height + 1] += value;
            }
        }
        for height in 0..count {
            lower[height + 1] += lower[height];
            higher[height + 1] += higher[height];
        }
        let mut best: Option<(i32, Move)> = None;
        // The ends of the pile stay, so that it lies as it did.
        for from in 1..count.saturating_sub(2) {
            let [a, x, y, b] = [-1, 0, 1, 2].map(|step| panels[from.saturating_add_signed(step)]);
            if self.dual.common_edges(a, b).is_none() {
                continue;
            }
            for edge in 0..4 {
                let Some(u) = self.dual.across(x, edge).map(|across| across.panel) else { continue };
                if self.place[u].0 != pile || u == a || u == y {
                    continue;
                }
                let at = self.place[u].1;
                for (to, next) in [(at, at + 1), (at.wrapping_sub(1), at.wrapping_sub(1))] {
                    let reversed = next < at || next == usize::MAX;
                    let Some(&beside) = panels.get(next) else { continue };
                    if (from.saturating_sub(1)..=from + 1).contains(&to)
                        || self.dual.common_edges(y, beside).is_none()
                    {
                        continue;
                    }
                    let gain = if to > from {
                        lower[to + 1] - lower[from + 2]
                    } else {
                        higher[from] - higher[to + 1]
                    } - now[from]
                        - now[from + 1];
                    if gain > 0 && best.is_none_or(|(most, _)| gain > most) {
                        best = Some((gain, Move { from, to, reversed }));
                    }
                }
            }
        }
        best.map(|(_, best)| best)
    }
}

impl Move {
    fn apply(self, pile: &mut [usize]) {
        let Self { from, to, reversed } = self;
        let at = if to > from {
            pile[from..=to].rotate_left(2);
            to - 1
        } else {
            pile[to + 1..from + 2].rotate_right(2);
            to + 1
        };
        if reversed {
            pile.swap(at, at + 1);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_move_puts_its_pair_between_two_others_and_leaves_the_rest_in_order() {
        let pile: Vec<usize> = (10..20).collect();
        for (from, to, reversed) in (1..8)
            .flat_map(|from| (0..9).map(move |to| (from, to)))
            .flat_map(|(from, to)| [(from, to, false), (from, to, true)])
            .filter(|(from, to, _)| !(from - 1..=from + 1).contains(to))
        {
            let mut moved = pile.clone();
            Move { from, to, reversed }.apply(&mut moved);
            let mut pair = [pile[from], pile[from + 1]];
            if reversed {
                pair.reverse();
            }
            let mut expected: Vec<usize> =
                pile.iter().copied().filter(|panel| !pair.contains(panel)).collect();
            let at = expected.iter().position(|panel| *panel == pile[to]).unwrap() + 1;
            expected.splice(at..at, pair);
            assert_eq!(moved, expected, "{from} to {to}, reversed: {reversed}");
        }
    }
}
