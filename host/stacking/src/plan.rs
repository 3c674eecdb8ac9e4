//! The plan: panels, piles and hinges of one zygote and its target, as every other crate sees them.
//! `fold` reads and writes it as a `.fold` file; `check` holds the rules.

use crate::mesh::Distance;

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

impl Side {
    /// The four sides, each a quarter turn counter-clockwise from the one before.
    pub const ALL: [Self; 4] = [Self::E, Self::N, Self::W, Self::S];

    /// The side after so many quarter turns counter-clockwise.
    #[must_use]
    pub fn turned(self, quarters: usize) -> Self {
        Self::ALL[(self as usize + quarters) % 4]
    }

    /// The side across.
    #[must_use]
    pub fn opposite(self) -> Self {
        self.turned(2)
    }

    /// The step to the cell beyond this side.
    pub fn step(self) -> [i32; 2] {
        match self {
            Self::E => [1, 0],
            Self::N => [0, 1],
            Self::W => [-1, 0],
            Self::S => [0, -1],
        }
    }

    /// The side's letter, as plan files have it.
    pub fn letter(self) -> &'static str {
        match self {
            Self::E => "E",
            Self::N => "N",
            Self::W => "W",
            Self::S => "S",
        }
    }
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
#[derive(Debug, Clone, Default, PartialEq, Eq)]
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
    /// How far the target is from that mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distance: Option<Distance>,
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

impl Plan {
    /// The number of panels.
    pub fn panels(&self) -> usize {
        self.target.len()
    }

    /// The number of panels in a pile.
    pub fn height(&self) -> usize {
        self.piles.first().map_or(0, |pile| pile.panels.len())
    }

    /// Of every panel the pile and the height in it.
    pub fn places(&self) -> Vec<(usize, usize)> {
        let mut places = vec![(0, 0); self.panels()];
        for (number, pile) in self.piles.iter().enumerate() {
            for (height, panel) in pile.panels.iter().enumerate() {
                places[*panel] = (number, height);
            }
        }
        places
    }

    /// The sides of the grid of piles, in cells.
    pub fn grid(&self) -> [i32; 2] {
        [0, 1].map(|axis| {
            let cells = || self.piles.iter().map(|pile| pile.cell[axis]);
            cells().max().unwrap_or(0) - cells().min().unwrap_or(0) + 1
        })
    }

    /// Package-volume expansion ratio: box of the target over box of the zygote. A side of length 0 counts as one thickness.
    pub fn expansion_ratio(&self) -> f64 {
        let side = |axis: usize| {
            let values = || self.target.iter().flatten().map(|corner| corner[axis]);
            let length = values().max().unwrap_or(0) - values().min().unwrap_or(0);
            if length == 0 { self.thickness } else { f64::from(length) }
        };
        let [across, along] = self.grid().map(f64::from);
        side(0) * side(1) * side(2) / (across * along * self.height() as f64 * self.thickness)
    }
}
