//! Rehearsals: the real controller deploys over a simulated line on a simulated board, something goes wrong, and the
//! outcome is judged by the plant's true temperatures, currents and angles, not by what the firmware says of itself.
//!
//! ```text
//!   Scenario (a file), campaign (chance) --> Trial --run--> Rehearsed --judge--> breaches of the safety rules
//!                                              |
//!                          Stage: Line, Board, Script of causes, Witness of the truth
//! ```

mod board;
mod calibration;
pub mod campaign;
mod cause;
mod judge;
mod run;
pub mod scenario;
mod script;
mod stage;
mod subject;
mod transport;
mod wiretap;
mod witness;

pub use board::{BoardError, bench, board, channels, emulated, plant};
pub use cause::{Cause, Way, What, When};
pub use judge::{Breach, Excuses, judge, judge_calibration, margin_k};
pub use run::{Ending, Rehearsed, Trial};
pub use scenario::{Scenario, ScenarioError, Verdict};
pub use script::Script;
pub use stage::Stage;
pub use subject::Subject;
pub use wiretap::Wiretap;
pub use witness::{ANGLE_TOLERANCE_DEG, HingeTruth, Span, Watch, Witness};
