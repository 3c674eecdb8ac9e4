r"""Postcard for dataclasses: what the fields' types say decides how they are encoded.

| type hint                            | on the wire                                  |
|--------------------------------------|----------------------------------------------|
| `U8`, `U16`, ..., `I64`              | a number                                     |
| `Annotated[bytes, Raw(n)]`           | n bytes                                      |
| `bool`                               | one byte                                     |
| `Text`                               | a string                                     |
| `T \| None`                          | an option                                    |
| `tuple[T, ...]`                      | a sequence                                   |
| a dataclass                          | a struct                                     |
| an `IntEnum`                         | an enum without fields                       |
| a union of dataclasses, in order     | an enum whose variants are those dataclasses |
"""

import dataclasses
import enum
import functools
import types
import typing
from typing import Annotated, Any, Protocol


class PostcardError(ValueError):
    """Bytes that don't encode a value, or a value that can't be encoded."""


class Reader:
    """Bytes with a place in them."""

    def __init__(self, data: bytes):
        self.data = data
        self.at = 0

    def take(self, count: int) -> bytes:
        """The next bytes."""
        taken = self.data[self.at : self.at + count]
        if len(taken) < count:
            raise PostcardError(f"byte {self.at}: expected {count} more bytes, found {len(taken)}")
        self.at += count
        return taken

    def varint(self, bits: int) -> int:
        """The next unsigned number of so many bits."""
        start, value = self.at, 0
        for shift in range(0, bits, 7):
            byte = self.take(1)[0]
            value |= (byte & 0x7F) << shift
            if byte < 0x80:
                if value >> bits:
                    break
                return value
        raise PostcardError(f"byte {start}: a number of more than {bits} bits")


def varint(value: int) -> bytes:
    """An unsigned number, seven bits a byte, lowest first."""
    out = bytearray()
    while value >= 0x80:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


class Codec(Protocol):
    """How values of one type go to bytes and back."""

    def write(self, value: Any) -> bytes: ...

    def read(self, reader: Reader) -> Any: ...


class Byte:
    """A u8."""

    def write(self, value: int) -> bytes:
        return bytes([value])

    def read(self, reader: Reader) -> int:
        return reader.take(1)[0]


@dataclasses.dataclass(frozen=True)
class Unsigned:
    """A u16, u32 or u64."""

    bits: int

    def write(self, value: int) -> bytes:
        if not 0 <= value < 1 << self.bits:
            raise PostcardError(f"expected an unsigned number of {self.bits} bits, found {value}")
        return varint(value)

    def read(self, reader: Reader) -> int:
        return reader.varint(self.bits)


@dataclasses.dataclass(frozen=True)
class Signed:
    """An i16 or i64, in zigzag."""

    bits: int

    def write(self, value: int) -> bytes:
        if not -(1 << self.bits - 1) <= value < 1 << self.bits - 1:
            raise PostcardError(f"expected a number of {self.bits} bits, found {value}")
        return varint(value * 2 if value >= 0 else -value * 2 - 1)

    def read(self, reader: Reader) -> int:
        raw = reader.varint(self.bits)
        return raw >> 1 if raw & 1 == 0 else -(raw >> 1) - 1


class Truth:
    """A bool."""

    def write(self, value: bool) -> bytes:
        return b"\1" if value else b"\0"

    def read(self, reader: Reader) -> bool:
        byte = reader.take(1)[0]
        if byte > 1:
            raise PostcardError(f"byte {reader.at - 1}: expected 0 or 1, found {byte}")
        return byte == 1


@dataclasses.dataclass(frozen=True)
class Raw:
    """So many bytes, without a length."""

    count: int

    def write(self, value: bytes) -> bytes:
        if len(value) != self.count:
            raise PostcardError(f"expected {self.count} bytes, found {len(value)}")
        return value

    def read(self, reader: Reader) -> bytes:
        return reader.take(self.count)


class Letters:
    """A string. Its room is the receiver's business: tests send longer ones on purpose."""

    def write(self, value: str) -> bytes:
        data = value.encode()
        return varint(len(data)) + data

    def read(self, reader: Reader) -> str:
        return reader.take(reader.varint(32)).decode()


