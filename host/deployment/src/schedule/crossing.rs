//! Where a step waits for a step of another node: no MCU knows of the other, so the host has to pass on that it opened.

use super::Schedule;

/// A step that waits for a step of another node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Crossing {
    /// Index of the step that waits.
    pub step: usize,
    /// Its node.
    pub node: usize,
    /// Index of the step that it waits for.
    pub waits_for: usize,
    /// The node of that one.
    pub other_node: usize,
}

impl Schedule {
    /// Every wait for a step of another node, in the order of the steps.
    pub fn crossings(&self) -> Vec<Crossing> {
        let mut crossings = Vec::new();
        for (index, step) in self.steps.iter().enumerate() {
            for &waits_for in &step.after {
                let Some(other) = self.steps.get(waits_for).filter(|other| other.node != step.node) else {
                    continue;
                };
                crossings.push(Crossing { step: index, node: step.node, waits_for, other_node: other.node });
            }
        }
        crossings
    }

    /// Indices of the nodes that it moves hinges of, rising.
    pub fn nodes(&self) -> Vec<usize> {
        let mut nodes: Vec<_> = self.steps.iter().map(|step| step.node).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }
}
