//! `zygote torque`: what gravity does to every hinge while a plan opens, against what the hinges are rated for.

use crate::failure::{Failure, OrFail};
use crate::input;
use crate::output::{say, write_file};
use crate::weighing::{Scale, WeighingArguments, millis, tipping};
use clap::Args;
use serde_json::json;
use std::fmt::Write as _;
use std::path::PathBuf;
use zygote_deployment::statics::{Load, Role, Statics, Support};
use zygote_deployment::{Order, Rig, Tree};
use zygote_stacking::Plan;

/// Loads that are listed.
const SHOWN: usize = 10;

/// Arguments of `zygote torque`.
#[derive(Args)]
#[command(
    after_help = "Hinges open one by one, slowly, in the order of the plan's schedule, or without one in that of the tree. \
    A hinge turns once and then holds what hangs on it; either way its load is the greatest torque over its rating, at the \
    worst angle of every turn. A positive torque would close the hinge, a negative one would open it further. Exit code 1 if \
    a hinge is overloaded or the whole tips."
)]
pub(crate) struct Arguments {
    /// The plan
    #[arg(value_name = "PLAN.fold")]
    plan: PathBuf,
    /// The rig, with [panel], [gravity] and what its hinges are rated for
    #[arg(long, value_name = "RIG.toml")]
    rig: PathBuf,
    /// A schedule beside the plan
    #[arg(long, value_name = "SCHEDULE.json")]
    schedule: Option<PathBuf>,
    #[command(flatten)]
    weighing: WeighingArguments,
    /// Write a table of all steps here
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Weighs, prints the worst, writes the table.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let name = arguments.plan.display();
    let rig = input::rig(&arguments.rig)?;
    let plan = input::plan(&arguments.plan)?;
    let (order, of) = if plan.schedule.is_some() || arguments.schedule.is_some() {
        let schedule = input::schedule(&arguments.plan, &plan, &rig, arguments.schedule.as_deref())?;
        let order: Vec<_> = schedule.steps.iter().map(|step| step.hinge).collect();
        (order, if schedule.most_at_once() > 1 { "its schedule, but one by one" } else { "its schedule" })
    } else {
        (Order::of_tree(&Tree::new(&plan).or_bad_input()?).hinges, "the tree")
    };
    let support = arguments.weighing.support();
    let statics = Scale { path: &arguments.plan, plan: &plan, rig: &rig, support }.weigh(&order)?;
    if let Some(path) = &arguments.output {
        write_file(path, csv(&plan, &rig, &statics)?.as_bytes())?;
    }
    let overloads = statics.overloads();
    if arguments.json {
        say(serde_json::to_string_pretty(&json(&rig, &statics, of, &overloads)).or_failed()?);
    } else {
        let [x, y, z] = rig.gravity.direction;
        say(format_args!(
            "{name}: {} hinges in the order of {of}, panels of {}, gravity along ({x}, {y}, {z})",
            order.len(),
            statics.panel_mass
        ));
        summary(&statics, &overloads);
    }
    arguments.weighing.hold(&arguments.plan, &plan, &statics)
}

fn summary(statics: &Statics, overloads: &[Load]) {
    for (role, loads) in [(Role::Turning, &statics.turning), (Role::Holding, &statics.holding)] {
        let greatest = loads.iter().max_by(|a, b| a.torque.0.abs().total_cmp(&b.torque.0.abs()));
        let beyond = overloads.iter().filter(|load| load.role == role).count();
        if let Some(load) = greatest {
            say(format_args!(
                "{}: at most {:.1} mNm, on hinge {}; {beyond} beyond their rating",
                role.name(),
                millis(load.torque).abs(),
                load.hinge
            ));
        }
    }
    say(format_args!("tipping: {}", tipping(statics)));
    let worst = statics.worst_first();
    if worst.is_empty() {
        return;
    }
    if let Some(mass) = statics.bearable_mass() {
        say(format_args!("mass: these hinges bear panels of at most {mass:.3}"));
    }
    say("the worst loads, by torque over rating:");
    say(format_args!(
        "{:>7}  {:<8}{:>6}{:>10}{:>8}{:>13}{:>13}{:>9}",
        "hinge", "", "step", "turning", "at deg", "torque, mNm", "rating, mNm", "factor"
    ));
    for load in worst.iter().take(SHOWN) {
        say(format_args!(
            "{:>7}  {:<8}{:>6}{:>10}{:>8.1}{:>13.2}{:>13.2}{:>9.2}",
            load.hinge,
            load.role.name(),
            load.step,
            load.turning,
            load.opening.0,
            millis(load.torque),
            millis(load.rating),
            load.factor()
        ));
    }
}

fn json(rig: &Rig, statics: &Statics, order: &str, overloads: &[Load]) -> serde_json::Value {
    let load = |load: &Load| {
        json!({
            "hinge": load.hinge,
            "role": load.role.name(),
            "step": load.step,
            "turning_hinge": load.turning,
            "at_deg": load.opening.0,
            "torque_nm": load.torque.0,
            "rating_nm": load.rating.0,
            "factor": load.factor(),
        })
    };
    let worst = statics.worst_first();
    let tipping = &statics.tipping;
    json!({
        "order": order,
        "steps": statics.turning.len(),
        "panel_mass_g": statics.panel_mass.0,
        "bearable_panel_mass_g": statics.bearable_mass().map(|mass| mass.0),
        "gravity": rig.gravity.direction,
        "worst": worst.iter().take(SHOWN).map(load).collect::<Vec<_>>(),
        "overloads": overloads.iter().map(load).collect::<Vec<_>>(),
        "tipping": {
            "support": match tipping.support { Support::Touching => "touching", Support::Root => "root" },
            "first_step": tipping.first(),
            "least_margin_step": tipping.least().map(|(step, _)| step),
            "least_margin_mm": tipping.least().map(|(_, margin)| margin.0),
        },
    })
}

/// All steps as comma-separated values.
fn csv(plan: &Plan, rig: &Rig, statics: &Statics) -> Result<String, Failure> {
    let fittings = rig.fit_tree(&Tree::new(plan).or_bad_input()?).or_bad_input()?;
    let mut text = "step,hinge,drive,turning_torque_mnm,turning_at_deg,turning_rating_mnm,turning_factor,holding_torque_mnm,\
                    holding_step,holding_turning_hinge,holding_at_deg,holding_rating_mnm,holding_factor,margin_mm\n"
        .to_owned();
    let loads = statics.turning.iter().zip(&statics.holding).zip(&statics.tipping.margins);
    for (step, ((turning, holding), margin)) in loads.enumerate() {
        let drive = fittings.get(turning.hinge).map_or("", |fitting| fitting.drive.kind().name());
        let margin = margin.map_or(String::new(), |margin| format!("{:.3}", margin.0));
        let figures =
            |load: &Load| format!("{:.2},{:.4},{:.4}", load.opening.0, millis(load.rating), load.factor());
        let _infallible = writeln!(
            text,
            "{step},{},{drive},{:.4},{},{:.4},{},{},{},{margin}",
            turning.hinge,
            millis(turning.torque),
            figures(turning),
            millis(holding.torque),
            holding.step,
            holding.turning,
            figures(holding),
        );
    }
    Ok(text)
}
