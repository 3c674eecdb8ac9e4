//! Small changes of a strip that leave it a strip: all panels, each the neighbour of the next.
//!
//! ```text
//! turn an end     a b c d e, e next to b:                 a b e d c
//! turn a piece    a b c d e f, a next to d, b next to e:  a d c b e f
//! move a panel    a b c ... d e, a next to c, b to both:  a c ... d b e
//! move two        a b c d ... e f, a next to d:           a d ... e b c f   around a flat vertex nothing else moves in the net
//! ```

use super::neighbours::Neighbours;
use crate::random::Random;

/// A strip that is being changed.
pub(super) struct Changing {
    order: Vec<usize>,
    /// Of every panel its place in the order.
    place: Vec<usize>,
    /// The order as it would be.
    proposed: Vec<usize>,
}

impl Changing {
    pub(super) fn new(order: Vec<usize>) -> Self {
        let mut changing = Self { place: vec![0; order.len()], proposed: order.clone(), order };
        changing.accept();
        changing
    }

    /// The strip.
    pub(super) fn order(&self) -> &[usize] {
        &self.order
    }

    /// The strip as it was proposed last.
    pub(super) fn proposed(&self) -> &[usize] {
        &self.proposed
    }

    /// Takes the proposed order.
    pub(super) fn accept(&mut self) {
        self.order.clone_from(&self.proposed);
        for (place, panel) in self.order.iter().enumerate() {
            self.place[*panel] = place;
        }
    }

    /// Proposes a change at random; false where there is none.
    pub(super) fn propose(&mut self, neighbours: &Neighbours, random: &mut Random) -> bool {
        match random.below(8) {
            0 => self.turn_end(neighbours, random),
            1 | 2 => self.turn_piece(neighbours, random),
            3 => self.move_piece(1, neighbours, random),
            _ => self.move_piece(2, neighbours, random),
        }
    }

    fn start(&mut self) {
        self.proposed.clone_from(&self.order);
    }

    fn turn_end(&mut self, neighbours: &Neighbours, random: &mut Random) -> bool {
        let last = self.order.len() - 1;
        let first_end = random.below(2) == 0;
        let end = self.order[if first_end { 0 } else { last }];
        let Some(near) = any(neighbours.of(end), random) else { return false };
        let at = self.place[near];
        self.start();
        if first_end {
            self.proposed[..at].reverse();
        } else {
            self.proposed[at + 1..].reverse();
        }
        true
    }

    fn turn_piece(&mut self, neighbours: &Neighbours, random: &mut Random) -> bool {
        let at = random.below(self.order.len() - 1);
        let (a, b) = (self.order[at], self.order[at + 1]);
        let ends = neighbours.of(a).filter(|d| {
            let to = self.place[*d];
            to > at + 1 && self.order.get(to + 1).is_none_or(|e| neighbours.joins(b, *e))
        });
        let Some(d) = any(ends, random) else { return false };
        let to = self.place[d];
        self.start();
        self.proposed[at + 1..=to].reverse();
        true
    }

    /// Takes a piece of one or two panels out and puts it between two others.
    fn move_piece(&mut self, length: usize, neighbours: &Neighbours, random: &mut Random) -> bool {
        let panels = self.order.len();
        if panels < length + 2 {
            return false;
        }
        let at = random.below(panels - length + 1);
        let piece = at..at + length;
        // What the piece leaves behind has to hang together; at an end there is nothing to join.
        if at > 0 && piece.end < panels && !neighbours.joins(self.order[at - 1], self.order[piece.end]) {
            return false;
        }
        let (b, c) = (self.order[at], self.order[piece.end - 1]);
        let place = &self.place;
        let outside = |panel: &usize| !piece.contains(&place[*panel]);
        let gaps = neighbours.of(b).filter(outside).flat_map(|e| {
            let others = neighbours.of(c).filter(outside);
            others.filter(move |f| place[e].abs_diff(place[*f]) == 1).map(move |f| (e, f))
        });
        let Some((e, f)) = any(gaps, random) else { return false };
        let (e, f) = (self.place[e], self.place[f]);
        let upper = e.max(f);
        self.start();
        if upper >= piece.end {
            self.proposed[at..upper].rotate_left(length);
            if f < e {
                self.proposed[upper - length..upper].reverse();
            }
        } else {
            self.proposed[upper..piece.end].rotate_right(length);
            if f < e {
                self.proposed[upper..upper + length].reverse();
            }
        }
        true
    }
}

/// One of several, each as likely.
fn any<T: Copy>(list: impl Iterator<Item = T>, random: &mut Random) -> Option<T> {
    let mut chosen = None;
    for (number, item) in list.enumerate() {
        if random.below(number + 1) == 0 {
            chosen = Some(item);
        }
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hamiltonian;
    use crate::readers::Model;
    use std::path::PathBuf;

    #[test]
    fn every_change_leaves_a_strip() {
        for name in ["fish92.txt", "torus32.txt", "sheet12.obj", "i14.txt", "diagonal24.txt"] {
            let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name);
            let model = Model::read(&path, None).unwrap();
            let all: Vec<usize> = (0..model.surface.len()).collect();
            let neighbours = Neighbours::among(&all, &model.dual);
            let mut changing = Changing::new(hamiltonian::find(&model.dual.neighbours(), 1).unwrap().order);
            let mut random = Random::new(5, 5);
            let mut accepted = 0;
            for _ in 0..20_000 {
                if changing.propose(&neighbours, &mut random) {
                    let mut sorted = changing.proposed.clone();
                    sorted.sort_unstable();
                    assert_eq!(sorted, all, "{name}");
                    let pairs = changing.proposed.windows(2);
                    assert!(pairs.clone().all(|pair| neighbours.joins(pair[0], pair[1])), "{name}");
                    changing.accept();
                    accepted += 1;
                }
            }
            assert!(accepted > 1000, "{name}: {accepted}");
        }
    }
}
