//! A schedule as comma-separated values, a row a step.

use crate::schedule::{Fingerprint, Schedule, VerifyError};
use std::fmt::Write as _;
use zygote_stacking::{HingeKind, Plan};

/// Checks that a schedule was made for this plan, for those who know no rig; [`Schedule::verify`] looks at all else.
///
/// # Errors
/// [`VerifyError`] if it is that of another plan, or has a hinge that the plan hasn't.
pub fn belongs(schedule: &Schedule, plan: &Plan) -> Result<(), VerifyError> {
    let fingerprint = Fingerprint::of(plan);
    if schedule.plan_crc64 != fingerprint {
        return Err(VerifyError::OtherPlan { schedule: schedule.plan_crc64, plan: fingerprint });
    }
    let hinges = plan.hinges.len();
    match schedule.steps.iter().enumerate().find(|(_, step)| step.hinge >= hinges) {
        None => Ok(()),
        Some((index, step)) => Err(VerifyError::Step {
            step: index,
            hinge: step.hinge,
            key: "hinge",
            expected: format!("less than {hinges}"),
            found: step.hinge.to_string(),
        }),
    }
}

/// The cell and the height of every panel.
pub fn places(plan: &Plan) -> Vec<([i32; 2], usize)> {
    let mut places = vec![([0, 0], 0); plan.panels()];
    for pile in &plan.piles {
        for (height, panel) in pile.panels.iter().enumerate() {
            if let Some(place) = places.get_mut(*panel) {
                *place = (pile.cell, height);
            }
        }
    }
    places
}

/// The word for a hinge's kind.
pub const fn kind_name(kind: HingeKind) -> &'static str {
    match kind {
        HingeKind::Fold => "fold",
        HingeKind::Bridge => "bridge",
    }
}

/// The steps of a plan's schedule, under one line of headings. `after` has steps, parted by spaces.
///
/// # Errors
/// [`VerifyError`] if the schedule is that of another plan.
pub fn csv(schedule: &Schedule, plan: &Plan) -> Result<String, VerifyError> {
    belongs(schedule, plan)?;
    let places = places(plan);
    let mut text =
        "step,hinge,kind,drive,panel_a,panel_b,cell_a_x,cell_a_y,height_a,cell_b_x,cell_b_y,height_b,side_a,\
                    node,channel,start_ms,end_ms,after,from_deg,to_deg,current_ma,hold_current_ma\n"
            .to_owned();
    for (index, step) in schedule.steps.iter().enumerate() {
        let hinge = &plan.hinges[step.hinge];
        let [a, b] = hinge.panels;
        let place = |panel: usize| places.get(panel).copied().unwrap_or_default();
        let (([ax, ay], ah), ([bx, by], bh)) = (place(a), place(b));
        let after: Vec<_> = step.after.iter().map(ToString::to_string).collect();
        // Writing to a String can't fail.
        let _infallible = writeln!(
            text,
            "{index},{},{},{},{a},{b},{ax},{ay},{ah},{bx},{by},{bh},{},{},{},{},{},{},{},{},{},{}",
            step.hinge,
            kind_name(hinge.kind),
            step.motion.kind().name(),
            hinge.side.letter(),
            step.node,
            step.channel,
            step.start.0,
            step.opened().0,
            after.join(" "),
            step.from_opening_deg,
            step.opening_deg,
            step.current.0,
            step.hold_current.0,
        );
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::Rig;
    use crate::testing::{real_plans, rig_text};
    use crate::{Limits, Order, Tree};

    fn scheduled(plan: &Plan) -> Schedule {
        let rig = Rig::read("rig.toml", &rig_text("")).expect("a good rig");
        let order = Order::of_tree(&Tree::new(plan).expect("a tree"));
        Schedule::plan(plan, &rig, &order, &Limits::at_most(1)).expect("a schedule")
    }

    #[test]
    fn every_step_has_a_row_with_its_place_its_time_and_what_it_waits_for() {
        let plan = real_plans().remove(1);
        let schedule = scheduled(&plan);
        let text = csv(&schedule, &plan).expect("its own plan");
        let rows: Vec<Vec<_>> = text.lines().map(|line| line.split(',').collect()).collect();
        assert_eq!(rows.len(), 1 + plan.hinges.len());
        assert!(rows.iter().all(|row| row.len() == rows[0].len()));
        let column = |name: &str| rows[0].iter().position(|head| *head == name).expect("a heading");
        for (index, (step, row)) in schedule.steps.iter().zip(&rows[1..]).enumerate() {
            let number = |name: &str| row[column(name)].parse::<usize>().expect("a number");
            assert_eq!((number("step"), number("hinge")), (index, step.hinge));
            assert_eq!([number("panel_a"), number("panel_b")], plan.hinges[step.hinge].panels);
            assert_eq!(plan.piles[0].panels[number("height_b")], number("panel_b"));
            assert_eq!(number("end_ms") as u64, step.start.0 + step.duration.0);
            let expected = index.checked_sub(1).map_or(String::new(), |last| last.to_string());
            assert_eq!(row[column("after")], expected);
        }
    }

    #[test]
    fn a_schedule_of_another_plan_has_no_table() {
        let plans = real_plans();
        let schedule = scheduled(&plans[0]);
        let refusal = csv(&schedule, &plans[1]).expect_err("another plan").to_string();
        assert!(refusal.starts_with("schedule: it belongs to the plan"), "{refusal}");
    }
}
