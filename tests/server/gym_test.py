"""The Gymnasium environment against the real server: by Gymnasium's own check where that is installed, by laws here."""

import gc
import subprocess
import sys
import threading
import unittest
from pathlib import Path

import numpy as np
from foreign_client import Server, main

CLIENT = Path(__file__).resolve().parents[2] / "proto/python"
sys.path.insert(0, str(CLIENT))

import weft  # noqa: E402
from weft import gym  # noqa: E402
from weft.gym import picture, spaces  # noqa: E402
from weft.messages import Fabric  # noqa: E402

SMALL = {
    "name": "small",
    "environment": {"drag": 1, "air_density": 0},
    "cloths": [{"rows": 9, "columns": 9, "width": 0.2, "height": 0.2, "origin": [-0.1, 1.2, 0], "v": [0, -1, 0]}],
    "pins": [{"place": "edge", "side": "top"}],
    "grippers": [{"name": "gripper", "center": [0, 1.05, 0], "half_extents": [0.005, 0.02, 0.04], "opening": 0.04,
                  "orientation": [0, -0.7071067811865476, 0, 0.7071067811865476]}],
}
CLOSED = np.array([0, 0, 0, -1], np.float32)


def draw_fabric(chance):
    fabric: Fabric = {"areal_density": float(chance.uniform(0.1, 0.4)), "stretch_weft": float(chance.uniform(50, 400))}
    return {"fabric": fabric}


async def grasp(cloth):
    """The start of an episode: the jaws hold the cloth."""
    await cloth.gripper("gripper", opening=0, force=2)
    await cloth.advance(60)


def same(a, b):
    return set(a) == set(b) and all(np.array_equal(a[name], b[name]) for name in a)


