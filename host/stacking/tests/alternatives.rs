//! Alternatives: several plans of one shape that no turn of the stack makes alike.

#![expect(clippy::unwrap_used, reason = "a model that cannot be read or planned fails the test")]

use std::path::PathBuf;
use zygote_stacking::{Alternatives, Model, PlanError, Reconfiguration, Request, alternatives, fold};

fn found(name: &str, piles: usize, count: usize) -> Result<Alternatives, PlanError> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../models").join(name);
    let request = Request { piles, ..Request::default() };
    alternatives(&Model::read(&path, None).unwrap(), &request, count)
}

#[test]
fn ten_plans_of_a_fish_are_valid_and_every_two_differ_however_the_stack_is_turned() {
    for piles in [1, 2, 4] {
        let all = found("fish92.txt", piles, 10).unwrap();
        assert_eq!(all.found.len(), 10);
        assert!(all.tried >= 10);
        for (number, one) in all.found.iter().enumerate() {
            assert!(fold::check(&fold::write(&one.plan).unwrap()).unwrap().is_valid());
            assert!(one.depth >= 91 / 2 / piles, "{}", one.depth);
            for other in &all.found[..number] {
                // Cells that no turn makes alike are different enough.
                if let Ok(way) = Reconfiguration::between(&one.plan, &other.plan) {
                    assert_ne!(way.counts.kept, 91);
                }
            }
        }
    }
}

#[test]
fn a_cube_has_few_sequences_and_more_seeds_find_no_more() {
    let few = found("cube6.txt", 1, 20).unwrap();
    assert!((2..20).contains(&few.found.len()) && few.tried == 400, "{} of {}", few.found.len(), few.tried);
    let all = found("cube6.txt", 1, 40).unwrap();
    assert_eq!(all.found.len(), few.found.len());
}

#[test]
fn a_number_of_piles_that_does_not_divide_the_panels_is_refused_at_once() {
    assert!(matches!(found("fish92.txt", 3, 10), Err(PlanError::Indivisible { .. })));
}
