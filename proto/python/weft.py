"""Client of a Weft server: one shared cloth, simulated on the server, seen and held from here.

It speaks weft.v1 (proto/README.md) over the package `websockets` (10.4) and needs nothing else but Python 3.11.
Asynchronous:

    async with weft.connect("ws://127.0.0.1:8080/ws", name="script") as cloth:
        hit = await cloth.pick([0, 1, 3], [0, 0, -1])
        async with cloth.drag(hit, radius=0.05) as hand:
            await hand.move([0, 1.5, 1])
        frame = await cloth.next_frame()

and the same, blocking:

    with weft.open("ws://127.0.0.1:8080/ws") as cloth:
        cloth.pause()
        print(cloth.advance(60)["hash"])

Units are SI and y is up. Vertex data has one row per vertex: a numpy array if numpy is installed, else
`Rows`, a read-only sequence of tuples. Arguments may be numpy's numbers and vectors too.

No call waits forever: `timeout` of `connect` and `open` bounds joining, `call_timeout` every answer (30 s), and
each command takes a `timeout` of its own; None: no bound. A call without an answer in time raises CallTimeout.
`load` waits 300 s by default, `advance` 60 s and one more for each tick, and only `until_asleep` forever. Commands
are paced to keep the server's limit of messages a second: a loop of calls simply runs at that rate.
"""

from __future__ import annotations

import array
import asyncio
import bisect
import functools
import json
import math
import operator
import random
import struct
import sys
import threading
from collections.abc import AsyncIterator, Awaitable, Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any
from urllib.parse import urlsplit

try:
    import numpy
except ImportError:  # optional; everything works without it
    numpy = None

try:
    import websockets
except ImportError:  # only the decoders work without it
    websockets = None

if sys.byteorder != "little":
    raise ImportError("weft.py reads little-endian data as it is and needs such a machine")

SUBPROTOCOL = "weft.v1"
REPEAT_SECONDS = 0.4  # a hand at rest repeats its target; the lease asks for 0.5
MOST_MESSAGE_BYTES = 256 * 2**20
CALL_SECONDS = 30.0  # for an answer or a frame
LOAD_SECONDS = 300.0  # for an answer to `load`
ADVANCE_SECONDS, ADVANCE_TICK_SECONDS = 60.0, 1.0  # for an answer to `advance`, and more for each tick
USUAL_RATE = 1000  # messages a second, if `welcome` names no limit
RATE_PART, BURST_SECONDS = 0.95, 0.25  # of the limit, sustained; a burst has the messages of this time
FIRST_PAUSE, LONGEST_PAUSE = 0.25, 8.0  # before a new attempt to connect [s]
FINAL_CODES = frozenset((1002, 1003, 1007, 1008, 1009, 4003))  # a new attempt would fail alike

# --- errors ---


class WeftError(Exception):
    """Anything that this module raises."""


class ProtocolError(WeftError):
    """Bytes that do not form a message of weft.v1."""


class ConnectionLost(WeftError):
    """The connection ended before the answer arrived, or there is none."""

    def __init__(self, code: int, reason: str):
        super().__init__(f"{code} {reason}".strip())
        self.code, self.reason = code, reason


class CallTimeout(WeftError, TimeoutError):
    """An answer did not arrive in time. The command may have been executed, or may still be."""

    def __init__(self, command: str, seconds: float):
        super().__init__(f"{command}: no answer within {seconds:g} s")
        self.command, self.seconds = command, seconds


def _limit_text(limit: dict) -> str:
    """The allowed values, in words."""
    least, most = limit.get("minimum"), limit.get("maximum")
    if "allowed" in limit:
        return "allowed: " + ", ".join(limit["allowed"])
    if "length" in limit:
        return f"allowed: {limit['length']} elements"
    if least is not None and most is not None:
        return f"allowed: {least:g} to {most:g}"
    return f"allowed: at most {most:g}" if most is not None else ""


class CommandError(WeftError):
    """The server refused a command; the fields are those of its `error` message."""

    def __init__(self, message: dict):
        details = [f"field: {message['field']}" if message.get("field") else ""]
        details += [_limit_text(message.get("limit") or {}), message.get("hint") or ""]
        super().__init__("; ".join(part for part in (message.get("message", ""), *details) if part))
        self.code: str = message.get("code", "internal")
        self.command: str | None = message.get("command")
        self.field: str | None = message.get("field")
        self.value: Any = message.get("value")
        self.limit: dict | None = message.get("limit")
        self.hint: str | None = message.get("hint")


# --- binary messages (sections 6 to 8 of the specification) ---

_FRAME, _MESH, _DATA, _ACK = 1, 2, 3, 4
_VERSION = 1
_KEY, _JUMP, _PAUSED, _OBSERVED = 1, 2, 4, 8
_POSITIONS, _GRABS, _APPLIED, _POSES, _CONTACTS, _REACTIONS, _PACKED_POSITIONS = 1, 2, 3, 4, 5, 6, 7
_VELOCITIES, _GRIPPERS = 8, 9
_REST, _TRIANGLES, _UV, _COLLIDER_POSITIONS, _COLLIDER_TRIANGLES, _ORDER = 16, 17, 18, 19, 20, 21
_FLOAT32, _PACKED = 0, 2  # codecs of frames
_COMMON = struct.Struct("<BBBBIII")
_FRAME_FIELDS = struct.Struct("<QddIIIIfI")
_MESH_FIELDS = struct.Struct("<IIII")
_DATA_FIELDS = struct.Struct("<QIIII")
_SECTION = struct.Struct("<HHI")
_GRAB = struct.Struct("<II7f")
_APPLIED_ENTRY = struct.Struct("<II")
_POSE = struct.Struct("<I7f")
_CONTACT = struct.Struct("<II11f")
_REACTION = struct.Struct("<II3f")
_GRIPPER = struct.Struct("<II12f")
_NO_COLLIDER = 2**32 - 1
_REACTION_OF = {0: "pin", 1: "collider"}
_ACK_FIELDS = struct.Struct("<BBHI")
_TICK_END = 2**53


class Rows(Sequence):
    """Rows of numbers, read-only; `flat` is all of them as a memoryview."""

    def __init__(self, flat: memoryview, width: int):
        self.flat, self.width = flat, width

    def __len__(self) -> int:
        return len(self.flat) // self.width

    def __getitem__(self, index):
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        start = range(len(self))[index] * self.width
        return tuple(self.flat[start : start + self.width])


@dataclass(frozen=True)
class GrabSample:
    """A hand at the tick of a frame; `force` [N] is a magnitude."""

    id: int
    viewer: int  # 0: a hand of the scene itself
    held: tuple[float, float, float]
    target: tuple[float, float, float]
    force: float


@dataclass(frozen=True)
class Pose:
    """A collider whose pose differs from `mesh`: p is at position + rotation (p - pivot)."""

    position: tuple[float, float, float]  # of its pivot [m]
    rotation: tuple[float, float, float, float]  # unit quaternion x, y, z, w


@dataclass(frozen=True)
class ContactSample:
    """A contact of the cloth at the tick of a frame; forces are on the cloth [N]."""

    collider: int | None  # its index in the list of the `mesh` message; None: cloth too
    particle: int
    point: tuple[float, float, float]  # of the cloth's mid-surface [m]
    normal: tuple[float, float, float]  # unit, out of the other side
    gap: float  # from the mid-surface to the other side [m]
    normal_force: float
    friction: tuple[float, float, float]


@dataclass(frozen=True)
class ReactionSample:
    """A force of a pin on the cloth, or of the cloth on a collider [N]."""

    of: str | int  # "pin" or "collider"; a number, if this client does not know it
    id: int  # of the pin, or the collider's index in the list of the `mesh` message
    force: tuple[float, float, float]


@dataclass(frozen=True)
class GripperSample:
    """A gripper at the end of a tick."""

    jaw: int  # its left jaw's index in the list of the `mesh` message; the right one follows
    gripping: bool
    position: tuple[float, float, float]  # of its middle [m]
    rotation: tuple[float, float, float, float]  # from its definition, unit quaternion x, y, z, w
    opening: float  # between its jaws [m]
    force: float  # most that each jaw presses with [N]
    reaction: tuple[float, float, float]  # of the cloth on both jaws, mean of the tick [N]


