//! Short rows of nodes that cycles are made of: each may be read either way, be cut in two, or be joined with the next.

/// A row of nodes.
#[derive(Default)]
pub(super) struct Segment {
    nodes: Vec<u32>,
    /// Whether the cycle runs through it from its last node to its first.
    backwards: bool,
    /// The cycle that it is in.
    pub(super) cycle: usize,
    /// Its place in the row of segments of the cycle.
    pub(super) rank: usize,
}

impl Segment {
    /// Nodes in a segment at most. With a million nodes a cycle has about as many segments.
    pub(super) const LONGEST: usize = 1000;
}

/// All segments, and where every node is.
pub(super) struct Segments {
    all: Vec<Segment>,
    unused: Vec<usize>,
    /// Of every node its segment and its place there.
    places: Vec<(u32, u32)>,
}

/// Of a node in no segment.
const NOWHERE: (u32, u32) = (u32::MAX, 0);

#[expect(clippy::cast_possible_truncation, reason = "surfaces of 2^32 panels don't fit in memory")]
fn short(number: usize) -> u32 {
    number as u32
}

impl Segments {
    /// No segments yet, and so many nodes.
    pub(super) fn new(nodes: usize) -> Self {
        Self { all: Vec::new(), unused: Vec::new(), places: vec![NOWHERE; nodes] }
    }

    /// Whether a node is in a segment.
    pub(super) fn holds(&self, node: usize) -> bool {
        self.places[node] != NOWHERE
    }

    /// The segment of a node.
    pub(super) fn of(&self, node: usize) -> &Segment {
        &self.all[self.places[node].0 as usize]
    }

    /// The cycle of a node and its position there: a number that grows along the cycle.
    pub(super) fn position(&self, node: usize) -> (usize, u64) {
        let (segment, index) = self.places[node];
        let segment = &self.all[segment as usize];
        let along = if segment.backwards { short(segment.nodes.len()) - 1 - index } else { index };
        (segment.cycle, (segment.rank as u64) << 32 | u64::from(along))
    }

    /// The first node, in the direction of the cycle.
    pub(super) fn first(&self, segment: usize) -> usize {
        let Segment { nodes, backwards, .. } = &self.all[segment];
        nodes[if *backwards { nodes.len() - 1 } else { 0 }] as usize
    }

    /// The last node, in the direction of the cycle.
    pub(super) fn last(&self, segment: usize) -> usize {
        let Segment { nodes, backwards, .. } = &self.all[segment];
        nodes[if *backwards { 0 } else { nodes.len() - 1 }] as usize
    }

    /// Turns a segment round.
    pub(super) fn turn(&mut self, segment: usize) {
        let backwards = &mut self.all[segment].backwards;
        *backwards = !*backwards;
    }

    /// Puts a segment into a cycle and tells how long it is.
    pub(super) fn place(&mut self, segment: usize, cycle: usize, rank: usize) -> usize {
        let segment = &mut self.all[segment];
        (segment.cycle, segment.rank) = (cycle, rank);
        segment.nodes.len()
    }

    /// Makes segments of a row of nodes.
    pub(super) fn cut_up(&mut self, row: impl Iterator<Item = usize>) -> Vec<usize> {
        let nodes: Vec<u32> = row.map(short).collect();
        // Half full, so that there is room to join.
        nodes.chunks(Segment::LONGEST / 2).map(|chunk| self.add(chunk.to_vec(), false)).collect()
    }

    fn add(&mut self, nodes: Vec<u32>, backwards: bool) -> usize {
        let number = self.unused.pop().unwrap_or(self.all.len());
        for (index, node) in nodes.iter().enumerate() {
            self.places[*node as usize] = (short(number), short(index));
        }
        let segment = Segment { nodes, backwards, ..Segment::default() };
        if number == self.all.len() {
            self.all.push(segment);
        } else {
            self.all[number] = segment;
        }
        number
    }

    /// Cuts a segment after a node, in the direction of the cycle, and gives the part beyond, if any. The part with the
    /// node stays what it was.
    pub(super) fn split_after(&mut self, node: usize) -> Option<usize> {
        let (number, index) = (self.places[node].0 as usize, self.places[node].1 as usize);
        let segment = &mut self.all[number];
        let backwards = segment.backwards;
        let beyond = if backwards {
            let kept = segment.nodes.split_off(index);
            std::mem::replace(&mut segment.nodes, kept)
        } else {
            segment.nodes.split_off(index + 1)
        };
        if backwards {
            for (index, node) in segment.nodes.iter().enumerate() {
                self.places[*node as usize].1 = short(index);
            }
        }
        (!beyond.is_empty()).then(|| self.add(beyond, backwards))
    }

    /// Joins segments that follow each other and are short together.
    pub(super) fn merge_small(&mut self, row: Vec<usize>) -> Vec<usize> {
        let mut merged: Vec<usize> = Vec::with_capacity(row.len());
        for next in row {
            let length = |number: usize| self.all[number].nodes.len();
            match merged.last() {
                Some(&before) if length(before) + length(next) <= Segment::LONGEST => {
                    self.append(before, next);
                }
                _ => merged.push(next),
            }
        }
        merged
    }

    /// Appends the nodes of a segment, in the direction of the cycle, to the one before it.
    fn append(&mut self, before: usize, next: usize) {
        let Segment { mut nodes, backwards, .. } = std::mem::take(&mut self.all[next]);
        self.unused.push(next);
        if backwards {
            nodes.reverse();
        }
        let segment = &mut self.all[before];
        let mut from = segment.nodes.len();
        if segment.backwards {
            segment.nodes.reverse();
            segment.backwards = false;
            from = 0;
        }
        segment.nodes.extend(nodes);
        for (index, node) in segment.nodes.iter().enumerate().skip(from) {
            self.places[*node as usize] = (short(before), short(index));
        }
    }
}
