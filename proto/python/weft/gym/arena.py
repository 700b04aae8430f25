"""One room with its actors: its start, its steps, and what it looks like. Environments of both forms run it."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping, Sequence
from typing import Any

import numpy as np

from ..client import Client, Observation
from ..errors import CommandError, WeftError
from ..samples import Frame
from .actors import Actor
from .checks import NUMBERS
from .spaces import Box, Dict

START = "gym-start"  # the name of the state that `reset` goes back to
FARTHEST, FASTEST, STRONGEST = 1e4, 1e4, 1e6  # bounds of what is observed [m], [m/s], [N] and [N m]
GRIPPER_NUMBERS = 14  # position 3, rotation 4, opening, force 3, torque 3
OBSERVED = ("velocities", "grippers")
MOST_TICKS = 100_000  # of one `advance`
# What the server says where another viewer set the room going, or stopped it; it is paused then and goes on. A few
# times, lest two programs that want it otherwise go on for ever.
MEDDLED, TIMES = ("not_paused", "interrupted"), 5

Preparation = Callable[[Client], Awaitable[None]]


def action_space(actors: Sequence[Actor]) -> Any:
    """Four numbers for each actor."""
    return Box(-1.0, 1.0, (NUMBERS * len(actors),), np.float32)


def observation_space(vertices: int, grippers: int) -> Any:
    """Of the cloth, and of all grippers in the order of the scene."""
    return Dict({
        "positions": Box(-FARTHEST, FARTHEST, (vertices, 3), np.float32),
        "velocities": Box(-FASTEST, FASTEST, (vertices, 3), np.float32),
        "grippers": Box(-STRONGEST, STRONGEST, (grippers, GRIPPER_NUMBERS), np.float32),
    })


def observed(frame: Frame) -> dict[str, Any]:
    """What an environment tells of a frame. Positions and velocities share the memory of its message."""
    rows = [(*g.position, *g.rotation, g.opening, *g.reaction, *g.torque) for g in frame.grippers]
    return {
        "positions": frame.positions,
        "velocities": frame.velocities,
        "grippers": np.array(rows, np.float32).reshape(len(rows), GRIPPER_NUMBERS),
    }


class Arena:
    """A paused room that is this environment's alone.

    `ticks` pass a step. `prepare` brings the room from the scene's start to that of an episode, once: it is saved in
    the server's memory and each `begin` goes back to it. A server that cannot save loads and prepares it each time.

    Other viewers may look on. Where one sets the room going it is paused again, and where one loads another scene,
    `begin` loads that of the environment.
    """

    def __init__(
        self, client: Client, actors: Sequence[Actor], ticks: int, scene: str | Mapping[str, Any],
        prepare: Preparation | None,
    ):  # fmt: skip
        self.client, self.actors, self.ticks = client, list(actors), ticks
        self.frame: Frame | None = None  # the last that was observed
        self._scene, self._prepare = scene, prepare
        self._epoch = 0  # of the mesh of its scene
        self._refused: list[CommandError] = []  # of commands whose answers are not awaited
        client.on("refused", self._refused.append)

    async def set_up(self, *, forked: bool = False) -> None:
        """Brings the room to the start of an episode, where it is already if it is `forked` from one; keeps that."""
        await self.client.view(hz=0)  # frames come with observations alone
        await self._paused(self._keep if forked else self._make)

    async def _paused(self, doing: Callable[[], Awaitable[Any]]) -> Any:
        """Its result in the paused room; done anew where another viewer meddles."""
        for left in reversed(range(TIMES)):
            await self.client.pause()
            try:
                return await doing()
            except CommandError as refusal:
                if refusal.code not in MEDDLED or not left:
                    raise

    async def _make(self) -> None:
        await self.client.load(self._scene)
        if self._prepare is not None:
            await self._prepare(self.client)
        await self._keep()

    async def _keep(self) -> None:
        self._epoch = self.client.mesh["epoch"]
        if self._saves:
            await self.client.save(START)

    @property
    def _saves(self) -> bool:
        return self.client.welcome is not None and "rooms" in self.client.welcome["capabilities"]

    @property
    def _is_own(self) -> bool:
        """Whether the room has the scene that was made here. Loading another one forgets what was saved."""
        return self.client.mesh["epoch"] == self._epoch

    async def begin(self, settings: Mapping[str, Any]) -> dict[str, Any]:
        """Back to the start, with some settings of `set`; one tick passes, of which is told."""
        for actor in self.actors:
            await actor.end()
        return await self._paused(lambda: self._begin(settings))

    async def _begin(self, settings: Mapping[str, Any]) -> dict[str, Any]:
        self._refused.clear()
        if self._saves and self._is_own:
            await self.client.restore(START)
        else:
            await self._make()
        if settings:
            await self.client.set(**settings)
        for actor in self.actors:
            await actor.begin(self.client)
        return self._observed(await self.client.advance(1, observe=OBSERVED))

    async def step(self, action: Any) -> dict[str, Any]:
        """What is observed after the ticks of a step with this action, which was checked."""
        self._demand_own()
        self._refused.clear()
        for k, actor in enumerate(self.actors):
            await actor.act(self.client, action[NUMBERS * k : NUMBERS * (k + 1)])
        return self._observed(await self._advance())

    async def _advance(self) -> Observation:
        """The ticks of a step, after those that passed while another viewer let the room run."""
        ticks, begin = self.ticks, self.frame.tick if self.frame else 0
        for left in reversed(range(TIMES)):
            try:
                return await self.client.advance(ticks, observe=OBSERVED)
            except CommandError as refusal:
                if refusal.code not in MEDDLED or not left:
                    raise
                now = (await self.client.pause())["tick"]
                if refusal.code == "interrupted" and 0 <= now - begin <= ticks:
                    ticks = max(1, ticks - (now - begin))  # those that are still to come
                begin = now
        raise AssertionError("the last time returns or raises")

    def _observed(self, result: Observation) -> dict[str, Any]:
        self._demand_own()
        for refusal in self._refused:
            if refusal.command != "drag":  # a hand hears of its own, and repeats itself beside the steps
                raise refusal
        self.frame = result["observation"]
        return observed(self.frame)

    def _demand_own(self) -> None:
        if not self._is_own:
            raise WeftError("another viewer loaded a scene into this room; reset() loads that of the environment again")
