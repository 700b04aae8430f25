"""The Python client against a played server on loopback, over real sockets."""

import asyncio
import math
import unittest
from unittest import mock

import golden
import weft
from played_server import GRID, WELCOME, PlayedServer, example

HANDS = golden.read("frame_hands.bin")  # epoch 1, 6 vertices, tick 2^40 + 5


class WithoutWebsocketsTest(unittest.TestCase):
    def test_a_python_without_the_package_is_told_which_one_is_missing(self):
        with mock.patch.object(weft.packages, "websockets", None):
            with self.assertRaisesRegex(ImportError, "python3-websockets"):
                weft.open("ws://127.0.0.1:1/ws")


class ClientTest(unittest.IsolatedAsyncioTestCase):
    async def asyncSetUp(self):
        self.server = await self.enterAsyncContext(PlayedServer())
        self.client = await self.enterAsyncContext(weft.connect(self.server.url))

    async def test_joining_gives_welcome_and_mesh(self):
        self.assertEqual(self.client.welcome, WELCOME)
        self.assertEqual(self.client.viewer, WELCOME["viewer"])
        self.assertEqual(self.client.mesh, GRID)
        self.assertEqual(len(self.client.mesh_data.triangles), 4)

    async def test_each_call_sends_the_golden_command_with_an_id_of_its_own(self):
        self.server.answers = {
            "pick": [{"hit": None}], "hash": [{"hash": "ff"}], "query": [{"data": []}],
            "advance": [golden.read("frame_observed.bin"), {"tick": 60}],
        }
        ids = set()
        for call in golden.read_json("client_calls.json"):
            method = getattr(self.client, call["method"])
            result = await method(*call["args"], **call["options"])
            if "observe" in call["options"]:
                self.assertEqual((result["observation"].tick, result["observation"].observed), (60, True))
            sent = dict(self.server.heard[-1])
            ids.add(sent.pop("id"))
            self.assertEqual(sent, call["sends"])
        self.assertEqual(len(ids), len(self.server.heard))

    async def test_results_go_to_the_calls_that_they_answer_in_any_order(self):
        self.server.answers = {"hash": [], "pause": []}
        calls = [asyncio.create_task(c) for c in (self.client.hash(), self.client.pause())]
        await self.server.until(lambda: len(self.server.heard) == 2)
        hash_id, pause_id = (message["id"] for message in self.server.heard)
        await self.server.say({"op": "result", "id": pause_id, "paused": True})
        await self.server.say({"op": "result", "id": hash_id, "hash": "ff"})
        self.assertEqual(await calls[0], "ff")
        self.assertTrue((await calls[1])["paused"])

    async def test_pick_answers_a_hit_or_none(self):
        found = example("result", "pick")
        self.server.answers = {"pick": [{"hit": found["hit"]}]}
        hit = await self.client.pick([0, 1, 3], [0, 0, -1])
        self.assertEqual(hit.triangle, found["hit"]["triangle"])
        self.assertEqual(list(hit.barycentric), found["hit"]["barycentric"])
        self.server.answers = {"pick": [{"hit": None}]}
        self.assertIsNone(await self.client.pick((0, 1, 3), (0, 0, 1)))

    async def test_a_refusal_raises_all_that_the_server_says(self):
        refusal = example("error")
        self.server.answers = {"speed": [{k: v for k, v in refusal.items() if k != "id"}]}
        with self.assertRaises(weft.CommandError) as raised:
            await self.client.speed(99)
        for name in ("code", "command", "field", "value", "limit", "hint"):
            self.assertEqual(getattr(raised.exception, name), refusal[name])
        self.assertEqual(
            str(raised.exception),
            f"{refusal['message']}; field: target[1]; {refusal['hint']}",  # the message tells what is allowed
        )

    async def test_a_refusal_says_in_words_what_is_allowed(self):
        limits = (
            ({"allowed": ["slow", "soften"]}, "no; allowed: slow, soften"),
            ({"length": 3}, "no; allowed: 3 elements"),
            ({"maximum": 1000}, "no; allowed: at most 1000"),
            ({"minimum": 0.01, "maximum": 10}, "no; allowed: 0.01 to 10"),
            (None, "no"),
        )
        for limit, text in limits:
            self.server.answers = {"speed": [{"op": "error", "code": "c", "message": "no", "limit": limit}]}
            with self.assertRaises(weft.CommandError) as raised:
                await self.client.speed(99)
            self.assertEqual(str(raised.exception), text)

    async def test_a_setting_that_there_is_none_of_is_named_and_nothing_is_sent(self):
        for values in ({"windy": 1}, {"wind": [1, 0, 0], "windy": 1}):
            with self.assertRaisesRegex(TypeError, "windy"):
                await self.client.set(**values)
        self.assertEqual(self.server.heard, [])

    async def test_a_field_of_a_dict_that_there_is_none_of_is_named_and_nothing_is_sent(self):
        fan = {"position": [0, 1, 2], "direction": [0, 0, -1]}
        for values, word in (({"fabric": {"frction": 0.2}}, "frction"), ({"fans": [fan, {**fan, "sped": 1}]}, "sped")):
            with self.assertRaisesRegex(TypeError, word):
                await self.client.set(**values)
        self.assertEqual(self.server.heard, [])
        await self.client.set(fans=[fan], fabric={"preset": "silk"})
        self.assertEqual(len(self.server.heard), 1)

    async def test_a_field_of_what_is_held_or_moved_that_there_is_none_of_is_named_and_nothing_is_sent(self):
        client, near = self.client, {"triangle": 1, "barycentric": [1, 0, 0]}
        wrong = (
            (lambda: client.pin({"particle": 3, "radus": 0.1}), "radus"),
            (lambda: client.pin({**near, "tringle": 1}), "tringle"),
            (lambda: client.pin({}), "particle"),
            (lambda: client.pin({"triangle": 1}), "barycentric"),
            (lambda: client.drag({"particle": 3, "tagret": [0, 0, 0]}).start(), "tagret"),
            (lambda: client.move({"collider": 0, "sped": 3}, [0, 0, 0]), "sped"),
            (lambda: client.move({"colider": 0}, [0, 0, 0]), "colider"),
        )
        for call, word in wrong:
            with self.assertRaisesRegex(TypeError, word):
                await call()
        self.assertEqual(self.server.heard, [])
        found = {**near, "position": [0, 1, 0], "particle": 2, "distance": 1}  # as the server tells it
        for hold in (near, found, {"particle": 2}):
            await client.pin(hold)
        await client.move({"collider": 0}, [0, 0, 0])
        self.assertEqual(len(self.server.heard), 4)

    async def test_a_number_that_is_not_finite_is_named_with_its_command_and_not_sent(self):
        nan, client = float("nan"), self.client
        wrong = (
            (lambda: client.speed(nan), r"speed\.speed = nan"),
            (lambda: client.pick([0, nan, 0], [0, 0, 1]), r"pick\.origin\[1\] = nan"),
            (lambda: client.pick((0, 1, 0), (0, 0, -math.inf)), r"pick\.direction\[2\] = -inf"),
            (lambda: client.set(fabric={"friction": nan}), r"set\.fabric\.friction = nan"),
            (lambda: client.drag(3, target=[nan, 0, 0]).start(), r"drag\.target\[0\] = nan"),
        )
        for call, what in wrong:
            with self.assertRaisesRegex(ValueError, what):
                await call()
        self.assertEqual(self.server.heard, [])

    async def test_a_refusal_that_nobody_waits_for_is_told(self):
        told = asyncio.get_running_loop().create_future()
        self.client.on("refused", told.set_result)
        await self.server.say({"op": "error", "code": "rate_limited", "message": "too fast"})
        self.assertEqual((await told).code, "rate_limited")

    async def test_events_are_kept_and_told_and_unknown_ones_ignored(self):
        for op in ("state", "roster", "pins", "grabs", "notice", "bye"):
            told = asyncio.get_running_loop().create_future()
            stop = self.client.on(op, told.set_result)
            await self.server.say({"op": "of the future"}, example(op))
            self.assertEqual(await told, example(op))
            stop()
            if op not in ("notice", "bye"):
                self.assertEqual(getattr(self.client, op), example(op))

    async def test_sleeping_names_the_cloths_of_the_newest_state_and_all_asleep_means_all(self):
        curtains = {**GRID, "epoch": 2, "cloths": [{"name": "left"}, {"name": "right"}]}

        def state(*names):
            return {**example("state"), "sleeping": {"islands": len(names), "cloths": names}}

        self.assertEqual((self.client.sleeping, self.client.all_asleep), ((), False))
        waiting = asyncio.create_task(self.client.until_asleep())
        for names in (("left",), (), ("left", "right")):
            self.assertFalse(waiting.done())
            told = asyncio.get_running_loop().create_future()
            stop = self.client.on("state", told.set_result)
            await self.server.say(curtains, golden.read("mesh_grid.bin"), state(*names))
            await told
            stop()
            self.assertEqual((self.client.sleeping, self.client.all_asleep), (names, len(names) == 2))
        await waiting

    async def test_every_frame_is_acknowledged_and_only_those_of_the_mesh_are_told(self):
        one = golden.read("frame_jump.bin")  # of epoch 7
        await self.server.say(one, HANDS)
        frame = await self.client.next_frame()
        self.assertEqual(frame.tick, 2**40 + 5)
        await self.server.until(lambda: len(self.server.acks) == 2)
        self.assertEqual(self.server.acks[0], weft.encode_ack(1))
        self.assertEqual(self.server.acks[1], weft.encode_ack(2**32 - 1))

    async def test_a_frame_that_an_advance_observed_is_told_and_not_acknowledged(self):
        told = []
        self.client.on("frame", told.append)
        await self.server.say(golden.read("frame_observed.bin"), HANDS)
        await self.server.until(lambda: len(self.server.acks) == 1)
        self.assertEqual(self.server.acks[0], weft.encode_ack(2**32 - 1))  # of the other one
        self.assertEqual([frame.observed for frame in told], [True, False])

    async def test_an_answer_without_what_was_observed_is_an_error(self):
        self.server.answers = {"advance": [{"tick": 3}]}
        with self.assertRaisesRegex(weft.ProtocolError, "observed"):
            await self.client.advance(1, observe=["velocities"])

    async def test_frames_can_be_waited_for_by_tick_and_listed(self):
        await self.server.say(HANDS)
        self.assertEqual((await self.client.frame_at(5)).tick, 2**40 + 5)
        seen = []
        listing = asyncio.create_task(self._list(seen))
        await asyncio.sleep(0)
        await self.server.say(HANDS)
        await self.server.until(lambda: len(self.server.acks) == 2)
        await self.server.socket.close(1001)
        await listing
        self.assertEqual([frame.epoch for frame in seen], [1])

    async def _list(self, seen):
        async for frame in self.client.frames():
            seen.append(frame)

    async def test_a_binary_query_returns_its_data(self):
        announced = {"binary": {"transfer": 1, "count": 5, "components": 3}}
        self.server.answers = {"query": [announced, golden.read("data_f32.bin")]}
        data = await self.client.query("positions", format="f32")
        self.assertEqual((data.tick, len(data.values)), (600, 5))

    async def test_a_message_that_cannot_be_read_ends_the_connection(self):
        damaged = bytearray(HANDS)
        damaged[70] ^= 1
        bad = (
            bytes(damaged), "{", "null", "[]", {"op": "result", "id": [1]},
            golden.read("frame_one_vertex.bin"), golden.read("mesh_colliders.bin"), b"",
        )
        for message in bad:
            async with PlayedServer() as server, weft.connect(server.url) as client:
                await server.say(message)
                with self.assertRaises(weft.ProtocolError):
                    await client.next_frame()
                await server.socket.wait_closed()
                self.assertEqual(server.socket.close_code, 4002)
                with self.assertRaises(weft.ProtocolError):
                    await client.pause()

    async def test_what_waits_is_told_when_the_connection_ends(self):
        self.server.answers = {"hash": [], "query": [{"binary": {"transfer": 9}}]}
        calls = [self.client.hash(), self.client.query("positions", format="f64"), self.client.next_frame()]
        tasks = [asyncio.create_task(call) for call in calls]
        await self.server.until(lambda: len(self.server.heard) == 2)
        await self.server.socket.close(1012, "restart")
        for task in tasks:
            with self.assertRaises(weft.ConnectionLost) as raised:
                await task
            self.assertEqual((raised.exception.code, raised.exception.reason), (1012, "restart"))
        with self.assertRaises(weft.ConnectionLost):
            await self.client.pause()

    async def test_ping_measures_the_round_trip_and_the_servers_clock(self):
        now = asyncio.get_running_loop().time()
        self.server.answers = {"ping": [{"t": 0, "received": now + 100, "sent": now + 100}]}
        round_trip, offset = await self.client.ping()
        self.assertGreater(round_trip, 0)
        self.assertAlmostEqual(offset, 100, delta=round_trip)

    async def test_a_listener_that_fails_does_not_end_the_connection(self):
        faults = []
        asyncio.get_running_loop().set_exception_handler(lambda _, context: faults.append(context))
        self.client.on("state", lambda _: 1 / 0)
        await self.server.say(example("state"))
        await self.client.pause()
        self.assertIsInstance(faults[0]["exception"], ZeroDivisionError)


