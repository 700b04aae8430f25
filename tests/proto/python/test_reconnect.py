"""A Python client that comes back by itself, against a played server over real sockets."""

import asyncio
import unittest
from unittest import mock

import golden
import weft
from played_server import WELCOME, PlayedServer

HANDS = golden.read("frame_hands.bin")


class ReconnectTest(unittest.IsolatedAsyncioTestCase):
    async def asyncSetUp(self):
        self.enterContext(mock.patch.object(weft.pace, "FIRST_PAUSE", 0.02))
        self.server = await self.enterAsyncContext(PlayedServer())

    async def join(self, **options):
        client = await self.enterAsyncContext(
            weft.connect(self.server.url, name="Ada", reconnect=True, **options)
        )
        self.phases, self.welcomed = [], asyncio.Event()
        client.on("status", lambda status: self.phases.append(status["phase"]))
        client.on("welcome", lambda _: self.welcomed.set())
        return client

    async def cut(self, code=1012):
        self.welcomed.clear()
        await self.server.socket.close(code)

    async def back(self):
        await asyncio.wait_for(self.welcomed.wait(), 20)

    async def test_it_joins_again_and_says_its_name_and_what_it_wants_to_see(self):
        client = await self.join()
        await client.hello(color="#123456")
        await client.view(hz=30)
        self.server.heard.clear()
        for code in (1012, 1001, 1011, 4000, 4001):
            await self.cut(code)
            await self.back()
            self.assertEqual(client.welcome, WELCOME)
        await client.pause()
        hello, view = {"op": "hello", "name": "Ada", "color": "#123456"}, {"op": "view", "hz": 30}
        self.assertEqual(self.server.heard[:-1], [hello, view] * 5)
        self.assertEqual(self.phases, ["waiting", "open"] * 5)

    async def test_what_the_server_refused_is_not_said_again(self):
        client = await self.join()
        await client.view(hz=20, codec="packed")
        self.server.answers = {op: [{"op": "error", "code": "out_of_range", "message": "no"}] for op in ("view", "hello")}
        for call in (client.view(hz=300, forces=True), client.hello(name="x" * 40, color="#123456")):
            with self.assertRaises(weft.CommandError):
                await call
        self.server.answers = {}
        self.server.heard.clear()
        await self.cut()
        await self.back()
        await client.pause()
        again = [{"op": "hello", "name": "Ada"}, {"op": "view", "hz": 20, "codec": "packed"}]
        self.assertEqual(self.server.heard[:-1], again)

    async def test_who_waits_for_a_frame_goes_on_waiting_and_who_waits_for_an_answer_is_told(self):
        client = await self.join()
        self.server.answers = {"hash": []}
        frame, answer = asyncio.create_task(client.next_frame()), asyncio.create_task(client.hash())
        await self.server.until(lambda: self.server.of("hash"))
        await self.cut()
        with self.assertRaises(weft.ConnectionLost) as raised:
            await answer
        self.assertEqual(raised.exception.code, 1012)
        await self.back()
        await client._ready()
        await self.server.say(HANDS)
        self.assertEqual((await frame).epoch, 1)

    async def test_between_two_connections_nothing_is_sent(self):
        client = await self.join()
        with mock.patch.object(weft.pace, "FIRST_PAUSE", 60):
            await self.cut()
            with self.assertRaises(weft.ConnectionLost):
                while True:
                    await client.pause()
            self.assertEqual(client.viewer, 0)
            await client.close()  # does not wait for the pause
        self.assertEqual(self.phases, ["waiting", "closed"])
        with self.assertRaises(weft.ConnectionLost):
            await client.next_frame()

    async def test_a_hand_is_lost_with_its_connection(self):
        client = await self.join()
        self.server.answers = {"drag": [{"grab": 17, "target": [1, 2, 3]}]}
        with mock.patch.object(weft.drag, "REPEAT_SECONDS", 0.01):
            async with client.drag(7) as hand:
                await self.cut()
                await self.back()
                count = len(self.server.of("drag"))
                with self.assertRaises(weft.ConnectionLost):
                    await hand.move([4, 5, 6])
                await asyncio.sleep(0.05)
            await client.pause()
            self.assertEqual(len(self.server.of("drag")), count)  # neither a target nor an end
            async with client.drag(8) as other:
                await other.move([4, 5, 6])

    async def test_what_would_happen_again_ends_it(self):
        for code in (1002, 1003, 1007, 1008, 1009, 4003):
            client = await self.join()
            await self.cut(code)
            with self.assertRaises(weft.ConnectionLost) as raised:
                await client.next_frame()
            self.assertEqual(raised.exception.code, code)
            self.assertEqual(self.phases, ["closed"])

    async def test_without_the_option_it_ends(self):
        async with weft.connect(self.server.url) as client:
            await self.server.socket.close(1012)
            with self.assertRaises(weft.ConnectionLost):
                await client.next_frame()

    async def test_it_goes_on_trying_while_nobody_is_there(self):
        client = await self.join()
        port = int(self.server.url.split(":")[2].split("/")[0])
        self.welcomed.clear()
        await self.server.__aexit__()
        while len(self.phases) < 3:
            await asyncio.sleep(0.01)
        self.assertEqual(set(self.phases), {"waiting"})
        async with PlayedServer(port=port):
            await self.back()
            await client.pause()


    async def test_closing_ends_the_trying_even_where_a_dial_swallows_its_cancellation(self):
        client = await self.join()
        dialling = asyncio.Event()

        async def refused():
            dialling.set()
            try:
                await asyncio.sleep(60)
            except asyncio.CancelledError:  # as wait_for does if the answer comes at the same time
                raise weft.ConnectionLost(1006, "refused") from None

        client._dial = refused
        await self.cut()
        await dialling.wait()
        await asyncio.wait_for(client.close(), 20)
        self.assertEqual(self.phases[-1], "closed")

    async def test_a_connection_that_comes_while_closing_is_closed(self):
        client = await self.join()
        dial, dialling, made = client._dial, asyncio.Event(), []

        async def late():
            dialling.set()
            try:
                await asyncio.sleep(60)
            except asyncio.CancelledError:
                made.append(await dial())
                return made[-1]

        client._dial = late
        await self.cut()
        await dialling.wait()
        await asyncio.wait_for(client.close(), 20)
        self.assertTrue(made[0].closed)
        self.assertEqual(self.phases[-1], "closed")


class PauseTest(unittest.TestCase):
    def test_pauses_double_from_a_quarter_of_a_second_to_eight_with_jitter_down_to_half(self):
        longest = [weft.pace.pause_before(attempt, 1) for attempt in range(8)]
        self.assertEqual(longest, [0.25, 0.5, 1, 2, 4, 8, 8, 8])
        self.assertEqual([weft.pace.pause_before(attempt, 0) for attempt in range(8)], [p / 2 for p in longest])
        self.assertEqual(weft.pace.pause_before(10**6, 1), 8)


if __name__ == "__main__":
    unittest.main()