@dataclasses.dataclass(frozen=True)
class Optional:
    """Nothing, or a value."""

    inner: Codec

    def write(self, value: Any) -> bytes:
        return b"\0" if value is None else b"\1" + self.inner.write(value)

    def read(self, reader: Reader) -> Any:
        return self.inner.read(reader) if Truth().read(reader) else None


@dataclasses.dataclass(frozen=True)
class Sequence:
    """Values one after the other."""

    inner: Codec

    def write(self, value: tuple) -> bytes:
        return varint(len(value)) + b"".join(map(self.inner.write, value))

    def read(self, reader: Reader) -> tuple:
        return tuple(self.inner.read(reader) for _ in range(reader.varint(32)))


@dataclasses.dataclass(frozen=True)
class Index:
    """An enum without fields."""

    members: type[enum.IntEnum]

    def write(self, value: enum.IntEnum) -> bytes:
        return varint(self.members(value))

    def read(self, reader: Reader) -> enum.IntEnum:
        number = reader.varint(32)
        try:
            return self.members(number)
        except ValueError as error:
            raise PostcardError(f"{self.members.__name__} has no variant {number}") from error


class Struct:
    """A dataclass."""

    def __init__(self, kind: type):
        self.kind = kind
        hints = typing.get_type_hints(kind, include_extras=True)
        self.fields = [(field.name, codec(hints[field.name])) for field in dataclasses.fields(kind)]

    def write(self, value: Any) -> bytes:
        return b"".join(inner.write(getattr(value, name)) for name, inner in self.fields)

    def read(self, reader: Reader) -> Any:
        return self.kind(*(inner.read(reader) for _, inner in self.fields))


class Choice:
    """A union of dataclasses, numbered in order."""

    def __init__(self, variants: tuple[type, ...]):
        self.variants = variants

    def write(self, value: Any) -> bytes:
        number = self.variants.index(type(value))
        return varint(number) + codec(self.variants[number]).write(value)

    def read(self, reader: Reader) -> Any:
        number = reader.varint(32)
        if number >= len(self.variants):
            raise PostcardError(f"expected one of {len(self.variants)} variants, found {number}")
        return codec(self.variants[number]).read(reader)


@functools.cache
def codec(hint: Any) -> Codec:
    """The codec that a type hint stands for."""
    if typing.get_origin(hint) is Annotated:
        return hint.__metadata__[0]
    if typing.get_origin(hint) in (typing.Union, types.UnionType):
        members = typing.get_args(hint)
        if type(None) in members:
            return Optional(codec(next(member for member in members if member is not type(None))))
        return Choice(members)
    if typing.get_origin(hint) is tuple:
        return Sequence(codec(typing.get_args(hint)[0]))
    if hint is bool:
        return Truth()
    if isinstance(hint, type) and issubclass(hint, enum.IntEnum):
        return Index(hint)
    if isinstance(hint, type) and dataclasses.is_dataclass(hint):
        return Struct(hint)
    raise PostcardError(f"no codec for {hint}")


U8 = Annotated[int, Byte()]
U16 = Annotated[int, Unsigned(16)]
U32 = Annotated[int, Unsigned(32)]
U64 = Annotated[int, Unsigned(64)]
I16 = Annotated[int, Signed(16)]
I64 = Annotated[int, Signed(64)]
Text = Annotated[str, Letters()]


def encode(value: Any, hint: Any = None) -> bytes:
    """The bytes of a value; `hint` says its type where it stands in a union."""
    kind: Any = hint or type(value)
    return codec(kind).write(value)


def decode(hint: Any, data: bytes) -> Any:
    """The value that these bytes encode, to the last one."""
    reader = Reader(data)
    value = codec(hint).read(reader)
    if reader.at < len(data):
        raise PostcardError(f"{len(data) - reader.at} bytes after the message")
    return value


def peek(hint: Any, data: bytes) -> Any:
    """The value at the front of these bytes, whatever follows."""
    return codec(hint).read(Reader(data))
