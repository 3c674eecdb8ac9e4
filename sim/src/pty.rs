//! Serves a simulated board on a pseudo-terminal, in real time: any serial program can open it.

use crate::device::Device;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fd::OwnedFd;
use rustix::fs::{Mode, OFlags};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;
use zygote_protocol::{Micros, Millis};

/// Most that the board's clock catches up with. On a machine too busy to keep up, the board runs slow instead of
/// missing a host that was just as held up.
const MOST_BEHIND: Millis = Millis(50);
/// Most that the board's clock moves on between two looks at the line: a board that runs slow still answers soon.
const MOST_AT_ONCE: Millis = Millis(2);
/// Longest wait for bytes before the board's clock is moved on.
const SLICE: Timespec = Timespec { tv_sec: 0, tv_nsec: 2_000_000 };
/// No wait, when there is time to catch up with.
const AT_ONCE: Timespec = Timespec { tv_sec: 0, tv_nsec: 0 };

/// Why serving ended.
#[derive(Debug, thiserror::Error)]
pub enum ServeError {
    /// No pseudo-terminal, or it broke.
    #[error("{what}: the pseudo-terminal failed")]
    Terminal {
        /// What was being done.
        what: &'static str,
        /// What the system says.
        #[source]
        source: io::Error,
    },
    /// The board refused.
    #[error("the board can't go on")]
    Device(#[source] Box<dyn std::error::Error + Send + Sync>),
}

fn terminal(what: &'static str) -> impl Fn(rustix::io::Errno) -> ServeError {
    move |errno| ServeError::Terminal { what, source: errno.into() }
}

/// A pseudo-terminal in raw mode.
pub struct Pty {
    master: OwnedFd,
    /// Kept open, so that the line stays up when a program closes it.
    _slave: OwnedFd,
    path: PathBuf,
}

impl Pty {
    /// Makes one.
    ///
    /// # Errors
    /// [`ServeError::Terminal`].
    pub fn open() -> Result<Self, ServeError> {
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).map_err(terminal("opening"))?;
        grantpt(&master).map_err(terminal("granting"))?;
        unlockpt(&master).map_err(terminal("unlocking"))?;
        // A full line must not hold up the board's clock.
        rustix::fs::fcntl_setfl(&master, OFlags::RDWR | OFlags::NONBLOCK).map_err(terminal("unblocking"))?;
        let name = ptsname(&master, Vec::new()).map_err(terminal("naming"))?;
        let path = PathBuf::from(name.to_string_lossy().into_owned());
        let slave = rustix::fs::open(&path, OFlags::RDWR | OFlags::NOCTTY, Mode::empty())
            .map_err(terminal("opening the device"))?;
        let mut modes = tcgetattr(&slave).map_err(terminal("reading the modes"))?;
        modes.make_raw();
        tcsetattr(&slave, OptionalActions::Now, &modes).map_err(terminal("setting raw mode"))?;
        Ok(Self { master, _slave: slave, path })
    }

    /// The device to open.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Runs the board against the clock on the wall until `stop` is set.
    ///
    /// # Errors
    /// The terminal broke.
    pub fn serve<D: Device>(&self, board: &mut D, stop: &AtomicBool) -> Result<(), ServeError> {
        let mut wall = Instant::now();
        let mut behind = 0;
        let mut buffer = [0; 4096];
        let mut out = Vec::new();
        while !stop.load(Ordering::Relaxed) {
            let mut watched = [PollFd::new(&self.master, PollFlags::IN)];
            match poll(&mut watched, Some(if behind == 0 { &SLICE } else { &AT_ONCE })) {
                Ok(_) | Err(rustix::io::Errno::INTR) => {}
                Err(errno) => return Err(terminal("waiting")(errno)),
            }
            if watched.iter().any(|fd| fd.revents().contains(PollFlags::IN)) {
                let count = rustix::io::read(&self.master, &mut buffer[..]).map_err(terminal("reading"))?;
                board.receive(buffer.get(..count).unwrap_or_default());
            }
            let before = std::mem::replace(&mut wall, Instant::now());
            let elapsed = u64::try_from(wall.duration_since(before).as_micros()).unwrap_or(u64::MAX);
            behind = elapsed.saturating_add(behind).min(MOST_BEHIND.to_micros());
            let step = behind.min(MOST_AT_ONCE.to_micros());
            behind -= step;
            let until = Micros(board.now().0.saturating_add(step));
            while board.now() < until {
                board.advance(until).map_err(|error| ServeError::Device(Box::new(error)))?;
            }
            out.clear();
            board.transmit(&mut out);
            self.write(&out)?;
        }
        Ok(())
    }

    /// Writes what the terminal takes; the rest is lost, as on a line that nobody listens to.
    fn write(&self, mut bytes: &[u8]) -> Result<(), ServeError> {
        while !bytes.is_empty() {
            match rustix::io::write(&self.master, bytes) {
                Ok(count) => bytes = bytes.get(count..).unwrap_or_default(),
                Err(rustix::io::Errno::AGAIN) => return Ok(()),
                Err(errno) => return Err(terminal("writing")(errno)),
            }
        }
        Ok(())
    }
}
