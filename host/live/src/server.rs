//! Serves the page and what it shows, on loopback alone: files to read, a picture to bring where one is waited for, and lines both ways
//! where a run goes on.

use crate::hub::Hub;
use crate::request::{self, Refusal, Request};
use crate::socket;
use crate::token::Token;
use std::collections::BTreeMap;
use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Arc, PoisonError, RwLock};
use std::thread;
use std::time::Duration;
use tungstenite::handshake::derive_accept_key;

/// Who says nothing for so long is hung up on.
const SILENCE: Duration = Duration::from_secs(10);
/// Pages that may watch at once.
const MOST_LINES: usize = 32;

/// What the page brings when it was asked for a picture.
#[derive(Debug, PartialEq, Eq)]
pub enum Brought {
    /// The picture, as a PNG.
    Picture(Vec<u8>),
    /// Why there is none.
    Trouble(String),
}

/// A server that runs until the program ends.
pub struct Server {
    port: u16,
    offer: Arc<Offer>,
}

struct Offer {
    page: &'static [u8],
    files: RwLock<BTreeMap<&'static str, Arc<[u8]>>>,
    brought: Option<Sender<Brought>>,
    live: Option<(Arc<Hub>, Token)>,
    lines: AtomicUsize,
}

/// Takes a port of loopback, 0 for any that is free.
///
/// # Errors
/// The port can't be had.
pub fn bind(port: u16) -> io::Result<TcpListener> {
    TcpListener::bind(SocketAddr::from((Ipv4Addr::LOCALHOST, port)))
}

impl Server {
    /// Serves a page. Pictures are taken only where somebody waits for one.
    ///
    /// # Errors
    /// The system has no thread left.
    pub fn start(
        listener: TcpListener,
        page: &'static [u8],
        brought: Option<Sender<Brought>>,
    ) -> io::Result<Self> {
        Self::serve(listener, page, brought, None)
    }

    /// Serves a page with a run that goes on, to whoever knows the token.
    ///
    /// # Errors
    /// The system has no thread left.
    pub fn start_live(
        listener: TcpListener,
        page: &'static [u8],
        hub: Arc<Hub>,
        token: Token,
    ) -> io::Result<Self> {
        Self::serve(listener, page, None, Some((hub, token)))
    }

    fn serve(
        listener: TcpListener,
        page: &'static [u8],
        brought: Option<Sender<Brought>>,
        live: Option<(Arc<Hub>, Token)>,
    ) -> io::Result<Self> {
        let port = listener.local_addr()?.port();
        let (files, lines) = (RwLock::default(), AtomicUsize::new(0));
        let offer = Arc::new(Offer { page, files, brought, live, lines });
        let own = Arc::clone(&offer);
        thread::Builder::new().name("view".to_owned()).spawn(move || {
            for stream in listener.incoming().flatten() {
                let offer = Arc::clone(&own);
                // A browser opens several connections at once, and may leave one silent. Without a thread it has to ask again.
                thread::Builder::new().spawn(move || offer.serve(stream, port)).ok();
            }
        })?;
        Ok(Self { port, offer })
    }

    /// Puts a file of JSON where the page looks for it, in place of the one that was there.
    pub fn put(&self, path: &'static str, json: Vec<u8>) {
        let mut files = self.offer.files.write().unwrap_or_else(PoisonError::into_inner);
        files.insert(path, json.into());
    }

    /// Where the page is, with the secret in it if there is one.
    pub fn address(&self) -> String {
        let secret = self.offer.live.as_ref().map(|(_, token)| format!("#{token}")).unwrap_or_default();
        format!("http://127.0.0.1:{}/{secret}", self.port)
    }
}

