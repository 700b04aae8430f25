"""Frames, and the lists that are in them."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable
from dataclasses import replace
from typing import Any, cast

from . import layout
from .reading import demand, read_common, read_sections, rows_of
from .samples import ContactSample, Frame, GrabSample, GripperSample, Pose, ReactionSample


def _entries(payload: memoryview | None, form: struct.Struct) -> list[tuple]:
    payload = payload or memoryview(b"")
    demand(len(payload) % form.size == 0, "a section does not fit")
    return list(form.iter_unpack(payload))


def _grab(entry: tuple) -> GrabSample:
    id_, viewer, *numbers = entry
    demand(all(map(math.isfinite, numbers)), "a number is not finite")
    return GrabSample(id_, viewer, tuple(numbers[0:3]), tuple(numbers[3:6]), numbers[6])


def _pose(entry: tuple) -> tuple[int, Pose]:
    collider, *numbers = entry
    demand(all(map(math.isfinite, numbers)), "a number is not finite")
    return collider, Pose(tuple(numbers[0:3]), tuple(numbers[3:7]))


def _contact(entry: tuple) -> ContactSample:
    collider, particle, *numbers = entry
    demand(all(map(math.isfinite, numbers)), "a number is not finite")
    return ContactSample(
        collider=None if collider == layout.NO_COLLIDER else collider,
        particle=particle,
        point=tuple(numbers[0:3]),
        normal=tuple(numbers[3:6]),
        gap=numbers[6],
        normal_force=numbers[7],
        friction=tuple(numbers[8:11]),
    )


def _reaction(entry: tuple) -> ReactionSample:
    of, id_, *force = entry
    demand(all(map(math.isfinite, force)), "a number is not finite")
    return ReactionSample(layout.REACTION_OF.get(of) or of, id_, tuple(force))


def _gripper(entry: tuple) -> GripperSample:
    jaw, gripping, *numbers = entry
    demand(all(map(math.isfinite, numbers)), "a number is not finite")
    return GripperSample(
        jaw=jaw,
        gripping=bool(gripping),
        position=tuple(numbers[0:3]),
        rotation=tuple(numbers[3:7]),
        opening=numbers[7],
        force=numbers[8],
        reaction=tuple(numbers[9:12]),
        torque=tuple(numbers[12:15]),
    )


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
    key = bool(flags & layout.KEY)
    demand(key == (reference == sequence), "a key frame builds on no other")
    fits = key and step == 0 if codec == layout.FLOAT32 else math.isfinite(step) and step > 0
    demand(fits, "the step does not fit the codec")
    sections = read_sections(message, start, count)
    velocities = sections.get((layout.VELOCITIES, 0))
    frame = Frame(
        tick=tick,
        time=time,
        server_time=server_time,
        sequence=sequence,
        reference=reference,
        epoch=epoch,
        flags=flags,
        positions=cast(Any, None),  # until the end
        grabs=tuple(map(_grab, _entries(sections.get((layout.GRABS, 0)), layout.GRAB))),
        applied=dict(_entries(sections.get((layout.APPLIED, 0)), layout.APPLIED_ENTRY)),
        poses=dict(map(_pose, _entries(sections.get((layout.POSES, 0)), layout.POSE))),
        contacts=tuple(map(_contact, _entries(sections.get((layout.CONTACTS, 0)), layout.CONTACT))),
        reactions=tuple(map(_reaction, _entries(sections.get((layout.REACTIONS, 0)), layout.REACTION))),
        velocities=rows_of(velocities, "f", vertices, 3) if velocities is not None else None,
        grippers=tuple(map(_gripper, _entries(sections.get((layout.GRIPPERS, 0)), layout.GRIPPER))),
    )
    if unpack is None or codec == layout.FLOAT32:
        positions = rows_of(sections.get((layout.POSITIONS, 0)), "f", vertices, 3)
    else:
        demand((layout.PACKED_POSITIONS, 0) in sections, "the frame has no positions")
        positions = unpack(frame, step, vertices, bytes(sections[layout.PACKED_POSITIONS, 0]))
    return replace(frame, positions=positions)
