//! The plan: panels, piles and hinges of one zygote and its target, as every other crate sees them.
//! `fold` reads and writes it as a `.fold` file; `check` holds the rules.

/// A side of a cell of the grid of piles, seen from above.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// +x
    E,
    /// +y
    N,
    /// -x
    W,
    /// -y
    S,
}

/// What a hinge joins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum HingeKind {
    /// Two consecutive heights of one pile; closed in the zygote.
    Fold,
    /// Two equal heights of neighbouring piles; flat in the zygote.
    Bridge,
}

/// A hinge of the tree path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Hinge {
    /// Fold or bridge.
    pub kind: HingeKind,
    /// The two panels; of a fold the lower one first.
    pub panels: [usize; 2],
    /// The edge of each panel that carries the hinge: edge `e` runs from corner `e` to corner `(e + 1) % 4`.
    pub edges: [usize; 2],
    /// The side of the first panel's cell that carries the hinge.
    pub side: Side,
    /// Opening angle in the target, degrees: 90, 180 or 270.
    pub opening_deg: u16,
    /// Fold angle in the zygote, degrees, FOLD's sign: +-180 for a fold, 0 for a bridge.
    pub zygote_angle_deg: i16,
    /// Fold angle in the target, degrees, FOLD's sign: -90, 0 or 90.
    pub target_angle_deg: i16,
}

/// A column of panels on one cell.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pile {
    /// The cell (i, j), covering [i, i+1] x [j, j+1].
    pub cell: [i32; 2],
    /// Panel numbers from the bottom up.
    pub panels: Vec<usize>,
}

/// What a plan was made from; stands in the file for people and for repeatability.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Source {
    /// File name of the model, without its folder.
    pub model: String,
    /// Edge of a voxel in units of the mesh, where a mesh was voxelised.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub voxel_size: Option<f64>,
    /// Sides of the target's box, in panel lengths.
    #[serde(rename = "box")]
    pub bounds: [i32; 3],
    /// Seed of every random choice.
    pub seed: u64,
    /// Name and version of the program.
    pub program: String,
}

/// A zygote and its target.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// The four corners of every panel in the target, counter-clockwise seen from outside, panel lengths.
    pub target: Vec<[[i32; 3]; 4]>,
    /// The same corners in the zygote, in the plane z = 0.
    pub zygote: Vec<[[i32; 2]; 4]>,
    /// The hinges, one less than there are panels.
    pub hinges: Vec<Hinge>,
    /// The piles, equally high.
    pub piles: Vec<Pile>,
    /// The panel that stays fixed.
    pub root: usize,
    /// Panel thickness over panel length.
    pub thickness: f64,
    /// Panel length in millimetres.
    pub panel_length_mm: f64,
    /// Where it came from.
    pub source: Source,
    /// The deployment schedule as it stands in the file, where it has one; `deployment` reads it.
    pub schedule: Option<serde_json::Value>,
}
