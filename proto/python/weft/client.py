"""The client: all commands, and waiting for frames."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Iterable, Mapping
from typing import Any, Literal, TypedDict, overload

from .drag import Drag
from .errors import ConnectionLost
from .fields import Hold, hold_fields, is_number, known, listed, without_none
from .queries import Queries
from .reading import demand
from .results import (
    AdvanceResult, HelloResult, LoadResult, MoveResult1, MoveResult2, PinResult, ReleaseResult, ViewResult,
)  # fmt: skip
from .samples import Frame, Hit
from .timeouts import ADVANCE_SECONDS, ADVANCE_TICK_SECONDS, CLIENTS


class Moved(TypedDict, total=False):
    """What `move` moves, as a dict: a collider by its name or its place in the list of the mesh, or a pin."""

    collider: str | int
    pin: int


class Observation(AdvanceResult):
    """The answer to an `advance` that observes."""

    observation: Frame  # of its last tick


class Client(Queries):
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

    @property
    def sleeping(self) -> tuple[str, ...]:
        """Cloths that have come to rest and are not stepped, as the newest `state` names them. That message
        may come a little after the answer to a command; `query("state")` asks for it."""
        return tuple(self.state["sleeping"]["cloths"]) if self.state else ()

    @property
    def all_asleep(self) -> bool:
        """Whether all cloths sleep; no frame comes then until something wakes one or an object moves."""
        return bool(self.sleeping) and self.mesh is not None and len(self.sleeping) == len(self.mesh["cloths"])

    async def until_asleep(self, *, timeout: float | None = None) -> None:
        """Waits until all cloths sleep, in a running room whose scene lets them (`sleep.after`)."""
        await self._in_time("until_asleep", timeout, self._until(lambda: self.all_asleep))

    # --- commands (section 5 of the specification) ---

    async def hello(
        self, *, name: str | None = None, color: str | None = None, timeout: float | None = CLIENTS
    ) -> HelloResult:
        """Name and colour ("#rrggbb") of this viewer."""
        fields = without_none({"name": name, "color": color})
        answer = await self.request("hello", timeout=timeout, **fields)
        self._hello.update(fields)  # once accepted: what is refused now would be after each reconnection
        return answer

    async def pick(
        self, origin: Iterable[float], direction: Iterable[float], *, timeout: float | None = CLIENTS
    ) -> Hit | None:
        """The point where a ray meets the cloth."""
        ray = {"origin": listed(origin), "direction": listed(direction)}
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
        self, hold: Hold, *, target: Iterable[float] | None = None, radius: float | None = None,
        stiffness: float | None = None, max_force: float | None = None,
        mode: Literal["live", "sling"] | None = None, timeout: float | None = CLIENTS,
    ) -> Drag:  # fmt: skip
        """A hand; it takes hold with `async with` or `await start()`.

        `hold` is a Hit, a particle's number, or a dict with `particle` or `triangle` and
        `barycentric`. With mode="sling" the cloth is left alone until the hand lets go. `timeout` is
        for each of its commands.
        """
        number, self._next_drag = self._next_drag, self._next_drag + 1
        fields: dict[str, Any] = {"radius": radius, "stiffness": stiffness, "max_force": max_force, "mode": mode}
        fields["target"] = None if target is None else list(target)
        return Drag(self, number, {**hold_fields(hold), **without_none(fields)}, timeout)

    async def pin(
        self, hold: Hold, *, radius: float | None = None, timeout: float | None = CLIENTS
    ) -> PinResult:
        """Fixes a disc of the fabric of some radius [m] where it is now."""
        fields = {**hold_fields(hold), **without_none({"radius": radius})}
        return await self.request("pin", timeout=timeout, **fields)

    async def release(
        self, *, pin: int | None = None, particle: int | None = None, all: Literal[True] | None = None,
        timeout: float | None = CLIENTS,
    ) -> ReleaseResult:  # fmt: skip
        """Removes one pin, those of a particle, or all."""
        fields = {"pin": pin, "particle": particle, "all": all}
        return await self.request("release", timeout=timeout, **without_none(fields))

    async def move(
        self, what: str | int | Mapping[str, int], position: Iterable[float] | None = None,
        rotation: Iterable[float] | None = None, *, speed: float | None = None, turn_speed: float | None = None,
        force: bool | None = None, release: Literal[True] | None = None, seconds: float | None = None,
        max_force: float | None = None, stop: Literal[True] | None = None, timeout: float | None = CLIENTS,
    ) -> MoveResult1 | MoveResult2:  # fmt: skip
        """Sends a collider, by its name or as {"collider": its place in the list of the mesh message}, to a
        pose at bounded speed, or back to its keyframes (release=True);
        or a pin, by its id, to a position, at bounded speed or within some seconds, or fixes it where it is
        on its way (stop=True)."""
        if isinstance(what, Mapping):
            fields: dict[str, Any] = dict(known(Moved, "what is moved", what))
        else:
            fields = {"pin" if is_number(what) else "collider": what}
        fields |= {"position": listed(position), "rotation": listed(rotation)}
        fields |= {"speed": speed, "turn_speed": turn_speed, "force": force, "release": release}
        fields |= {"seconds": seconds, "max_force": max_force, "stop": stop}
        return await self.request("move", timeout=timeout, **without_none(fields))

    @overload
    async def advance(
        self, n: int, *, frames: Literal["none", "last", "all"] | None = "last", observe: None = None,
        timeout: float | None = CLIENTS,
    ) -> AdvanceResult: ...  # fmt: skip
    @overload
    async def advance(
        self, n: int, *, frames: Literal["none", "last", "all"] | None = "last", observe: Iterable[str],
        timeout: float | None = CLIENTS,
    ) -> Observation: ...  # fmt: skip
    async def advance(
        self, n: int, *, frames: str | None = "last", observe: Iterable[str] | None = None,
        timeout: float | None = CLIENTS,
    ) -> Any:  # fmt: skip
        """Runs n ticks as fast as possible; the room must be paused. Result: tick and hash.

        `frames` says which of its frames this viewer gets, regardless of its `hz`: "last", "all" or "none".
        They arrive before the result, so that with the first two `frame` is then the last tick's. With None
        they are those that its `hz` allows, and that of the last tick may come after the result. `observe`
        lists what else to tell of the last tick ("velocities", "contacts", "reactions", "grippers"):
        `observation` of the result is its frame with them.
        """
        if timeout is CLIENTS:
            ticks = n if is_number(n) or isinstance(n, float) else 0  # the server refuses other types
            timeout = ADVANCE_SECONDS + ADVANCE_TICK_SECONDS * ticks
        if isinstance(observe, str):
            raise TypeError(f"observe is a list of words, as [{observe!r}]")
        if observe is None:
            return await self.request("advance", timeout=timeout, n=n, **without_none({"frames": frames}))
        # What is observed is the last frame, and forces are then measured in no other tick.
        fields = without_none({"frames": None if frames == "last" else frames, "observe": list(observe)})
        frames_told: list[Frame] = []
        end = self.on("frame", frames_told.append)
        try:
            result = await self.request("advance", timeout=timeout, n=n, **fields)
        finally:
            end()
        observed = [frame for frame in frames_told if frame.observed and frame.tick == result["tick"]]
        demand(len(observed) > 0, "what was observed did not come before the answer")
        return {**result, "observation": observed[-1]}

    async def hash(self, *, timeout: float | None = CLIENTS) -> str:
        """Hash of all that decides the future of the scene."""
        return (await self.request("hash", timeout=timeout))["hash"]

    async def load(
        self, scene: str | Mapping[str, Any], *, timeout: float | None = CLIENTS
    ) -> LoadResult:
        """Replaces the scene, by its name or by a whole scene as a dict."""
        return await self.request("load", timeout=timeout, scene=scene)

    async def view(
        self, *, hz: float | None = None, codec: Literal["f32", "packed"] | None = None, error: float | None = None,
        forces: bool | None = None, timeout: float | None = CLIENTS,
    ) -> ViewResult:  # fmt: skip
        """What frames are sent. With codec="packed" they take about a byte a vertex, off by at most `error` [m]
        (1e-4), and some time to decode in Python."""
        fields = without_none({"hz": hz, "codec": codec, "error": error, "forces": forces})
        answer = await self.request("view", timeout=timeout, **fields)
        self._view.update(fields)  # once accepted
        return answer

    async def ping(self, *, timeout: float | None = CLIENTS) -> tuple[float, float]:
        """Round trip, and the server's clock minus this client's [s]."""
        now = asyncio.get_running_loop().time
        sent = now()
        answer = await self.request("ping", timeout=timeout, t=sent)
        back = now()
        round_trip = back - sent - (answer["sent"] - answer["received"])
        return round_trip, (answer["received"] - sent + answer["sent"] - back) / 2

    # --- frames ---

    async def next_frame(self, *, timeout: float | None = CLIENTS) -> Frame:
        """The next frame; none is sent while nothing changes: all cloths sleep, or the room is paused."""
        before = self.frame
        return await self._in_time("next_frame", timeout, self._frame_where(lambda frame: frame is not before))

    async def frame_at(self, tick: int, *, timeout: float | None = CLIENTS) -> Frame:
        """The first frame from now on whose tick is at least this one."""
        return await self._in_time("frame_at", timeout, self._frame_where(lambda frame: frame.tick >= tick))

    async def frames(self) -> AsyncIterator[Frame]:
        """Newest frames as long as the connection lasts; a slow loop misses some."""
        last = self.frame
        while True:
            try:
                last = await self._frame_where(lambda frame, before=last: frame is not before)
            except ConnectionLost:
                return
            yield last
