//! `zygote hil` where it can't run: what it says, and its exit code. That it runs is what `cargo xtask hil` shows.

use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn hil(folder: &Path, arguments: &[&str]) -> std::io::Result<Output> {
    Command::new(env!("CARGO_BIN_EXE_zygote")).current_dir(folder).arg("hil").args(arguments).output()
}

fn scratch(name: &str) -> std::io::Result<std::path::PathBuf> {
    let folder = std::env::temp_dir().join(format!("zygote-hil-{name}-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    Ok(folder)
}

#[test]
fn outside_of_a_checkout_the_suite_is_asked_for() -> Result<(), Box<dyn Error>> {
    let folder = scratch("outside")?;
    let done = hil(&folder, &[])?;
    fs::remove_dir_all(&folder)?;
    assert_eq!(done.status.code(), Some(2));
    let said = String::from_utf8(done.stderr)?;
    assert!(said.starts_with("error: no serial suite in "), "{said}");
    assert!(said.contains("--suite"), "{said}");
    Ok(())
}

#[test]
fn a_folder_without_a_suite_is_refused_by_its_name() -> Result<(), Box<dyn Error>> {
    let folder = scratch("named")?;
    let done = hil(&folder, &["--suite", "nothing-here"])?;
    fs::remove_dir_all(&folder)?;
    assert_eq!(done.status.code(), Some(2));
    assert!(String::from_utf8(done.stderr)?.starts_with("error: nothing-here: no serial suite"));
    Ok(())
}

#[test]
fn a_python_that_isnt_there_is_refused_by_its_name() -> Result<(), Box<dyn Error>> {
    let done = hil(Path::new(env!("CARGO_MANIFEST_DIR")), &["--python", "no-such-python"])?;
    assert_eq!(done.status.code(), Some(2));
    let said = String::from_utf8(done.stderr)?;
    assert!(said.starts_with("error: cannot start no-such-python"), "{said}");
    Ok(())
}
