"""A cloth as a Gymnasium environment."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from ..connecting import connect
from ..runner import Runner
from .actors import Actor, Gripper
from .arena import MOST_TICKS, Arena, Preparation, action_space, observation_space
from .checks import actions, whole
from .picture import Picture
from .spaces import Env

MOST_PIXELS = 10_000  # of a picture, along each side
# Of what was observed before and after a step, and the action between, as it was carried out: the reward.
Reward = Callable[[Mapping[str, Any], Mapping[str, Any], Any], float]
# Draws the settings of an episode, those of `Client.set`, from a source of chance.
Randomise = Callable[[Any], Mapping[str, Any]]


def lifted(before: Mapping[str, Any], after: Mapping[str, Any], action: Any) -> float:
    """By how much the cloth's mean height grew in a step [m]."""
    return float(after["positions"][:, 1].mean() - before["positions"][:, 1].mean())


class ClothEnv(Env):
    """One room of a server. Its actions move grippers and hands, four numbers from -1 to 1 each; it observes positions
    and velocities of the vertices and the state of all grippers with the force and torque that they feel. Numbers of an
    action beyond -1 and 1 are clipped; a wrong shape and what is not finite raise ValueError before anything is sent.

    The room is this environment's alone: it is paused, and loses its scene. `reset(seed, options)` goes back to the
    start; `options` may have `settings`, those of `Client.set`, which count above what `randomise` draws. An episode is
    cut after `limit` steps; `finished` of an observation ends it before.

    Where another viewer sets the room going, `reset` and `step` pause it and go on; ticks that passed meanwhile show in
    the `tick` of `info`. Where one loads another scene, `step` raises WeftError and `reset` loads that of the
    environment again. `step` raises CommandError if the server refuses what an action asks for.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}

    def __init__(
        self, url: str, *, scene: str | Mapping[str, Any] = "gripper", actors: Sequence[Actor] | None = None,
        ticks: int = 6, limit: int = 100, reward: Reward = lifted,
        finished: Callable[[Mapping[str, Any]], bool] | None = None, randomise: Randomise | None = None,
        prepare: Preparation | None = None, render_mode: str | None = None, size: tuple[int, int] = (240, 320),
    ):  # fmt: skip
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f"render_mode {render_mode!r}: there is rgb_array alone")
        ticks, self.limit = whole("ticks", ticks, 1, MOST_TICKS), whole("limit", limit, 1)
        rows, columns = (whole("size", side, 1, MOST_PIXELS) for side in size)
        actors = [Gripper()] if actors is None else list(actors)
        self.render_mode = render_mode
        self._reward, self._finished, self._randomise = reward, finished, randomise
        self._steps, self._seen = 0, {}
        self._runner = Runner()
        self._runner._client = self._runner._start(connect(url, name="gym")._connect())
        try:
            self._arena = Arena(self._runner._client, actors, ticks, scene, prepare)
            self._runner._run(self._arena.set_up())
            found = self._runner._run(self._arena.begin({}))
        except BaseException:
            self.close()
            raise
        self.action_space = action_space(actors)
        self.observation_space = observation_space(len(found["positions"]), len(found["grippers"]))
        self._picture = Picture(self._arena.client.mesh, self._arena.client.mesh_data, (rows, columns))

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Back to the start, with settings drawn from the seed."""
        super().reset(seed=seed)
        settings = {**(self._randomise(self.np_random) if self._randomise else {}), **(options or {}).get("settings", {})}
        self._steps, self._seen = 0, self._runner._run(self._arena.begin(settings))
        return self._seen, {"settings": settings, "tick": self._tick()}

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Some ticks with an action: observation, reward, finished, cut, and what else there is to know."""
        action = actions(action, self.action_space.shape)
        before, self._seen = self._seen, self._runner._run(self._arena.step(action))
        self._steps += 1
        finished = self._finished is not None and bool(self._finished(self._seen))
        reward = float(self._reward(before, self._seen, action))
        return self._seen, reward, finished, self._steps >= self.limit, {"tick": self._tick()}

    def render(self) -> Any:
        """A picture of the newest state, rows of pixels of red, green and blue."""
        frame = self._arena.frame
        return self._picture.of(frame) if frame is not None and self.render_mode == "rgb_array" else None

    def close(self) -> None:
        """Leaves the server."""
        self._runner.close()

    def _tick(self) -> int:
        return self._arena.frame.tick if self._arena.frame else 0
