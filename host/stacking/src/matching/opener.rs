//! Opens the rings of placed piles, each so that it joins as many groups as can be and matches most.

use super::Matched;
use super::border::{BorderEdge, borders, places};
use super::groups::Groups;
use super::opening::{Frame, Opening};
use crate::dual::Dual;
use crate::folding_map::Facing;
use crate::hamiltonian::Strip;
use crate::planner::Bridges;
use crate::random::Random;

/// Times that every pile is opened anew at the end.
const SWEEPS: usize = 3;

/// A match that some opening would give.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Vote {
    opening: Opening,
    other_pile: usize,
    /// How far from the nearer end of the pile.
    central: usize,
}

/// How good an opening is: more is better. The groups that it joins come first; the last number is a lot.
type Score = (usize, usize, usize, u64);

/// Opens rings so that they match.
pub(crate) struct Opener<'a> {
    dual: &'a Dual,
    frames: Vec<Frame>,
    borders: Vec<Vec<BorderEdge>>,
    cells: &'a [[i32; 2]],
    wanted: Bridges,
    /// Of every panel its place in its ring.
    place: Vec<usize>,
    openings: Vec<Option<Opening>>,
    /// Of every panel at the border of an opened pile its height, and how it lies.
    settled: Vec<(usize, Facing)>,
}

impl<'a> Opener<'a> {
    /// Looks at rings on cells.
    pub(crate) fn new(dual: &'a Dual, rings: &[Strip], cells: &'a [[i32; 2]], wanted: Bridges) -> Self {
        let panels = rings.iter().map(|ring| ring.order.len()).sum();
        let orders = || rings.iter().map(|ring| &ring.order);
        let places = places(orders(), panels);
        Self {
            dual,
            borders: borders(dual, orders(), &places, cells),
            frames: rings.iter().map(|ring| Frame::of(ring.clone(), dual)).collect(),
            cells,
            wanted,
            place: places.into_iter().map(|(_, at)| at).collect(),
            openings: vec![None; rings.len()],
            settled: vec![(0, Facing::BOTTOM); panels],
        }
    }

    /// Opens all piles, from the first one on, which is tried in every turn.
    pub(crate) fn open_all(&mut self, first: usize, random: &mut Random) {
        let mut best: Option<(usize, usize, Vec<Option<Opening>>)> = None;
        for turn in 0..4 {
            self.openings.fill(None);
            self.settle(first, Opening { turn, ..Opening::default() });
            self.open_others(first, random);
            let (apart, matches) = (self.frames.len() - self.groups().count(), self.matches());
            if best.as_ref().is_none_or(|(a, m, _)| (apart, matches) > (*a, *m)) {
                best = Some((apart, matches, self.openings.clone()));
            }
        }
        if let Some((_, _, openings)) = best {
            for (pile, opening) in openings.into_iter().enumerate() {
                self.settle(pile, opening.unwrap_or_default());
            }
        }
    }

    /// Opens all other piles, each beside those that are open, where it matches most. A pile that matches none of them is
    /// opened anyhow, as a group of its own.
    fn open_others(&mut self, first: usize, random: &mut Random) {
        let one_group = vec![0; self.frames.len()];
        let mut closed: Vec<usize> = (0..self.frames.len()).filter(|pile| *pile != first).collect();
        while !closed.is_empty() {
            let mut best: Option<(Score, usize, Opening)> = None;
            for (number, pile) in closed.iter().enumerate() {
                if let Some((score, opening)) = self.best(*pile, &one_group, random)
                    && best.is_none_or(|(most, _, _)| score > most)
                {
                    best = Some((score, number, opening));
                }
            }
            let (number, opening) =
                best.map_or((0, Opening::default()), |(_, number, opening)| (number, opening));
            let pile = closed.remove(number);
            self.settle(pile, opening);
        }
    }

    /// The groups in which the piles hang together.
    pub(crate) fn groups(&self) -> Groups {
        self.groups_without(None)
    }

    /// Tries to join the groups of two piles side by side: opens the one anew, and where that is not enough, the other one
    /// as well. The number of groups never grows. `ring` gives the first pile another ring to try.
    pub(crate) fn join(&mut self, pile: usize, beside: usize, ring: Option<Strip>, random: &mut Random) {
        let before = self.groups().count();
        let (old_ring, old) = (ring.map(|ring| self.exchange(pile, ring)), self.openings[pile]);
        let groups = self.groups_without(Some(pile));
        let opening = self.best(pile, &groups.of, random).map(|(_, opening)| opening);
        // Where nothing matches, the new ring is kept as a group of its own: it may show its borders other sides.
        self.settle(pile, opening.unwrap_or_default());
        let after = self.groups().count();
        if after < before || (after == before && self.turn_to(pile, beside, before, random)) {
            return;
        }
        if after > before {
            if let Some(ring) = old_ring {
                self.exchange(pile, ring);
            }
            if let Some(opening) = old {
                self.settle(pile, opening);
            }
        }
    }

