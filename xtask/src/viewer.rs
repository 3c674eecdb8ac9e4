//! `cargo xtask page`, `cargo xtask viewer`: the page of `zygote view`, built into one file, and tested in a real browser.

use crate::tools;
use anyhow::{Context, Result, ensure};
use std::env;
use std::path::PathBuf;
use std::process::Command;

/// Node older than this can't run the build.
const OLDEST_NODE: u32 = 18;

/// Browsers that will do, best first.
const BROWSERS: &[&str] = &["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Builds the page into `host/viewer/page`, from where the build of `zygote` takes it.
pub(crate) fn page() -> Result<()> {
    packages()?;
    tools::run(npm()?.args(["run", "--silent", "build"]))
}

/// Tests the page: its parts by themselves, then the page of the program in a browser.
pub(crate) fn test() -> Result<()> {
    packages()?;
    if !folder().join("page/index.html").is_file() {
        page()?;
    }
    tools::run(npm()?.args(["run", "--silent", "test"]))?;
    let browser = browser()?;
    let zygote = tools::built("zygote")?;
    tools::run(
        npm()?.args(["run", "--silent", "browser"]).env("ZYGOTE", zygote).env("BROWSER_PROGRAM", browser),
    )
}

/// `cargo xtask viewer [--test]`: the page, and with the option its tests.
pub(crate) fn run(options: &[String]) -> Result<()> {
    let options: Vec<&str> = options.iter().map(String::as_str).collect();
    match options.as_slice() {
        [] => {
            page()?;
            println!("The page is built; the next build of zygote embeds it.");
            Ok(())
        }
        ["--test"] => page().and_then(|()| test()),
        _ => anyhow::bail!("expected `cargo xtask viewer` or `cargo xtask viewer --test`, found {options:?}"),
    }
}

fn folder() -> PathBuf {
    tools::root().join("host/viewer")
}

/// What the lock file names, unless it is there already.
fn packages() -> Result<()> {
    // npm leaves a copy of the lock file behind, newer than the lock file where all is in place.
    let there = || {
        let time = |path: &str| folder().join(path).metadata()?.modified();
        time("node_modules/.package-lock.json")
            .and_then(|had| Ok(had >= time("package-lock.json")?))
            .unwrap_or(false)
    };
    if there() {
        return Ok(());
    }
    // Not `npm ci`, which wants an entry for every platform that a package has an optional part for, be it in the registry or not.
    // What is installed is what the lock file says, to the checksum.
    tools::run(npm()?.args(["install", "--no-audit", "--no-fund", "--loglevel=error"]))?;
    ensure!(there(), "npm left no packages in {}", folder().join("node_modules").display());
    Ok(())
}

/// npm, in the folder of the page.
fn npm() -> Result<Command> {
    let answers = |program: &str| tools::output_of(Command::new(program).arg("--version")).ok();
    if answers("node").is_none() || answers("npm").is_none() {
        tools::apt_install(&["nodejs", "npm"])?;
    }
    let version = answers("node").context("no Node, which builds the viewer's page")?;
    let major = version.trim().trim_start_matches('v').split('.').next().and_then(|major| major.parse().ok());
    ensure!(
        major.is_some_and(|major: u32| major >= OLDEST_NODE),
        "Node {OLDEST_NODE} or newer builds the viewer's page, found {}",
        version.trim()
    );
    let mut npm = tools::command("npm");
    npm.current_dir(folder());
    Ok(npm)
}

/// A Chromium, installed where none is found.
fn browser() -> Result<PathBuf> {
    let found = || {
        let path = env::var_os("PATH").unwrap_or_default();
        let folders: Vec<_> = env::split_paths(&path).collect();
        let places = BROWSERS.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
        places.map(|place| place.with_extension(env::consts::EXE_EXTENSION)).find(|place| place.is_file())
    };
    if let Some(browser) = found() {
        return Ok(browser);
    }
    tools::apt_install(&["chromium"])?;
    found().context("no Chromium to test the viewer's page in")
}
