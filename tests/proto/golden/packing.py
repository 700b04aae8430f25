"""An encoder of the codec `packed`, slow and plain, as proto/README.md section 10 says."""

import struct

WORD = 2**32
STATE_LOW = 2**23
MOST_TOKENS = 58
MISSING = 2**32 - 1


def grid_order(rows, columns, first=0):
    """Vertex and neighbours of each place of a grid; None: missing."""
    order = []
    for i in range(rows * columns):
        left, above = i % columns > 0, i >= columns
        a = i - 1 if left else i - columns if above else None
        b, c = (i - columns, i - columns - 1) if left and above else (None, None)
        order.append([first + i] + [None if x is None else first + x for x in (a, b, c)])
    return order


def order_bytes(order):
    words = [MISSING if word is None else word for entry in order for word in entry]
    return struct.pack(f"<{len(words)}I", *words)


def signed(word):
    return word - WORD if word >= WORD // 2 else word


def differences(base, now, last, before):
    if base == 0:
        return [k % WORD for k in now]
    if base == 1:
        return [(k - k1) % WORD for k, k1 in zip(now, last)]
    return [(k - 2 * k1 + k2) % WORD for k, k1, k2 in zip(now, last, before)]


def prediction(neighbours, d, a, b, c):
    value = [0 if place is None else d[place] for place in (a, b, c)]
    if neighbours == 0 or a is None:
        return 0
    if neighbours == 2:
        return value[0] + value[1] - value[2]
    if b is None:
        return value[0]
    if neighbours == 1:
        return signed((value[0] + value[1]) % WORD) >> 1
    return signed((3 * (value[0] + value[1]) - 2 * value[2] + 2) % WORD) >> 2


def zigzag(r):
    r = signed(r % WORD)
    return ((r << 1) ^ (r >> 31)) % WORD


def token_of(v):
    """Token, raw bits and how many they are."""
    if v < 16:
        return v, 0, 0
    e = v.bit_length() - 1
    return 16 + 2 * (e - 4) + (v >> (e - 1) & 1), v % (1 << (e - 1)), e - 1


def context_of(around):
    most = (0, 1, 2, 4, 8, 16, 40, 100, 250)
    return next((i for i, bound in enumerate(most) if around <= bound), 9)


def normalised(counts):
    """Frequencies that add up to 4096; at least 1 for what occurs."""
    total = sum(counts)
    f = [max(1, 4096 * count // total) if count else 0 for count in counts]
    rest = 4096 - sum(f)
    largest = f.index(max(f))
    if f[largest] + rest >= 1:
        f[largest] += rest
        return f
    t = 0
    while sum(f) > 4096:
        if f[t] > 1:
            f[t] -= 1
        t = (t + 1) % len(f)
    return f


def table_bytes(f):
    m = max((t + 1 for t, frequency in enumerate(f) if frequency), default=0)
    out = bytes([m])
    for frequency in f[:m]:
        out += bytes([frequency]) if frequency < 128 else bytes(
            [frequency & 127 | 128, frequency >> 7]
        )
    return out


def code(symbols, tables):
    """States and coded bytes; `symbols` are pairs of context and token."""
    states, out = [STATE_LOW, STATE_LOW], bytearray()
    for j in range(len(symbols) - 1, -1, -1):
        context, token = symbols[j]
        f, start = tables[context][token], sum(tables[context][:token])
        x = states[j % 2]
        while x >= f * 2**19:
            out.append(x & 255)
            x >>= 8
        states[j % 2] = x // f * 4096 + x % f + start
    return struct.pack("<II", *states) + bytes(reversed(out))


def residuals(order, base, neighbours, now, last, before):
    """Zigzag residuals of the three components."""
    planes = []
    for component in range(3):
        d = differences(
            base, now[component], last and last[component], before and before[component]
        )
        planes.append(
            [zigzag(d[i] - prediction(neighbours, d, *near)) for i, (_, *near) in enumerate(order)]
        )
    return planes


def payload(order, base, neighbours, now, last=None, before=None, before_sequence=0, origin=None):
    """Section 7. `now`, `last`, `before`: three lists of k in coding order."""
    symbols, bits, bit_count = [], 0, 0
    for v in residuals(order, base, neighbours, now, last, before):
        for i, (_, a, b, _) in enumerate(order):
            around = sum(0 if place is None else v[place] for place in (a, b))
            token, low, count = token_of(v[i])
            symbols.append((context_of(around), token))
            bits |= low << bit_count
            bit_count += count
    counts = [[0] * MOST_TOKENS for _ in range(10)]
    for context, token in symbols:
        counts[context][token] += 1
    tables = [normalised(c) if sum(c) else c for c in counts]
    raw = bits.to_bytes((bit_count + 7) // 8, "little")
    flat = [k for plane in now for k in plane]
    sum_a = sum(flat) % WORD
    sum_b = sum((n + 1) * k for n, k in enumerate(flat)) % WORD
    named = before_sequence if base == 2 else 0
    out = struct.pack("<BBHIIII", base, neighbours, 0, named, len(raw), sum_a, sum_b)
    if origin is not None:
        out += struct.pack("<3d", *origin)
    return out + b"".join(map(table_bytes, tables)) + code(symbols, tables) + raw


def positions(order, now, origin, step):
    """Coordinates in float64, three for each vertex; float32 is made of them when they are written."""
    out = [0.0] * (3 * len(order))
    for i, (vertex, *_) in enumerate(order):
        for component in range(3):
            out[3 * vertex + component] = origin[component] + now[component][i] * step
    return out
