//! The progress of a calibration on the error output, where that is a terminal: how long it still takes, and how warm each hinge is.

use indicatif::{ProgressBar, ProgressStyle};
use std::cell::Cell;
use std::fmt::Write;
use zygote_controller::calibrate::{Progress, Running};

/// Steps of the bar.
const STEPS: u64 = 1000;
/// More hinges have no room in a line.
const MOST_SHOWN: usize = 6;

/// The bar.
pub(crate) struct Display {
    bar: ProgressBar,
    /// The longest that it was ever thought to take.
    whole_s: Cell<f64>,
}

impl Display {
    pub(crate) fn new() -> Self {
        let bar = ProgressBar::new(STEPS);
        // The template is a constant of ours; if it were wrong, the plain bar would do.
        if let Ok(style) = ProgressStyle::with_template("{bar:20} {elapsed}  {wide_msg}") {
            bar.set_style(style);
        }
        Self { bar, whole_s: Cell::new(0.0) }
    }

    pub(crate) fn show(&self, progress: &Progress) {
        self.whole_s.set(self.whole_s.get().max(progress.left_s));
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 1000")]
        let done = ((1.0 - progress.left_s / self.whole_s.get().max(1.0)) * STEPS as f64) as u64;
        // A guess that grows doesn't move the bar back.
        self.bar.set_position(done.max(self.bar.position()));
        self.bar.set_message(line(progress));
    }

    pub(crate) fn close(&self) {
        self.bar.finish_and_clear();
    }
}

/// `2 of 16 ended, about 3:20 left; 14 hinges side by side: ramp; 3 62 °C, 5 60 °C, 1 cools 41 °C, 11 more`
fn line(progress: &Progress) -> String {
    let Progress { ended, total, doing, running, left_s } = progress;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some minutes; it saturates")]
    let left_s = left_s.round() as u64;
    let mut line = format!(
        "{ended} of {total} ended, about {}:{:02} of the rig's time left; {doing}",
        left_s / 60,
        left_s % 60
    );
    let mut mark = "; ";
    for Running { hinge, reading_c, heated } in running.iter().take(MOST_SHOWN) {
        // Writing to a string cannot fail.
        let _ = write!(line, "{mark}{hinge} {}{reading_c:.0} °C", if *heated { "" } else { "cools " });
        mark = ", ";
    }
    if let Some(more @ 1..) = running.len().checked_sub(MOST_SHOWN) {
        let _ = write!(line, ", {more} more");
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_tells_time_left_and_the_temperature_of_each_hinge_that_it_has_room_for() {
        let running = |hinge| Running { hinge, reading_c: 61.6, heated: hinge != 7 };
        let mut progress = Progress {
            ended: 2,
            total: 16,
            doing: "2 hinges side by side: ramp".to_owned(),
            running: vec![running(3), running(7)],
            left_s: 200.4,
        };
        let expected = "2 of 16 ended, about 3:20 of the rig's time left; 2 hinges side by side: ramp; 3 62 °C, 7 cools 62 °C";
        assert_eq!(line(&progress), expected);
        progress.running = (0..9).map(running).collect();
        assert!(line(&progress).ends_with(", 5 62 °C, 3 more"), "{}", line(&progress));
    }
}
