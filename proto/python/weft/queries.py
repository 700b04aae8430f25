"""Reading something from the state between two ticks: what each query answers."""

from __future__ import annotations

from typing import Any, Literal, overload

from .commands import Commands
from .fields import without_none
from .messages import (
    Camera, ColliderPose, Contact, Crossings, Energy, EnergyBalance, Grab, GripperState, Pin, Reactions, StageWork, State, Strain,
    Tree, Viewer,
)  # fmt: skip
from .samples import Data
from .timeouts import CLIENTS

Binary = Literal["f32", "f64"]


class ViewerCamera(Camera):
    """Where a viewer looks from."""

    viewer: int


class Queries(Commands):
    """Queries, by what they ask for."""

    @overload
    async def query(
        self, what: Literal["positions", "velocities"], *, format: Binary, timeout: float | None = CLIENTS
    ) -> Data: ...
    @overload
    async def query(
        self, what: Literal["positions", "velocities"], *, format: Literal["json"] | None = None,
        timeout: float | None = CLIENTS,
    ) -> list[list[float]]: ...  # fmt: skip
    @overload
    async def query(
        self, what: Literal["boxes"], *, tree: str, level: int | None = None, format: Binary,
        timeout: float | None = CLIENTS,
    ) -> Data: ...  # fmt: skip
    @overload
    async def query(
        self, what: Literal["boxes"], *, tree: str, level: int | None = None,
        format: Literal["json"] | None = None, timeout: float | None = CLIENTS,
    ) -> list[list[float]]: ...  # fmt: skip
    @overload
    async def query(self, what: Literal["energies"], *, timeout: float | None = CLIENTS) -> Energy: ...
    @overload
    async def query(self, what: Literal["strain"], *, timeout: float | None = CLIENTS) -> Strain: ...
    @overload
    async def query(self, what: Literal["pins"], *, timeout: float | None = CLIENTS) -> list[Pin]: ...
    @overload
    async def query(self, what: Literal["grabs"], *, timeout: float | None = CLIENTS) -> list[Grab]: ...
    @overload
    async def query(
        self, what: Literal["camera"], *, viewer: int | None = None, timeout: float | None = CLIENTS
    ) -> list[ViewerCamera]: ...
    @overload
    async def query(self, what: Literal["roster"], *, timeout: float | None = CLIENTS) -> list[Viewer]: ...
    @overload
    async def query(self, what: Literal["state"], *, timeout: float | None = CLIENTS) -> State: ...
    @overload
    async def query(self, what: Literal["work"], *, timeout: float | None = CLIENTS) -> list[StageWork]: ...
    @overload
    async def query(self, what: Literal["trees"], *, timeout: float | None = CLIENTS) -> list[Tree]: ...
    @overload
    async def query(self, what: Literal["colliders"], *, timeout: float | None = CLIENTS) -> list[ColliderPose]: ...
    @overload
    async def query(self, what: Literal["measurements"], *, timeout: float | None = CLIENTS) -> dict[str, float]: ...
    @overload
    async def query(self, what: Literal["contacts"], *, timeout: float | None = CLIENTS) -> list[Contact]: ...
    @overload
    async def query(self, what: Literal["reactions"], *, timeout: float | None = CLIENTS) -> Reactions: ...
    @overload
    async def query(self, what: Literal["grippers"], *, timeout: float | None = CLIENTS) -> list[GripperState]: ...
    @overload
    async def query(self, what: Literal["crossings"], *, timeout: float | None = CLIENTS) -> Crossings: ...
    @overload
    async def query(self, what: Literal["balance"], *, timeout: float | None = CLIENTS) -> EnergyBalance: ...
    async def query(
        self, what: str, *, format: str | None = None, viewer: int | None = None, tree: str | None = None,
        level: int | None = None, timeout: float | None = CLIENTS,
    ) -> Any:  # fmt: skip
        """The data of a query; a `Data` if the format is "f32" or "f64"."""
        options = without_none({"format": format, "viewer": viewer, "tree": tree, "level": level})
        return (await self.request("query", timeout=timeout, what=what, **options))["data"]