class JoiningTest(unittest.IsolatedAsyncioTestCase):
    async def test_name_and_colour_are_said(self):
        async with PlayedServer() as server:
            async with weft.connect(server.url, name="Ada", color="#e4572e"):
                hello, = server.of("hello")
                self.assertEqual((hello["name"], hello["color"]), ("Ada", "#e4572e"))

    async def test_a_token_is_the_first_that_is_said_and_stands_in_no_other_message(self):
        async with PlayedServer() as server:
            async with weft.connect(server.url, name="Ada", token="0123456789abcdef"):
                first, second = server.of("hello")
                self.assertEqual(server.heard[0], first)
                self.assertEqual(first["token"], "0123456789abcdef")
                self.assertNotIn("token", second)

    async def test_a_link_brings_its_token_and_another_one_that_is_given_goes_before_it(self):
        for given, said in ((None, "0123456789abcdef"), ("fedcba9876543210", "fedcba9876543210")):
            async with PlayedServer() as server:
                link = server.url.replace("ws://", "http://").removesuffix("/ws") + "/#token=0123456789abcdef"
                async with weft.connect(link, name="Ada", token=given):
                    self.assertEqual(server.of("hello")[0]["token"], said)

    async def test_a_server_without_the_subprotocol_is_refused(self):
        async with PlayedServer(subprotocols=None) as server:
            with self.assertRaises(weft.WeftError):
                await weft.connect(server.url)

    async def test_nobody_there_is_a_lost_connection(self):
        async with PlayedServer() as server:
            url = server.url
        with self.assertRaises(weft.ConnectionLost):
            await weft.connect(url)

    async def test_what_cannot_be_held_or_observed_is_told_before_it_is_sent(self):
        async with PlayedServer() as server, weft.connect(server.url) as client:
            with self.assertRaisesRegex(TypeError, "misses the cloth"):
                client.drag(None)
            with self.assertRaisesRegex(TypeError, "list of words"):
                await client.advance(1, observe="grippers")

    async def test_a_server_that_says_nothing_is_given_up(self):
        async with PlayedServer(welcome=()) as server:
            with self.assertRaises(weft.ConnectionLost):
                await weft.connect(server.url, timeout=0.2)


