//! What reads a servo hinge's angle for `zygote calibrate --servo`: lines that somebody types, a command, the simulator's truth.

use crate::output::say;
use crate::paced_line::PacedLine;
use std::io::{BufRead, Read};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};
use zygote_controller::calibrate_servo::{Answer, Protractor, Question, ReadingError};
use zygote_deployment::{Drive, Fitting};
use zygote_protocol::Millis;

/// An answer is waited for so long before the line is looked at again.
const SOON: Duration = Duration::from_millis(20);
/// A sensor is waited for.
const PATIENCE: Millis = Millis(10_000);
/// No sensor says more.
const LONGEST_WORD: u64 = 200;
const HELP: &str = "at each pulse type the angle that the hinge shows, in degrees (=-2 where it is below 0); +5 or -5 makes the pulse \
                    longer or shorter by so many us; `end`: it pushes against its end; `stop`: leave off, --resume goes on";

/// Lines from standard input.
pub(crate) struct Typed {
    lines: Receiver<String>,
    asked: Option<String>,
}

impl Typed {
    pub(crate) fn new() -> Self {
        let (typed, lines) = channel();
        // It ends with the input, or with the program: a read can't be called off.
        thread::spawn(move || {
            let mut input = std::io::stdin().lock();
            let mut line = Vec::new();
            while matches!(input.read_until(b'\n', &mut line), Ok(1..)) {
                if typed.send(String::from_utf8_lossy(&line).trim().to_owned()).is_err() {
                    break;
                }
                line.clear();
            }
        });
        Self { lines, asked: None }
    }

    /// What a line means; none for one that means nothing.
    fn meaning(line: &str) -> Option<Answer> {
        match line {
            "stop" => return Some(Answer::Stop),
            "end" => return Some(Answer::End),
            _ => {}
        }
        if line.starts_with(['+', '-']) {
            return line.parse().ok().map(Answer::Nudge);
        }
        degrees(line.strip_prefix('=').unwrap_or(line)).map(Answer::Angle)
    }
}

/// A finite number.
fn degrees(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|degrees: &f64| degrees.is_finite())
}

impl<T> Protractor<T> for Typed {
    fn ask(&mut self, question: &Question) -> Result<(), ReadingError> {
        if self.asked.is_none() {
            say(HELP);
        }
        if let Some(why) = &question.again {
            say(format_args!("{why}: please read it again"));
        }
        let sought = question.for_deg.map_or_else(|| "its middle".to_owned(), |angle| format!("{angle} deg"));
        let state =
            if question.relaxed { "it pushed, and is relaxed now: where does it stand" } else { "angle" };
        let Question { hinge, pulse_us, .. } = question;
        let asked = format!("hinge {hinge}, {pulse_us} us, looking for {sought}: {state}?");
        say(&asked);
        self.asked = Some(asked);
        Ok(())
    }

    fn answer(&mut self, _: &T) -> Result<Option<Answer>, ReadingError> {
        let line = match self.lines.recv_timeout(SOON) {
            Ok(line) => line,
            Err(RecvTimeoutError::Timeout) => return Ok(None),
            Err(RecvTimeoutError::Disconnected) => {
                say("the input has ended");
                return Ok(Some(Answer::Stop));
            }
        };
        let meaning = Self::meaning(&line);
        if meaning.is_none() {
            say(format_args!("{line:?} isn't understood: {HELP}"));
            say(self.asked.as_deref().unwrap_or_default());
        }
        Ok(meaning)
    }
}

/// A command that prints the angle.
pub(crate) struct CommandSensor {
    command: String,
    patience: Millis,
    running: Option<Running>,
}

struct Running {
    child: Child,
    since: Instant,
    printed: Receiver<Vec<u8>>,
}

impl CommandSensor {
    pub(crate) fn new(command: &str) -> Self {
        Self { command: command.to_owned(), patience: PATIENCE, running: None }
    }

    /// Ends a command that nobody waits for any more.
    fn end(&mut self) {
        if let Some(mut running) = self.running.take() {
            // It may have ended by itself meanwhile.
            running.child.kill().and_then(|()| running.child.wait()).ok();
        }
    }

    fn start(&mut self, question: &Question) -> std::io::Result<()> {
        self.end();
        let mut shell = Command::new("sh");
        shell.args(["-c", &self.command]).stdin(Stdio::null()).stdout(Stdio::piped());
        shell.env("ZYGOTE_HINGE", question.hinge.to_string());
        shell.env("ZYGOTE_PULSE_US", question.pulse_us.to_string());
        let mut child = shell.spawn()?;
        let (read, printed) = channel();
        if let Some(output) = child.stdout.take() {
            thread::spawn(move || {
                let mut bytes = Vec::new();
                // What was read until an error is what it printed; nobody waits where this is not sent.
                output.take(LONGEST_WORD).read_to_end(&mut bytes).ok();
                read.send(bytes).ok();
            });
        }
        self.running = Some(Running { child, since: Instant::now(), printed });
        Ok(())
    }

