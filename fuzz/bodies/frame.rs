//! The frame decoder: any bytes, in pieces of any size, are the same frames; what it takes encodes back to what it took.

use zygote_protocol::{Decoder, FrameError, Header, MAX_ENCODED, MAX_PAYLOAD, encode};

type Frames = Vec<Result<(Header, Vec<u8>), FrameError>>;

fn frames<'a>(pieces: impl Iterator<Item = &'a [u8]>) -> Frames {
    let mut decoder = Decoder::new();
    let mut frames = Vec::new();
    for piece in pieces {
        let mut rest = piece;
        while let Some(result) = decoder.next(&mut rest) {
            frames.push(result.map(|header| (header, decoder.payload().to_vec())));
        }
    }
    frames
}

/// The first byte says how long the pieces are.
pub(crate) fn check(data: &[u8]) {
    let Some((&size, stream)) = data.split_first() else { return };
    let whole = frames(std::iter::once(stream));
    assert_eq!(frames(stream.chunks(usize::from(size).max(1))), whole);
    let delimiters = stream.split(|byte| *byte == 0).count() - 1;
    assert!(whole.len() <= delimiters, "more frames than delimiters");
    for (header, payload) in whole.into_iter().flatten() {
        assert!(payload.len() <= MAX_PAYLOAD);
        let mut out = [0; MAX_ENCODED];
        let length = encode(header, &payload, &mut out).unwrap();
        let again = frames(std::iter::once(&out[..length]));
        assert_eq!(again, [Ok((header, payload))]);
    }
}
