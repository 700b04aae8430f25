"""Hands of the Python client, against a played server on loopback, over real sockets."""

import asyncio
import unittest
from unittest import mock

import weft
from played_server import PlayedServer, example

HIT = weft.Hit(411, (0.25, 0.5, 0.25), (0, 1, 0), 222, 2.88)


class HandsTest(unittest.IsolatedAsyncioTestCase):
    async def asyncSetUp(self):
        self.server = await self.enterAsyncContext(PlayedServer())
        self.client = await self.enterAsyncContext(weft.connect(self.server.url))

    async def test_a_drag_starts_moves_repeats_its_target_and_ends(self):
        self.server.answers = {"drag": [{"drag": 1, "grab": 17, "target": [1, 2, 3]}]}
        with mock.patch.object(weft.drag, "REPEAT_SECONDS", 0.01):
            async with self.client.drag(HIT, radius=0.05) as hand:
                self.assertEqual(hand.grab, 17)
                await self.server.until(lambda: len(self.server.of("drag")) >= 3)
                await hand.move([4, 5, 6])
                count = len(self.server.of("drag"))
                await self.server.until(lambda: len(self.server.of("drag")) >= count + 3)
        start, *moves, end = self.server.of("drag")
        self.assertEqual(
            {name: value for name, value in start.items() if name != "id"},
            {"op": "drag", "phase": "start", "drag": 1, "triangle": 411,
             "barycentric": [0.25, 0.5, 0.25], "radius": 0.05},
        )
        self.assertEqual(moves[0], {"op": "drag", "phase": "move", "drag": 1, "target": [1, 2, 3]})
        self.assertEqual(moves[-1]["target"], [4, 5, 6])
        self.assertEqual((end["phase"], end["drag"]), ("end", 1))

    async def test_a_drag_that_the_server_ended_ends_quietly(self):
        self.server.answers = {"drag": [{"grab": 17, "target": [1, 2, 3]}]}
        async with self.client.drag(3) as hand:
            self.server.answers = {"drag": [{"op": "error", "code": "unknown_drag", "message": ""}]}
            with self.assertRaises(weft.CommandError):
                await hand.move([0, 0, 0])

    async def hold(self, particle):
        """A hand, the room's number of which is 17."""
        self.server.answers = {"drag": [{"grab": 17, "target": [1, 2, 3]}]}
        return await self.client.drag(particle).start()

    async def told(self, event, *messages):
        """Lets the server say something, and waits for the last of it."""
        heard = asyncio.get_running_loop().create_future()
        stop = self.client.on(event, lambda _: heard.done() or heard.set_result(None))
        await self.server.say(*messages)
        await heard
        stop()

    async def test_a_hand_that_the_server_let_go_is_silent_from_then_on(self):
        grabs = example("grabs")
        held = {**grabs["grabs"][0], "id": 17}
        refusal = {"op": "error", "command": "drag", "message": "no"}
        unknown = {**refusal, "code": "unknown_drag", "field": "drag"}
        with mock.patch.object(weft.drag, "REPEAT_SECONDS", 0.01):
            ends = (  # what leaves it holding, and what ends it
                ("grabs", {**grabs, "grabs": [held]}, {**grabs, "grabs": [{**held, "id": 16}]}),
                ("grabs", {**grabs, "grabs": [held]}, {**grabs, "grabs": []}),
                ("refused", {**unknown, "value": 99}, {**unknown, "value": None}),
                ("refused", {**refusal, "command": "pin", "code": "not_allowed"}, {**refusal, "code": "not_allowed"}),
            )
            for event, harmless, last in ends:
                hand = await self.hold(7)
                if last.get("code") == "unknown_drag":
                    last["value"] = hand.number
                await self.told(event, harmless)
                self.assertTrue(hand.active)
                await self.told(event, last)
                self.assertFalse(hand.active)
                await self.client.pause()  # what was on its way has come
                count = len(self.server.of("drag"))
                await asyncio.sleep(0.05)
                self.assertIsNone(await hand.end())
                self.assertEqual(len(self.server.of("drag")), count)

    async def test_leaving_a_hand_that_may_not_hold_any_more_is_quiet(self):
        for code in ("unknown_drag", "not_allowed"):
            self.server.answers = {"drag": [{"grab": 17, "target": [1, 2, 3]}]}
            async with self.client.drag(3):  # the end crosses the message `grabs`
                self.server.answers = {"drag": [{"op": "error", "code": code, "message": ""}]}

    async def test_hands_have_numbers_of_their_own_and_hold_what_they_are_told(self):
        self.server.answers = {"drag": [{"grab": 1, "target": [0, 0, 0]}]}
        holds = (7, {"particle": 8}, {"triangle": 1, "barycentric": [1, 0, 0], "particle": 9}, HIT)
        hands = [await self.client.drag(hold).start() for hold in holds]
        starts = [message for message in self.server.of("drag") if message["phase"] == "start"]
        numbers = [message["drag"] for message in starts]
        self.assertEqual(len(set(numbers)), len(holds))
        particles = [message.get("particle") for message in starts]
        self.assertEqual(particles, [7, 8, None, None])
        for hand in hands:
            await hand.end()
            self.assertIsNone(await hand.end())  # once is enough


if __name__ == "__main__":
    unittest.main()
