//! Which panels are neighbours: the dual graph of a surface, with the pairing rule where two sheets touch along an edge.
//! The Hamiltonian search and the arcs walk on it.

use crate::adjacency::Adjacency;
use crate::square::{self, At, Point};
use crate::surface::{Surface, SurfaceError};

/// How many pieces of a surface in pieces a message lists.
const PIECES_SHOWN: usize = 5;

/// A neighbour: the panel, and the edge of that panel which is the common one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Across {
    pub(crate) panel: usize,
    pub(crate) edge: usize,
}

/// For every panel and edge the neighbour across, where a hinge can be.
#[derive(Debug, Clone)]
pub(crate) struct Dual {
    across: Vec<[Option<Across>; 4]>,
}

/// One side of one panel, at its lattice edge.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Flank {
    /// Sorts and compares faster than the ends themselves.
    place: u128,
    panel: usize,
    edge: usize,
}

impl Dual {
    /// Finds the neighbours on a surface.
    ///
    /// # Errors
    /// Sheets that cross, neighbours of unlike orientation, a surface in pieces.
    pub(crate) fn of(surface: &Surface) -> Result<Self, SurfaceError> {
        let quads = surface.quads();
        let mut flanks: Vec<Flank> = Vec::with_capacity(4 * quads.len());
        for (panel, quad) in quads.iter().enumerate() {
            for edge in 0..4 {
                let (p, q) = (quad[edge], quad[(edge + 1) % 4]);
                flanks.push(Flank { place: square::edge_name(p, q), panel, edge });
            }
        }
        flanks.sort_unstable();
        let mut dual = Self { across: vec![[None; 4]; quads.len()] };
        for meeting in flanks.chunk_by(|a, b| a.place == b.place) {
            match meeting {
                [_] => {}
                [a, b] => dual.join_two(surface, a, b)?,
                [_, _, _, _] => dual.join_four(surface, meeting)?,
                _ => return Err(crossing(surface, meeting)),
            }
        }
        dual.require_one_piece(surface)?;
        Ok(dual)
    }

    /// The neighbour across an edge of a panel.
    pub(crate) fn across(&self, panel: usize, edge: usize) -> Option<Across> {
        self.across[panel][edge]
    }

    /// The edges of two neighbours that are their common one. Two unit squares share one edge at most, unless they lie
    /// back to back, and those are no neighbours.
    pub(crate) fn common_edges(&self, a: usize, b: usize) -> Option<[usize; 2]> {
        (0..4).find_map(|edge| {
            self.across[a][edge].filter(|across| across.panel == b).map(|across| [edge, across.edge])
        })
    }

    /// The neighbours of every panel, without the edges.
    pub(crate) fn neighbours(&self) -> Adjacency {
        self.across.iter().map(|edges| edges.iter().flatten().map(|across| across.panel)).collect()
    }

    fn join_two(&mut self, surface: &Surface, a: &Flank, b: &Flank) -> Result<(), SurfaceError> {
        let quads = surface.quads();
        if quads[a.panel][a.edge] == quads[b.panel][b.edge] {
            return Err(SurfaceError::Unlike {
                first: surface.name(a.panel),
                second: surface.name(b.panel),
                edge: edge_name(surface, a),
            });
        }
        // Two squares back to back meet here too, but no hinge opens by 0 or 360 degrees.
        if square::into(&quads[a.panel], a.edge) != square::into(&quads[b.panel], b.edge) {
            self.across[a.panel][a.edge] = Some(Across { panel: b.panel, edge: b.edge });
            self.across[b.panel][b.edge] = Some(Across { panel: a.panel, edge: a.edge });
        }
        Ok(())
    }

    /// Four panels at one edge: each turns about the edge towards its inner side, and the first panel met is its partner.
    fn join_four(&mut self, surface: &Surface, meeting: &[Flank]) -> Result<(), SurfaceError> {
        let quads = surface.quads();
        let mut partners = [None; 4];
        for (partner, here) in partners.iter_mut().zip(meeting) {
            let quad = &quads[here.panel];
            let (into, outward) = (square::into(quad, here.edge), square::normal(quad));
            let turn = [square::opposite(outward), square::opposite(into), outward];
            let stands = |there: &&Flank, way: Point| square::into(&quads[there.panel], there.edge) == way;
            let first = turn.into_iter().find(|&way| meeting.iter().any(|there| stands(&there, way)));
            *partner = first.and_then(|way| {
                let like = |there: &Flank| quads[there.panel][there.edge] != quad[here.edge];
                meeting.iter().position(|there| stands(&there, way) && like(there))
            });
        }
        for (number, partner) in partners.iter().enumerate() {
            match partner {
                Some(other) if partners[*other] == Some(number) => {
                    let (here, there) = (&meeting[number], &meeting[*other]);
                    self.across[here.panel][here.edge] =
                        Some(Across { panel: there.panel, edge: there.edge });
                }
                _ => return Err(crossing(surface, meeting)),
            }
        }
        Ok(())
    }

    fn require_one_piece(&self, surface: &Surface) -> Result<(), SurfaceError> {
        let mut seen = vec![false; self.across.len()];
        let mut pieces: Vec<(usize, usize)> = Vec::new();
        for start in 0..self.across.len() {
            if seen[start] {
                continue;
            }
            seen[start] = true;
            let (mut size, mut reached) = (0, vec![start]);
            while let Some(panel) = reached.pop() {
                size += 1;
                for across in self.across[panel].iter().flatten() {
                    if !seen[across.panel] {
                        seen[across.panel] = true;
                        reached.push(across.panel);
                    }
                }
            }
            pieces.push((size, start));
        }
        if pieces.len() == 1 {
            return Ok(());
        }
        let shown = pieces.iter().take(PIECES_SHOWN);
        let mut list: Vec<String> =
            shown.map(|(size, panel)| format!("{size} panels with {}", surface.name(*panel))).collect();
        if pieces.len() > PIECES_SHOWN {
            list.push("...".into());
        }
        Err(SurfaceError::Pieces { count: pieces.len(), pieces: list.join("; ") })
    }
}

fn edge_name(surface: &Surface, flank: &Flank) -> String {
    let quad = &surface.quads()[flank.panel];
    let (p, q) = (quad[flank.edge], quad[(flank.edge + 1) % 4]);
    format!("{} {}", At(p.min(q)), At(p.max(q)))
}

fn crossing(surface: &Surface, meeting: &[Flank]) -> SurfaceError {
    let faces: Vec<String> = meeting.iter().map(|flank| surface.name(flank.panel)).collect();
    SurfaceError::Crossing { edge: edge_name(surface, &meeting[0]), faces: faces.join(", ") }
}

#[cfg(test)]
impl Dual {
    /// A flat sheet for tests: panel `y * width + x` is the square at (x, y).
    pub(crate) fn of_sheet(width: i32, depth: i32) -> Self {
        let squares = (0..depth).flat_map(|y| (0..width).map(move |x| (x, y)));
        let quads = squares.map(|(x, y)| [[x, y, 0], [x + 1, y, 0], [x + 1, y + 1, 0], [x, y + 1, 0]]);
        Self::of(&Surface::new(quads.collect(), Vec::new()).unwrap()).unwrap()
    }
}
