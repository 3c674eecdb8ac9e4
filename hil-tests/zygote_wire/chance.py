"""Random messages of any type that the codec knows, to hold one implementation against another."""

import random
from typing import Any

from zygote_wire import postcard
from zygote_wire.postcard import Byte, Choice, Index, Letters, Optional, Raw, Sequence, Signed, Struct, Truth, Unsigned

# Fits the shortest text and the shortest list of the protocol.
SHORTEST_TEXT = 12
SHORTEST_LIST = 4
LETTERS = "az09- ä€😀\0"


def message(hint: Any, rng: random.Random) -> Any:
    """A value of this type: numbers of every length, ends of ranges more often than not by chance."""
    return _value(postcard.codec(hint), rng)


def _value(codec: Any, rng: random.Random) -> Any:
    match codec:
        case Byte():
            return _number(8, rng)
        case Unsigned(bits):
            return _number(bits, rng)
        case Signed(bits):
            return _number(bits, rng) - (1 << bits - 1)
        case Truth():
            return rng.random() < 0.5
        case Raw(count):
            return rng.randbytes(count)
        case Letters():
            text = "".join(rng.choices(LETTERS, k=rng.randrange(SHORTEST_TEXT + 1)))
            return text.encode()[:SHORTEST_TEXT].decode(errors="ignore")
        case Optional(inner):
            return None if rng.random() < 0.5 else _value(inner, rng)
        case Sequence(inner):
            return tuple(_value(inner, rng) for _ in range(rng.randrange(SHORTEST_LIST + 1)))
        case Index(members):
            return rng.choice(list(members))
        case Struct():
            return codec.kind(*(_value(inner, rng) for _, inner in codec.fields))
        case Choice():
            return _value(postcard.codec(rng.choice(codec.variants)), rng)
    raise TypeError(f"no random value of {codec}")


def _number(bits: int, rng: random.Random) -> int:
    """Of every length in bits alike, and both ends now and then."""
    if rng.random() < 0.1:
        return rng.choice([0, (1 << bits) - 1])
    return rng.getrandbits(rng.randrange(1, bits + 1))
