//! From a coded sequence back to a plan: the panels are numbered column by column, and the target stands so that the first
//! panel lies in the plane with its outer side up.

use super::SequenceText;
use crate::folding_map::Facing;
use crate::plan::{Hinge, HingeKind, Pile, Plan, Source};
use crate::square::{self, Quad};
use crate::tree_path;

impl SequenceText {
    /// The plan that the sequence is the code of. It may break the rules of a plan where the text makes panels overlap:
    /// `check` says so. Without a root in the text the middle of the tree path stays fixed.
    pub fn build(&self, name: &str, thickness: f64, panel_length_mm: f64) -> Plan {
        let sequence = &self.sequence;
        let height = sequence.columns.first().map_or(0, |column| column.layers.len());
        let facings: Vec<Facing> =
            (0..sequence.panels()).map(|panel| Facing::square_on(panel % height)).collect();
        let hinges: Vec<Hinge> = sequence
            .joints()
            .into_iter()
            .map(|joint| {
                let side = joint.mounted.side;
                let (other_side, over_odd) = match joint.kind {
                    HingeKind::Fold => (side, joint.height % 2 == 1),
                    HingeKind::Bridge => (side.opposite(), false),
                };
                let bend = 180 - i16::try_from(joint.mounted.opening_deg).unwrap_or(180);
                let [a, b] = joint.panels;
                Hinge {
                    kind: joint.kind,
                    panels: joint.panels,
                    edges: [facings[a].edge(side), facings[b].edge(other_side)],
                    side,
                    opening_deg: joint.mounted.opening_deg,
                    zygote_angle_deg: match (joint.kind, over_odd) {
                        (HingeKind::Bridge, _) => 0,
                        (HingeKind::Fold, false) => 180,
                        (HingeKind::Fold, true) => -180,
                    },
                    target_angle_deg: if over_odd { -bend } else { bend },
                }
            })
            .collect();
        let zygote = (0..facings.len())
            .map(|panel| facings[panel].corners(sequence.columns[panel / height].cell))
            .collect();
        let piles = sequence.columns.iter().enumerate().map(|(number, column)| Pile {
            cell: column.cell,
            panels: (number * height..(number + 1) * height).collect(),
        });
        let marked = sequence.columns.iter().flat_map(|column| &column.layers).position(|layer| layer.root);
        let joined = tree_path::joined(facings.len(), &hinges);
        let target = unfold(facings.len(), &hinges);
        Plan {
            source: Source {
                model: name.into(),
                voxel_size: None,
                distance: None,
                bounds: box_of(&target).map(|[low, high]| high - low),
                seed: 0,
                program: concat!("zygote ", env!("CARGO_PKG_VERSION")).into(),
            },
            target,
            zygote,
            piles: piles.collect(),
            root: marked.unwrap_or_else(|| tree_path::centre(&joined).0),
            hinges,
            thickness,
            panel_length_mm,
            schedule: None,
        }
    }
}

/// Where every panel is in the target: each follows from the one before it over their hinge.
fn unfold(panels: usize, hinges: &[Hinge]) -> Vec<Quad> {
    let mut at_panel = vec![Vec::new(); panels];
    for hinge in hinges {
        let ([a, b], [e, f]) = (hinge.panels, hinge.edges);
        at_panel[a].push((b, e, f, hinge.target_angle_deg));
        at_panel[b].push((a, f, e, hinge.target_angle_deg));
    }
    let mut quads: Vec<Option<Quad>> = vec![None; panels];
    let first = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]];
    let mut open = vec![0];
    if let Some(quad) = quads.first_mut() {
        *quad = Some(first);
    }
    while let Some(panel) = open.pop() {
        let Some(quad) = quads[panel] else { continue };
        for &(other, e, f, angle) in &at_panel[panel] {
            if quads[other].is_none() {
                quads[other] = Some(beside(&quad, e, f, angle));
                open.push(other);
            }
        }
    }
    // A parsed text is a tree of all panels, so none is left out.
    let mut target: Vec<Quad> = quads.into_iter().flatten().collect();
    let low = box_of(&target).map(|[low, _]| low);
    for point in target.iter_mut().flatten() {
        *point = square::vector(low, *point);
    }
    target
}

/// The square beyond edge `e` of a square, with its own edge `f` there, bent by an angle.
fn beside(quad: &Quad, e: usize, f: usize, angle_deg: i16) -> Quad {
    let direction = match angle_deg {
        1.. => square::normal(quad),
        0 => square::opposite(square::into(quad, e)),
        _ => square::opposite(square::normal(quad)),
    };
    let (start, end) = (quad[(e + 1) % 4], quad[e]);
    let further = |p: square::Point| square::vector(direction.map(|c| -c), p);
    let mut beside = [start; 4];
    for (step, point) in [start, end, further(end), further(start)].into_iter().enumerate() {
        beside[(f + step) % 4] = point;
    }
    beside
}

/// Least and greatest coordinate along each axis.
fn box_of(quads: &[Quad]) -> [[i32; 2]; 3] {
    [0, 1, 2].map(|axis| {
        let values = || quads.iter().flatten().map(|point| point[axis]);
        [values().min().unwrap_or(0), values().max().unwrap_or(0)]
    })
}
