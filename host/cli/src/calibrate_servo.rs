//! `zygote calibrate --servo`: finds the pulses of servo hinges at 0, 90, 180 and 270 degrees, by angles that a person types or a
//! sensor reads.

use crate::board_calibrations::forget;
use crate::calibrate::{Arguments, HELLO_PATIENCE, SIMULATED};
use crate::calibration_files::{Files, Found};
use crate::failure::{Failure, OrFail};
use crate::paced_line::PacedLine;
use crate::servo_protractor::{CommandSensor, Truth, Typed};
use crate::{identity, interrupt, servo_report};
use anyhow::{Context, anyhow};
use clap::Args;
use std::sync::atomic::Ordering;
use zygote_controller::calibrate::chip_id;
use zygote_controller::calibrate_servo::{
    MeasuredServos, Protractor, ServoCalibration, ServoHinge, calibrate_servos,
};
use zygote_controller::{SerialTransport, Session, Transport};
use zygote_deployment::{Calibration, Drive, Fitting, Rig};

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

/// Reads angles; succeeds only when every servo is calibrated.
pub(crate) fn run(arguments: &Arguments, rig: &Rig, fittings: &[Fitting]) -> Result<(), Failure> {
    let tolerance_deg = arguments.servo.tolerance;
    if !(0.1..=10.0).contains(&tolerance_deg) {
        let error = anyhow!("--tolerance {tolerance_deg}: expected 0.1 to 10 degrees");
        return Err(Failure::BadInput(error));
    }
    let files = Files::new(arguments, "servos.json", "servos.html");
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
    let earlier = files.earlier(arguments, MeasuredServos::from_json, |measured| measured.complete)?;
    // Before anything moves: a file of another rig stays as it is.
    let known = files.known(rig)?;
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
    let mut keep = |hinges: &[ServoHinge]| files.keep(&MeasuredServos::new(&rig.id, &info, hinges));
    // What the board kept was of a servo that may have been replaced, and would hold this one to that one's range.
    forget(&mut session, hinges.iter().map(|hinge| hinge.channel)).or_failed()?;
    calibrate_servos(&mut session, &calibration, &mut hinges, protractor, &mut keep).or_failed()?;
    let firmware = format!("{} {}", info.identity.firmware, info.identity.git);
    let date = identity::now_utc();
    let mut fresh = fresh();
    fresh.hinges = hinges.iter().map(|hinge| servo_report::hinge_of(hinge, &date, &firmware)).collect();
    let page = servo_report::page(rig, &date, &hinges, &fresh.hinges);
    let found = Found { table: servo_report::table(&fresh.hinges), page, hinges: fresh };
    files.finish(&mut session, rig, result, found, arguments.json)
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
