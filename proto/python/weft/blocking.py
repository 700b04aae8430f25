"""The client for scripts that wait for each call."""

from __future__ import annotations

import asyncio
import functools
import threading
from collections.abc import Callable, Iterable
from typing import Any

from .client import Client
from .connecting import connect
from .drag import Drag
from .timeouts import CALL_SECONDS


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