@dataclass(frozen=True)
class Frame:
    """Positions of the vertices at a tick."""

    tick: int
    time: float  # simulated [s]
    server_time: float  # server's clock [s]
    sequence: int
    reference: int
    epoch: int
    flags: int
    positions: Any  # one row of 3 per vertex [m]
    grabs: tuple[GrabSample, ...]
    applied: dict[int, int]  # viewer to the number of its last included message
    poses: dict[int, Pose]  # by the collider's index in the list of the `mesh` message
    contacts: tuple[ContactSample, ...]  # if `view` asked for forces
    reactions: tuple[ReactionSample, ...]  # if `view` asked for forces
    velocities: Any = None  # one row of 3 per vertex [m/s], if `observe` asked for them
    grippers: tuple[GripperSample, ...] = ()  # if `observe` asked for them

    @property
    def jump(self) -> bool:
        """The state was replaced (reset, load, recovery)."""
        return bool(self.flags & _JUMP)

    @property
    def paused(self) -> bool:
        return bool(self.flags & _PAUSED)

    @property
    def observed(self) -> bool:
        """It has what `observe` of an `advance` asked for."""
        return bool(self.flags & _OBSERVED)


@dataclass(frozen=True)
class ColliderMesh:
    collider: int  # index in the list of the `mesh` message
    positions: Any  # one row of 3 per vertex [m]
    triangles: Any  # one row of 3 per triangle


@dataclass(frozen=True)
class MeshData:
    """Everything constant during an epoch."""

    rest_positions: Any  # one row of 3 per vertex [m]
    triangles: Any  # one row of 3 per triangle
    uv: Any  # one row of 2 per vertex
    colliders: tuple[ColliderMesh, ...]
    order: Any = None  # one row of 4 per vertex, of the codec `packed`; None: all cloths are grids


@dataclass(frozen=True)
class Data:
    """Answer to a binary query."""

    tick: int
    transfer: int
    components: int
    values: Any  # one row of `components` each


@dataclass(frozen=True)
class Hit:
    """A point of the cloth."""

    triangle: int
    barycentric: tuple[float, float, float]
    position: tuple[float, float, float]
    particle: int  # the nearest corner
    distance: float  # along the ray [m]


def _demand(condition: bool, message: str) -> None:
    if not condition:
        raise ProtocolError(message)


def _padded(size: int) -> int:
    return (size + 7) // 8 * 8


def _checksum(message: bytes) -> tuple[int, int]:
    if numpy is not None:
        words = numpy.frombuffer(message, "<u4").copy()
        words[2:4] = 0
        places = numpy.arange(1, len(words) + 1, dtype=numpy.uint32)
        return int(words.sum(dtype=numpy.uint32)), int((words * places).sum(dtype=numpy.uint32))
    words = memoryview(message).cast("I")
    a = sum(words) - words[2] - words[3]
    b = sum(map(operator.mul, words, range(1, len(words) + 1))) - 3 * words[2] - 4 * words[3]
    return a % 2**32, b % 2**32


def _read_common(message: bytes, type_: int, least: int, last_codec: int) -> tuple[int, int]:
    """Checks the parts common to all messages; returns codec and flags."""
    _demand(len(message) >= _COMMON.size, "the message is too short")
    kind, version, codec, flags, length, a, b = _COMMON.unpack_from(message)
    _demand(kind == type_, "the message is of another type")
    _demand(version == _VERSION, "unknown version")
    _demand(codec <= last_codec, "unknown codec")
    _demand(len(message) >= least, "the message is too short")
    _demand(length == len(message) and length % 8 == 0, "the length does not match")
    _demand(_checksum(message) == (a, b), "the checksum does not match")
    return codec, flags


def _read_sections(message: bytes, offset: int, count: int) -> dict[tuple[int, int], memoryview]:
    """Payloads by kind and index."""
    view, sections = memoryview(message), {}
    for _ in range(count):
        _demand(len(message) - offset >= _SECTION.size, "a section is cut off")
        kind, index, length = _SECTION.unpack_from(message, offset)
        offset += _SECTION.size
        _demand(length <= len(message) - offset, "a section is too long")
        end = offset + _padded(length)
        _demand(not any(view[offset + length : end]), "padding is not zero")
        _demand((kind, index) not in sections, "a section appears twice")
        sections[kind, index] = view[offset : offset + length]
        offset = end
    _demand(offset == len(message), "bytes are left over")
    return sections


def _rows(payload: memoryview | None, format_: str, count: int, width: int):
    """Exactly `count` rows of finite numbers."""
    fits = payload is not None and len(payload) == count * width * struct.calcsize(format_)
    _demand(fits, "a section does not fit")
    flat = payload.cast(format_)
    if numpy is not None:
        rows = numpy.frombuffer(payload, {"f": "<f4", "d": "<f8", "I": "<u4"}[format_])
        finite = format_ == "I" or bool(numpy.isfinite(rows).all())
        rows = rows.reshape(count, width)
    else:
        rows, finite = Rows(flat, width), format_ == "I" or all(map(math.isfinite, flat))
    _demand(finite, "a number is not finite")
    return rows


def _triangles(payload: memoryview | None, count: int, vertices: int):
    rows = _rows(payload, "I", count, 3)
    _demand(max(payload.cast("I"), default=-1) < vertices, "an index is out of range")
    return rows


def _entries(payload: memoryview | None, layout: struct.Struct) -> list[tuple]:
    payload = payload or memoryview(b"")
    _demand(len(payload) % layout.size == 0, "a section does not fit")
    return list(layout.iter_unpack(payload))


def _grab(entry: tuple) -> GrabSample:
    id_, viewer, *numbers = entry
    _demand(all(map(math.isfinite, numbers)), "a number is not finite")
    return GrabSample(id_, viewer, tuple(numbers[0:3]), tuple(numbers[3:6]), numbers[6])


def _pose(entry: tuple) -> tuple[int, Pose]:
    collider, *numbers = entry
    _demand(all(map(math.isfinite, numbers)), "a number is not finite")
    return collider, Pose(tuple(numbers[0:3]), tuple(numbers[3:7]))


def _contact(entry: tuple) -> ContactSample:
    collider, particle, *numbers = entry
    _demand(all(map(math.isfinite, numbers)), "a number is not finite")
    return ContactSample(
        collider=None if collider == _NO_COLLIDER else collider,
        particle=particle,
        point=tuple(numbers[0:3]),
        normal=tuple(numbers[3:6]),
        gap=numbers[6],
        normal_force=numbers[7],
        friction=tuple(numbers[8:11]),
    )


def _reaction(entry: tuple) -> ReactionSample:
    of, id_, *force = entry
    _demand(all(map(math.isfinite, force)), "a number is not finite")
    return ReactionSample(_REACTION_OF.get(of, of), id_, tuple(force))


def _gripper(entry: tuple) -> GripperSample:
    jaw, gripping, *numbers = entry
    _demand(all(map(math.isfinite, numbers)), "a number is not finite")
    return GripperSample(
        jaw=jaw,
        gripping=bool(gripping),
        position=tuple(numbers[0:3]),
        rotation=tuple(numbers[3:7]),
        opening=numbers[7],
        force=numbers[8],
        reaction=tuple(numbers[9:12]),
    )


def decode_frame(message: bytes) -> Frame:
    """Reads a frame in codec `f32`; those in `packed` build on each other and need a FrameDecoder."""
    return _decode_frame(message, None)


