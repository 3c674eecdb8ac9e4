//! Every input that the fuzz targets of this crate have in their corpus, on the toolchain of every day.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a test that cannot go on fails"
)]

#[path = "../../../fuzz/bodies/corpus.rs"]
mod corpus;
#[path = "../../../fuzz/bodies/plan.rs"]
mod plan;
#[path = "../../../fuzz/bodies/rig.rs"]
mod rig;
#[path = "../../../fuzz/bodies/schedule.rs"]
mod schedule;

#[test]
fn the_corpus_of_plan_holds() {
    corpus::replay(env!("CARGO_MANIFEST_DIR"), "../..", "plan", plan::check);
}

#[test]
fn the_corpus_of_rig_holds() {
    corpus::replay(env!("CARGO_MANIFEST_DIR"), "../..", "rig", rig::check);
}

#[test]
fn the_corpus_of_schedule_holds() {
    corpus::replay(env!("CARGO_MANIFEST_DIR"), "../..", "schedule", schedule::check);
}
