//! `cargo xtask tutorial`: every command of the book's tutorial, run as it stands there, in a folder of its own.
//!
//! In blocks marked `console`, a line after `$ ` is a command and has to end well; the lines behind it are what it prints: each has to come, in
//! that order, though others may stand between. `…` in a line stands for anything.

use crate::tools;
use anyhow::{Context, Result, bail, ensure};
use std::fs;
use std::path::Path;
use std::process::Command;

const PAGE: &str = "docs/src/tutorial.md";

/// A command of the page.
#[derive(Debug, PartialEq, Eq)]
struct Step {
    /// Line of the page.
    line: usize,
    words: Vec<String>,
    /// What it prints.
    shown: Vec<String>,
}

/// Runs them all.
pub(crate) fn run() -> Result<()> {
    let page = fs::read_to_string(tools::root().join(PAGE)).with_context(|| format!("cannot read {PAGE}"))?;
    let steps = steps(&page);
    ensure!(!steps.is_empty(), "{PAGE} has no command");
    let zygote = tools::built("zygote")?;
    let place = tools::root().join("target/tutorial");
    if place.exists() {
        fs::remove_dir_all(&place).with_context(|| format!("{} cannot be emptied", place.display()))?;
    }
    for folder in ["models", "sim/scenarios"] {
        copy(&tools::root().join(folder), &place.join(folder))?;
    }
    for step in &steps {
        follow(step, &zygote, &place).with_context(|| format!("{PAGE}:{}", step.line))?;
    }
    Ok(())
}

fn copy(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to).with_context(|| format!("{} cannot be made", to.display()))?;
    for entry in fs::read_dir(from).with_context(|| format!("cannot list {}", from.display()))? {
        let (path, name) = entry.map(|entry| (entry.path(), entry.file_name()))?;
        if path.is_dir() {
            copy(&path, &to.join(name))?;
        } else {
            fs::copy(&path, to.join(name)).with_context(|| format!("cannot copy {}", path.display()))?;
        }
    }
    Ok(())
}

fn follow(step: &Step, zygote: &Path, place: &Path) -> Result<()> {
    let line = step.words.join(" ");
    println!("$ {line}");
    let [program, arguments @ ..] = step.words.as_slice() else { bail!("an empty command") };
    // Nothing else is needed, and a page shouldn't run just anything.
    let program = match program.as_str() {
        "zygote" => zygote.as_os_str(),
        "cp" => "cp".as_ref(),
        other => bail!("expected zygote or cp, found `{other}`"),
    };
    let output = Command::new(program)
        .args(arguments)
        .current_dir(place)
        .env_remove("NO_COLOR")
        .output()
        .with_context(|| format!("cannot start `{line}`"))?;
    let said =
        [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
    ensure!(output.status.success(), "`{line}` ended with {}:\n{said}", output.status);
    match missing(&step.shown, &said) {
        None => Ok(()),
        Some(missing) => bail!("`{line}` doesn't print, in its place:\n{missing}\nbut:\n{said}"),
    }
}

/// The first of the shown lines that doesn't come.
fn missing<'a>(shown: &'a [String], said: &str) -> Option<&'a str> {
    let mut said = said.lines();
    shown.iter().find(|line| !said.any(|said| is_like(said.trim_end(), line))).map(String::as_str)
}

/// Whether a line is the shown one, whose `…` stand for anything.
fn is_like(said: &str, shown: &str) -> bool {
    let mut parts = shown.split('…');
    let Some(mut rest) = parts.next().and_then(|first| said.strip_prefix(first)) else { return false };
    let mut parts = parts.peekable();
    if parts.peek().is_none() {
        return rest.is_empty();
    }
    while let Some(part) = parts.next() {
        if parts.peek().is_none() {
            return rest.ends_with(part);
        }
        let Some((_, after)) = rest.split_once(part) else { return false };
        rest = after;
    }
    true
}

/// The commands of a page. A word in double quotes may have spaces; what stands behind `  #` is for people.
fn steps(page: &str) -> Vec<Step> {
    let (mut steps, mut inside): (Vec<Step>, bool) = (Vec::new(), false);
    for (number, line) in page.lines().enumerate() {
        if line.starts_with("```") {
            inside = line == "```console";
        } else if !inside {
        } else if let Some(command) = line.strip_prefix("$ ") {
            let command = command.split_once("  #").map_or(command, |(command, _)| command);
            let words = command.split('"').enumerate().flat_map(|(place, part)| {
                if place % 2 == 1 {
                    vec![part.to_owned()]
                } else {
                    part.split_whitespace().map(str::to_owned).collect()
                }
            });
            steps.push(Step { line: number + 1, words: words.collect(), shown: Vec::new() });
        } else if let (Some(step), false) = (steps.last_mut(), line.trim().is_empty() || line.trim() == "…")
        {
            step.shown.push(line.trim_end().to_owned());
        }
    }
    steps
}

#[cfg(test)]
mod checks {
    use super::*;

    #[test]
    fn commands_and_what_they_print_are_read_from_console_blocks_alone() {
        let page = "text\n```console\n$ zygote plan a.txt -o \"b c\"  # why\nfine\n…\n\n$ cp a b\n```\n```sh\n$ rm x\n```\n";
        let step = |line, words: &[&str], shown: &[&str]| {
            let owned = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect();
            Step { line, words: owned(words), shown: owned(shown) }
        };
        let expected =
            [step(3, &["zygote", "plan", "a.txt", "-o", "b c"], &["fine"]), step(7, &["cp", "a", "b"], &[])];
        assert_eq!(steps(page), expected);
    }

    #[test]
    fn what_is_shown_comes_in_order_with_anything_for_an_ellipsis() {
        let shown = |lines: &[&str]| lines.iter().map(|line| (*line).to_owned()).collect::<Vec<_>>();
        let said = "one 1\ntwo 2 of 3\nthree\n";
        assert_eq!(missing(&shown(&["one 1", "two … of …", "three"]), said), None);
        assert_eq!(missing(&shown(&["…ee"]), said), None);
        assert_eq!(missing(&shown(&["two …", "one 1"]), said), Some("one 1"));
        assert_eq!(missing(&shown(&["two"]), said), Some("two"), "a line is shown whole");
        assert_eq!(missing(&shown(&["two … 4"]), said), Some("two … 4"));
    }
}
