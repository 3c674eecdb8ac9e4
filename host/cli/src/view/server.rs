//! Serves the page and what it shows, on loopback alone: two paths to read, and two to bring a picture where one is waited for.

use super::request::{self, Refusal, Request};
use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::thread;
use std::time::Duration;

/// Who says nothing for so long is hung up on.
const SILENCE: Duration = Duration::from_secs(10);

/// What the page brings when it was asked for a picture.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Brought {
    /// The picture, as a PNG.
    Picture(Vec<u8>),
    /// Why there is none.
    Trouble(String),
}

/// A server that runs until the program ends.
pub(super) struct Server {
    port: u16,
}

struct Offer {
    page: &'static [u8],
    scene: Vec<u8>,
    brought: Option<Sender<Brought>>,
}

/// Takes a port of loopback, 0 for any that is free.
///
/// # Errors
/// The port can't be had.
pub(super) fn bind(port: u16) -> io::Result<TcpListener> {
    TcpListener::bind(SocketAddr::from((Ipv4Addr::LOCALHOST, port)))
}

impl Server {
    /// Serves. Pictures are taken only where somebody waits for one.
    ///
    /// # Errors
    /// The system has no thread left.
    pub(super) fn start(
        listener: TcpListener,
        page: &'static [u8],
        scene: Vec<u8>,
        brought: Option<Sender<Brought>>,
    ) -> io::Result<Self> {
        let port = listener.local_addr()?.port();
        let offer = Arc::new(Offer { page, scene, brought });
        thread::Builder::new().name("view".to_owned()).spawn(move || {
            for stream in listener.incoming().flatten() {
                let offer = Arc::clone(&offer);
                // A browser opens several connections at once, and may leave one silent.
                thread::spawn(move || offer.serve(stream, port));
            }
        })?;
        Ok(Self { port })
    }

    /// Where the page is.
    pub(super) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }
}

impl Offer {
    /// Answers one connection; one that breaks is the browser's to make again.
    fn serve(&self, mut stream: TcpStream, port: u16) -> io::Result<()> {
        stream.set_read_timeout(Some(SILENCE))?;
        stream.set_write_timeout(Some(SILENCE))?;
        let answer = request::read(&mut stream, port)?.and_then(|request| self.answer(request));
        match answer {
            Ok((kind, body, with_body)) => request::answer(&mut stream, kind, body, with_body),
            Err(refusal) => request::refuse(&mut stream, refusal),
        }
    }

    fn answer(&self, request: Request) -> Result<(&'static str, &[u8], bool), Refusal> {
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
                Ok(("text/plain", b"", true))
            }
        }
    }

    fn read(&self, path: &str) -> Result<(&'static str, &[u8]), Refusal> {
        match path {
            "/" => Ok(("text/html; charset=utf-8", self.page)),
            "/scene.json" => Ok(("application/json", &self.scene)),
            _ => Err(Refusal::NotFound),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Read, Write};
    use std::sync::mpsc::channel;

    fn start(page: &'static [u8], scene: &[u8], brought: Option<Sender<Brought>>) -> Server {
        Server::start(bind(0).expect("a free port"), page, scene.to_vec(), brought).expect("a thread")
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
