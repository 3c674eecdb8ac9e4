//! `zygote export`: a plan as files for a workshop and for other programs. All of what was asked for is written, or nothing.

mod sizes;

use crate::failure::{Failure, OrFail};
use crate::input;
use crate::output::{say, write_files};
use anyhow::{Context, anyhow};
use clap::{ArgGroup, Args};
use sizes::Sizes;
use std::path::{Path, PathBuf};
use std::{collections::BTreeSet, fs};
use zygote_deployment::{picture, scene};
use zygote_fabrication::{
    Assembly, Bill, Drives, Panel, Stack, assembly, crease_pattern, dxf, sheets, stl, svg,
};
use zygote_stacking::{Net, Plan};

/// Arguments of `zygote export`.
#[derive(Args)]
#[command(
    group(ArgGroup::new("what").required(true).multiple(true)),
    after_help = "--all writes plan.fold, zygote.stl, cut-*.svg and .dxf, bom.csv and .json, assembly.html, net.svg, crease.fold, deployment.glb and \
    target.glb; the folder is made if it isn't there. Sheets after the first are files of their own, numbered. Nothing is \
    written unless everything can be."
)]
pub(crate) struct Arguments {
    /// The plan
    #[arg(value_name = "PLAN.fold")]
    plan: PathBuf,
    /// Bodies to print: the stack, a gap between any two panels
    #[arg(long, value_name = "FILE.stl", group = "what")]
    stl: Option<PathBuf>,
    /// Panels to cut, with their numbers and hinges; .svg or .dxf
    #[arg(long, value_name = "FILE.svg", group = "what")]
    cut: Option<PathBuf>,
    /// Bill of materials; .csv, .json or .txt
    #[arg(long, value_name = "FILE.csv", group = "what")]
    bom: Option<PathBuf>,
    /// The coded sequence as pages to print, with pictures
    #[arg(long, value_name = "FILE.html", group = "what")]
    assembly: Option<PathBuf>,
    /// All panels flattened along their hinges
    #[arg(long, value_name = "FILE.svg", group = "what")]
    net: Option<PathBuf>,
    /// The same as a crease pattern, which origami programs fold into the shape
    #[arg(long, value_name = "FILE.fold", group = "what")]
    crease: Option<PathBuf>,
    /// The deployment as an animated scene, at the times of the plan's schedule; without one hinge after hinge, a second each
    #[arg(short = 'o', long, alias = "output", value_name = "FILE.glb", group = "what")]
    gltf: Option<PathBuf>,
    /// The shape alone as a scene at rest
    #[arg(long, value_name = "FILE.glb", group = "what")]
    target: Option<PathBuf>,
    /// All of these, into a folder
    #[arg(long, value_name = "DIR", group = "what")]
    all: Option<PathBuf>,
    /// Whose hinges the bill and the pages name
    #[arg(long, value_name = "RIG.toml")]
    rig: Option<PathBuf>,
    #[command(flatten)]
    sizes: Sizes,
}

/// A file to be, or several of one kind, and what the user reads of them.
struct Made {
    files: Vec<(PathBuf, Vec<u8>)>,
    told: String,
}

impl Made {
    fn one(path: PathBuf, bytes: Vec<u8>, told: impl Into<String>) -> Self {
        Self { files: vec![(path, bytes)], told: told.into() }
    }

    /// What the user reads.
    fn line(&self) -> String {
        let names: Vec<_> = self.files.iter().map(|(path, _)| path.display().to_string()).collect();
        let names = match names.as_slice() {
            [first, .., last] => format!("{first} to {last}"),
            _ => names.concat(),
        };
        let size: usize = self.files.iter().map(|(_, bytes)| bytes.len()).sum();
        format!("{names}: {} kB, {}", size.div_ceil(1000), self.told)
    }
}

/// What is made from.
struct Source<'a> {
    name: String,
    plan: &'a Plan,
    sizes: &'a Sizes,
    panel: Panel,
    drives: Option<Drives>,
}