/// An answer: its kind, its body, and whether the body is wanted.
type Answer = (&'static str, Arc<[u8]>, bool);

impl Offer {
    /// Answers one connection; one that breaks is the browser's to make again.
    fn serve(&self, mut stream: TcpStream, port: u16) -> io::Result<()> {
        stream.set_read_timeout(Some(SILENCE))?;
        stream.set_write_timeout(Some(SILENCE))?;
        let answer = match request::read(&mut stream, port)? {
            Ok(Request::Live(key)) => return self.line(stream, &key),
            Ok(request) => self.answer(request),
            Err(refusal) => Err(refusal),
        };
        match answer {
            Ok((kind, body, with_body)) => request::answer(&mut stream, kind, &body, with_body),
            Err(refusal) => request::refuse(&mut stream, refusal),
        }
    }

    fn line(&self, mut stream: TcpStream, key: &str) -> io::Result<()> {
        let Some((hub, token)) = &self.live else {
            return request::refuse(&mut stream, Refusal::NotFound);
        };
        let served = if self.lines.fetch_add(1, Ordering::Relaxed) < MOST_LINES {
            request::grant(&mut stream, &derive_accept_key(key.as_bytes()))
                .and_then(|()| socket::serve(stream, hub, token).map_err(io::Error::other))
        } else {
            request::refuse(&mut stream, Refusal::Busy)
        };
        self.lines.fetch_sub(1, Ordering::Relaxed);
        served
    }

    fn answer(&self, request: Request) -> Result<Answer, Refusal> {
        match request {
            Request::Get(path) => self.read(&path).map(|(kind, body)| (kind, body, true)),
            Request::Head(path) => self.read(&path).map(|(kind, body)| (kind, body, false)),
            Request::Post(path, body) => {
                let brought = match path.as_str() {
                    "/picture" => Brought::Picture(body),
                    "/trouble" => Brought::Trouble(String::from_utf8_lossy(&body).into_owned()),
                    _ => return Err(Refusal::Method),
                };
                let waiting = self.brought.as_ref().ok_or(Refusal::NotFound)?;
                waiting.send(brought).map_err(|_| Refusal::NotFound)?;
                Ok(("text/plain", Arc::default(), true))
            }
            Request::Live(_) => Err(Refusal::Method),
        }
    }

    fn read(&self, path: &str) -> Result<(&'static str, Arc<[u8]>), Refusal> {
        if path == "/" {
            return Ok(("text/html; charset=utf-8", self.page.into()));
        }
        let files = self.files.read().unwrap_or_else(PoisonError::into_inner);
        files.get(path).map(|file| ("application/json", Arc::clone(file))).ok_or(Refusal::NotFound)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Read, Write};
    use std::sync::mpsc::channel;

    fn start(page: &'static [u8], scene: &[u8], brought: Option<Sender<Brought>>) -> Server {
        let server = Server::start(bind(0).expect("a free port"), page, brought).expect("a thread");
        server.put("/scene.json", scene.to_vec());
        server
    }

    fn exchange(server: &Server, method: &str, path: &str, body: &str) -> String {
        let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, server.port)).expect("listens");
        let (port, length) = (server.port, body.len());
        write!(
            stream,
            "{method} {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: {length}\r\n\r\n{body}"
        )
        .expect("takes a request");
        let mut text = String::new();
        stream.read_to_string(&mut text).expect("answers");
        text
    }

    #[test]
    fn page_and_scene_are_served_and_nothing_else() {
        let server = start(b"<html>", b"{}", None);
        assert!(exchange(&server, "GET", "/", "").ends_with("\r\n\r\n<html>"));
        assert!(exchange(&server, "GET", "/scene.json", "").ends_with("\r\n\r\n{}"));
        assert!(exchange(&server, "HEAD", "/", "").ends_with("\r\n\r\n"));
        for path in ["/etc/passwd", "/../Cargo.toml", "//", "/index.html"] {
            assert!(exchange(&server, "GET", path, "").starts_with("HTTP/1.1 404"), "{path}");
        }
        assert!(exchange(&server, "POST", "/picture", "x").starts_with("HTTP/1.1 404"));
        assert!(exchange(&server, "POST", "/", "x").starts_with("HTTP/1.1 405"));
    }

    #[test]
    fn a_picture_comes_to_who_waits_for_it() {
        let (sender, receiver) = channel();
        let server = start(b"", b"", Some(sender));
        assert!(exchange(&server, "POST", "/picture", "png").starts_with("HTTP/1.1 200"));
        assert_eq!(receiver.recv(), Ok(Brought::Picture(b"png".to_vec())));
        exchange(&server, "POST", "/trouble", "no WebGL");
        assert_eq!(receiver.recv(), Ok(Brought::Trouble("no WebGL".to_owned())));
    }

    #[test]
    fn a_port_that_is_taken_is_an_error() {
        let first = start(b"", b"", None);
        assert!(bind(first.port).is_err());
    }
}
