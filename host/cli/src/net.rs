//! `zygote net`: all panels of a plan flattened along the tree path, and how many lie on each other.

use crate::failure::Failure;
use crate::input;
use crate::output::{say, write_file};
use clap::Args;
use std::path::PathBuf;
use zygote_deployment::picture;
use zygote_stacking::{Net, Overlaps};

/// Arguments of `zygote net`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// The plan
    #[arg(value_name = "PLAN.fold")]
    plan: PathBuf,
    /// Draw the net here; panels that lie on each other are red, with their number
    #[arg(long, value_name = "FILE.svg")]
    svg: Option<PathBuf>,
}

/// Flattens a plan and counts.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let plan = input::plan(&arguments.plan)?;
    let net = Net::of(&plan);
    if let Some(path) = &arguments.svg {
        write_file(path, picture::net(&plan, &net).as_bytes())?;
    }
    let [across, along] = net.bounds();
    let name = arguments.plan.display();
    say(format_args!("{name}: flattened, {} panels take {across} x {along}", plan.panels()));
    let Overlaps { panels, pairs, pairs_in_a_pile, most } = net.overlaps(&plan);
    if pairs == 0 {
        say("no two panels overlap: the net can be cut from one sheet");
    } else {
        say(format_args!(
            "{panels} panels overlap, in {pairs} pairs: {pairs_in_a_pile} of one pile, {} of two piles; at most {most} panels \
             lie on one square",
            pairs - pairs_in_a_pile
        ));
    }
    Ok(())
}
