//! `cargo xtask bench motion [--large] [--peers] [--solids N]`: which shapes open without a collision, how long it takes to find
//! and to check that, and whether others see the same.

use super::measure::{Bench, Run};
use super::stacking::machine;
use crate::python;
use crate::tools::{self, cargo};
use anyhow::{Context, Result, bail, ensure};
use serde_json::Value;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::{env, fs};

const MODELS: [(&str, usize); 6] =
    [("i14", 14), ("l14", 14), ("fish92", 92), ("vehicle92", 92), ("airplane92", 92), ("fish144", 144)];
const LARGE: [(&str, usize); 3] = [("fish4000", 4_000), ("bird4000", 4_000), ("vehicle4000", 4_000)];
const PILES: [usize; 3] = [1, 2, 4];
/// Runs of which the middle one counts.
const RUNS: usize = 5;
/// The thickness that goes with panels that are thick, in panel lengths.
const THICK: &str = "0.05";
/// Plans tried until one opens freely with thick panels.
const TRIES: &str = "40";
/// Random solids, unless told otherwise: about a minute.
const SOLIDS: &str = "100";
/// Degrees from pose to pose for others.
const POSE_STEP: &str = "2";
/// A heater for every hinge, and current for all: nothing waits but for the motion.
const RIG: &str = "version = 1\n[rig]\nid = \"bench\"\n[supply]\nvoltage = \"5 V\"\nlimit = \"800 A\"\nresistance = \"0 ohm\"\n\
                   [hinges]\ndefault = \"sma\"\n[[node]]\nname = \"all\"\nheaters = 4000\n";

const HEAD: &str = "| shape | N | K | plan, CPU s | schedule, CPU s | check, CPU s | certified | waits | clearance proved | \
                    sampled |\n|---|---|---|---|---|---|---|---|---|---|";

/// What a verb of the program took and said, and where the plan is.
struct Motion<'a> {
    bench: &'a Bench,
    rig: PathBuf,
    plan: PathBuf,
}

