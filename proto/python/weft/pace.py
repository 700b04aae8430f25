"""How fast messages and attempts to connect may follow each other."""

USUAL_RATE = 1000  # messages a second, if `welcome` names no limit
RATE_PART, BURST_SECONDS = 0.95, 0.25  # of the limit, sustained; a burst has the messages of this time
FIRST_PAUSE, LONGEST_PAUSE = 0.25, 8.0  # before a new attempt to connect [s]


def pause_before(attempt: int, jitter: float) -> float:
    """Seconds to wait before an attempt to connect again; the first is 0. `jitter` is from 0 to 1."""
    return min(LONGEST_PAUSE, FIRST_PAUSE * 2 ** min(attempt, 16)) * (0.5 + 0.5 * jitter)


class Pace:
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
