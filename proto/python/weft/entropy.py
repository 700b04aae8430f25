"""The residuals of a packed frame (section 10 of the specification)."""

from __future__ import annotations

import bisect
import struct

from .errors import ProtocolError
from .reading import demand

_STATES = struct.Struct("<II")
_CONTEXT_BOUNDS = (0, 1, 2, 4, 8, 16, 40, 100, 250)
_CONTEXT_OF = tuple(bisect.bisect_left(_CONTEXT_BOUNDS, around) for around in range(252))
_STATE_LOW = 2**23
_PADDING = bytes(256)  # what a few values may read beyond the end


class Tokens:
    """Reads the residuals of a packed frame: tables, rANS with two states, raw bits."""

    def __init__(self, data: bytes, raw_length: int):
        demand(raw_length <= len(data), "the raw bits are cut off")
        self._end = len(data) - raw_length
        self._data, self._at = data[: self._end], 0
        self._tables = [self._read_table() for _ in range(len(_CONTEXT_BOUNDS) + 1)]
        demand(self._at + _STATES.size <= self._end, "the states are cut off")
        self._now, self._next = _STATES.unpack_from(data, self._at)
        fit = all(_STATE_LOW <= state < 2**31 for state in (self._now, self._next))
        demand(fit, "a state is out of range")
        self._at += _STATES.size
        self._data += _PADDING
        self._raw, self._raw_left = int.from_bytes(data[self._end :], "little"), 8 * raw_length

    def _byte(self) -> int:
        demand(self._at < self._end, "a table is cut off")
        self._at += 1
        return self._data[self._at - 1]

    def _read_table(self) -> tuple[list[int], list[int], list[int]]:
        """The token of each slot; the frequency of each token, and that of those below it added up."""
        count, slots, frequencies, below = self._byte(), [], [], []
        demand(count <= 58, "too many tokens")
        for token in range(count):
            frequency = self._byte()
            if frequency >= 128:
                frequency = (frequency & 127) | self._byte() << 7
            demand(len(slots) + frequency <= 4096, "frequencies are too large")
            frequencies.append(frequency)
            below.append(len(slots))
            slots += [token] * frequency
        demand(len(slots) == (4096 if count else 0), "frequencies do not add up")
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
        demand(self._raw_left >= 0, "the raw bits are cut off")
        return (2 + (token & 1) << bits) | low

    def demand_end(self) -> None:
        ended = self._now == self._next == _STATE_LOW and self._at == self._end
        demand(ended and self._raw_left < 8 and self._raw == 0, "bytes are left over")
