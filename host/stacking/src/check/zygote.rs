//! The zygote: every panel lies on its cell, outer side up at even heights and down at odd ones, and `faceOrders` says so.

use super::document::{Document, ZYGOTE};
use super::piles::Stack;
use super::report::{Report, Rule};
use super::squares::Frame;
use serde_json::Value;
use std::collections::BTreeMap;

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
    let mut expected: BTreeMap<(u64, u64), i64> = BTreeMap::new();
    for pile in &document.piles {
        for (height, pair) in pile.panels.windows(2).enumerate() {
            expected.insert((pair[1] as u64, pair[0] as u64), if height % 2 == 0 { 1 } else { -1 });
        }
    }
    for (index, order) in document.face_orders.iter().enumerate() {
        let read = || {
            let [upper, lower, s] = order.as_array()?.as_slice() else { return None };
            Some(((upper.as_u64()?, lower.as_u64()?), s.as_i64()?))
        };
        let good = read().is_some_and(|(pair, s): (_, i64)| expected.remove(&pair) == Some(s));
        report.require(good, Rule::FaceOrders, || {
            let message = "expected [upper, lower, s] of two consecutive heights, each once, s by the lower panel's normal";
            (format!("{ZYGOTE}faceOrders[{index}]"), format!("{message}; found {}", brief(order)))
        });
    }
    if let Some(((upper, lower), _)) = expected.first_key_value() {
        let message = format!("nothing for {} pairs of panels, first {upper} over {lower}", expected.len());
        report.add(Rule::FaceOrders, format!("{ZYGOTE}faceOrders"), message);
    }
}

fn brief(order: &Value) -> String {
    order.to_string().chars().take(40).collect()
}
