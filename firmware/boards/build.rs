//! Hands `memory.x` to the linker, and the commit to the program.

use std::{env, error::Error, fs, path::PathBuf, process::Command};

/// What the firmware is made of.
const SOURCES: &[&str] = &[".", "../../core", "../../parts", "../../stm32f4", "../../../protocol"];

fn main() -> Result<(), Box<dyn Error>> {
    let out = PathBuf::from(env::var("OUT_DIR")?);
    fs::copy("memory.x", out.join("memory.x"))?;
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rerun-if-changed=memory.x");

    println!("cargo:rustc-env=ZYGOTE_COMMIT={}", commit().unwrap_or_else(|| "unknown".into()));
    for file in ["HEAD", "index"] {
        if let Some(path) = git(&["rev-parse", "--git-path", file]) {
            println!("cargo:rerun-if-changed={path}");
        }
    }
    for folder in SOURCES {
        println!("cargo:rerun-if-changed={folder}");
    }
    Ok(())
}

/// The commit, with a `+` where the sources differ from it.
fn commit() -> Option<String> {
    let hash = git(&["rev-parse", "--short=10", "HEAD"])?;
    let dirty =
        git(&[&["status", "--porcelain", "--"], SOURCES].concat()).is_none_or(|changes| !changes.is_empty());
    Some(if dirty { format!("{hash}+") } else { hash })
}

fn git(arguments: &[&str]) -> Option<String> {
    let output =
        Command::new("git").args(arguments).output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_owned())
}
