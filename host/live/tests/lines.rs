//! Pages' lines as a network sees them (S14): who is let in, who may do what, and that nobody is kept waiting.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use serde_json::{Value, json};
use std::net::TcpStream;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Error, HandshakeError, Message, WebSocket, client};
use zygote_controller::{Moment, Record, Wish};
use zygote_live::{Hub, Server, Token, Told, bind};

struct Place {
    hub: Arc<Hub>,
    token: String,
    port: u16,
}

fn place() -> Place {
    let (hub, token) = (Arc::new(Hub::new()), Token::fresh().unwrap());
    let said = token.to_string();
    let server = Server::start_live(bind(0).unwrap(), b"<html>", Arc::clone(&hub), token).unwrap();
    let address = server.address();
    let (_, port) = address.trim_end_matches(&format!("/#{said}")).rsplit_once(':').unwrap();
    Place { hub, token: said, port: port.parse().unwrap() }
}

type Page = WebSocket<TcpStream>;

impl Place {
    /// A line from a page of `origin`, to `host`; the HTTP status where it is refused.
    fn line(&self, origin: Option<&str>) -> Result<Page, u16> {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(10))).unwrap();
        let mut request = format!("ws://127.0.0.1:{}/live", self.port).into_client_request().unwrap();
        if let Some(origin) = origin {
            request.headers_mut().insert("Origin", origin.parse().unwrap());
        }
        match client(request, stream) {
            Ok((page, _)) => Ok(page),
            Err(HandshakeError::Failure(Error::Http(answer))) => Err(answer.status().as_u16()),
            Err(error) => panic!("{error}"),
        }
    }

    fn own(&self) -> String {
        format!("http://127.0.0.1:{}", self.port)
    }

    /// A page that is let in.
    fn page(&self, control: bool) -> Page {
        let mut page = self.line(Some(&self.own())).unwrap();
        say(&mut page, &json!({ "type": "hello", "version": 1, "token": self.token, "control": control }));
        assert_eq!(hear(&mut page, "welcome")["version"], 1);
        page
    }

    /// Waits until a stop is asked for.
    fn is_stopped(&self) -> bool {
        let until = Instant::now() + Duration::from_secs(5);
        while Instant::now() < until {
            if self.hub.stop_asked() {
                return true;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        false
    }
}

fn say(page: &mut Page, message: &Value) {
    page.send(Message::text(message.to_string())).unwrap();
}

/// The next message of a type.
fn hear(page: &mut Page, kind: &str) -> Value {
    loop {
        if let Message::Text(text) = page.read().unwrap() {
            let told: Value = serde_json::from_str(&text).unwrap();
            if told["type"] == kind {
                return told;
            }
        }
    }
}

#[test]
fn s14_a_page_from_elsewhere_gets_no_line() {
    let place = place();
    for origin in [Some("http://evil.example"), Some("https://127.0.0.1"), Some("null"), None] {
        assert_eq!(place.line(origin).err(), Some(403), "{origin:?}");
    }
    assert!(place.line(Some(&place.own())).is_ok());
    assert!(place.line(Some(&format!("http://localhost:{}", place.port))).is_ok());
}

#[test]
fn s14_without_the_secret_nothing_is_told_and_nothing_done() {
    let place = place();
    place.hub.tell(&Told::Event(&Record::Paused));
    let wrong = format!("{:0>32}", "");
    for first in [
        json!({ "type": "hello", "version": 1, "token": wrong, "control": true }),
        json!({ "type": "hello", "version": 1, "token": "", "control": true }),
        json!({ "type": "stop", "id": 1 }),
        json!({ "type": "order", "order": "arm" }),
    ] {
        let mut page = place.line(Some(&place.own())).unwrap();
        say(&mut page, &first);
        let Message::Text(text) = page.read().unwrap() else { panic!("expected a refusal") };
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap()["type"], "refused", "{first}");
        assert!(matches!(page.read(), Ok(Message::Close(_))), "{first}");
        assert!(!place.hub.stop_asked(), "{first}");
    }
}

#[test]
fn s14_one_page_steers_and_every_page_stops() {
    let place = place();
    assert_eq!(place.hub.wish(Moment::Loaded), Wish::Wait);
    let mut first = place.page(true);
    assert_eq!(hear(&mut first, "control")["you"], true);
    let mut second = place.page(true);
    assert_eq!(hear(&mut second, "control")["you"], false);
    say(&mut second, &json!({ "type": "order", "order": "arm" }));
    assert!(hear(&mut second, "refused")["why"].as_str().unwrap().contains("only watches"));
    assert_eq!(place.hub.wish(Moment::Loaded), Wish::Wait);
    say(&mut second, &json!({ "type": "stop", "id": 7 }));
    assert_eq!(hear(&mut second, "stopping")["id"], 7);
    assert!(place.is_stopped());
    drop(first);
    while hear(&mut second, "control")["taken"] == true {}
    say(&mut second, &json!({ "type": "control", "take": true }));
    assert_eq!(hear(&mut second, "control")["you"], true);
}

#[test]
fn a_page_that_reads_nothing_keeps_nobody_waiting_and_can_stop() {
    let place = place();
    let mut stuck = place.page(false);
    let mut good = place.page(false);
    let begin = Instant::now();
    let long = "x".repeat(1_000);
    for _ in 0..20_000 {
        place.hub.tell(&Told::Event(&Record::Lost { message: long.clone() }));
    }
    // More than a connection's buffers hold; a teller that waited for the stuck page would wait for ever.
    assert!(begin.elapsed() < Duration::from_secs(5), "{:?}", begin.elapsed());
    for _ in 0..20_000 {
        hear(&mut good, "event");
    }
    say(&mut stuck, &json!({ "type": "stop", "id": 1 }));
    assert!(place.is_stopped());
}

#[test]
fn a_page_that_comes_back_is_told_everything_anew() {
    let place = place();
    for step in 0..3 {
        place.hub.tell(&Told::Event(&Record::Opened { mcu_us: 1, step, hinge: usize::from(step) }));
    }
    for _ in 0..2 {
        let mut page = place.page(false);
        let hinges: Vec<_> = (0..3).map(|_| hear(&mut page, "event")["hinge"].clone()).collect();
        assert_eq!(hinges, [0, 1, 2]);
    }
}

#[test]
fn what_is_no_message_is_refused_and_too_much_ends_the_line() {
    let place = place();
    let mut page = place.page(true);
    page.send(Message::text("hello")).unwrap();
    assert!(hear(&mut page, "refused")["why"].as_str().unwrap().contains("can't be read"));
    page.send(Message::text("x".repeat(5_000))).unwrap();
    loop {
        match page.read() {
            Ok(Message::Close(_)) | Err(_) => break,
            Ok(_) => {}
        }
    }
    assert_eq!(place.hub.wish(Moment::Armed), Wish::Pause, "its control is gone with it");
}
