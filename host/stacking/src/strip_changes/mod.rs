//! From strip to strip by small changes, towards one that costs less: simulated annealing. `net_search` counts overlaps in
//! the net, `reconfigure` the hinges to move.

mod changes;
mod neighbours;

pub(crate) use neighbours::Neighbours;

use crate::random::Random;
use changes::Changing;

/// How long and how freely a strip is changed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Schedule {
    /// Changes tried.
    pub(crate) rounds: u64,
    /// The chance, in parts of 65,536, that a change may cost one more, at the beginning; it falls to nothing.
    pub(crate) hottest: u64,
}

/// A strip that was changed.
#[derive(Debug, Clone)]
pub(crate) struct Changed {
    /// The best order found.
    pub(crate) order: Vec<usize>,
    /// What it costs.
    pub(crate) cost: usize,
    /// Changes tried.
    pub(crate) rounds: u64,
}

/// Changes a strip until it costs nothing or the rounds are over. `cost` may stop at a limit, and then gives nothing; nor does it
/// for an order that isn't wanted at any price.
pub(crate) fn anneal(
    order: Vec<usize>,
    neighbours: &Neighbours,
    schedule: Schedule,
    random: &mut Random,
    mut cost: impl FnMut(&[usize], usize) -> Option<usize>,
) -> Changed {
    let mut now = cost(&order, usize::MAX).unwrap_or(usize::MAX);
    let mut best = Changed { order: order.clone(), cost: now, rounds: 0 };
    if order.len() < 3 {
        return best;
    }
    let mut changing = Changing::new(order);
    for round in 0..schedule.rounds {
        if best.cost == 0 {
            break;
        }
        best.rounds += 1;
        if !changing.propose(neighbours, random) {
            continue;
        }
        // One more with a chance p, two with p p, and so on; whole numbers, so that all machines agree.
        let chance = schedule.hottest - schedule.hottest * round / schedule.rounds;
        let mut limit = now;
        while random.next() & 0xFFFF < chance {
            limit = limit.saturating_add(1);
        }
        if let Some(cost) = cost(changing.proposed(), limit).filter(|cost| *cost <= limit) {
            changing.accept();
            now = cost;
            if now < best.cost {
                best = Changed { order: changing.order().to_vec(), cost: now, ..best };
            }
        }
    }
    best
}
