//! The zygote: every panel lies on its cell, outer side up at even heights and down at odd ones, and `faceOrders` says so.

use super::document::{Document, ZYGOTE};
use super::items::Order;
use super::piles::Stack;
use super::report::{Report, Rule};
use super::squares::Frame;

/// Checks the folding map and the order of the layers.
pub(super) fn check(document: &Document, zygote: &Frame<'_>, stack: &Stack, report: &mut Report) {
    for (panel, square) in zygote.squares() {
        let (cell, height) = stack[panel];
        let here = || format!("faces_vertices[{panel}]");
        let [x, y, z] = square.least;
        report.require(square.axis == 2 && z == 0 && [x, y] == cell, Rule::FoldingMap, || {
            (here(), format!("at {:?} in the zygote, its cell is {cell:?}", square.least))
        });
        let up = square.sign > 0;
        report.require(up == (height % 2 == 0), Rule::FoldingMap, || {
            (here(), format!("outer side {} at height {height}", if up { "up" } else { "down" }))
        });
    }
    check_orders(document, report);
}

fn check_orders(document: &Document, report: &mut Report) {
    /// What stands for no panel.
    const NONE: i64 = -1;
    let mut above = vec![(NONE, 0); document.panels()];
    for pile in &document.piles {
        for (height, pair) in pile.panels.windows(2).enumerate() {
            above[pair[0]] = (pair[1].cast_signed() as i64, if height % 2 == 0 { 1 } else { -1 });
        }
    }
    for (index, &Order([upper, lower, s])) in document.face_orders.entries.iter().enumerate() {
        let odd = document.face_orders.odd.get(&index);
        let expected = usize::try_from(lower).ok().and_then(|lower| above.get_mut(lower));
        let good = odd.is_none()
            && expected.is_some_and(|expected| {
                *expected != (NONE, 0) && std::mem::replace(expected, (NONE, 0)) == (upper, s)
            });
        report.require(good, Rule::FaceOrders, || {
            let message = "expected [upper, lower, s] of two consecutive heights, each once, s by the lower panel's normal";
            let found = odd.map_or_else(|| format!("[{upper},{lower},{s}]"), String::clone);
            (format!("{ZYGOTE}faceOrders[{index}]"), format!("{message}; found {found}"))
        });
    }
    let mut left = above.iter().enumerate().filter(|(_, (upper, _))| *upper != NONE);
    if let Some((lower, (upper, _))) = left.next() {
        let message = format!("nothing for {} pairs of panels, first {upper} over {lower}", 1 + left.count());
        report.add(Rule::FaceOrders, format!("{ZYGOTE}faceOrders"), message);
    }
}
