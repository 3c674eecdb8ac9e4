//! Every input that the fuzz targets of this crate have in their corpus, on the toolchain of every day.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a test that cannot go on fails"
)]

#[path = "../../fuzz/bodies/corpus.rs"]
mod corpus;
#[path = "../../fuzz/bodies/frame.rs"]
mod frame;
#[path = "../../fuzz/bodies/message.rs"]
mod message;

#[test]
fn the_corpus_of_frame_holds() {
    corpus::replay(env!("CARGO_MANIFEST_DIR"), "..", "frame", frame::check);
}

#[test]
fn the_corpus_of_message_holds() {
    corpus::replay(env!("CARGO_MANIFEST_DIR"), "..", "message", message::check);
}