def _decode_frame(message: bytes, unpack: Callable | None) -> Frame:
    """`unpack` makes positions of the header and the packed ones; it is called last, as it has effects."""
    start = _COMMON.size + _FRAME_FIELDS.size
    codec, flags = _read_common(message, _FRAME, start, _PACKED)
    _demand(codec == _FLOAT32 or codec == _PACKED and unpack is not None, "unknown codec")
    fields = _FRAME_FIELDS.unpack_from(message, _COMMON.size)
    tick, time, server_time, sequence, reference, epoch, vertices, step, count = fields
    _demand(tick < _TICK_END, "the tick is too large")
    _demand(math.isfinite(time) and math.isfinite(server_time), "a time is not finite")
    key = bool(flags & _KEY)
    _demand(key == (reference == sequence), "a key frame builds on no other")
    fits = key and step == 0 if codec == _FLOAT32 else math.isfinite(step) and step > 0
    _demand(fits, "the step does not fit the codec")
    sections = _read_sections(message, start, count)
    velocities = sections.get((_VELOCITIES, 0))
    frame = Frame(
        tick=tick,
        time=time,
        server_time=server_time,
        sequence=sequence,
        reference=reference,
        epoch=epoch,
        flags=flags,
        positions=None,
        grabs=tuple(map(_grab, _entries(sections.get((_GRABS, 0)), _GRAB))),
        applied=dict(_entries(sections.get((_APPLIED, 0)), _APPLIED_ENTRY)),
        poses=dict(map(_pose, _entries(sections.get((_POSES, 0)), _POSE))),
        contacts=tuple(map(_contact, _entries(sections.get((_CONTACTS, 0)), _CONTACT))),
        reactions=tuple(map(_reaction, _entries(sections.get((_REACTIONS, 0)), _REACTION))),
        velocities=_rows(velocities, "f", vertices, 3) if velocities is not None else None,
        grippers=tuple(map(_gripper, _entries(sections.get((_GRIPPERS, 0)), _GRIPPER))),
    )
    if codec == _FLOAT32:
        positions = _rows(sections.get((_POSITIONS, 0)), "f", vertices, 3)
    else:
        _demand((_PACKED_POSITIONS, 0) in sections, "the frame has no positions")
        positions = unpack(frame, step, vertices, bytes(sections[_PACKED_POSITIONS, 0]))
    return replace(frame, positions=positions)


