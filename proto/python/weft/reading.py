"""What all binary messages have: header, checksum, sections, rows of numbers."""

from __future__ import annotations

import math
import operator
import struct
from typing import Any, Literal, cast

from . import layout, packages
from .errors import ProtocolError
from .samples import Rows


def demand(condition: bool, message: str) -> None:
    if not condition:
        raise ProtocolError(message)


def padded(size: int) -> int:
    return (size + 7) // 8 * 8


def _checksum(message: bytes) -> tuple[int, int]:
    np = packages.numpy
    if np is not None:
        words = np.frombuffer(message, "<u4").copy()
        words[2:4] = 0
        places = np.arange(1, len(words) + 1, dtype=np.uint32)
        return int(words.sum(dtype=np.uint32)), int((words * places).sum(dtype=np.uint32))
    words = memoryview(message).cast("I")
    a = sum(words) - words[2] - words[3]
    b = sum(map(operator.mul, words, range(1, len(words) + 1))) - 3 * words[2] - 4 * words[3]
    return a % 2**32, b % 2**32


def read_common(message: bytes, type_: int, least: int, last_codec: int) -> tuple[int, int]:
    """Checks the parts common to all messages; returns codec and flags."""
    demand(len(message) >= layout.COMMON.size, "the message is too short")
    kind, version, codec, flags, length, a, b = layout.COMMON.unpack_from(message)
    demand(kind == type_, "the message is of another type")
    demand(version == layout.VERSION, "unknown version")
    demand(codec <= last_codec, "unknown codec")
    demand(len(message) >= least, "the message is too short")
    demand(length == len(message) and length % 8 == 0, "the length does not match")
    demand(_checksum(message) == (a, b), "the checksum does not match")
    return codec, flags


def read_sections(message: bytes, offset: int, count: int) -> dict[tuple[int, int], memoryview]:
    """Payloads by kind and index."""
    view, sections = memoryview(message), {}
    for _ in range(count):
        demand(len(message) - offset >= layout.SECTION.size, "a section is cut off")
        kind, index, length = layout.SECTION.unpack_from(message, offset)
        offset += layout.SECTION.size
        demand(length <= len(message) - offset, "a section is too long")
        end = offset + padded(length)
        demand(not any(view[offset + length : end]), "padding is not zero")
        demand((kind, index) not in sections, "a section appears twice")
        sections[kind, index] = view[offset : offset + length]
        offset = end
    demand(offset == len(message), "bytes are left over")
    return sections


def rows_of(payload: memoryview | None, format_: Literal["f", "d", "I"], count: int, width: int) -> Any:
    """Exactly `count` rows of finite numbers, which share the memory of the message."""
    if payload is None or len(payload) != count * width * struct.calcsize(format_):
        raise ProtocolError("a section does not fit")
    flat = payload.cast(format_)
    np = packages.numpy
    if np is not None:
        rows = np.frombuffer(payload, {"f": "<f4", "d": "<f8", "I": "<u4"}[format_])
        finite = format_ == "I" or bool(np.isfinite(rows).all())
        rows = rows.reshape(count, width)
    else:
        rows, finite = Rows(cast(memoryview, flat), width), format_ == "I" or all(map(math.isfinite, flat))
    demand(finite, "a number is not finite")
    return rows