class GymTest(unittest.TestCase):
    def setUp(self):
        self.server = Server()
        self.addCleanup(lambda: self.assertEqual(self.server.stop(), 0))

    def env(self, **options):
        made = gym.ClothEnv(self.server.websocket, **{"scene": SMALL, "limit": 5, **options})
        self.addCleanup(made.close)
        return made

    def test_gymnasiums_own_check_passes_where_it_is_installed(self):
        env = self.env(render_mode="rgb_array", randomise=draw_fabric)
        if spaces.gymnasium:
            from gymnasium.utils.env_checker import check_env  # noqa: PLC0415
            check_env(env)
        env.close()
        if not spaces.gymnasium:
            self.skipTest("gymnasium is not installed, so its check_env was not run")

    def test_an_episode_is_decided_by_its_seed_and_its_actions_to_the_bit(self):
        env = self.env(randomise=draw_fabric)
        actions = [np.random.default_rng(k).uniform(-1, 1, 4).astype(np.float32) for k in range(3)]
        runs = []
        for seed in (5, 6, 5):
            first, info = env.reset(seed=seed)
            runs.append(([first, *(env.step(action)[0] for action in actions)], info["settings"]))
        self.assertEqual(runs[0][1], runs[2][1])
        self.assertNotEqual(runs[0][1], runs[1][1])
        self.assertTrue(all(map(same, runs[0][0], runs[2][0])))
        self.assertFalse(same(runs[0][0][-1], runs[1][0][-1]))

    def test_observations_and_actions_are_of_their_spaces_and_an_episode_is_cut_at_its_limit(self):
        env = self.env(limit=3)
        seen, _ = env.reset()
        self.assertTrue(env.observation_space.contains(seen))
        for k in range(1, 4):
            action = env.action_space.sample()
            self.assertTrue(env.action_space.contains(action))
            seen, reward, finished, cut, info = env.step(action)
            self.assertTrue(env.observation_space.contains(seen))
            self.assertEqual((type(reward), finished, cut), (float, False, k == 3))
            self.assertEqual(info["tick"], 1 + 6 * k)

    def test_an_episode_ends_when_it_is_finished_and_its_reward_is_what_was_asked_for(self):
        env = self.env(finished=lambda seen: seen["grippers"][0][0] > 0.015,
                       reward=lambda before, after, action: float(action.sum()))
        env.reset()
        for far in (False, True):
            _, reward, finished, _, _ = env.step(np.array([0.5, 0, 0.25, 1], np.float32))
            self.assertEqual((reward, finished), (1.75, far))

    def test_the_start_that_was_prepared_is_what_each_reset_goes_back_to(self):
        env = self.env(prepare=grasp)
        first, _ = env.reset()
        self.assertAlmostEqual(first["grippers"][0][7], 0.008, delta=1e-4)  # two thicknesses: it holds the cloth
        for _ in range(3):
            env.step(np.array([0, 1, 0, -1], np.float32))
        again, _ = env.reset()
        self.assertTrue(same(first, again))

    def test_a_gripper_goes_where_its_action_says_and_lifts_what_it_holds(self):
        env = self.env(prepare=grasp, limit=100)
        seen, _ = env.reset()
        before = seen["grippers"][0][:3]
        for _ in range(3):
            seen, reward, *_ = env.step(np.array([0, 0.5, 0, -1], np.float32))
        for _ in range(3):
            seen, *_ = env.step(CLOSED)
        np.testing.assert_allclose(seen["grippers"][0][:3] - before, [0, 0.03, 0], atol=1e-4)
        self.assertGreater(reward, 0)

    def test_a_hand_takes_its_particle_pulls_it_and_lets_go(self):
        corner = 80
        env = self.env(actors=[gym.Hand(corner, reach=0.05)], limit=100)
        hanging, _ = env.reset()
        for _ in range(12):
            pulled, *_ = env.step(np.array([0, 0, 0.2, 1], np.float32))
        for _ in range(12):
            pulled, *_ = env.step(np.array([0, 0, 0, 1], np.float32))
        for _ in range(60):
            free, *_ = env.step(np.array([0, 0, 0, -1], np.float32))
        self.assertGreater(pulled["positions"][corner, 2], 0.08)
        self.assertLess(abs(free["positions"][corner, 2]), 0.03)
        self.assertLess(abs(hanging["positions"][corner, 2]), 1e-3)

    def test_a_scene_without_the_gripper_is_told_with_those_that_it_has(self):
        with self.assertRaisesRegex(ValueError, "'hand'; it has gripper"):
            self.env(actors=[gym.Gripper("hand")])
        with self.assertRaisesRegex(ValueError, "rgb_array"):
            self.env(render_mode="human")

    def test_arguments_out_of_range_are_refused_by_the_constructor(self):
        for wrong in ({"ticks": 0}, {"ticks": 100_001}, {"ticks": 1.5}, {"limit": 0}, {"size": (0, 80)}):
            with self.assertRaisesRegex(ValueError, f"{next(iter(wrong))} is a whole number"):
                self.env(**wrong)
        for kind, wrong in ((gym.Gripper, {"opening": 1.01}), (gym.Gripper, {"opening": float("nan")}),
                            (gym.Gripper, {"force": -1}), (gym.Gripper, {"speed": 0}), (gym.Gripper, {"reach": -1}),
                            (gym.Hand, {"particle": -1}), (gym.Hand, {"radius": 101}), (gym.Hand, {"max_force": -1})):
            with self.assertRaisesRegex(ValueError, f"{next(iter(wrong))} is a "):
                kind(**wrong)
        with self.assertRaisesRegex(ValueError, "81 particles, from 0, and no 81"):
            self.env(actors=[gym.Hand(81)])

    def test_the_server_takes_the_largest_and_the_least_arguments(self):
        for actors in ([gym.Gripper(opening=1, force=1000, speed=20, reach=0), gym.Hand(80, 0, 100, 1e5, 1e6)],
                       [gym.Gripper(opening=0, force=0, speed=0.001), gym.Hand(0, 0, 0, 0, 0)]):
            env = self.env(actors=actors, ticks=1)
            env.reset()
            for _ in range(2):
                env.step([1] * 8)
            env.close()

    def test_an_action_beyond_its_space_is_clipped_and_its_reward_is_of_what_was_done(self):
        env = self.env(reward=lambda before, after, action: float(action.sum()), limit=100)
        runs = []
        for action in ([0, 1, -1, -1], [0, 1.01, -3, -1.2]):
            env.reset()
            runs.append([env.step(np.array(action, np.float32))[:2] for _ in range(5)])
        for (seen, reward), (clipped, of_clipped) in zip(*runs):
            self.assertTrue(same(seen, clipped))
            self.assertEqual((reward, of_clipped), (-1, -1))
        self.assertAlmostEqual(clipped["grippers"][0][1] - 1.05, 5 * 0.02, delta=1e-3)

    def test_an_action_of_a_wrong_shape_or_not_finite_is_refused_and_moves_nothing(self):
        env = self.env(actors=[gym.Gripper(), gym.Hand(80)], limit=100)
        still, runs = np.zeros(8, np.float32), []
        for wrong in ((), (np.full(8, np.nan), [0, np.inf, 0, 0, 0, 0, 0, 0], np.zeros(4), np.zeros(16),
                           np.zeros((2, 4)), None, ["a"] * 8, [[0], [0, 1]])):
            env.reset()
            for action in wrong:
                with self.assertRaisesRegex(ValueError, r"4 numbers from -1 to 1 for each actor, shape \(8,\)"):
                    env.step(action)
            seen, *_, info = env.step(still)
            runs.append(seen)
            self.assertEqual(info["tick"], 7)
        self.assertTrue(same(*runs))

    def test_what_the_server_refuses_of_an_action_is_told(self):
        env = self.env(actors=[gym.Gripper(reach=600)])
        env.reset()
        env.step([1, 0, 0, 1])
        with self.assertRaisesRegex(weft.CommandError, "position") as raised:
            env.step([1, 0, 0, 1])
        self.assertEqual(raised.exception.code, "out_of_range")
        env.reset()
        env.step([1, 0, 0, 1])

    def other(self):
        viewer = weft.open(self.server.websocket, name="other")
        self.addCleanup(viewer.close)
        return viewer

    def test_a_room_that_another_viewer_sets_going_is_paused_again(self):
        env, other = self.env(prepare=grasp), self.other()
        first, _ = env.reset()
        other.resume()
        again, info = env.reset()
        self.assertTrue(same(first, again))
        other.resume()
        _, _, _, _, after = env.step(CLOSED)
        self.assertGreaterEqual(after["tick"], info["tick"] + 6)
        self.assertTrue(other.query("state")["paused"])

    def test_a_step_that_another_viewer_stops_goes_on_to_its_end(self):
        env, other = self.env(ticks=3000), self.other()
        env.reset()
        seen = []
        running = threading.Thread(target=lambda: seen.append(env.step(CLOSED)[4]["tick"]))
        running.start()
        while running.is_alive() and other.query("state")["tick"] < 10:
            pass
        other.pause()
        running.join()
        self.assertEqual(seen, [3001])

    def test_after_another_viewers_load_a_reset_brings_the_scene_of_the_environment_back(self):
        env, other = self.env(prepare=grasp), self.other()
        first, _ = env.reset()
        lifted = env.step(np.array([0, 1, 0, -1], np.float32))[0]
        for _ in range(2):
            other.load("flag")
            with self.assertRaisesRegex(weft.WeftError, r"another viewer loaded .* reset\(\) loads"):
                env.step(CLOSED)
            again, _ = env.reset()
            self.assertTrue(same(first, again))
            self.assertTrue(same(lifted, env.step(np.array([0, 1, 0, -1], np.float32))[0]))

    def test_a_hand_that_another_viewer_made_let_go_takes_hold_anew(self):
        env, other = self.env(actors=[gym.Hand(80)], limit=100), self.other()
        env.reset()
        env.step(np.ones(4, np.float32))
        other.reset()
        self.assertEqual(other.query("grabs"), [])
        env.step(np.ones(4, np.float32))
        self.assertEqual(len(other.query("grabs")), 1)
        other.reset()
        env.reset()  # what holds no more needs not let go

    def test_closing_while_a_hand_holds_says_nothing(self):
        with self.assertNoLogs("asyncio", "WARNING"):
            env = gym.ClothEnv(self.server.websocket, scene=SMALL, actors=[gym.Hand(80)])
            env.reset()
            env.step(np.ones(4, np.float32))
            env.close()
            del env  # with it goes its loop, which tells what it left undone
            gc.collect()

    def test_a_picture_shows_the_cloth_and_needs_no_window(self):
        env = self.env(render_mode="rgb_array", size=(60, 80))
        env.reset()
        image = env.render()
        self.assertEqual((image.shape, image.dtype), ((60, 80, 3), np.uint8))
        covered = (image != picture.BACKGROUND).any(axis=2).mean()
        self.assertGreater(covered, 0.05)
        self.assertLess(covered, 0.9)


