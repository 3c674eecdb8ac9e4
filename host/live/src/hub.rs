//! What all pages are told, and what one of them wants.
//!
//! What happened is kept in order and whole; of looks at the rig, of the stage and of who has control, the newest. A page's line
//! remembers how far it has read ([`Seen`]), so a slow page is behind, loses no event, and makes nobody wait; one that comes back reads
//! from the beginning.

use crate::message::{Begin, Choice, Look, Told};
use crate::stage::{Order, Stage};
use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use zygote_controller::{Moment, Observer, Progress, Record, RunReport, Times, Wish};

/// Of the looks at the rig one in so much MCU time is kept for pages that come later, us.
const KEEP_LOOK_EVERY_US: u64 = 1_000_000;

/// Everything that pages and run share.
#[derive(Default)]
pub struct Hub {
    inner: Mutex<Inner>,
}

#[derive(Default)]
struct Inner {
    /// Grows with every run; what was told before is over.
    run: u64,
    log: Vec<Arc<str>>,
    choices: Newest,
    stage: Newest,
    look: Newest,
    kept_look_us: Option<u64>,
    now: Option<Stage>,
    pages: BTreeSet<u64>,
    next_page: u64,
    controller: Option<u64>,
    /// Grows whenever a page comes, goes, takes control or gives it up.
    people: u64,
    order: Option<Order>,
    stop: bool,
    /// Loaded is armed, and armed is started, without another word.
    at_once: bool,
    pausing: bool,
}

/// A message of which only the newest is worth telling.
#[derive(Default)]
struct Newest {
    number: u64,
    text: Option<Arc<str>>,
}

impl Newest {
    fn set(&mut self, text: Arc<str>) {
        self.number += 1;
        self.text = Some(text);
    }

    fn unseen(&self, seen: &mut u64) -> Option<Arc<str>> {
        (*seen != self.number).then(|| *seen = self.number)?;
        self.text.clone()
    }
}

/// How far a page's line has read.
#[derive(Debug, Default)]
pub(crate) struct Seen {
    run: u64,
    log: usize,
    choices: u64,
    stage: u64,
    look: u64,
    people: u64,
}

