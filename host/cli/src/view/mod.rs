//! `zygote view`: a plan in the browser, from its stack to its shape; or a picture of it as that page draws it.
//!
//! ```text
//! plan, schedule, rig -> Scene (JSON) -> `zygote_live::Server` (loopback alone) -> the page, built into this program
//!                                            ^--- a picture, posted by a browser without a window
//! ```

mod browser;
mod motion;
mod page;
mod photograph;
mod scene;
mod showing;

use crate::failure::{Failure, OrFail};
use crate::output::say;
use crate::{input, interrupt};
use anyhow::anyhow;
use clap::{Args, ValueEnum};
pub(crate) use page::has_page;
use photograph::Photograph;
pub(crate) use scene::{Run, SceneOf};
pub(crate) use showing::{Showing, listen, page, until_interrupted};
use std::path::PathBuf;
use zygote_deployment::{Direction, Fingerprint, Schedule};
use zygote_stacking::Plan;

/// Arguments of `zygote view`.
#[derive(Args)]
#[command(
    after_help = "The page is served to this computer alone, and to nobody but itself. Without a schedule the hinges open one by \
    one, in the order of the tree."
)]
pub(crate) struct Arguments {
    /// The plan
    #[arg(value_name = "PLAN.fold")]
    plan: PathBuf,
    /// A schedule beside the plan
    #[arg(long, value_name = "SCHEDULE.json")]
    schedule: Option<PathBuf>,
    /// The rig, to colour hinges by their torque
    #[arg(long, value_name = "RIG.toml")]
    rig: Option<PathBuf>,
    /// Port of the address [default: any that is free]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// Open no browser
    #[arg(long)]
    no_open: bool,
    /// Write a picture instead, drawn by a Chromium without a window
    #[arg(long, value_name = "FILE.png")]
    png: Option<PathBuf>,
    #[command(flatten)]
    picture: PictureArguments,
}

/// What the picture shows.
#[derive(Args)]
struct PictureArguments {
    /// From the stack (0) to the shape (1)
    #[arg(long, value_name = "0..1", default_value_t = 1.0, value_parser = share, requires = "png")]
    at: f64,
    /// What colours say
    #[arg(long, value_enum, default_value_t = Colour::Pile, requires = "png")]
    colour: Colour,
    /// How far piles and layers are drawn apart
    #[arg(long, value_name = "0..1", default_value_t = 0.0, value_parser = share, requires = "png")]
    explode: f64,
    /// Width and height
    #[arg(long, value_name = "WxH", default_value = "1200x800", value_parser = size, requires = "png")]
    size: [u32; 2],
    /// Light on dark
    #[arg(long, requires = "png")]
    dark: bool,
    /// The browser [default: the first Chromium or Chrome on the PATH]
    #[arg(long, value_name = "PROGRAM", requires = "png")]
    browser: Option<PathBuf>,
}

/// What colours say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Colour {
    /// The pile of a panel
    Pile,
    /// Its height in the pile
    Height,
    /// When its hinge opens
    Time,
    /// What its hinge is, and its angle in the shape
    Hinge,
    /// What drives its hinge, where a schedule says it
    Drive,
    /// The torque on its hinge, over what that is rated for
    Torque,
}

fn share(text: &str) -> Result<f64, String> {
    let share = text.parse().ok().filter(|share| (0.0..=1.0).contains(share));
    share.ok_or_else(|| "expected a number from 0 to 1".to_owned())
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse().ok().filter(|side| (64..=4096).contains(side));
    let sides = text.split_once('x').and_then(|(width, height)| Some([side(width)?, side(height)?]));
    sides.ok_or_else(|| "expected width and height, each 64 to 4096, as in 1200x800".to_owned())
}

/// Serves the page until Ctrl-C, or draws.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let name = arguments.plan.display();
    let mut plan = input::plan(&arguments.plan)?;
    let rig = arguments.rig.as_deref().map(input::rig).transpose()?;
    let schedule = schedule(arguments, &mut plan)?;
    let scene =
        SceneOf { path: &arguments.plan, plan: &plan, schedule: schedule.as_ref(), rig: rig.as_ref() };
    let json = scene.json(None)?;
    let listener = listen(arguments.port, "--port")?;
    if let Some(png) = &arguments.png {
        let lacking = match arguments.picture.colour {
            Colour::Torque if rig.is_none() => {
                Some("--colour torque needs a --rig that says what panels weigh")
            }
            Colour::Drive if schedule.is_none() => Some("--colour drive needs a schedule"),
            _ => None,
        };
        if let Some(lacking) = lacking {
            return Err(Failure::BadInput(anyhow!(lacking)));
        }
        return Photograph { file: png, of: &arguments.picture }.take(listener, json);
    }
    let stop = interrupt::flag()?;
    let server = zygote_live::Server::start(listener, page()?, None).or_failed()?;
    server.put("/scene.json", json);
    if schedule.is_none() {
        say(format_args!("{name}: has no schedule, so its hinges open in the order of the tree"));
    }
    Showing { what: &name, server: &server, no_open: arguments.no_open }.tell()?;
    until_interrupted(&stop);
    Ok(())
}

/// The schedule that is shown, which the plan holds from then on; none where there is none.
fn schedule(arguments: &Arguments, plan: &mut Plan) -> Result<Option<Schedule>, Failure> {
    if plan.schedule.is_none() && arguments.schedule.is_none() {
        return Ok(None);
    }
    let beside = arguments.schedule.as_deref();
    let (file, schedule) = input::unverified_schedule(&arguments.plan, plan, beside)?;
    if schedule.direction() == Direction::Fold {
        return Err(Failure::BadInput(anyhow!(
            "{file}: is a way back; show the schedule that it was made of, and go through that backwards"
        )));
    }
    let (of, own) = (schedule.plan_crc64, Fingerprint::of(plan));
    if of != own {
        let name = arguments.plan.display();
        return Err(Failure::BadInput(anyhow!("{file}: is for plan {of}, expected plan {own} of {name}")));
    }
    plan.schedule = Some(schedule.to_json().or_failed()?);
    Ok(Some(schedule))
}