class PictureTest(unittest.TestCase):
    """A square of 1 m, seen from above: how many pixels it covers, and what is nearer hides it."""

    def draw(self, *heights, rows=200):
        points = np.array([[x, h, z] for h in heights for x, z in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))])
        triangles = np.array([[4 * k + i for i in t] for k in range(len(heights)) for t in ((0, 2, 1), (0, 3, 2))])
        mesh = {"colliders": [], "view": {"target": [0, 0, 0], "direction": [0, 1, 0], "radius": 1.0},
                "cloths": [{"first_triangle": 2 * k, "triangles": 2, "look": {"color": color}}
                           for k, color in zip(range(len(heights)), ("#ff0000", "#0000ff"))]}
        data = type("Data", (), {"rest_positions": points, "triangles": triangles, "colliders": ()})
        frame = type("Frame", (), {"positions": points.astype(np.float32), "poses": {}})
        return picture.Picture(mesh, data, (rows, rows)).of(frame)

    def test_a_square_covers_the_pixels_of_its_projection_to_2_percent(self):
        half = np.tan(picture.FIELD / 2)
        distance = picture.MARGIN / np.sin(picture.FIELD / 2)
        for height in (0, 1):
            side = 200 / (2 * half * (distance - height))
            image = self.draw(height)
            covered = (image != picture.BACKGROUND).any(axis=2).sum()
            self.assertAlmostEqual(covered, side * side, delta=0.02 * side * side)

    def test_what_is_nearer_hides_what_is_behind_it_in_either_order(self):
        for heights, nearer in (((0, 0.1), 2), ((0.1, 0), 0)):
            middle = self.draw(*heights)[100, 100]
            self.assertGreater(middle[nearer], 50)
            self.assertEqual(middle[2 - nearer], 0)


class WithoutGymnasium(unittest.TestCase):
    def test_it_imports_without_gymnasium(self):
        script = "import sys; sys.modules['gymnasium'] = None; from weft import gym; from weft.gym import spaces; " \
                 "assert spaces.gymnasium is None; print(gym.ClothEnv.__mro__[1].__name__)"
        done = subprocess.run([sys.executable, "-B", "-c", script], capture_output=True, text=True, timeout=60,
                              check=True, cwd=CLIENT)
        self.assertEqual(done.stdout.strip(), "PlainEnv")


if __name__ == "__main__":
    main()
