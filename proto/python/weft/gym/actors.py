"""What acts on the cloth: each takes four numbers from -1 to 1 a step."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..client import Client
from ..drag import Drag
from ..errors import CommandError
from .checks import number, whole

# Bounds of the server for what it is told (section 5 of proto/README.md), as least and most.
FARTHEST = 1000.0  # [m]
OPENINGS, JAW_FORCES, SPEEDS = (0, 1), (0, 1000), (0.001, 20)
RADII, STIFFNESSES, PULLS = (0, 100), (0, 1e5), (0, 1e6)


@dataclass
class Gripper:
    """A gripper of the scene. Its action: the way of its middle along x, y and z in parts of `reach`, and its opening,
    from -1, closed on what is there, to 1, `opening` wide."""

    name: str = "gripper"
    reach: float = 0.02  # most of a step, in each direction [m]
    opening: float = 0.06  # [m]
    force: float | None = None  # of each jaw [N]; None: that of the scene
    speed: float = 2.0  # limit of its middle [m/s]
    _target: Any = field(default=None, init=False, repr=False)

    def __post_init__(self) -> None:
        number("reach", self.reach, 0, FARTHEST)
        number("opening", self.opening, *OPENINGS)
        number("speed", self.speed, *SPEEDS)
        if self.force is not None:
            number("force", self.force, *JAW_FORCES)

    async def begin(self, client: Client) -> None:
        """After the room was put back to its start."""
        states = {state["name"]: state for state in await client.query("grippers")}
        if self.name not in states:
            raise ValueError(f"the scene has no gripper {self.name!r}; it has {', '.join(states) or 'none'}")
        self._target = np.array(states[self.name]["position"])

    async def act(self, client: Client, action: Any) -> None:
        """Sends what an action says; the next `advance` comes behind it."""
        self._target = self._target + self.reach * action[:3]
        opening = self.opening * (float(action[3]) + 1) / 2
        fields: dict[str, Any] = {"opening": opening, "position": self._target, "speed": self.speed}
        if self.force is not None:
            fields["force"] = self.force
        await client.post("gripper", name=self.name, **fields)

    async def end(self) -> None:
        """Before the room is put back."""


@dataclass
class Hand:
    """A hand at a particle, as of a viewer. Its action: the way of its target along x, y and z in parts of `reach`,
    and whether it holds: above 0. It takes the cloth where its particle then is, and does so anew where another viewer
    made it let go."""

    particle: int = 0
    reach: float = 0.02  # most of a step, in each direction [m]
    radius: float = 0.03  # of the held disc [m]
    stiffness: float = 150.0  # [N/m]
    max_force: float = 50.0  # [N]
    _drag: Drag | None = field(default=None, init=False, repr=False)
    _target: Any = field(default=None, init=False, repr=False)

    def __post_init__(self) -> None:
        whole("particle", self.particle, 0)
        number("reach", self.reach, 0, FARTHEST)
        number("radius", self.radius, *RADII)
        number("stiffness", self.stiffness, *STIFFNESSES)
        number("max_force", self.max_force, *PULLS)

    async def begin(self, client: Client) -> None:
        """After the room was put back to its start."""
        if self.particle >= client.mesh["vertices"]:
            raise ValueError(f"the scene has {client.mesh['vertices']} particles, from 0, and no {self.particle}")
        self._drag = self._target = None

    async def act(self, client: Client, action: Any) -> None:
        """Takes hold, pulls or lets go, as an action says."""
        if action[3] <= 0:
            return await self.end()
        way = self.reach * action[:3]
        if self._drag is not None:
            try:
                return await self._pull(self._drag, way)
            except CommandError as refusal:
                if refusal.code != "unknown_drag":
                    raise
                await self.end()  # the server let go of it, as at another viewer's `reset`
        drag = client.drag(self.particle, radius=self.radius, stiffness=self.stiffness, max_force=self.max_force)
        self._drag = await drag.start()
        self._target = np.array(drag.target)
        await self._pull(drag, way)

    async def _pull(self, drag: Drag, way: Any) -> None:
        self._target = self._target + way
        await drag.move(self._target)

    async def end(self) -> None:
        """Lets go, if it still holds."""
        drag, self._drag = self._drag, None
        if drag is not None:
            await drag.__aexit__()


Actor = Gripper | Hand
