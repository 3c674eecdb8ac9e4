//! The roll call of the tasks: the watchdog is fed only when every one of them was alive since the last call (S9).

use core::sync::atomic::{AtomicU32, Ordering};

/// How often each task has come around; tasks are known by their number.
#[derive(Debug)]
pub struct Beats<const TASKS: usize>([AtomicU32; TASKS]);

impl<const TASKS: usize> Beats<TASKS> {
    /// No task has come around yet.
    #[must_use]
    pub const fn new() -> Self {
        Self([const { AtomicU32::new(0) }; TASKS])
    }

    /// A task came around.
    pub fn beat(&self, task: usize) {
        if let Some(count) = self.0.get(task) {
            // Wraps around, which is as good as any other number.
            count.fetch_add(1, Ordering::Relaxed);
        }
    }
}

impl<const TASKS: usize> Default for Beats<TASKS> {
    fn default() -> Self {
        Self::new()
    }
}

/// The counts at the last call.
#[derive(Debug)]
pub struct RollCall<const TASKS: usize>([u32; TASKS]);

impl<const TASKS: usize> RollCall<TASKS> {
    /// Before the first call: it wants one beat of each.
    #[must_use]
    pub const fn new() -> Self {
        Self([0; TASKS])
    }

    /// Looks at every task; the error is the first one that hasn't come around since the last call.
    ///
    /// # Errors
    /// The number of that task.
    pub fn call(&mut self, beats: &Beats<TASKS>) -> Result<(), usize> {
        let mut missing = Ok(());
        for (task, (seen, count)) in self.0.iter_mut().zip(&beats.0).enumerate() {
            let count = count.load(Ordering::Relaxed);
            if count == *seen && missing.is_ok() {
                missing = Err(task);
            }
            *seen = count;
        }
        missing
    }
}

impl<const TASKS: usize> Default for RollCall<TASKS> {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_roll_call_wants_every_task_anew() {
        let (beats, mut roll) = (Beats::<3>::new(), RollCall::new());
        assert_eq!(roll.call(&beats), Err(0), "nobody has come around yet");
        (0..3).for_each(|task| beats.beat(task));
        assert_eq!(roll.call(&beats), Ok(()));
        beats.beat(0);
        beats.beat(2);
        beats.beat(2);
        assert_eq!(roll.call(&beats), Err(1));
        (0..3).for_each(|task| beats.beat(task));
        assert_eq!(roll.call(&beats), Ok(()), "a late one is back");
    }

    #[test]
    fn counts_may_wrap_around() {
        let (beats, mut roll) = (Beats::<1>([AtomicU32::new(u32::MAX)]), RollCall::new());
        assert_eq!(roll.call(&beats), Ok(()));
        beats.beat(0);
        assert_eq!(roll.call(&beats), Ok(()));
        assert_eq!(roll.call(&beats), Err(0));
    }

    #[test]
    fn a_task_that_is_not_on_the_list_counts_for_nobody() {
        let (beats, mut roll) = (Beats::<1>::new(), RollCall::new());
        beats.beat(1);
        assert_eq!(roll.call(&beats), Err(0));
    }
}
