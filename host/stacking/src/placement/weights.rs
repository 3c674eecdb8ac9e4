//! Cut edges between parts, counted.

/// Of every two parts the number of cut edges between them.
#[derive(Debug, Clone)]
pub(crate) struct Weights {
    pub(super) count: usize,
    weights: Vec<usize>,
}

impl Weights {
    /// No edges between so many parts.
    pub(crate) fn new(count: usize) -> Self {
        Self { count, weights: vec![0; count * count] }
    }

    /// Adds a cut edge.
    pub(crate) fn add(&mut self, a: usize, b: usize) {
        self.weights[a * self.count + b] += 1;
        self.weights[b * self.count + a] += 1;
    }

    /// The cut edges between two parts.
    pub(crate) fn of(&self, a: usize, b: usize) -> usize {
        self.weights[a * self.count + b]
    }

    /// All cut edges.
    pub(crate) fn total(&self) -> usize {
        self.weights.iter().sum::<usize>() / 2
    }
}
