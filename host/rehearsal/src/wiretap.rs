//! Listens at the board's end of the line, to know when a frame of the host last arrived. Link loss is judged by this
//! and not by what the core says that it has heard.

use zygote_protocol::{Decoder, FrameKind, Micros, granted_session};

/// What was heard.
#[derive(Debug, Default)]
pub struct Wiretap {
    decoder: Decoder,
    /// The session that the latest hello asked for, and when, if it isn't known yet what was granted.
    asked: Option<(u32, Micros)>,
    /// The session that the latest hello opened.
    pub session: Option<u32>,
    /// When the latest frame of that session arrived; a hello is none.
    pub last_frame: Option<Micros>,
}

impl Wiretap {
    /// Listens to bytes that reach a board now; `boot` is its boot, as far as that is known.
    pub(crate) fn hear(&mut self, now: Micros, boot: Option<u32>, mut bytes: &[u8]) {
        while let Some(frame) = self.decoder.next(&mut bytes) {
            let Ok(header) = frame else { continue };
            match header.kind {
                FrameKind::Hello => {
                    self.asked = Some((header.session, now));
                    self.grant(boot);
                }
                FrameKind::HelloReply | FrameKind::Reset => {}
                _ => {
                    self.grant(boot);
                    if self.session == Some(header.session) {
                        self.last_frame = Some(now);
                    }
                }
            }
        }
    }

    /// A hello opens its session as soon as the board's boot is known.
    fn grant(&mut self, boot: Option<u32>) {
        let Some(boot) = boot else { return };
        let Some((session, at)) = self.asked.take() else { return };
        let granted = Some(granted_session(session, boot));
        if self.session != granted {
            self.session = granted;
            self.last_frame = Some(at);
        }
    }
}
