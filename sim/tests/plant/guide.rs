//! The table of the guide against the plant, so that neither can drift from the other.

use std::fmt::Write;

use zygote_core::Duty;
use zygote_sim::plant::SmaConfig;

use crate::rig::Rig;

const PAGE: &str = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/src/plant.md"));

/// One row: times from ambient, and what the hinge comes to if the power is left on.
fn row(per_mille: u16) -> String {
    let sma = SmaConfig::opening(180.0);
    let mut rig = Rig::hinge(sma);
    rig.heaters[0] = Duty::new(per_mille);
    rig.run(120.0);
    let (steady_c, steady_film_c) = (rig.foil_c(), rig.film_c());

    let mut row = format!("| {:.2} W |", f64::from(per_mille) / 1000.0);
    let mut rig = Rig::hinge(sma);
    rig.heaters[0] = Duty::new(per_mille);
    let mut elapsed_s = 0.0;
    for goal_c in [sma.alloy.as_c, sma.alloy.af_c, sma.alloy.af_c + 10.0] {
        if steady_c <= goal_c {
            row += " never |";
        } else {
            elapsed_s += rig.run_until(|foil_c| foil_c >= goal_c);
            write!(row, " {elapsed_s:.1} s |").expect("a string takes all");
        }
    }
    row + &format!(" {steady_c:.0} °C | {steady_film_c:.0} °C |")
}

#[test]
fn the_table_of_heating_times_is_what_the_plant_does() {
    let rows = [300, 500, 600, 750, 1000].map(row).join("\n");
    assert!(PAGE.contains(&rows), "docs/src/plant.md lacks the rows\n{rows}");
}

#[test]
fn the_cooling_times_of_the_guide_are_what_the_plant_does() {
    let sma = SmaConfig::opening(180.0);
    let mut rig = Rig::hinge(sma);
    rig.heaters[0] = Duty::FULL;
    rig.run_until(|foil_c| foil_c >= sma.alloy.af_c + 10.0);
    let film_c = rig.film_c();
    rig.heaters[0] = Duty::OFF;
    // The film passes on what it holds above the foil.
    let mut peak_c = rig.foil_c();
    for _ in 0..100 {
        rig.run(0.005);
        peak_c = peak_c.max(rig.foil_c());
    }
    let ms_s = 0.5 + rig.run_until(|foil_c| foil_c <= sma.alloy.ms_c);
    let mf_s = ms_s + rig.run_until(|foil_c| foil_c <= sma.alloy.mf_c);
    let touch_s = mf_s + rig.run_until(|foil_c| foil_c <= 35.0);
    let line = format!(
        "film at {film_c:.0} °C, foil peaks at {peak_c:.1} °C, Ms after {ms_s:.1} s, Mf after {mf_s:.1} s, \
         35 °C after {touch_s:.1} s"
    );
    assert!(PAGE.contains(&line), "docs/src/plant.md lacks the line\n{line}");
}