/// Makes and writes all files.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let wanted = arguments.wanted()?;
    let name = arguments.plan.display().to_string();
    let plan = input::plan(&arguments.plan)?;
    let drives = match &arguments.rig {
        Some(path) => {
            let rig = input::rig(path)?;
            Some(Drives::of(&plan, &rig).with_context(|| path.display().to_string()).or_bad_input()?)
        }
        None => None,
    };
    let (panel, note) = arguments.sizes.panel(&plan);
    let source = Source { name, plan: &plan, sizes: &arguments.sizes, panel, drives };
    let each = wanted.iter().map(|(what, path)| source.make(*what, path));
    let mut made = each.collect::<Result<Vec<_>, _>>()?;
    if let Some(folder) = &arguments.all {
        let bytes = fs::read(&arguments.plan).with_context(|| source.name.clone()).or_bad_input()?;
        made.insert(0, Made::one(folder.join("plan.fold"), bytes, "the plan itself"));
    }
    let told: Vec<_> = made.iter().map(Made::line).collect();
    let files: Vec<_> = made.into_iter().flat_map(|made| made.files).collect();
    if let Some(twice) = twice(&files) {
        return Err(Failure::BadInput(anyhow!("{}: asked for twice", twice.display())));
    }
    write_files(arguments.all.as_deref(), &files)?;
    for line in told.into_iter().chain(note) {
        say(line);
    }
    Ok(())
}

/// A kind of file.
#[derive(Debug, Clone, Copy)]
enum What {
    Stl,
    CutSvg,
    CutDxf,
    BomCsv,
    BomJson,
    BomText,
    Assembly,
    Net,
    Crease,
    Gltf,
    Target,
}

impl Arguments {
    /// What is asked for and where it goes, each file with an ending that fits it.
    fn wanted(&self) -> Result<Vec<(What, PathBuf)>, Failure> {
        use What::{Assembly, BomCsv, BomJson, BomText, Crease, CutDxf, CutSvg, Gltf, Net, Stl, Target};
        let mut wanted = Vec::new();
        for (path, endings) in [
            (&self.stl, &[("stl", Stl)][..]),
            (&self.cut, &[("svg", CutSvg), ("dxf", CutDxf)]),
            (&self.bom, &[("csv", BomCsv), ("json", BomJson), ("txt", BomText)]),
            (&self.assembly, &[("html", Assembly)]),
            (&self.net, &[("svg", Net)]),
            (&self.crease, &[("fold", Crease)]),
            (&self.gltf, &[("glb", Gltf)]),
            (&self.target, &[("glb", Target)]),
        ] {
            let Some(path) = path else { continue };
            let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
            let Some((_, what)) = endings.iter().find(|(known, _)| known.eq_ignore_ascii_case(ending)) else {
                let known: Vec<_> = endings.iter().map(|(known, _)| format!(".{known}")).collect();
                let (path, known) = (path.display(), known.join(" or "));
                return Err(Failure::BadInput(anyhow!("{path}: expected a file that ends with {known}")));
            };
            wanted.push((*what, path.clone()));
        }
        if let Some(folder) = &self.all {
            for (what, name) in [
                (Stl, "zygote.stl"),
                (CutSvg, "cut.svg"),
                (CutDxf, "cut.dxf"),
                (BomCsv, "bom.csv"),
                (BomJson, "bom.json"),
                (Assembly, "assembly.html"),
                (Net, "net.svg"),
                (Crease, "crease.fold"),
                (Gltf, "deployment.glb"),
                (Target, "target.glb"),
            ] {
                wanted.push((what, folder.join(name)));
            }
        }
        Ok(wanted)
    }
}

/// A path that two files would have.
fn twice(files: &[(PathBuf, Vec<u8>)]) -> Option<&Path> {
    let mut seen = BTreeSet::new();
    files.iter().map(|(path, _)| path.as_path()).find(|path| !seen.insert(*path))
}