/// A message; one that JSON has no words for says that.
fn text(told: &Told<'_>) -> Arc<str> {
    told.text().unwrap_or_else(|error| format!(r#"{{"type":"trouble","told":"{error}"}}"#)).into()
}

/// What the run tells.
impl Hub {
    /// Nothing has happened yet.
    pub fn new() -> Self {
        Self::default()
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        // A thread that panicked here has left nothing half done that matters more than going on.
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts runs on offer.
    pub fn offer(&self, runs: &[Choice]) {
        self.lock().choices.set(text(&Told::Choices { runs }));
    }

    /// A run is loaded; `at_once`: it is armed and started without another word.
    pub fn begin(&self, begin: &Begin, at_once: bool) {
        let mut inner = self.lock();
        inner.run += 1;
        inner.log = vec![text(&Told::Begin(begin))];
        inner.look.text = None;
        inner.kept_look_us = None;
        inner.at_once = at_once;
        inner.pausing = false;
    }

    /// Something happened.
    pub fn tell(&self, told: &Told<'_>) {
        let text = text(told);
        self.lock().log.push(text);
    }

    /// The run is somewhere else. What was asked for before is void.
    pub fn enter(&self, stage: Stage) {
        self.lock().enter(stage);
    }

    /// A look at the rig.
    pub fn look(&self, progress: &Progress) {
        let look = Look::from(progress);
        let text = text(&Told::Look(&look));
        let mut inner = self.lock();
        let since = inner.kept_look_us.map(|kept| look.mcu_us().saturating_sub(kept));
        if since.is_none_or(|since| since >= KEEP_LOOK_EVERY_US) {
            inner.kept_look_us = Some(look.mcu_us());
            inner.log.push(Arc::clone(&text));
        }
        inner.look.set(text);
    }

    /// The run is over, or this part of it.
    pub fn report(&self, report: &RunReport) {
        self.tell(&Told::Report(report));
    }

    /// Somebody wants to stop; asked once, answered once.
    pub fn stop_asked(&self) -> bool {
        std::mem::take(&mut self.lock().stop)
    }

    /// What the page that has control asked for last.
    pub fn order(&self) -> Option<Order> {
        self.lock().order.take()
    }

    /// What whoever attends the run wants at a moment of it.
    pub fn wish(&self, moment: Moment) -> Wish {
        let mut inner = self.lock();
        if std::mem::take(&mut inner.stop) {
            return Wish::Stop;
        }
        match (moment, inner.order.take()) {
            (Moment::Running, Some(Order::Pause)) => inner.pausing = true,
            (Moment::Running, Some(Order::GoOn)) => inner.pausing = false,
            (Moment::Loaded, Some(Order::Arm)) | (Moment::Armed, Some(Order::Start)) => return Wish::GoOn,
            (Moment::Loaded, Some(Order::Unload)) | (Moment::Armed, Some(Order::Disarm)) => {
                return Wish::Pause;
            }
            (Moment::Loaded | Moment::Armed | Moment::Running, _) => {}
        }
        let (stage, wish) = match moment {
            Moment::Running if inner.pausing => (Stage::pausing(), Wish::Pause),
            Moment::Running => (Stage::running(), Wish::GoOn),
            Moment::Loaded | Moment::Armed if inner.at_once => (Stage::busy("Starting."), Wish::GoOn),
            // Nobody is there to start it.
            Moment::Armed if inner.controller.is_none() => (Stage::armed(), Wish::Pause),
            Moment::Armed => (Stage::armed(), Wish::Wait),
            Moment::Loaded => (Stage::loaded(), Wish::Wait),
        };
        if inner.now.as_ref() != Some(&stage) {
            inner.enter(stage);
        }
        wish
    }
}

/// A run's event log is told to all pages; looks at the rig come by [`Hub::look`].
impl Observer for &Hub {
    fn observe(&mut self, _times: Times, record: &Record) {
        if !matches!(record, Record::Telemetry { .. }) {
            self.tell(&Told::Event(record));
        }
    }

    fn error(&self) -> Option<String> {
        None
    }
}

impl Inner {
    fn enter(&mut self, stage: Stage) {
        self.stage.set(text(&Told::Stage(&stage)));
        self.now = Some(stage);
        self.order = None;
    }
}

/// What pages want.
impl Hub {
    /// A page is let in.
    pub(crate) fn come(&self) -> u64 {
        let mut inner = self.lock();
        inner.next_page += 1;
        let page = inner.next_page;
        inner.pages.insert(page);
        inner.people += 1;
        page
    }

    /// A page is gone, and control with it if it had it.
    pub(crate) fn go(&self, page: u64) {
        let mut inner = self.lock();
        inner.pages.remove(&page);
        inner.controller = inner.controller.filter(|controller| *controller != page);
        inner.people += 1;
    }

    /// A page would have control, or gives it up.
    pub(crate) fn control(&self, page: u64, take: bool) -> Result<(), &'static str> {
        let mut inner = self.lock();
        match (inner.controller, take) {
            (None, true) => inner.controller = Some(page),
            (Some(other), _) if other != page => {
                return if take { Err("another page has control") } else { Ok(()) };
            }
            (Some(_), false) => inner.controller = None,
            (Some(_), true) | (None, false) => {}
        }
        inner.people += 1;
        Ok(())
    }

    /// A page wants something done.
    pub(crate) fn ask(&self, page: u64, order: Order) -> Result<(), String> {
        let mut inner = self.lock();
        if inner.controller != Some(page) {
            return Err("this page only watches: take control first".to_owned());
        }
        let now = inner.now.as_ref();
        if now.is_none_or(|stage| !stage.can.contains(&order.name())) {
            let stage = now.map_or("busy", |stage| stage.stage);
            return Err(format!("`{}` can't be asked for while the run is {stage}", order.name()));
        }
        inner.order = Some(order);
        Ok(())
    }

    /// A page wants everything off. Whoever was let in may: off is the safe side.
    pub(crate) fn stop(&self) {
        self.lock().stop = true;
    }

    /// The next that a page's line has to say.
    pub(crate) fn news(&self, page: u64, seen: &mut Seen) -> Option<Arc<str>> {
        let inner = self.lock();
        if let Some(choices) = inner.choices.unseen(&mut seen.choices) {
            return Some(choices);
        }
        if seen.people != inner.people {
            seen.people = inner.people;
            let (you, taken) = (inner.controller == Some(page), inner.controller.is_some());
            return Some(text(&Told::Control { you, taken, pages: inner.pages.len() }));
        }
        if seen.run != inner.run {
            (seen.run, seen.log) = (inner.run, 0);
        }
        if let Some(next) = inner.log.get(seen.log) {
            seen.log += 1;
            return Some(Arc::clone(next));
        }
        inner.stage.unseen(&mut seen.stage).or_else(|| inner.look.unseen(&mut seen.look))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(hub: &Hub, page: u64, seen: &mut Seen) -> Vec<String> {
        std::iter::from_fn(|| hub.news(page, seen)).map(|text| text.to_string()).collect()
    }

    fn opened(hinge: usize) -> Record {
        Record::Opened { mcu_us: 0, step: 0, hinge }
    }

    fn look(at_us: u64) -> Progress {
        Progress {
            opened: 0,
            total: 1,
            motions: Vec::new(),
            at: zygote_protocol::Micros(at_us),
            supply: zygote_protocol::Millivolts(0),
            current: zygote_protocol::Milliamps(0),
        }
    }

    #[test]
    fn a_page_that_was_away_is_told_every_event_and_the_newest_look() {
        let hub = Hub::new();
        let (quick, late) = (hub.come(), hub.come());
        let (mut seen, mut seen_late) = (Seen::default(), Seen::default());
        all(&hub, quick, &mut seen);
        for hinge in 0..1_000 {
            hub.tell(&Told::Event(&opened(hinge)));
            hub.look(&look(100_000 * hinge as u64));
            assert_eq!(all(&hub, quick, &mut seen).len(), if hinge % 10 == 0 { 3 } else { 2 });
        }
        let told = all(&hub, late, &mut seen_late);
        assert_eq!(told.iter().filter(|text| text.contains("opened\",\"mcu")).count(), 1_000);
        assert_eq!(
            told.iter().filter(|text| text.contains("\"look\"")).count(),
            101,
            "one a second, and the newest"
        );
        assert!(told.last().is_some_and(|text| text.contains("\"mcu_us\":99900000")), "{:?}", told.last());
    }

    #[test]
    fn one_page_has_control_until_it_goes() {
        let hub = Hub::new();
        let (first, second) = (hub.come(), hub.come());
        hub.enter(Stage::loaded());
        assert!(hub.ask(first, Order::Arm).is_err(), "nobody has taken control");
        assert_eq!(hub.control(first, true), Ok(()));
        assert!(hub.control(second, true).is_err());
        assert!(hub.ask(second, Order::Arm).is_err());
        assert_eq!(hub.control(second, false), Ok(()));
        assert_eq!(hub.ask(first, Order::Arm), Ok(()));
        hub.go(first);
        assert_eq!(hub.control(second, true), Ok(()));
    }

    #[test]
    fn only_what_the_stage_allows_is_taken_and_a_stop_always() {
        let hub = Hub::new();
        let page = hub.come();
        assert_eq!(hub.control(page, true), Ok(()));
        assert_eq!(hub.wish(Moment::Loaded), Wish::Wait);
        assert!(hub.ask(page, Order::Start).is_err(), "it isn't armed");
        assert_eq!(hub.ask(page, Order::Arm), Ok(()));
        assert_eq!(hub.wish(Moment::Loaded), Wish::GoOn);
        assert_eq!(hub.wish(Moment::Armed), Wish::Wait);
        assert_eq!(hub.ask(page, Order::Start), Ok(()));
        assert_eq!(hub.wish(Moment::Armed), Wish::GoOn);
        assert_eq!(hub.wish(Moment::Running), Wish::GoOn);
        assert_eq!(hub.ask(page, Order::Pause), Ok(()));
        assert_eq!([hub.wish(Moment::Running), hub.wish(Moment::Running)], [Wish::Pause, Wish::Pause]);
        assert_eq!(hub.ask(page, Order::GoOn), Ok(()));
        assert_eq!(hub.wish(Moment::Running), Wish::GoOn);
        hub.stop();
        assert_eq!([hub.wish(Moment::Running), hub.wish(Moment::Running)], [Wish::Stop, Wish::GoOn]);
    }

    #[test]
    fn an_arming_whose_page_has_gone_is_taken_back_and_a_run_goes_on() {
        let hub = Hub::new();
        let page = hub.come();
        assert_eq!(hub.control(page, true), Ok(()));
        assert_eq!(hub.wish(Moment::Armed), Wish::Wait);
        hub.go(page);
        assert_eq!(hub.wish(Moment::Armed), Wish::Pause);
        assert_eq!(hub.wish(Moment::Running), Wish::GoOn);
    }
}
