//! One request of HTTP/1.1, read from a connection and answered: no more of the protocol than a browser needs of a page.
//!
//! A page elsewhere on the web may make the user's browser ask this address, and may give a name of its own to it. So the `Host`
//! has to be this address, and an `Origin`, where there is one, as well.

use std::io::{self, Read, Write};

/// A longer head is no browser's.
const MOST_HEAD: usize = 16 * 1024;
/// A longer body is no picture of ours.
const MOST_BODY: usize = 64 * 1024 * 1024;
const MOST_HEADERS: usize = 64;
/// Where lines that stay open begin.
const LIVE: &str = "/live";

/// What is asked for.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Request {
    /// Something to read.
    Get(String),
    /// The same, without its body.
    Head(String),
    /// Something brought.
    Post(String, Vec<u8>),
    /// A line that stays open both ways, with the browser's key.
    Live(String),
}

/// What is answered where there is nothing to read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Refusal {
    /// It isn't HTTP, or too long.
    Malformed,
    /// It was sent to another name than this address, or by a page from elsewhere.
    Foreign,
    /// There is no such path.
    NotFound,
    /// The path isn't for this method.
    Method,
    /// As many lines are open as there may be.
    Busy,
}

impl Refusal {
    const fn status(self) -> &'static str {
        match self {
            Self::Malformed => "400 Bad Request",
            Self::Foreign => "403 Forbidden",
            Self::NotFound => "404 Not Found",
            Self::Method => "405 Method Not Allowed",
            Self::Busy => "503 Service Unavailable",
        }
    }
}

/// Reads a request that was sent to a port of this computer.
///
/// # Errors
/// What the connection says; the refusal is inside.
pub(crate) fn read(stream: &mut impl Read, port: u16) -> io::Result<Result<Request, Refusal>> {
    let mut bytes = Vec::new();
    let head = loop {
        if let Some(end) = bytes.windows(4).position(|four| four == b"\r\n\r\n") {
            break end + 4;
        }
        if bytes.len() > MOST_HEAD || !more(stream, &mut bytes)? {
            return Ok(Err(Refusal::Malformed));
        }
    };
    let Parsed { method, path, length, key } = match parse(&bytes[..head], port) {
        Ok(parsed) => parsed,
        Err(refusal) => return Ok(Err(refusal)),
    };
    if path == LIVE {
        // What follows before the line is granted is no browser's.
        return Ok(key
            .filter(|_| method == "GET" && bytes.len() == head)
            .map(Request::Live)
            .ok_or(Refusal::Malformed));
    }
    Ok(match method.as_str() {
        "GET" => Ok(Request::Get(path)),
        "HEAD" => Ok(Request::Head(path)),
        "POST" => {
            if length > MOST_BODY {
                return Ok(Err(Refusal::Malformed));
            }
            while bytes.len() < head + length {
                if !more(stream, &mut bytes)? {
                    return Ok(Err(Refusal::Malformed));
                }
            }
            Ok(Request::Post(path, bytes[head..head + length].to_vec()))
        }
        _ => Err(Refusal::Method),
    })
}

fn more(stream: &mut impl Read, bytes: &mut Vec<u8>) -> io::Result<bool> {
    let mut chunk = [0; 16 * 1024];
    let read = stream.read(&mut chunk)?;
    bytes.extend_from_slice(&chunk[..read]);
    Ok(read > 0)
}

/// The head of a request.
struct Parsed {
    method: String,
    path: String,
    /// Of the body.
    length: usize,
    /// The key of a browser that wants a line both ways.
    key: Option<String>,
}

