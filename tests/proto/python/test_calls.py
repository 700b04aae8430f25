"""What calls of the Python client take, how long they wait, and how fast they come."""

import asyncio
import contextlib
import functools
import gc
import random
import socket
import time
import unittest
import warnings
from unittest import mock

import golden
import websockets
import weft
from played_server import GRID, WELCOME, PlayedServer, example


class CallsTest(unittest.IsolatedAsyncioTestCase):
    async def asyncSetUp(self):
        self.server = await self.enterAsyncContext(PlayedServer())
        self.client = await self.enterAsyncContext(weft.connect(self.server.url))

    async def test_what_lists_itself_as_numpy_does_is_sent_as_plain_numbers(self):
        class Listed:
            def __init__(self, value):
                self.value = value

            def tolist(self):
                return self.value

        await self.client.set(wind=Listed([1, 2, 3]), drag=Listed(0.5), still_air=Listed(True))
        sent = dict(self.server.heard[-1])
        sent.pop("id")
        self.assertEqual(sent, {"op": "set", "wind": [1, 2, 3], "drag": 0.5, "still_air": True})
        with self.assertRaises(ValueError):
            await self.client.set(drag=Listed(float("nan")))
        with self.assertRaisesRegex(TypeError, "complex"):
            await self.client.set(drag=1j)
        self.assertEqual(len(self.server.heard), 1)

    @unittest.skipIf(weft.packages.numpy is None, "numpy is not installed")
    async def test_numpys_numbers_and_vectors_are_taken_wherever_plain_ones_are(self):
        np = weft.packages.numpy
        self.server.answers = {
            "pick": [{"hit": None}], "query": [{"data": []}], "drag": [{"grab": 1, "target": [0, 0, 0]}],
        }
        vector, number = np.array([0.5, 1, 2], np.float32), np.int64(5)
        plain = [0.5, 1, 2]

        async def sends(call, **fields):
            await call
            sent = {name: value for name, value in self.server.heard[-1].items() if name != "id"}
            self.assertEqual(sent, fields)

        client = self.client
        await sends(client.pick(vector, vector), op="pick", origin=plain, direction=plain)
        await sends(client.pin(number, radius=np.float32(0.5)), op="pin", particle=5, radius=0.5)
        await sends(client.pin({"particle": np.uint8(7)}), op="pin", particle=7)
        await sends(client.release(pin=number), op="release", pin=5)
        await sends(client.camera(vector, plain, up=vector), op="camera", position=plain, target=plain, up=plain)
        await sends(client.move("ball", vector), op="move", collider="ball", position=plain)
        await sends(client.move(number, vector), op="move", pin=5, position=plain)
        await sends(client.gripper("g", position=vector), op="gripper", name="g", position=plain)
        await sends(client.set(wind=np.zeros(3)), op="set", wind=[0, 0, 0])
        await sends(client.set(still_air=np.True_), op="set", still_air=True)
        await sends(client.step(number), op="step", n=5)
        await sends(client.advance(np.int32(3)), op="advance", n=3, frames="last")
        await sends(client.advance(3, frames=None), op="advance", n=3)
        await sends(client.speed(np.float32(0.25)), op="speed", speed=0.25)
        await sends(client.query("boxes", tree="edges", level=number), op="query", what="boxes", tree="edges", level=5)
        await sends(client.load({"cloths": [{"origin": vector}]}), op="load", scene={"cloths": [{"origin": plain}]})
        hand = client.drag(number, target=vector, radius=np.float64(0.25))
        await sends(hand.start(), op="drag", phase="start", drag=1, particle=5, target=plain, radius=0.25)
        await sends(hand.move(vector), op="drag", phase="move", drag=1, target=plain)
        await hand.end()

    async def test_a_call_that_is_not_answered_in_time_raises_and_a_late_answer_does_no_harm(self):
        self.server.answers = {"hash": []}
        with self.assertRaises(weft.CallTimeout) as raised:
            await self.client.hash(timeout=0.02)
        self.assertEqual((raised.exception.command, raised.exception.seconds), ("hash", 0.02))
        self.assertIsInstance(raised.exception, TimeoutError)
        await self.server.say({"op": "result", "id": self.server.heard[-1]["id"], "hash": "ff"})
        self.server.answers = {}
        await self.client.pause()
        self.assertEqual(self.client._waiting, {})

    async def test_every_call_takes_a_time_out_of_its_own(self):
        for call in golden.read_json("client_calls.json"):
            self.server.answers = {call["sends"]["op"]: []}
            with self.assertRaises(weft.CallTimeout, msg=call["method"]):
                await getattr(self.client, call["method"])(*call["args"], **call["options"], timeout=0.001)
        self.server.answers = {"ping": [], "drag": []}
        waits = (self.client.ping, self.client.next_frame, self.client.until_asleep,
                 functools.partial(self.client.frame_at, 7), functools.partial(self.client.request, "hash"))
        self.server.answers["hash"] = []
        for wait in waits:
            with self.assertRaises(weft.CallTimeout):
                await wait(timeout=0.001)
        with self.assertRaises(weft.CallTimeout):
            await self.client.drag(7, timeout=0.001).start()

    async def test_a_time_out_of_none_waits_for_ever_and_that_of_the_client_is_for_all_calls(self):
        async with weft.connect(self.server.url, call_timeout=0.02) as client:
            self.server.answers = {"hash": [], "advance": [], "load": [], "create_room": [], "fork": []}
            for wait in (client.hash, client.next_frame):
                with self.assertRaises(weft.CallTimeout):
                    await wait()
            patient = [client.hash(timeout=None), client.advance(10), client.load("flag"), client.until_asleep(),
                       client.create_room("mine"), client.fork("ours")]
            tasks = [asyncio.create_task(call) for call in patient]
            await asyncio.sleep(0.1)
            self.assertFalse(any(task.done() for task in tasks))
            for task in tasks:
                task.cancel()

    async def test_what_waits_for_its_turn_when_the_connection_is_lost_is_not_sent_on_the_next(self):
        with mock.patch.object(weft.pace, "FIRST_PAUSE", 0.02):
            async with weft.connect(self.server.url, reconnect=True) as client:
                welcomed = asyncio.Event()
                client.on("welcome", lambda _: welcomed.set())
                client._pace.set_limit(1, asyncio.get_running_loop().time())
                await client.pause()
                waiting = asyncio.create_task(client.hash())
                await asyncio.sleep(0)
                await self.server.socket.close(1012)
                with self.assertRaises(weft.ConnectionLost):
                    await waiting
                await asyncio.wait_for(welcomed.wait(), 20)
                await asyncio.sleep(1.2)  # its turn would have come
                self.assertEqual(self.server.of("hash"), [])


