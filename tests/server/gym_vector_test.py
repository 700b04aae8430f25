"""Many environments in one server: each moves as one alone does, and all go on together."""

import sys
import unittest

import numpy as np
from foreign_client import Server, main
from gym_test import CLIENT, SMALL, draw_fabric, grasp

sys.path.insert(0, str(CLIENT))

import weft  # noqa: E402
from weft import gym  # noqa: E402
from weft.gym import spaces  # noqa: E402

COUNT = 3


class VectorTest(unittest.TestCase):
    def setUp(self):
        self.server = Server()
        self.addCleanup(lambda: self.assertEqual(self.server.stop(), 0))

    def many(self, **options):
        envs = gym.VectorClothEnv(self.server.websocket, COUNT, **{"scene": SMALL, "limit": 100, **options})
        self.addCleanup(envs.close)
        return envs

    def test_each_room_moves_to_the_bits_of_an_environment_alone_with_its_seed_and_actions(self):
        options = {"prepare": grasp, "randomise": draw_fabric}
        chance = np.random.default_rng(1)
        actions = chance.uniform(-1, 1, (3, COUNT, 4)).astype(np.float32)
        envs = self.many(**options)
        together = [envs.reset(seed=20)[0], *(envs.step(action)[0] for action in actions)]
        alone = gym.ClothEnv(self.server.websocket, scene=SMALL, limit=100, **options)
        self.addCleanup(alone.close)
        for k in range(COUNT):
            own = [alone.reset(seed=20 + k)[0], *(alone.step(action[k])[0] for action in actions)]
            for seen, wanted in zip(together, own):
                for name, values in wanted.items():
                    self.assertTrue(np.array_equal(seen[name][k], values), (k, name))

    def test_observations_and_actions_are_of_their_batched_spaces(self):
        envs = self.many()
        self.assertEqual(envs.action_space.shape, (COUNT, *envs.single_action_space.shape))
        seen, _ = envs.reset(seed=[1, 2, 3])
        self.assertTrue(envs.observation_space.contains(seen))
        seen, rewards, finished, cut, info = envs.step(envs.action_space.sample())
        self.assertTrue(envs.observation_space.contains(seen))
        self.assertEqual([part.shape for part in (rewards, finished, cut)], [(COUNT,)] * 3)
        self.assertEqual(info["tick"].tolist(), [7] * COUNT)
        if spaces.gymnasium:
            self.assertEqual(envs.metadata["autoreset_mode"], spaces.gymnasium.vector.AutoresetMode.NEXT_STEP)

    def test_an_episode_that_is_over_begins_anew_in_the_next_step_alone(self):
        # Environment 0 goes to the right and is finished there; the others stand.
        envs = self.many(finished=lambda seen: seen["grippers"][0][0] > 0.015,
                         reward=lambda before, after, action: 1.0)
        first, _ = envs.reset()
        actions = np.zeros((COUNT, 4), np.float32)
        actions[0, 0] = 1
        _, rewards, finished, cut, _ = envs.step(actions)
        self.assertEqual((finished.tolist(), cut.tolist()), ([True, False, False], [False] * COUNT))
        seen, rewards, finished, _, info = envs.step(actions)
        self.assertEqual((rewards.tolist(), finished.tolist()), ([0, 1, 1], [False] * COUNT))
        self.assertTrue(np.array_equal(seen["positions"][0], first["positions"][0]))
        self.assertEqual(info["tick"].tolist(), [1, 13, 13])

    def test_closing_closes_the_rooms(self):
        envs = self.many()
        envs.close()
        with_rooms = self.server.get("/api/v1/rooms")[2]
        self.assertNotIn(b"gym-", with_rooms)

    def hall(self):
        hall = weft.open(self.server.websocket)
        self.addCleanup(hall.close)
        return hall

    def names(self):
        return sorted(room["name"] for room in self.hall().list_rooms()["rooms"])

    def test_two_share_a_server_and_each_closes_its_own_rooms(self):
        still = np.zeros((COUNT, 4), np.float32)
        self.hall().create_room("gym-1")  # a stranger's
        one, two = self.many(), self.many()
        self.assertEqual(self.names(), ["default", *(f"gym-{k}" for k in range(2 * COUNT + 1))])
        self.assertTrue(np.array_equal(one.reset(seed=1)[0]["positions"], two.reset(seed=1)[0]["positions"]))
        two.close()
        self.assertEqual(self.names(), ["default", *(f"gym-{k}" for k in range(COUNT + 1))])
        self.assertEqual(one.step(still)[4]["tick"].tolist(), [7] * COUNT)
        one.close()
        self.assertEqual(self.names(), ["default", "gym-1"])

    def test_a_constructor_that_fails_leaves_the_rooms_of_others_and_none_of_its_own(self):
        async def fail(cloth):
            raise KeyError("no grasp")

        self.server.stop()
        self.server = Server("--rooms", str(2 * COUNT))
        one = self.many()
        one.reset()
        before = self.names()
        for options, error, what in (({}, weft.CommandError, "close one that is no longer used"),
                                     ({"prepare": fail}, KeyError, "no grasp"),
                                     ({"rooms": "x" * 31}, weft.CommandError, "name must have")):
            with self.assertRaisesRegex(error, what):
                self.many(**options)
            self.assertEqual(self.names(), before)
        one.step(np.zeros((COUNT, 4), np.float32))

    def test_a_name_that_another_took_after_its_room_was_closed_is_not_closed(self):
        envs, hall = self.many(), self.hall()
        hall.close_room("gym-1")
        hall.create_room("gym-1")
        self.assertTrue(envs._runner._run(self.lost(envs._rooms["gym-1"])))
        envs.close()
        self.assertEqual(self.names(), ["default", "gym-1"])

    @staticmethod
    async def lost(client):
        await client._reader
        return client.welcome is None

    def test_wrong_actions_and_arguments_are_refused_and_move_none(self):
        envs = self.many()
        envs.reset()
        one_nan = np.zeros((COUNT, 4))
        one_nan[1, 2] = np.nan
        for wrong in (one_nan, np.zeros((COUNT, 8)), np.zeros((COUNT, 3)), np.zeros((2, 4)), np.zeros(4 * COUNT), None):
            with self.assertRaisesRegex(ValueError, rf"shape \({COUNT}, 4\)"):
                envs.step(wrong)
        self.assertEqual(envs.step(np.full((COUNT, 4), 1.5))[4]["tick"].tolist(), [7] * COUNT)
        for name, wrong in (("ticks", 0), ("limit", 0)):
            with self.assertRaisesRegex(ValueError, f"{name} is a whole number"):
                self.many(**{name: wrong})
        with self.assertRaisesRegex(ValueError, "num_envs is a whole number"):
            gym.VectorClothEnv(self.server.websocket, 0, scene=SMALL)

    def test_rooms_that_another_viewer_sets_going_or_loads_are_brought_back(self):
        envs = self.many(prepare=grasp)
        first, _ = envs.reset()
        for k in (0, 2):
            with weft.open(self.server.websocket + f"/gym-{k}") as other:
                other.load("flag")
                other.resume()
            again, info = envs.reset()
            self.assertEqual(info["tick"].tolist(), [61] * COUNT)
            for name, values in first.items():
                self.assertTrue(np.array_equal(again[name], values), name)


if __name__ == "__main__":
    main()
