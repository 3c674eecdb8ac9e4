//! Every scenario file of the repository, with the real controller over the real protocol.

use std::path::Path;
use zygote_rehearsal::Scenario;
use zygote_rehearsal::scenario::{Verdict, table};

#[test]
fn every_scenario_holds() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim/scenarios");
    let scenarios = Scenario::find(&folder).unwrap();
    assert!(scenarios.len() >= 30, "{} scenarios", scenarios.len());
    let verdicts: Vec<_> = scenarios.iter().map(|scenario| scenario.rehearse().unwrap()).collect();
    println!("{}", table(&verdicts));
    assert!(verdicts.iter().all(Verdict::holds));
}
