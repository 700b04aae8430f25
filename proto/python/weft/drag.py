"""Hands that hold the cloth."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from .errors import CommandError, ConnectionLost
from .fields import without_none
from .results import DragResult
from .timeouts import CLIENTS

if TYPE_CHECKING:
    from .announcement import Grabs
    from .client import Client

REPEAT_SECONDS = 0.4  # a hand at rest repeats its target; the lease asks for 0.5


class Drag:
    """A hand that pulls the cloth towards a target. It repeats the target while it holds, and ends when the server
    lets go: at a `reset`, where a policy or an operator forbids it, or because its lease has ended."""

    def __init__(self, client: Client, number: int, start: dict[str, Any], timeout: float | None = CLIENTS):
        self._client, self._start, self._target = client, start, start.get("target")
        self._timeout = timeout
        self._repeater: asyncio.Task[None] | None = None
        self._listening: list[Callable[[], None]] = []  # each ends a listener
        self._connection = client._connections
        self.number = number
        self.grab: int | None = None  # the room's number, once it holds

    @property
    def target(self) -> tuple[float, ...] | None:
        """Where it pulls to [m]; None before it holds, if none was given."""
        return None if self._target is None else tuple(self._target)

    @property
    def active(self) -> bool:
        """Whether it holds, as far as the server has told."""
        return self._repeater is not None and not self._is_lost()

    async def start(self) -> Drag:
        """Takes hold."""
        self._connection = self._client._connections
        fields = {"phase": "start", "drag": self.number, **self._start}
        result = await self._client.request("drag", timeout=self._timeout, **fields)
        self.grab = result["grab"]
        if self._target is None:
            self._target = result.get("target")
        self._repeater = asyncio.create_task(self._repeat())
        self._client._keep(self._repeater)
        self._listening = [
            self._client.on("grabs", self._hear_grabs),
            self._client.on("refused", self._hear_refusal),
        ]
        return self

    async def move(self, target: Iterable[float]) -> DragResult:
        """Pulls towards another point [m]; returns when the command has its place in a tick."""
        self._target = list(target)
        if self._is_lost():
            raise ConnectionLost(1006, "the hand was lost with its connection")
        fields = {"phase": "move", "drag": self.number, "target": self._target}
        return await self._client.request("drag", timeout=self._timeout, **fields)

    async def end(self, *, fire: bool | None = None) -> DragResult | None:
        """Lets go; a sling then gives its impulse, unless fire is False."""
        active = self.active
        self._finish()
        if not active:
            return None
        fields = {"phase": "end", "drag": self.number, **without_none({"fire": fire})}
        return await self._client.request("drag", timeout=self._timeout, **fields)

    def _is_lost(self) -> bool:
        return self._connection != self._client._connections

    def _finish(self) -> None:
        """Ends it here, without a word to the server."""
        for end in self._listening:
            end()
        self._listening = []
        if self._repeater is not None:
            self._repeater.cancel()
        self._repeater = None

    def _hear_grabs(self, message: Grabs) -> None:
        if all(grab["id"] != self.grab for grab in message["grabs"]):
            self._finish()

    def _hear_refusal(self, error: CommandError) -> None:
        """Of a target that it has repeated, where the server let go before it could hear of that."""
        if error.command == "drag" and (error.code == "not_allowed" or self._is_unknown(error)):
            self._finish()

    def _is_unknown(self, error: CommandError) -> bool:
        return error.code == "unknown_drag" and error.value == self.number

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

    async def __aexit__(self, *error: object) -> None:
        try:
            await self.end()
        except ConnectionLost:
            pass
        except CommandError as refusal:  # the server let go, and this end crossed what tells it
            if refusal.code not in ("unknown_drag", "not_allowed"):
                raise
