"""The calls of `Client`, blocking. Written by proto/generate.py from the asynchronous ones."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Literal, overload

from .client import Observation
from .fields import Hold
from .messages import (
    Camera, ColliderPose, Contact, Crossings, Energy, EnergyBalance, Fabric, Fan, Grab, GripperState, Pin, Reactions,
    StageWork, State, Strain, Tree, Viewer,
)  # fmt: skip
from .queries import Binary, ViewerCamera
from .results import (
    AdvanceResult, CameraResult, CloseRoomResult, CreateRoomResult, FollowResult, ForkResult, GiveHandResult,
    GripperResult, HelloResult, InviteResult, LeadResult, ListRoomsResult, LoadResult, MoveResult1, MoveResult2,
    MuteResult, PauseResult, PinResult, PolicyResult, PresenceResult, ReleaseResult, ResetResult, RestoreResult,
    ResumeResult, SaveResult, SetResult, SpeedResult, StepResult, ViewResult,
)  # fmt: skip
from .runner import Runner
from .samples import Data, Frame, Hit
from .timeouts import CLIENTS


class BlockingCommands(Runner):
    """What `Client` does, without waiting in the caller."""

    def camera(
        self, position: Iterable[float], target: Iterable[float], *, up: Iterable[float] | None = None,
        fov: float | None = None, timeout: float | None = CLIENTS,
    ) -> CameraResult:  # fmt: skip
        """Stores where this viewer looks from, so that others may follow.

        position: of the eye [m]; 3 × ±10000
        target: what it looks at; not the same point [m]; 3 × ±10000
        up: a direction; 3 × ±10000
        fov: vertical angle of view [degrees]; 1 to 179
        """
        return self._run(self._client.camera(position, target, up=up, fov=fov, timeout=timeout))

    def pause(self, *, timeout: float | None = CLIENTS) -> PauseResult:
        """Stops the room's clock."""
        return self._run(self._client.pause(timeout=timeout))

    def resume(self, *, timeout: float | None = CLIENTS) -> ResumeResult:
        """Lets the room's clock run."""
        return self._run(self._client.resume(timeout=timeout))

    def step(self, n: int = 1, *, timeout: float | None = CLIENTS) -> StepResult:
        """Lets ticks pass in a paused room. (n: ticks; 1 to 600)"""
        return self._run(self._client.step(n, timeout=timeout))

    def reset(self, *, timeout: float | None = CLIENTS) -> ResetResult:
        """Back to the scene's start."""
        return self._run(self._client.reset(timeout=timeout))

    def save(self, name: str, *, timeout: float | None = CLIENTS) -> SaveResult:
        """Keeps the present state in memory, in place of an earlier one of this name.

        name: lower-case letters, digits and hyphens; 1 to 32 characters
        """
        return self._run(self._client.save(name, timeout=timeout))

    def restore(self, name: str, *, timeout: float | None = CLIENTS) -> RestoreResult:
        """Back to a state that was saved. (name: lower-case letters, digits and hyphens; 1 to 32 characters)"""
        return self._run(self._client.restore(name, timeout=timeout))

    def speed(self, speed: float, *, timeout: float | None = CLIENTS) -> SpeedResult:
        """Sets how fast time passes. (speed: simulated per real time; 0.01 to 10)"""
        return self._run(self._client.speed(speed, timeout=timeout))

    def gripper(
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
        call = self._client.gripper(
            name, opening=opening, force=force, position=position, rotation=rotation, speed=speed,
            turn_speed=turn_speed, timeout=timeout,
        )  # fmt: skip
        return self._run(call)

    def set(
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
        call = self._client.set(
            gravity=gravity, wind=wind, gust_speed=gust_speed, gust_length=gust_length, air_density=air_density,
            still_air=still_air, drag=drag, fans=fans, softness=softness, budget_ms=budget_ms,
            over_budget=over_budget, fabric=fabric, cloth=cloth, timeout=timeout,
        )  # fmt: skip
        return self._run(call)

    def create_room(
        self, name: str, *, scene: str | None = None, paused: bool | None = None, timeout: float | None = CLIENTS,
    ) -> CreateRoomResult:  # fmt: skip
        """Opens a room beside this one; its address ends in `/ws/name`.

        name: lower-case letters, digits and hyphens; 1 to 32 characters
        scene: its name; by default that with which the server was started; 1 to 64 characters
        paused: it begins paused; true or false
        """
        return self._run(self._client.create_room(name, scene=scene, paused=paused, timeout=timeout))

    def list_rooms(self, *, timeout: float | None = CLIENTS) -> ListRoomsResult:
        """The rooms of the server."""
        return self._run(self._client.list_rooms(timeout=timeout))

    def close_room(self, name: str, *, timeout: float | None = CLIENTS) -> CloseRoomResult:
        """Closes a room and the connections of its viewers; the default one stays.

        name: lower-case letters, digits and hyphens; 1 to 32 characters
        """
        return self._run(self._client.close_room(name, timeout=timeout))

    def fork(self, name: str, *, paused: bool | None = None, timeout: float | None = CLIENTS) -> ForkResult:
        """Opens a room that is like this one at this moment; its address ends in `/ws/name`.

        name: lower-case letters, digits and hyphens; 1 to 32 characters
        paused: whether it begins so; by default as this room is; true or false
        """
        return self._run(self._client.fork(name, paused=paused, timeout=timeout))

    def policy(
        self, policy: Literal["watch", "one_hand", "everybody"], *, timeout: float | None = CLIENTS,
    ) -> PolicyResult:  # fmt: skip
        """Says who may hold the cloth. (policy: who may hold the cloth; watch or one_hand or everybody)"""
        return self._run(self._client.policy(policy, timeout=timeout))

    def mute(self, viewer: int, *, muted: bool | None = None, timeout: float | None = CLIENTS) -> MuteResult:
        """Takes the right to hold from a viewer, whatever the policy.

        viewer: whose hands let go; 0 to 4294967295
        muted: false: the policy holds for it again; true or false
        """
        return self._run(self._client.mute(viewer, muted=muted, timeout=timeout))

    def give_hand(self, viewer: int, *, given: bool | None = None, timeout: float | None = CLIENTS) -> GiveHandResult:
        """Gives a viewer the right to hold, whatever the policy.

        viewer: that may hold; 0 to 4294967295
        given: false: the policy holds for it again; true or false
        """
        return self._run(self._client.give_hand(viewer, given=given, timeout=timeout))

    def presence(
        self, *, cursor: Iterable[float] | None = None, away: bool | None = None, camera: Camera | None = None,
        timeout: float | None = CLIENTS,
    ) -> PresenceResult:  # fmt: skip
        """Tells others where this viewer points and looks.

        cursor: what it points at [m]; 3 × ±10000
        away: it points at nothing any more; true or false
        camera: where it looks from
        """
        return self._run(self._client.presence(cursor=cursor, away=away, camera=camera, timeout=timeout))

    def follow(self, viewer: int, *, timeout: float | None = CLIENTS) -> FollowResult:
        """Sees by the camera of another viewer; 0: by its own again.

        viewer: by whose camera it sees; 0: its own again; 0 to 4294967295
        """
        return self._run(self._client.follow(viewer, timeout=timeout))

    def lead(self, on: bool = True, *, timeout: float | None = CLIENTS) -> LeadResult:
        """Brings all viewers to this one's camera.

        on: false: those that follow its sender see by their own again; true or false
        """
        return self._run(self._client.lead(on, timeout=timeout))

    def invite(self, right: Literal["look", "hold", "operate"], *, timeout: float | None = CLIENTS) -> InviteResult:
        """Makes a token for a link; the result has it. (right: of who comes by it; look or hold or operate)"""
        return self._run(self._client.invite(right, timeout=timeout))

    def request(self, op: str, *, timeout: float | None = CLIENTS, **fields: Any) -> Any:
        """Sends any command and waits for its result."""
        return self._run(self._client.request(op, timeout=timeout, **fields))

    def post(self, op: str, **fields: Any) -> None:
        """Sends a command without waiting for an answer."""
        return self._run(self._client.post(op, **fields))

    @overload
    def query(
        self, what: Literal["positions", "velocities"], *, format: Binary, timeout: float | None = CLIENTS,
    ) -> Data: ...  # fmt: skip

    @overload
    def query(
        self, what: Literal["positions", "velocities"], *, format: Literal["json"] | None = None,
        timeout: float | None = CLIENTS,
    ) -> list[list[float]]: ...  # fmt: skip

    @overload
    def query(
        self, what: Literal["boxes"], *, tree: str, level: int | None = None, format: Binary,
        timeout: float | None = CLIENTS,
    ) -> Data: ...  # fmt: skip

    @overload
    def query(
        self, what: Literal["boxes"], *, tree: str, level: int | None = None, format: Literal["json"] | None = None,
        timeout: float | None = CLIENTS,
    ) -> list[list[float]]: ...  # fmt: skip

    @overload
    def query(self, what: Literal["energies"], *, timeout: float | None = CLIENTS) -> Energy: ...

    @overload
    def query(self, what: Literal["strain"], *, timeout: float | None = CLIENTS) -> Strain: ...

    @overload
    def query(self, what: Literal["pins"], *, timeout: float | None = CLIENTS) -> list[Pin]: ...

    @overload
    def query(self, what: Literal["grabs"], *, timeout: float | None = CLIENTS) -> list[Grab]: ...

    @overload
    def query(
        self, what: Literal["camera"], *, viewer: int | None = None, timeout: float | None = CLIENTS,
    ) -> list[ViewerCamera]: ...  # fmt: skip

    @overload
    def query(self, what: Literal["roster"], *, timeout: float | None = CLIENTS) -> list[Viewer]: ...

    @overload
    def query(self, what: Literal["state"], *, timeout: float | None = CLIENTS) -> State: ...

    @overload
    def query(self, what: Literal["work"], *, timeout: float | None = CLIENTS) -> list[StageWork]: ...

    @overload
    def query(self, what: Literal["trees"], *, timeout: float | None = CLIENTS) -> list[Tree]: ...

    @overload
    def query(self, what: Literal["colliders"], *, timeout: float | None = CLIENTS) -> list[ColliderPose]: ...

    @overload
    def query(self, what: Literal["measurements"], *, timeout: float | None = CLIENTS) -> dict[str, float]: ...

    @overload
    def query(self, what: Literal["contacts"], *, timeout: float | None = CLIENTS) -> list[Contact]: ...

    @overload
    def query(self, what: Literal["reactions"], *, timeout: float | None = CLIENTS) -> Reactions: ...

    @overload
    def query(self, what: Literal["grippers"], *, timeout: float | None = CLIENTS) -> list[GripperState]: ...

    @overload
    def query(self, what: Literal["crossings"], *, timeout: float | None = CLIENTS) -> Crossings: ...

    @overload
    def query(self, what: Literal["balance"], *, timeout: float | None = CLIENTS) -> EnergyBalance: ...

    def query(
        self, what: str, *, format: str | None = None, viewer: int | None = None, tree: str | None = None,
        level: int | None = None, timeout: float | None = CLIENTS,
    ) -> Any:  # fmt: skip
        """The data of a query; a `Data` if the format is "f32" or "f64"."""
        wanted: Any = self._client.query
        return self._run(wanted(what, format=format, viewer=viewer, tree=tree, level=level, timeout=timeout))

    def until_asleep(self, *, timeout: float | None = None) -> None:
        """Waits until all cloths sleep, in a running room whose scene lets them (`sleep.after`)."""
        return self._run(self._client.until_asleep(timeout=timeout))

    def hello(
        self, *, name: str | None = None, color: str | None = None, timeout: float | None = CLIENTS,
    ) -> HelloResult:  # fmt: skip
        """Name and colour ("#rrggbb") of this viewer."""
        return self._run(self._client.hello(name=name, color=color, timeout=timeout))

    def pick(
        self, origin: Iterable[float], direction: Iterable[float], *, timeout: float | None = CLIENTS,
    ) -> Hit | None:  # fmt: skip
        """The point where a ray meets the cloth."""
        return self._run(self._client.pick(origin, direction, timeout=timeout))

    def pin(self, hold: Hold, *, radius: float | None = None, timeout: float | None = CLIENTS) -> PinResult:
        """Fixes a disc of the fabric of some radius [m] where it is now."""
        return self._run(self._client.pin(hold, radius=radius, timeout=timeout))

    def release(
        self, *, pin: int | None = None, particle: int | None = None, all: Literal[True] | None = None,
        timeout: float | None = CLIENTS,
    ) -> ReleaseResult:  # fmt: skip
        """Removes one pin, those of a particle, or all."""
        return self._run(self._client.release(pin=pin, particle=particle, all=all, timeout=timeout))

    def move(
        self, what: str | int | Mapping[str, int], position: Iterable[float] | None = None,
        rotation: Iterable[float] | None = None, *, speed: float | None = None, turn_speed: float | None = None,
        force: bool | None = None, release: Literal[True] | None = None, seconds: float | None = None,
        max_force: float | None = None, stop: Literal[True] | None = None, timeout: float | None = CLIENTS,
    ) -> MoveResult1 | MoveResult2:  # fmt: skip
        """Sends a collider, by its name or as {"collider": its place in the list of the mesh message}, to a
        pose at bounded speed, or back to its keyframes (release=True);
        or a pin, by its id, to a position, at bounded speed or within some seconds, or fixes it where it is
        on its way (stop=True).
        """
        call = self._client.move(
            what, position, rotation, speed=speed, turn_speed=turn_speed, force=force, release=release,
            seconds=seconds, max_force=max_force, stop=stop, timeout=timeout,
        )  # fmt: skip
        return self._run(call)

    @overload
    def advance(
        self, n: int, *, frames: Literal["none", "last", "all"] | None = "last", observe: None = None,
        timeout: float | None = CLIENTS,
    ) -> AdvanceResult: ...  # fmt: skip

    @overload
    def advance(
        self, n: int, *, frames: Literal["none", "last", "all"] | None = "last", observe: Iterable[str],
        timeout: float | None = CLIENTS,
    ) -> Observation: ...  # fmt: skip

    def advance(
        self, n: int, *, frames: str | None = "last", observe: Iterable[str] | None = None,
        timeout: float | None = CLIENTS,
    ) -> Any:  # fmt: skip
        """Runs n ticks as fast as possible; the room must be paused. Result: tick and hash.

        `frames` says which of its frames this viewer gets, regardless of its `hz`: "last", "all" or "none".
        They arrive before the result, so that with the first two `frame` is then the last tick's. With None
        they are those that its `hz` allows, and that of the last tick may come after the result. `observe`
        lists what else to tell of the last tick ("velocities", "contacts", "reactions", "grippers"):
        `observation` of the result is its frame with them.
        """
        wanted: Any = self._client.advance
        return self._run(wanted(n, frames=frames, observe=observe, timeout=timeout))

    def hash(self, *, timeout: float | None = CLIENTS) -> str:
        """Hash of all that decides the future of the scene."""
        return self._run(self._client.hash(timeout=timeout))

    def load(self, scene: str | Mapping[str, Any], *, timeout: float | None = CLIENTS) -> LoadResult:
        """Replaces the scene, by its name or by a whole scene as a dict."""
        return self._run(self._client.load(scene, timeout=timeout))

    def view(
        self, *, hz: float | None = None, codec: Literal["f32", "packed"] | None = None, error: float | None = None,
        forces: bool | None = None, timeout: float | None = CLIENTS,
    ) -> ViewResult:  # fmt: skip
        """What frames are sent. With codec="packed" they take about a byte a vertex, off by at most `error` [m]
        (1e-4), and some time to decode in Python.
        """
        return self._run(self._client.view(hz=hz, codec=codec, error=error, forces=forces, timeout=timeout))

    def ping(self, *, timeout: float | None = CLIENTS) -> tuple[float, float]:
        """Round trip, and the server's clock minus this client's [s]."""
        return self._run(self._client.ping(timeout=timeout))

    def next_frame(self, *, timeout: float | None = CLIENTS) -> Frame:
        """The next frame; none is sent while nothing changes: all cloths sleep, or the room is paused."""
        return self._run(self._client.next_frame(timeout=timeout))

    def frame_at(self, tick: int, *, timeout: float | None = CLIENTS) -> Frame:
        """The first frame from now on whose tick is at least this one."""
        return self._run(self._client.frame_at(tick, timeout=timeout))
