//! Serves the viewer's page to this computer alone, and to its pages a run that goes on.
//!
//! ```text
//!   browser --GET--> request --> server: the page, what it shows
//!           --line--> request --> socket --token--> Hub: what all pages are told, what one of them wants
//!                                                     ^
//!                          the run: tells every record, every look at the rig; asks for wishes and stops
//! ```
//!
//! The run never waits for a page. All that happened in it stands in the hub; each page's line reads on from where it is, and of looks
//! at the rig takes the newest. `docs/src/live.md` has the messages.

mod hub;
mod message;
mod request;
mod server;
mod socket;
mod stage;
mod token;

pub use hub::Hub;
pub use message::{Begin, Choice, Told, VERSION, expected};
pub use server::{Brought, Server, bind};
pub use stage::{Order, Stage};
pub use token::{Token, TokenError};
