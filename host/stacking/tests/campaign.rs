//! The short version of the campaign over random solids; `cargo xtask bench stacking` runs the long one.
#![expect(clippy::unwrap_used, reason = "helpers of tests fail as tests do")]

mod boundary;
mod grown;

#[test]
fn lumps_tendrils_plates_and_tunnels_stack_into_one_two_four_and_six_piles() {
    let (mut planned, mut refused) = (0, Vec::new());
    for number in 0..32 {
        let (growth, voxels, model) = grown::solid(number);
        for piles in [1, 2, 4, 6].into_iter().filter(|k| model.surface().len().is_multiple_of(*k)) {
            match grown::attempt(&model, piles, 0) {
                Ok(()) => planned += 1,
                Err(error) => refused.push(format!("{growth:?} of {voxels} voxels, K={piles}: {error}")),
            }
        }
    }
    // One in a hundred may be refused, and that is less than one of these.
    assert!(planned > 64, "{planned} planned");
    assert!(refused.is_empty(), "{}", refused.join("\n"));
}
