//! `zygote calibrate`: measures the shape-memory hinges of a rig, at a board or on the simulator, and writes what they are like. Servos
//! are [`calibrate_servo`]'s.

use crate::calibration_files::{Files, Found};
use crate::calibration_progress::Display;
use crate::calibration_table::{hinge_of, table};
use crate::failure::{Failure, OrFail};
use crate::paced_line::PacedLine;
use crate::{calibrate_servo, calibration_report, identity, input, interrupt};
use anyhow::{Context, anyhow};
use clap::Args;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use zygote_calibration::Fit;
use zygote_controller::calibrate::{self, Calibration, Hinge, Measured};
use zygote_controller::{SerialTransport, Session, Transport};
use zygote_deployment::{Drive, Fitting, Kind, Rig};
use zygote_protocol::Millis;

/// How long an answer to the hello is waited for.
pub(crate) const HELLO_PATIENCE: Millis = Millis(2_000);
/// Session, first run and boot of the simulator, so that every run is the same.
pub(crate) const SIMULATED: u32 = 1;

/// Arguments of `zygote calibrate`.
#[derive(Args)]
#[expect(clippy::struct_excessive_bools, reason = "flags of a command line")]
pub(crate) struct Arguments {
    /// The rig
    #[arg(long, value_name = "RIG.toml")]
    pub(crate) rig: PathBuf,
    #[command(flatten)]
    pub(crate) target: Target,
    #[command(flatten)]
    pub(crate) which: Which,
    #[command(flatten)]
    pub(crate) servo: calibrate_servo::Options,
    /// The plan whose hinges are on the rig; without it every heater is taken for a hinge
    #[arg(long, value_name = "PLAN.fold")]
    plan: Option<PathBuf>,
    /// What is known of the hinges [default: calibration.toml beside the rig file]
    #[arg(short, long, value_name = "FILE.toml")]
    pub(crate) output: Option<PathBuf>,
    /// Go on with a calibration that was interrupted
    #[arg(long, conflicts_with = "restart")]
    pub(crate) resume: bool,
    /// Forget a calibration that was interrupted
    #[arg(long)]
    pub(crate) restart: bool,
    /// Leave the safe state of an earlier fault or stop: you have looked at the rig
    #[arg(long)]
    pub(crate) clear: bool,
    /// Print what was calibrated as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// Where the rig is.
#[derive(Args)]
#[group(required = true, multiple = false)]
pub(crate) struct Target {
    /// Serial port of the board
    #[arg(long, value_name = "DEV")]
    pub(crate) port: Option<String>,
    /// Simulated board, in virtual time
    #[arg(long)]
    pub(crate) sim: bool,
}

/// Which hinges.
#[derive(Args)]
#[group(required = true, multiple = false)]
pub(crate) struct Which {
    /// A hinge of this number; may be given more than once
    #[arg(long, value_name = "HINGE")]
    hinge: Vec<usize>,
    /// Every shape-memory hinge, as many at once as the supply allows
    #[arg(long)]
    all: bool,
    /// A servo hinge of this number, whose angle you read at each pulse; may be given more than once
    #[arg(long, value_name = "HINGE")]
    pub(crate) servo: Vec<usize>,
}

/// Measures; succeeds only when every hinge is calibrated.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (rig, _) = input::rig_as_written(&arguments.rig)?;
    let fittings = fittings(arguments, &rig)?;
    if !arguments.which.servo.is_empty() {
        return calibrate_servo::run(arguments, &rig, &fittings);
    }
    let files = Files::new(arguments, "records.json", "html");
    let earlier = files.earlier(arguments, Measured::from_json, |measured| measured.complete)?;
    // Before anything is heated: a file of another rig stays as it is.
    let known = files.known(&rig)?;
    if let Some(device) = &arguments.target.port {
        let transport = SerialTransport::open(device, rig.link.baud).or_bad_input()?;
        measure(arguments, transport, identity::fresh(), &rig, &fittings, &files, (earlier, known))
    } else {
        let board = zygote_rehearsal::bench(&rig, &fittings, SIMULATED).or_bad_input()?;
        let line = PacedLine::new(board, rig.link.baud);
        measure(arguments, line, SIMULATED, &rig, &fittings, &files, (earlier, known))
    }
}

