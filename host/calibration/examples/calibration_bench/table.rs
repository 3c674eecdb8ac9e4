//! The tables.

use crate::drifts::{self, Since};
use crate::faults::{self, accepted};
use crate::hinges::Subject;
use crate::outcome::Outcome;
use std::collections::BTreeMap;
use zygote_calibration::{Bounds, Drift, Quantity, Verdict};

/// Sound hinges, a line for each quantity.
pub(crate) fn sound(outcomes: &[Outcome]) {
    println!("| quantity | identified | median error | worst | accepted | within | covered | median ± |");
    println!("|---|---|---|---|---|---|---|---|");
    for quantity in Quantity::ALL.into_iter().filter(|quantity| *quantity != Quantity::Opening) {
        let mut errors = Vec::new();
        let mut halves = Vec::new();
        let (mut within, mut covered) = (0, 0);
        let relative = matches!(quantity.unit(), "K/W" | "ohm" | "J") || quantity == Quantity::TimeConstant;
        for (_, truth, verdict) in
            outcomes.iter().flat_map(|outcome| &outcome.verdicts).filter(|row| row.0 == quantity)
        {
            let Verdict::Identified(at) = verdict else { continue };
            let error = (at.value - truth).abs();
            let scale = if relative { 100.0 / truth } else { 1.0 };
            errors.push(error * scale);
            halves.push((at.high - at.low) / 2.0 * scale);
            within += usize::from(accepted(quantity, *truth).is_some_and(|most| error <= most));
            covered += usize::from((at.low..=at.high).contains(truth));
        }
        let count = errors.len();
        let unit = if relative { "%" } else { quantity.unit() };
        let most = accepted(quantity, 100.0).map_or("none".to_owned(), |most| format!("{most} {unit}"));
        println!(
            "| {quantity} | {count} of {} | {:.2} {unit} | {:.2} {unit} | {most} | {} | {} | {:.2} {unit} |",
            outcomes.len(),
            median(&mut errors),
            errors.last().copied().unwrap_or(f64::NAN),
            percent(within, count),
            percent(covered, count),
            median(&mut halves),
        );
    }
    for (name, of) in [("heat", true), ("cool", false)] {
        let mut errors: Vec<f64> = outcomes
            .iter()
            .filter_map(|outcome| outcome.held_out)
            .map(|held_out| if of { held_out.heat_rmse_k } else { held_out.cool_rmse_k })
            .collect();
        let within = errors.iter().filter(|error| **error <= 2.0).count();
        let count = errors.len();
        println!(
            "| held out, {name} (rms) | {count} of {} | {:.2} K | {:.2} K | 2 K | {} | | |",
            outcomes.len(),
            median(&mut errors),
            errors.last().copied().unwrap_or(f64::NAN),
            percent(within, count)
        );
    }
    let mut lengths: Vec<f64> = outcomes.iter().map(|outcome| outcome.length_s).collect();
    let highest_c = outcomes.iter().map(|outcome| outcome.highest_c).fold(0.0, f64::max);
    let strong = outcomes.iter().filter(|outcome| outcome.can_reach_af);
    let middle = median(&mut lengths);
    println!(
        "\nOne calibration takes {middle:.0} s ({:.0} s at most); the hottest reading was {highest_c:.1} °C; {} ended early; \
         {} of {} supplies take their hinge past Af within a pulse, and {} of these have an Af.\n",
        lengths.last().copied().unwrap_or(0.0),
        outcomes.iter().filter(|outcome| outcome.ended.is_some()).count(),
        strong.clone().count(),
        outcomes.len(),
        strong.filter(|outcome| outcome.has(Quantity::AusteniteFinish)).count(),
    );
}

/// Broken hinges, a line for each fault.
pub(crate) fn broken(hinges: &[Vec<faults::Verdict>]) {
    #[derive(Default)]
    struct Row {
        runs: usize,
        noticed: usize,
        without: usize,
        wrong: usize,
    }
    let mut rows: BTreeMap<String, Row> = BTreeMap::new();
    for verdict in hinges.iter().flatten() {
        let name = format!("{:?}", verdict.fault);
        let name = name.split(['(', ' ', '{']).next().unwrap_or_default().to_owned();
        let row = rows.entry(name).or_default();
        row.runs += 1;
        row.noticed += usize::from(verdict.noticed);
        row.without += usize::from(verdict.identified == 0);
        row.wrong += usize::from(verdict.is_wrong());
    }
    println!("| fault | runs | named | without any value | a confident wrong value |\n|---|---|---|---|---|");
    for (name, row) in rows {
        println!("| `{name}` | {} | {} | {} | {} |", row.runs, row.noticed, row.without, row.wrong);
    }
}

/// What runs of one hinge say of it, each change `runs` times; nothing where its calibration isn't whole.
pub(crate) fn seen(
    subject: &Subject,
    bounds: &Bounds,
    runs: u64,
    seed: u64,
    verbose: bool,
) -> Result<Vec<(Since, Drift)>, String> {
    let text = |error: Box<dyn std::error::Error>| error.to_string();
    let Some(calibrated) = drifts::calibrate(subject, bounds).map_err(text)? else { return Ok(Vec::new()) };
    let mut all = Vec::new();
    for since in Since::ALL {
        for run in 0..runs {
            let drift = drifts::opened(subject, &calibrated, since, seed * 1_000 + run).map_err(text)?;
            if verbose && (since == Since::Nothing) != (drift == Drift::Keep) {
                println!("{seed} {since:?}: {drift:?}");
            }
            all.push((since, drift));
        }
    }
    Ok(all)
}

/// Hinges after their calibration, a line for each change.
pub(crate) fn drifts(hinges: &[Vec<(Since, Drift)>]) {
    println!("| changed since | runs | recalibrate | can't tell | keep |\n|---|---|---|---|---|");
    for since in Since::ALL {
        let of: Vec<&Drift> =
            hinges.iter().flatten().filter(|row| row.0 == since).map(|row| &row.1).collect();
        let count = |wanted: fn(&Drift) -> bool| of.iter().filter(|drift| wanted(drift)).count();
        println!(
            "| {} | {} | {} | {} | {} |",
            since.name(),
            of.len(),
            count(|drift| matches!(drift, Drift::Recalibrate { .. })),
            count(|drift| matches!(drift, Drift::CannotTell { .. })),
            count(|drift| matches!(drift, Drift::Keep)),
        );
    }
}

/// Sorts them, and gives the middle one.
fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

fn percent(part: usize, whole: usize) -> String {
    format!("{:.1} %", 100.0 * part as f64 / whole.max(1) as f64)
}