    /// The number, once the command has ended.
    fn look(&mut self) -> Result<Option<f64>, ReadingError> {
        let (command, after) = (self.command.clone(), self.patience);
        let Some(running) = &mut self.running else { return Ok(None) };
        let late = running.since.elapsed() > Duration::from_millis(after.0.into());
        let status = match running.child.try_wait() {
            Ok(Some(status)) => status,
            Ok(None) if !late => {
                thread::sleep(SOON);
                return Ok(None);
            }
            Ok(None) => {
                self.end();
                return Err(ReadingError::TooLong { command, after });
            }
            Err(error) => return Err(ReadingError::Failed { command, code: error.to_string() }),
        };
        if !status.success() {
            let code = status.code().map_or_else(|| status.to_string(), |code| format!("exit code {code}"));
            return Err(ReadingError::Failed { command, code });
        }
        // Something that it has started may still hold its output.
        let printed = match running.printed.recv_timeout(SOON) {
            Ok(printed) => printed,
            Err(RecvTimeoutError::Timeout) if !late => return Ok(None),
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {
                return Err(ReadingError::TooLong { command, after });
            }
        };
        self.running = None;
        let printed = String::from_utf8_lossy(&printed).trim().to_owned();
        degrees(&printed).map(Some).ok_or(ReadingError::NoNumber { command, printed })
    }
}

impl<T> Protractor<T> for CommandSensor {
    fn ask(&mut self, question: &Question) -> Result<(), ReadingError> {
        self.start(question).map_err(|source| ReadingError::Start { command: self.command.clone(), source })
    }

    fn answer(&mut self, _: &T) -> Result<Option<Answer>, ReadingError> {
        Ok(self.look()?.map(Answer::Angle))
    }
}

impl Drop for CommandSensor {
    fn drop(&mut self) {
        self.end();
    }
}

/// The simulated hinge's true angle.
pub(crate) struct Truth {
    /// The servo output of each hinge.
    channels: Vec<Option<u16>>,
    asked: Option<u16>,
}

impl Truth {
    pub(crate) fn new(fittings: &[Fitting]) -> Self {
        let channel = |fitting: &Fitting| matches!(fitting.drive, Drive::Servo(_)).then_some(fitting.channel);
        Self { channels: fittings.iter().map(channel).collect(), asked: None }
    }
}

impl Protractor<PacedLine> for Truth {
    fn ask(&mut self, question: &Question) -> Result<(), ReadingError> {
        self.asked = self.channels.get(question.hinge).copied().flatten();
        Ok(())
    }

    fn answer(&mut self, line: &PacedLine) -> Result<Option<Answer>, ReadingError> {
        let Some(channel) = self.asked else { return Ok(None) };
        let servo = line.board().plant().servo_hinges().get(usize::from(channel));
        let angle_deg = servo.ok_or(ReadingError::NoServo { channel })?.angle_deg();
        Ok(Some(Answer::Angle(angle_deg)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_mean_angles_nudges_ends_and_stops_and_nothing_else() {
        for (line, meaning) in [
            ("89.5", Some(Answer::Angle(89.5))),
            ("=-2", Some(Answer::Angle(-2.0))),
            ("+5", Some(Answer::Nudge(5))),
            ("-5", Some(Answer::Nudge(-5))),
            ("end", Some(Answer::End)),
            ("stop", Some(Answer::Stop)),
            ("89,5", None),
            ("+5.5", None),
            ("nan", None),
            ("inf", None),
            ("", None),
        ] {
            assert_eq!(Typed::meaning(line), meaning, "{line:?}");
        }
    }

    /// Asks a command until it answers.
    fn read(command: &str, patience: Millis) -> Result<f64, String> {
        let mut sensor = CommandSensor::new(command);
        sensor.patience = patience;
        let question = Question { hinge: 3, pulse_us: 1167, for_deg: Some(90), relaxed: false, again: None };
        sensor.start(&question).unwrap();
        loop {
            match sensor.look() {
                Ok(None) => {}
                Ok(Some(degrees)) => return Ok(degrees),
                Err(error) => return Err(error.to_string()),
            }
        }
    }

    #[test]
    fn a_sensor_is_a_command_that_prints_one_number() {
        assert_eq!(read("echo ' 91.25 '", PATIENCE), Ok(91.25));
        assert_eq!(read("echo $ZYGOTE_HINGE$ZYGOTE_PULSE_US", PATIENCE), Ok(31167.0));
        for (command, message) in [
            ("echo 90 deg", "printed \"90 deg\"; expected one number, in degrees"),
            ("true", "printed \"\"; expected one number"),
            ("echo nan", "printed \"nan\""),
            ("echo 90; exit 3", "ended with exit code 3; expected 0"),
            ("kill -9 $$", "ended with signal"),
            ("zygote-no-such-command 2>/dev/null", "ended with exit code 127"),
        ] {
            let error = read(command, PATIENCE).unwrap_err();
            assert!(error.contains(message), "{error}");
        }
    }

    #[test]
    fn a_sensor_that_hangs_is_ended() {
        let error = read("exec sleep 60", Millis(100)).unwrap_err();
        assert!(error.contains("hasn't ended after 100 ms"), "{error}");
        let error = read("sleep 5 2>/dev/null & echo 90", Millis(100)).unwrap_err();
        assert!(error.contains("hasn't ended after 100 ms"), "its output stays open: {error}");
    }
}