/// Builds, and prints the tables.
pub(crate) fn run(options: &[String]) -> Result<()> {
    let (mut large, mut beside_peers, mut solids) = (false, false, SOLIDS);
    let mut options = options.iter().map(String::as_str);
    while let Some(option) = options.next() {
        match option {
            "--large" => large = true,
            "--peers" => beside_peers = true,
            "--solids" => solids = options.next().context("--solids: expected a number after it")?,
            _ => {
                bail!("unknown option `{option}` of `bench motion`, expected --large, --peers or --solids N")
            }
        }
    }
    tools::run(cargo().args(["build", "--release", "--package", "zygote-cli"]).current_dir(tools::root()))?;
    let place = tools::root().join("target/bench/motion");
    if place.exists() {
        fs::remove_dir_all(&place).with_context(|| format!("{} cannot be emptied", place.display()))?;
    }
    let poses = place.join("poses");
    fs::create_dir_all(&poses).with_context(|| format!("{} cannot be made", place.display()))?;
    let rig = place.join("rig.toml");
    fs::write(&rig, RIG).with_context(|| format!("{} cannot be written", rig.display()))?;
    let program = tools::root().join("target/release/zygote").with_extension(env::consts::EXE_EXTENSION);
    let bench = Bench { program, place };
    let motion =
        |name: String| Motion { bench: &bench, rig: rig.clone(), plan: bench.place.join(name + ".fold") };
    let mut plans = Vec::new();

    println!("\nMachine: {}, load {}\n\nIdeal panels, `--free ideal`:\n\n{HEAD}", machine(), load());
    for (name, panels) in MODELS {
        for piles in PILES.into_iter().filter(|piles| panels % piles == 0) {
            let motion = motion(format!("{name}-{piles}"));
            motion.free_row(name, panels, piles, &["--free", "ideal"], RUNS)?;
            plans.push(motion.plan);
        }
    }
    println!("\nThe same in wider rests, `--bridges least` and `most`, plan of seed 0:\n");
    println!("| shape | N | K | bridges | schedule, CPU s | certified | collisions | deepest | sampled |");
    println!("|---|---|---|---|---|---|---|---|---|");
    for (name, panels) in MODELS {
        for piles in PILES.into_iter().filter(|piles| panels % piles == 0 && *piles > 1) {
            for bridges in ["least", "most"] {
                let motion = motion(format!("{name}-{piles}-{bridges}"));
                motion.wide_row(name, panels, piles, bridges)?;
                plans.push(motion.plan);
            }
        }
    }
    println!("\nPanels a twentieth thick, K = 2, `--free thick`, at most {TRIES} plans:\n");
    println!(
        "| shape | N | plans tried | plan, CPU s | schedule, CPU s | check, CPU s | certified | waits | clearance proved | sampled |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let mut blocked = Vec::new();
    for (name, panels) in MODELS {
        let motion = motion(format!("{name}-2-thick"));
        blocked.extend(motion.thick_row(name, panels)?);
        plans.push(motion.plan);
    }
    for list in blocked {
        println!("\n{list}");
    }
    if large {
        println!("\n4,000 panels, `--free ideal`, one run:\n\n{HEAD}");
        for (name, panels) in LARGE {
            motion(format!("{name}-4")).free_row(name, panels, 4, &["--free", "ideal"], 1)?;
        }
    }
    println!("\nOne check of a full motion, of five the middle one:\n");
    let of_92 = plans.iter().filter(|plan| plan.to_string_lossy().contains("92-"));
    example("motion_times", [OsStr::new("ideal")].into_iter().chain(of_92.map(|plan| plan.as_os_str())))?;
    println!("\nRandom solids:\n");
    let small = bench.place.join("solids");
    fs::create_dir_all(&small).with_context(|| format!("{} cannot be made", small.display()))?;
    example("motion_campaign", [OsStr::new(solids), small.as_os_str()])?;
    if !beside_peers {
        return Ok(());
    }
    plans.extend(folds(&small)?);
    peers(&poses, &plans)
}

/// FCL's verdicts beside ours, of plans in the order of their schedules.
fn peers(poses: &Path, plans: &[PathBuf]) -> Result<()> {
    // In the wrong order there is more to see.
    let of_2 = plans.iter().filter(|plan| {
        let stem = plan.file_stem().unwrap_or_default().to_string_lossy();
        !stem.starts_with("solid") && (stem.ends_with("-2") || stem.ends_with("-thick"))
    });
    for (way, plans) in [("forwards", plans.iter().collect()), ("backwards", of_2.collect::<Vec<_>>())] {
        let arguments = [poses.as_os_str(), OsStr::new(POSE_STEP), OsStr::new(way)];
        let arguments = arguments.into_iter().chain(plans.iter().map(|plan| plan.as_os_str()));
        tools::output_of(&mut example_of("motion_poses", arguments))?;
    }
    let scripts = tools::root().join("xtask/peers");
    let python =
        python::with_requirements(&tools::root().join("target/venv-motions"), &scripts.join("motions.txt"))?;
    tools::run(tools::command(python).arg(scripts.join("motions.py")).arg(poses))
}

/// The plans in a folder, by name.
fn folds(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder).with_context(|| format!("{} cannot be read", folder.display()))?;
    let mut found = Vec::new();
    for entry in entries {
        found.push(entry.with_context(|| format!("{} cannot be read", folder.display()))?.path());
    }
    found.sort();
    Ok(found)
}

fn example_of<'a>(name: &str, arguments: impl Iterator<Item = &'a OsStr>) -> std::process::Command {
    let mut example = cargo();
    example.args(["run", "--quiet", "--release", "--package", "zygote-deployment", "--example", name, "--"]);
    example.args(arguments).current_dir(tools::root());
    example
}

/// Prints what an example does.
fn example<'a>(name: &str, arguments: impl IntoIterator<Item = &'a OsStr>) -> Result<()> {
    let mut example = example_of(name, arguments.into_iter());
    let status = example.status().with_context(|| format!("cannot start the example `{name}`"))?;
    ensure!(status.success(), "the example `{name}` ended with {status}");
    Ok(())
}

/// Processes that wanted a core in the last minute, where the system says so.
fn load() -> String {
    let told = fs::read_to_string("/proc/loadavg").unwrap_or_default();
    told.split(' ').next().filter(|load| !load.is_empty()).unwrap_or("unknown").to_owned()
}

fn processor_seconds(run: &Run) -> f64 {
    run.used.as_ref().map_or(run.seconds, |used| used.processor_seconds)
}

