"""What commands answer. Written by proto/generate.py from the descriptions in proto/messages."""

from collections.abc import Sequence
from typing import Literal, NotRequired, TypedDict

from .messages import Hit, RoomInfo


class Answer(TypedDict):
    """What every answer has."""

    op: Literal["result"]
    id: int | str
    command: str  # the `op` that it answers


class PauseResult(Answer):
    """The answer to `pause`."""

    tick: int
    paused: bool


class ResumeResult(Answer):
    """The answer to `resume`."""

    tick: int
    paused: bool


class CameraResult(Answer):
    """The answer to `camera`."""

    tick: int


class SetResult(Answer):
    """The answer to `set`."""

    tick: int


class ResetResult(Answer):
    """The answer to `reset`."""

    tick: int


class SaveResult(Answer):
    """The answer to `save`."""

    tick: int


class RestoreResult(Answer):
    """The answer to `restore`."""

    tick: int


class PolicyResult(Answer):
    """The answer to `policy`."""

    tick: int


class MuteResult(Answer):
    """The answer to `mute`."""

    tick: int


class GiveHandResult(Answer):
    """The answer to `give_hand`."""

    tick: int


class PresenceResult(Answer):
    """The answer to `presence`."""

    tick: int


class FollowResult(Answer):
    """The answer to `follow`."""

    tick: int


class LeadResult(Answer):
    """The answer to `lead`."""

    tick: int


class HelloResult(Answer):
    """The answer to `hello`."""

    viewer: int  # its number
    name: str  # in force
    color: str  # in force
    role: Literal["viewer", "operator", "admin"]  # what it may do; viewer or operator or admin


class InviteResult(Answer):
    """The answer to `invite`."""

    tick: int  # the command's place in the order: after it
    token: str  # for a link's fragment, #token=…


class PickResult(Answer):
    """The answer to `pick`."""

    tick: int  # the command's place in the order: after it
    hit: Hit | None  # null: the ray meets no cloth


class DragResult(Answer):
    """The answer to `drag`."""

    tick: int  # the command's place in the order: after it
    drag: int  # the viewer's number
    grab: int  # the room's number of the hand
    target: NotRequired[Sequence[float]]  # of a start [m]
    impulse: NotRequired[Sequence[float]]  # of a sling that was fired [N s]


class PinResult(Answer):
    """The answer to `pin`."""

    tick: int  # the command's place in the order: after it
    pin: int  # its id
    particle: int  # its centre
    count: int  # particles that it holds


class ReleaseResult(Answer):
    """The answer to `release`."""

    tick: int  # the command's place in the order: after it
    released: list[int]  # ids of the pins that are gone


class StepResult(Answer):
    """The answer to `step`."""

    tick: int  # the command's place in the order: after it
    until: int  # tick at which the room stands still again


class SpeedResult(Answer):
    """The answer to `speed`."""

    tick: int  # the command's place in the order: after it
    speed: float  # simulated per real time


class MoveResult1(Answer):
    """The answer to `move`."""

    tick: int  # the command's place in the order: after it
    collider: str | int  # as in the command


class MoveResult2(Answer):
    """The answer to `move`."""

    tick: int  # the command's place in the order: after it
    pin: int  # its id
    position: Sequence[float]  # where it was [m]


class GripperResult(Answer):
    """The answer to `gripper`."""

    tick: int  # the command's place in the order: after it
    gripper: str  # its name


class AdvanceResult(Answer):
    """The answer to `advance`."""

    tick: int  # the command's place in the order: after it
    hash: str  # of the state


class HashResult(Answer):
    """The answer to `hash`."""

    tick: int  # the command's place in the order: after it
    hash: str  # of the state


class PingResult(Answer):
    """The answer to `ping`."""

    t: float  # as sent
    received: float  # by the server's clock [s]
    sent: float  # by the server's clock [s]


class LoadResult(Answer):
    """The answer to `load`."""

    tick: int  # the command's place in the order: after it
    scene: str  # its name
    epoch: int  # of its mesh


class CreateRoomResult(Answer):
    """The answer to `create_room`."""

    room: RoomInfo  # as it begins


class ListRoomsResult(Answer):
    """The answer to `list_rooms`."""

    rooms: list[RoomInfo]  # by name
    most: int  # rooms that this server has at a time


class CloseRoomResult(Answer):
    """The answer to `close_room`."""

    name: str  # of the room that is gone


class ForkResult(Answer):
    """The answer to `fork`."""

    tick: int  # the command's place in the order: after it
    room: RoomInfo  # as it begins
    token: NotRequired[str]  # with which its maker, who comes by a token, operates the copy


class ViewResult(Answer):
    """The answer to `view`."""

    hz: float  # most frames a second
    codec: Literal["f32", "packed"]  # of the positions in frames; f32 or packed
    error: NotRequired[float]  # most that a vertex may be off [m]
    forces: bool  # contacts and reactions in the frames; true or false
