"""A connection to a server, its calls and what the server tells."""

from __future__ import annotations

import asyncio
import json
import random
from collections.abc import Awaitable, Callable
from typing import Any, TypeVar

from . import layout, packages
from .announcement import Grabs, Mesh, Pins, Roster, Welcome
from .binary import decode_binary, encode_ack
from .errors import CallTimeout, CommandError, ConnectionLost, ProtocolError, WeftError
from .fields import text_of, without_none
from .messages import State
from .pace import USUAL_RATE, Pace, pause_before
from .packed import FrameDecoder
from .reading import demand
from .samples import Data, Frame, MeshData
from .timeouts import CALL_SECONDS, CLIENTS, SCENE_SECONDS

Value = TypeVar("Value")

FINAL_CODES = frozenset((1002, 1003, 1007, 1008, 1009, 4003, 4004))  # a new attempt would fail alike


class Session:
    """A connection that is kept: what is sent waits for its turn, answers go to the calls that they are for, and
    what the server tells is kept and told on. `Client` says what its calls mean."""

    def __init__(
        self, socket: Any, dial: Callable[[], Awaitable[Any]], hello: dict[str, Any], reconnect: bool,
        call_timeout: float | None = CALL_SECONDS,
    ):  # fmt: skip
        self._socket, self._dial = socket, dial
        self.call_timeout = call_timeout  # for an answer or a frame [s]; None: no bound
        self._pace, self._turn = Pace(), asyncio.Lock()
        self._hello = without_none(hello)  # repeated after a reconnection
        self._view: dict[str, Any] = {}  # the same
        self._reconnect = reconnect
        self._redial: asyncio.Task[None] | None = None
        self._connections = 1
        self._attempts = 0  # to connect again since the last welcome
        self._waiting: dict[int, asyncio.Future[Any]] = {}
        self._transfers: dict[int, tuple[asyncio.Future[Any], dict[str, Any]]] = {}
        self._listeners: dict[str, list[Callable[[Any], None]]] = {}
        self._kept: set[asyncio.Task[None]] = set()  # tasks of hands
        self._next_id = self._next_drag = 1
        self._changed = asyncio.Condition()
        self._lost: WeftError | None = None  # why there is no connection now
        self._ended = False  # and none will follow
        self.welcome: Welcome | None = None
        # Both are there before anyone gets the client, as `connect` waits for them.
        self.mesh: Mesh = None  # type: ignore[assignment]
        self.mesh_data: MeshData = None  # type: ignore[assignment]
        self._announced: Mesh | None = None  # a mesh whose data is on the way
        self._packed: FrameDecoder | None = None  # of the present mesh
        self.frame: Frame | None = None
        self.state: State | None = None
        self.roster: Roster | None = None
        self.pins: Pins | None = None
        self.grabs: Grabs | None = None
        self._reader = asyncio.create_task(self._read())

    @property
    def viewer(self) -> int:
        """Own number among the viewers; 0 before `welcome`."""
        return self.welcome["viewer"] if self.welcome else 0

    def on(self, name: str, listener: Callable[[Any], None]) -> Callable[[], None]:
        """Calls `listener` with each message of this name (`frame`, `mesh`, `state`, `notice`, …,
        `refused` for errors that answer no call). Returns a function that ends it."""
        listeners = self._listeners.setdefault(name, [])
        listeners.append(listener)
        return lambda: listeners.remove(listener)

    async def close(self) -> None:
        """Leaves the server."""
        self._reconnect = False
        if self._redial is not None:
            self._redial.cancel()
        for task in self._kept:
            task.cancel()
        await asyncio.gather(*self._kept, return_exceptions=True)  # none is left when the loop ends
        await self._socket.close()
        await self._reader

    def _keep(self, task: asyncio.Task[None]) -> None:
        """Ends a task with the client, if it has not ended before."""
        self._kept.add(task)
        task.add_done_callback(self._kept.discard)

    async def request(self, op: str, *, timeout: float | None = CLIENTS, **fields: Any) -> Any:
        """Sends any command and waits for its result."""
        return await self._in_time(op, timeout, self._ask(op, fields))

    async def _ask(self, op: str, fields: dict[str, Any]) -> Any:
        if self._lost:
            raise self._lost
        id_, self._next_id = self._next_id, self._next_id + 1
        answer = asyncio.get_running_loop().create_future()
        self._waiting[id_] = answer
        try:
            await self.post(op, id=id_, **fields)
            return await answer
        finally:
            self._waiting.pop(id_, None)
            if answer.done() and not answer.cancelled():
                answer.exception()  # retrieved, even if sending failed first

    async def _in_time(self, what: str, timeout: float | None, waiting: Awaitable[Value]) -> Value:
        """Its result, or CallTimeout."""
        seconds = SCENE_SECONDS.get(what, self.call_timeout) if timeout is CLIENTS else timeout
        bound = asyncio.timeout(seconds)
        try:
            async with bound:
                return await waiting
        except TimeoutError as error:
            if not bound.expired():
                raise
            raise CallTimeout(what, seconds or 0) from error

    async def post(self, op: str, **fields: Any) -> None:
        """Sends a command without waiting for an answer."""
        if self._lost:
            raise self._lost
        await self._send(op, **fields)

    async def _send(self, op: str, **fields: Any) -> None:
        text = text_of(op, fields)
        socket = self._socket
        async with self._turn:  # so that no message overtakes another
            wait = self._pace.wait_before_next(asyncio.get_running_loop().time())
            if wait > 0:
                await asyncio.sleep(wait)
            if socket is not self._socket:  # a message for the previous connection is dropped
                raise self._lost or ConnectionLost(1006, "the connection was lost before the message was sent")
            try:
                await socket.send(text)
            except packages.websockets.ConnectionClosed as closed:
                raise self._lost or ConnectionLost(1006, str(closed)) from closed

    # --- inside ---

    async def _until(self, condition: Callable[[], bool]) -> None:
        async with self._changed:
            await self._changed.wait_for(lambda: condition() or self._ended)
        if not condition():
            raise self._lost or ConnectionLost(1006, "the connection was closed")

    async def _frame_where(self, holds: Callable[[Frame], bool]) -> Frame:
        """The newest frame once this holds of it."""
        await self._until(lambda: self.frame is not None and holds(self.frame))
        assert self.frame is not None
        return self.frame

    async def _ready(self) -> None:
        """Waits for the messages that a client needs to begin."""
        await self._until(lambda: self.welcome is not None and self.mesh_data is not None)

    async def _read(self) -> None:
        while True:
            lost = await self._read_socket()
            self._lose(lost)
            if not self._reconnect or self._is_final(lost):
                break
            try:
                self._redial = asyncio.ensure_future(self._join_again())
                await self._redial
            except asyncio.CancelledError:
                break
            except ProtocolError as error:  # another program answers there now
                self._lost = error
                break
            # A dial that ends at the moment of its cancellation may swallow the cancellation.
            if not self._reconnect:
                break
        await self._socket.close()
        self._ended = True
        self._tell("status", {"phase": "closed", **self._why()})
        async with self._changed:
            self._changed.notify_all()

    @staticmethod
    def _is_final(lost: WeftError) -> bool:
        return isinstance(lost, ConnectionLost) and lost.code in FINAL_CODES

    def _why(self) -> dict[str, Any]:
        lost = self._lost
        if isinstance(lost, ConnectionLost):
            return {"code": lost.code, "reason": lost.reason}
        return {"code": 4002, "reason": str(lost)}

    def _lose(self, lost: WeftError) -> None:
        """Notes the loss of the connection."""
        self._lost, self.welcome = lost, None
        self._transfers.clear()
        for answer in self._waiting.values():
            if not answer.done():
                answer.set_exception(lost)

    async def _join_again(self) -> None:
        while self._reconnect:
            pause = pause_before(self._attempts, random.random())
            self._attempts += 1
            self._tell("status", {"phase": "waiting", **self._why(), "retry_in": pause})
            await asyncio.sleep(pause)
            try:
                self._socket = await self._dial()
                self._connections += 1
                self._pace = Pace()
                if self._hello:
                    await self._send("hello", **self._hello)
                if self._view:
                    await self._send("view", **self._view)
                return
            except ConnectionLost as lost:
                self._lost = lost

    async def _read_socket(self) -> WeftError:
        """Reads until the connection ends; returns why it did."""
        fault = None
        try:
            async for message in self._socket:
                await self._take(message)
        except packages.websockets.ConnectionClosed:
            pass  # the close code below tells why
        except ProtocolError as error:
            fault = error
        except (AttributeError, IndexError, KeyError, TypeError) as error:
            fault = ProtocolError(f"a message is not as it must be: {error!r}")
        if fault:
            await self._socket.close(4002, str(fault)[:100])
        code, reason = self._socket.close_code, self._socket.close_reason
        return fault or ConnectionLost(code or 1006, reason or "connection lost")

    async def _take(self, message: str | bytes) -> None:
        if isinstance(message, str):
            name, value = self._take_text(message)
        else:
            name, value = await self._take_binary(message)
        self._tell(name, value)
        if name == "welcome":
            self._tell("status", {"phase": "open"})
        async with self._changed:
            self._changed.notify_all()

    def _tell(self, name: str, value: Any) -> None:
        for listener in list(self._listeners.get(name, ())):
            try:
                listener(value)
            except Exception as error:  # thrown by a listener
                context = {"message": f"a listener of {name} failed", "exception": error}
                asyncio.get_running_loop().call_exception_handler(context)

    def _take_text(self, text: str) -> tuple[str, Any]:
        try:
            message = json.loads(text)
        except ValueError as error:
            raise ProtocolError("a text message is not JSON") from error
        demand(isinstance(message, dict), "a text message is no object")
        op = message.get("op", "")
        if op == "mesh":
            self._announced = message
            return "", None  # reported when its data has arrived
        if op == "result":
            return self._answer(message)
        if op == "error":
            return self._refuse(message)
        if op in ("welcome", "state", "roster", "pins", "grabs"):
            setattr(self, op, message)
        if op == "welcome":
            self._lost, self._attempts = None, 0
            limit = message.get("limits", {}).get("messages_per_second") or USUAL_RATE
            self._pace.set_limit(limit, asyncio.get_running_loop().time())
        return op, message

    def _answer(self, message: dict[str, Any]) -> tuple[str, Any]:
        answer = self._waiting.get(message.get("id", 0))
        if answer is not None and not answer.done():
            if "binary" in message:
                self._transfers[message["binary"]["transfer"]] = (answer, message)
            else:
                answer.set_result(message)
        return "result", message

    def _refuse(self, message: dict[str, Any]) -> tuple[str, Any]:
        answer, error = self._waiting.get(message.get("id", 0)), CommandError(message)
        if answer is None or answer.done():
            return "refused", error
        answer.set_exception(error)
        return "error", error

    async def _take_binary(self, content: bytes) -> tuple[str, Any]:
        message = self._decode(content)
        if isinstance(message, Data):
            answer, result = self._transfers.pop(message.transfer, (None, {}))
            if answer is not None and not answer.done():
                answer.set_result({**result, "data": message})
            return "data", message
        if isinstance(message, MeshData):
            self.mesh, self.mesh_data = self._fitting(message), message
            self._announced = self._packed = None
            return "mesh", message
        if not message.observed:
            await self._socket.send(encode_ack(message.sequence))
        if self.mesh is None or self.mesh["epoch"] != message.epoch:
            return "", None  # of another mesh
        demand(len(message.positions) == self.mesh["vertices"], "the frame does not fit the mesh")
        self.frame = message
        return "frame", message

    def _decode(self, content: bytes) -> Frame | MeshData | Data:
        packed = content[:1] == bytes([layout.FRAME]) and content[2:3] == bytes([layout.PACKED])
        if not packed or self.mesh is None:
            return decode_binary(content)
        if self._packed is None:  # now that one is needed: making it takes a while
            self._packed = FrameDecoder(self.mesh["cloths"], self.mesh_data)
        return self._packed.decode(content)

    def _fitting(self, data: MeshData) -> Mesh:
        """The message that announced a mesh."""
        mesh = self._announced
        if mesh is None:
            raise ProtocolError("a mesh came unannounced")
        kinds = [collider["kind"] for collider in mesh["colliders"]]
        fits = (
            len(data.rest_positions) == mesh["vertices"]
            and len(data.triangles) == mesh["triangles"]
            and [c.collider for c in data.colliders]
            == [i for i, kind in enumerate(kinds) if kind == "mesh"]
        )
        demand(fits, "the mesh is not the one announced")
        return mesh
