//! What collides when a plan opens: as its schedule's certificate says, else as a check of the order finds.

use serde::Serialize;
use zygote_deployment::Schedule;
use zygote_deployment::motion::{Certificate, Collision, MotionError, Obstacle, Options, Thickness, check};
use zygote_stacking::Plan;

/// With more panels than this nothing is checked before the page opens: it would keep the user waiting.
const MOST_PANELS: usize = 1_000;

/// What is known of collisions.
#[derive(Serialize)]
pub(super) struct Checked {
    /// In a sentence.
    told: String,
    /// Whether anything was checked.
    known: bool,
    collisions: Vec<Meeting>,
}

/// A collision.
#[derive(Serialize)]
struct Meeting {
    told: String,
    /// The panels that meet; one, where it meets the ground.
    panels: Vec<usize>,
}

impl Checked {
    /// What is known of an order.
    pub(super) fn of(plan: &Plan, schedule: Option<&Schedule>, order: &[usize]) -> Result<Self, MotionError> {
        if let Some(certificate) = schedule.and_then(|schedule| schedule.certificate.as_ref()) {
            return Ok(Self::certified(certificate));
        }
        if plan.panels() > MOST_PANELS {
            return Ok(Self {
                told: "Not checked; `zygote schedule` and `zygote check --motion` do it".to_owned(),
                known: false,
                collisions: Vec::new(),
            });
        }
        let report = check(plan, order, Thickness::ideal(plan), &Options::default())?;
        let collisions: Vec<_> = report.collisions.iter().map(Meeting::found).collect();
        Ok(Self { told: summary(collisions.len(), "ideal panels, one by one"), known: true, collisions })
    }

    fn certified(certificate: &Certificate) -> Self {
        let collisions: Vec<_> = certificate.collisions.iter().map(|told| Meeting::told(told)).collect();
        let plates = if certificate.ideal { "ideal" } else { "thick" };
        let how = format!("{plates} panels, as the schedule certifies");
        Self { told: summary(collisions.len(), &how), known: true, collisions }
    }
}

fn summary(collisions: usize, how: &str) -> String {
    match collisions {
        0 => format!("No collision ({how})"),
        1 => format!("1 collision ({how})"),
        more => format!("{more} collisions ({how})"),
    }
}

impl Meeting {
    fn found((step, collision): &(usize, Collision)) -> Self {
        let mut panels = vec![collision.panel];
        if let Obstacle::Panel(panel) = collision.obstacle {
            panels.push(panel);
        }
        Self { told: format!("step {step}: {collision}"), panels }
    }

    /// A certificate holds collisions in words only: the panels are the numbers that follow that word.
    fn told(told: &str) -> Self {
        let words: Vec<&str> = told.split_whitespace().collect();
        let panels = words.windows(2).filter(|pair| pair[0] == "panel");
        Self { told: told.to_owned(), panels: panels.filter_map(|pair| pair[1].parse().ok()).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_of_a_collision_in_words_are_those_that_met() {
        let collision = Collision {
            hinge: 5,
            panel: 7,
            obstacle: Obstacle::Panel(31),
            from_deg: 12.0,
            to_deg: 12.5,
            depth: 0.25,
        };
        let found = Meeting::found(&(3, collision));
        assert_eq!(found.panels, [7, 31]);
        assert_eq!(Meeting::told(&found.told).panels, found.panels);
        let ground = Meeting::found(&(3, Collision { obstacle: Obstacle::Ground, ..collision }));
        assert_eq!(ground.panels, [7]);
        assert_eq!(Meeting::told(&ground.told).panels, ground.panels);
    }
}
