"""What a frame has beside times and positions. Written by proto/generate.py from proto/frames. Do not edit."""

from __future__ import annotations

from dataclasses import dataclass, field
from struct import Struct
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .samples import Floats


@dataclass(frozen=True)
class GrabSample:
    """One for each hand."""

    id: int
    viewer: int  # 0: the scene
    held: tuple[float, float, float]  # the point of the cloth [m]
    target: tuple[float, float, float]  # where the hand is [m]
    force: float  # magnitude [N]


@dataclass(frozen=True)
class Pose:
    """One for each collider that is not as defined."""

    position: tuple[float, float, float]  # of its pivot [m]
    rotation: tuple[float, float, float, float]  # unit quaternion x y z w


@dataclass(frozen=True)
class ContactSample:
    """One for each contact of the cloth."""

    collider: int | None  # the other side's place in colliders of mesh; none for cloth
    particle: int  # of the cloth, with the largest weight
    point: tuple[float, float, float]  # of the cloth's mid-surface [m]
    normal: tuple[float, float, float]  # unit, out of the other side
    gap: float  # from the mid-surface to the other side [m]
    normal_force: float  # on the cloth, along the normal [N]
    friction: tuple[float, float, float]  # on the cloth, tangential [N]


@dataclass(frozen=True)
class ReactionSample:
    """One for each pin or collider that bears the cloth."""

    of: str | int  # whose it is; a number, if this client does not know its meaning
    id: int  # of the pin, or the collider's place in colliders of mesh
    force: tuple[float, float, float]  # of a pin on the cloth, of the cloth on a collider [N]


@dataclass(frozen=True)
class GripperSample:
    """One for each gripper."""

    jaw: int  # its left jaw's place in colliders of mesh; the right one follows
    gripping: bool  # it presses something
    position: tuple[float, float, float]  # of its middle [m]
    rotation: tuple[float, float, float, float]  # from its definition, unit quaternion x y z w
    opening: float  # between its jaws [m]
    force: float  # most that each jaw presses with [N]
    reaction: tuple[float, float, float]  # of the cloth on both jaws, mean of the tick [N]
    torque: tuple[float, float, float]  # the same about its middle [N m]


@dataclass(frozen=True, kw_only=True)
class FrameParts:
    """What a frame has beside times and positions."""

    flags: int
    grabs: tuple[GrabSample, ...] = ()
    applied: dict[int, int] = field(default_factory=dict)  # by viewer
    # by collider, its place in colliders of mesh; its point p is at position + rotation (p - pivot)
    poses: dict[int, Pose] = field(default_factory=dict)
    contacts: tuple[ContactSample, ...] = ()  # if view or observe asked for them; as in query
    reactions: tuple[ReactionSample, ...] = ()  # if view or observe asked for them; as in query
    grippers: tuple[GripperSample, ...] = ()  # if observe asked for them; as in query
    velocities: Floats | None = None  # one row of 3 per vertex [m/s], if observe asked for them

    @property
    def key(self) -> bool:
        """It builds on no other frame (always in codec 0)."""
        return bool(self.flags & 1)

    @property
    def jump(self) -> bool:
        """The state was replaced (reset, load, recovery), so do not interpolate to it."""
        return bool(self.flags & 2)

    @property
    def paused(self) -> bool:
        """The room is paused."""
        return bool(self.flags & 4)

    @property
    def observed(self) -> bool:
        """It has what `observe` of an `advance` asked for."""
        return bool(self.flags & 8)


# Of each list: its section, the form of its entries, how one is made, what collects them.
LISTS: dict[str, tuple[int, Struct, Any, Any]] = {
    "grabs": (2, Struct("<2I7f"), lambda e: GrabSample(e[0], e[1], e[2:5], e[5:8], e[8]), tuple),
    "applied": (3, Struct("<2I"), lambda e: (e[0], e[1]), dict),
    "poses": (4, Struct("<I7f"), lambda e: (e[0], Pose(e[1:4], e[4:8])), dict),
    "contacts": (
        5,
        Struct("<2I11f"),
        lambda e: ContactSample(None if e[0] == 4294967295 else e[0], e[1], e[2:5], e[5:8], e[8], e[9], e[10:13]),
        tuple,
    ),
    "reactions": (
        6,
        Struct("<2I3f"),
        lambda e: ReactionSample(("pin", "collider")[e[0]] if e[0] < 2 else e[0], e[1], e[2:5]),
        tuple,
    ),
    "grippers": (
        9,
        Struct("<2I15f"),
        lambda e: GripperSample(e[0], bool(e[1]), e[2:5], e[5:9], e[9], e[10], e[11:14], e[14:17]),
        tuple,
    ),
}  # fmt: skip
ARRAYS = {"velocities": 8}
