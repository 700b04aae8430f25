"""Frames, and the lists that are in them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, cast

from . import layout
from .frame_parts import ARRAYS, LISTS
from .reading import demand, read_common, read_sections, rows_of
from .samples import Frame

KEY = 1  # bit 0 of the flags


def _parts(sections: dict[tuple[int, int], memoryview], vertices: int) -> dict[str, Any]:
    """What the frame has beside times and positions."""
    parts: dict[str, Any] = {}
    for name, (kind, form, entry, collected) in LISTS.items():
        payload = sections.get((kind, 0), memoryview(b""))
        demand(len(payload) % form.size == 0, "a section does not fit")
        entries = list(form.iter_unpack(payload))
        demand(all(all(map(math.isfinite, numbers)) for numbers in entries), "a number is not finite")
        parts[name] = collected(map(entry, entries))
    for name, kind in ARRAYS.items():
        array = sections.get((kind, 0))
        parts[name] = rows_of(array, "f", vertices, 3) if array is not None else None
    return parts


def decode_frame(message: bytes) -> Frame:
    """Reads a frame in codec `f32`; those in `packed` build on each other and need a FrameDecoder."""
    return decode_frame_by(message, None)


def decode_frame_by(message: bytes, unpack: Callable[[Frame, float, int, bytes], Any] | None) -> Frame:
    """`unpack` makes positions of the header and the packed ones; it is called last, as it has effects."""
    start = layout.COMMON.size + layout.FRAME_FIELDS.size
    codec, flags = read_common(message, layout.FRAME, start, layout.PACKED)
    demand(codec == layout.FLOAT32 or codec == layout.PACKED and unpack is not None, "unknown codec")
    fields = layout.FRAME_FIELDS.unpack_from(message, layout.COMMON.size)
    tick, time, server_time, sequence, reference, epoch, vertices, step, count = fields
    demand(tick < layout.TICK_END, "the tick is too large")
    demand(math.isfinite(time) and math.isfinite(server_time), "a time is not finite")
    key = bool(flags & KEY)
    demand(key == (reference == sequence), "a key frame builds on no other")
    fits = key and step == 0 if codec == layout.FLOAT32 else math.isfinite(step) and step > 0
    demand(fits, "the step does not fit the codec")
    sections = read_sections(message, start, count)
    frame = Frame(
        tick=tick,
        time=time,
        server_time=server_time,
        sequence=sequence,
        reference=reference,
        epoch=epoch,
        flags=flags,
        positions=cast(Any, None),  # until the end
        **_parts(sections, vertices),
    )
    if unpack is None or codec == layout.FLOAT32:
        positions = rows_of(sections.get((layout.POSITIONS, 0)), "f", vertices, 3)
    else:
        demand((layout.PACKED_POSITIONS, 0) in sections, "the frame has no positions")
        positions = unpack(frame, step, vertices, bytes(sections[layout.PACKED_POSITIONS, 0]))
    return replace(frame, positions=positions)
