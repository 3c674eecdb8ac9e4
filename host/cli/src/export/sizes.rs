//! How large the things are that `zygote export` makes: the panel, its holes, the gaps, the sheet it is cut from.

use clap::{Args, ValueEnum};
use zygote_fabrication::{Gaps, Holes, Magnet, Panel, Rim, Screws, Sheet};
use zygote_stacking::Plan;

/// Sizes, all in millimetres.
#[derive(Args)]
#[command(next_help_heading = "Sizes, in millimetres")]
pub(super) struct Sizes {
    /// Side of a panel [default: the plan's]
    #[arg(long, value_name = "MM")]
    side: Option<f64>,
    /// Thickness of a panel [default: the plan's]
    #[arg(long, value_name = "MM")]
    thickness: Option<f64>,
    /// Holes in the panels [default: magnets where the panel has room for them, else none]
    #[arg(long, value_enum)]
    holes: Option<Drilled>,
    /// Magnet along each side, diameter and length
    #[arg(long, value_name = "DxL", default_value = "2x30", value_parser = numbers::<2>)]
    magnet: [f64; 2],
    /// How much wider than the magnet its hole is
    #[arg(long, value_name = "MM", default_value_t = Magnet::default().clearance_mm)]
    clearance: f64,
    /// Two holes at each side: diameter, from the side, from each other
    #[arg(long, value_name = "DxIxA", default_value = "2.2x5x12", value_parser = numbers::<3>)]
    screws: [f64; 3],
    /// Form of the sides [default: round with magnets, so that panels roll on each other; else square]
    #[arg(long, value_enum)]
    rim: Option<Form>,
    /// Gap between the panels of a pile
    #[arg(long, value_name = "MM", default_value_t = Gaps::default().layers_mm)]
    gap: f64,
    /// Gap between piles [default: that of --gap]
    #[arg(long, value_name = "MM")]
    pile_gap: Option<f64>,
    /// Sheet that panels are cut from, width and height
    #[arg(long, value_name = "WxH", default_value = "600x400", value_parser = numbers::<2>)]
    sheet: [f64; 2],
    /// What stays free at the border of a sheet
    #[arg(long, value_name = "MM", default_value_t = Sheet::default().margin_mm)]
    margin: f64,
    /// What stays between two cuts
    #[arg(long, value_name = "MM", default_value_t = Sheet::default().spacing_mm)]
    spacing: f64,
    /// Width of the cut: lines are half of it beside the panel
    #[arg(long, value_name = "MM", default_value_t = Sheet::default().kerf_mm)]
    kerf: f64,
}

/// Holes by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Drilled {
    /// Along each side, for a cylindrical magnet that is a hinge of any angle
    Magnets,
    /// Two through the panel at each side, to fix a hinge with
    Screws,
    /// None
    None,
}

/// Forms of the side by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Form {
    /// Half a cylinder
    Round,
    /// Upright
    Square,
}

/// So many numbers with an x between them.
fn numbers<const COUNT: usize>(text: &str) -> Result<[f64; COUNT], String> {
    let numbers: Option<Vec<f64>> = text.split('x').map(|number| number.parse().ok()).collect();
    let numbers = numbers.and_then(|numbers| <[f64; COUNT]>::try_from(numbers).ok());
    numbers.ok_or_else(|| {
        format!("expected {COUNT} numbers of millimetres with an x between them, as in the default")
    })
}

impl Sizes {
    /// The panel, and what the user has to know of it.
    pub(super) fn panel(&self, plan: &Plan) -> (Panel, Option<String>) {
        let [diameter_mm, length_mm] = self.magnet;
        let magnets = Holes::Magnets(Magnet { diameter_mm, length_mm, clearance_mm: self.clearance });
        let [hole_mm, inset_mm, apart_mm] = self.screws;
        let screws = Holes::Screws(Screws { diameter_mm: hole_mm, inset_mm, apart_mm });
        let with = |holes: Holes| {
            let round = match self.rim {
                Some(form) => form == Form::Round,
                None => matches!(holes, Holes::Magnets(_)),
            };
            Panel {
                side_mm: self.side.unwrap_or(plan.panel_length_mm),
                thickness_mm: self.thickness.unwrap_or(plan.thickness * plan.panel_length_mm),
                rim: if round { Rim::Round } else { Rim::Square },
                holes,
            }
        };
        match self.holes {
            Some(Drilled::Magnets) => (with(magnets), None),
            Some(Drilled::Screws) => (with(screws), None),
            Some(Drilled::None) => (with(Holes::None), None),
            None => match with(magnets).check() {
                Ok(()) => (with(magnets), None),
                Err(error) => {
                    let note = format!(
                        "panels have no holes ({error}); --thickness, --side, --magnet or --holes change that"
                    );
                    (with(Holes::None), Some(note))
                }
            },
        }
    }

    /// The gaps of a stack.
    pub(super) fn gaps(&self) -> Gaps {
        Gaps { layers_mm: self.gap, piles_mm: self.pile_gap.unwrap_or(self.gap) }
    }

    /// The sheet.
    pub(super) fn sheet(&self) -> Sheet {
        let [width_mm, height_mm] = self.sheet;
        Sheet { width_mm, height_mm, margin_mm: self.margin, spacing_mm: self.spacing, kerf_mm: self.kerf }
    }
}
