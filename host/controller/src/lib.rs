//! Talks to an MCU: opens a session, uploads a program, watches its run, stops it, and tells what happened.
//!
//! ```text
//!   Schedule --program--> steps --Session--> link --Transport--> MCU (serial port, simulator)
//!                                   |
//!                                   +--> deploy --> Progress (for a display), EventLog, RunReport
//!                                   |                                            +--> drift: hinges against their calibration
//!                                   +--> calibrate --> records of hinges, which `zygote_calibration` fits
//!                                   +--> calibrate_servo --> readings of servos, of which it makes pulses
//! ```
//!
//! The MCU executes a run by itself; what stands here carries the program there and brings the news back.

pub mod calibrate;
pub mod calibrate_servo;
mod clock;
mod connect;
mod deploy;
mod drift;
mod estimate;
mod event_log;
mod inbox;
mod known;
mod link_bench;
mod program;
mod report;
mod resume;
mod serial;
mod session;
mod transport;

pub use clock::{Clock, ClockFit, Exchange};
pub use connect::ConnectError;
pub use deploy::{DeployError, Deployment, Moment, Progress, Wish, deploy};
pub use drift::{DriftError, DriftVerdict, HingeDrift, SeenMotion, Sightings};
pub use estimate::MotionState;
pub use event_log::{EventLog, Observer, Record, Times};
pub use inbox::Notice;
pub use known::{UntoldError, known};
pub use link_bench::{LinkFigures, link_bench};
pub use program::{ProgramError, limits, program};
pub use report::{HingeOutcome, HingeReport, Outcome, RunReport};
pub use resume::{EarlierRun, ResumeError};
pub use serial::{SerialError, SerialTransport, serial_ports};
pub use session::{RequestError, Session, SessionError};
pub use transport::Transport;
