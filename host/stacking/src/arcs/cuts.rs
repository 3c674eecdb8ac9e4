//! All ways of cutting one strip into equal arcs, without stacking any of them: which bridges each way allows. The planner
//! asks for the bridges of hundreds of ways and stacks the best one only.
//!
//! Let arcs begin at place `o` of the strip, each `h` places long, every other one upside down. Neighbours at places i and j
//! stand equally high when i = j (mod h), should both arcs run the same way, or i + j + 1 = 2 o (mod h) where they run
//! against each other. So every pair of neighbours belongs to one remainder of h, and a way of cutting to one as well.

use crate::dual::Dual;
use crate::folding_map::Facing;
use crate::joint::Joint;
use crate::plan::Side;

/// A strip and the bridges that cutting it can give.
pub(super) struct Cuts<'a> {
    order: &'a [usize],
    dual: &'a Dual,
    height: usize,
    /// Of every panel its place in the strip.
    place: Vec<usize>,
    /// Of every place how its panel lies when the whole strip is one pile; goes on past the end as far as an arc can.
    facing: Vec<Facing>,
    /// Panel and edge of pairs of neighbours, by remainder; those of one remainder in order.
    pairs: Vec<(usize, usize)>,
    /// Where the pairs of a remainder begin; one more for the end.
    begin: Vec<usize>,
    /// Pairs that arcs running the same way bring to one height.
    alike: Vec<(usize, usize)>,
}

impl<'a> Cuts<'a> {
    /// Looks at a strip that is to be cut into `count` arcs.
    pub(super) fn of(order: &'a [usize], count: usize, dual: &'a Dual) -> Self {
        let height = order.len() / count;
        let mut place = vec![0; order.len()];
        for (number, panel) in order.iter().enumerate() {
            place[*panel] = number;
        }
        let mut facing = vec![Facing::BOTTOM; order.len() + height];
        for along in 1..facing.len() {
            let (before, here) = (order[(along - 1) % order.len()], order[along % order.len()]);
            // Neighbours in a strip are neighbours in the graph, so the edges are there; not so past the end of an open one,
            // where no arc leads.
            if let Some([edge, other]) = dual.common_edges(before, here) {
                facing[along] = facing[along - 1].folded(edge, other);
            }
        }
        let mut cuts = Self {
            order,
            dual,
            height,
            place,
            facing,
            pairs: Vec::new(),
            begin: vec![0; height + 1],
            alike: Vec::new(),
        };
        if count > 1 {
            cuts.sort_pairs();
        }
        cuts
    }

    fn sort_pairs(&mut self) {
        let (dual, place, height) = (self.dual, &self.place, self.height);
        let pairs = || {
            (0..place.len()).flat_map(move |a| {
                (0..4).filter_map(move |edge| {
                    let b = dual.across(a, edge)?.panel;
                    (a < b).then(|| {
                        (a, edge, (place[a] + place[b] + 1) % height, place[a] % height == place[b] % height)
                    })
                })
            })
        };
        for (_, _, remainder, _) in pairs() {
            self.begin[remainder + 1] += 1;
        }
        for remainder in 0..height {
            self.begin[remainder + 1] += self.begin[remainder];
        }
        let mut next = self.begin.clone();
        let mut sorted = vec![(0, 0); self.begin[height]];
        let mut alike = Vec::new();
        for (a, edge, remainder, is_alike) in pairs() {
            sorted[next[remainder]] = (a, edge);
            next[remainder] += 1;
            if is_alike {
                alike.push((a, edge));
            }
        }
        self.pairs = sorted;
        self.alike = alike;
    }

    /// The pile of a panel and its height there, when the first arc begins at `offset`.
    pub(super) fn pile_and_height(&self, panel: usize, offset: usize) -> (usize, usize) {
        let along = (self.place[panel] + self.order.len() - offset) % self.order.len();
        let (pile, rest) = (along / self.height, along % self.height);
        (pile, if pile % 2 == 0 { rest } else { self.height - 1 - rest })
    }

    /// The side of its pile that an edge of a panel at some height is on, in a frame of the pile's own.
    fn side(&self, panel: usize, edge: usize, height: usize, offset: usize) -> Side {
        let place = self.place[panel];
        // Places before the first arc belong to the last one, which runs on past the end of the strip.
        let along = if place < offset { place + self.order.len() } else { place };
        let side = self.facing[along].side(edge);
        // In the strip even places look up, in the pile even heights: where they differ, the pile is its mirror image.
        if (along + height).is_multiple_of(2) { side } else { Side::E.turned(4 - side as usize) }
    }

    /// All bridges that are possible when the first arc begins at `offset`.
    pub(super) fn joints(&self, offset: usize) -> Vec<Joint> {
        let remainder = 2 * offset % self.height;
        let against = &self.pairs[self.begin[remainder]..self.begin[remainder + 1]];
        let candidates =
            against.iter().map(|pair| (pair, false)).chain(self.alike.iter().map(|pair| (pair, true)));
        let joints = candidates.filter_map(|(&(a, edge), alike)| {
            let across = self.dual.across(a, edge)?;
            let b = across.panel;
            let ((pile, height), (other_pile, other_height)) =
                (self.pile_and_height(a, offset), self.pile_and_height(b, offset));
            let runs_alike = pile % 2 == other_pile % 2;
            (pile != other_pile && height == other_height && runs_alike == alike).then(|| Joint {
                panels: [a, b],
                edges: [edge, across.edge],
                piles: [pile, other_pile],
                sides: [self.side(a, edge, height, offset), self.side(b, across.edge, height, offset)],
            })
        });
        joints.collect()
    }

    /// The quarter turns from a stacked pile's frame, with edge 0 of its bottom panel on E, to the frame of the joints.
    pub(super) fn turn_of(&self, bottom: usize, offset: usize) -> usize {
        self.side(bottom, 0, 0, offset) as usize
    }
}
