//! Panels that a partition may not move: each part keeps those around a panel of its own.

use crate::adjacency::Adjacency;
use std::collections::VecDeque;

/// For every panel the part that holds it, if one does.
pub(crate) struct Held {
    part_of: Vec<Option<usize>>,
}

impl Held {
    /// Nothing is held.
    pub(crate) fn none() -> Self {
        Self { part_of: Vec::new() }
    }

    /// Each part holds its own seed and the panels nearer to that than to other seeds, up to `radius` hinges away.
    pub(crate) fn around(neighbours: &Adjacency, seeds: &[usize], radius: usize) -> Self {
        let mut part_of = vec![None; neighbours.len()];
        let mut reached: VecDeque<(usize, usize)> = seeds.iter().map(|seed| (*seed, 0)).collect();
        for (part, seed) in seeds.iter().enumerate() {
            part_of[*seed] = Some(part);
        }
        while let Some((panel, distance)) = reached.pop_front() {
            if distance == radius {
                break;
            }
            for &other in &neighbours[panel] {
                if part_of[other].is_none() {
                    part_of[other] = part_of[panel];
                    reached.push_back((other, distance + 1));
                }
            }
        }
        Self { part_of }
    }

    /// The part that holds a panel.
    pub(crate) fn part_of(&self, panel: usize) -> Option<usize> {
        self.part_of.get(panel).copied().flatten()
    }

    /// Of every member the half that it must stay in, given the parts that are beyond; nothing where nothing is held.
    pub(super) fn halves(&self, members: &[usize], beyond: impl Fn(usize) -> bool) -> Vec<Option<bool>> {
        let half = |panel: &usize| self.part_of(*panel).map(&beyond);
        if self.any() { members.iter().map(half).collect() } else { Vec::new() }
    }

    /// Whether any panel is held.
    pub(crate) fn any(&self) -> bool {
        !self.part_of.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_part_holds_what_is_nearest_to_its_seed() {
        let strip: Adjacency =
            (0..9_usize).map(|n| [n.wrapping_sub(1), n + 1].into_iter().filter(|m| *m < 9)).collect();
        let held = Held::around(&strip, &[3, 4], 2);
        let parts: Vec<Option<usize>> = (0..9).map(|panel| held.part_of(panel)).collect();
        let (a, b) = (Some(0), Some(1));
        assert_eq!(parts, [None, a, a, a, b, b, b, None, None]);
        assert!(held.any() && !Held::none().any());
        assert_eq!(Held::none().part_of(4), None);
    }
}
