"""What one viewer sends again and again, and a mesh of any size, take from the others neither their frames
nor their connection. A foreign client on real sockets; verdicts are on what came for each tick."""

import asyncio
import itertools
import json
import re
import socket
from pathlib import Path

from foreign_client import PATIENCE, SocketTest, main

RATE = 900  # messages a second of the one that floods; the limit is 1,000
TICKS = 45  # for which it does
PART = 64 * 1024
IDLE = 30  # seconds after which the server cuts a download that stands


class Floods(SocketTest):
    options = ("--scene", "curtain")

    async def flood(self, sender, messages, watchers):
        """Sends messages at the rate until every watcher has seen so many ticks pass."""
        begin = [w.frames[-1].tick for w in watchers]
        clock = asyncio.get_running_loop().time
        start, sent = clock(), 0
        while any(w.frames[-1].tick < tick + TICKS for w, tick in zip(watchers, begin)):
            self.assertFalse(any(w.reader.done() for w in (sender, *watchers)), "somebody was closed")
            while sent < RATE * (clock() - start):
                await sender.socket.send(json.dumps(next(messages)))
                sent += 1
            await asyncio.sleep(0.002)
            self.assertLess(clock() - start, 60, "ticks do not go on")
        self.assertGreater(sent, 100)

    async def test_no_tick_comes_twice_and_news_at_most_once_a_tick_whatever_one_viewer_sends(self):
        sender = await self.viewer()
        watchers = [await self.viewer() for _ in range(4)]
        await sender.ask("drag", phase="start", particle=1300)
        for watcher in watchers:
            await watcher.wait_frame(lambda f: True)
        floods = {
            "drag": lambda k: {"op": "drag", "phase": "move", "target": [0, 1 + 0.01 * (k % 5), 0.3]},
            "view": lambda k: {"op": "view", "hz": 240},
            "set": lambda k: {"op": "set", "drag": 1 + k % 3},
            "pin": lambda k: {"op": "pin", "particle": k % 1000},
            "hello": lambda k: {"op": "hello", "name": f"n{k}"},
        }
        for name, message in floods.items():
            with self.subTest(name):
                texts = [len(w.texts) for w in watchers]
                frames = [len(w.frames) for w in watchers]
                ticks = [w.frames[-1].tick for w in watchers]
                await self.flood(sender, map(message, itertools.count()), watchers)
                for w, first_text, first_frame, tick in zip(watchers, texts, frames, ticks):
                    passed = [f.tick for f in w.frames[first_frame:]]
                    self.assertEqual(passed, sorted(set(passed)), "a tick came in two frames")
                    told = [m["op"] for m in w.texts[first_text:]]
                    for op in ("state", "roster", "pins", "grabs"):
                        self.assertLessEqual(told.count(op), passed[-1] - tick + 10, op)
        # In the end everyone knows what holds.
        name = [v["name"] for v in (await sender.ask("query", what="roster"))["data"]]
        for w in watchers:
            await w.wait_text(lambda m: m["op"] == "roster" and [v["name"] for v in m["viewers"]] == name)


class LargeMesh(SocketTest):
    options = ("--paused",)

    async def test_a_mesh_larger_than_any_queue_is_joined_and_loaded_by_everyone(self):
        first = await self.viewer()
        scene = {"cloths": [{"rows": 450, "columns": 450}], "contact": {"self": "none"}}
        loaded = await first.ask("load", scene=scene)
        self.assertEqual(loaded["op"], "result")
        for viewer in (first, await self.viewer(), await self.viewer()):
            frame = await viewer.wait_frame(lambda f: f.epoch == loaded["epoch"])
            self.assertEqual(frame.vertices, 450 * 450)
            mesh = await viewer.wait_text(lambda m: m["op"] == "mesh" and m["epoch"] == loaded["epoch"])
            self.assertGreater(mesh["bytes"], 8 << 20)
            self.assertEqual(len(viewer.binaries[-1]), mesh["bytes"])
            self.assertEqual((await viewer.ask("hash"))["op"], "result")


class Memory(SocketTest):
    options = ("--paused",)

    def memory(self):
        """What the server has of it [bytes]."""
        status = Path(f"/proc/{self.server.process.pid}/status").read_text(encoding="utf-8")
        return 1024 * int(re.search(r"VmRSS:\s*(\d+) kB", status)[1])


