"""What the socket tests share: the program under test on a free port of loopback, and a client written
from proto/README.md alone on top of the plain `websockets` package."""

import asyncio
import contextlib
import itertools
import json
import os
import signal
import struct
import subprocess
import sys
import unittest
import urllib.request

import websockets

PROGRAM = os.environ.get("WEFT_PROGRAM", "")
PATIENCE = 20  # seconds until a missing message fails a test; no verdict depends on it


class Server:
    """Runs `weft serve` and stops it. It also stops by itself after two minutes."""

    def __init__(self, *options):
        self.process = subprocess.Popen(
            [PROGRAM, "serve", "--port", "0", "--max-seconds", "120", "--log-level", "error", *options],
            stdout=subprocess.PIPE, text=True)
        self.addresses = json.loads(self.process.stdout.readline())
        self.url = self.addresses["url"]
        self.websocket = self.addresses["websocket"]

    def stop(self):
        """Asks the program to stop and returns its exit code."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(timeout=PATIENCE)
        self.process.stdout.close()
        return code

    def get(self, path):
        """Status, headers and body of a plain HTTP request."""
        try:
            with urllib.request.urlopen(self.url + path.lstrip("/"), timeout=PATIENCE) as answer:
                return answer.status, answer.headers, answer.read()
        except urllib.error.HTTPError as error:
            with error:
                return error.code, error.headers, error.read()


def checksum(message):
    """The two sums of a binary message as README section 6 defines them."""
    words = list(struct.unpack(f"<{len(message) // 4}I", message))
    words[2] = words[3] = 0
    a = sum(words) % 2**32
    b = sum(j * w for j, w in enumerate(words, 1)) % 2**32
    return a, b


class Frame:
    def __init__(self, message):
        self.flags = message[3]
        self.sums = struct.unpack_from("<II", message, 8)
        assert self.sums == checksum(message), "wrong checksum"
        assert struct.unpack_from("<I", message, 4)[0] == len(message)
        (self.tick, self.time, self.server_time, self.sequence, self.reference, self.epoch,
         self.vertices, self.step, sections) = struct.unpack_from("<QddIIIIfI", message, 16)
        self.positions, self.grabs, self.applied = [], [], {}
        offset = 64
        for _ in range(sections):
            kind, _, length = struct.unpack_from("<HHI", message, offset)
            payload = message[offset + 8:offset + 8 + length]
            if kind == 1:
                self.positions = list(struct.iter_unpack("<fff", payload))
                self.position_bytes = payload
            elif kind == 2:
                self.grabs = list(struct.iter_unpack("<IIfffffff", payload))
            elif kind == 3:
                self.applied = dict(struct.iter_unpack("<II", payload))
            offset += 8 + (length + 7) // 8 * 8
        assert offset == len(message)


class Viewer:
    """One connection. Messages are kept in the order of arrival until somebody waits for them."""

    def __init__(self, socket, acknowledge):
        self.socket = socket
        self.acknowledge = acknowledge
        self.texts, self.frames, self.binaries = [], [], []
        self.order = []
        self.ids = itertools.count(1)
        self.changed = asyncio.Condition()
        self.reader = asyncio.ensure_future(self._read())

    @classmethod
    async def open(cls, server, acknowledge=True, query="", **options):
        socket = await websockets.connect(server.websocket + query, subprotocols=["weft.v1"],
                                          compression=None, max_size=None, ping_interval=None,
                                          **options)
        viewer = cls(socket, acknowledge)
        viewer.welcome = await viewer.wait_text(lambda m: m["op"] == "welcome")
        viewer.id = viewer.welcome["viewer"]
        return viewer

    async def _read(self):
        try:
            async for message in self.socket:
                await self._take(message)
        except websockets.ConnectionClosed:
            pass
        async with self.changed:
            self.changed.notify_all()

    async def _take(self, message):
        if isinstance(message, str):
            self.texts.append(json.loads(message))
            self.order.append(self.texts[-1]["op"])
        elif message[0] == 1:
            self.frames.append(Frame(message))
            self.order.append("frame")
            if self.acknowledge:
                # The server may be closing already; what it said before that is still to be read.
                with contextlib.suppress(websockets.ConnectionClosed):
                    await self.ack(self.frames[-1].sequence)
        else:
            self.binaries.append(message)
            self.order.append({2: "mesh data", 3: "data"}[message[0]])
        async with self.changed:
            self.changed.notify_all()

    async def ack(self, sequence):
        await self.socket.send(struct.pack("<BBHI", 4, 1, 0, sequence))

    async def _wait(self, find, what):
        async def poll():
            async with self.changed:
                while True:
                    found = find()
                    if found is not None:
                        return found
                    if self.reader.done():
                        raise ConnectionError(f"closed while waiting for {what}")
                    await self.changed.wait()
        return await asyncio.wait_for(poll(), PATIENCE)

    async def wait_text(self, wanted, after=0):
        return await self._wait(
            lambda: next((m for m in self.texts[after:] if wanted(m)), None), "text")

    async def wait_frame(self, wanted, after=0):
        return await self._wait(
            lambda: next((f for f in self.frames[after:] if wanted(f)), None), "frame")

    async def wait_binary(self, count):
        await self._wait(lambda: True if len(self.binaries) >= count else None, "binary")
        return self.binaries[count - 1]

    async def wait_closed(self):
        await asyncio.wait_for(self.reader, PATIENCE)
        return self.socket.close_code

    async def ask(self, op, **fields):
        """Sends a command and returns its result or error."""
        number = f"q{next(self.ids)}"
        await self.socket.send(json.dumps({"op": op, "id": number, **fields}))
        return await self.wait_text(lambda m: m.get("id") == number)

    async def tell(self, op, **fields):
        await self.socket.send(json.dumps({"op": op, **fields}))

    async def positions(self):
        return (await self.ask("query", what="positions"))["data"]

    async def close(self):
        await self.socket.close()
        await self.wait_closed()


class SocketTest(unittest.IsolatedAsyncioTestCase):
    """Starts the server with `options` for each test and checks that it ends cleanly."""

    options = ()

    def setUp(self):
        self.server = Server(*self.options)

    async def asyncTearDown(self):
        # Off the loop, so that clients can answer the server's goodbye.
        code = await asyncio.get_running_loop().run_in_executor(None, self.server.stop)
        self.assertEqual(code, 0, "the server ends with code 0")

    async def viewer(self, *arguments, **fields):
        viewer = await Viewer.open(self.server, *arguments, **fields)

        async def end():
            await viewer.socket.close()
            await asyncio.wait({viewer.reader}, timeout=PATIENCE)
        self.addAsyncCleanup(end)
        return viewer


def main():
    if not PROGRAM:
        sys.exit("WEFT_PROGRAM names no program")
    unittest.main(verbosity=2)
