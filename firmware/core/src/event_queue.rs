//! Events on their way to the link. The sequencer starts a motion only when its events will fit, so none is lost.

use heapless::Deque;
use zygote_protocol::Event;

const CAPACITY: usize = 96;
/// Kept free for changes of state, which can't be put off.
const RESERVE: usize = 8;

#[derive(Debug)]
pub(crate) struct EventQueue {
    waiting: Deque<Event, CAPACITY>,
    count: u32,
}

impl EventQueue {
    pub(crate) const fn new() -> Self {
        Self { waiting: Deque::new(), count: 0 }
    }

    /// How many events there ever were.
    pub(crate) fn count(&self) -> u32 {
        self.count
    }

    /// How many events of motions still fit.
    pub(crate) fn room(&self) -> usize {
        CAPACITY.saturating_sub(RESERVE + self.waiting.len())
    }

    /// Adds an event; when the queue is full, the oldest one goes.
    pub(crate) fn push(&mut self, event: Event) {
        self.count = self.count.wrapping_add(1);
        if let Err(event) = self.waiting.push_back(event) {
            self.waiting.pop_front();
            // There is room now: one was just taken out.
            self.waiting.push_back(event).ok();
        }
    }

    pub(crate) fn pop(&mut self) -> Option<Event> {
        self.waiting.pop_front()
    }

    pub(crate) fn clear(&mut self) {
        self.waiting.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zygote_protocol::{EventKind, Micros};

    fn event(step: u16) -> Event {
        Event { at: Micros(0), kind: EventKind::StepStarted { step } }
    }

    #[test]
    fn the_room_for_motions_shrinks_to_the_reserve_and_then_the_oldest_event_goes() {
        let mut queue = EventQueue::new();
        for number in 0..88 {
            assert_eq!(queue.room(), 88 - usize::from(number));
            queue.push(event(number));
        }
        for number in 88..97 {
            assert_eq!(queue.room(), 0);
            queue.push(event(number));
        }
        assert_eq!(queue.count(), 97);
        let left = core::iter::from_fn(|| queue.pop());
        assert!(left.eq((1..97).map(event)), "all but the oldest, in order");
    }
}
