//! Runs every part, each under a heading, and ends with a table. A part that fails doesn't keep the others
//! from running.

use anyhow::{Result, bail};
use std::time::Instant;

/// One thing that has to pass.
pub(crate) struct Part {
    /// Its verb on the command line.
    pub(crate) verb: &'static str,
    /// What it does, for the usage text and the heading.
    pub(crate) about: &'static str,
    /// Does it.
    pub(crate) run: fn() -> Result<()>,
}

/// Runs all `parts` in order.
///
/// # Errors
/// Names the parts that failed.
pub(crate) fn run_all(parts: &[Part]) -> Result<()> {
    let mut rows = Vec::new();
    let mut failed = Vec::new();
    for part in parts {
        println!("\n=== {}: {}\n", part.verb, part.about);
        let start = Instant::now();
        let result = (part.run)();
        if let Err(error) = &result {
            println!("\n{} failed: {error:#}", part.verb);
            failed.push(part.verb);
        }
        let outcome = if result.is_ok() { "ok" } else { "FAILED" };
        rows.push(format!("{:<10} {:>7.1} s  {outcome}", part.verb, start.elapsed().as_secs_f64()));
    }
    println!("\n=== summary\n\n{}", rows.join("\n"));
    if failed.is_empty() { Ok(()) } else { bail!("failed: {}", failed.join(", ")) }
}

#[cfg(test)]
mod checks {
    use super::*;

    #[test]
    fn every_part_runs_and_the_failed_ones_are_named() {
        let part = |verb, run| Part { verb, about: "", run };
        let parts = [part("one", || bail!("broken")), part("two", || Ok(())), part("three", || bail!("too"))];
        assert_eq!(run_all(&parts).unwrap_err().to_string(), "failed: one, three");
        assert!(run_all(&parts[1..2]).is_ok());
    }
}
