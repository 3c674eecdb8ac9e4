//! The table of `docs/src/package-volume.md`, row by row.

#![expect(clippy::unwrap_used, reason = "a model that cannot be read or planned fails the test")]

use std::fs;
use std::path::PathBuf;
use zygote_stacking::{Model, Request, check, fold, plan};

/// A cell such as `7 x 3 x 3`, as numbers from the greatest down: a box may lie any way.
fn sides(cell: &str) -> Vec<f64> {
    let mut sides: Vec<f64> = cell.split(" x ").map(|side| side.parse().unwrap()).collect();
    sides.sort_by(|a, b| b.total_cmp(a));
    sides
}

#[test]
fn the_ratios_in_the_book_are_those_of_the_plans() {
    let repository = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..");
    let page = fs::read_to_string(repository.join("docs/src/package-volume.md")).unwrap();
    let rows: Vec<Vec<&str>> = page
        .lines()
        .filter(|line| line.starts_with("| `"))
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    assert_eq!(rows.len(), 4, "rows of the table");
    for row in rows {
        let [name, panels, piles, slenderness, target, zygote, ratio, _] = row[..] else {
            panic!("{row:?}: expected eight cells")
        };
        let name = name.trim_matches('`');
        let slenderness: f64 = slenderness.parse().unwrap();
        let piles = piles.parse().unwrap();
        let request = Request { piles, thickness: 1.0 / slenderness, ..Request::default() };
        let model = Model::read(&repository.join("models").join(name), None).unwrap();
        let plan = plan(&model, &request).unwrap();
        let figures = check(&fold::parse(&fold::write(&plan).unwrap()).unwrap()).figures;
        assert_eq!(figures.panels.to_string(), panels.replace(',', ""), "{name}");
        let [x, y, z] = plan.source.bounds;
        assert_eq!(format!("{x} x {y} x {z}"), target, "{name}");
        let [across, along] = plan.grid().map(f64::from);
        let mut own = [across, along, plan.height() as f64 / slenderness];
        own.sort_by(|a, b| b.total_cmp(a));
        for (own, written) in own.iter().zip(sides(zygote)) {
            assert!((own - written).abs() < 1e-9, "{name}: {own}, the table says {written}");
        }
        assert_eq!(format!("{:.1}", figures.expansion_ratio), ratio, "{name}");
    }
}
