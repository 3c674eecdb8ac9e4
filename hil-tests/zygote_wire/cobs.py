"""COBS: bytes without a zero, so that a zero can end a frame."""

LONGEST_STRETCH = 254


class CobsError(ValueError):
    """Bytes that COBS never produces."""


def encode(raw: bytes) -> bytes:
    """`raw` without zeros, one byte longer for up to 253 bytes."""
    out = bytearray()
    for stretch in raw.split(b"\0"):
        whole = len(stretch) // LONGEST_STRETCH * LONGEST_STRETCH
        for at in range(0, whole, LONGEST_STRETCH):
            out += b"\xff" + stretch[at : at + LONGEST_STRETCH]
        out += bytes([len(stretch) - whole + 1]) + stretch[whole:]
    return bytes(out)


def decode(encoded: bytes) -> bytes:
    """The bytes that `encode` made this of."""
    out = bytearray()
    at = 0
    while at < len(encoded):
        code = encoded[at]
        stretch = encoded[at + 1 : at + code]
        if code == 0 or 0 in stretch or len(stretch) != code - 1:
            raise CobsError(f"byte {at}: {code} is no length of a stretch among {len(encoded)} bytes")
        out += stretch
        at += code
        if code <= LONGEST_STRETCH and at < len(encoded):
            out.append(0)
    return bytes(out)
