//! Every scenario file of the repository, with the real controller over the real protocol.

use std::path::Path;
use zygote_rehearsal::Scenario;
use zygote_rehearsal::scenario::table;

/// Scenarios whose rule doesn't hold today, with the rule; taken off as soon as it does.
const KNOWN_FAILURES: [(&str, &str); 0] = [];

#[test]
fn every_scenario_holds_but_those_that_are_known_not_to() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim/scenarios");
    let scenarios = Scenario::find(&folder).unwrap();
    assert!(scenarios.len() >= 30, "{} scenarios", scenarios.len());
    let verdicts: Vec<_> = scenarios.iter().map(|scenario| scenario.rehearse().unwrap()).collect();
    println!("{}", table(&verdicts));
    for (scenario, verdict) in scenarios.iter().zip(&verdicts) {
        let known = KNOWN_FAILURES.iter().any(|(name, _)| *name == scenario.name());
        assert_eq!(
            verdict.holds(),
            !known,
            "{}, known to fail: {known}\n{}",
            scenario.name(),
            table(&verdicts)
        );
    }
}
