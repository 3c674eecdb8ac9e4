//! The rules of a plan file, checked on the file alone: whatever can be is computed from the coordinates and compared
//! with what the file says. Nothing here is shared with the planner.
//!
//! `zygote check` prints the report, `fold::read` refuses what breaks a rule, `zygote plan` checks what it planned.

mod column;
mod document;
mod entry;
mod file;
mod heads;
mod hinges;
mod items;
mod lattice;
mod object;
mod piles;
mod report;
mod squares;
mod target;
mod topology;
mod zygote;

pub(crate) use document::Document;
pub(crate) use file::{Parsed, PlanFile};
pub use report::{Figures, Report, Rule, Violation};

use serde::Deserialize;
use serde_json::Value;
use squares::Frame;

/// Checks a plan file that is a tree of values. From bytes `fold::check` is faster by far.
pub fn check(file: &Value) -> Report {
    // What is no object, and so no file, has no key; reading from a tree of values can't fail otherwise.
    let read = Parsed::<PlanFile>::deserialize(file).ok().and_then(|parsed| parsed.0.ok());
    check_file(read.unwrap_or_default()).1
}

/// Checks a plan file, and hands on what was read of it.
pub(crate) fn check_file(file: PlanFile) -> (Option<Document>, Report) {
    let mut report = Report::default();
    let Some(document) = Document::read(file, &mut report) else { return (None, report) };
    heads::check(&document, &mut report);
    let joints = topology::check(&document, &mut report);
    let target = Frame::new("target", &document.target.points, &document.faces, &mut report);
    let zygote = Frame::new("zygote", &document.zygote.points, &document.faces, &mut report);
    let stack = piles::check(&document, &mut report);
    hinges::check_cut_edges(&document, &mut report);
    if target.is_whole() {
        target::check(&document, &target, &joints, &mut report);
    }
    if let Some(stack) = &stack
        && zygote.is_whole()
    {
        zygote::check(&document, &zygote, stack, &mut report);
        if zygote.is_flat() {
            hinges::check(&document, &zygote, stack, &joints, &mut report);
        }
    }
    piles::check_expansion_ratio(&document, &mut report);
    (Some(document), report)
}
