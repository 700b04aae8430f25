"""One room with its actors: its start, its steps, and what it looks like. Environments of both forms run it."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping, Sequence
from typing import Any

import numpy as np

from ..client import Client
from ..samples import Frame
from .actors import NUMBERS, Actor
from .spaces import Box, Dict

START = "gym-start"  # the name of the state that `reset` goes back to
FARTHEST, FASTEST, STRONGEST = 1e4, 1e4, 1e6  # bounds of what is observed [m], [m/s], [N] and [N m]
GRIPPER_NUMBERS = 14  # position 3, rotation 4, opening, force 3, torque 3
OBSERVED = ("velocities", "grippers")

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
    """

    def __init__(self, client: Client, actors: Sequence[Actor], ticks: int):
        self.client, self.actors, self.ticks = client, list(actors), ticks
        self.frame: Frame | None = None  # the last that was observed
        self._scene: str | Mapping[str, Any] | None = None
        self._prepare: Preparation | None = None

    async def set_up(self, scene: str | Mapping[str, Any] | None, prepare: Preparation | None) -> None:
        """Brings the room to the start of an episode, and keeps that."""
        self._scene, self._prepare = scene, prepare
        await self.client.pause()
        await self.client.view(hz=0)  # frames come with observations alone
        await self._prepare_anew()
        if self._saves:
            await self.client.save(START)

    @property
    def _saves(self) -> bool:
        return self.client.welcome is not None and "rooms" in self.client.welcome["capabilities"]

    async def _prepare_anew(self) -> None:
        if self._scene is not None:
            await self.client.load(self._scene)
        if self._prepare is not None:
            await self._prepare(self.client)

    async def begin(self, settings: Mapping[str, Any]) -> dict[str, Any]:
        """Back to the start, with some settings of `set`; one tick passes, of which is told."""
        for actor in self.actors:
            await actor.end()
        if self._saves:
            await self.client.restore(START)
        else:
            await self._prepare_anew()
        if settings:
            await self.client.set(**settings)
        for actor in self.actors:
            await actor.begin(self.client)
        return await self._advance(1)

    async def step(self, action: Any) -> dict[str, Any]:
        """What is observed after the ticks of a step with this action."""
        for k, actor in enumerate(self.actors):
            await actor.act(self.client, np.asarray(action[NUMBERS * k : NUMBERS * (k + 1)], np.float64))
        return await self._advance(self.ticks)

    async def _advance(self, ticks: int) -> dict[str, Any]:
        result = await self.client.advance(ticks, observe=OBSERVED)
        self.frame = result["observation"]
        return observed(self.frame)
