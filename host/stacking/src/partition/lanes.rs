//! Lanes along the borders of parts. Where two parts run side by side for a while, both cycles should run along the border:
//! then all panels of that run come to equal heights at once, and each pair of them can be a bridge.

use super::Neighbours;

/// Which part every panel is in.
pub(crate) struct Borders {
    part_of: Vec<usize>,
}

impl Borders {
    pub(crate) fn of(parts: &[Vec<usize>]) -> Self {
        let mut part_of = vec![usize::MAX; parts.iter().map(Vec::len).sum()];
        for (number, part) in parts.iter().enumerate() {
            for panel in part {
                part_of[*panel] = number;
            }
        }
        Self { part_of }
    }

    /// The edges of a part along its border with the parts that are wanted: each is a side of a square of panels, whose
    /// opposite side is an edge of the other part.
    pub(crate) fn lanes(
        &self,
        neighbours: &Neighbours,
        part: &[usize],
        wanted: impl Fn(usize) -> bool,
    ) -> Vec<(usize, usize)> {
        let mut lanes = Vec::new();
        for &u in part {
            let own = self.part_of[u];
            for &v in &neighbours[u] {
                let other = self.part_of[v];
                if other == own || !wanted(other) {
                    continue;
                }
                for &next in neighbours[u].iter().filter(|next| u < **next && self.part_of[**next] == own) {
                    let beside = |beyond: &&usize| {
                        self.part_of[**beyond] == other && neighbours[next].contains(beyond)
                    };
                    if neighbours[v].iter().any(|beyond| beside(&beyond)) {
                        lanes.push((u, next));
                    }
                }
            }
        }
        lanes
    }
}
