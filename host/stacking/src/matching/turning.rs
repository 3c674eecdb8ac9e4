//! Where a pile changes its turn. A pile cut between two heights may be turned differently above and below, so bridges
//! that need different turns can stand in one pile, as long as all pieces still hang together.
//!
//! A climb: turns change over a range of heights, in one pile or in two at once, while that makes more bridges fit.

use super::bridges::Candidate;
use crate::sets::Sets;
use std::collections::BTreeMap;

/// Rounds over all piles.
const ROUNDS: usize = 4;
/// How many stops a range of change is long, unless it goes on to the top.
const LONGEST: usize = 40;
/// Candidates looked at for each pile in one round, over all changes that might leave pieces apart.
const EFFORT: usize = 400_000;

/// For every pile its quarter turns at every height. Begins with piles turned as a whole, which must hang together.
pub(super) fn choose(candidates: &[Candidate], turns: &[usize], height: usize) -> Vec<Vec<usize>> {
    let mut climb = Climb::new(candidates, turns);
    for _ in 0..ROUNDS {
        let before = climb.fitting();
        for pile in 0..turns.len() {
            climb.turn_one(pile);
        }
        climb.turn_two();
        if climb.fitting() == before {
            break;
        }
    }
    let mut turned: Vec<Vec<usize>> = turns.iter().map(|turn| vec![*turn; height]).collect();
    for (pile, heights) in turned.iter_mut().enumerate() {
        let stops = &climb.stops[pile];
        for (number, (stop, turn)) in stops.iter().zip(&climb.turns[pile]).enumerate() {
            // The cut is half way to the stop below.
            let from = if number == 0 { 0 } else { (stops[number - 1] + stop).div_ceil(2) };
            heights[from..].fill(*turn);
        }
    }
    turned
}

/// The turns so far, at the heights of candidates only.
struct Climb<'a> {
    candidates: &'a [Candidate],
    /// Of every pile the heights at which it has candidates.
    stops: Vec<Vec<usize>>,
    /// Of every pile its turn at each stop.
    turns: Vec<Vec<usize>>,
    /// Of every pile and stop the candidates there.
    at: Vec<Vec<Vec<usize>>>,
    /// Of every candidate the number of its height among the stops of each of its piles.
    number: Vec<[usize; 2]>,
}

impl<'a> Climb<'a> {
    fn new(candidates: &'a [Candidate], turns: &[usize]) -> Self {
        let mut at: Vec<BTreeMap<usize, Vec<usize>>> = vec![BTreeMap::new(); turns.len()];
        for (number, candidate) in candidates.iter().enumerate() {
            for pile in candidate.joint.piles {
                at[pile].entry(candidate.height).or_default().push(number);
            }
        }
        let stops: Vec<Vec<usize>> = at.iter().map(|of_pile| of_pile.keys().copied().collect()).collect();
        let number = |candidate: &Candidate| {
            candidate.joint.piles.map(|pile| stops[pile].partition_point(|stop| *stop < candidate.height))
        };
        Self {
            number: candidates.iter().map(number).collect(),
            turns: stops.iter().zip(turns).map(|(stops, turn)| vec![*turn; stops.len()]).collect(),
            at: at.into_iter().map(|of_pile| of_pile.into_values().collect()).collect(),
            stops,
            candidates,
        }
    }

    fn fits(&self, candidate: usize) -> bool {
        let Candidate { joint, turns, .. } = self.candidates[candidate];
        let [a, b] = self.number[candidate];
        [self.turns[joint.piles[0]][a], self.turns[joint.piles[1]][b]] == turns
    }

    fn fitting(&self) -> usize {
        (0..self.candidates.len()).filter(|candidate| self.fits(*candidate)).count()
    }

    /// How many candidates at a stop fit when the pile is turned so.
    fn fitting_at(&self, pile: usize, stop: usize, turn: usize) -> usize {
        let fits = |candidate: &&usize| {
            let Candidate { joint, turns, .. } = self.candidates[**candidate];
            let own = usize::from(joint.piles[1] == pile);
            let other = 1 - own;
            turns[own] == turn
                && turns[other] == self.turns[joint.piles[other]][self.number[**candidate][other]]
        };
        self.at[pile][stop].iter().filter(fits).count()
    }

    /// Changes the turn of one pile over ranges, wherever more candidates fit.
    fn turn_one(&mut self, pile: usize) {
        let count = self.stops[pile].len();
        let mut effort = 0;
        for (first, turn) in (0..count).flat_map(|first| (0..4).map(move |turn| (first, turn))) {
            // Along the range: the end where the gain is greatest, if it gains at all.
            let mut gain = 0isize;
            let mut ends = Vec::new();
            for last in first..count {
                let now = self.fitting_at(pile, last, self.turns[pile][last]);
                gain += self.fitting_at(pile, last, turn).cast_signed() - now.cast_signed();
                if gain > 0 && (last < first + LONGEST || last + 1 == count) {
                    ends.push((gain, last));
                }
            }
            ends.sort_by(|a, b| b.cmp(a));
            for (_, last) in ends {
                effort += self.candidates.len();
                if effort > EFFORT {
                    return;
                }
                let old = self.turns[pile].clone();
                self.turns[pile][first..=last].fill(turn);
                if self.hangs_together() {
                    break;
                }
                self.turns[pile] = old;
            }
        }
    }

    /// Changes the turns of two piles between two candidates that join them and need the same turns.
    fn turn_two(&mut self) {
        let mut effort = 0;
        for low in 0..self.candidates.len() {
            if self.fits(low) {
                continue;
            }
            let Candidate { joint, turns, .. } = self.candidates[low];
            let like = |high: &usize| {
                let other = self.candidates[*high];
                other.joint.piles == joint.piles && other.turns == turns
            };
            let highs: Vec<usize> = (low..self.candidates.len()).filter(like).take(LONGEST).collect();
            for high in highs {
                effort += self.candidates.len();
                if effort > self.stops.len() * EFFORT {
                    return;
                }
                let before = self.fitting();
                let old = joint.piles.map(|pile| self.turns[pile].clone());
                for (pile, turn, first, last) in [0, 1]
                    .map(|own| (joint.piles[own], turns[own], self.number[low][own], self.number[high][own]))
                {
                    self.turns[pile][first..=last].fill(turn);
                }
                if self.fitting() > before && self.hangs_together() {
                    break;
                }
                for (pile, old) in joint.piles.into_iter().zip(old) {
                    self.turns[pile] = old;
                }
            }
        }
    }

    /// Whether bridges and folds still join all pieces.
    fn hangs_together(&self) -> bool {
        let mut offset = vec![0; self.stops.len() + 1];
        for (pile, stops) in self.stops.iter().enumerate() {
            offset[pile + 1] = offset[pile] + stops.len();
        }
        let mut pieces = offset[self.stops.len()];
        let mut sets = Sets::new(pieces);
        let mut join = |a: usize, b: usize| pieces -= usize::from(sets.join(a, b));
        for (pile, turns) in self.turns.iter().enumerate() {
            for (number, pair) in turns.windows(2).enumerate() {
                if pair[0] == pair[1] {
                    join(offset[pile] + number, offset[pile] + number + 1);
                }
            }
        }
        for candidate in (0..self.candidates.len()).filter(|candidate| self.fits(*candidate)) {
            let [a, b] = self.candidates[candidate].joint.piles;
            let [at_a, at_b] = self.number[candidate];
            join(offset[a] + at_a, offset[b] + at_b);
        }
        pieces <= 1
    }
}
