//! `cargo xtask docs`: builds the book into `docs/book`.

use crate::tools;
use anyhow::{Context, Result, ensure};
use std::{fs, path::Path};

/// Builds the book, and checks that it holds every page under `docs/`.
pub(crate) fn run() -> Result<()> {
    // Unoptimised: it takes less time to build, and the book is small.
    let mdbook = tools::from_crates_io("mdbook", "^0.5", &["--no-default-features", "--debug"])?;
    let docs = tools::root().join("docs");
    let summary =
        fs::read_to_string(docs.join("src/SUMMARY.md")).context("cannot read docs/src/SUMMARY.md")?;
    for page in pages(&docs.join("src"))? {
        ensure!(summary.contains(&format!("({page})")), "docs/src/SUMMARY.md has no link to {page}");
    }
    tools::run(tools::command(mdbook).arg("build").arg(&docs))
}

/// The pages below `folder`, as the summary links them.
fn pages(folder: &Path) -> Result<Vec<String>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).with_context(|| format!("cannot list {}", folder.display()))? {
        let path = entry?.path();
        let Some(name) = path.file_name().and_then(|name| name.to_str()) else { continue };
        if path.is_dir() {
            found.extend(pages(&path)?.into_iter().map(|page| format!("{name}/{page}")));
        } else if path.extension() == Some("md".as_ref()) && name != "SUMMARY.md" {
            found.push(name.to_owned());
        }
    }
    found.sort();
    Ok(found)
}
