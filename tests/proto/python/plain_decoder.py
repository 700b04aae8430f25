"""A decoder of Weft's frames, written from proto/README.md alone: it imports nothing of Weft.

    decoder = Decoder(cloths, mesh_message)     # `cloths` as in the text message `mesh`
    frame = decoder.decode(frame_message)       # in either codec
    frame.positions                             # three float32 values a vertex, as an array
"""

import struct
from array import array
from math import isfinite

FRAME, MESH = 1, 2
FLOAT32, PACKED = 0, 2
KEY = 1
WORD = 2**32
STATE_LOW = 2**23


class Refused(Exception):
    """Bytes that are no message of weft.v1."""


def demand(condition, message):
    if not condition:
        raise Refused(message)


def read_header(message, kind):
    """Codec and flags (section 6)."""
    demand(len(message) >= 16, "too short")
    type_, version, codec, flags, length, sum_a, sum_b = struct.unpack_from("<BBBBIII", message)
    demand(type_ == kind and version == 1, "another type or version")
    demand(length == len(message) and length % 8 == 0, "length")
    words = list(struct.unpack(f"<{length // 4}I", message))
    words[2] = words[3] = 0
    a = sum(words) % WORD
    b = sum((j + 1) * word for j, word in enumerate(words)) % WORD
    demand((a, b) == (sum_a, sum_b), "checksum")
    return codec, flags


def read_sections(message, offset, count):
    """Payloads by kind and index."""
    sections = {}
    for _ in range(count):
        demand(offset + 8 <= len(message), "a section is cut off")
        kind, index, length = struct.unpack_from("<HHI", message, offset)
        start, offset = offset + 8, offset + 8 + (length + 7) // 8 * 8
        demand(offset <= len(message), "a section is too long")
        demand(not any(message[start + length : offset]), "padding")
        demand((kind, index) not in sections, "a section appears twice")
        sections[kind, index] = bytes(message[start : start + length])
    demand(offset == len(message), "bytes are left over")
    return sections


def grid_order(first, columns, count, none):
    for i in range(first, first + count):
        left, above = (i - first) % columns > 0, i - first >= columns
        near = [i - 1, i - columns, i - columns - 1]
        yield i, near if left and above else [near[0 if left else 1] if left or above else none, none, none]


def read_order(payload, vertices):
    """Vertices in coding order, and the places of their neighbours a, b, c (section 10)."""
    demand(len(payload) == 16 * vertices, "the order does not fit")
    order, near = [], []
    for place, (vertex, *others) in enumerate(struct.iter_unpack("<4I", payload)):
        demand(all(other < place or other == WORD - 1 for other in others), "a neighbour is later")
        order.append(vertex)
        near.append([vertices if other == WORD - 1 else other for other in others])
    demand(sorted(order) == list(range(vertices)), "a vertex is missing")
    return order, near


class Bits:
    """Bits from the lowest of each byte on."""

    def __init__(self, data):
        self.value, self.left = int.from_bytes(data, "little"), 8 * len(data)

    def take(self, count):
        demand(count <= self.left, "the raw bits are used up")
        taken = self.value & ((1 << count) - 1)
        self.value >>= count
        self.left -= count
        return taken


