//! Plans of real models, for the tests.

#![expect(clippy::unwrap_used, reason = "a test without its model fails")]

use std::path::PathBuf;
use zygote_stacking::{Model, Plan, Request, plan};

/// The plan of a model of this repository.
pub(crate) fn planned(model: &str, piles: usize) -> Plan {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../models").join(model);
    let request = Request { piles, thickness: 0.05, ..Request::default() };
    plan(&Model::read(&path, None).unwrap(), &request).unwrap()
}
