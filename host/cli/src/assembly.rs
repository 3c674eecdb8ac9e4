//! `zygote assembly`: how people open a stack by hand, hinge after hinge: magnets, tape or card need no rig.

use crate::failure::{Failure, OrFail};
use crate::input;
use crate::output::{say, write_file};
use anyhow::Context;
use clap::Args;
use std::fmt::Write as _;
use std::path::PathBuf;
use zygote_deployment::{Branch, Tree, table};
use zygote_stacking::{Hinge, HingeKind, Plan};

/// Arguments of `zygote assembly`.
#[derive(Args)]
#[command(
    after_help = "Each line is one hinge: which panel stays and which one is turned about their common edge, with all panels \
    that hang on it. The edge is named by its side of the stack (E is +x, N is +y) and by the panels' heights from the bottom, \
    0 up. Valley and mountain are as seen on the outer side of the shape."
)]
pub(crate) struct Arguments {
    /// The plan
    #[arg(value_name = "PLAN.fold")]
    plan: PathBuf,
    /// A schedule beside the plan; without any the order is that of the tree
    #[arg(long, value_name = "SCHEDULE.json")]
    schedule: Option<PathBuf>,
    /// Write the list here as a table instead of printing it
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
}

/// Prints or writes the list.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let name = arguments.plan.display();
    let plan = input::plan(&arguments.plan)?;
    let tree = Tree::new(&plan).with_context(|| format!("{name}: no tree")).or_bad_input()?;
    let (order, of) = if plan.schedule.is_some() || arguments.schedule.is_some() {
        let beside = arguments.schedule.as_deref();
        let (name, schedule) = input::unverified_schedule(&arguments.plan, &plan, beside)?;
        table::belongs(&schedule, &plan).context(name).or_bad_input()?;
        (schedule.steps.iter().map(|step| step.hinge).collect(), "its schedule")
    } else {
        (tree.branches().iter().map(|branch| branch.hinge).collect::<Vec<_>>(), "the tree")
    };
    let lines = lines(&plan, &tree, &order);
    if let Some(path) = &arguments.output {
        write_file(path, csv(&lines).as_bytes())?;
        say(format_args!("{}: {} hinges", path.display(), lines.len()));
        return Ok(());
    }
    say(format_args!(
        "{name}: {} hinges by hand, in the order of {of}. Panel {} stays.",
        lines.len(),
        plan.root
    ));
    let width = lines.len().to_string().len();
    let mut last = None;
    for (number, line) in lines.iter().enumerate() {
        let heading = line.heading();
        if last.as_ref() != Some(&heading) {
            say(format_args!("\n{heading}"));
            last = Some(heading);
        }
        say(format_args!("{:>width$}. {}", number + 1, line.words()));
    }
    Ok(())
}

/// One hinge of the list.
struct Line<'a> {
    number: usize,
    hinge: &'a Hinge,
    branch: Branch,
    /// Cell and height of the panel that stays, and of the one that is turned.
    places: [([i32; 2], usize); 2],
    /// Panels that are turned along with it.
    carried: usize,
}

fn lines<'a>(plan: &'a Plan, tree: &Tree, order: &[usize]) -> Vec<Line<'a>> {
    let places = table::places(plan);
    let mut branch_of = vec![None; plan.hinges.len()];
    for branch in tree.branches() {
        branch_of[branch.hinge] = Some(*branch);
    }
    let mut carried = vec![0; plan.panels()];
    // Children come after their parents.
    for branch in tree.branches().iter().rev() {
        carried[branch.parent] += carried[branch.child] + 1;
    }
    let line = |hinge: &usize| {
        let branch = branch_of.get(*hinge).copied().flatten()?;
        let places = [branch.parent, branch.child].map(|panel| places[panel]);
        let carried = carried[branch.child];
        Some(Line { number: *hinge, hinge: &plan.hinges[*hinge], branch, places, carried })
    };
    order.iter().filter_map(line).collect()
}

impl Line<'_> {
    fn heading(&self) -> String {
        let [([i, j], _), ([k, l], _)] = self.places;
        match self.hinge.kind {
            HingeKind::Fold => format!("Pile on cell ({i},{j})"),
            HingeKind::Bridge => format!("From the pile on cell ({i},{j}) to that on cell ({k},{l})"),
        }
    }

    /// The side of the stack on which the hinge is, seen from the panel that stays.
    fn side(&self) -> &'static str {
        let from_first = self.hinge.panels[0] == self.branch.parent || self.hinge.kind == HingeKind::Fold;
        if from_first { self.hinge.side.letter() } else { self.hinge.side.opposite().letter() }
    }

    fn fold(&self) -> &'static str {
        match self.hinge.target_angle_deg.signum() {
            1 => "valley",
            -1 => "mountain",
            _ => "flat",
        }
    }

    /// Opening angles in the stack and in the shape.
    fn angles(&self) -> [u16; 2] {
        let start = match self.hinge.kind {
            HingeKind::Fold => 0,
            HingeKind::Bridge => 180,
        };
        [start, self.hinge.opening_deg]
    }

    fn words(&self) -> String {
        let Branch { parent, child, .. } = self.branch;
        let [(_, low), (_, high)] = self.places;
        let (side, fold) = (self.side(), self.fold());
        let carried = match self.carried {
            0 => String::new(),
            1 => " and the one on it".to_owned(),
            more => format!(" and the {more} on it"),
        };
        let what =
            format!("panel {child} (height {high}){carried}, side {side} of panel {parent} (height {low})");
        match self.angles() {
            [from, to] if from == to => format!("leave {what}: {fold}, at {to} degrees"),
            [from, to] => format!("turn {what}: {fold}, from {from} to {to} degrees"),
        }
    }
}

/// The list as comma-separated values.
fn csv(lines: &[Line]) -> String {
    let mut text = "number,hinge,kind,cell_x,cell_y,panel,height,turned_cell_x,turned_cell_y,turned_panel,turned_height,\
                    carried,side,fold,from_deg,to_deg\n"
        .to_owned();
    for (number, line) in lines.iter().enumerate() {
        let Branch { parent, child, .. } = line.branch;
        let [([i, j], low), ([k, l], high)] = line.places;
        let [from, to] = line.angles();
        let (kind, side, fold) = (table::kind_name(line.hinge.kind), line.side(), line.fold());
        let _infallible = writeln!(
            text,
            "{},{},{kind},{i},{j},{parent},{low},{k},{l},{child},{high},{},{side},{fold},{from},{to}",
            number + 1,
            line.number,
            line.carried,
        );
    }
    text
}
