//! `cargo xtask arrows`: which crate of ours may use which, checked against what the manifests say.

use crate::{
    firmware,
    tools::{self, cargo},
};
use anyhow::{Context, Result, bail, ensure};
use serde_json::Value;
use std::collections::BTreeSet;

/// A crate, and those of ours that it may use, in the code and in its tests.
const ALLOWED: &[(&str, &[&str])] = &[
    ("zygote-protocol", &[]),
    ("zygote-core", &["zygote-protocol"]),
    ("zygote-sim", &["zygote-core", "zygote-protocol"]),
    ("zygote-emulator", &["zygote-core", "zygote-protocol", "zygote-sim"]),
    ("zygote-stacking", &[]),
    ("zygote-deployment", &["zygote-stacking"]),
    ("zygote-calibration", &["zygote-core", "zygote-sim"]),
    ("zygote-fabrication", &["zygote-deployment", "zygote-stacking"]),
    ("zygote-controller", &["zygote-calibration", "zygote-protocol", "zygote-deployment"]),
    (
        "zygote-rehearsal",
        &[
            "zygote-calibration",
            "zygote-stacking",
            "zygote-deployment",
            "zygote-controller",
            "zygote-core",
            "zygote-protocol",
            "zygote-sim",
            "zygote-emulator",
        ],
    ),
    (
        "zygote-recording",
        &["zygote-stacking", "zygote-deployment", "zygote-controller", "zygote-protocol", "zygote-rehearsal"],
    ),
    ("zygote-live", &["zygote-controller", "zygote-deployment", "zygote-protocol"]),
    (
        "zygote-cli",
        &[
            "zygote-calibration",
            "zygote-stacking",
            "zygote-deployment",
            "zygote-controller",
            "zygote-fabrication",
            "zygote-live",
            "zygote-protocol",
            "zygote-recording",
            "zygote-rehearsal",
            "zygote-sim",
            "zygote-emulator",
        ],
    ),
    ("zygote-parts", &["zygote-core", "zygote-protocol"]),
    ("zygote-stm32f4", &["zygote-core", "zygote-parts", "zygote-protocol"]),
    ("zygote-nucleo-f446re", &["zygote-core", "zygote-protocol", "zygote-stm32f4"]),
    ("zygote-stm32f4-discovery", &["zygote-core", "zygote-protocol", "zygote-stm32f4"]),
    ("xtask", &[]),
];

/// `user` uses `used`.
type Arrow = (String, String);

/// Checks the host workspace and every board.
pub(crate) fn run() -> Result<()> {
    let mut manifests = vec![tools::root().join("Cargo.toml")];
    manifests.extend(firmware::outside()?.iter().map(|folder| folder.join("Cargo.toml")));
    let (mut crates, mut arrows) = (BTreeSet::new(), BTreeSet::new());
    for manifest in manifests {
        let mut metadata = cargo();
        metadata.args(["metadata", "--format-version", "1", "--no-deps", "--manifest-path"]).arg(&manifest);
        let metadata = serde_json::from_str(&tools::output_of(&mut metadata)?)
            .with_context(|| format!("what cargo says of {} isn't JSON", manifest.display()))?;
        let (more_crates, more_arrows) = ours(&metadata)?;
        crates.extend(more_crates);
        arrows.extend(more_arrows);
    }
    check(&crates, &arrows)?;
    println!("{} crates, {} arrows, all of them allowed", crates.len(), arrows.len());
    Ok(())
}

/// Our crates in what `cargo metadata` says, and the arrows between them.
fn ours(metadata: &Value) -> Result<(BTreeSet<String>, BTreeSet<Arrow>)> {
    let (mut crates, mut arrows) = (BTreeSet::new(), BTreeSet::new());
    for package in list(metadata, "packages")? {
        let user = text(package, "name")?;
        for dependency in list(package, "dependencies")? {
            // What has a path is ours; the rest comes from a registry.
            if dependency.get("path").is_some_and(Value::is_string) {
                arrows.insert((user.clone(), text(dependency, "name")?));
            }
        }
        crates.insert(user);
    }
    Ok((crates, arrows))
}

/// Refuses crates without a line in the table, and arrows that it doesn't have.
fn check(crates: &BTreeSet<String>, arrows: &BTreeSet<Arrow>) -> Result<()> {
    let allowed = |user: &str| ALLOWED.iter().find(|(name, _)| *name == user).map(|(_, used)| *used);
    let unknown: Vec<_> = crates.iter().filter(|name| allowed(name).is_none()).cloned().collect();
    ensure!(unknown.is_empty(), "no line in xtask/src/arrows.rs for: {}", unknown.join(", "));
    let forbidden: Vec<String> = arrows
        .iter()
        .filter(|(user, used)| !allowed(user).unwrap_or_default().contains(&used.as_str()))
        .map(|(user, used)| {
            let may = allowed(user).unwrap_or_default().join(", ");
            format!("{user} uses {used}, but may use {}", if may.is_empty() { "none of ours" } else { &may })
        })
        .collect();
    if forbidden.is_empty() { Ok(()) } else { bail!("{}", forbidden.join("\n")) }
}

fn list<'a>(value: &'a Value, key: &str) -> Result<&'a Vec<Value>> {
    value.get(key).and_then(Value::as_array).with_context(|| format!("cargo metadata has no list `{key}`"))
}

fn text(value: &Value, key: &str) -> Result<String> {
    let text = value.get(key).and_then(Value::as_str);
    text.map(str::to_owned).with_context(|| format!("cargo metadata has no text `{key}`"))
}

#[cfg(test)]
mod checks {
    use super::*;
    use serde_json::json;

    fn check_metadata(metadata: &Value) -> Result<()> {
        let (crates, arrows) = ours(metadata)?;
        check(&crates, &arrows)
    }

    fn using(user: &str, dependencies: &Value) -> Value {
        json!({ "packages": [{ "name": user, "dependencies": dependencies }] })
    }

    #[test]
    fn an_allowed_arrow_passes() {
        let metadata =
            using("zygote-core", &json!([{ "name": "zygote-protocol", "path": "/here/protocol" }]));
        check_metadata(&metadata).unwrap();
    }

    #[test]
    fn a_forbidden_arrow_is_refused_with_what_is_allowed() {
        let metadata =
            using("zygote-deployment", &json!([{ "name": "zygote-protocol", "path": "/here/protocol" }]));
        let error = check_metadata(&metadata).unwrap_err().to_string();
        assert_eq!(error, "zygote-deployment uses zygote-protocol, but may use zygote-stacking");
    }

    #[test]
    fn an_arrow_of_the_tests_counts_too() {
        let dependencies = json!([{ "name": "zygote-core", "kind": "dev", "path": "/here/core" }]);
        assert!(check_metadata(&using("zygote-protocol", &dependencies)).is_err());
    }

    #[test]
    fn a_crate_that_the_table_does_not_have_is_refused() {
        let error = check_metadata(&using("zygote-novel", &json!([]))).unwrap_err().to_string();
        assert!(error.contains("zygote-novel"), "{error}");
    }

    #[test]
    fn what_comes_from_a_registry_is_free() {
        let metadata = using("zygote-protocol", &json!([{ "name": "serde", "path": null }]));
        check_metadata(&metadata).unwrap();
    }
}
