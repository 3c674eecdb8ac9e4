//! Running other programs, and getting hold of those that are missing.

use anyhow::{Context, Result, bail, ensure};
use std::{
    env,
    path::{Path, PathBuf},
    process::Command,
};

/// The repository.
pub(crate) fn root() -> &'static Path {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here)
}

/// The cargo that started this program.
pub(crate) fn cargo() -> Command {
    command(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
}

/// `program`, to be run in the repository.
pub(crate) fn command(program: impl AsRef<std::ffi::OsStr>) -> Command {
    let mut command = Command::new(program);
    command.current_dir(root());
    command
}

/// Runs `command` to its end.
///
/// # Errors
/// When it doesn't start, or doesn't end well.
pub(crate) fn run(command: &mut Command) -> Result<()> {
    let line = shown(command);
    println!("$ {line}");
    let status = command.status().with_context(|| format!("cannot start `{line}`"))?;
    ensure!(status.success(), "`{line}` ended with {status}");
    Ok(())
}

/// What `command` writes on its standard output.
///
/// # Errors
/// When it doesn't start, doesn't end well, or writes something that isn't UTF-8.
pub(crate) fn output_of(command: &mut Command) -> Result<String> {
    let line = shown(command);
    let output = command.output().with_context(|| format!("cannot start `{line}`"))?;
    let complaint = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "`{line}` ended with {}: {}", output.status, complaint.trim());
    String::from_utf8(output.stdout).with_context(|| format!("`{line}` didn't write UTF-8"))
}

/// A program from crates.io: the one on the PATH, or else one built once into `target/tools`.
///
/// # Errors
/// When it is missing and cannot be built.
pub(crate) fn from_crates_io(name: &str, version: &str, install_options: &[&str]) -> Result<PathBuf> {
    // Called by itself, a subcommand of cargo may want the word that cargo would give it.
    let word = name.strip_prefix("cargo-");
    let is_there = |program: &Path| {
        let tells = |command: &mut Command| command.output().is_ok_and(|told| told.status.success());
        tells(Command::new(program).arg("--version"))
            || word.is_some_and(|word| tells(Command::new(program).args([word, "--version"])))
    };
    if is_there(Path::new(name)) {
        return Ok(name.into());
    }
    let tools = root().join("target/tools");
    let built = tools.join("bin").join(name).with_extension(env::consts::EXE_EXTENSION);
    if !is_there(&built) {
        let mut install = cargo();
        install.args(["install", "--locked", "--quiet", name, "--version", version, "--root"]).arg(&tools);
        run(install.args(install_options))
            .with_context(|| format!("{name} is missing and cannot be built"))?;
    }
    Ok(built)
}

/// A program of this workspace, built along with all tests: any smaller choice of packages gives some dependencies other features,
/// and has all that rests on them built a second time.
///
/// # Errors
/// When the workspace doesn't build.
pub(crate) fn built(program: &str) -> Result<PathBuf> {
    let target = root().join("target");
    run(cargo()
        .args(["build", "--workspace", "--bins", "--tests", "--target-dir"])
        .arg(&target)
        .current_dir(root()))?;
    Ok(target.join("debug").join(program).with_extension(env::consts::EXE_EXTENSION))
}

/// Installs Debian packages where that is possible.
///
/// # Errors
/// Names the packages where it isn't.
pub(crate) fn apt_install(packages: &[&str]) -> Result<()> {
    let names = packages.join(" ");
    let is_root = output_of(Command::new("id").arg("-u")).is_ok_and(|id| id.trim() == "0");
    if !is_root || Command::new("apt-get").arg("--version").output().is_err() {
        bail!("missing Debian packages, install them by hand: {names}");
    }
    run(command("apt-get").args(["update", "--quiet"]))?;
    run(command("apt-get")
        .env("DEBIAN_FRONTEND", "noninteractive")
        .args(["install", "--yes", "--quiet", "--no-install-recommends"])
        .args(packages))
    .with_context(|| format!("cannot install the Debian packages {names}"))
}

fn shown(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ")
}