class Tokens:
    """The coded tokens: rANS with two states that take turns."""

    def __init__(self, data):
        self.data, self.at = data, 0
        self.tables = [self.read_table() for _ in range(10)]
        demand(self.at + 8 <= len(data), "the states are cut off")
        self.states = list(struct.unpack_from("<II", data, self.at))
        self.at += 8
        demand(all(STATE_LOW <= x < 2**31 for x in self.states), "a state is out of range")

    def byte(self):
        demand(self.at < len(self.data), "the coded bytes are used up")
        self.at += 1
        return self.data[self.at - 1]

    def read_table(self):
        """Token, frequency and sum of those below, for each of the 4096 slots."""
        tokens, slots = self.byte(), []
        demand(tokens <= 58, "too many tokens")
        for token in range(tokens):
            f = self.byte()
            if f >= 128:
                f = f - 128 + 128 * self.byte()
            slots += [(token, f, len(slots))] * f
            demand(len(slots) <= 4096, "the frequencies are too large")
        demand(len(slots) in ((4096,) if tokens else (0,)), "the frequencies do not add up")
        return slots

    def take(self, number, context):
        demand(self.tables[context], "a context that does not occur")
        x = self.states[number % 2]
        token, f, below = self.tables[context][x % 4096]
        x = f * (x // 4096) + x % 4096 - below
        while x < STATE_LOW:
            x = 256 * x + self.byte()
        self.states[number % 2] = x
        return token

    def demand_end(self):
        demand(self.states == [STATE_LOW] * 2 and self.at == len(self.data), "no end")


CONTEXTS = [0, 1, 2, 3, 3] + [4] * 4 + [5] * 8 + [6] * 24 + [7] * 60 + [8] * 150 + [9]


def signed(value):
    value %= WORD
    return value - WORD if value >= WORD // 2 else value


def residuals(tokens, bits, near, number):
    """Of one component."""
    v = [0] * (len(near) + 1)
    for i, (a, b, _) in enumerate(near):
        token = tokens.take(number + i, CONTEXTS[min(v[a] + v[b], 251)])
        low = (token - 16) // 2 + 3
        v[i] = token if token < 16 else (2 + token % 2 << low) + bits.take(low)
    return v


def restore(v, near, neighbours):
    """Differences from residuals."""
    d = [0] * len(v)
    none = len(near)
    for i, (a, b, c) in enumerate(near):
        total = d[a] + d[b]
        blend = signed(3 * total - 2 * d[c] + 2) >> 2
        guess = (0, signed(total) >> 1, total - d[c], blend)[neighbours]
        predicted = d[a] if b == none and neighbours % 2 == 1 else guess
        d[i] = signed((v[i] >> 1 ^ -(v[i] & 1)) + predicted)
    return d


class Frame:
    def __init__(self, message):
        self.codec, self.flags = read_header(message, FRAME)
        demand(len(message) >= 64 and self.codec in (FLOAT32, PACKED), "codec")
        self.tick, self.time, self.server_time = struct.unpack_from("<Qdd", message, 16)
        self.sequence, self.reference, self.epoch = struct.unpack_from("<3I", message, 40)
        self.vertices, self.step, count = struct.unpack_from("<IfI", message, 52)
        demand(self.tick < 2**53 and isfinite(self.time + self.server_time), "tick or time")
        self.key = bool(self.flags & KEY)
        demand(self.key == (self.reference == self.sequence), "key and reference")
        self.sections = read_sections(message, 64, count)
        plain = self.codec == FLOAT32
        demand(self.key and self.step == 0 if plain else 0 < self.step < 1e39, "step")
        demand((1 if plain else 7, 0) in self.sections, "no positions")
        self.positions = array("f", [])


class Decoder:
    """Decodes the frames of one mesh in the order in which they come."""

    def __init__(self, cloths, mesh_message):
        read_header(mesh_message, MESH)
        self.vertices, _, _, count = struct.unpack_from("<4I", mesh_message, 16)
        sections = read_sections(mesh_message, 32, count)
        if (21, 0) in sections:
            self.order, self.near = read_order(sections[21, 0], self.vertices)
        else:
            places = []
            for cloth in cloths:
                first, columns, count = (cloth[n] for n in ("first_vertex", "columns", "vertices"))
                places += grid_order(first, columns, count, self.vertices)
            self.order, self.near = [p[0] for p in places], [p[1] for p in places]
        self.held = []  # sequence and numbers of the last two packed frames, the last one first
        self.origin, self.step = None, None

    def decode(self, message):
        frame = Frame(message)
        if frame.codec == PACKED:
            self.unpack(frame)
        else:
            frame.positions.frombytes(frame.sections[1, 0])
        demand(len(frame.positions) == 3 * self.vertices == 3 * frame.vertices, "vertices")
        demand(all(map(isfinite, frame.positions)), "a position is not finite")
        return frame

    def numbers_of(self, frame, held, base, neighbours, tokens, bits):
        planes = []
        for component in range(3):
            v = residuals(tokens, bits, self.near, component * self.vertices)
            d = restore(v, self.near, neighbours)[: self.vertices]
            if base == 1:
                d = [x + p for x, p in zip(d, held[0][1][component])]
            if base == 2:
                d = [x + 2 * p - o for x, p, o in zip(d, *(h[1][component] for h in held))]
            planes.append([signed(k) for k in d])
        tokens.demand_end()
        demand(bits.left < 8 and bits.value == 0, "raw bits are left over")
        return planes

    def unpack(self, frame):
        payload, size = frame.sections[7, 0], 44 if frame.key else 20
        demand(frame.vertices == self.vertices and len(payload) >= size, "it does not fit")
        base, neighbours, zero, before, raw, a, b = struct.unpack_from("<BBHIIII", payload)
        demand(base <= 2 and neighbours <= 3 and zero == 0, "the prediction is unknown")
        demand(not (frame.key and base), "a key frame builds on no other")
        origin = struct.unpack_from("<3d", payload, 20) if frame.key else self.origin
        held = [] if frame.key else self.held
        demand(frame.key or held and held[0][0] == frame.reference, "a frame is missing")
        demand(frame.key or frame.step == self.step, "another step")
        named = base != 2 and before == 0 or base == 2 and len(held) > 1 and held[1][0] == before
        demand(named and all(map(isfinite, origin)) and raw <= len(payload) - size, "out of range")
        tokens = Tokens(payload[size : len(payload) - raw])
        bits = Bits(payload[len(payload) - raw :])
        planes = self.numbers_of(frame, held, base, neighbours, tokens, bits)
        flat = [k for plane in planes for k in plane]
        demand(all(abs(k) < 2**20 for k in flat), "a number is out of range")
        sums = sum(flat) % WORD, sum((n + 1) * k for n, k in enumerate(flat)) % WORD
        demand(sums == (a, b), "the sums do not match")
        values = [0.0] * (3 * self.vertices)
        for component, plane in enumerate(planes):
            for vertex, k in zip(self.order, plane):
                values[3 * vertex + component] = origin[component] + k * frame.step
        frame.positions = array("f", values)
        demand(all(map(isfinite, frame.positions)), "a position is not finite")
        self.held = [(frame.sequence, planes)] + held[:1]
        self.origin, self.step = origin, frame.step
