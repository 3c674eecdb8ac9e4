//! `cargo xtask bench stacking [--large] [--peers]`: how long planning takes, from a model file to a checked plan on disk.

use super::blob;
use super::hard;
use super::measure::{Bench, HEAD};
use super::peers;
use crate::tools::{self, cargo};
use anyhow::{Context, Result, bail};
use std::{env, fs, thread};

/// Models of the repository with some 4,000 panels, and the numbers of piles that they are stacked into.
const MODELS: [&str; 3] = ["fish4000", "bird4000", "vehicle4000"];
const MODEL_PILES: [usize; 7] = [2, 4, 8, 10, 16, 20, 40];
/// Solids made here: panels, numbers of piles, runs of which the middle one counts.
const SOLIDS: [(usize, &[usize], usize); 3] = [(1_000, &[4], 5), (10_000, &[4], 5), (100_000, &[4, 16], 5)];
/// The same with `--large`.
const LARGE: (usize, &[usize], usize) = (1_000_000, &[4, 16, 64], 1);
/// Runs of a model of the repository.
const RUNS: usize = 5;

/// Builds, makes the models and prints the tables.
pub(crate) fn run(options: &[String]) -> Result<()> {
    let (mut large, mut beside_peers) = (false, false);
    for option in options {
        match option.as_str() {
            "--large" => large = true,
            "--peers" => beside_peers = true,
            _ => bail!("unknown option `{option}` of `bench stacking`, expected --large or --peers"),
        }
    }
    tools::run(cargo().args(["build", "--release", "--package", "zygote-cli"]).current_dir(tools::root()))?;
    let place = tools::root().join("target/bench");
    fs::create_dir_all(&place).with_context(|| format!("{} cannot be made", place.display()))?;
    let program = tools::root().join("target/release/zygote").with_extension(env::consts::EXE_EXTENSION);
    let bench = Bench { program, place };
    println!("\nMachine: {}\n", machine());
    println!("{HEAD}");
    for name in MODELS {
        let model = tools::root().join("models").join(name).with_extension("txt");
        let panels = panels_of(&fs::read_to_string(&model).with_context(|| model.display().to_string())?);
        for piles in MODEL_PILES {
            bench.row(name, &model, panels, piles, RUNS)?;
        }
    }
    let solids = SOLIDS.iter().chain(large.then_some(&LARGE));
    for (panels, piles, runs) in solids {
        let model = bench.place.join(format!("solid{panels}.txt"));
        fs::write(&model, blob::voxel_text(*panels)?).with_context(|| model.display().to_string())?;
        for count in *piles {
            bench.row("ellipsoids", &model, *panels, *count, *runs)?;
        }
    }
    for (name, solid) in hard::solids() {
        let model = bench.place.join("hard.txt");
        fs::write(&model, solid.text()).with_context(|| model.display().to_string())?;
        bench.row(name, &model, solid.panels(), 1, RUNS)?;
    }
    println!("\nRandom solids of 20 to 400 voxels:\n");
    let mut campaign = cargo();
    campaign.args(["run", "--quiet", "--release", "--package", "zygote-stacking", "--example", "solids"]);
    print!("{}", tools::output_of(campaign.current_dir(tools::root()))?);
    if beside_peers { peers::run(&bench) } else { Ok(()) }
}

/// Cores, and what they are called where the system says so.
pub(super) fn machine() -> String {
    let cores = thread::available_parallelism().map_or(0, usize::from);
    let told = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = told.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    format!("{cores} cores, {}", name.map_or("unknown processor", |(_, name)| name.trim()))
}

/// Squares between solid and empty of a voxel text.
pub(super) fn panels_of(text: &str) -> usize {
    let slices: Vec<Vec<&[u8]>> = text
        .split("\n\n")
        .map(|slice| slice.lines().filter(|row| !row.is_empty()).map(str::as_bytes).collect())
        .collect();
    let solid = |x: usize, y: usize, z: usize| {
        slices.get(z).and_then(|slice: &Vec<&[u8]>| slice.get(y)?.get(x)) == Some(&b'#')
    };
    let (mut voxels, mut touching) = (0, 0);
    for (z, slice) in slices.iter().enumerate() {
        for (y, row) in slice.iter().enumerate() {
            for x in (0..row.len()).filter(|x| solid(*x, y, z)) {
                voxels += 1;
                let beyond = [solid(x + 1, y, z), solid(x, y + 1, z), solid(x, y, z + 1)];
                touching += beyond.into_iter().filter(|solid| *solid).count();
            }
        }
    }
    6 * voxels - 2 * touching
}