class BlockingTest(unittest.IsolatedAsyncioTestCase):
    """The blocking client in a thread, as a script has it, the server here."""

    def script(self, url):
        with weft.open(url, name="script") as cloth:
            self.assertEqual(cloth.viewer, WELCOME["viewer"])
            self.assertEqual(len(cloth.mesh_data.uv), 6)
            self.assertEqual(cloth.advance(600)["hash"], "ff")
            with self.assertRaises(weft.CommandError):
                cloth.speed(99)
            with cloth.drag(7) as hand:
                self.assertEqual(hand.grab, 17)
                hand.move([0, 1, 0])
            self.assertEqual(cloth.next_frame().epoch, 1)
            self.assertEqual((cloth.sleeping, cloth.all_asleep), ((), False))
            with self.assertRaises(AttributeError):
                cloth.fly()
        cloth.close()  # a second time does no harm

    async def test_commands_block(self):
        async with PlayedServer() as server:
            server.answers = {
                "advance": [{"hash": "ff"}],
                "speed": [{"op": "error", "code": "out_of_range", "message": "no"}],
                "drag": [{"grab": 17, "target": [0, 0, 0]}],
            }
            running = asyncio.create_task(asyncio.to_thread(self.script, server.url))
            await server.until(lambda: server.of("drag")[-1:] and server.of("drag")[-1]["phase"] == "end")
            while not running.done():  # frames until the script has seen one
                try:
                    await server.say(HANDS)
                except Exception:
                    break
                await asyncio.sleep(0.01)
            await running
        # Targets that are repeated have no id.
        phases = [message["phase"] for message in server.of("drag") if "id" in message]
        self.assertEqual(phases, ["start", "move", "end"])

    async def test_what_fails_at_joining_leaves_no_thread(self):
        import threading

        async with PlayedServer() as server:
            url = server.url
        before = threading.active_count()
        with self.assertRaises(weft.ConnectionLost):
            await asyncio.to_thread(weft.open, url)
        names = [thread.name for thread in threading.enumerate()]
        self.assertNotIn("weft", names)
        self.assertLessEqual(threading.active_count(), before + 1)  # the pool's own


if __name__ == "__main__":
    unittest.main()