fn median(mut seconds: Vec<f64>) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds.get(seconds.len() / 2).copied().unwrap_or(f64::NAN)
}

/// What the schedule in a plan says of its motion.
struct Proved {
    waits: usize,
    clearance: f64,
    collisions: Vec<String>,
}

impl Proved {
    fn of(plan: &Path) -> Result<Self> {
        let read = || -> Result<Value> { Ok(serde_json::from_slice(&fs::read(plan)?)?) };
        let file = read().with_context(|| plan.display().to_string())?;
        let schedule = &file["zygote:schedule"];
        let missing = || format!("{}: no schedule with a certificate", plan.display());
        let steps = schedule["steps"].as_array().with_context(missing)?;
        let certificate = &schedule["certificate"];
        let lines = certificate["collisions"].as_array().map_or(&[][..], Vec::as_slice);
        Ok(Self {
            waits: steps.iter().filter_map(|step| step["after"].as_array()).map(Vec::len).sum(),
            clearance: certificate["clearance"].as_f64().with_context(missing)?,
            collisions: lines.iter().filter_map(Value::as_str).map(str::to_owned).collect(),
        })
    }

    /// Depth of the deepest collision, from its words.
    fn deepest(&self) -> f64 {
        let depth = |line: &String| line.rsplit_once(", ")?.1.split(' ').next()?.parse::<f64>().ok();
        self.collisions.iter().filter_map(depth).fold(0.0, f64::max)
    }
}

/// What `zygote check --motion` saw.
struct Seen {
    run: Run,
    /// The least clearance, where nothing collides.
    clearance: Option<String>,
}

impl Seen {
    fn collisions(&self) -> &str {
        after(&self.run.complaint, ".fold: ").split(' ').next().unwrap_or_default()
    }
}

/// What follows a label.
fn after<'a>(told: &'a str, label: &str) -> &'a str {
    told.split_once(label).map_or("", |(_, rest)| rest)
}

