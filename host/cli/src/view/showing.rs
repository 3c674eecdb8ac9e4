//! A page that is served until Ctrl-C: its address told, the browser opened.

use super::browser;
use crate::failure::{Failure, OrFail};
use crate::output::say;
use anyhow::Context;
use std::fmt::Display;
use std::io::{self, Write};
use std::net::TcpListener;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use zygote_live::Server;

pub(crate) use super::page::page;

/// How often Ctrl-C is looked for.
const PATIENCE: Duration = Duration::from_millis(200);

/// What is shown where.
pub(crate) struct Showing<'a> {
    pub(crate) what: &'a dyn Display,
    pub(crate) server: &'a Server,
    pub(crate) no_open: bool,
}

impl Showing<'_> {
    /// Tells the address, and opens the browser. Where there is none, the address can be opened anywhere on this computer.
    pub(crate) fn tell(&self) -> Result<(), Failure> {
        let address = self.server.address();
        say(format_args!("{}: {address} (Ctrl-C ends it)", self.what));
        // Whoever started this program waits for that line.
        io::stdout().flush().or_failed()?;
        if !self.no_open && !browser::open(&address) {
            say("No browser could be opened: open the address yourself.");
        }
        Ok(())
    }
}

/// Takes a port of this computer; `option` is what the user gave it with.
pub(crate) fn listen(port: u16, option: &str) -> Result<TcpListener, Failure> {
    zygote_live::bind(port)
        .with_context(|| {
            format!("port {port} of this computer can't be used; leave out {option} for any that is free")
        })
        .or_bad_input()
}

/// Waits for Ctrl-C.
pub(crate) fn until_interrupted(stop: &AtomicBool) {
    while !stop.load(Ordering::Relaxed) {
        std::thread::sleep(PATIENCE);
    }
}
