//! How a verb ends when it doesn't succeed: what the user reads and the exit code that scripts read.

use std::process::ExitCode;

/// Why a verb stopped.
pub(crate) enum Failure {
    /// What the user gave can't be used: exit code 2, as for a wrong option.
    BadInput(anyhow::Error),
    /// The input was good, the work didn't succeed: exit code 1.
    Failed(anyhow::Error),
}

impl Failure {
    /// Prints the message with its causes, and returns the exit code.
    #[expect(clippy::print_stderr, reason = "the one place where errors reach the user")]
    pub(crate) fn report(self) -> ExitCode {
        let (error, code) = match self {
            Self::BadInput(error) => (error, 2),
            Self::Failed(error) => (error, 1),
        };
        eprintln!("error: {error}");
        for cause in error.chain().skip(1) {
            eprintln!("  because: {cause}");
        }
        ExitCode::from(code)
    }
}

/// Says which kind of failure an error is.
pub(crate) trait OrFail<T> {
    /// An error here means that the user's input can't be used.
    fn or_bad_input(self) -> Result<T, Failure>;
    /// An error here means that the work failed.
    fn or_failed(self) -> Result<T, Failure>;
}

impl<T, E: Into<anyhow::Error>> OrFail<T> for Result<T, E> {
    fn or_bad_input(self) -> Result<T, Failure> {
        self.map_err(|error| Failure::BadInput(error.into()))
    }

    fn or_failed(self) -> Result<T, Failure> {
        self.map_err(|error| Failure::Failed(error.into()))
    }
}
