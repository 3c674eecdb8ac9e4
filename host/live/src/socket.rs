//! One page's line: lets it in, tells it what is new, and hears what it wants.
//!
//! One thread a line, which reads for a moment and then writes what there is. A page that takes nothing for a while is hung up on.

use crate::hub::{Hub, Seen};
use crate::message::{Said, Told, VERSION};
use crate::token::Token;
use std::io::{self, ErrorKind};
use std::net::TcpStream;
use std::time::{Duration, Instant};
use tungstenite::protocol::{Role, WebSocketConfig};
use tungstenite::{Error, Message, WebSocket};

/// How long it reads before it looks for something to tell.
const MOMENT: Duration = Duration::from_millis(5);
/// The first message comes within this.
const HELLO_WITHIN: Duration = Duration::from_secs(5);
/// It is asked for a sign of life so often,
const PING_EVERY: Duration = Duration::from_secs(2);
/// and has to give one, and to take what it is told, within this.
const DEAD_AFTER: Duration = Duration::from_secs(8);
/// No page of ours says more at once.
const MOST_HEARD: usize = 4 * 1024;
/// Longer than the longest message to a page, that of a run of thousands of hinges.
const MOST_TOLD: usize = 16 * 1024 * 1024;

struct Line<'a> {
    socket: WebSocket<TcpStream>,
    hub: &'a Hub,
    /// Once it was let in.
    page: Option<u64>,
    seen: Seen,
    heard: Instant,
    asked: Instant,
    /// Since when something waits to be taken by the page.
    stuck: Option<Instant>,
}

/// Serves a line that was granted, until it ends.
///
/// # Errors
/// What ended it, where it wasn't the page.
pub(crate) fn serve(stream: TcpStream, hub: &Hub, token: &Token) -> Result<(), Error> {
    stream.set_read_timeout(Some(MOMENT))?;
    stream.set_write_timeout(Some(MOMENT))?;
    stream.set_nodelay(true)?;
    let limits = WebSocketConfig::default()
        .read_buffer_size(MOST_HEARD)
        .write_buffer_size(0)
        .max_write_buffer_size(MOST_TOLD)
        .max_message_size(Some(MOST_HEARD))
        .max_frame_size(Some(MOST_HEARD));
    let socket = WebSocket::from_raw_socket(stream, Role::Server, Some(limits));
    let now = Instant::now();
    let mut line =
        Line { socket, hub, page: None, seen: Seen::default(), heard: now, asked: now, stuck: None };
    let ended = line.run(token);
    if let Some(page) = line.page {
        hub.go(page);
    }
    match ended {
        Err(Error::ConnectionClosed | Error::AlreadyClosed) => Ok(()),
        ended => ended,
    }
}

/// Nothing came within the moment, or nothing went.
fn is_for_later(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted)
}

impl Line<'_> {
    fn run(&mut self, token: &Token) -> Result<(), Error> {
        loop {
            match self.socket.read() {
                Ok(message) => {
                    self.heard = Instant::now();
                    if let Message::Text(text) = message {
                        self.take(&text, token)?;
                    }
                }
                Err(Error::Io(error)) if is_for_later(&error) => {}
                Err(error) => return Err(error),
            }
            let patience = if self.page.is_some() { DEAD_AFTER } else { HELLO_WITHIN };
            if self.heard.elapsed() > patience || self.stuck.is_some_and(|since| since.elapsed() > DEAD_AFTER)
            {
                return Ok(());
            }
            if self.asked.elapsed() > PING_EVERY && self.stuck.is_none() {
                self.asked = Instant::now();
                self.put(Message::Ping(Vec::new().into()))?;
            }
            self.tell_news()?;
        }
    }

    fn take(&mut self, text: &str, token: &Token) -> Result<(), Error> {
        let said = match Said::read(text) {
            Ok(said) => said,
            Err(error) => return self.refuse(None, &format!("a message that can't be read: {error}")),
        };
        match (self.page, said) {
            (None, Said::Hello { version, token: told, control }) => {
                let refusal = if !token.is(&told) {
                    Some(
                        "the address has no valid secret: open the one that zygote printed when it started"
                            .to_owned(),
                    )
                } else if version == VERSION {
                    None
                } else {
                    Some(format!(
                        "messages: expected version {VERSION}, found {version}; load the page again"
                    ))
                };
                if let Some(why) = refusal {
                    self.refuse(None, &why)?;
                    self.close();
                    return Err(Error::ConnectionClosed);
                }
                let page = self.hub.come();
                self.page = Some(page);
                self.tell(&Told::Welcome { version: VERSION })?;
                if control {
                    // Another page may have it; the page is told who does.
                    self.hub.control(page, true).ok();
                }
                Ok(())
            }
            (None, _) => {
                self.refuse(None, "the first message has to be `hello`")?;
                self.close();
                Err(Error::ConnectionClosed)
            }
            (Some(_), Said::Hello { .. }) => self.refuse(None, "it was let in already"),
            (Some(page), Said::Control { take }) => match self.hub.control(page, take) {
                Ok(()) => Ok(()),
                Err(why) => self.refuse(Some("control"), why),
            },
            (Some(page), Said::Order(order)) => match self.hub.ask(page, order) {
                Ok(()) => Ok(()),
                Err(why) => self.refuse(Some(order.name()), &why),
            },
            (Some(_), Said::Stop { id }) => {
                self.hub.stop();
                self.tell(&Told::Stopping { id })
            }
        }
    }

    fn refuse(&mut self, order: Option<&str>, why: &str) -> Result<(), Error> {
        self.tell(&Told::Refused { order, why })
    }

    fn tell(&mut self, told: &Told<'_>) -> Result<(), Error> {
        let text = told.text().map_err(|error| Error::Io(error.into()))?;
        self.put(Message::text(text))
    }

    /// Says goodbye, and waits a little for the page to have heard it.
    fn close(&mut self) {
        let since = Instant::now();
        let mut gone = self.socket.close(None);
        while since.elapsed() < HELLO_WITHIN {
            match gone {
                Err(Error::Io(error)) if is_for_later(&error) => {}
                Ok(()) => {}
                Err(_) => return,
            }
            gone = self.socket.read().map(drop);
        }
    }

    /// Tells all that is new, until the page takes no more.
    fn tell_news(&mut self) -> Result<(), Error> {
        if self.stuck.is_some() {
            let flushed = self.socket.flush();
            self.note(flushed)?;
        }
        let Some(page) = self.page else { return Ok(()) };
        while self.stuck.is_none() {
            let Some(news) = self.hub.news(page, &mut self.seen) else { break };
            self.put(Message::text(news.as_ref()))?;
        }
        Ok(())
    }

    fn put(&mut self, message: Message) -> Result<(), Error> {
        let sent = self.socket.send(message);
        self.note(sent)
    }

    /// What isn't taken yet waits in the socket, and nothing more is put there.
    fn note(&mut self, sent: Result<(), Error>) -> Result<(), Error> {
        match sent {
            Ok(()) => self.stuck = None,
            Err(Error::Io(error)) if is_for_later(&error) => {
                self.stuck.get_or_insert_with(Instant::now);
            }
            Err(error) => return Err(error),
        }
        Ok(())
    }
}