impl Source<'_> {
    fn make(&self, what: What, path: &Path) -> Result<Made, Failure> {
        let refused = || format!("{}: cannot be exported", self.name);
        let one = |bytes: Vec<u8>, told: String| Ok(Made::one(path.to_owned(), bytes, told));
        let bill = || Bill::new(self.plan, &self.panel, self.drives.as_ref());
        let pieces = || format!("{} pieces", bill().total);
        match what {
            What::Stl => {
                let (bytes, told) = self.stl().with_context(refused).or_bad_input()?;
                one(bytes, told)
            }
            What::CutSvg => self.sheets(path, |drawing| svg(drawing).into_bytes()),
            What::CutDxf => self.sheets(path, |drawing| dxf(drawing).into_bytes()),
            What::BomCsv => one(bill().csv().into_bytes(), pieces()),
            What::BomJson => one(bill().json().with_context(refused).or_failed()?.into_bytes(), pieces()),
            What::BomText => one(bill().table().into_bytes(), pieces()),
            What::Assembly => {
                let about = Assembly { plan: self.plan, panel: &self.panel, drives: self.drives.as_ref() };
                let html = assembly(&about).with_context(refused).or_bad_input()?;
                let pages = html.matches("<section class=\"page\"").count();
                one(html.into_bytes(), format!("{pages} pages"))
            }
            What::Net => {
                let net = Net::of(self.plan);
                let pairs = net.overlaps(self.plan).pairs;
                one(picture::net(self.plan, &net).into_bytes(), format!("{pairs} pairs of panels overlap"))
            }
            What::Crease => {
                let bytes = crease_pattern(self.plan).with_context(refused).or_failed()?;
                one(bytes, "the net as a crease pattern".to_owned())
            }
            What::Gltf => {
                let bytes = scene::gltf(self.plan).with_context(refused).or_bad_input()?;
                one(bytes, "the deployment".to_owned())
            }
            What::Target => {
                let bytes = scene::gltf_of_target(self.plan).with_context(refused).or_bad_input()?;
                one(bytes, "the shape".to_owned())
            }
        }
    }

    fn stl(&self) -> anyhow::Result<(Vec<u8>, String)> {
        let gaps = self.sizes.gaps();
        let stack = Stack::new(self.plan, &self.panel, gaps)?;
        let [x, y, z] = stack.box_mm;
        let triangles = stack.body.triangles.len();
        let count = stack.middles.len();
        let hidden = match stack.hidden_holes {
            0 => String::new(),
            hidden => format!(
                "; {hidden} of {} magnet holes open towards another pile: a magnet gets in where --pile-gap is its length or more",
                4 * count
            ),
        };
        let told = format!("{count} panels of {triangles} triangles, {x:.1} x {y:.1} x {z:.1} mm{hidden}");
        Ok((stl(&stack, gaps)?, told))
    }

    /// One file, or one a sheet with the sheet's number in its name.
    fn sheets(
        &self,
        path: &Path,
        write: impl Fn(&zygote_fabrication::Drawing) -> Vec<u8>,
    ) -> Result<Made, Failure> {
        let drawings = sheets(self.plan, &self.panel, &self.sizes.sheet())
            .with_context(|| format!("{}: cannot be cut", self.name))
            .or_bad_input()?;
        let (count, width) = (drawings.len(), drawings.len().to_string().len());
        let named = |number: usize| {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            let ending = path.extension().unwrap_or_default().to_string_lossy();
            if count == 1 {
                path.to_owned()
            } else {
                path.with_file_name(format!("{stem}-{number:0width$}.{ending}"))
            }
        };
        let files = drawings.iter().enumerate().map(|(index, drawing)| (named(index + 1), write(drawing)));
        let sheets = if count == 1 { "1 sheet".to_owned() } else { format!("{count} sheets") };
        Ok(Made { files: files.collect(), told: sheets })
    }
}
