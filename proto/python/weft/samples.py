"""What binary messages say."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias, overload

from .frame_parts import ContactSample, FrameParts, GrabSample, GripperSample, Pose, ReactionSample

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


@dataclass(frozen=True, kw_only=True)
class Frame(FrameParts):
    """Positions of the vertices at a tick."""

    tick: int
    time: float  # simulated [s]
    server_time: float  # server's clock [s]
    sequence: int
    reference: int
    epoch: int
    positions: Floats  # one row of 3 per vertex [m]


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
