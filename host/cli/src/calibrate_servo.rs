//! `zygote calibrate --servo`: finds the pulses of servo hinges at 0, 90, 180 and 270 degrees, by angles that a person types or a
//! sensor reads.

use crate::board_calibrations::{Taught, forget, teach};
use crate::calibrate::{Arguments, HELLO_PATIENCE, SIMULATED, known};
use crate::failure::{Failure, OrFail};
use crate::output::{say, write_file};
use crate::paced_line::PacedLine;
use crate::servo_protractor::{CommandSensor, Truth, Typed};
use crate::{calibration_json, identity, interrupt, servo_report};
use anyhow::{Context, anyhow};
use clap::Args;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use zygote_controller::calibrate::chip_id;
use zygote_controller::calibrate_servo::{
    MeasuredServos, Protractor, ServoCalibration, ServoHinge, calibrate_servos,
};
use zygote_controller::{SerialTransport, Session, Transport};
use zygote_deployment::{CalibratedHinge, Calibration, CalibrationVerdict, Drive, Fitting, Rig};

/// The sensor that is the simulator's truth.
const TRUTH: &str = "sim";

/// What only servos have.
#[derive(Args)]
pub(crate) struct Options {
    /// Instead of you, this command reads a servo hinge's angle: it prints one number, degrees. `sim` is the simulated hinge's true angle
    #[arg(long, value_name = "COMMAND", requires = "servo")]
    sensor: Option<String>,
    /// So near to an angle, in degrees, a pulse is good
    #[arg(long, value_name = "DEG", requires = "servo", default_value_t = 1.0)]
    tolerance: f64,
}

/// The files of a servo calibration.
struct Files {
    result: PathBuf,
    /// All that was read.
    records: PathBuf,
    /// For people.
    report: PathBuf,
}

/// Reads angles; succeeds only when every servo is calibrated.
pub(crate) fn run(arguments: &Arguments, rig: &Rig, fittings: &[Fitting]) -> Result<(), Failure> {
    let tolerance_deg = arguments.servo.tolerance;
    if !(0.1..=10.0).contains(&tolerance_deg) {
        let error = anyhow!("--tolerance {tolerance_deg}: expected 0.1 to 10 degrees");
        return Err(Failure::BadInput(error));
    }
    let result = arguments.output.clone().unwrap_or_else(|| arguments.rig.with_file_name("calibration.toml"));
    let files = Files {
        records: result.with_extension("servos.json"),
        report: result.with_extension("servos.html"),
        result,
    };
    let sensor = arguments.servo.sensor.as_deref();
    let bench = (rig, fittings, &files);
    if let Some(device) = &arguments.target.port {
        let transport = |baud| SerialTransport::open(device, baud).or_bad_input();
        match sensor {
            Some(TRUTH) => Err(Failure::BadInput(anyhow!(
                "--sensor {TRUTH}: expected a command, or --sim instead of --port"
            ))),
            Some(command) => {
                let mut sensor = CommandSensor::new(command);
                measure(arguments, transport(rig.link.baud)?, identity::fresh(), bench, &mut sensor)
            }
            None => {
                measure(arguments, transport(rig.link.baud)?, identity::fresh(), bench, &mut Typed::new())
            }
        }
    } else {
        let board = zygote_rehearsal::bench(rig, fittings, SIMULATED).or_bad_input()?;
        let line = PacedLine::new(board, rig.link.baud);
        match sensor {
            Some(TRUTH) => measure(arguments, line, SIMULATED, bench, &mut Truth::new(fittings)),
            Some(command) => measure(arguments, line, SIMULATED, bench, &mut CommandSensor::new(command)),
            None => measure(arguments, line, SIMULATED, bench, &mut Typed::new()),
        }
    }
}

