//! What reads a hinge's angle: a person at a terminal, a command, the simulator's truth.

use zygote_protocol::Millis;

/// What is to be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Question {
    /// The hinge.
    pub hinge: usize,
    /// The pulse that it is held with, or was.
    pub pulse_us: u16,
    /// The angle that is looked for, degrees.
    pub for_deg: Option<u16>,
    /// It pushed against something and was relaxed.
    pub relaxed: bool,
    /// Why the same is asked again.
    pub again: Option<String>,
}

/// What is answered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Answer {
    /// The hinge's opening angle, degrees.
    Angle(f64),
    /// Try a pulse that is longer by so many microseconds.
    Nudge(i16),
    /// It has come to its end and pushes.
    End,
    /// Leave off.
    Stop,
}

/// Why no angle can be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadingError {
    /// The command can't be started.
    #[error("`{command}` can't be started")]
    Start {
        /// The command.
        command: String,
        /// What the system says.
        #[source]
        source: std::io::Error,
    },
    /// It takes too long.
    #[error("`{command}` hasn't ended after {} ms; expected one number, in degrees, on its standard output", .after.0)]
    TooLong {
        /// The command.
        command: String,
        /// So long it was waited for.
        after: Millis,
    },
    /// It failed.
    #[error("`{command}` ended with {code}; expected 0, and one number, in degrees, on its standard output")]
    Failed {
        /// The command.
        command: String,
        /// Its exit code, or the signal.
        code: String,
    },
    /// It says something else.
    #[error("`{command}` printed {printed:?}; expected one number, in degrees")]
    NoNumber {
        /// The command.
        command: String,
        /// What it printed.
        printed: String,
    },
    /// The simulated board has no such servo.
    #[error("the simulated board has no servo channel {channel}")]
    NoServo {
        /// The channel.
        channel: u16,
    },
}

/// Reads angles, without keeping whoever asks from the line.
pub trait Protractor<T> {
    /// Asks.
    ///
    /// # Errors
    /// [`ReadingError`], where nothing can be read.
    fn ask(&mut self, question: &Question) -> Result<(), ReadingError>;

    /// The answer to what was asked last, once it is there; returns soon.
    ///
    /// # Errors
    /// [`ReadingError`], where nothing can be read.
    fn answer(&mut self, line: &T) -> Result<Option<Answer>, ReadingError>;
}
