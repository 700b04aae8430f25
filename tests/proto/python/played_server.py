"""A server of weft.v1 that a test plays: it answers as it is told and keeps what it heard."""

import asyncio
import json

import websockets

import golden

EXAMPLES = golden.examples()


def example(op, command=None):
    return next(
        m for m in EXAMPLES if m.get("op") == op and command in (None, m.get("command"))
    )


WELCOME = example("welcome")
GRID = {
    "op": "mesh", "epoch": 1, "scene": "grid", "hash": "00", "url": "/api/v1/mesh/00",
    "bytes": 224, "vertices": 6, "triangles": 4, "cloths": [], "colliders": [],
}


class PlayedServer:
    """Listens on loopback at a port that is free.

    `answers` gives for an op the messages that answer it: dicts (which get op, id and command where
    they lack them) or bytes; by default an empty result.
    """

    def __init__(self, welcome=(WELCOME, GRID, golden.read("mesh_grid.bin")), subprotocols=("weft.v1",),
                 port=0):
        self.first, self.subprotocols, self.port = welcome, subprotocols, port
        self.answers, self.heard, self.acks = {}, [], []
        self.socket = None
        self._news = asyncio.Condition()

    async def __aenter__(self):
        self._server = await websockets.serve(
            self._serve, "127.0.0.1", self.port, subprotocols=self.subprotocols, compression=None
        )
        self.url = f"ws://127.0.0.1:{self._server.sockets[0].getsockname()[1]}/ws"
        return self

    async def __aexit__(self, *error):
        self._server.close()
        await self._server.wait_closed()

    async def say(self, *messages):
        for message in messages:
            text = isinstance(message, (bytes, str))
            await self.socket.send(message if text else json.dumps(message))

    def of(self, op):
        """What was heard with this op."""
        return [message for message in self.heard if message["op"] == op]

    async def until(self, condition):
        async with self._news:
            await asyncio.wait_for(self._news.wait_for(condition), 20)

    async def _serve(self, socket):
        self.socket = socket
        try:
            await self._talk(socket)
        except websockets.ConnectionClosed:
            pass  # as the test wanted it

    async def _talk(self, socket):
        await self.say(*self.first)
        async for message in socket:
            if isinstance(message, bytes):
                self.acks.append(message)
            else:
                self.heard.append(json.loads(message))
                await self._answer(self.heard[-1])
            async with self._news:
                self._news.notify_all()

    async def _answer(self, command):
        for answer in self.answers.get(command["op"], [{}]):
            if isinstance(answer, dict) and "id" in command:
                answer = {"op": "result", "id": command["id"], "command": command["op"], **answer}
            if answer:
                await self.say(answer)