    /// Opens a pile in all ways that join as many other groups as its present one, until `pile` can be joined to it so that
    /// there are fewer groups.
    fn turn_to(&mut self, pile: usize, beside: usize, before: usize, random: &mut Random) -> bool {
        let (Some(old), Some(old_beside)) = (self.openings[pile], self.openings[beside]) else {
            return false;
        };
        let groups = self.groups_without(Some(beside));
        let mut ways: Vec<(Score, Opening)> = self.ways(beside, &groups.of, random);
        let most = ways.iter().map(|(score, _)| score.0).max().unwrap_or(0);
        ways.retain(|(score, opening)| score.0 == most && *opening != old_beside);
        for (_, opening) in ways {
            self.settle(beside, opening);
            if !self.votes(pile).iter().any(|vote| vote.other_pile == beside) {
                continue;
            }
            let groups = self.groups_without(Some(pile));
            if let Some((_, opening)) = self.best(pile, &groups.of, random) {
                self.settle(pile, opening);
                if self.groups().count() < before {
                    return true;
                }
                self.settle(pile, old);
            }
        }
        self.settle(beside, old_beside);
        false
    }

    /// Opens every pile once more beside all others, as long as that makes more matches.
    pub(crate) fn better(&mut self, random: &mut Random) {
        for _ in 0..SWEEPS {
            let before = self.matches();
            for pile in 0..self.frames.len() {
                let groups = self.groups_without(Some(pile));
                let (Some(now), Some((_, opening))) =
                    (self.openings[pile], self.best(pile, &groups.of, random))
                else {
                    continue;
                };
                let matches = self.matches();
                self.settle(pile, opening);
                if self.matches() < matches {
                    self.settle(pile, now);
                }
            }
            if self.matches() == before {
                break;
            }
        }
    }

    /// The piles as they are open now.
    pub(crate) fn matched(self) -> Matched {
        let openings: Vec<Opening> = self.openings.into_iter().flatten().collect();
        let piles: Vec<Vec<usize>> =
            self.frames.iter().zip(&openings).map(|(frame, opening)| frame.pile(*opening)).collect();
        let mut facing = vec![Facing::BOTTOM; self.settled.len()];
        for ((frame, opening), pile) in self.frames.iter().zip(&openings).zip(&piles) {
            for (height, panel) in pile.iter().enumerate() {
                facing[*panel] = frame.facing(opening.way, opening.start, height);
            }
        }
        let turns = openings.iter().map(|opening| opening.turn).collect();
        Matched { piles, facing, turns, cells: self.cells.to_vec() }
    }

    /// Opens a pile so. Only its border is looked at by others.
    fn settle(&mut self, pile: usize, opening: Opening) {
        let Opening { way, start, turn } = opening;
        let frame = &self.frames[pile];
        for BorderEdge { panel, .. } in &self.borders[pile] {
            let height = (frame.place(way, self.place[*panel]) + frame.height() - start) % frame.height();
            self.settled[*panel] = (height, frame.facing(way, start, height).turned(turn));
        }
        self.openings[pile] = Some(opening);
    }

    /// Gives a pile another ring and returns the one it had.
    fn exchange(&mut self, pile: usize, ring: Strip) -> Strip {
        for (at, panel) in ring.order.iter().enumerate() {
            self.place[*panel] = at;
        }
        std::mem::replace(&mut self.frames[pile], Frame::of(ring, self.dual)).ring
    }

    /// The best opening of a pile beside those that are open.
    fn best(&self, pile: usize, group_of: &[usize], random: &mut Random) -> Option<(Score, Opening)> {
        self.ways(pile, group_of, random).into_iter().max()
    }

    /// All openings of a pile that match open piles.
    fn ways(&self, pile: usize, group_of: &[usize], random: &mut Random) -> Vec<(Score, Opening)> {
        let mut votes = self.votes(pile);
        votes.sort_unstable();
        let mut levels: Vec<(usize, usize)> =
            if self.wanted == Bridges::Most { self.levels(pile) } else { Vec::new() };
        levels.sort_unstable();
        let level_with = |Opening { way, start, .. }: Opening| {
            let from = levels.partition_point(|level| *level < (way, start));
            levels[from..].partition_point(|level| *level == (way, start))
        };
        let mut ways = Vec::new();
        for votes in votes.chunk_by(|a, b| a.opening == b.opening) {
            let mut joined: Vec<usize> = votes.iter().map(|vote| group_of[vote.other_pile]).collect();
            joined.sort_unstable();
            joined.dedup();
            let central = votes.iter().map(|vote| vote.central).max().unwrap_or(0);
            let all = level_with(votes[0].opening);
            let score = match self.wanted {
                // Bridges half way up keep the tree path shallow.
                Bridges::Least | Bridges::Base => (joined.len(), central, votes.len(), random.next()),
                // Neighbours that are equally high without facing each other can be made to by a break.
                Bridges::Most => (joined.len(), 2 * votes.len() + all, central, random.next()),
            };
            ways.push((score, votes[0].opening));
        }
        ways
    }