class LargeScenes(Memory):
    async def test_most_of_the_memory_of_scenes_that_have_ended_goes_back(self):
        viewer = await self.viewer()
        fabric = {"stretch_warp": 1, "stretch_weft": 1, "shear": 0, "bending_warp": 0, "bending_weft": 0}
        scene = {"cloths": [{"rows": 450, "columns": 440, "width": 20, "height": 20, "fabric": fabric}]}
        before = self.memory()
        for _ in range(2):
            self.assertEqual((await viewer.ask("load", scene=scene))["op"], "result")
            await viewer.ask("save", name="here")
            self.assertEqual((await viewer.ask("fork", name="mine"))["op"], "result")
            most = self.memory()
            await viewer.ask("close_room", name="mine")
            await viewer.ask("load", scene="default")
        deadline = asyncio.get_running_loop().time() + PATIENCE
        while self.memory() - before > (most - before) / 2 and asyncio.get_running_loop().time() < deadline:
            await asyncio.sleep(0.1)
        self.assertLess(self.memory() - before, (most - before) / 2)


class SlowDownloads(Memory):
    COUNT = 30

    def begin(self, url):
        """A download of which its client has read the head alone: that, and the connection."""
        connection = socket.socket()
        self.addCleanup(connection.close)
        connection.settimeout(PATIENCE)
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, PART)
        connection.connect((self.server.addresses["host"], self.server.addresses["port"]))
        connection.sendall(f"GET {url} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
        received = b""
        while b"\r\n\r\n" not in received:
            received += connection.recv(1)
        return received, connection

    async def test_downloads_of_a_mesh_share_its_bytes_and_a_slow_one_that_goes_on_is_not_cut_off(self):
        viewer = await self.viewer()
        scene = {"cloths": [{"rows": 450, "columns": 450}], "contact": {"self": "none"}}
        await viewer.ask("load", scene=scene)
        mesh = await viewer.wait_text(lambda m: m["op"] == "mesh" and m["epoch"] == 2)
        before = self.memory()
        downloads = [self.begin(mesh["url"]) for _ in range(self.COUNT)]
        self.assertLess(self.memory() - before, self.COUNT / 3 * mesh["bytes"])
        head, slow = downloads[0]
        self.assertTrue(head.startswith(b"HTTP/1.1 200"), head)
        loop, body = asyncio.get_running_loop(), b""
        end = loop.time() + IDLE + 3
        while loop.time() < end:
            body += slow.recv(PART // 2)
            await asyncio.sleep(0.5)
        self.assertLess(len(body), mesh["bytes"] - (5 << 20), "more is left than any buffer holds")
        while len(body) < mesh["bytes"] and (part := slow.recv(PART)):
            body += part
        self.assertEqual(body, viewer.binaries[-1])


class LockStep(SocketTest):
    options = ("--paused",)

    async def test_an_advance_gives_its_viewer_the_frames_that_it_asks_for_before_the_result(self):
        a, b = await self.viewer(), await self.viewer()
        await a.wait_frame(lambda f: True)
        await a.ask("view", hz=0)
        tick = 0
        for n, frames, wanted in ((60, "all", 60), (7, "last", 1), (1, "last", 1), (5, "none", 0)):
            seen, order = len(a.frames), len(a.order)
            answer = await a.ask("advance", n=n, frames=frames)
            tick += n
            self.assertEqual(answer["tick"], tick)
            self.assertEqual([f.tick for f in a.frames[seen:]], list(range(tick - wanted + 1, tick + 1)))
            self.assertEqual(a.order[order:].count("frame"), wanted)
        await b.wait_frame(lambda f: f.tick == tick)
        self.assertEqual((await b.ask("advance", n=1, frames="some"))["field"], "frames")

    async def test_an_advance_whose_frames_nobody_reads_ends_and_the_others_go_on(self):
        deaf, other = await self.viewer(), await self.viewer()
        await deaf.tell("advance", n=100000, frames="all")
        await asyncio.sleep(0.1)
        deaf.socket.transport.pause_reading()
        self.assertEqual((await other.ask("hash"))["op"], "result")  # while it still waits
        while (await other.ask("advance", n=1)).get("code") == "busy":
            await asyncio.sleep(0.1)
        deaf.socket.transport.resume_reading()
        error = await deaf.wait_text(lambda m: m["op"] == "error")
        self.assertEqual((error["code"], error["command"]), ("stalled", "advance"))


if __name__ == "__main__":
    main()