fn parse(head: &[u8], port: u16) -> Result<Parsed, Refusal> {
    let mut headers = [httparse::EMPTY_HEADER; MOST_HEADERS];
    let mut request = httparse::Request::new(&mut headers);
    request.parse(head).map_err(|_| Refusal::Malformed)?;
    let (method, path) = request.method.zip(request.path).ok_or(Refusal::Malformed)?;
    let all = |name: &'static str| {
        let named = request.headers.iter().filter(move |header| header.name.eq_ignore_ascii_case(name));
        named.map(|header| std::str::from_utf8(header.value).unwrap_or(""))
    };
    let hosts = [format!("127.0.0.1:{port}"), format!("localhost:{port}")];
    if all("host").count() != 1 || all("host").any(|host| !hosts.iter().any(|ours| ours == host)) {
        return Err(Refusal::Foreign);
    }
    let ours = |origin: &str| {
        origin.strip_prefix("http://").is_some_and(|host| hosts.iter().any(|ours| ours == host))
    };
    if all("origin").any(|origin| !ours(origin)) {
        return Err(Refusal::Foreign);
    }
    // What a browser says of itself: a link followed from elsewhere is `cross-site`, an address typed in is `none`.
    if all("sec-fetch-site").any(|site| !matches!(site, "same-origin" | "none")) && path != "/" {
        return Err(Refusal::Foreign);
    }
    let length = match all("content-length").next() {
        Some(length) => length.parse().map_err(|_| Refusal::Malformed)?,
        None => 0,
    };
    let path = path.split_once('?').map_or(path, |(path, _)| path);
    let upgrades = all("upgrade").any(|to| to.eq_ignore_ascii_case("websocket"))
        && all("sec-websocket-version").any(|version| version == "13");
    let key = all("sec-websocket-key").next().filter(|_| upgrades).map(ToOwned::to_owned);
    if path == LIVE && all("origin").count() == 0 {
        // A browser always says whose page asks.
        return Err(Refusal::Foreign);
    }
    Ok(Parsed { method: method.to_owned(), path: path.to_owned(), length, key })
}

/// Answers with a body.
///
/// # Errors
/// What the connection says.
pub(crate) fn answer(stream: &mut impl Write, kind: &str, body: &[u8], with_body: bool) -> io::Result<()> {
    write!(
        stream,
        "HTTP/1.1 200 OK\r\nContent-Type: {kind}\r\nContent-Length: {}\r\n{GUARDS}\r\n",
        body.len()
    )?;
    if with_body {
        stream.write_all(body)?;
    }
    stream.flush()
}

/// Grants a line that stays open both ways; `accept` is what the browser's key comes to.
///
/// # Errors
/// What the connection says.
pub(crate) fn grant(stream: &mut impl Write, accept: &str) -> io::Result<()> {
    write!(
        stream,
        "HTTP/1.1 101 Switching Protocols\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Accept: {accept}\r\n\r\n"
    )?;
    stream.flush()
}

/// Answers with a refusal.
///
/// # Errors
/// What the connection says.
pub(crate) fn refuse(stream: &mut impl Write, refusal: Refusal) -> io::Result<()> {
    let status = refusal.status();
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: text/plain\r\nContent-Length: {}\r\n{GUARDS}\r\n{status}",
        status.len()
    )?;
    stream.flush()
}

/// What the page may do stands in the page itself; here is what a page can't say of itself.
const GUARDS: &str = "Connection: close\r\nCache-Control: no-store\r\nContent-Security-Policy: frame-ancestors 'none'\r\n\
    Cross-Origin-Opener-Policy: same-origin\r\nCross-Origin-Resource-Policy: same-origin\r\n\
    Referrer-Policy: no-referrer\r\nX-Content-Type-Options: nosniff\r\n";

#[cfg(test)]
mod tests {
    use super::*;

    fn request(text: &str) -> Result<Request, Refusal> {
        read(&mut text.as_bytes(), 4000).expect("a text can be read")
    }

    #[test]
    fn a_browser_at_this_address_is_answered() {
        let asked =
            "GET /scene.json?fresh HTTP/1.1\r\nHost: 127.0.0.1:4000\r\nSec-Fetch-Site: same-origin\r\n\r\n";
        assert_eq!(request(asked), Ok(Request::Get("/scene.json".to_owned())));
        assert_eq!(
            request("HEAD / HTTP/1.1\r\nHost: localhost:4000\r\n\r\n"),
            Ok(Request::Head("/".to_owned()))
        );
        let brought = "POST /picture HTTP/1.1\r\nHost: 127.0.0.1:4000\r\nOrigin: http://127.0.0.1:4000\r\nContent-Length: 3\r\n\r\nabc";
        assert_eq!(request(brought), Ok(Request::Post("/picture".to_owned(), b"abc".to_vec())));
    }

