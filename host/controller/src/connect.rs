//! Opens a session: says hello until it is answered, and understands who is there.

use crate::Transport;
use std::io;
use zygote_protocol::{
    Hello, HelloReply, Link, MAX_ENCODED, Millis, Received, VERSION, VERSION_MIN, decode_payload,
    granted_session, peek_versions, schema,
};

/// A hello is repeated so often until it is answered.
const HELLO_EVERY: Millis = Millis(200);

/// Why no session was opened.
#[derive(Debug, thiserror::Error)]
pub enum ConnectError {
    /// Nobody answered.
    #[error(
        "{line}: no answer to a hello within {waited_ms} ms ({heard} bytes came, none of them a zygote's frame): \
         is this a zygote, and is the baud rate right?"
    )]
    NoAnswer {
        /// The line.
        line: String,
        /// How long it was waited for.
        waited_ms: u32,
        /// Bytes that came all the same.
        heard: usize,
    },
    /// An answer of another version.
    #[error(
        "{line}: the firmware ({firmware}) speaks protocol {theirs_min} to {theirs}, this program {VERSION_MIN} to \
         {VERSION}: flash the firmware of this program's version, or use the program of the firmware's"
    )]
    Version {
        /// The line.
        line: String,
        /// Name of the firmware, where it could be read.
        firmware: String,
        /// Oldest version that the MCU understands.
        theirs_min: u16,
        /// Newest version that the MCU understands.
        theirs: u16,
    },
    /// The same version number, but other messages.
    #[error(
        "{line}: the firmware says protocol {VERSION} as this program does, but its messages differ (schema \
         {theirs:08x}, here {ours:08x}): one of the two is a development build; build both from one commit"
    )]
    Schema {
        /// The line.
        line: String,
        /// Schema hash of the firmware.
        theirs: u32,
        /// Schema hash of this program.
        ours: u32,
    },
    /// The line broke.
    #[error("{line}: the line failed")]
    Line {
        /// The line.
        line: String,
        /// What the system says.
        #[source]
        source: io::Error,
    },
}

/// Says hello as session `number` until the answer comes, but not longer than `patience`; the link is then open.
pub(crate) fn shake_hands<T: Transport>(
    transport: &mut T,
    link: &mut Link,
    number: u32,
    patience: Millis,
) -> Result<HelloReply, ConnectError> {
    let line = transport.name();
    let failed = |source| ConnectError::Line { line: line.clone(), source };
    let deadline = transport.now().plus(patience);
    let mut heard = 0;
    let mut buffer = [0; 1024];
    while transport.now() < deadline {
        // A hello always fits a frame.
        link.send_hello(number, &Hello::ours()).ok();
        transmit(transport, link).map_err(failed)?;
        let again = transport.now().plus(HELLO_EVERY).min(deadline);
        while transport.now() < again {
            let count = transport.receive(&mut buffer, again).map_err(failed)?;
            heard += count;
            let now = transport.now();
            let mut bytes = buffer.get(..count).unwrap_or_default();
            while let Some(received) = link.receive(now, &mut bytes, true) {
                if let Received::HelloReply(session, payload) = received
                    && session == number
                {
                    let info = understand(&line, payload)?;
                    link.open(granted_session(number, info.identity.boot), now);
                    link.heed(info.buffers);
                    return Ok(info);
                }
            }
        }
    }
    Err(ConnectError::NoAnswer { line, waited_ms: patience.0, heard })
}

/// Sends every frame that is due.
pub(crate) fn transmit<T: Transport>(transport: &mut T, link: &mut Link) -> io::Result<()> {
    let mut frame = [0; MAX_ENCODED];
    loop {
        let length = link.poll_transmit(transport.now(), &mut frame);
        match frame.get(..length) {
            None | Some([]) => return Ok(()),
            Some(bytes) => transport.send(bytes)?,
        }
    }
}

/// Reads an answer to a hello; the versions come first, so that they can be read whatever follows.
fn understand(line: &str, payload: &[u8]) -> Result<HelloReply, ConnectError> {
    let info = decode_payload::<HelloReply>(payload);
    // Same leading fields as any HelloReply, of any version.
    let (theirs_min, theirs, schema_hash) = match (&info, peek_versions(payload)) {
        (Some(info), _) => (info.min, info.current, info.schema),
        (None, Some(hello)) => (hello.min, hello.current, hello.schema),
        (None, None) => (0, 0, 0),
    };
    if theirs < VERSION_MIN || theirs_min > VERSION {
        let firmware = info.map_or_else(|| "unknown".to_owned(), |info| info.identity.firmware.to_string());
        return Err(ConnectError::Version { line: line.to_owned(), firmware, theirs_min, theirs });
    }
    let differs = ConnectError::Schema { line: line.to_owned(), theirs: schema_hash, ours: schema::hash() };
    match info {
        Some(info) if schema_hash == schema::hash() => Ok(info),
        Some(_) | None => Err(differs),
    }
}
