//! How often the panels of a strip lie on each other when it is flattened: a walk on the square lattice, counted in one pass.

use crate::plan::Side;
use crate::strip_changes::Neighbours;

/// The walk over a strip's net.
pub(super) struct Walk<'a> {
    neighbours: &'a Neighbours,
    squares: Squares,
}

impl<'a> Walk<'a> {
    /// Over so many panels.
    pub(super) fn new(panels: usize, neighbours: &'a Neighbours) -> Self {
        Self { neighbours, squares: Squares::new(panels) }
    }

    /// The pairs of panels on one square, as long as there are no more than `limit`.
    pub(super) fn pairs(&mut self, order: &[usize], limit: usize) -> Option<usize> {
        self.squares.clear();
        let ([mut x, mut y], mut turn, mut entry) = ([0, 0], 0, 0);
        let mut pairs = 0;
        for (along, panel) in order.iter().enumerate() {
            pairs += self.squares.put([x, y]);
            if pairs > limit {
                return None;
            }
            let Some(next) = order.get(along + 1) else { break };
            // Neighbours in a strip are neighbours in the graph.
            let Some([exit, other]) = self.neighbours.edges(*panel, *next) else { break };
            // Edge `entry` of this panel is on side `turn` of its square; edges and sides run the same way round.
            let side = Side::E.turned(turn + exit + 4 - entry);
            let [dx, dy] = side.step();
            (x, y) = (x + dx, y + dy);
            turn = side.opposite() as usize;
            entry = other;
        }
        Some(pairs)
    }
}

/// How many panels lie on each square: a hash table that is emptied by counting on.
struct Squares {
    entries: Vec<Entry>,
    round: u32,
}

#[derive(Clone, Copy, Default)]
struct Entry {
    square: [i32; 2],
    round: u32,
    panels: u32,
}

impl Squares {
    fn new(panels: usize) -> Self {
        Self { entries: vec![Entry::default(); (4 * panels).next_power_of_two()], round: 0 }
    }

    fn clear(&mut self) {
        self.round = self.round.wrapping_add(1);
        if self.round == 0 {
            self.entries.fill(Entry::default());
            self.round = 1;
        }
    }

    /// Adds a panel; tells how many were there before.
    fn put(&mut self, square: [i32; 2]) -> usize {
        let mask = self.entries.len() - 1;
        let [x, y] = square.map(i32::cast_unsigned);
        let mixed = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77);
        let mut at = (mixed ^ mixed >> 15) as usize & mask;
        loop {
            let entry = &mut self.entries[at];
            if entry.round != self.round {
                *entry = Entry { square, round: self.round, panels: 1 };
                return 0;
            }
            if entry.square == square {
                entry.panels += 1;
                return entry.panels as usize - 1;
            }
            at = (at + 1) & mask;
        }
    }
}
