//! The piles: equally high, on distinct cells that hang together, every panel in one of them. And the expansion ratio,
//! which follows from the grid and the target's box.

use super::document::Document;
use super::report::{Report, Rule};
use crate::plan::Side;
use std::collections::BTreeMap;

/// One part in 10^9: a double printed in full differs by far less.
const VER_TOLERANCE: f64 = 1e-9;

/// Of every panel its cell and height.
pub(super) type Stack = Vec<([i32; 2], usize)>;

/// Checks the piles; where every panel is in one, tells where each panel lies.
pub(super) fn check(document: &Document, report: &mut Report) -> Option<Stack> {
    let mut place: Vec<Option<([i32; 2], usize)>> = vec![None; document.panels()];
    let mut cells: BTreeMap<[i32; 2], usize> = BTreeMap::new();
    let height = document.piles[0].panels.len();
    for (number, pile) in document.piles.iter().enumerate() {
        let here = || format!("zygote:piles[{number}]");
        if let Some(other) = cells.insert(pile.cell, number) {
            report.add(Rule::Cells, here(), format!("cell {:?} is that of pile {other} already", pile.cell));
        }
        report.require(pile.panels.len() == height && height > 0, Rule::PileHeight, || {
            (here(), format!("{} panels, expected {height} as in pile 0, above 0", pile.panels.len()))
        });
        for (h, panel) in pile.panels.iter().enumerate() {
            if place[*panel].replace((pile.cell, h)).is_some() {
                report.add(Rule::Piles, here(), format!("panel {panel} a second time"));
            }
        }
    }
    let missing: Vec<usize> = (0..place.len()).filter(|panel| place[*panel].is_none()).collect();
    report.require(missing.is_empty(), Rule::Piles, || {
        let first = &missing[..missing.len().min(3)];
        ("zygote:piles".into(), format!("{} panels in no pile, first {first:?}", missing.len()))
    });
    require_connected(cells.clone(), document.piles[0].cell, report);
    report.figures.panels = document.panels();
    report.figures.piles = document.piles.len();
    report.figures.height = height;
    place.into_iter().collect()
}

fn require_connected(mut alone: BTreeMap<[i32; 2], usize>, first: [i32; 2], report: &mut Report) {
    let mut reached = vec![first];
    alone.remove(&first);
    while let Some([x, y]) = reached.pop() {
        for side in Side::ALL {
            let [dx, dy] = side.step();
            let beyond = [x + dx, y + dy];
            if alone.remove(&beyond).is_some() {
                reached.push(beyond);
            }
        }
    }
    if let Some((cell, pile)) = alone.pop_first() {
        let message = format!(
            "cell {cell:?} doesn't hang together with the cell of pile 0, nor do {} more",
            alone.len()
        );
        report.add(Rule::Cells, format!("zygote:piles[{pile}]"), message);
    }
}

/// Checks the package-volume expansion ratio.
pub(super) fn check_expansion_ratio(document: &Document, report: &mut Report) {
    let extent = |values: &mut dyn Iterator<Item = i32>| {
        let (mut low, mut high) = (i64::MAX, i64::MIN);
        for value in values {
            low = low.min(value.into());
            high = high.max(value.into());
        }
        high - low
    };
    let mut volume = 1.0;
    for axis in 0..3 {
        let side = extent(&mut document.target.points.iter().map(|point| point[axis]));
        volume *= if side == 0 { document.thickness } else { side as f64 };
    }
    let grid = [0, 1].map(|axis| extent(&mut document.piles.iter().map(|pile| pile.cell[axis])) + 1);
    let height = document.panels() as f64 / document.piles.len() as f64;
    let ver = volume / (grid[0] as f64 * grid[1] as f64 * height * document.thickness);
    let close = document.ver.is_some_and(|stated| (stated - ver).abs() <= VER_TOLERANCE * ver);
    report.require(close, Rule::Ver, || {
        let stated = document.ver.map_or("nothing".into(), |stated| stated.to_string());
        ("zygote:ver".into(), format!("stated {stated}, the boxes give {ver}"))
    });
    report.figures.grid = grid;
    report.figures.expansion_ratio = ver;
}
