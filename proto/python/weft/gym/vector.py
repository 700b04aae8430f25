"""Many cloths in one server, a room each, stepped in lock-step."""

from __future__ import annotations

import asyncio
import itertools
from collections.abc import Awaitable, Callable, Iterable, Mapping, Sequence
from typing import Any, TypeVar
from urllib.parse import urlsplit

import numpy as np

from ..address import socket_address, token_of
from ..client import Client
from ..connecting import connect
from ..errors import CommandError, ConnectionLost
from ..runner import Runner
from .actors import Actor, Gripper
from .arena import MOST_TICKS, Arena, Preparation, action_space, observation_space
from .checks import actions as checked
from .checks import whole
from .env import Randomise, Reward, lifted
from .spaces import Box, Dict, VectorEnv, gymnasium

Observations = dict[str, Any]
Value = TypeVar("Value")


async def all_of(calls: Iterable[Awaitable[Value]]) -> list[Value]:
    """What all of them give, once all are done. Only then a failure is raised, so that none goes on behind it."""
    values: list[Value] = []
    failure: BaseException | None = None
    for value in await asyncio.gather(*calls, return_exceptions=True):
        if isinstance(value, BaseException):
            failure = failure or value
        else:
            values.append(value)
    if failure is not None:
        raise failure
    return values


class VectorClothEnv(VectorEnv):
    """`num_envs` environments as `ClothEnv` is one. The first room is set up, and the others are forks of it, so that
    all begin with the same bits. Each step all rooms run their ticks at once; the answer comes when all are done.

    An environment whose episode ended begins anew in the next step, whose action it ignores (Gymnasium's
    `NEXT_STEP`).

    The rooms have the first free names of `rooms`-0, `rooms`-1 and so on, so that many of these share a server that has
    room for all (`weft serve --rooms`). `close` closes those that were made here, and so does a constructor that fails;
    rooms of others are left alone.
    """

    metadata: dict[str, Any] = {"render_modes": [], "autoreset_mode": "NextStep"}

    def __init__(
        self, url: str, num_envs: int, *, scene: str | Mapping[str, Any] = "gripper",
        actors: Callable[[], Sequence[Actor]] = lambda: [Gripper()], ticks: int = 6, limit: int = 100,
        reward: Reward = lifted, finished: Callable[[Mapping[str, Any]], bool] | None = None,
        randomise: Randomise | None = None, prepare: Preparation | None = None, rooms: str = "gym",
    ):  # fmt: skip
        self.num_envs, self.limit = whole("num_envs", num_envs, 1), whole("limit", limit, 1)
        ticks = whole("ticks", ticks, 1, MOST_TICKS)
        self._url, self._reward, self._finished, self._randomise = url, reward, finished, randomise
        self._names = (f"{rooms}-{k}" for k in itertools.count())
        self._rooms: dict[str, Client | None] = {}  # that were made here, with the client in each
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
        async def joined(name: str) -> Arena:
            return Arena(await self._join(name), actors(), ticks, scene, prepare)

        first = await joined(await self._make(lambda name: self._hall.create_room(name, paused=True)))
        await first.set_up()
        forks = [await self._make(lambda name: first.client.fork(name, paused=True)) for _ in range(1, self.num_envs)]
        self._arenas = [first, *await all_of(map(joined, forks))]
        await all_of(arena.set_up(forked=True) for arena in self._arenas[1:])  # forks begin without saves
        self._seen = await all_of(arena.begin({}) for arena in self._arenas)

    async def _make(self, make: Callable[[str], Awaitable[Any]]) -> str:
        """The name of a room that this makes, the next one that is free."""
        for name in self._names:
            try:
                await make(name)
            except CommandError as refusal:
                if refusal.code == "room_exists":
                    continue
                raise
            self._rooms[name] = None
            return name
        raise AssertionError("names do not end")

    async def _join(self, room: str) -> Client:
        parts = urlsplit(socket_address(self._url))
        address = parts._replace(path=f"/ws/{room}").geturl()
        client = await connect(address, name="gym", token=token_of(self._url))._connect()
        self._rooms[room] = client
        return client

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
        begun = [self._begin(k, options or {}) for k in range(self.num_envs)]
        self._seen = self._runner._run(all_of(begun))
        return self._told(), {"tick": self._ticks()}

    def step(self, actions: Any) -> tuple[Observations, Any, Any, Any, dict[str, Any]]:
        """One step of all: observations, rewards, which finished, which were cut, and what else there is to know."""
        actions = checked(actions, self.action_space.shape)
        begun, before = self._over.copy(), self._seen
        calls = [self._begin(k, {}) if begun[k] else self._arenas[k].step(actions[k]) for k in range(self.num_envs)]
        self._seen = self._runner._run(all_of(calls))
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
        """Closes the rooms that were made here and leaves the server."""
        runner = getattr(self, "_runner", None)  # Gymnasium also closes what refused its arguments
        if runner is None or runner._loop.is_closed():
            return
        try:
            runner._run(self._leave())
        finally:
            runner.close()

    async def _leave(self) -> None:
        # Whoever is no longer connected may have lost its room, and another one may have that name since.
        own = [name for name, client in self._rooms.items() if client is None or client.welcome is not None]
        await all_of(client.close() for client in self._rooms.values() if client is not None)
        await all_of(map(self._close_room, own))

    async def _close_room(self, name: str) -> None:
        try:
            await self._hall.close_room(name)
        except ConnectionLost:
            pass  # and with it the server, or it closes the room later by itself
        except CommandError as refusal:
            if refusal.code != "unknown_room":
                raise
