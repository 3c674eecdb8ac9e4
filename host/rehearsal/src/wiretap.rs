//! Listens at the board's end of the line, to know when a frame of the host last arrived. Link loss is judged by this
//! and not by what the core says that it has heard.

use zygote_protocol::{Decoder, FrameKind, Micros};

/// What was heard.
#[derive(Debug, Default)]
pub struct Wiretap {
    decoder: Decoder,
    /// The session of the latest hello.
    pub session: Option<u32>,
    /// When the latest frame of that session arrived; a hello is none.
    pub last_frame: Option<Micros>,
}

impl Wiretap {
    /// Listens to bytes that reach the board now.
    pub(crate) fn hear(&mut self, now: Micros, mut bytes: &[u8]) {
        while let Some(frame) = self.decoder.next(&mut bytes) {
            let Ok(header) = frame else { continue };
            match header.kind {
                FrameKind::Hello if self.session != Some(header.session) => {
                    self.session = Some(header.session);
                    self.last_frame = Some(now);
                }
                FrameKind::Hello | FrameKind::HelloReply | FrameKind::Reset => {}
                _ if self.session == Some(header.session) => self.last_frame = Some(now),
                _ => {}
            }
        }
    }
}
