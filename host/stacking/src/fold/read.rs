//! Reads a FOLD file as a plan, and refuses one that breaks any rule of the format.

use super::SCHEDULE;
use crate::check::{self, Document, Parsed, PlanFile, Report};
use crate::plan::{Hinge, Plan, Source};
use serde_json::Value;

/// How many places of each broken rule a message names.
const SHOWN_PER_RULE: usize = 3;

/// Why bytes are no plan.
#[derive(Debug, thiserror::Error)]
pub enum FoldError {
    /// No JSON.
    #[error("not JSON")]
    NotJson(#[from] serde_json::Error),
    /// JSON, but no object.
    #[error("expected a JSON object, found {found}")]
    NotAnObject {
        /// What kind of value was found.
        found: &'static str,
    },
    /// A plan that breaks rules.
    #[error("breaks the rules of a plan:\n  {}", .0.lines(SHOWN_PER_RULE).join("\n  "))]
    BreaksRules(Box<Report>),
    /// A source that lacks something.
    #[error("zygote:source: expected model, box, seed and program")]
    Source(#[source] serde_json::Error),
}

/// Parses a FOLD file without checking the rules.
///
/// # Errors
/// Bytes that are no JSON object.
pub fn parse(bytes: &[u8]) -> Result<Value, FoldError> {
    let file: Value = serde_json::from_slice(bytes)?;
    let found = match &file {
        Value::Object(_) => return Ok(file),
        Value::Array(_) => "an array",
        Value::String(_) => "a string",
        Value::Number(_) => "a number",
        Value::Bool(_) => "a truth value",
        Value::Null => "null",
    };
    Err(FoldError::NotAnObject { found })
}

/// Checks the bytes of a FOLD file against the rules, without a tree of values between.
///
/// # Errors
/// Bytes that are no JSON object.
pub fn check(bytes: &[u8]) -> Result<Report, FoldError> {
    Ok(check::check_file(file(bytes)?).1)
}

fn file(bytes: &[u8]) -> Result<PlanFile, FoldError> {
    let parsed: Parsed<PlanFile> = serde_json::from_slice(bytes)?;
    parsed.0.map_err(|found| FoldError::NotAnObject { found })
}

/// Reads a plan.
///
/// # Errors
/// Bytes that are no JSON object, or a plan that breaks a rule: named with key and index.
pub fn read(bytes: &[u8]) -> Result<Plan, FoldError> {
    let (document, report) = check::check_file(file(bytes)?);
    match document {
        Some(document) if report.is_valid() => plan(document),
        _ => Err(FoldError::BreaksRules(Box::new(report))),
    }
}

/// Makes a plan of a file that breaks no rule.
fn plan(mut document: Document) -> Result<Plan, FoldError> {
    let mut head = |key: &str| document.heads.remove(key).unwrap_or_default();
    let source: Source = serde_json::from_value(head("zygote:source")).map_err(FoldError::Source)?;
    let panel_length_mm = head("zygote:panel_length_mm").as_f64().unwrap_or_default();
    let root = head("zygote:root").as_u64().and_then(|root| usize::try_from(root).ok()).unwrap_or_default();
    let target = document.faces.iter().map(|face| face.map(|v| document.target.points[v])).collect();
    let flat = |point: [i32; 3]| [point[0], point[1]];
    let zygote = document.faces.iter().map(|face| face.map(|v| flat(document.zygote.points[v]))).collect();
    let hinges = document.hinges.iter().enumerate().map(|(index, entry)| {
        let [u, v] = document.edges[index];
        let [a, b] = entry.panels;
        let edge = |panel: usize, start: usize| {
            document.faces[panel].iter().position(|vertex| *vertex == start).unwrap_or_default()
        };
        Hinge {
            kind: entry.kind,
            panels: entry.panels,
            edges: [edge(a, u), edge(b, v)],
            side: entry.side,
            opening_deg: entry.opening_deg,
            zygote_angle_deg: degrees(document.zygote.angles[index]),
            target_angle_deg: degrees(document.target.angles[index]),
        }
    });
    let hinges = hinges.collect();
    Ok(Plan {
        target,
        zygote,
        hinges,
        thickness: document.thickness,
        panel_length_mm,
        root,
        source,
        schedule: document.heads.remove(SCHEDULE),
        piles: document.piles,
    })
}

/// A fold angle that the check compared with one of -180, -90, 0, 90, 180.
#[expect(clippy::cast_possible_truncation, reason = "a whole number of at most 180, as the check saw to")]
fn degrees(angle: f64) -> i16 {
    angle.round() as i16
}
