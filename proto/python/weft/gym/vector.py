"""Many cloths in one server, a room each, stepped in lock-step."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Mapping, Sequence
from typing import Any
from urllib.parse import urlsplit

import numpy as np

from ..address import socket_address, token_of
from ..client import Client
from ..connecting import connect
from ..runner import Runner
from .actors import Actor, Gripper
from .arena import Arena, Preparation, action_space, observation_space
from .env import Randomise, Reward, lifted
from .spaces import Box, Dict, VectorEnv, gymnasium

Observations = dict[str, Any]


class VectorClothEnv(VectorEnv):
    """`num_envs` environments as `ClothEnv` is one. The first room is set up, and the others are forks of it, so that
    all begin with the same bits. Each step all rooms run their ticks at once; the answer comes when all are done.

    An environment whose episode ended begins anew in the next step, whose action it ignores (Gymnasium's
    `NEXT_STEP`). `close` closes the rooms.
    """

    metadata: dict[str, Any] = {"render_modes": [], "autoreset_mode": "NextStep"}

    def __init__(
        self, url: str, num_envs: int, *, scene: str | Mapping[str, Any] = "gripper",
        actors: Callable[[], Sequence[Actor]] = lambda: [Gripper()], ticks: int = 6, limit: int = 100,
        reward: Reward = lifted, finished: Callable[[Mapping[str, Any]], bool] | None = None,
        randomise: Randomise | None = None, prepare: Preparation | None = None, rooms: str = "gym",
    ):  # fmt: skip
        self.num_envs, self.limit = num_envs, limit
        self._url, self._reward, self._finished, self._randomise = url, reward, finished, randomise
        self._names = [f"{rooms}-{k}" for k in range(num_envs)]
        self._chances = [np.random.default_rng() for _ in range(num_envs)]
        self._arenas: list[Arena] = []
        self._steps, self._over = np.zeros(num_envs, int), np.zeros(num_envs, bool)
        self._seen: list[Observations] = []
        self._runner = Runner()
        self._hall = self._runner._client = self._runner._start(connect(url, name="gym")._connect())
        try:
            self._runner._run(self._open(scene, actors, ticks, prepare))
        except BaseException:
            self.close()
            raise
        if gymnasium:
            self.metadata = {**self.metadata, "autoreset_mode": gymnasium.vector.AutoresetMode.NEXT_STEP}
        first = self._seen[0]
        self.single_action_space = action_space(actors())
        self.single_observation_space = observation_space(len(first["positions"]), len(first["grippers"]))
        self.action_space = self._batched(self.single_action_space)
        spaces = self.single_observation_space.spaces
        self.observation_space = Dict({name: self._batched(space) for name, space in spaces.items()})

    def _batched(self, space: Any) -> Any:
        low, high = float(space.low.flat[0]), float(space.high.flat[0])
        return Box(low, high, (self.num_envs, *space.shape), space.dtype)

    async def _open(
        self, scene: Any, actors: Callable[[], Sequence[Actor]], ticks: int, prepare: Preparation | None
    ) -> None:
        await self._hall.create_room(self._names[0], paused=True)
        first = Arena(await self._join(self._names[0]), actors(), ticks)
        await first.set_up(scene, prepare)
        for name in self._names[1:]:
            await first.client.fork(name, paused=True)
        clients = await asyncio.gather(*map(self._join, self._names[1:]))
        self._arenas = [first, *(Arena(client, actors(), ticks) for client in clients)]
        await asyncio.gather(*(arena.set_up(None, None) for arena in self._arenas[1:]))  # forks begin without saves
        self._seen = list(await asyncio.gather(*(arena.begin({}) for arena in self._arenas)))

    async def _join(self, room: str) -> Client:
        parts = urlsplit(socket_address(self._url))
        address = parts._replace(path=f"/ws/{room}").geturl()
        return await connect(address, name="gym", token=token_of(self._url))._connect()

    def _at_once(self, calls: Sequence[Awaitable[Observations]]) -> list[Observations]:
        async def together() -> list[Observations]:
            return list(await asyncio.gather(*calls))

        return self._runner._run(together())

    def _begin(self, k: int, options: Mapping[str, Any]) -> Awaitable[Observations]:
        drawn = self._randomise(self._chances[k]) if self._randomise else {}
        self._steps[k], self._over[k] = 0, False
        return self._arenas[k].begin({**drawn, **options.get("settings", {})})

    def _told(self) -> Observations:
        """All that was seen, as one array for each part."""
        return {name: np.stack([seen[name] for seen in self._seen]) for name in self._seen[0]}

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observations, dict[str, Any]]:
        """All back to the start. From one seed environment k draws with seed + k."""
        seeds = [seed + k for k in range(self.num_envs)] if isinstance(seed, int) else seed
        for k, own in enumerate(seeds or ()):
            self._chances[k] = np.random.default_rng(own)
        self._seen = self._at_once([self._begin(k, options or {}) for k in range(self.num_envs)])
        return self._told(), {"tick": self._ticks()}

    def step(self, actions: Any) -> tuple[Observations, Any, Any, Any, dict[str, Any]]:
        """One step of all: observations, rewards, which finished, which were cut, and what else there is to know."""
        begun, before = self._over.copy(), self._seen
        calls = [self._begin(k, {}) if begun[k] else self._arenas[k].step(actions[k]) for k in range(self.num_envs)]
        self._seen = self._at_once(calls)
        self._steps += ~begun
        rewards, finished = np.zeros(self.num_envs), np.zeros(self.num_envs, bool)
        for k in np.flatnonzero(~begun):
            rewards[k] = self._reward(before[k], self._seen[k], actions[k])
            finished[k] = self._finished is not None and self._finished(self._seen[k])
        cut = ~begun & (self._steps >= self.limit)
        self._over = finished | cut
        return self._told(), rewards, finished, cut, {"tick": self._ticks()}

    def _ticks(self) -> Any:
        return np.array([arena.frame.tick if arena.frame else 0 for arena in self._arenas])

    def close(self, **options: Any) -> None:
        """Closes the rooms and leaves the server."""
        if not self._runner._loop.is_closed():
            self._runner._run(self._leave())
            self._runner.close()

    async def _leave(self) -> None:
        await asyncio.gather(*(arena.client.close() for arena in self._arenas))
        there = {room["name"] for room in (await self._hall.list_rooms())["rooms"]}
        for name in self._names:
            if name in there:
                await self._hall.close_room(name)
