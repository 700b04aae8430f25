"""Commands that follow from their fields. Written by proto/generate.py from proto/messages."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from .fields import known, listed, without_none
from .messages import Camera, Fabric, Fan
from .results import (
    CameraResult, CloseRoomResult, CreateRoomResult, FollowResult, ForkResult, GiveHandResult, GripperResult,
    InviteResult, LeadResult, ListRoomsResult, MuteResult, PauseResult, PolicyResult, PresenceResult, ResetResult,
    RestoreResult, ResumeResult, SaveResult, SetResult, SpeedResult, StepResult,
)  # fmt: skip
from .session import Session
from .timeouts import CLIENTS


class Commands(Session):
    """Commands that follow from their fields."""

    async def camera(
        self, position: Iterable[float], target: Iterable[float], *, up: Iterable[float] | None = None,
        fov: float | None = None, timeout: float | None = CLIENTS,
    ) -> CameraResult:  # fmt: skip
        """Stores where this viewer looks from, so that others may follow.

        position: of the eye [m]; 3 × ±10000
        target: what it looks at; not the same point [m]; 3 × ±10000
        up: a direction; 3 × ±10000
        fov: vertical angle of view [degrees]; 1 to 179
        """
        fields = {"position": listed(position), "target": listed(target), "up": listed(up), "fov": fov}
        return await self.request("camera", timeout=timeout, **without_none(fields))

    async def pause(self, *, timeout: float | None = CLIENTS) -> PauseResult:
        """Stops the room's clock."""
        return await self.request("pause", timeout=timeout)

    async def resume(self, *, timeout: float | None = CLIENTS) -> ResumeResult:
        """Lets the room's clock run."""
        return await self.request("resume", timeout=timeout)

    async def step(self, n: int = 1, *, timeout: float | None = CLIENTS) -> StepResult:
        """Lets ticks pass in a paused room. (n: ticks; 1 to 600)"""
        fields = {"n": n}
        return await self.request("step", timeout=timeout, **without_none(fields))

    async def reset(self, *, timeout: float | None = CLIENTS) -> ResetResult:
        """Back to the scene's start."""
        return await self.request("reset", timeout=timeout)

    async def save(self, name: str, *, timeout: float | None = CLIENTS) -> SaveResult:
        """Keeps the present state in memory, in place of an earlier one of this name.

        name: lower-case letters, digits and hyphens; 1 to 32 characters
        """
        fields = {"name": name}
        return await self.request("save", timeout=timeout, **without_none(fields))

    async def restore(self, name: str, *, timeout: float | None = CLIENTS) -> RestoreResult:
        """Back to a state that was saved. (name: lower-case letters, digits and hyphens; 1 to 32 characters)"""
        fields = {"name": name}
        return await self.request("restore", timeout=timeout, **without_none(fields))

    async def speed(self, speed: float, *, timeout: float | None = CLIENTS) -> SpeedResult:
        """Sets how fast time passes. (speed: simulated per real time; 0.01 to 10)"""
        fields = {"speed": speed}
        return await self.request("speed", timeout=timeout, **without_none(fields))

    async def gripper(
        self, name: str, *, opening: float | None = None, force: float | None = None,
        position: Iterable[float] | None = None, rotation: Iterable[float] | None = None, speed: float | None = None,
        turn_speed: float | None = None, timeout: float | None = CLIENTS,
    ) -> GripperResult:  # fmt: skip
        """Opens, closes (opening=0) or moves a gripper; omitted values stay as they are.

        name: of the gripper; 1 to 56 bytes
        opening: between its jaws; 0 closes on what is there [m]; 0 to 1
        force: with which each jaw presses [N]; 0 to 1000
        position: target of its middle [m]; 3 × ±1000
        rotation: relative to its definition; without it, as it is now; unit quaternion
        speed: of its middle, at most [m/s]; 0.001 to 20
        turn_speed: at most [rad/s]; 0.001 to 60
        """
        fields = {
            "name": name, "opening": opening, "force": force, "position": listed(position),
            "rotation": listed(rotation), "speed": speed, "turn_speed": turn_speed,
        }  # fmt: skip
        return await self.request("gripper", timeout=timeout, **without_none(fields))

    async def set(
        self, *, gravity: Iterable[float] | None = None, wind: Iterable[float] | None = None,
        gust_speed: float | None = None, gust_length: float | None = None, air_density: float | None = None,
        still_air: bool | None = None, drag: float | None = None, fans: list[Fan] | None = None,
        softness: float | None = None, budget_ms: float | None = None,
        over_budget: Literal["slow", "soften"] | None = None, fabric: Fabric | None = None,
        cloth: str | int | None = None, timeout: float | None = CLIENTS,
    ) -> SetResult:  # fmt: skip
        """Changes forces, settings and fabric of the room; omitted values stay as they are.

        gravity: acceleration [m/s²]; 3 × ±1000
        wind: mean velocity [m/s]; 3 × ±100
        gust_speed: bound of each component of the gusts [m/s]; 0 to 100
        gust_length: size of an eddy [m]; 0.01 to 100
        air_density: of the air [kg/m³]; 0 to 1000
        still_air: air resists without wind too; true or false
        drag: uniform damping of velocities [1/s]; 0 to 1000
        fans: all local winds; list of at most 4
        softness: fraction of the springs' stiffness; 0.01 to 1
        budget_ms: for each tick that is due; 0: no bound [ms]; 0 to 1000
        over_budget: what gives way beyond it; slow or soften
        fabric: of one cloth
        cloth: whose fabric: its name, or its place in the list of mesh; the first by default
        """
        fields = {
            "gravity": listed(gravity), "wind": listed(wind), "gust_speed": gust_speed, "gust_length": gust_length,
            "air_density": air_density, "still_air": still_air, "drag": drag, "fans": known(Fan, "fans", fans),
            "softness": softness, "budget_ms": budget_ms, "over_budget": over_budget,
            "fabric": known(Fabric, "fabric", fabric), "cloth": cloth,
        }  # fmt: skip
        return await self.request("set", timeout=timeout, **without_none(fields))

    async def create_room(
        self, name: str, *, scene: str | None = None, paused: bool | None = None, timeout: float | None = CLIENTS,
    ) -> CreateRoomResult:  # fmt: skip
        """Opens a room beside this one; its address ends in `/ws/name`.

        name: lower-case letters, digits and hyphens; 1 to 32 characters
        scene: its name; by default that with which the server was started; 1 to 64 characters
        paused: it begins paused; true or false
        """
        fields = {"name": name, "scene": scene, "paused": paused}
        return await self.request("create_room", timeout=timeout, **without_none(fields))

    async def list_rooms(self, *, timeout: float | None = CLIENTS) -> ListRoomsResult:
        """The rooms of the server."""
        return await self.request("list_rooms", timeout=timeout)

    async def close_room(self, name: str, *, timeout: float | None = CLIENTS) -> CloseRoomResult:
        """Closes a room and the connections of its viewers; the default one stays.

        name: lower-case letters, digits and hyphens; 1 to 32 characters
        """
        fields = {"name": name}
        return await self.request("close_room", timeout=timeout, **without_none(fields))

    async def fork(self, name: str, *, paused: bool | None = None, timeout: float | None = CLIENTS) -> ForkResult:
        """Opens a room that is like this one at this moment; its address ends in `/ws/name`.

        name: lower-case letters, digits and hyphens; 1 to 32 characters
        paused: whether it begins so; by default as this room is; true or false
        """
        fields = {"name": name, "paused": paused}
        return await self.request("fork", timeout=timeout, **without_none(fields))

    async def policy(
        self, policy: Literal["watch", "one_hand", "everybody"], *, timeout: float | None = CLIENTS,
    ) -> PolicyResult:  # fmt: skip
        """Says who may hold the cloth. (policy: who may hold the cloth; watch or one_hand or everybody)"""
        fields = {"policy": policy}
        return await self.request("policy", timeout=timeout, **without_none(fields))

    async def mute(self, viewer: int, *, muted: bool | None = None, timeout: float | None = CLIENTS) -> MuteResult:
        """Takes the right to hold from a viewer, whatever the policy.

        viewer: whose hands let go; 0 to 4294967295
        muted: false: the policy holds for it again; true or false
        """
        fields = {"viewer": viewer, "muted": muted}
        return await self.request("mute", timeout=timeout, **without_none(fields))

    async def give_hand(
        self, viewer: int, *, given: bool | None = None, timeout: float | None = CLIENTS,
    ) -> GiveHandResult:  # fmt: skip
        """Gives a viewer the right to hold, whatever the policy.

        viewer: that may hold; 0 to 4294967295
        given: false: the policy holds for it again; true or false
        """
        fields = {"viewer": viewer, "given": given}
        return await self.request("give_hand", timeout=timeout, **without_none(fields))

    async def presence(
        self, *, cursor: Iterable[float] | None = None, away: bool | None = None, camera: Camera | None = None,
        timeout: float | None = CLIENTS,
    ) -> PresenceResult:  # fmt: skip
        """Tells others where this viewer points and looks.

        cursor: what it points at [m]; 3 × ±10000
        away: it points at nothing any more; true or false
        camera: where it looks from
        """
        fields = {"cursor": listed(cursor), "away": away, "camera": known(Camera, "camera", camera)}
        return await self.request("presence", timeout=timeout, **without_none(fields))

    async def follow(self, viewer: int, *, timeout: float | None = CLIENTS) -> FollowResult:
        """Sees by the camera of another viewer; 0: by its own again.

        viewer: by whose camera it sees; 0: its own again; 0 to 4294967295
        """
        fields = {"viewer": viewer}
        return await self.request("follow", timeout=timeout, **without_none(fields))

    async def lead(self, on: bool = True, *, timeout: float | None = CLIENTS) -> LeadResult:
        """Brings all viewers to this one's camera.

        on: false: those that follow its sender see by their own again; true or false
        """
        fields = {"on": on}
        return await self.request("lead", timeout=timeout, **without_none(fields))

    async def invite(
        self, right: Literal["look", "hold", "operate"], *, timeout: float | None = CLIENTS,
    ) -> InviteResult:  # fmt: skip
        """Makes a token for a link; the result has it. (right: of who comes by it; look or hold or operate)"""
        fields = {"right": right}
        return await self.request("invite", timeout=timeout, **without_none(fields))
