"""What binary messages say."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias, overload

from . import layout
from .results import AdvanceResult

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray

# Rows of numbers: a numpy array that shares the memory of its message; `Rows` where numpy is not installed.
Floats: TypeAlias = "NDArray[numpy.float32]"
Indices: TypeAlias = "NDArray[numpy.uint32]"
Numbers: TypeAlias = "NDArray[Any]"


class Rows(Sequence[tuple[Any, ...]]):
    """Rows of numbers, read-only; `flat` is all of them as a memoryview."""

    def __init__(self, flat: memoryview, width: int):
        self.flat, self.width = flat, width

    def __len__(self) -> int:
        return len(self.flat) // self.width

    @overload
    def __getitem__(self, index: int) -> tuple[Any, ...]: ...
    @overload
    def __getitem__(self, index: slice) -> list[tuple[Any, ...]]: ...
    def __getitem__(self, index: int | slice) -> Any:
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        start = range(len(self))[index] * self.width
        return tuple(self.flat[start : start + self.width])


@dataclass(frozen=True)
class GrabSample:
    """A hand at the tick of a frame; `force` [N] is a magnitude."""

    id: int
    viewer: int  # 0: a hand of the scene itself
    held: tuple[float, float, float]
    target: tuple[float, float, float]
    force: float


@dataclass(frozen=True)
class Pose:
    """A collider whose pose differs from `mesh`: p is at position + rotation (p - pivot)."""

    position: tuple[float, float, float]  # of its pivot [m]
    rotation: tuple[float, float, float, float]  # unit quaternion x, y, z, w


@dataclass(frozen=True)
class ContactSample:
    """A contact of the cloth at the tick of a frame; forces are on the cloth [N]."""

    collider: int | None  # its index in the list of the `mesh` message; None: cloth too
    particle: int
    point: tuple[float, float, float]  # of the cloth's mid-surface [m]
    normal: tuple[float, float, float]  # unit, out of the other side
    gap: float  # from the mid-surface to the other side [m]
    normal_force: float
    friction: tuple[float, float, float]


@dataclass(frozen=True)
class ReactionSample:
    """A force of a pin on the cloth, or of the cloth on a collider [N]."""

    of: str | int  # "pin" or "collider"; a number, if this client does not know it
    id: int  # of the pin, or the collider's index in the list of the `mesh` message
    force: tuple[float, float, float]


@dataclass(frozen=True)
class GripperSample:
    """A gripper at the end of a tick."""

    jaw: int  # its left jaw's index in the list of the `mesh` message; the right one follows
    gripping: bool
    position: tuple[float, float, float]  # of its middle [m]
    rotation: tuple[float, float, float, float]  # from its definition, unit quaternion x, y, z, w
    opening: float  # between its jaws [m]
    force: float  # most that each jaw presses with [N]
    reaction: tuple[float, float, float]  # of the cloth on both jaws, mean of the tick [N]
    torque: tuple[float, float, float]  # the same about its middle [N m]


@dataclass(frozen=True)
class Frame:
    """Positions of the vertices at a tick."""

    tick: int
    time: float  # simulated [s]
    server_time: float  # server's clock [s]
    sequence: int
    reference: int
    epoch: int
    flags: int
    positions: Floats  # one row of 3 per vertex [m]
    grabs: tuple[GrabSample, ...]
    applied: dict[int, int]  # viewer to the number of its last included message
    poses: dict[int, Pose]  # by the collider's index in the list of the `mesh` message
    contacts: tuple[ContactSample, ...]  # if `view` asked for forces
    reactions: tuple[ReactionSample, ...]  # if `view` asked for forces
    velocities: Floats | None = None  # one row of 3 per vertex [m/s], if `observe` asked for them
    grippers: tuple[GripperSample, ...] = ()  # if `observe` asked for them

    @property
    def jump(self) -> bool:
        """The state was replaced (reset, load, recovery)."""
        return bool(self.flags & layout.JUMP)

    @property
    def paused(self) -> bool:
        return bool(self.flags & layout.PAUSED)

    @property
    def observed(self) -> bool:
        """It has what `observe` of an `advance` asked for."""
        return bool(self.flags & layout.OBSERVED)


@dataclass(frozen=True)
class ColliderMesh:
    collider: int  # index in the list of the `mesh` message
    positions: Floats  # one row of 3 per vertex [m]
    triangles: Indices  # one row of 3 per triangle


@dataclass(frozen=True)
class MeshData:
    """Everything constant during an epoch."""

    rest_positions: Floats  # one row of 3 per vertex [m]
    triangles: Indices  # one row of 3 per triangle
    uv: Floats  # one row of 2 per vertex
    colliders: tuple[ColliderMesh, ...]
    order: Indices | None = None  # one row of 4 per vertex, of the codec `packed`; None: all cloths are grids


@dataclass(frozen=True)
class Data:
    """Answer to a binary query."""

    tick: int
    transfer: int
    components: int
    values: Numbers  # one row of `components` each


@dataclass(frozen=True)
class Hit:
    """A point of the cloth."""

    triangle: int
    barycentric: tuple[float, float, float]
    position: tuple[float, float, float]
    particle: int  # the nearest corner
    distance: float  # along the ray [m]


class Observation(AdvanceResult):
    """The answer to an `advance` that observes."""

    observation: Frame  # of its last tick