fn measure<T: Transport>(
    arguments: &Arguments,
    transport: T,
    number: u32,
    (rig, fittings, files): (&Rig, &[Fitting], &Files),
    protractor: &mut dyn Protractor<T>,
) -> Result<(), Failure> {
    let earlier = earlier(arguments, files)?;
    // Before anything moves: a file of another rig stays as it is.
    let known = known(&files.result, rig)?;
    let interrupted = interrupt::flag()?;
    let mut session = Session::connect(transport, number, HELLO_PATIENCE).or_failed()?;
    let info = session.info().clone();
    let mut hinges = hinges(arguments, &mut session, fittings)?;
    if let Some(earlier) = earlier {
        let name = files.records.display().to_string();
        earlier.resume(&rig.id, &info, &mut hinges).context(name).or_bad_input()?;
    }
    let unique_id = chip_id(&info);
    let fresh = || Calibration::new(&rig.id, &info.identity.board, &unique_id);
    let mut result = known.unwrap_or_else(fresh);
    // A file of another board is refused before anything moves.
    result.take_in(fresh()).context(files.result.display().to_string()).or_bad_input()?;
    let calibration = ServoCalibration {
        rig,
        run: number,
        clear: arguments.clear,
        interrupted: &|| interrupted.load(Ordering::Relaxed),
    };
    let mut keep = |hinges: &[ServoHinge]| {
        let json = serde_json::to_vec(&MeasuredServos::new(&rig.id, &info, hinges))
            .map_err(|error| error.to_string())?;
        write_file(&files.records, &json).map_err(|failure| match failure {
            Failure::BadInput(error) | Failure::Failed(error) => format!("{error:#}"),
        })
    };
    // What the board kept was of a servo that may have been replaced, and would hold this one to that one's range.
    forget(&mut session, hinges.iter().map(|hinge| hinge.channel)).or_failed()?;
    calibrate_servos(&mut session, &calibration, &mut hinges, protractor, &mut keep).or_failed()?;
    let firmware = format!("{} {}", info.identity.firmware, info.identity.git);
    let date = identity::now_utc();
    let mut fresh = fresh();
    fresh.hinges = hinges.iter().map(|hinge| servo_report::hinge_of(hinge, &date, &firmware)).collect();
    let calibrated = fresh.hinges.clone();
    result.take_in(fresh).or_failed()?;
    write_file(&files.result, result.text().or_failed()?.as_bytes())?;
    let page = servo_report::page(rig, &date, &hinges, &calibrated);
    write_file(&files.report, page.as_bytes())?;
    let taught = teach(&mut session, rig, &files.result, &result);
    if arguments.json {
        let files = [&files.result, &files.records, &files.report].map(PathBuf::as_path);
        let taught = taught.as_ref().ok();
        let document =
            calibration_json::document(&rig.id, &result.at(), &calibrated, taught, files).or_failed()?;
        say(serde_json::to_string_pretty(&document).or_failed()?);
    } else {
        say(servo_report::table(&calibrated));
        say(format_args!("calibration: {}\nreport: {}", files.result.display(), files.report.display()));
        taught.iter().map(Taught::line).for_each(say);
    }
    judge(&calibrated)?;
    taught.map(drop)
}

fn judge(calibrated: &[CalibratedHinge]) -> Result<(), Failure> {
    let bad: Vec<String> = calibrated
        .iter()
        .filter(|hinge| hinge.verdict != CalibrationVerdict::Calibrated)
        .map(|hinge| {
            format!(
                "hinge {}: {}: {}",
                hinge.hinge,
                hinge.verdict.name(),
                hinge.why.as_deref().unwrap_or_default()
            )
        })
        .collect();
    if bad.is_empty() { Ok(()) } else { Err(Failure::Failed(anyhow!("{}", bad.join("\n       ")))) }
}

/// The hinges asked for.
fn hinges<T: Transport>(
    arguments: &Arguments,
    session: &mut Session<T>,
    fittings: &[Fitting],
) -> Result<Vec<ServoHinge>, Failure> {
    let settings = session.settings().or_failed()?.in_force;
    let info = session.info();
    let hinge = |number: usize| match fittings.get(number) {
        Some(Fitting { channel, drive: Drive::Servo(_), .. }) if *channel >= info.channels.servos => {
            let (board, servos) = (&info.identity.board, info.channels.servos);
            Err(anyhow!("hinge {number}: servo channel {channel}, the {board} has {servos} of them"))
        }
        Some(Fitting { channel, drive: Drive::Servo(servo), .. }) => {
            Ok(ServoHinge::new(number, *channel, *servo, &settings, arguments.servo.tolerance))
        }
        Some(Fitting { drive, .. }) => {
            Err(anyhow!("--servo {number}: expected a servo hinge, found a {}", drive.kind().name()))
        }
        None => Err(anyhow!("--servo {number}: expected a hinge of the rig, 0 to {}", fittings.len() - 1)),
    };
    let mut numbers = arguments.which.servo.clone();
    numbers.sort_unstable();
    numbers.dedup();
    let hinges: Vec<ServoHinge> = numbers.into_iter().map(hinge).collect::<Result<_, _>>().or_bad_input()?;
    for hinge in &hinges {
        let bounds = hinge.bounds;
        if bounds.shortest_us >= bounds.longest_us {
            let (shortest, longest) = (settings.shortest_pulse_us, settings.longest_pulse_us);
            let error = anyhow!(
                "hinge {}: servo.shortest_pulse and servo.longest_pulse of the rig file leave nothing of the {shortest} to {longest} us that \
                 the board sends",
                hinge.number
            );
            return Err(Failure::BadInput(error));
        }
    }
    Ok(hinges)
}

/// What an interrupted calibration read, where it is gone on with.
fn earlier(arguments: &Arguments, files: &Files) -> Result<Option<MeasuredServos>, Failure> {
    let name = files.records.display().to_string();
    let bytes = match std::fs::read(&files.records) {
        Ok(bytes) => bytes,
        Err(error) if arguments.resume => {
            return Err(Failure::BadInput(anyhow!(error).context(format!("{name}: cannot be read"))));
        }
        Err(_) => return Ok(None),
    };
    let measured = MeasuredServos::from_json(&bytes).context(name.clone());
    if arguments.resume {
        return measured.map(Some).or_bad_input();
    }
    match measured {
        Ok(measured) if !measured.complete && !arguments.restart => Err(Failure::BadInput(anyhow!(
            "{name}: holds a calibration that was interrupted: --resume goes on with it, --restart forgets it"
        ))),
        Ok(_) | Err(_) => Ok(None),
    }
}