class JoiningTest(unittest.IsolatedAsyncioTestCase):
    """`timeout` bounds joining as a whole."""

    async def fails(self, url, seconds, why, **options):
        begin = time.monotonic()
        with self.assertRaisesRegex(weft.ConnectionLost, f"no connection to {url}: {why} within {seconds:g} s"):
            await weft.connect(url, timeout=seconds, **options)
        self.assertLess(time.monotonic() - begin, 1.6 * seconds)

    async def test_a_server_that_accepts_and_does_not_answer_is_given_up_in_time(self):
        with socket.create_server(("127.0.0.1", 0)) as silent:  # the system accepts for it
            await self.fails(f"ws://127.0.0.1:{silent.getsockname()[1]}/ws", 2, "no answer")

    async def test_a_server_that_answers_late_and_then_does_not_begin_is_given_up_in_time(self):
        async def late(path, headers):
            await asyncio.sleep(1.5)

        async with websockets.serve(lambda joined: joined.wait_closed(), "127.0.0.1", 0, process_request=late,
                                    subprotocols=["weft.v1"]) as server:
            await self.fails(f"ws://127.0.0.1:{server.sockets[0].getsockname()[1]}/ws", 2, "the server does not begin")

    async def test_a_server_that_does_not_answer_to_a_name_is_given_up_in_time(self):
        async with PlayedServer() as server:
            server.answers = {"hello": []}
            await self.fails(server.url, 2, "the server does not begin", name="Ada")


