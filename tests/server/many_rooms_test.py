"""Rooms of one server: each has its own cloth, clock and viewers. A foreign client on real sockets."""

import asyncio
import contextlib
import json
import os
import socket

import websockets

from foreign_client import PATIENCE, Server, SocketTest, Viewer, main


class ManyRooms(SocketTest):
    options = ("--scene", "curtain", "--rooms", "4")

    async def enter(self, room):
        viewer = await Viewer.open(self.server, query=f"/{room}")
        self.addAsyncCleanup(viewer.socket.close)
        return viewer

    async def test_a_room_is_created_listed_entered_and_closed(self):
        viewer = await self.viewer()
        self.assertEqual(viewer.welcome["room"], "default")
        self.assertIn("rooms", viewer.welcome["capabilities"])
        made = await viewer.ask("create_room", name="class-7", scene="flag")
        self.assertEqual(made["op"], "result", made)
        self.assertEqual((made["room"]["name"], made["room"]["scene"]), ("class-7", "flag"))
        inside = await self.enter("class-7")
        self.assertEqual((inside.welcome["room"], inside.welcome["scene"]), ("class-7", "flag"))
        await inside.wait_frame(lambda f: f.tick > 3)
        listed = await viewer.ask("list_rooms")
        self.assertEqual([room["name"] for room in listed["rooms"]], ["class-7", "default"])
        self.assertEqual([room["viewers"] for room in listed["rooms"]], [1, 1])
        self.assertEqual(listed["most"], 4)
        self.assertEqual(json.loads(self.server.get("/api/v1/rooms")[2])["rooms"][0]["name"], "class-7")
        closed = await viewer.ask("close_room", name="class-7")
        self.assertEqual((closed["op"], closed["name"]), ("result", "class-7"))
        bye = await inside.wait_text(lambda m: m["op"] == "bye")
        self.assertEqual(bye["code"], 4004)
        self.assertEqual(await inside.wait_closed(), 4004)
        self.assertEqual((await viewer.ask("close_room", name="class-7"))["code"], "unknown_room")

    async def test_a_glance_keeps_a_room_neither_awake_nor_open(self):
        viewer = await self.viewer()
        await viewer.ask("create_room", name="watched")
        wall = await Viewer.open(self.server, query="/watched?glance=1")
        self.addAsyncCleanup(wall.socket.close)
        self.assertEqual((wall.welcome["room"], wall.welcome["role"]), ("watched", "viewer"))
        first = await wall.wait_frame(lambda f: True)
        await wall.ask("view", hz=1)
        here = (await viewer.ask("query", what="state"))["data"]["tick"]
        await viewer.wait_frame(lambda f: f.tick > here + 20)
        room = (await viewer.ask("list_rooms"))["rooms"][1]
        self.assertEqual((room["name"], room["viewers"], room["tick"]), ("watched", 0, first.tick))
        for command in ("pause", "fork"):
            self.assertEqual((await wall.ask(command, name="mine"))["code"], "not_allowed")
        pupil = await self.enter("watched")
        await wall.wait_text(lambda m: m["op"] == "state" and m["tick"] > first.tick)
        roster = await pupil.ask("query", what="roster")
        self.assertEqual([one["id"] for one in roster["data"]], [pupil.id])

    async def test_what_happens_in_one_room_is_not_seen_in_another(self):
        here = await self.viewer()
        await here.ask("create_room", name="there")
        there = await self.enter("there")
        self.assertEqual(there.welcome["scene"], "curtain")
        await there.ask("pause")
        await there.wait_text(lambda m: m["op"] == "state" and m["paused"])
        await there.ask("pin", particle=700, radius=0.02)
        await there.ask("load", scene="flag")
        answer = await here.ask("query", what="state")
        self.assertFalse(answer["data"]["paused"])
        pins = await here.ask("query", what="pins")
        self.assertFalse([pin for pin in pins["data"] if pin["viewer"] == there.id])
        roster = await here.ask("query", what="roster")
        self.assertEqual([viewer["id"] for viewer in roster["data"]], [here.id])
        listed = await here.ask("list_rooms")
        self.assertEqual([(r["name"], r["scene"], r["paused"]) for r in listed["rooms"]],
                         [("default", "curtain", False), ("there", "flag", True)])

    async def test_rooms_of_one_scene_have_the_same_ticks_whatever_passes_beside(self):
        first = await self.viewer()
        for name in ("a", "b"):
            await first.ask("create_room", name=name, scene="default", paused=True)
        a, b = await self.enter("a"), await self.enter("b")
        answers = await asyncio.gather(a.ask("advance", n=40), b.ask("advance", n=40))
        self.assertEqual(answers[0]["hash"], answers[1]["hash"])
        self.assertEqual(answers[0]["tick"], 40)

    async def test_a_fork_is_its_room_at_that_moment_and_has_the_same_future(self):
        here = await self.viewer()
        await here.wait_frame(lambda f: f.tick > 10)
        await here.ask("pin", particle=40, radius=0.05)
        await here.ask("drag", phase="start", drag=1, particle=500)
        await here.ask("pause")
        made = await here.ask("fork", name="mine")
        self.assertEqual(made["op"], "result", made)
        self.assertEqual((made["room"]["tick"], made["room"]["paused"]), (made["tick"], True))
        mine = await self.enter("mine")
        self.assertEqual(mine.welcome["scene"], "curtain")
        self.assertEqual((await mine.ask("query", what="grabs"))["data"], [])
        await here.ask("drag", phase="end", drag=1)
        for viewer in (here, mine):
            await viewer.ask("set", wind=[1, 0, 0.5])
            await viewer.ask("drag", phase="start", drag=2, particle=300, target=[0.1, 1.5, 0])
        answers = await asyncio.gather(*(viewer.ask("advance", n=12) for viewer in (here, mine)))
        self.assertEqual(answers[0]["hash"], answers[1]["hash"])
        self.assertEqual(answers[0]["tick"], made["tick"] + 12)
        await mine.ask("advance", n=2)
        self.assertEqual((await here.ask("hash"))["hash"], answers[0]["hash"])
        self.assertEqual((await here.ask("fork", name="mine"))["code"], "room_exists")
        # And a fork of a fork, running.
        await mine.ask("resume")
        running = await mine.ask("fork", name="again")
        self.assertFalse(running["room"]["paused"])
        again = await self.enter("again")
        await again.wait_frame(lambda f: f.tick > running["tick"] + 2)

    async def test_refusals_name_field_value_and_limit(self):
        viewer = await self.viewer()
        for name, code in (("", "wrong_length"), ("a" * 33, "wrong_length"), ("A", "unknown_value"),
                           ("-a", "unknown_value"), ("a/b", "unknown_value"), ("ä", "unknown_value"),
                           ("default", "room_exists")):
            error = await viewer.ask("create_room", name=name)
            self.assertEqual((error["op"], error["code"], error["field"]), ("error", code, "name"), name)
        error = await viewer.ask("create_room", name="a", scene="nothing")
        self.assertEqual((error["code"], error["field"]), ("unknown_scene", "scene"))
        self.assertEqual((await viewer.ask("close_room", name="default"))["code"], "not_allowed")
        for name in "abc":
            self.assertEqual((await viewer.ask("create_room", name=name, paused=True))["op"], "result")
        error = await viewer.ask("create_room", name="d")
        self.assertEqual((error["code"], error["limit"]["maximum"]), ("too_many", 4))
        await viewer.ask("close_room", name="a")
        self.assertEqual((await viewer.ask("create_room", name="d"))["op"], "result")

    async def test_an_address_without_a_room_is_refused_by_name(self):
        for path, status in (("/nothing", 404), ("/", 404), ("/a/b", 404)):
            with self.assertRaises(websockets.InvalidStatusCode) as refused:
                await Viewer.open(self.server, query=path)
            self.assertEqual(refused.exception.status_code, status)
        status, _, body = self.server.get("/api/v1/connect?room=nothing")
        self.assertEqual((status, json.loads(body)["error"]["code"]), (404, "unknown_room"))
        self.assertEqual(self.server.get("/api/v1/connect?room=default")[0], 200)

    async def test_a_viewer_that_creates_and_leaves_at_once_leaves_a_room_or_none(self):
        for number in range(3):
            hasty = await Viewer.open(self.server)
            await hasty.tell("create_room", name=f"hasty-{number}", scene="flag")
            await hasty.close()
        viewer = await self.viewer()
        while True:  # the last scene may still be under construction
            names = [room["name"] for room in (await viewer.ask("list_rooms"))["rooms"]]
            errors = [await viewer.ask("create_room", name=f"hasty-{number}") for number in range(3)]
            if all(error["op"] == "result" or error["code"] == "room_exists" for error in errors):
                break
        self.assertIn("default", names)

    async def test_a_room_closes_itself_under_its_viewer(self):
        viewer = await self.viewer()
        await viewer.ask("create_room", name="own")
        inside = await self.enter("own")
        await inside.tell("close_room", name="own")
        self.assertEqual(await inside.wait_closed(), 4004)
        self.assertEqual((await viewer.ask("create_room", name="own"))["op"], "result")


