"""Golden streams of the codec `packed`: what a server sends of a mesh and its frames.

Each stream is a file of messages, one after another: a mesh, then each frame twice, packed and with
the same positions in codec 0. A decoder has to find the second in the first, bit for bit.
"""

import json
import random

import packing
from samples import APPLIED_NUMBERS, HANDS, applied_bytes, grab_bytes, grid
from sealing import floats, frame_body, integers, message, patched, round_float, section

FRAME, MESH = 1, 2
KEY = 1
POSITIONS, GRABS, APPLIED, PACKED = 1, 2, 3, 7
REST, TRIANGLES, UV, ORDER = 16, 17, 18, 21
FINE, COARSE = (round_float([step])[0] for step in (1.15e-5, 1.15e-4))
MOST = 2**20 - 1


class Stream:
    """A connection as its server sees it."""

    def __init__(self, order, rest, triangles, cloths, told):
        self.order, self.cloths = order, cloths
        sections = [
            section(REST, 0, floats(rest)),
            section(TRIANGLES, 0, integers(triangles)),
            section(UV, 0, floats([0.5] * (len(rest) // 3 * 2))),
        ]
        if told:
            sections.append(section(ORDER, 0, packing.order_bytes(order)))
        head = integers((len(rest) // 3, len(triangles) // 3, 0, len(sections)))
        self.messages = [message(MESH, head + b"".join(sections))]
        self.frames = []
        self.sequence, self.last, self.before = 4_000_000_000, None, None
        self.origin, self.step = (0.0, 0.0, 0.0), COARSE

    def key(self, now, neighbours=2, origin=(0.1, 1.25, -3.0), step=COARSE, **more):
        self.origin, self.step, self.last, self.before = origin, step, None, None
        self.add(now, 0, neighbours, **more)

    def add(self, now, base, neighbours, skip=1, extra=()):
        """A frame that builds on the last one, `skip` sequence numbers before it."""
        self.sequence += skip
        key = self.last is None
        header = dict(tick=self.sequence, time=0.5, server_time=2.25, sequence=self.sequence)
        header.update(reference=self.sequence if key else self.last[0], epoch=3)
        last, before = self.last or (0, None), self.before or (0, None)
        packed = packing.payload(
            self.order, base, neighbours, now, last[1], before[1], before[0],
            self.origin if key else None,
        )
        count = len(self.order)
        extra = list(extra)
        body = frame_body(header, count, [section(PACKED, 0, packed)] + extra, self.step)
        self.messages.append(message(FRAME, body, 2, KEY if key else 0))
        shown = floats(packing.positions(self.order, now, self.origin, self.step))
        header["reference"] = self.sequence
        body = frame_body(header, count, [section(POSITIONS, 0, shown)] + extra)
        self.messages.append(message(FRAME, body, 0, KEY))
        self.frames.append({"base": base, "neighbours": neighbours, "key": key})
        self.last, self.before = (self.sequence, now), self.last


def of_grid(rows, columns):
    count = rows * columns
    if rows > 1 and columns > 1:
        rest, triangles, _ = grid(rows, columns)
    else:
        rest, triangles = [0.25 * i for i in range(3 * count)], []
    cloth = dict(first_vertex=0, vertices=count, rows=rows, columns=columns)
    return Stream(packing.grid_order(rows, columns), rest, triangles, [cloth], False)


def waves(order, phase, bend=40, noise=0, seed=1):
    """Smooth numbers that move with the phase."""
    draw = random.Random(seed * 1000 + phase)
    planes = [[], [], []]
    for vertex, *_ in order:
        u, v = vertex % 64, vertex // 64
        for component, plane in enumerate(planes):
            t = phase + 7 * component
            smooth = bend * u * (v + t) // (component + 3) - (u - t) ** 2 + t * t * v // 5
            plane.append(smooth + (draw.randint(-noise, noise) if noise else 0))
    return planes


def still(order, value):
    return [[value] * len(order) for _ in range(3)]


def predictions():
    """Every base with every kind of neighbours, and frames that skip some."""
    stream = of_grid(10, 64)
    stream.key(waves(stream.order, 0), 0)
    stream.key(waves(stream.order, 1), 1)
    stream.key(waves(stream.order, 2), 2, extra=[section(GRABS, 0, grab_bytes(HANDS))])
    phase = 2
    for base in (1, 2, 0):
        for neighbours in (0, 1, 2, 3):
            phase += 1
            stream.add(waves(stream.order, phase, noise=2), base, neighbours)
    stream.add(waves(stream.order, 20), 1, 2, skip=8)
    extra = [section(APPLIED, 0, applied_bytes(APPLIED_NUMBERS)), section(900, 0, b"12345")]
    stream.add(waves(stream.order, 28), 2, 1, skip=8, extra=extra)
    stream.key(waves(stream.order, 29, bend=400), origin=(0.1, 1.2, -3.1), step=FINE)
    stream.add(waves(stream.order, 30, bend=400), 1, 2)
    return stream


def extremes():
    """The largest numbers and differences, and residuals of every length."""
    stream = of_grid(8, 16)
    order = stream.order
    ends = [[MOST if (i + c) % 2 else -MOST for i in range(len(order))] for c in range(3)]
    other = [[-k for k in plane] for plane in ends]
    stream.key(ends, 2)
    stream.add(other, 1, 2)
    stream.add(ends, 2, 2)
    stream.add(other, 2, 0)
    powers = [0] + [s * (2**e + o) for e in range(20) for o in (-1, 0, 1) for s in (1, -1)]
    lengths = [[powers[(i + 5 * c) % len(powers)] for i in range(len(order))] for c in range(3)]
    stream.key(lengths, 0, origin=(1e-3, 10.0, 2.0**-40))
    stream.add(still(order, 0), 1, 0)
    stream.add(still(order, 0), 1, 2)  # nothing is left: one token of frequency 4096
    stream.add(still(order, 5), 1, 2)
    draw = random.Random(3)
    stream.add([[draw.randint(-MOST, MOST) for _ in order] for _ in range(3)], 0, 0)
    crowd = [[draw.choice((0,) * 60 + tuple(powers)) for _ in order] for _ in range(3)]
    stream.add(crowd, 0, 0)
    return stream


def small(rows, columns):
    stream = of_grid(rows, columns)
    for phase in range(2):
        stream.key(waves(stream.order, phase), phase + 1)
    for base, neighbours in ((1, 0), (1, 1), (1, 2), (2, 0), (2, 1), (2, 2), (2, 3)):
        stream.add(waves(stream.order, base * 3 + neighbours, noise=1), base, neighbours)
    return stream


def two_meshes():
    """A sheet with diagonals both ways and mixed numbers, a lone vertex, and a grid beside it."""
    draw = random.Random(5)
    rows, columns, lone = 9, 11, 1
    count = rows * columns + lone
    names = list(range(count))
    draw.shuffle(names)
    rest, triangles = [0.0] * (3 * count), []
    for i in range(rows * columns):
        x, y = i % columns, i // columns
        rest[3 * names[i] : 3 * names[i] + 3] = [0.1 * x, 0.1 * y, 0.01 * (x * y % 3)]
        if x + 1 < columns and y + 1 < rows:
            a, b, c, d = (names[i + o] for o in (0, 1, columns, columns + 1))
            triangles += draw.choice(([a, c, b, b, c, d], [a, c, d, a, d, b]))
    sides = [set() for _ in range(count)]
    for a, b, c in zip(*[iter(triangles)] * 3):
        for p, q in ((a, b), (b, c), (c, a)):
            sides[p].add(q)
            sides[q].add(p)
    vertices = draw.sample(range(count), count)  # any order will do
    place, order = {}, []
    for vertex in vertices:
        near = sorted((place[n] for n in sides[vertex] if n in place), reverse=True)[:3]
        order.append([vertex] + near + [None] * (3 - len(near)))
        place[vertex] = len(place)
    beside, more, _ = grid(4, 5)
    rest += beside
    triangles += [count + i for i in more]
    order += packing.grid_order(4, 5, count)
    cloths = [
        dict(first_vertex=0, vertices=count, rows=0, columns=0),
        dict(first_vertex=count, vertices=20, rows=4, columns=5),
    ]
    stream = Stream(order, rest, triangles, cloths, True)
    stream.key(waves(order, 0))
    for base, neighbours in ((1, 0), (1, 1), (2, 2), (1, 3), (2, 1), (0, 3)):
        stream.add(waves(order, 1 + len(stream.frames), noise=1), base, neighbours)
    return stream


def streams():
    yield "packed_predictions", predictions()
    yield "packed_extremes", extremes()
    for rows, columns in ((1, 1), (1, 9), (9, 1), (2, 2)):
        yield f"packed_{rows}x{columns}", small(rows, columns)
    yield "packed_meshes", two_meshes()
    sheet = of_grid(64, 48)
    sheet.key(waves(sheet.order, 0))
    sheet.add(waves(sheet.order, 1, noise=1), 1, 1)
    yield "packed_64x48", sheet


# Where things are in a packed frame without sections before the packed positions.
STEP, KIND, PAYLOAD = 56, 64, 72


def refused(stream):
    """Frames that break one rule each, and the number of packed frames that come before them."""
    key, step, straight = (stream.messages[1 + 2 * i] for i in (1, 4, 6))
    yield "float64", 2, patched(key, 2, "B", 1)
    yield "codec 3", 2, patched(key, 2, "B", 3)
    yield "not key, reference its own", 2, patched(key, 3, "B", 0)
    yield "key with a reference", 4, patched(step, 3, "B", KEY)
    yield "reference not held", 4, patched(step, 44, "I", 7)
    yield "reference before the last", 5, step
    yield "before not held", 6, patched(straight, PAYLOAD + 4, "I", 7)
    yield "step 0", 2, patched(key, STEP, "f", 0.0)
    yield "step below 0", 2, patched(key, STEP, "f", -1e-4)
    yield "step NaN", 2, patched(key, STEP, "f", float("nan"))
    yield "another step", 4, patched(step, STEP, "f", FINE)
    yield "a step that leads beyond float32", 2, patched(key, STEP, "f", 3e38)
    yield "another number of vertices", 2, patched(key, 52, "I", 2)
    yield "float positions", 2, patched(key, KIND, "H", POSITIONS)
    yield "no positions", 2, patched(key, KIND, "H", 901)
    yield "base 3", 4, patched(step, PAYLOAD, "B", 3)
    yield "key with base 1", 2, patched(key, PAYLOAD, "B", 1)
    yield "neighbours 4", 2, patched(key, PAYLOAD + 1, "B", 4)
    yield "reserved", 2, patched(key, PAYLOAD + 2, "H", 1)
    yield "before without need", 4, patched(step, PAYLOAD + 4, "I", 1)
    yield "raw bits longer than all", 2, patched(key, PAYLOAD + 8, "I", 2**32 - 1)
    yield "a raw byte more", 2, patched(key, PAYLOAD + 8, "I", 1)
    yield "sum A", 2, patched(key, PAYLOAD + 12, "B", key[PAYLOAD + 12] ^ 1)
    yield "sum B", 2, patched(key, PAYLOAD + 19, "B", key[PAYLOAD + 19] ^ 128)
    yield "origin NaN", 2, patched(key, PAYLOAD + 20, "d", float("nan"))
    yield "too many tokens", 4, patched(step, PAYLOAD + 20, "B", 59)
    yield "a frequency changed", 4, patched(step, PAYLOAD + 21, "B", step[PAYLOAD + 21] ^ 1)
    yield "section of 19 bytes", 4, patched(step, KIND + 4, "I", 19)


def write(folder):
    told = {}
    for name, stream in streams():
        (folder / f"{name}.bin").write_bytes(b"".join(stream.messages))
        told[name] = {"cloths": stream.cloths, "frames": stream.frames}
    told["refused"] = [
        {"rule": rule, "after": after, "hex": frame.hex()}
        for rule, after, frame in refused(small(2, 2))
    ]
    text = json.dumps(told, indent=1, ensure_ascii=False) + "\n"
    (folder / "packed.json").write_text(text, encoding="utf-8")
