"""The host's end of the wire, written from `docs/src/protocol.md` and from nothing else.

It shares no code with the Rust crate `protocol`, so that the page, the crate and this package keep each other honest.
"""