    #[test]
    fn another_name_for_this_address_is_refused() {
        for host in ["evil.example", "evil.example:4000", "127.0.0.1:4001", "127.0.0.1", ""] {
            assert_eq!(
                request(&format!("GET / HTTP/1.1\r\nHost: {host}\r\n\r\n")),
                Err(Refusal::Foreign),
                "{host}"
            );
        }
        assert_eq!(request("GET / HTTP/1.1\r\n\r\n"), Err(Refusal::Foreign));
        let twice = "GET / HTTP/1.1\r\nHost: 127.0.0.1:4000\r\nHost: evil.example\r\n\r\n";
        assert_eq!(request(twice), Err(Refusal::Foreign));
    }

    #[test]
    fn a_page_from_elsewhere_is_refused() {
        for header in [
            "Origin: http://evil.example",
            "Origin: null",
            "Origin: https://127.0.0.1:4000",
            "Sec-Fetch-Site: cross-site",
        ] {
            let asked = format!("GET /scene.json HTTP/1.1\r\nHost: 127.0.0.1:4000\r\n{header}\r\n\r\n");
            assert_eq!(request(&asked), Err(Refusal::Foreign), "{header}");
        }
        // A link to the page may be followed.
        let link = "GET / HTTP/1.1\r\nHost: 127.0.0.1:4000\r\nSec-Fetch-Site: cross-site\r\n\r\n";
        assert_eq!(request(link), Ok(Request::Get("/".to_owned())));
    }

    const LINE: &str = "GET /live HTTP/1.1\r\nHost: 127.0.0.1:4000\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
        Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";

    #[test]
    fn a_line_is_for_a_page_of_this_address_alone() {
        let ours = format!("{LINE}Origin: http://127.0.0.1:4000\r\n\r\n");
        assert_eq!(request(&ours), Ok(Request::Live("dGhlIHNhbXBsZSBub25jZQ==".to_owned())));
        for origin in ["http://evil.example", "http://127.0.0.1:4001", "https://127.0.0.1:4000", "null", ""] {
            let foreign = format!("{LINE}Origin: {origin}\r\n\r\n");
            assert_eq!(request(&foreign), Err(Refusal::Foreign), "{origin}");
        }
        assert_eq!(request(&format!("{LINE}\r\n")), Err(Refusal::Foreign), "no page at all");
        let renamed = ours.replace("Host: 127.0.0.1:4000", "Host: evil.example:4000");
        assert_eq!(request(&renamed), Err(Refusal::Foreign));
    }

    #[test]
    fn what_asks_for_no_line_gets_none() {
        let ours = format!("{LINE}Origin: http://127.0.0.1:4000\r\n\r\n");
        for (from, to) in
            [("Version: 13", "Version: 8"), ("Upgrade: websocket", "Upgrade: h2c"), ("GET", "POST")]
        {
            assert_eq!(request(&ours.replace(from, to)), Err(Refusal::Malformed), "{to}");
        }
        assert_eq!(request(&format!("{ours}early")), Err(Refusal::Malformed));
    }

    #[test]
    fn what_is_too_long_or_no_request_is_refused() {
        assert_eq!(request("hello\r\n\r\n"), Err(Refusal::Malformed));
        assert_eq!(request("GET / HTTP/1.1\r\nHost: 127.0.0.1:4000\r\n"), Err(Refusal::Malformed));
        let long = format!("GET / HTTP/1.1\r\nX: {}\r\n", "x".repeat(MOST_HEAD + 1));
        assert_eq!(request(&long), Err(Refusal::Malformed));
        let head = "POST /picture HTTP/1.1\r\nHost: 127.0.0.1:4000\r\nContent-Length: ";
        for length in ["99999999999", "-1", "4"] {
            assert_eq!(request(&format!("{head}{length}\r\n\r\nabc")), Err(Refusal::Malformed), "{length}");
        }
        assert_eq!(request("DELETE / HTTP/1.1\r\nHost: 127.0.0.1:4000\r\n\r\n"), Err(Refusal::Method));
    }
}
