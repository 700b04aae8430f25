"""The client for scripts that wait for each call."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any, Literal

from .announcement import Grabs, Mesh, Pins, Roster, Welcome
from .blocking_commands import BlockingCommands
from .connecting import connect
from .drag import Drag
from .errors import ConnectionLost
from .fields import Hold
from .messages import State
from .results import DragResult
from .samples import Frame, MeshData
from .timeouts import CALL_SECONDS, CLIENTS


class SyncDrag:
    """A hand, blocking. Use it with `with`, or call `start` and `end`."""

    def __init__(self, owner: SyncClient, drag: Drag):
        self._owner, self._drag = owner, drag

    @property
    def grab(self) -> int | None:
        """The room's number of it, once it holds."""
        return self._drag.grab

    @property
    def active(self) -> bool:
        """Whether it holds, as far as the server has told."""
        return self._drag.active

    @property
    def target(self) -> tuple[float, ...] | None:
        """Where it pulls to [m]; None before it holds, if none was given."""
        return self._drag.target

    def start(self) -> SyncDrag:
        """Takes hold."""
        self._owner._run(self._drag.start())
        return self

    def move(self, target: Iterable[float]) -> DragResult:
        """Pulls towards another point [m]; returns when the command has its place in a tick."""
        return self._owner._run(self._drag.move(target))

    def end(self, *, fire: bool | None = None) -> DragResult | None:
        """Lets go; a sling then gives its impulse, unless fire is False."""
        return self._owner._run(self._drag.end(fire=fire))

    def __enter__(self) -> SyncDrag:
        return self.start()

    def __exit__(self, *error: object) -> None:
        if not self._owner._loop.is_closed():
            self._owner._run(self._drag.__aexit__(*error))


class SyncClient(BlockingCommands):
    """A client whose commands block; its event loop runs in a thread of its own.

    It has the commands and properties of `Client`. Listeners are called in that thread.
    """

    def __init__(
        self, url: str, *, name: str | None = None, color: str | None = None, token: str | None = None,
        timeout: float = 10, reconnect: bool = False, call_timeout: float | None = CALL_SECONDS,
    ):  # fmt: skip
        joining = connect(
            url, name=name, color=color, token=token, timeout=timeout, reconnect=reconnect, call_timeout=call_timeout
        )
        super().__init__()
        self._client = self._start(joining._connect())

    def __enter__(self) -> SyncClient:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def drag(
        self, hold: Hold, *, target: Iterable[float] | None = None, radius: float | None = None,
        stiffness: float | None = None, max_force: float | None = None,
        mode: Literal["live", "sling"] | None = None, timeout: float | None = CLIENTS,
    ) -> SyncDrag:  # fmt: skip
        """A hand; it takes hold with `with` or `start()`. The arguments are those of `Client.drag`."""
        drag = self._client.drag(
            hold, target=target, radius=radius, stiffness=stiffness, max_force=max_force, mode=mode, timeout=timeout
        )
        return SyncDrag(self, drag)

    def frames(self) -> Iterator[Frame]:
        """Newest frames as long as the connection lasts; a slow loop misses some."""
        while True:
            try:
                yield self.next_frame(timeout=None)
            except ConnectionLost:
                return

    def on(self, name: str, listener: Callable[[Any], None]) -> Callable[[], None]:
        """Calls `listener` with each message of this name, in the client's thread: there the client's own calls,
        which would wait for answers that only this thread can read, raise RuntimeError."""
        return self._client.on(name, listener)

    # --- what the server has told, each None before the first ---

    @property
    def welcome(self) -> Welcome | None:
        return self._client.welcome

    @property
    def mesh(self) -> Mesh:
        """The text message."""
        return self._client.mesh

    @property
    def mesh_data(self) -> MeshData:
        return self._client.mesh_data

    @property
    def frame(self) -> Frame | None:
        """The newest."""
        return self._client.frame

    @property
    def state(self) -> State | None:
        return self._client.state

    @property
    def roster(self) -> Roster | None:
        return self._client.roster

    @property
    def pins(self) -> Pins | None:
        return self._client.pins

    @property
    def grabs(self) -> Grabs | None:
        return self._client.grabs

    @property
    def viewer(self) -> int:
        """Own number among the viewers; 0 before `welcome`."""
        return self._client.viewer

    @property
    def sleeping(self) -> tuple[str, ...]:
        """Cloths that have come to rest, as the newest `state` names them."""
        return self._client.sleeping

    @property
    def all_asleep(self) -> bool:
        """Whether all cloths sleep."""
        return self._client.all_asleep

    @property
    def call_timeout(self) -> float | None:
        """For an answer or a frame [s]; None: no bound."""
        return self._client.call_timeout

    @call_timeout.setter
    def call_timeout(self, seconds: float | None) -> None:
        self._client.call_timeout = seconds


def open(
    url: str, *, name: str | None = None, color: str | None = None, token: str | None = None, timeout: float = 10,
    reconnect: bool = False, call_timeout: float | None = CALL_SECONDS,
) -> SyncClient:  # fmt: skip
    """Joins a server, blocking; use it with `with`. The arguments are those of `connect`."""
    return SyncClient(
        url, name=name, color=color, token=token, timeout=timeout, reconnect=reconnect, call_timeout=call_timeout
    )