/// What drives every hinge.
fn fittings(arguments: &Arguments, rig: &Rig) -> Result<Vec<Fitting>, Failure> {
    if let [_, _, ..] = rig.nodes.as_slice() {
        let nodes = rig.nodes.len();
        return Err(Failure::BadInput(anyhow!("{}: expected a rig of one node, found {nodes}", rig.id)));
    }
    if let Some(path) = &arguments.plan {
        return rig.fit(input::plan(path)?.hinges.len()).or_bad_input();
    }
    let channels =
        rig.nodes.iter().map(|node| node.heaters + node.servos + node.springs).map(usize::from).sum();
    // As many hinges as the rig can have.
    let most = (1..=channels).rev().find_map(|hinges| rig.fit(hinges).ok());
    most.map_or_else(|| rig.fit(channels).or_bad_input(), Ok)
}

/// The hinges asked for.
fn hinges<T: Transport>(
    arguments: &Arguments,
    session: &Session<T>,
    fittings: &[Fitting],
) -> Result<Vec<Hinge>, Failure> {
    let info = session.info();
    let hinge = |number: usize| match fittings.get(number) {
        Some(Fitting { channel, drive: Drive::Sma(_), .. }) if *channel >= info.channels.heaters => {
            let (board, heaters) = (&info.identity.board, info.channels.heaters);
            Err(anyhow!("hinge {number}: heater channel {channel}, the {board} has {heaters} of them"))
        }
        Some(Fitting { channel, drive: Drive::Sma(settings), .. }) => {
            Ok(Hinge::new(number, *channel, *settings, &info.ceiling))
        }
        Some(Fitting { drive, .. }) => {
            let servo = if drive.kind() == Kind::Servo { "; for servos there is --servo" } else { "" };
            let kind = drive.kind().name();
            Err(anyhow!("--hinge {number}: expected a shape-memory hinge, found a {kind}{servo}"))
        }
        None => Err(anyhow!("--hinge {number}: expected a hinge of the rig, 0 to {}", fittings.len() - 1)),
    };
    let is_sma = |number: &usize| matches!(fittings.get(*number).map(|fit| fit.drive), Some(Drive::Sma(_)));
    let mut numbers: Vec<usize> = if arguments.which.all {
        (0..fittings.len()).filter(is_sma).collect()
    } else {
        arguments.which.hinge.clone()
    };
    numbers.sort_unstable();
    numbers.dedup();
    if numbers.is_empty() {
        return Err(Failure::BadInput(anyhow!("--all: the rig has no shape-memory hinge")));
    }
    numbers.into_iter().map(hinge).collect::<Result<_, _>>().or_bad_input()
}

fn measure<T: Transport>(
    arguments: &Arguments,
    transport: T,
    number: u32,
    rig: &Rig,
    fittings: &[Fitting],
    files: &Files,
    (earlier, known): (Option<Measured>, Option<zygote_deployment::Calibration>),
) -> Result<(), Failure> {
    let interrupted = interrupt::flag()?;
    let mut session = Session::connect(transport, number, HELLO_PATIENCE).or_failed()?;
    let info = session.info().clone();
    let mut hinges = hinges(arguments, &session, fittings)?;
    if let Some(earlier) = earlier {
        let name = files.records.display().to_string();
        earlier.resume(&rig.id, &info, &mut hinges).context(name).or_bad_input()?;
    }
    let unique_id = calibrate::chip_id(&info);
    let fresh = || zygote_deployment::Calibration::new(&rig.id, &info.identity.board, &unique_id);
    let mut result = known.unwrap_or_else(fresh);
    // A file of another board is refused before anything is heated.
    result.take_in(fresh()).context(files.result.display().to_string()).or_bad_input()?;
    let calibration = Calibration {
        rig,
        run: number,
        clear: arguments.clear,
        interrupted: &|| interrupted.load(Ordering::Relaxed),
    };
    let display = Display::new();
    let mut keep = |hinges: &[Hinge]| files.keep(&Measured::new(&rig.id, &info, hinges));
    let outcome = calibrate::calibrate(&mut session, &calibration, &mut hinges, &mut keep, &mut |progress| {
        display.show(progress);
    });
    display.close();
    outcome.or_failed()?;
    let firmware = format!("{} {}", info.identity.firmware, info.identity.git);
    let date = identity::now_utc();
    let mut fits: Vec<Option<Fit>> = Vec::new();
    let mut fresh = fresh();
    for hinge in &hinges {
        let fit = hinge.fit().or_failed()?;
        fresh.hinges.push(hinge_of(hinge, &fit, &date, &firmware));
        fits.push(Some(fit));
    }
    let page = calibration_report::page(rig, &date, &hinges, &fits, &fresh.hinges);
    let found = Found { table: table(&fresh.hinges), page, hinges: fresh };
    files.finish(&mut session, rig, result, found, arguments.json)
}
