//! `zygote settings`: what a board keeps over power cycles, and lowering its limits for the rig at hand (S13).

use crate::failure::{Failure, OrFail};
use crate::output::say;
use crate::{board_calibrations, identity};
use clap::Args;
use serde_json::{Value, json};
use zygote_controller::{SerialTransport, Session};
use zygote_protocol::{CentiCelsius, MemoryReport, MemoryState, Milliamps, Millis, Settings, SettingsReport};

/// How long an answer to the hello is waited for.
const HELLO_PATIENCE: Millis = Millis(5_000);

/// Arguments of `zygote settings`.
#[derive(Args)]
pub(crate) struct Arguments {
    /// Serial port of the board
    #[arg(long, value_name = "DEV")]
    port: String,
    /// Speed of the line
    #[arg(long, value_name = "BAUD", default_value_t = 921_600)]
    baud: u32,
    /// Highest temperature of any hinge, 0.01 °C
    #[arg(long, value_name = "CENTI_C")]
    max_temperature: Option<i16>,
    /// Longest time that a heater may be on, ms
    #[arg(long, value_name = "MS")]
    max_on: Option<u32>,
    /// Shortest rest of a heater, ms
    #[arg(long, value_name = "MS")]
    min_rest: Option<u32>,
    /// Highest sum of currents, mA
    #[arg(long, value_name = "MA")]
    supply: Option<u32>,
    /// Longest silence of the host, ms
    #[arg(long, value_name = "MS")]
    link_timeout: Option<u32>,
    /// Shortest servo pulse, us
    #[arg(long, value_name = "US")]
    shortest_pulse: Option<u16>,
    /// Longest servo pulse, us
    #[arg(long, value_name = "US")]
    longest_pulse: Option<u16>,
    /// Start from what is compiled into the board, not from what is in force
    #[arg(long)]
    reset: bool,
    /// Forget what was calibrated of every heater and servo
    #[arg(long)]
    forget_calibrations: bool,
    /// Print as JSON
    #[arg(long)]
    json: bool,
}

/// Has the board keep what is asked for, if anything is, and prints what it keeps.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let line = SerialTransport::open(&arguments.port, arguments.baud).or_bad_input()?;
    let mut session = Session::connect(line, identity::fresh(), HELLO_PATIENCE).or_failed()?;
    let before = session.settings().or_failed()?;
    let wanted = arguments.wanted(&before);
    if wanted != before.in_force {
        session.configure(wanted).or_failed()?;
    }
    if arguments.forget_calibrations {
        let known = board_calibrations::of(&mut session).or_failed()?;
        session
            .calibrate(&known.iter().map(board_calibrations::forgotten).collect::<Vec<_>>())
            .or_failed()?;
    }
    let after = session.settings().or_failed()?;
    let calibrations = board_calibrations::of(&mut session).or_failed()?;
    let memory = session.memory().or_failed()?;
    if arguments.json {
        say(format_args!(
            "{:#}",
            json!({
                "in_force": value(&after.in_force),
                "compiled": value(&after.compiled),
                "calibrations": calibrations.iter().map(board_calibrations::value).collect::<Vec<_>>(),
                "memory": { "state": state(memory.state), "damaged_records": memory.damaged },
            })
        ));
    } else {
        say(table(&after));
        calibrations.iter().map(board_calibrations::line).for_each(say);
        say(told(memory));
    }
    Ok(())
}

impl Arguments {
    fn wanted(&self, now: &SettingsReport) -> Settings {
        let mut wanted = if self.reset { now.compiled } else { now.in_force };
        let ceiling = &mut wanted.ceiling;
        set(&mut ceiling.max_temperature, self.max_temperature.map(CentiCelsius));
        set(&mut ceiling.max_on, self.max_on.map(Millis));
        set(&mut ceiling.min_rest, self.min_rest.map(Millis));
        set(&mut ceiling.supply, self.supply.map(Milliamps));
        set(&mut ceiling.link_timeout, self.link_timeout.map(Millis));
        set(&mut wanted.shortest_pulse_us, self.shortest_pulse);
        set(&mut wanted.longest_pulse_us, self.longest_pulse);
        wanted
    }
}

fn set<T>(place: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *place = value;
    }
}

/// Name, unit and value of each setting.
fn fields(settings: &Settings) -> [(&'static str, &'static str, i64); 7] {
    let Settings { ceiling, shortest_pulse_us, longest_pulse_us } = settings;
    [
        ("max_temperature", "0.01 °C", ceiling.max_temperature.0.into()),
        ("max_on", "ms", ceiling.max_on.0.into()),
        ("min_rest", "ms", ceiling.min_rest.0.into()),
        ("supply", "mA", ceiling.supply.0.into()),
        ("link_timeout", "ms", ceiling.link_timeout.0.into()),
        ("shortest_pulse", "us", (*shortest_pulse_us).into()),
        ("longest_pulse", "us", (*longest_pulse_us).into()),
    ]
}

fn value(settings: &Settings) -> Value {
    fields(settings).into_iter().map(|(name, _, value)| (name.to_owned(), Value::from(value))).collect()
}

fn table(report: &SettingsReport) -> String {
    let head = format!("{:<16}{:<9}{:>9}{:>10}", "setting", "unit", "in force", "compiled");
    let rows = fields(&report.in_force).into_iter().zip(fields(&report.compiled));
    let rows =
        rows.map(|((name, unit, ours), (_, _, most))| format!("{name:<16}{unit:<9}{ours:>9}{most:>10}"));
    std::iter::once(head).chain(rows).collect::<Vec<_>>().join("\n")
}

fn state(state: MemoryState) -> &'static str {
    match state {
        MemoryState::Kept => "kept",
        MemoryState::Blank => "blank",
        MemoryState::OtherVersion => "other version",
        MemoryState::Unusable => "unusable",
    }
}

/// What became of what was kept, and what to do about it.
fn told(memory: MemoryReport) -> String {
    let state = match memory.state {
        MemoryState::Kept => "These settings are kept in flash.",
        MemoryState::Blank => "Nothing is kept in flash: what is compiled in holds.",
        MemoryState::OtherVersion => {
            "What is kept in flash is of another firmware: what is compiled in holds. Set your limits again."
        }
        MemoryState::Unusable => {
            "The flash can't be used: what is compiled in holds, and nothing can be kept. Replace the board."
        }
    };
    let damaged = memory.damaged;
    if damaged == 0 {
        return state.to_owned();
    }
    format!(
        "{state}\nwarning: the start passed over {damaged} damaged record(s) in flash: power failed while they were written, or the flash \
         wears out. What they held is lost, and the record before them counts: check the limits above."
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_became_of_the_memory_is_told_with_what_to_do() {
        let told = |state, damaged| told(MemoryReport { state, damaged });
        assert_eq!(told(MemoryState::Kept, 0), "These settings are kept in flash.");
        assert!(told(MemoryState::Blank, 0).contains("what is compiled in holds"));
        assert!(told(MemoryState::OtherVersion, 0).contains("Set your limits again"));
        assert!(told(MemoryState::Unusable, 0).contains("Replace the board"));
        let spoiled = told(MemoryState::Kept, 2);
        assert!(spoiled.contains("2 damaged record(s)") && spoiled.contains("check the limits"), "{spoiled}");
    }
}
