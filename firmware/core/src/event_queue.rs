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
