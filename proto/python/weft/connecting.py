"""Joining a server."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Generator
from typing import Any

from . import packages
from .address import refusal_of, socket_address, token_of
from .client import Client
from .errors import ConnectionLost, ProtocolError
from .timeouts import CALL_SECONDS, CLOSE_SECONDS, GOODBYE_SECONDS, REFUSAL_SECONDS

SUBPROTOCOL = "weft.v1"
MOST_MESSAGE_BYTES = 256 * 2**20


class Connecting:
    """Result of `connect`: gives a client if awaited, and one that closes itself in `async with`."""

    def __init__(self, url: str, hello: dict[str, Any], timeout: float, reconnect: bool, call_timeout: float | None,
                 token: str | None = None):
        self._token = token if token is not None else token_of(url)
        self._url, self._hello, self._timeout, self._reconnect = socket_address(url), hello, timeout, reconnect
        self._call_timeout = call_timeout
        self._client: Client | None = None

    async def _dial(self) -> Any:
        """A socket that speaks weft.v1."""
        if packages.websockets is None:
            raise ImportError("no package `websockets` for this Python: Debian has it as python3-websockets, "
                              "for /usr/bin/python3")
        now = asyncio.get_running_loop().time
        begin = now()
        try:
            socket = await packages.websockets.connect(
                self._url,
                subprotocols=[SUBPROTOCOL],
                compression=None,
                max_size=MOST_MESSAGE_BYTES,
                open_timeout=self._timeout,
                close_timeout=GOODBYE_SECONDS,  # it may not answer that either
            )
        except packages.websockets.InvalidHandshake as error:
            left = REFUSAL_SECONDS if self._timeout is None else max(0.0, begin + self._timeout - now())
            why = await asyncio.to_thread(refusal_of, self._url, min(left, REFUSAL_SECONDS))
            raise ConnectionLost(1006, f"no connection to {self._url}: {why or error}") from error
        except (OSError, asyncio.TimeoutError) as error:  # that of `open_timeout` has no text
            why = str(error) or f"no answer within {self._timeout:g} s"
            raise ConnectionLost(1006, f"no connection to {self._url}: {why}") from error
        if socket.subprotocol != SUBPROTOCOL:
            await socket.close(4002)
            raise ProtocolError(f"the server does not speak {SUBPROTOCOL}")
        if self._token:  # where one is asked for, nothing comes before it
            await socket.send(json.dumps({"op": "hello", "token": self._token}))
        socket.close_timeout = CLOSE_SECONDS if self._timeout is None else min(CLOSE_SECONDS, self._timeout)
        return socket

    async def _connect(self) -> Client:
        begin = asyncio.get_running_loop().time()
        socket = await self._dial()
        self._client = Client(socket, self._dial, self._hello, self._reconnect, self._call_timeout)
        bound = asyncio.timeout_at(None if self._timeout is None else begin + self._timeout)
        try:
            try:
                async with bound:
                    await self._begin(self._client)
            except TimeoutError as error:
                if not bound.expired():
                    raise
                why = f"the server does not begin within {self._timeout:g} s"
                raise ConnectionLost(1006, f"no connection to {self._url}: {why}") from error
        except BaseException:
            socket.close_timeout = GOODBYE_SECONDS
            await self._client.close()
            raise
        return self._client

    async def _begin(self, client: Client) -> None:
        await client._ready()
        if any(self._hello.values()):
            await client.hello(**self._hello)

    def __await__(self) -> Generator[Any, None, Client]:
        return self._connect().__await__()

    async def __aenter__(self) -> Client:
        return await self._connect()

    async def __aexit__(self, *error: object) -> None:
        if self._client is not None:
            await self._client.close()


def connect(
    url: str,
    *,
    name: str | None = None,
    color: str | None = None,
    token: str | None = None,
    timeout: float = 10,
    reconnect: bool = False,
    call_timeout: float | None = CALL_SECONDS,
) -> Connecting:
    """Joins a server: `client = await connect(url)` or `async with connect(url) as client`.

    `url` is that of the socket, ws://HOST:PORT/ws, or of the page, http://HOST:PORT/, as the server prints it.
    `token` is for a server that asks for one; that of a link, http://HOST:PORT/#token=…, is read from there.
    `timeout` [s] bounds joining, `call_timeout` each answer by default; None: no bound.
    """
    return Connecting(url, {"name": name, "color": color}, timeout, reconnect, call_timeout, token)
