//! Runs that people watch and steer in the viewer's page: `zygote deploy --view` and `zygote serve`.
//!
//! ```text
//!   page <--line--> Hub <--> Attended: choose -> load -> arm -> start -> report -> resume, choose ...
//!                              |
//!                              +--> deploy::Order --Session--> board, or simulator in RealTime
//! ```

mod attended;
mod real_time;
#[cfg(test)]
mod tests;

pub(crate) use attended::{Attended, Bench};
pub(crate) use real_time::RealTime;

use crate::failure::{Failure, OrFail};
use crate::view;
use clap::Args;
use std::fmt::Display;
use std::sync::Arc;
use zygote_live::{Hub, Server, Token};

/// How a run is shown.
#[derive(Args)]
pub(crate) struct Screen {
    /// Port of the page's address [default: any that is free]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub(crate) view_port: u16,
    /// Open no browser
    #[arg(long)]
    pub(crate) no_open: bool,
    /// On the simulator, so many seconds of the run in a second [default: 1]
    #[arg(long, value_name = "N", value_parser = pace, requires = "sim")]
    pub(crate) pace: Option<f64>,
}

fn pace(text: &str) -> Result<f64, String> {
    let pace = text.parse().ok().filter(|pace| (0.01..=10_000.0).contains(pace));
    pace.ok_or_else(|| "expected a number from 0.01 to 10000".to_owned())
}

impl Screen {
    /// Seconds of the run in a second.
    pub(crate) fn pace(&self) -> f64 {
        self.pace.unwrap_or(1.0)
    }

    /// Serves the page with these scenes on offer, and tells its address.
    pub(crate) fn open(&self, what: &dyn Display, hub: &Arc<Hub>) -> Result<Server, Failure> {
        let listener = view::listen(self.view_port, "--view-port")?;
        let token = Token::fresh().or_failed()?;
        let server = Server::start_live(listener, view::page()?, Arc::clone(hub), token).or_failed()?;
        view::Showing { what, server: &server, no_open: self.no_open }.tell()?;
        Ok(server)
    }
}
