//! Listens at the board's end of the line, to know when a frame of the host last arrived. Link loss is judged by this
//! and not by what the core says that it has heard.

use zygote_protocol::{Decoder, FrameKind, Micros, granted_session};

/// What was heard.
#[derive(Debug, Default)]
pub struct Wiretap {
    decoder: Decoder,
    /// The session that the latest hello opened.
    pub session: Option<u32>,
    /// When the latest frame of that session arrived; a hello is none.
    pub last_frame: Option<Micros>,
}

impl Wiretap {
    /// Listens to bytes that reach a board of this boot now.
    pub(crate) fn hear(&mut self, now: Micros, boot: u32, mut bytes: &[u8]) {
        while let Some(frame) = self.decoder.next(&mut bytes) {
            let Ok(header) = frame else { continue };
            match header.kind {
                FrameKind::Hello => {
                    let granted = Some(granted_session(header.session, boot));
                    if self.session != granted {
                        self.session = granted;
                        self.last_frame = Some(now);
                    }
                }
                FrameKind::HelloReply | FrameKind::Reset => {}
                _ if self.session == Some(header.session) => self.last_frame = Some(now),
                _ => {}
            }
        }
    }
}
