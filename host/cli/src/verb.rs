//! The table of verbs.

use crate::failure::Failure;
use crate::{
    alternatives, assembly, calibrate, check, completions, deploy, doctor, drift, explain, export, flash,
    fold_back, hil, link, man, net, picture, plan, reconfigure, rehearse, replay, report, schedule, sequence,
    serve, settings, sim, table, tolerance, torque, view,
};
use clap::Subcommand;

/// A verb and its arguments.
#[derive(Subcommand)]
pub(crate) enum Verb {
    /// Plan how panels stack into piles and unfold into a shape
    Plan(plan::Arguments),
    /// Check that a plan breaks no rule
    Check(check::Arguments),
    /// Print a plan's coded sequence, a line a pile, or read one back
    Sequence(sequence::Arguments),
    /// List the hinges to move so that a stack unfolds into another shape
    Reconfigure(reconfigure::Arguments),
    /// Look for several plans of one shape, no two of which are hinged alike
    Alternatives(alternatives::Arguments),
    /// Flatten a plan along its hinges, and count the panels that overlap
    Net(net::Arguments),
    /// Tell how far panels are off when hinges aren't exact, for the tree and for a single strip
    Tolerance(tolerance::Arguments),
    /// Put the hinges of a plan in order and time for a rig
    Schedule(schedule::Arguments),
    /// Print a plan's schedule as a table, a row a hinge
    Table(table::Arguments),
    /// Weigh a plan: the torque on every hinge while it opens, and whether the whole stands
    Torque(torque::Arguments),
    /// Draw a plan: stack, shape, the way between them, or its schedule
    Picture(picture::Arguments),
    /// Show a plan in the browser: the way from stack to shape, panel by panel
    View(view::Arguments),
    /// Write a plan as files for a workshop: bodies to print, sheets to cut, bill, assembly pages, net, scenes
    Export(export::Arguments),
    /// Run a plan's schedule backwards: what folds the shape up again, with servos alone
    Fold(fold_back::Arguments),
    /// List what to turn by hand, hinge after hinge, where nothing is driven
    Assembly(assembly::Arguments),
    /// Run a plan's schedule on a board or on the simulator
    Deploy(deploy::Arguments),
    /// Tell which hinges of a recorded run aren't as they were calibrated
    Drift(drift::Arguments),
    /// Serve a page from which runs are chosen, armed, started, paused and stopped
    Serve(serve::Arguments),
    /// Run scenario files: deployments on the simulator with something going wrong, judged
    Rehearse(rehearse::Arguments),
    /// Tell a recorded run again: what happened when, and how it ended
    Replay(replay::Arguments),
    /// Write a recorded run as one HTML page with plots
    Report(report::Arguments),
    /// Measure shape-memory hinges: what heats them, how fast, and where they open
    Calibrate(calibrate::Arguments),
    /// Measure the line to a board
    Link(link::Arguments),
    /// Tell what a refusal or fault code means, and what to do
    Explain(explain::Arguments),
    /// Program a board with its firmware, through probe-rs
    Flash(flash::Arguments),
    /// Show what a board keeps over power cycles, and lower its limits
    Settings(settings::Arguments),
    /// Test a board, simulated, emulated or real, with the serial suite
    Hil(hil::Arguments),
    /// Serve a simulated board on a pseudo-terminal
    Sim(sim::Arguments),
    /// Look for what zygote can use: ports, a board's firmware, other programs; tell what to do about what isn't there
    Doctor(doctor::Arguments),
    /// Print what a shell needs to complete verbs and options
    Completions(completions::Arguments),
    /// Write the manual, a page a verb
    Man(man::Arguments),
}

impl Verb {
    /// Does what the user asked for.
    pub(crate) fn run(self) -> Result<(), Failure> {
        match self {
            Self::Plan(arguments) => plan::run(&arguments),
            Self::Doctor(arguments) => doctor::run(&arguments),
            Self::Completions(arguments) => completions::run(&arguments),
            Self::Man(arguments) => man::run(&arguments),
            Self::Check(arguments) => check::run(&arguments),
            Self::Sequence(arguments) => sequence::run(&arguments),
            Self::Reconfigure(arguments) => reconfigure::run(&arguments),
            Self::Alternatives(arguments) => alternatives::run(&arguments),
            Self::Net(arguments) => net::run(&arguments),
            Self::Tolerance(arguments) => tolerance::run(&arguments),
            Self::Deploy(arguments) => deploy::run(&arguments),
            Self::Drift(arguments) => drift::run(&arguments),
            Self::Calibrate(arguments) => calibrate::run(&arguments),
            Self::Link(arguments) => link::run(&arguments),
            Self::Explain(arguments) => explain::run(&arguments),
            Self::Flash(arguments) => flash::run(&arguments),
            Self::Settings(arguments) => settings::run(&arguments),
            Self::Hil(arguments) => hil::run(&arguments),
            Self::Sim(arguments) => sim::run(&arguments),
            Self::Serve(arguments) => serve::run(&arguments),
            Self::Rehearse(arguments) => rehearse::run(&arguments),
            Self::Replay(arguments) => replay::run(&arguments),
            Self::Report(arguments) => report::run(&arguments),
            Self::Export(arguments) => export::run(&arguments),
            Self::Fold(arguments) => fold_back::run(&arguments),
            Self::Assembly(arguments) => assembly::run(&arguments),
            Self::Table(arguments) => table::run(&arguments),
            Self::Torque(arguments) => torque::run(&arguments),
            Self::Schedule(arguments) => schedule::run(&arguments),
            Self::View(arguments) => view::run(&arguments),
            Self::Picture(arguments) => picture::run(&arguments),
        }
    }
}
