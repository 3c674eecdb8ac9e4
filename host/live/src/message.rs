//! What goes over a page's line, as JSON: one message a text. `docs/src/live.md` lists them.

use crate::stage::{Order, Stage};
use serde::{Deserialize, Serialize};
use zygote_controller::{MotionState, Progress, Record, RunReport};
use zygote_deployment::{Direction, Millis, Schedule};

/// The version of the messages.
pub const VERSION: u32 = 1;

/// What a page is told.
#[derive(Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Told<'a> {
    /// The page is let in.
    Welcome {
        /// Of the messages.
        version: u32,
    },
    /// The page isn't let in, or an order isn't taken.
    Refused {
        /// Which order; none where the page isn't let in.
        order: Option<&'a str>,
        /// Why.
        why: &'a str,
    },
    /// Runs on offer.
    Choices {
        /// By their numbers.
        runs: &'a [Choice],
    },
    /// A run, or what is left of one, is loaded: what was told before is over.
    Begin(&'a Begin),
    /// A line of the event log.
    Event(&'a Record),
    /// A look at the rig.
    Look(&'a Look),
    /// Where the run is.
    Stage(&'a Stage),
    /// Who has control.
    Control {
        /// This page.
        you: bool,
        /// Anyone.
        taken: bool,
        /// How many pages watch.
        pages: usize,
    },
    /// A stop was heard by this program, and goes to the MCU.
    Stopping {
        /// The page's number of it.
        id: u32,
    },
    /// A stop that no MCU has confirmed.
    Unconfirmed {
        /// Why.
        why: &'a str,
    },
    /// Something that didn't work out.
    Trouble {
        /// In a sentence.
        told: &'a str,
    },
    /// How the run ended.
    Report(&'a RunReport),
}

impl Told<'_> {
    /// As a text.
    ///
    /// # Errors
    /// A number that JSON has no word for.
    pub fn text(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string(self)
    }
}

/// A run on offer.
#[derive(Debug, Clone, Serialize)]
pub struct Choice {
    /// File names of what is run.
    pub file: String,
    /// How many hinges it moves.
    pub hinges: usize,
    /// `deploy` or `fold`.
    pub direction: Direction,
    /// How long it takes, s.
    pub expected_s: f64,
}

/// What is about to run.
#[derive(Debug, Clone, Serialize)]
pub struct Begin {
    /// Of the messages.
    pub version: u32,
    /// Which of the runs on offer.
    pub run: usize,
    /// File name of what is run.
    pub file: String,
    /// Name of the rig.
    pub rig: String,
    /// Where it runs.
    pub line: String,
    /// `deploy` or `fold`.
    pub direction: Direction,
    /// How many seconds of the run pass in a second; a simulator's, where it isn't 1.
    pub pace: f64,
    /// Most current that the supply gives, A.
    pub current_limit_a: f64,
    /// What is expected of each hinge, in the order of the program.
    pub steps: Vec<Expected>,
    /// Hinges that stand at their angle already.
    pub open: Vec<usize>,
}

/// What is expected of a hinge, from the start of the run.
#[derive(Debug, Clone, Serialize)]
pub struct Expected {
    /// Number of the hinge in the plan.
    pub hinge: usize,
    /// What moves it.
    pub kind: &'static str,
    /// When it starts, s.
    pub start_s: f64,
    /// When it is at its angle, s.
    pub opened_s: f64,
    /// Hinges that have to be at theirs before.
    pub after: Vec<usize>,
}

/// What a schedule expects of its hinges.
pub fn expected(schedule: &Schedule) -> Vec<Expected> {
    let steps = schedule.steps.iter().map(|step| Expected {
        hinge: step.hinge,
        kind: step.motion.kind().name(),
        start_s: seconds(step.start),
        opened_s: seconds(step.opened()),
        after: step.after.iter().filter_map(|before| Some(schedule.steps.get(*before)?.hinge)).collect(),
    });
    steps.collect()
}

#[expect(clippy::cast_precision_loss, reason = "a schedule is far shorter than 2^52 ms")]
fn seconds(time: Millis) -> f64 {
    time.0 as f64 / 1e3
}

/// A look at the rig.
#[derive(Debug, Clone, Serialize)]
pub struct Look {
    mcu_us: u64,
    supply_v: f64,
    current_a: f64,
    opened: usize,
    motions: Vec<Moving>,
}

/// A hinge under way.
#[derive(Debug, Clone, Serialize)]
struct Moving {
    hinge: usize,
    phase: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    temperature_c: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    duty: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    opening_deg: Option<f64>,
}

impl Look {
    /// When, by the MCU's clock.
    pub(crate) fn mcu_us(&self) -> u64 {
        self.mcu_us
    }
}

impl From<&Progress> for Look {
    fn from(progress: &Progress) -> Self {
        let moving = |motion: &MotionState| Moving {
            hinge: motion.hinge,
            phase: motion.phase,
            temperature_c: motion.temperature_c,
            duty: motion.duty,
            opening_deg: motion.opening_deg.map(|degrees| (degrees * 10.0).round() / 10.0),
        };
        Self {
            mcu_us: progress.at.0,
            supply_v: f64::from(progress.supply.0) / 1e3,
            current_a: f64::from(progress.current.0) / 1e3,
            opened: progress.opened,
            motions: progress.motions.iter().map(moving).collect(),
        }
    }
}

/// What a page says.
#[derive(Debug, PartialEq, Eq, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub(crate) enum Said {
    /// The first message.
    Hello {
        /// Of the messages.
        version: u32,
        /// From the page's address.
        token: String,
        /// It would have control, if nobody has.
        control: bool,
    },
    /// It would have control, or gives it up.
    Control {
        /// Have.
        take: bool,
    },
    /// It wants something done; only of the page that has control.
    Order(Order),
    /// Everything off, now; of every page.
    Stop {
        /// The page's number of it.
        id: u32,
    },
}

impl Said {
    pub(crate) fn read(text: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_are_what_the_book_says() {
        let text = |told: Told<'_>| told.text().expect("JSON");
        assert_eq!(text(Told::Event(&Record::Paused)), r#"{"type":"event","kind":"paused"}"#);
        let opened = Record::Opened { mcu_us: 7, step: 0, hinge: 3 };
        assert_eq!(
            text(Told::Event(&opened)),
            r#"{"type":"event","kind":"opened","mcu_us":7,"step":0,"hinge":3}"#
        );
        assert_eq!(
            text(Told::Stage(&Stage::running())),
            r#"{"type":"stage","stage":"running","told":"The MCU goes on by itself.","can":["pause"],"interrupted":[]}"#
        );
    }

    #[test]
    fn what_a_page_says_is_read_to_the_letter() {
        let read = |text| Said::read(text).ok();
        assert_eq!(read(r#"{"type":"stop","id":3}"#), Some(Said::Stop { id: 3 }));
        assert_eq!(
            read(r#"{"type":"order","order":"choose","run":2}"#),
            Some(Said::Order(Order::Choose { run: 2 }))
        );
        assert_eq!(
            read(r#"{"type":"order","order":"resume"}"#),
            Some(Said::Order(Order::Resume { back: false }))
        );
        for wrong in [
            "",
            "[]",
            r#"{"type":"order"}"#,
            r#"{"type":"order","order":"fly"}"#,
            r#"{"type":"stop","id":-1}"#,
        ] {
            assert_eq!(read(wrong), None, "{wrong}");
        }
    }
}
