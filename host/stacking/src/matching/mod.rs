//! Opens the rings of placed parts so that neighbours come to equal heights with their common edge on the sides that face
//! each other: there a bridge is possible. A cycle can be opened anywhere, so a bridge is arranged and not waited for.
//!
//! ```text
//! opening:  what a ring can become
//! matching: pile after pile, the opening that matches most; then every pile once more
//! bridges:  a spanning tree of them, or as many as can be, a fold broken for each one too many
//! ```

mod bridges;
mod opening;
mod turning;

pub(crate) use bridges::{Bridged, bridge};

use crate::dual::Dual;
use crate::folding_map::Facing;
use crate::partition::Ring;
use crate::plan::Side;
use crate::planner::Bridges;
use opening::{Frame, Opening};

/// Times that every pile is opened anew.
const SWEEPS: usize = 3;

/// A cut edge between neighbouring cells, seen from one of its piles.
#[derive(Debug, Clone, Copy)]
struct CutEdge {
    panel: usize,
    edge: usize,
    other: usize,
    other_edge: usize,
    other_pile: usize,
    /// The side of the own cell beyond which the other pile stands.
    towards: Side,
}

/// The piles, each opened.
#[derive(Debug, Clone)]
pub(crate) struct Matched {
    /// Panels of every pile from the bottom up.
    pub(crate) piles: Vec<Vec<usize>>,
    /// Of every panel how it lies before its pile is turned.
    pub(crate) facing: Vec<Facing>,
    /// Of every pile its quarter turns.
    pub(crate) turns: Vec<usize>,
    /// The cells, as they were given.
    pub(crate) cells: Vec<[i32; 2]>,
}

/// Opens all rings; or names the pile that found no opening, and one beside it.
pub(crate) fn open(
    dual: &Dual,
    rings: &[Ring],
    cells: &[[i32; 2]],
    first: usize,
    wanted: Bridges,
) -> Result<Matched, [usize; 2]> {
    let mut opener = Opener::new(dual, rings, cells, wanted);
    opener.settle(first, Opening { way: 0, start: 0, turn: 0 });
    for _ in 1..rings.len() {
        let mut best: Option<(Score, usize, Opening)> = None;
        for pile in 0..rings.len() {
            if opener.openings[pile].is_some() {
                continue;
            }
            if let Some((score, opening)) = opener.best(pile)
                && best.is_none_or(|(most, _, _)| score > most)
            {
                best = Some((score, pile, opening));
            }
        }
        let Some((_, pile, opening)) = best else { return Err(opener.stuck()) };
        opener.settle(pile, opening);
    }
    for _ in 0..SWEEPS {
        if !opener.sweep() {
            break;
        }
    }
    Ok(opener.matched())
}

/// How good an opening is: more is better.
type Score = (usize, usize);

struct Opener<'a> {
    frames: Vec<Frame>,
    borders: Vec<Vec<CutEdge>>,
    cells: &'a [[i32; 2]],
    wanted: Bridges,
    /// Of every panel its place in its ring.
    place: Vec<usize>,
    openings: Vec<Option<Opening>>,
    /// Of every panel of an opened pile its height, and how it lies.
    settled: Vec<(usize, Facing)>,
    /// The histogram over (way, start, turn): matches and how central the best is. Empty between uses.
    tally: Vec<Score>,
}

impl<'a> Opener<'a> {
    fn new(dual: &Dual, rings: &[Ring], cells: &'a [[i32; 2]], wanted: Bridges) -> Self {
        let panels = rings.iter().map(|ring| ring.order.len()).sum();
        let mut pile_of = vec![0; panels];
        let mut place = vec![0; panels];
        for (pile, ring) in rings.iter().enumerate() {
            for (at, panel) in ring.order.iter().enumerate() {
                pile_of[*panel] = pile;
                place[*panel] = at;
            }
        }
        let border = |pile: usize| {
            let edges = rings[pile].order.iter().flat_map(|panel| (0..4).map(move |edge| (*panel, edge)));
            let cut_edge = |(panel, edge): (usize, usize)| {
                let across = dual.across(panel, edge)?;
                let other_pile = pile_of[across.panel];
                let [x, y] = cells[pile];
                let beyond = |side: &Side| {
                    let [dx, dy] = side.step();
                    cells[other_pile] == [x + dx, y + dy]
                };
                let towards = Side::ALL.into_iter().find(beyond)?;
                Some(CutEdge {
                    panel,
                    edge,
                    other: across.panel,
                    other_edge: across.edge,
                    other_pile,
                    towards,
                })
            };
            edges.filter_map(cut_edge).collect()
        };
        Self {
            borders: (0..rings.len()).map(border).collect(),
            frames: rings.iter().map(|ring| Frame::of(ring.clone(), dual)).collect(),
            cells,
            wanted,
            place,
            openings: vec![None; rings.len()],
            settled: vec![(0, Facing::BOTTOM); panels],
            tally: vec![(0, 0); 8 * panels / rings.len()],
        }
    }