impl Motion<'_> {
    /// Runs a verb of the program.
    fn verb(&self, arguments: &[&OsStr]) -> Result<Run> {
        self.bench.run(arguments)
    }

    fn plan(&self, name: &str, piles: usize, options: &[&str]) -> Result<Run> {
        let model: OsString = tools::root().join("models").join(name).with_extension("txt").into();
        let piles = piles.to_string();
        let mut arguments = vec![OsStr::new("plan"), &model, OsStr::new("--piles"), OsStr::new(&piles)];
        arguments.extend(options.iter().map(OsStr::new));
        arguments.extend([OsStr::new("--output"), self.plan.as_os_str()]);
        self.verb(&arguments)
    }

    fn schedule(&self, options: &[&str]) -> Result<Run> {
        let mut arguments =
            vec![OsStr::new("schedule"), self.plan.as_os_str(), OsStr::new("--rig"), self.rig.as_os_str()];
        arguments.extend(options.iter().map(OsStr::new));
        let run = self.verb(&arguments)?;
        ensure!(run.code.is_some_and(|code| code < 2), "{}: {}", self.plan.display(), run.complaint);
        Ok(run)
    }

    /// Looks at the motion by sampling, with the program's independent checker.
    fn seen(&self) -> Result<Seen> {
        let run = self.verb(&[OsStr::new("check"), self.plan.as_os_str(), OsStr::new("--motion")])?;
        let clearance = match run.code {
            Some(0) => after(&run.said, ", clearance ").split(' ').next().map(str::to_owned),
            Some(1) => None,
            _ => bail!("{}: {}", self.plan.display(), run.complaint),
        };
        Ok(Seen { run, clearance })
    }

    /// A motion that was proved free must look free.
    fn assert_seen_free(&self, seen: &Seen) -> Result<()> {
        let collisions = seen.collisions();
        ensure!(
            seen.clearance.is_some(),
            "{}: certified free, but seen: {collisions} collisions",
            self.plan.display()
        );
        Ok(())
    }

    /// Plans, schedules and checks so many times, and prints the middle one.
    fn free_row(&self, name: &str, panels: usize, piles: usize, free: &[&str], runs: usize) -> Result<()> {
        let (mut planned, mut scheduled, mut checked) = (Vec::new(), Vec::new(), Vec::new());
        let mut last = None;
        for _ in 0..runs {
            let run = self.plan(name, piles, free)?;
            planned.push(processor_seconds(&run));
            if run.code != Some(0) {
                println!(
                    "| {name} | {panels} | {piles} | {:.2} | | | NO: {} | | | |",
                    median(planned),
                    run.complaint
                );
                return Ok(());
            }
            let run = self.schedule(&[])?;
            ensure!(
                run.code == Some(0),
                "{name}, K = {piles}: a free plan without a schedule: {}",
                run.complaint
            );
            scheduled.push(processor_seconds(&run));
            let seen = self.seen()?;
            checked.push(processor_seconds(&seen.run));
            last = Some(seen);
        }
        let [planned, scheduled, checked] = [planned, scheduled, checked].map(median);
        let proved = Proved::of(&self.plan)?;
        let seen = last.context("no run")?;
        println!(
            "| {name} | {panels} | {piles} | {planned:.2} | {scheduled:.2} | {checked:.2} | yes | {} | {:.2e} | {} |",
            proved.waits,
            proved.clearance,
            seen.clearance.as_deref().unwrap_or("COLLIDES")
        );
        self.assert_seen_free(&seen)
    }

    /// Schedules a plan with wide rests, come what may, and prints what it comes to.
    fn wide_row(&self, name: &str, panels: usize, piles: usize, bridges: &str) -> Result<()> {
        let planned = self.plan(name, piles, &["--bridges", bridges])?;
        ensure!(planned.code == Some(0), "{name}, K = {piles}: {}", planned.complaint);
        let run = self.schedule(&["--allow-collisions"])?;
        let proved = Proved::of(&self.plan)?;
        let seen = self.seen()?;
        let free = proved.collisions.is_empty();
        println!(
            "| {name} | {panels} | {piles} | {bridges} | {:.2} | {} | {} | {:.1e} | {} |",
            processor_seconds(&run),
            if free { "yes" } else { "no" },
            proved.collisions.len(),
            proved.deepest(),
            if seen.clearance.is_some() {
                "free".to_owned()
            } else {
                format!("{} collisions", seen.collisions())
            }
        );
        if free { self.assert_seen_free(&seen) } else { Ok(()) }
    }

    /// Looks for a plan that opens freely with thick panels; where none is found, gives the collisions of the best one.
    fn thick_row(&self, name: &str, panels: usize) -> Result<Option<String>> {
        let thick = ["--thickness", THICK];
        let run = self.plan(name, 2, &[&thick[..], &["--free", "thick", "--tries", TRIES]].concat())?;
        let planned = processor_seconds(&run);
        let found = run.code == Some(0);
        let mut tried = TRIES.to_owned();
        if found {
            after(&run.said, "; plan ").split(' ').next().unwrap_or_default().clone_into(&mut tried);
        } else {
            let seed: String =
                after(&run.complaint, "(seed ").chars().take_while(char::is_ascii_digit).collect();
            ensure!(!seed.is_empty(), "{name}: {}", run.complaint);
            let run = self.plan(name, 2, &[&thick[..], &["--bridges", "base", "--seed", &seed]].concat())?;
            ensure!(run.code == Some(0), "{name}: {}", run.complaint);
        }
        let run = self.schedule(&["--panels", "thick", "--allow-collisions"])?;
        let proved = Proved::of(&self.plan)?;
        let seen = self.seen()?;
        let free = proved.collisions.is_empty();
        println!(
            "| {name} | {panels} | {tried} | {planned:.2} | {:.2} | {:.2} | {} | {} | {:.2e} | {} |",
            processor_seconds(&run),
            processor_seconds(&seen.run),
            if free { "yes".to_owned() } else { format!("no: {} collisions", proved.collisions.len()) },
            proved.waits,
            proved.clearance,
            seen.clearance
                .as_deref()
                .map_or_else(|| format!("{} collisions", seen.collisions()), str::to_owned)
        );
        ensure!(free || !found, "{name}: a free plan whose schedule isn't");
        if free {
            self.assert_seen_free(&seen)?;
            return Ok(None);
        }
        Ok(Some(format!(
            "{name}, {panels} panels, the least bad order:\n\n- {}",
            proved.collisions.join("\n- ")
        )))
    }
}
