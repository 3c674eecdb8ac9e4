//! The fixed keys of the file and of its two frames, and the plain `zygote:` keys.

use super::document::{Document, Heads, ZYGOTE};
use super::report::{Report, Rule};
use serde_json::{Value, json};

/// Keys that the zygote's frame inherits and must not have of its own.
const INHERITED: [&str; 3] = ["faces_vertices", "edges_vertices", "edges_faces"];

/// Checks the heads.
pub(super) fn check(document: &Document, report: &mut Report) {
    let (file, frame) = (&document.heads, &document.zygote_heads);
    let target = [
        ("file_spec", json!(1.2)),
        ("file_classes", json!(["singleModel"])),
        ("frame_title", json!("target")),
        ("frame_classes", json!(["foldedForm"])),
        ("zygote:version", json!(1)),
    ];
    let zygote = [
        ("frame_title", json!("zygote")),
        ("frame_classes", json!(["foldedForm"])),
        ("frame_parent", json!(0)),
        ("frame_inherit", json!(true)),
    ];
    fixed(file, "", &target, "3D", report);
    fixed(frame, ZYGOTE, &zygote, "2D", report);
    let mut plain = |key: &str, expected: &str, test: &dyn Fn(&Value) -> bool| {
        let found = under(file, key);
        report
            .require(test(found), Rule::Head, || (key.into(), format!("expected {expected}, found {found}")));
    };
    let is_length = |value: &Value| value.as_f64().is_some_and(|length| length > 0.0);
    plain("file_creator", "name and version", &|value| value.as_str().is_some_and(|name| !name.is_empty()));
    plain("zygote:panel_length_mm", "a length above 0", &is_length);
    plain("zygote:root", "a panel number", &|value| {
        value.as_u64().is_some_and(|root| root < document.panels() as u64)
    });
    plain("zygote:source", "an object", &Value::is_object);
    for key in INHERITED {
        report.require(frame.get(key).is_none(), Rule::Head, || {
            (format!("{ZYGOTE}{key}"), "must be inherited, found an own one".into())
        });
    }
}

fn fixed(frame: &Heads, prefix: &str, keys: &[(&str, Value)], attribute: &str, report: &mut Report) {
    for (key, expected) in keys {
        let found = under(frame, key);
        report.require(same(found, expected), Rule::Head, || {
            (format!("{prefix}{key}"), format!("expected {expected}, found {found}"))
        });
    }
    let attributes = under(frame, "frame_attributes");
    let has = attributes.as_array().is_some_and(|list| list.iter().any(|entry| entry == attribute));
    report.require(has, Rule::Head, || {
        (
            format!("{prefix}frame_attributes"),
            format!("expected an array with \"{attribute}\", found {attributes}"),
        )
    });
}

/// The value under a key, or null.
fn under<'a>(heads: &'a Heads, key: &str) -> &'a Value {
    heads.get(key).unwrap_or(&Value::Null)
}

/// Whether two JSON values are the same, numbers by their value.
fn same(found: &Value, expected: &Value) -> bool {
    match (found.as_f64(), expected.as_f64()) {
        (Some(found), Some(expected)) => found - expected == 0.0,
        _ => found == expected,
    }
}
