//! `zygote link bench`: goodput, commands a second and round trips of a line, clean and damaged.

use crate::failure::{Failure, OrFail};
use crate::identity;
use crate::noisy_line::NoisyLine;
use crate::output::say;
use crate::paced_line::PacedLine;
use anyhow::anyhow;
use clap::{Args, Subcommand};
use serde::Serialize;
use zygote_controller::{LinkFigures, SerialTransport, Session, Transport, link_bench};
use zygote_protocol::{Channels, Millis};
use zygote_sim::Board;
use zygote_sim::plant::Config;

/// How long an answer to the hello is waited for.
const HELLO_PATIENCE: Millis = Millis(5_000);
/// The speeds that a simulated line is measured at.
const BAUDS: [u32; 2] = [115_200, 921_600];
/// Clean, and one byte in ten thousand damaged.
const DAMAGE: [f64; 2] = [0.0, 1e-4];
/// Session, boot and noise of the simulator, so that every run is the same.
const SIMULATED: u32 = 1;
const LONGEST_S: u32 = 3_600;

/// Arguments of `zygote link`.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    what: What,
}

/// What to do with a line.
#[derive(Subcommand)]
enum What {
    /// Measure a line: uploads, commands, round trips. Moves nothing; the MCU forgets its program
    Bench(Bench),
}

/// Arguments of `zygote link bench`.
#[derive(Args)]
struct Bench {
    #[command(flatten)]
    target: Target,
    /// Speed of the line [default: 921600 at a port; 115200 and 921600 for the simulator]
    #[arg(long, value_name = "BAUD", value_parser = clap::value_parser!(u32).range(1_200..=20_000_000))]
    baud: Option<u32>,
    /// Damage this share of all bytes, both ways [default: 0 and 0.0001]
    #[arg(long, value_name = "SHARE")]
    corrupt: Option<f64>,
    /// Time for each row of the table
    #[arg(long, value_name = "SECONDS", default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=i64::from(LONGEST_S)))]
    seconds: u32,
    /// Print as JSON
    #[arg(long)]
    json: bool,
}

/// Which line.
#[derive(Args)]
#[group(required = true, multiple = false)]
struct Target {
    /// Serial port of the board
    #[arg(long, value_name = "DEV")]
    port: Option<String>,
    /// Simulated board behind a line of that speed, in virtual time
    #[arg(long)]
    sim: bool,
}

/// A row of the table.
#[derive(Debug, Serialize)]
struct Row {
    baud: u32,
    corrupt: f64,
    #[serde(flatten)]
    figures: LinkFigures,
}

/// Measures and prints.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let What::Bench(bench) = &arguments.what;
    if let Some(share) = bench.corrupt.filter(|share| !(0.0..=0.1).contains(share)) {
        return Err(Failure::BadInput(anyhow!("--corrupt: expected 0 to 0.1, found {share}")));
    }
    let time = Millis(bench.seconds * 1_000);
    let damage = bench.corrupt.map_or(DAMAGE.to_vec(), |share| vec![share]);
    let mut rows = Vec::new();
    if let Some(device) = &bench.target.port {
        let baud = bench.baud.unwrap_or(921_600);
        for corrupt in damage {
            let line = SerialTransport::open(device, baud).or_bad_input()?;
            rows.push(measure(line, identity::fresh(), baud, corrupt, time)?);
        }
    } else {
        for baud in bench.baud.map_or(BAUDS.to_vec(), |baud| vec![baud]) {
            for &corrupt in &damage {
                rows.push(measure(PacedLine::new(board()?, baud), SIMULATED, baud, corrupt, time)?);
            }
        }
    }
    if bench.json {
        say(serde_json::to_string_pretty(&rows).or_failed()?);
    } else {
        say(table(&rows));
    }
    Ok(())
}

/// A board of one channel each: the line is measured, not the plant.
fn board() -> Result<Board, Failure> {
    let plant = Config { heaters: Vec::new(), servos: Vec::new(), springs: Vec::new(), ..Config::default() };
    Board::new(&plant, Channels { heaters: 0, servos: 0, springs: 0 }, SIMULATED).or_failed()
}

fn measure<T: Transport>(
    line: T,
    number: u32,
    baud: u32,
    corrupt: f64,
    time: Millis,
) -> Result<Row, Failure> {
    let noisy = NoisyLine::new(line, corrupt, u64::from(SIMULATED));
    let mut session = Session::connect(noisy, number, HELLO_PATIENCE).or_failed()?;
    let figures = link_bench(&mut session, baud, time).or_failed()?;
    Ok(Row { baud, corrupt, figures })
}

fn table(rows: &[Row]) -> String {
    let head = "   baud   damaged  goodput B/s   of line  commands/s   p50 ms   p99 ms  sent again";
    let line = |row: &Row| {
        let Row { baud, corrupt, figures } = row;
        format!(
            "{baud:>7}  {corrupt:>8}  {:>11.0}  {:>6.1} %  {:>10.0}  {:>7.2}  {:>7.2}  {:>10}",
            figures.goodput_bytes_per_s,
            100.0 * figures.share_of_line_rate,
            figures.commands_per_s,
            figures.round_trip_p50_ms,
            figures.round_trip_p99_ms,
            figures.repeated_frames,
        )
    };
    std::iter::once(head.to_owned()).chain(rows.iter().map(line)).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod checks {
    use super::*;

    fn row(baud: u32, corrupt: f64) -> Row {
        let Ok(board) = board() else { panic!("a board of nothing can be simulated") };
        let Ok(row) = measure(PacedLine::new(board, baud), SIMULATED, baud, corrupt, Millis(20_000)) else {
            panic!("the bench failed at {baud} baud, {corrupt} damaged")
        };
        row
    }

    #[test]
    fn a_clean_line_carries_uploads_at_nine_tenths_of_its_rate_and_repeats_next_to_nothing() {
        for baud in BAUDS {
            let Row { figures, .. } = row(baud, 0.0);
            assert!(
                figures.share_of_line_rate >= 0.9 && figures.share_of_line_rate < 0.96,
                "{baud}: {figures:?}"
            );
            // Events of the MCU may take the room of an answer; then a command is turned away and comes again.
            let frames = figures.goodput_bytes_per_s * 10.0 / 128.0;
            assert!(f64::from(figures.repeated_frames) < 0.02 * frames, "{baud}: {figures:?}");
            assert_eq!(figures.damaged_frames, 0, "{baud}");
        }
    }

    #[test]
    fn a_line_that_damages_a_byte_in_ten_thousand_carries_uploads_at_seven_tenths_of_its_rate() {
        for baud in BAUDS {
            let Row { figures, .. } = row(baud, 1e-4);
            assert!(figures.share_of_line_rate >= 0.7, "{baud}: {figures:?}");
            assert!(figures.repeated_frames > 0, "{baud}: {figures:?}");
        }
    }
}
