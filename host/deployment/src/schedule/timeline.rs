//! What is drawn, moves and has its turn over time, and the first place for one more motion.

/// Turns are told apart by so many bits; more nodes than that share one.
const TURNS: usize = 128;

/// From one change to the next.
#[derive(Debug, Clone, Copy)]
struct Segment {
    start: u64,
    drawn: i64,
    moving: usize,
    turns: u128,
}

/// A motion as a timeline sees it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Load {
    pub(super) duration: u64,
    /// Drawn from start to end, and from then on: beside what was drawn without it.
    pub(super) during: i64,
    pub(super) after: i64,
    pub(super) turn: Option<usize>,
}

/// Time from 0 on.
#[derive(Debug)]
pub(super) struct Timeline {
    segments: Vec<Segment>,
    limit: i64,
    parallel: usize,
}

impl Timeline {
    /// With `drawn` all the time.
    pub(super) fn new(drawn: i64, limit: i64, parallel: usize) -> Self {
        Self { segments: vec![Segment { start: 0, drawn, moving: 0, turns: 0 }], limit, parallel }
    }

    /// Places a motion at its earliest start, not before `ready`; `None` if there never is room.
    pub(super) fn place(&mut self, ready: u64, load: &Load) -> Option<u64> {
        let start = self.find(ready, load)?;
        let (first, last) = (self.split(start), self.split(start + load.duration));
        let turn = bit(load.turn);
        for segment in &mut self.segments[first..last] {
            segment.drawn += load.during;
            segment.moving += 1;
            segment.turns |= turn;
        }
        if load.after != 0 {
            self.segments[last..].iter_mut().for_each(|segment| segment.drawn += load.after);
        }
        Some(start)
    }

    fn find(&self, ready: u64, load: &Load) -> Option<u64> {
        let turn = bit(load.turn);
        let mut start = ready;
        let mut at = self.segments.partition_point(|segment| segment.start <= ready).saturating_sub(1);
        while let Some(segment) = self.segments.get(at) {
            let fits = if segment.start < start + load.duration {
                segment.drawn + load.during <= self.limit
                    && segment.moving < self.parallel
                    && segment.turns & turn == 0
            } else if load.after > 0 {
                segment.drawn + load.after <= self.limit
            } else {
                return Some(start);
            };
            at += 1;
            if !fits {
                start = self.segments.get(at)?.start;
            }
        }
        Some(start)
    }

    /// The segment that begins at `time`.
    fn split(&mut self, time: u64) -> usize {
        let at = self.segments.partition_point(|segment| segment.start < time);
        if self.segments.get(at).is_none_or(|segment| segment.start != time) {
            let before = self.segments[at - 1];
            self.segments.insert(at, Segment { start: time, ..before });
        }
        at
    }
}

fn bit(turn: Option<usize>) -> u128 {
    turn.map_or(0, |turn| 1 << (turn % TURNS))
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn load(duration: u64, during: i64, after: i64) -> Load {
        Load { duration, during, after, turn: None }
    }

    #[test]
    fn a_motion_goes_into_the_first_gap_that_is_long_and_deep_enough() {
        let mut timeline = Timeline::new(0, 10, 9);
        assert_eq!(timeline.place(0, &load(5, 8, 0)), Some(0));
        assert_eq!(timeline.place(8, &load(5, 8, 0)), Some(8));
        assert_eq!(timeline.place(0, &load(4, 3, 0)), Some(13), "the gap from 5 to 8 is too short");
        assert_eq!(timeline.place(0, &load(3, 3, 0)), Some(5));
        assert_eq!(timeline.place(0, &load(3, 2, 0)), Some(0));
    }

    #[test]
    fn what_is_held_from_then_on_must_fit_what_comes_later() {
        let mut timeline = Timeline::new(0, 10, 9);
        assert_eq!(timeline.place(20, &load(5, 9, 0)), Some(20));
        assert_eq!(timeline.place(0, &load(5, 4, 2)), Some(25), "2 held beside 9 would be too much");
        assert_eq!(timeline.place(0, &load(5, 4, 1)), Some(0));
        assert_eq!(timeline.place(0, &load(5, 10, 0)), None, "something is held for ever");
    }

    #[test]
    fn no_more_move_at_once_and_turns_are_taken_one_by_one() {
        let mut timeline = Timeline::new(0, 100, 2);
        let turn = Load { turn: Some(3), ..load(5, 1, 0) };
        assert_eq!(timeline.place(0, &turn), Some(0));
        assert_eq!(timeline.place(0, &turn), Some(5));
        assert_eq!(timeline.place(0, &load(10, 1, 0)), Some(0));
        assert_eq!(timeline.place(0, &load(1, 1, 0)), Some(10));
    }
}
