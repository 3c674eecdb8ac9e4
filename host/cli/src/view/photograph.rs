//! A picture as the page draws it: a browser without a window opens the page, which posts what it drew.

use super::browser::{self, Unseen};
use super::{Colour, PictureArguments, page};
use crate::failure::{Failure, OrFail};
use crate::output::{say, write_file};
use anyhow::{Context, anyhow};
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};
use zygote_live::{Brought, Server};

/// Thousands of panels drawn without a graphics card take seconds, a slow start of the browser some more.
const PATIENCE: Duration = Duration::from_secs(90);
/// How often the browser is looked at.
const LOOK: Duration = Duration::from_millis(250);
/// What every PNG begins with.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

/// A picture to be taken.
pub(super) struct Photograph<'a> {
    pub(super) file: &'a Path,
    pub(super) of: &'a PictureArguments,
}

impl Photograph<'_> {
    /// Takes it.
    pub(super) fn take(&self, listener: TcpListener, scene: Vec<u8>) -> Result<(), Failure> {
        let program = self.browser()?;
        let (sender, receiver) = channel();
        let server = Server::start(listener, page()?, Some(sender)).or_failed()?;
        server.put("/scene.json", scene);
        let address = format!("{}#{}", server.address(), self.wishes());
        let name = program.display();
        let mut browser = Unseen::open(&program, &address, self.of.size)
            .with_context(|| format!("{name}: cannot be started"))
            .or_failed()?;
        let start = Instant::now();
        let png = loop {
            match receiver.recv_timeout(LOOK) {
                Ok(Brought::Picture(png)) if png.starts_with(PNG) => break png,
                Ok(Brought::Picture(_)) => {
                    return Err(failed(format_args!("{name}: drew something that is no PNG")));
                }
                Ok(Brought::Trouble(told)) => {
                    return Err(failed(format_args!("{name}: the page can't be drawn: {told}")));
                }
                Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => {}
            }
            if let Some(status) = browser.ended() {
                return Err(failed(format_args!(
                    "{name}: ended with {status} before it drew anything; is it a Chromium?"
                )));
            }
            if start.elapsed() > PATIENCE {
                return Err(failed(format_args!("{name}: drew nothing within {} s", PATIENCE.as_secs())));
            }
        };
        drop(browser);
        write_file(self.file, &png)?;
        say(format_args!("{}: {} kB", self.file.display(), png.len().div_ceil(1000)));
        Ok(())
    }

    fn browser(&self) -> Result<PathBuf, Failure> {
        match &self.of.browser {
            Some(program) => browser::named(program)
                .with_context(|| {
                    format!("{}: no such program; --browser names a Chromium or Chrome", program.display())
                })
                .or_bad_input(),
            None => browser::find()
                .context(
                    "no Chromium or Chrome on the PATH; install one (on Debian `apt install chromium`), or name it with --browser",
                )
                .or_failed(),
        }
    }

    /// What the page is to draw, behind the `#` of its address.
    fn wishes(&self) -> String {
        let PictureArguments { at, colour, explode, size: [width, height], dark, .. } = self.of;
        let colour = match colour {
            Colour::Pile => "pile",
            Colour::Height => "height",
            Colour::Time => "time",
            Colour::Hinge => "hinge",
            Colour::Drive => "drive",
            Colour::Torque => "torque",
        };
        let theme = if *dark { "dark" } else { "light" };
        format!(
            "picture&at={at}&colour={colour}&explode={explode}&width={width}&height={height}&theme={theme}"
        )
    }
}

fn failed(message: std::fmt::Arguments) -> Failure {
    Failure::Failed(anyhow!("{message}"))
}