class ClosingTest(unittest.IsolatedAsyncioTestCase):
    """A client that is closed leaves nothing behind, and says nothing of it."""

    async def asyncSetUp(self):
        self.server = await self.enterAsyncContext(PlayedServer())
        self.server.answers = {"drag": [{"grab": 17, "target": [0, 0, 0]}]}

    async def test_a_hand_that_holds_ends_with_its_client(self):
        before = asyncio.all_tasks()
        client = await weft.connect(self.server.url)
        hand = await client.drag(7).start()
        self.assertFalse(hand._repeater.done())
        await client.close()
        self.assertTrue(hand._repeater.done())
        self.assertFalse([task for task in asyncio.all_tasks() - before if "_repeat" in str(task)])

    async def test_it_closes_within_four_seconds_of_a_server_that_hangs(self):
        client = await weft.connect(self.server.url)
        self.server.socket.transport.pause_reading()
        begin = time.monotonic()
        await client.close()
        self.assertLess(time.monotonic() - begin, 4)
        self.server.socket.transport.abort()

    async def test_a_listener_that_calls_its_blocking_client_is_told_and_the_client_lives_on(self):
        raised = []

        def use():
            with weft.open(self.server.url) as client:
                def listen(_):
                    try:
                        client.pause(timeout=0.2)
                    except RuntimeError as error:
                        raised.append(error)

                client.on("state", listen)
                client.reset(timeout=5)
                while not raised:
                    time.sleep(0.01)
                client.pause(timeout=5)

        self.server.answers = {"reset": [{}, example("state")]}
        await asyncio.wait_for(asyncio.to_thread(use), 20)
        self.assertIn("listener", str(raised[0]))

    async def test_a_blocking_client_with_a_hand_that_holds_closes_without_a_word(self):
        def script():
            with weft.open(self.server.url) as cloth:
                cloth.drag(7).start()
            with weft.open(self.server.url) as cloth, cloth.drag(8):
                cloth.close()
            with self.assertRaisesRegex(weft.ConnectionLost, "this client was closed"):
                cloth.pause()
            gc.collect()

        with self.assertNoLogs("asyncio", "ERROR"), self.assertNoWarnings():
            await asyncio.to_thread(script)

    @contextlib.contextmanager
    def assertNoWarnings(self):
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            yield
        self.assertEqual([str(one.message) for one in told if "never awaited" in str(one.message)], [])


class PaceTest(unittest.IsolatedAsyncioTestCase):
    def test_messages_never_come_faster_than_the_limit_allows_and_nearly_as_fast(self):
        chance = random.Random(7)
        for limit in (1, 3, 50, 1000, 1e6):
            for patience in (0, 0.5, 2):  # mean time between two that are asked for, in that of the limit
                pace, times, now = weft.pace.Pace(limit), [], 100.0
                tokens, last = limit, now  # of the server's bucket: as many at once as in a second
                for _ in range(5000):
                    now += patience / limit * chance.expovariate(1) if patience else 0
                    now += pace.wait_before_next(now)
                    tokens, last = min(limit, tokens + (now - last) * limit), now
                    self.assertGreaterEqual(tokens, 1 - 1e-6)
                    tokens -= 1
                    times.append(now)
                if patience == 0:
                    self.assertLess(times[-1] - times[0], 5000 / (0.94 * limit))

    async def test_a_client_keeps_to_the_limit_that_welcome_tells(self):
        limits = {**WELCOME["limits"], "messages_per_second": 20}
        first = ({**WELCOME, "limits": limits}, GRID, golden.read("mesh_grid.bin"))
        async with PlayedServer(welcome=first) as server, weft.connect(server.url) as client:
            server.answers = {"hash": [{"hash": "ff"}]}
            clock = asyncio.get_running_loop().time
            begin = clock()
            await asyncio.gather(*(client.hash() for _ in range(15)))
            self.assertGreater(clock() - begin, (15 - 1 - 0.25 * 20) / 20)  # no upper bound: machines differ
            ids = [message["id"] for message in server.of("hash")]
            self.assertEqual(ids, sorted(ids))


if __name__ == "__main__":
    unittest.main()
