//! The plan reader: any bytes are a plan or a refusal; a plan that was read can be written and is read as the same.

use zygote_stacking::fold;

/// Bytes as a `.fold` file.
pub(crate) fn check(data: &[u8]) {
    let Ok(plan) = fold::read(data) else { return };
    let written = fold::write(&plan).expect("what was read can be written");
    let again = fold::read(&written).expect("what was written can be read");
    assert_eq!(fold::write(&again).expect("and written again"), written);
}
