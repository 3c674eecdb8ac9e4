//! A cover of the graph by cycles and, while it is made, by paths: every node knows its mates, two at most.

/// For every node its mates.
#[derive(Debug, Clone)]
pub(super) struct Cover {
    mates: Vec<[Option<usize>; 2]>,
}

impl Cover {
    pub(super) fn new(nodes: usize) -> Self {
        Self { mates: vec![[None; 2]; nodes] }
    }

    pub(super) fn nodes(&self) -> usize {
        self.mates.len()
    }

    /// The mates of a node, in no order that means anything.
    pub(super) fn mates(&self, node: usize) -> impl Iterator<Item = usize> {
        self.mates[node].into_iter().flatten()
    }

    /// How many mates a node lacks.
    pub(super) fn lacks(&self, node: usize) -> usize {
        2 - self.mates(node).count()
    }

    pub(super) fn has(&self, u: usize, v: usize) -> bool {
        self.mates[u].contains(&Some(v))
    }

    /// Makes two nodes mates; each must lack one.
    pub(super) fn link(&mut self, u: usize, v: usize) {
        for (node, mate) in [(u, v), (v, u)] {
            let free = usize::from(self.mates[node][0].is_some());
            self.mates[node][free] = Some(mate);
        }
    }

    /// Undoes `link`.
    pub(super) fn unlink(&mut self, u: usize, v: usize) {
        for (node, mate) in [(u, v), (v, u)] {
            for place in &mut self.mates[node] {
                if *place == Some(mate) {
                    *place = None;
                }
            }
        }
    }

    /// Applies an exchange: first all that goes, then all that comes.
    pub(super) fn exchange(&mut self, removed: &[(usize, usize)], added: &[(usize, usize)]) {
        for (u, v) in removed {
            self.unlink(*u, *v);
        }
        for (u, v) in added {
            self.link(*u, *v);
        }
    }

    /// The nodes of a cycle in order, from one of its nodes on.
    pub(super) fn walk(&self, start: usize) -> impl Iterator<Item = usize> {
        let mut previous = None;
        let mut here = Some(start);
        std::iter::from_fn(move || {
            let node = here?;
            let next = self.mates(node).find(|mate| Some(*mate) != previous);
            previous = Some(node);
            here = next.filter(|next| *next != start);
            Some(node)
        })
    }

    /// The panels in the order of a cover that is one cycle; with an apex from one of its mates to the other.
    pub(super) fn order(&self, apex: Option<usize>) -> Vec<usize> {
        let start = apex.unwrap_or(0);
        self.walk(start).filter(|node| Some(*node) != apex).collect()
    }
}