class EmptyRooms(SocketTest):
    options = ("--scene", "flag", "--room-idle", "0.5")

    async def test_a_room_that_stays_empty_closes_and_one_with_a_viewer_does_not(self):
        viewer = await self.viewer()
        kept = None
        while not kept:  # it may have closed before its viewer came
            await viewer.ask("create_room", name="kept")
            with contextlib.suppress(websockets.InvalidStatusCode):
                kept = await Viewer.open(self.server, query="/kept")
        self.addAsyncCleanup(kept.socket.close)
        await viewer.ask("create_room", name="left")
        names = ["left"]
        while "left" in names:
            await asyncio.sleep(0.05)
            names = [room["name"] for room in (await viewer.ask("list_rooms"))["rooms"]]
        self.assertEqual(names, ["default", "kept"])


class ClosedRooms(SocketTest):
    options = ("--scene", "flag", "--paused", "--pong-seconds", "1")

    async def test_a_viewer_that_reads_nothing_and_goes_on_sending_keeps_no_closed_room(self):
        viewer = await self.viewer()
        await viewer.ask("create_room", name="left", paused=True)
        narrow = socket.socket()
        narrow.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        narrow.connect((self.server.addresses["host"], self.server.addresses["port"]))
        deaf = await Viewer.open(self.server, query="/left", max_queue=1, sock=narrow)
        self.addCleanup(narrow.close)
        deaf.reader.cancel()
        deaf.socket.transport.pause_reading()
        for _ in range(100):  # more than is sent ahead, and fewer than overflow its queue
            await deaf.tell("query", id="deaf", what="positions")
        await viewer.ask("close_room", name="left")

        async def insist():
            while True:
                await deaf.tell("ping")
                await asyncio.sleep(0.1)
        with self.assertRaises((ConnectionError, websockets.ConnectionClosed)):
            await asyncio.wait_for(insist(), PATIENCE)


class Ends(SocketTest):
    async def test_no_thread_waits_behind_other_programs_lest_it_stop_with_what_it_has_locked(self):
        task = f"/proc/{self.server.process.pid}/task"
        threads = [int(thread) for thread in os.listdir(task)]
        self.assertGreater(len(threads), 4)
        for thread in threads:
            self.assertEqual(os.sched_getscheduler(thread), os.sched_getscheduler(0))
            self.assertEqual(os.getpriority(os.PRIO_PROCESS, thread), os.getpriority(os.PRIO_PROCESS, 0))

    async def test_sigterm_ends_a_server_of_many_rooms_and_says_so_in_each(self):
        server = Server("--scene", "flag", "--room-idle", "0")
        viewer = await Viewer.open(server)
        others = []
        for number in range(6):
            await viewer.ask("create_room", name=f"room-{number}", scene="curtain")
            others.append(await Viewer.open(server, query=f"/room-{number}"))
        stopping = asyncio.get_running_loop().run_in_executor(None, server.stop)
        for each in (viewer, *others):
            self.assertEqual(await each.wait_closed(), 1001)
        self.assertEqual(await stopping, 0)


if __name__ == "__main__":
    main()
