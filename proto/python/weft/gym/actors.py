"""What acts on the cloth: each takes four numbers from -1 to 1 a step."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..client import Client
from ..drag import Drag

NUMBERS = 4  # of an action: three of the way, one of the grip


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
    and whether it holds: above 0. It takes the cloth where its particle then is."""

    particle: int = 0
    reach: float = 0.02  # most of a step, in each direction [m]
    radius: float = 0.03  # of the held disc [m]
    stiffness: float = 150.0  # [N/m]
    max_force: float = 50.0  # [N]
    _drag: Drag | None = field(default=None, init=False, repr=False)
    _target: Any = field(default=None, init=False, repr=False)

    async def begin(self, client: Client) -> None:
        """After the room was put back to its start."""
        self._drag = self._target = None

    async def act(self, client: Client, action: Any) -> None:
        """Takes hold, pulls or lets go, as an action says."""
        if action[3] <= 0:
            return await self.end()
        if self._drag is None:
            self._drag = client.drag(self.particle, radius=self.radius, stiffness=self.stiffness,
                                     max_force=self.max_force)
            await self._drag.start()
            self._target = np.array(self._drag.target)
        self._target = self._target + self.reach * action[:3]
        await self._drag.move(self._target)

    async def end(self) -> None:
        """Lets go."""
        drag, self._drag = self._drag, None
        if drag is not None:
            await drag.end()


Actor = Gripper | Hand