    fn settle(&mut self, pile: usize, opening: Opening) {
        let frame = &self.frames[pile];
        for (height, panel) in frame.pile(opening).into_iter().enumerate() {
            let facing = frame.facing(opening.way, opening.start, height).turned(opening.turn);
            self.settled[panel] = (height, facing);
        }
        self.openings[pile] = Some(opening);
    }

    /// The best opening of a pile beside those that are open: one histogram over all of them.
    fn best(&mut self, pile: usize) -> Option<(Score, Opening)> {
        let frame = &self.frames[pile];
        let height = frame.height();
        let mut seen = Vec::new();
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
                if !frame.opens(start) {
                    continue;
                }
                let side = frame.facing(way, start, level).side(cut.edge);
                let turn = (cut.towards as usize + 4 - side as usize) % 4;
                let key = (way * height + start) * 4 + turn;
                let (matches, central) = &mut self.tally[key];
                if *matches == 0 {
                    seen.push(key);
                }
                *matches += 1;
                *central = (*central).max(height - level.abs_diff(height - 1 - level));
            }
        }
        let mut best: Option<(Score, Opening)> = None;
        for key in seen {
            let (matches, central) = std::mem::take(&mut self.tally[key]);
            let score = match self.wanted {
                // Bridges half way up keep the tree path shallow.
                Bridges::Least => (central, matches),
                Bridges::Most => (matches, central),
            };
            let start = key / 4;
            let opening = Opening { way: start / height, start: start % height, turn: key % 4 };
            if best.is_none_or(|(most, chosen)| (score, opening) > (most, chosen)) {
                best = Some((score, opening));
            }
        }
        best
    }

    /// Opens every pile once more beside all others, where that makes more matches. Says whether any did.
    fn sweep(&mut self) -> bool {
        let mut bettered = false;
        for pile in 0..self.frames.len() {
            let Some(now) = self.openings[pile] else { continue };
            let before = self.matches();
            let Some((_, opening)) = self.best(pile) else { continue };
            if opening == now {
                continue;
            }
            self.settle(pile, opening);
            let after = self.matches();
            if after.0 && after.1 > before.1 && self.wanted == Bridges::Most {
                bettered = true;
            } else {
                self.settle(pile, now);
            }
        }
        bettered
    }

    /// Whether the matches join all piles, and how many there are.
    fn matches(&self) -> (bool, usize) {
        let mut group: Vec<usize> = (0..self.frames.len()).collect();
        let (mut groups, mut count) = (group.len(), 0);
        for (pile, border) in self.borders.iter().enumerate() {
            for cut in border.iter().filter(|cut| cut.other_pile > pile && self.is_match(cut)) {
                count += 1;
                let (a, b) = (bridges::root(&mut group, pile), bridges::root(&mut group, cut.other_pile));
                if a != b {
                    group[a] = b;
                    groups -= 1;
                }
            }
        }
        (groups == 1, count)
    }

    fn is_match(&self, cut: &CutEdge) -> bool {
        let ((height, facing), (level, other)) = (self.settled[cut.panel], self.settled[cut.other]);
        height == level
            && facing.side(cut.edge) == cut.towards
            && other.side(cut.other_edge) == cut.towards.opposite()
    }

    /// A pile that is not open though one beside it is, and that one.
    fn stuck(&self) -> [usize; 2] {
        let closed = (0..self.frames.len()).filter(|pile| self.openings[*pile].is_none());
        let mut pairs =
            closed.flat_map(|pile| self.borders[pile].iter().map(move |cut| [pile, cut.other_pile]));
        pairs.find(|[_, beside]| self.openings[*beside].is_some()).unwrap_or([0, 0])
    }

    fn matched(self) -> Matched {
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
}
