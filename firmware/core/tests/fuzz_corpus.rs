//! Every input that the fuzz targets of this crate have in their corpus, on the toolchain of every day.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a test that cannot go on fails"
)]

#[path = "../../../fuzz/bodies/core.rs"]
mod core;
#[path = "../../../fuzz/bodies/corpus.rs"]
mod corpus;

#[test]
fn the_corpus_of_core_holds() {
    corpus::replay(env!("CARGO_MANIFEST_DIR"), "../..", "core", core::check);
}
