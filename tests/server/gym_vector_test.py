"""Many environments in one server: each moves as one alone does, and all go on together."""

import sys
import unittest

import numpy as np
from foreign_client import Server, main
from gym_test import CLIENT, SMALL, draw_fabric, grasp

sys.path.insert(0, str(CLIENT))

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


if __name__ == "__main__":
    main()