    /// All matches with open piles that openings of a pile would give.
    fn votes(&self, pile: usize) -> Vec<Vote> {
        let frame = &self.frames[pile];
        let height = frame.height();
        let mut votes = Vec::new();
        for cut in &self.borders[pile] {
            if self.openings[cut.other_pile].is_none() {
                continue;
            }
            let (level, facing) = self.settled[cut.other];
            if facing.side(cut.other_edge) != cut.towards.opposite() {
                continue;
            }
            for way in [0, 1] {
                let start = (frame.place(way, self.place[cut.panel]) + height - level) % height;
                if frame.opens(start) {
                    let side = frame.facing(way, start, level).side(cut.edge);
                    let turn = (cut.towards as usize + 4 - side as usize) % 4;
                    let opening = Opening { way, start, turn };
                    let central = height - level.abs_diff(height - 1 - level);
                    votes.push(Vote { opening, other_pile: cut.other_pile, central });
                }
            }
        }
        votes
    }

    /// The ways and starts that bring a neighbour on an open pile to the same height, whatever sides they show each other.
    fn levels(&self, pile: usize) -> Vec<(usize, usize)> {
        let frame = &self.frames[pile];
        let height = frame.height();
        let open = self.borders[pile].iter().filter(|cut| self.openings[cut.other_pile].is_some());
        let both = open.flat_map(|cut| [0, 1].map(|way| (way, cut)));
        let starts = both.map(|(way, cut)| {
            (way, (frame.place(way, self.place[cut.panel]) + height - self.settled[cut.other].0) % height)
        });
        starts.filter(|(_, start)| frame.opens(*start)).collect()
    }

    /// The groups that are left when a pile is taken away; it is one of its own then.
    fn groups_without(&self, gone: Option<usize>) -> Groups {
        let pairs = self.borders.iter().enumerate().flat_map(|(pile, border)| {
            border.iter().filter(move |cut| cut.other_pile > pile).map(move |cut| (pile, cut))
        });
        let matches = |pile: usize, cut: &BorderEdge| {
            gone != Some(pile) && gone != Some(cut.other_pile) && self.is_match(cut)
        };
        Groups::new(self.frames.len(), pairs.map(|(pile, cut)| ((pile, cut.other_pile), matches(pile, cut))))
    }

    /// How many matches there are.
    pub(crate) fn matches(&self) -> usize {
        let borders = self.borders.iter().enumerate();
        let all = borders.flat_map(|(pile, border)| border.iter().filter(move |cut| cut.other_pile > pile));
        all.filter(|cut| self.is_match(cut)).count()
    }

    fn is_match(&self, cut: &BorderEdge) -> bool {
        let ((height, facing), (level, other)) = (self.settled[cut.panel], self.settled[cut.other]);
        height == level
            && facing.side(cut.edge) == cut.towards
            && other.side(cut.other_edge) == cut.towards.opposite()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rings round the left and the right half of a sheet four wide and four deep.
    fn halves() -> [Strip; 2] {
        [0, 2].map(|left| {
            let there = (0..4).map(|y| 4 * y + left);
            let back = (0..4).rev().map(|y| 4 * y + left + 1);
            Strip { order: there.chain(back).collect(), closed: true }
        })
    }

    #[test]
    fn rings_along_a_straight_border_are_opened_so_that_all_of_it_matches() {
        let dual = Dual::of_sheet(4, 4);
        for seed in 0..20 {
            let mut random = Random::new(seed, 1);
            let mut opener = Opener::new(&dual, &halves(), &[[0, 0], [1, 0]], Bridges::Most);
            opener.open_all(0, &mut random);
            opener.better(&mut random);
            assert_eq!((opener.matches(), opener.groups().count()), (4, 1), "{seed}");
        }
    }

    #[test]
    fn matches_are_neighbours_of_one_height_that_face_each_other_in_the_piles_that_come_out() {
        let dual = Dual::of_sheet(4, 4);
        let mut seen = std::collections::BTreeSet::new();
        let starts = (0..8).flat_map(|start| [0, 1].map(|way| (way, start)));
        let turns = (0..4).flat_map(|first| (0..4).map(move |turn| (first, turn)));
        for ((way, start), (first, turn)) in
            starts.flat_map(|opened| turns.clone().map(move |turns| (opened, turns)))
        {
            let mut opener = Opener::new(&dual, &halves(), &[[0, 0], [1, 0]], Bridges::Most);
            opener.settle(0, Opening { turn: first, ..Opening::default() });
            opener.settle(1, Opening { way, start, turn });
            let counted = opener.matches();
            let Matched { piles, facing, turns, .. } = opener.matched();
            let side = |pile: usize, panel: usize, other: usize| {
                let [edge, _] = dual.common_edges(panel, other).unwrap();
                facing[panel].turned(turns[pile]).side(edge)
            };
            let found = piles[0].iter().zip(&piles[1]).filter(|(a, b)| {
                dual.common_edges(**a, **b).is_some()
                    && side(0, **a, **b).step() == [1, 0]
                    && side(1, **b, **a).step() == [-1, 0]
            });
            assert_eq!(counted, found.count(), "way {way}, start {start}, turns {first} and {turn}");
            seen.insert(counted);
        }
        assert!(seen.len() > 1, "openings differ: {seen:?}");
    }
}
