"""An event loop in a thread of its own, for callers that wait for each call."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Coroutine
from typing import Any, TypeVar

from .client import Client
from .errors import ConnectionLost

Result = TypeVar("Result")


class Runner:
    """A client whose coroutines run in another thread."""

    _client: Client

    def __init__(self) -> None:
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="weft", daemon=True)
        self._thread.start()

    def _start(self, joining: Coroutine[Any, Any, Client]) -> Client:
        """The client that joins; nothing stays if it cannot."""
        try:
            return self._run(joining)
        except BaseException:
            self._stop()
            raise

    def close(self) -> None:
        """Leaves the server."""
        if not self._loop.is_closed():
            self._run(self._client.close())
            self._stop()

    def _run(self, coroutine: Coroutine[Any, Any, Result]) -> Result:
        if threading.current_thread() is self._thread:
            coroutine.close()
            raise RuntimeError("a listener cannot call the client, whose answers come in its own thread; "
                               "let it put what it hears into a queue.Queue for another thread")
        if self._loop.is_closed():
            coroutine.close()
            raise ConnectionLost(1000, "this client was closed")
        future = asyncio.run_coroutine_threadsafe(coroutine, self._loop)
        try:
            return future.result()
        except BaseException:
            future.cancel()  # an interrupted caller no longer wants it
            raise

    def _stop(self) -> None:
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()