def _collider(sections: dict, index: int) -> ColliderMesh:
    corners = sections[_COLLIDER_POSITIONS, index]
    faces = sections.get((_COLLIDER_TRIANGLES, index))
    _demand(faces is not None, "a collider has no triangles")
    vertices = len(corners) // 12
    positions = _rows(corners, "f", vertices, 3)
    return ColliderMesh(index, positions, _triangles(faces, len(faces) // 12, vertices))


def decode_mesh(message: bytes) -> MeshData:
    start = _COMMON.size + _MESH_FIELDS.size
    _read_common(message, _MESH, start, 0)
    fields = _MESH_FIELDS.unpack_from(message, _COMMON.size)
    vertices, triangles, collider_meshes, count = fields
    sections = _read_sections(message, start, count)
    indices = sorted(index for kind, index in sections if kind == _COLLIDER_POSITIONS)
    faces = sum(kind == _COLLIDER_TRIANGLES for kind, _ in sections)
    promised = len(indices) == collider_meshes and faces == collider_meshes
    _demand(promised, "the number of collider meshes does not fit")
    return MeshData(
        rest_positions=_rows(sections.get((_REST, 0)), "f", vertices, 3),
        triangles=_triangles(sections.get((_TRIANGLES, 0)), triangles, vertices),
        uv=_rows(sections.get((_UV, 0)), "f", vertices, 2),
        colliders=tuple(_collider(sections, index) for index in indices),
        order=_order_rows(sections.get((_ORDER, 0)), vertices),
    )


def _order_rows(payload: memoryview | None, vertices: int):
    """Checked too: each vertex once, each neighbour before."""
    if payload is None:
        return None
    rows = _rows(payload, "I", vertices, 4)
    _read_order(rows)
    return rows


def decode_data(message: bytes) -> Data:
    start = _COMMON.size + _DATA_FIELDS.size
    codec, _ = _read_common(message, _DATA, start, 1)
    tick, transfer, count, components, zero = _DATA_FIELDS.unpack_from(message, _COMMON.size)
    _demand(tick < _TICK_END and zero == 0 and 1 <= components <= 16, "the header does not fit")
    size = count * components * (4 if codec == 0 else 8)
    _demand(len(message) == start + _padded(size), "the values do not fit")
    _demand(not any(message[start + size :]), "padding is not zero")
    payload = memoryview(message)[start : start + size]
    return Data(tick, transfer, components, _rows(payload, "fd"[codec], count, components))


def decode_binary(message: bytes) -> Frame | MeshData | Data:
    """Reads any binary message of a server. Raises ProtocolError and nothing else on the bytes."""
    decoders = {_FRAME: decode_frame, _MESH: decode_mesh, _DATA: decode_data}
    decode = decoders.get(message[0] if message else 0)
    _demand(decode is not None, "unknown type")
    return decode(message)


# --- the codec `packed` (section 10 of the specification) ---

_PAYLOAD = struct.Struct("<BBHIIII")
_ORIGIN = struct.Struct("<3d")
_STATES = struct.Struct("<II")
_CONTEXT_BOUNDS = (0, 1, 2, 4, 8, 16, 40, 100, 250)
_CONTEXT_OF = tuple(bisect.bisect_left(_CONTEXT_BOUNDS, around) for around in range(252))
_STATE_LOW = 2**23
_MOST_STEPS = 2**20
_PADDING = bytes(256)  # what a few values may read beyond the end


def _signed(value: int) -> int:
    return (value + 2**31) % 2**32 - 2**31


def _read_order(rows) -> tuple[list[int], list[tuple[int, int, int]]]:
    """Vertices in coding order, and the places of their neighbours; the number of vertices: missing."""
    count, missing, vertices, near = len(rows), 2**32 - 1, [], []
    taken = bytearray(count)
    for place, row in enumerate(rows):
        vertex, *others = map(int, row)
        _demand(vertex < count and not taken[vertex], "the order is none of the vertices")
        _demand(all(n < place or n == missing for n in others), "a neighbour does not come before")
        taken[vertex] = 1
        vertices.append(vertex)
        near.append(tuple(count if n == missing else n for n in others))
    return vertices, near


def _grid_order(cloths: Iterable[dict], count: int) -> tuple[list[int], list[tuple[int, int, int]]]:
    near = []
    for cloth in cloths:
        first, vertices = cloth["first_vertex"], cloth["vertices"]
        columns = cloth.get("columns", 0)
        grid = first == len(near) and cloth.get("rows", 0) * columns == vertices
        _demand(grid, "a cloth without an order is no grid")
        for i in range(vertices):
            at, left, above = first + i, i % columns > 0, i >= columns
            if left and above:
                near.append((at - 1, at - columns, at - columns - 1))
            else:
                near.append((at - 1 if left else at - columns if above else count, count, count))
    _demand(len(near) == count, "the cloths are not all of the mesh")
    return list(range(count)), near


class _Tokens:
    """Reads the residuals of a packed frame: tables, rANS with two states, raw bits."""

    def __init__(self, data: bytes, raw_length: int):
        _demand(raw_length <= len(data), "the raw bits are cut off")
        self._end = len(data) - raw_length
        self._data, self._at = data[: self._end], 0
        self._tables = [self._read_table() for _ in range(len(_CONTEXT_BOUNDS) + 1)]
        _demand(self._at + _STATES.size <= self._end, "the states are cut off")
        self._now, self._next = _STATES.unpack_from(data, self._at)
        fit = all(_STATE_LOW <= state < 2**31 for state in (self._now, self._next))
        _demand(fit, "a state is out of range")
        self._at += _STATES.size
        self._data += _PADDING
        self._raw, self._raw_left = int.from_bytes(data[self._end :], "little"), 8 * raw_length

    def _byte(self) -> int:
        _demand(self._at < self._end, "a table is cut off")
        self._at += 1
        return self._data[self._at - 1]

    def _read_table(self) -> tuple[list[int], list[int], list[int]]:
        """The token of each slot; the frequency of each token, and that of those below it added up."""
        count, slots, frequencies, below = self._byte(), [], [], []
        _demand(count <= 58, "too many tokens")
        for token in range(count):
            frequency = self._byte()
            if frequency >= 128:
                frequency = (frequency & 127) | self._byte() << 7
            _demand(len(slots) + frequency <= 4096, "frequencies are too large")
            frequencies.append(frequency)
            below.append(len(slots))
            slots += [token] * frequency
        _demand(len(slots) == (4096 if count else 0), "frequencies do not add up")
        return slots, frequencies, below

    def residuals(self, near: list[tuple[int, int, int]]) -> list[int]:
        """Those of one component, zigzag, and a 0 for what is missing."""
        tables, contexts, data, low_state = self._tables, _CONTEXT_OF, self._data, _STATE_LOW
        now, after, at, end = self._now, self._next, self._at, self._end
        values = [0] * (len(near) + 1)
        for i, (a, b, _) in enumerate(near):
            around = values[a] + values[b]
            slots, frequencies, below = tables[contexts[around] if around < 251 else 9]
            if not slots or at > end:
                raise ProtocolError("the packed positions cannot be read")
            slot = now & 4095
            token = slots[slot]
            x = frequencies[token] * (now >> 12) + slot - below[token]
            while x < low_state:
                x, at = x << 8 | data[at], at + 1
            now, after = after, x
            values[i] = token if token < 16 else self._long(token)
        self._now, self._next, self._at = now, after, at
        return values

    def _long(self, token: int) -> int:
        bits = (token - 16 >> 1) + 3
        low = self._raw & ((1 << bits) - 1)
        self._raw >>= bits
        self._raw_left -= bits
        _demand(self._raw_left >= 0, "the raw bits are cut off")
        return (2 + (token & 1) << bits) | low

    def demand_end(self) -> None:
        ended = self._now == self._next == _STATE_LOW and self._at == self._end
        _demand(ended and self._raw_left < 8 and self._raw == 0, "bytes are left over")


def _add_neighbours(kind: int, values: list[int], near: list[tuple[int, int, int]]) -> list[int]:
    """Differences from residuals."""
    none = len(near)
    d = [0] * (none + 1)
    for i, (a, b, c) in enumerate(near):
        residual = values[i] >> 1 ^ -(values[i] & 1)
        if kind == 0:
            d[i] = residual
        elif kind == 2:
            d[i] = _signed(residual + d[a] + d[b] - d[c])
        elif b == none:
            d[i] = _signed(residual + d[a])
        elif kind == 1:
            d[i] = _signed(residual + (_signed(d[a] + d[b]) >> 1))
        else:
            d[i] = _signed(residual + (_signed(3 * (d[a] + d[b]) - 2 * d[c] + 2) >> 2))
    return d[:none]


class FrameDecoder:
    """Decodes the frames of one mesh in either codec, in the order in which they were sent. A frame that is
    refused changes nothing. A packed frame of 16,000 vertices takes about 0.1 s."""

    def __init__(self, cloths: Iterable[dict], data: MeshData):
        """`cloths` are those of the text message `mesh`, `data` its binary part."""
        count = len(data.rest_positions)
        order = _grid_order(cloths, count) if data.order is None else _read_order(data.order)
        self._vertices, self._near = order
        self._held: tuple[tuple[int, list[list[int]]], ...] = ()  # sequence and numbers, the last one first
        self._origin, self._step = (0.0, 0.0, 0.0), 0.0

    def decode(self, message: bytes) -> Frame:
        return _decode_frame(message, self._unpack)

    def _unpack(self, frame: Frame, step: float, vertices: int, payload: bytes):
        key = frame.reference == frame.sequence
        start = _PAYLOAD.size + (_ORIGIN.size if key else 0)
        _demand(vertices == len(self._vertices), "the frame does not fit the mesh")
        _demand(len(payload) >= start, "the packed positions are cut off")
        base, kind, zero, before, raw_length, *sums = _PAYLOAD.unpack_from(payload)
        _demand(base <= 2 and kind <= 3 and zero == 0, "the prediction is unknown")
        _demand(not key or base == 0, "a key frame builds on no other")
        origin = _ORIGIN.unpack_from(payload, _PAYLOAD.size) if key else self._origin
        held = () if key else self._held
        _demand(key or bool(held) and held[0][0] == frame.reference, "a frame is missing")
        _demand(key or step == self._step, "the step changes without a key frame")
        named = len(held) > 1 and held[1][0] == before if base == 2 else before == 0
        _demand(named and all(map(math.isfinite, origin)), "a frame is missing")
        tokens = _Tokens(payload[start:], raw_length)
        planes = [self._plane(tokens, base, kind, held, component) for component in range(3)]
        tokens.demand_end()
        positions = self._place(planes, sums, origin, step)
        self._held = ((frame.sequence, planes), *held[:1])
        self._origin, self._step = origin, step
        return positions

    def _plane(self, tokens: _Tokens, base: int, kind: int, held: tuple, component: int) -> list[int]:
        d = _add_neighbours(kind, tokens.residuals(self._near), self._near)
        if base == 0:
            return d
        last = held[0][1][component]
        if base == 1:
            return list(map(operator.add, d, last))
        return [x + 2 * p - o for x, p, o in zip(d, last, held[1][1][component])]

    def _place(self, planes: list[list[int]], sums: list[int], origin: tuple, step: float):
        """Numbers to coordinates, with all checks of the numbers."""
        flat = [number for plane in planes for number in plane]
        small = -_MOST_STEPS < min(flat, default=0) and max(flat, default=0) < _MOST_STEPS
        _demand(small, "a number is out of range")
        a, b = sum(flat), sum(map(operator.mul, flat, range(1, len(flat) + 1)))
        _demand([a % 2**32, b % 2**32] == sums, "the sums of the numbers do not match")
        values = array.array("f", bytes(4 * len(flat)))
        for component, plane in enumerate(planes):
            start = origin[component]
            for vertex, number in zip(self._vertices, plane):
                values[3 * vertex + component] = start + number * step
        return _rows(memoryview(values.tobytes()), "f", len(self._vertices), 3)


def encode_ack(sequence: int) -> bytes:
    """The answer to a frame."""
    return _ACK_FIELDS.pack(_ACK, _VERSION, 0, sequence)


# --- the client ---


_CLIENTS = object()  # timeout of a call that means the client's


def _is_number(value) -> bool:
    """Whether it is a whole number, also one of numpy."""
    return hasattr(value, "__index__")


def _plain(value):
    """Converts numpy's numbers and arrays, and any type with their `tolist`, for JSON."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"a value of type {type(value).__name__} cannot be sent")


def _hold_fields(hold) -> dict:
    """Fields that tell where to hold, from a Hit, a particle's number, or a dict with them."""
    if _is_number(hold):
        return {"particle": hold}
    if isinstance(hold, Hit):
        return {"triangle": hold.triangle, "barycentric": list(hold.barycentric)}
    names = ("triangle", "barycentric") if "triangle" in hold else ("particle",)
    return {name: hold[name] for name in names}


def _listed(vector):
    """A vector as it can be sent; what lists itself, as numpy's do, is sent as it is."""
    return vector if vector is None or hasattr(vector, "tolist") else list(vector)


def _without_none(fields: dict) -> dict:
    return {name: value for name, value in fields.items() if value is not None}


def _pause_before(attempt: int, jitter: float) -> float:
    """Seconds to wait before an attempt to connect again; the first is 0. `jitter` is from 0 to 1."""
    return min(LONGEST_PAUSE, FIRST_PAUSE * 2 ** min(attempt, 16)) * (0.5 + 0.5 * jitter)


class _Pace:
    """Spreads messages over time so that they stay below a limit: some at once after a quiet time, then one after
    the other."""

    def __init__(self, limit: float = USUAL_RATE):
        self._free = 0.0  # when all messages sent so far are paid off [s]
        self._interval = 1 / (RATE_PART * limit)

    def set_limit(self, limit: float, now: float) -> None:
        """Sets the messages a second that the server allows, also as a burst."""
        sent = max(0.0, self._free - now) / self._interval  # counts by the new limit too
        self._interval = 1 / (RATE_PART * limit)
        self._free = now + sent * self._interval

    def wait_before_next(self, now: float) -> float:
        """Takes a message's place and returns how long it must wait for it [s]."""
        begin = max(self._free, now)
        self._free = begin + self._interval
        return max(0.0, begin - max(0.0, BURST_SECONDS - self._interval) - now)


class Client:
    """A viewer of a Weft server. Make one with `connect`.

    With `reconnect` it joins again by itself, with growing pauses, when the connection is lost; commands
    raise ConnectionLost in the meantime, hands are lost, and a call that waits for a frame goes on waiting.
    The event `status` reports it: a dict with `phase` ("open", "waiting" or "closed"), and for the last
    two `code` and `reason`.

    Commands return the server's `result` as a dict, unless they document another type. They raise CommandError if
    the server refuses, ConnectionLost if the connection ends first and CallTimeout if no answer arrives
    within `timeout` seconds: by default the client's `call_timeout`; None: no bound.

    Kept up to date: `welcome`, `mesh` (the text message), `mesh_data`, `frame` (the newest), and the
    messages `state`, `roster`, `pins`, `grabs`; each is None before the first.
    """

    def __init__(
        self, socket, dial: Callable[[], Awaitable], hello: dict, reconnect: bool,
        call_timeout: float | None = CALL_SECONDS,
    ):  # fmt: skip
        self._socket, self._dial = socket, dial
        self.call_timeout = call_timeout  # for an answer or a frame [s]; None: no bound
        self._pace, self._turn = _Pace(), asyncio.Lock()
        self._hello, self._view = _without_none(hello), {}  # repeated after a reconnection
        self._reconnect = reconnect
        self._redial: asyncio.Task | None = None
        self._connections = 1
        self._attempts = 0  # to connect again since the last welcome
        self._waiting: dict[int, asyncio.Future] = {}
        self._transfers: dict[int, tuple[asyncio.Future, dict]] = {}
        self._listeners: dict[str, list[Callable[[Any], None]]] = {}
        self._next_id = self._next_drag = 1
        self._changed = asyncio.Condition()
        self._lost: WeftError | None = None  # why there is no connection now
        self._ended = False  # and none will follow
        self.welcome: dict | None = None
        self.mesh: dict | None = None
        self.mesh_data: MeshData | None = None
        self._packed: FrameDecoder | None = None  # of the present mesh
        self._observation: Frame | None = None  # the last frame that an `advance` observed
        self.frame: Frame | None = None
        self.state: dict | None = None
        self.roster: dict | None = None
        self.pins: dict | None = None
        self.grabs: dict | None = None
        self._reader = asyncio.create_task(self._read())

    @property
    def viewer(self) -> int:
        """Own number among the viewers; 0 before `welcome`."""
        return self.welcome["viewer"] if self.welcome else 0

    @property
    def sleeping(self) -> tuple[str, ...]:
        """Cloths that have come to rest and are not stepped, as the newest `state` names them. That message
        may come a little after the answer to a command; `query("state")` asks for it."""
        return tuple((self.state or {}).get("sleeping", {}).get("cloths", ()))

    @property
    def all_asleep(self) -> bool:
        """Whether all cloths sleep; no frame comes then until something wakes one or an object moves."""
        return bool(self.sleeping) and len(self.sleeping) == len(self.mesh["cloths"])

    async def until_asleep(self, *, timeout: float | None = None) -> None:
        """Waits until all cloths sleep, in a running room whose scene lets them (`sleep.after`)."""
        await self._in_time("until_asleep", timeout, self._until(lambda: self.all_asleep))

    def on(self, name: str, listener: Callable[[Any], None]) -> Callable[[], None]:
        """Calls `listener` with each message of this name (`frame`, `mesh`, `state`, `notice`, …,
        `refused` for errors that answer no call). Returns a function that ends it."""
        listeners = self._listeners.setdefault(name, [])
        listeners.append(listener)
        return lambda: listeners.remove(listener)

    async def close(self) -> None:
        self._reconnect = False
        if self._redial is not None:
            self._redial.cancel()
        await self._socket.close()
        await self._reader

    # --- commands (section 5 of the specification) ---

    async def request(self, op: str, *, timeout=_CLIENTS, **fields) -> dict:
        """Sends any command and waits for its result."""
        return await self._in_time(op, timeout, self._ask(op, fields))

    async def _ask(self, op: str, fields: dict) -> dict:
        if self._lost:
            raise self._lost
        id_, self._next_id = self._next_id, self._next_id + 1
        answer = asyncio.get_running_loop().create_future()
        self._waiting[id_] = answer
        try:
            await self.post(op, id=id_, **fields)
            return await answer
        finally:
            self._waiting.pop(id_, None)
            if answer.done() and not answer.cancelled():
                answer.exception()  # retrieved, even if sending failed first

    async def _in_time(self, what: str, timeout, waiting: Awaitable):
        """Its result, or CallTimeout."""
        seconds = self.call_timeout if timeout is _CLIENTS else timeout
        try:
            async with asyncio.timeout(seconds) as bound:
                return await waiting
        except TimeoutError as error:
            if not bound.expired():
                raise
            raise CallTimeout(what, seconds) from error

    async def post(self, op: str, **fields) -> None:
        """Sends a command without waiting for an answer."""
        if self._lost:
            raise self._lost
        await self._send(op, **fields)

    async def _send(self, op: str, **fields) -> None:
        text = json.dumps({"op": op, **fields}, allow_nan=False, default=_plain)
        socket = self._socket
        async with self._turn:  # so that no message overtakes another
            wait = self._pace.wait_before_next(asyncio.get_running_loop().time())
            if wait > 0:
                await asyncio.sleep(wait)
            if socket is not self._socket:  # a message for the previous connection is dropped
                raise self._lost or ConnectionLost(1006, "the connection was lost before the message was sent")
            try:
                await socket.send(text)
            except websockets.ConnectionClosed as closed:
                raise self._lost or ConnectionLost(1006, str(closed)) from closed

    async def hello(self, *, name: str | None = None, color: str | None = None, timeout=_CLIENTS) -> dict:
        fields = _without_none({"name": name, "color": color})
        self._hello.update(fields)
        return await self.request("hello", timeout=timeout, **fields)

    async def pick(
        self, origin: Iterable[float], direction: Iterable[float], *, timeout=_CLIENTS
    ) -> Hit | None:
        """The point where a ray meets the cloth."""
        ray = {"origin": list(origin), "direction": list(direction)}
        hit = (await self.request("pick", timeout=timeout, **ray))["hit"]
        if hit is None:
            return None
        return Hit(
            hit["triangle"],
            tuple(hit["barycentric"]),
            tuple(hit["position"]),
            hit["particle"],
            hit["distance"],
        )

    def drag(
        self, hold, *, target=None, radius=None, stiffness=None, max_force=None, mode=None, timeout=_CLIENTS
    ) -> Drag:
        """A hand; it takes hold with `async with` or `await start()`.

        `hold` is a Hit, a particle's number, or a dict with `particle` or `triangle` and
        `barycentric`. With mode="sling" the cloth is left alone until the hand lets go. `timeout` is
        for each of its commands.
        """
        number, self._next_drag = self._next_drag, self._next_drag + 1
        fields = {"radius": radius, "stiffness": stiffness, "max_force": max_force, "mode": mode}
        fields["target"] = None if target is None else list(target)
        return Drag(self, number, {**_hold_fields(hold), **_without_none(fields)}, timeout)

    # --- commands that follow from their fields: written by proto/generate.py ---

    async def camera(
        self, position: Iterable[float], target: Iterable[float], *, up: Iterable[float] | None = None,
        fov: float | None = None, timeout=_CLIENTS,
    ) -> dict:  # fmt: skip
        """Stores where this viewer looks from, so that others may follow.

        position: of the eye [m]; 3 × ±10000
        target: what it looks at; not the same point [m]; 3 × ±10000
        up: a direction; 3 × ±10000
        fov: vertical angle of view [degrees]; 1 to 179
        """
        fields = {"position": _listed(position), "target": _listed(target), "up": _listed(up), "fov": fov}
        return await self.request("camera", timeout=timeout, **_without_none(fields))

    async def pause(self, *, timeout=_CLIENTS) -> dict:
        """Stops the room's clock."""
        return await self.request("pause", timeout=timeout)

    async def resume(self, *, timeout=_CLIENTS) -> dict:
        """Lets the room's clock run."""
        return await self.request("resume", timeout=timeout)

    async def step(self, n: int = 1, *, timeout=_CLIENTS) -> dict:
        """Lets ticks pass in a paused room.

        n: ticks; 1 to 600
        """
        fields = {"n": n}
        return await self.request("step", timeout=timeout, **_without_none(fields))

    async def reset(self, *, timeout=_CLIENTS) -> dict:
        """Back to the scene's start."""
        return await self.request("reset", timeout=timeout)

    async def speed(self, speed: float, *, timeout=_CLIENTS) -> dict:
        """Sets how fast time passes.

        speed: simulated per real time; 0.01 to 10
        """
        fields = {"speed": speed}
        return await self.request("speed", timeout=timeout, **_without_none(fields))

    async def gripper(
        self, name: str, *, opening: float | None = None, force: float | None = None,
        position: Iterable[float] | None = None, rotation: Iterable[float] | None = None, speed: float | None = None,
        turn_speed: float | None = None, timeout=_CLIENTS,
    ) -> dict:  # fmt: skip
        """Opens, closes (opening=0) or moves a gripper; omitted values stay as they are.

        name: of the gripper; 1 to 56 bytes
        opening: between its jaws; 0 closes on what is there [m]; 0 to 1
        force: with which each jaw presses [N]; 0 to 1000
        position: target of its middle [m]; 3 × ±1000
        rotation: relative to its definition; without it, as it is now; unit quaternion
        speed: of its middle, at most [m/s]; 0.001 to 20
        turn_speed: at most [rad/s]; 0.001 to 60
        """
        fields = {
            "name": name, "opening": opening, "force": force, "position": _listed(position),
            "rotation": _listed(rotation), "speed": speed, "turn_speed": turn_speed,
        }  # fmt: skip
        return await self.request("gripper", timeout=timeout, **_without_none(fields))

    async def set(
        self, *, gravity: Iterable[float] | None = None, wind: Iterable[float] | None = None,
        gust_speed: float | None = None, gust_length: float | None = None, air_density: float | None = None,
        still_air: bool | None = None, drag: float | None = None, fans: list[dict] | None = None,
        softness: float | None = None, budget_ms: float | None = None, over_budget: str | None = None,
        fabric: dict | None = None, cloth: str | int | None = None, timeout=_CLIENTS,
    ) -> dict:  # fmt: skip
        """Changes forces, settings and fabric of the room; omitted values stay as they are.

        gravity: acceleration [m/s²]; 3 × ±1000
        wind: mean velocity [m/s]; 3 × ±100
        gust_speed: typical speed of the gusts [m/s]; 0 to 100
        gust_length: size of an eddy [m]; 0.01 to 100
        air_density: of the air [kg/m³]; 0 to 1000
        still_air: air resists without wind too; true or false
        drag: uniform damping of velocities [1/s]; 0 to 1000
        fans: all local winds; list of at most 4
        softness: fraction of the springs' stiffness; 0.01 to 1
        budget_ms: for each tick that is due; 0: no bound [ms]; 0 to 1000
        over_budget: what gives way beyond it; slow or soften
        fabric: of one cloth
        cloth: whose fabric: its name, or its place in the list of mesh; the first by default
        """
        fields = {
            "gravity": _listed(gravity), "wind": _listed(wind), "gust_speed": gust_speed, "gust_length": gust_length,
            "air_density": air_density, "still_air": still_air, "drag": drag, "fans": fans, "softness": softness,
            "budget_ms": budget_ms, "over_budget": over_budget, "fabric": fabric, "cloth": cloth,
        }  # fmt: skip
        return await self.request("set", timeout=timeout, **_without_none(fields))

    # --- the others ---

    async def pin(self, hold, *, radius: float | None = None, timeout=_CLIENTS) -> dict:
        fields = {**_hold_fields(hold), **_without_none({"radius": radius})}
        return await self.request("pin", timeout=timeout, **fields)

    async def release(
        self, *, pin: int | None = None, particle: int | None = None, all=None, timeout=_CLIENTS
    ) -> dict:
        """Removes one pin, those of a particle, or all."""
        fields = {"pin": pin, "particle": particle, "all": all}
        return await self.request("release", timeout=timeout, **_without_none(fields))

    async def move(
        self, what: str | int | dict, position=None, rotation=None, *, speed=None, turn_speed=None,
        force=None, release=None, seconds=None, max_force=None, stop=None, timeout=_CLIENTS,
    ) -> dict:  # fmt: skip
        """Sends a collider, by its name or as {"collider": its place in the list of the mesh message}, to a
        pose at bounded speed, or back to its keyframes (release=True);
        or a pin, by its id, to a position, at bounded speed or within some seconds, or fixes it where it is
        on its way (stop=True)."""
        named = isinstance(what, dict)
        fields = dict(what) if named else {"pin" if _is_number(what) else "collider": what}
        fields["position"] = None if position is None else list(position)
        fields["rotation"] = None if rotation is None else list(rotation)
        fields |= {"speed": speed, "turn_speed": turn_speed, "force": force, "release": release}
        fields |= {"seconds": seconds, "max_force": max_force, "stop": stop}
        return await self.request("move", timeout=timeout, **_without_none(fields))

    async def advance(
        self, n: int, *, frames: str | None = None, observe: Iterable[str] | None = None, timeout=_CLIENTS
    ) -> dict:  # fmt: skip
        """Runs n ticks as fast as possible; the room must be paused. Result: tick and hash.

        `frames` says which of its frames this viewer gets, regardless of its `hz`: "all", "last" or "none";
        by default those that its `hz` allows. They arrive before the result, so that `frame` is then the
        last tick's. `observe` lists what else to tell of the last tick ("velocities", "contacts", "reactions",
        "grippers"): `observation` of the result is its frame with them.
        """
        if timeout is _CLIENTS:
            ticks = n if _is_number(n) or isinstance(n, float) else 0  # the server refuses other types
            timeout = ADVANCE_SECONDS + ADVANCE_TICK_SECONDS * ticks
        fields = _without_none({"frames": frames})
        if observe is not None:
            fields["observe"] = list(observe)
        result = await self.request("advance", timeout=timeout, n=n, **fields)
        return result if observe is None else {**result, "observation": self._observation}

    async def query(
        self,
        what: str,
        *,
        format: str | None = None,
        viewer: int | None = None,
        tree: str | None = None,
        level: int | None = None,
        timeout=_CLIENTS,
    ):
        """The data of a query; a `Data` if the format is "f32" or "f64"."""
        options = _without_none({"format": format, "viewer": viewer, "tree": tree, "level": level})
        return (await self.request("query", timeout=timeout, what=what, **options))["data"]

    async def hash(self, *, timeout=_CLIENTS) -> str:
        return (await self.request("hash", timeout=timeout))["hash"]

    async def load(self, scene: str | dict, *, timeout=_CLIENTS) -> dict:
        if timeout is _CLIENTS:
            timeout = LOAD_SECONDS
        return await self.request("load", timeout=timeout, scene=scene)

    async def view(
        self, *, hz: float | None = None, codec: str | None = None, error: float | None = None,
        forces: bool | None = None, timeout=_CLIENTS,
    ) -> dict:  # fmt: skip
        """What frames are sent. With codec="packed" they take about a byte a vertex, off by at most `error` [m]
        (1e-4), and some time to decode in Python."""
        fields = _without_none({"hz": hz, "codec": codec, "error": error, "forces": forces})
        self._view.update(fields)
        return await self.request("view", timeout=timeout, **fields)

    async def ping(self, *, timeout=_CLIENTS) -> tuple[float, float]:
        """Round trip, and the server's clock minus this client's [s]."""
        now = asyncio.get_running_loop().time
        sent = now()
        answer = await self.request("ping", timeout=timeout, t=sent)
        back = now()
        round_trip = back - sent - (answer["sent"] - answer["received"])
        return round_trip, (answer["received"] - sent + answer["sent"] - back) / 2

    # --- frames ---

    async def next_frame(self, *, timeout=_CLIENTS) -> Frame:
        """The next frame; none is sent while nothing changes: all cloths sleep, or the room is paused."""
        before = self.frame
        await self._in_time("next_frame", timeout, self._until(lambda: self.frame is not before))
        return self.frame

    async def frame_at(self, tick: int, *, timeout=_CLIENTS) -> Frame:
        """The first frame from now on whose tick is at least this one."""
        reached = self._until(lambda: self.frame is not None and self.frame.tick >= tick)
        await self._in_time("frame_at", timeout, reached)
        return self.frame

    async def frames(self) -> AsyncIterator[Frame]:
        """Newest frames as long as the connection lasts; a slow loop misses some."""
        last = self.frame
        while True:
            try:
                await self._until(lambda: self.frame is not last)
            except ConnectionLost:
                return
            last = self.frame
            yield last

    # --- inside ---

    async def _until(self, condition: Callable[[], bool]) -> None:
        async with self._changed:
            await self._changed.wait_for(lambda: condition() or self._ended)
        if not condition():
            raise self._lost

    async def _ready(self) -> None:
        """Waits for the messages that a client needs to begin."""
        await self._until(lambda: self.welcome is not None and self.mesh_data is not None)

    async def _read(self) -> None:
        while True:
            self._lose(await self._read_socket())
            if not self._reconnect or self._is_final(self._lost):
                break
            try:
                self._redial = asyncio.ensure_future(self._join_again())
                await self._redial
            except asyncio.CancelledError:
                break
            except ProtocolError as error:  # another program answers there now
                self._lost = error
                break
            # A dial that ends at the moment of its cancellation may swallow the cancellation.
            if not self._reconnect:
                break
        await self._socket.close()
        self._ended = True
        self._tell("status", {"phase": "closed", **self._why()})
        async with self._changed:
            self._changed.notify_all()

    @staticmethod
    def _is_final(lost: WeftError) -> bool:
        return isinstance(lost, ConnectionLost) and lost.code in FINAL_CODES

    def _why(self) -> dict:
        lost = self._lost
        if isinstance(lost, ConnectionLost):
            return {"code": lost.code, "reason": lost.reason}
        return {"code": 4002, "reason": str(lost)}

    def _lose(self, lost: WeftError) -> None:
        """Notes the loss of the connection."""
        self._lost, self.welcome = lost, None
        self._transfers.clear()
        for answer in self._waiting.values():
            if not answer.done():
                answer.set_exception(lost)

    async def _join_again(self) -> None:
        while self._reconnect:
            pause = _pause_before(self._attempts, random.random())
            self._attempts += 1
            self._tell("status", {"phase": "waiting", **self._why(), "retry_in": pause})
            await asyncio.sleep(pause)
            try:
                self._socket = await self._dial()
                self._connections += 1
                self._pace = _Pace()
                if self._hello:
                    await self._send("hello", **self._hello)
                if self._view:
                    await self._send("view", **self._view)
                return
            except ConnectionLost as lost:
                self._lost = lost

    async def _read_socket(self) -> WeftError:
        """Reads until the connection ends; returns why it did."""
        fault = None
        try:
            async for message in self._socket:
                await self._take(message)
        except websockets.ConnectionClosed:
            pass  # the close code below tells why
        except ProtocolError as error:
            fault = error
        except (AttributeError, IndexError, KeyError, TypeError) as error:
            fault = ProtocolError(f"a message is not as it must be: {error!r}")
        if fault:
            await self._socket.close(4002, str(fault)[:100])
        code, reason = self._socket.close_code, self._socket.close_reason
        return fault or ConnectionLost(code or 1006, reason or "connection lost")

    async def _take(self, message: str | bytes) -> None:
        if isinstance(message, str):
            name, value = self._take_text(message)
        else:
            name, value = await self._take_binary(message)
        self._tell(name, value)
        if name == "welcome":
            self._tell("status", {"phase": "open"})
        async with self._changed:
            self._changed.notify_all()

    def _tell(self, name: str, value) -> None:
        for listener in list(self._listeners.get(name, ())):
            try:
                listener(value)
            except Exception as error:  # thrown by a listener
                context = {"message": f"a listener of {name} failed", "exception": error}
                asyncio.get_running_loop().call_exception_handler(context)

    def _take_text(self, text: str) -> tuple[str, Any]:
        try:
            message = json.loads(text)
        except ValueError as error:
            raise ProtocolError("a text message is not JSON") from error
        _demand(isinstance(message, dict), "a text message is no object")
        op = message.get("op", "")
        if op == "mesh":
            self.mesh, self.mesh_data = message, None
            return "", None  # reported when its data has arrived
        if op == "result":
            return self._answer(message)
        if op == "error":
            return self._refuse(message)
        if op in ("welcome", "state", "roster", "pins", "grabs"):
            setattr(self, op, message)
        if op == "welcome":
            self._lost, self._attempts = None, 0
            limit = message.get("limits", {}).get("messages_per_second") or USUAL_RATE
            self._pace.set_limit(limit, asyncio.get_running_loop().time())
        return op, message

    def _answer(self, message: dict) -> tuple[str, Any]:
        answer = self._waiting.get(message.get("id"))
        if answer is not None and not answer.done():
            if "binary" in message:
                self._transfers[message["binary"]["transfer"]] = (answer, message)
            else:
                answer.set_result(message)
        return "result", message

    def _refuse(self, message: dict) -> tuple[str, Any]:
        answer, error = self._waiting.get(message.get("id")), CommandError(message)
        if answer is None or answer.done():
            return "refused", error
        answer.set_exception(error)
        return "error", error

    async def _take_binary(self, content: bytes) -> tuple[str, Any]:
        message = self._decode(content)
        if isinstance(message, Data):
            answer, result = self._transfers.pop(message.transfer, (None, None))
            if answer is not None and not answer.done():
                answer.set_result({**result, "data": message})
            return "data", message
        if isinstance(message, MeshData):
            self._check_mesh(message)
            self.mesh_data, self._packed = message, None
            return "mesh", message
        await self._socket.send(encode_ack(message.sequence))
        if self.mesh_data is None or self.mesh["epoch"] != message.epoch:
            return "", None  # of an earlier mesh
        _demand(len(message.positions) == self.mesh["vertices"], "the frame does not fit the mesh")
        self.frame = message
        if message.observed:
            self._observation = message
        return "frame", message

    def _decode(self, content: bytes) -> Frame | MeshData | Data:
        packed = content[:1] == bytes([_FRAME]) and content[2:3] == bytes([_PACKED])
        if not packed or self.mesh_data is None:
            return decode_binary(content)
        if self._packed is None:  # now that one is needed: making it takes a while
            self._packed = FrameDecoder(self.mesh["cloths"], self.mesh_data)
        return self._packed.decode(content)

    def _check_mesh(self, data: MeshData) -> None:
        _demand(self.mesh is not None, "a mesh came unannounced")
        kinds = [collider["kind"] for collider in self.mesh["colliders"]]
        fits = (
            len(data.rest_positions) == self.mesh["vertices"]
            and len(data.triangles) == self.mesh["triangles"]
            and [c.collider for c in data.colliders]
            == [i for i, kind in enumerate(kinds) if kind == "mesh"]
        )
        _demand(fits, "the mesh is not the one announced")


class Drag:
    """A hand that pulls the cloth towards a target. It repeats the target while it holds."""

    def __init__(self, client: Client, number: int, start: dict, timeout=_CLIENTS):
        self._client, self._start, self._target = client, start, start.get("target")
        self._timeout = timeout
        self._repeater: asyncio.Task | None = None
        self._connection = client._connections
        self.number = number
        self.grab: int | None = None  # the room's number, once it holds

    async def start(self) -> Drag:
        self._connection = self._client._connections
        fields = {"phase": "start", "drag": self.number, **self._start}
        result = await self._client.request("drag", timeout=self._timeout, **fields)
        self.grab = result["grab"]
        if self._target is None:
            self._target = result.get("target")
        self._repeater = asyncio.create_task(self._repeat())
        return self

    async def move(self, target: Iterable[float]) -> dict:
        """Pulls towards another point [m]; returns when the command has its place in a tick."""
        self._target = list(target)
        if self._is_lost():
            raise ConnectionLost(1006, "the hand was lost with its connection")
        fields = {"phase": "move", "drag": self.number, "target": self._target}
        return await self._client.request("drag", timeout=self._timeout, **fields)

    async def end(self, *, fire=None) -> dict | None:
        """Lets go; a sling then gives its impulse, unless fire is False."""
        if self._repeater is None:
            return None
        self._repeater.cancel()
        self._repeater = None
        if self._is_lost():
            return None
        fields = {"phase": "end", "drag": self.number, **_without_none({"fire": fire})}
        return await self._client.request("drag", timeout=self._timeout, **fields)

    def _is_lost(self) -> bool:
        return self._connection != self._client._connections

    async def _repeat(self) -> None:
        while True:
            await asyncio.sleep(REPEAT_SECONDS)
            if self._is_lost():
                return
            fields = {"phase": "move", "drag": self.number, "target": self._target}
            try:
                await self._client.post("drag", **fields)
            except ConnectionLost:
                return

    async def __aenter__(self) -> Drag:
        return await self.start()

    async def __aexit__(self, *error) -> None:
        try:
            await self.end()
        except ConnectionLost:
            pass
        except CommandError as refusal:  # the server let go before
            if refusal.code != "unknown_drag":
                raise


def _socket_address(url: str) -> str:
    """The address of a server's socket; the argument may be that of its page."""
    scheme = {"http": "ws", "https": "wss"}
    try:
        parts = urlsplit(url)
        known = parts.scheme in ("ws", "wss", *scheme) and parts.hostname and parts.port != 0
    except ValueError:  # an invalid port
        known = False
    if not known:
        raise WeftError(f"{url!r} is no address of a server: give one as ws://127.0.0.1:8080/ws, or that of its page")
    path = parts.path if parts.path not in ("", "/") else "/ws"
    return parts._replace(scheme=scheme.get(parts.scheme, parts.scheme), path=path, fragment="").geturl()


class _Connecting:
    """Result of `connect`: gives a client if awaited, and one that closes itself in `async with`."""

    def __init__(self, url: str, hello: dict, timeout: float, reconnect: bool, call_timeout: float | None):
        self._url, self._hello, self._timeout, self._reconnect = _socket_address(url), hello, timeout, reconnect
        self._call_timeout = call_timeout
        self._client: Client | None = None

    async def _dial(self):
        """A socket that speaks weft.v1."""
        if websockets is None:
            raise ImportError("no package `websockets` for this Python: Debian has it as python3-websockets, "
                              "for /usr/bin/python3")
        try:
            socket = await websockets.connect(
                self._url,
                subprotocols=[SUBPROTOCOL],
                compression=None,
                max_size=MOST_MESSAGE_BYTES,
                open_timeout=self._timeout,
                close_timeout=self._timeout,
            )
        except (OSError, asyncio.TimeoutError, websockets.InvalidHandshake) as error:
            raise ConnectionLost(1006, f"no connection to {self._url}: {error}") from error
        if socket.subprotocol != SUBPROTOCOL:
            await socket.close(4002)
            raise ProtocolError(f"the server does not speak {SUBPROTOCOL}")
        return socket

    async def _connect(self) -> Client:
        socket = await self._dial()
        self._client = Client(socket, self._dial, self._hello, self._reconnect, self._call_timeout)
        try:
            try:
                await asyncio.wait_for(self._client._ready(), self._timeout)
            except asyncio.TimeoutError as error:
                raise ConnectionLost(1006, "the server does not begin") from error
            if any(self._hello.values()):
                await self._client.hello(**self._hello)
        except BaseException:
            await self._client.close()
            raise
        return self._client

    def __await__(self):
        return self._connect().__await__()

    async def __aenter__(self) -> Client:
        return await self._connect()

    async def __aexit__(self, *error) -> None:
        await self._client.close()


def connect(
    url: str,
    *,
    name: str | None = None,
    color: str | None = None,
    timeout: float = 10,
    reconnect: bool = False,
    call_timeout: float | None = CALL_SECONDS,
) -> _Connecting:
    """Joins a server: `client = await connect(url)` or `async with connect(url) as client`.

    `url` is that of the socket, ws://HOST:PORT/ws, or of the page, http://HOST:PORT/, as the server prints it.
    `timeout` [s] bounds joining, `call_timeout` each answer by default; None: no bound.
    """
    return _Connecting(url, {"name": name, "color": color}, timeout, reconnect, call_timeout)


# --- blocking ---


class SyncDrag:
    """A hand, blocking. Use it with `with`, or call `start` and `end`."""

    def __init__(self, owner: SyncClient, drag: Drag):
        self._owner, self._drag = owner, drag

    @property
    def grab(self) -> int | None:
        return self._drag.grab

    def start(self) -> SyncDrag:
        self._owner._run(self._drag.start())
        return self

    def move(self, target: Iterable[float]) -> dict:
        return self._owner._run(self._drag.move(target))

    def end(self, *, fire=None) -> dict | None:
        return self._owner._run(self._drag.end(fire=fire))

    def __enter__(self) -> SyncDrag:
        return self.start()

    def __exit__(self, *error) -> None:
        self._owner._run(self._drag.__aexit__(*error))


class SyncClient:
    """A client whose commands block; its event loop runs in a thread of its own.

    It has the commands and properties of `Client`. Listeners are called in that thread.
    """

    def __init__(
        self, url: str, *, name=None, color=None, timeout: float = 10, reconnect=False,
        call_timeout: float | None = CALL_SECONDS,
    ):  # fmt: skip
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="weft", daemon=True)
        self._thread.start()
        try:
            joining = connect(
                url, name=name, color=color, timeout=timeout, reconnect=reconnect, call_timeout=call_timeout
            )
            self._client: Client = self._run(joining._connect())
        except BaseException:
            self._stop()
            raise

    def _run(self, coroutine):
        return asyncio.run_coroutine_threadsafe(coroutine, self._loop).result()

    def _stop(self) -> None:
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    def close(self) -> None:
        if not self._loop.is_closed():
            self._run(self._client.close())
            self._stop()

    def __enter__(self) -> SyncClient:
        return self

    def __exit__(self, *error) -> None:
        self.close()

    def drag(self, hold, **options) -> SyncDrag:
        return SyncDrag(self, self._client.drag(hold, **options))

    def on(self, name: str, listener: Callable[[Any], None]) -> Callable[[], None]:
        return self._client.on(name, listener)

    def __getattr__(self, name: str):
        if name in _PROPERTIES:
            return getattr(self._client, name)
        raise AttributeError(name)


_PROPERTIES = frozenset(
    ("viewer", "welcome", "mesh", "mesh_data", "frame", "state", "roster", "pins", "grabs", "sleeping",
     "all_asleep", "call_timeout")
)


def _blocking(method):
    @functools.wraps(method)
    def call(self, *args, **options):
        return self._run(method(self._client, *args, **options))

    return call


for _name in (
    "request post hello pick pin release camera pause resume step reset speed move gripper set advance "
    "query hash load view ping next_frame frame_at until_asleep"
).split():
    setattr(SyncClient, _name, _blocking(getattr(Client, _name)))


def open(
    url: str, *, name=None, color=None, timeout: float = 10, reconnect=False,
    call_timeout: float | None = CALL_SECONDS,
) -> SyncClient:  # fmt: skip
    """Joins a server, blocking; use it with `with`. The arguments are those of `connect`."""
    return SyncClient(
        url, name=name, color=color, timeout=timeout, reconnect=reconnect, call_timeout=call_timeout
    )
