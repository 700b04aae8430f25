"""No legal scene and no legal command stops a room: ticks that take too long are given up, joins, answers
and the end of the server do not wait for a tick, and what would cost too much is refused."""

import json
import os
import random
import signal
import subprocess
import tempfile
import time

from foreign_client import PATIENCE, PROGRAM, Server, SocketTest, Viewer, main

# About a second of CPU a tick: near the most that is taken.
HEAVY = {"name": "heavy", "cloths": [{"rows": 80, "columns": 80, "width": 1, "height": 1,
                                      "origin": [0, 1, 0]}],
         "solver": {"min_substeps": 20000}, "contact": {"self": "none"}}
LONG_TICKS = {**HEAVY, "name": "long"}


def scene_file(folder, scene):
    path = os.path.join(folder, scene["name"] + ".json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(scene, file)
    return path


class TickLimit(SocketTest):
    options = ("--tick-limit", "0.1", "--paused")

    async def test_a_tick_beyond_the_limit_pauses_the_room_and_is_told_with_its_cause(self):
        viewer = await Viewer.open(self.server)
        loaded = await viewer.ask("load", scene=HEAVY)
        self.assertEqual(loaded["op"], "result", loaded)
        error = await viewer.ask("advance", n=3)
        self.assertEqual(error["code"], "halted", error)
        self.assertIn("0.1 s of CPU", error["message"])
        self.assertEqual((await viewer.ask("hash"))["tick"], 0)
        await viewer.ask("resume")
        notice = await viewer.wait_text(lambda m: m["op"] == "notice" and m["code"] == "halted")
        self.assertIn("paused", notice["message"])
        await viewer.wait_text(lambda m: m["op"] == "state" and m["paused"])
        self.assertIn("weft_ticks_halted_total", self.server.get("/metrics")[2].decode())
        await viewer.close()


class NoLimit(SocketTest):
    options = ("--tick-limit", "0", "--count-crossings", "0")

    async def test_joins_and_answers_and_loads_do_not_wait_for_a_tick(self):
        viewer = await Viewer.open(self.server)
        loaded = await viewer.ask("load", scene=LONG_TICKS)
        self.assertEqual(loaded["op"], "result", loaded)
        for _ in range(3):
            other = await Viewer.open(self.server)
            answer = await other.ask("camera", position=[0, 1, 3], target=[0, 1, 0], fov=50)
            self.assertEqual(answer["op"], "result", answer)
            await other.close()
        await viewer.ask("reset")
        loaded = await viewer.ask("load", scene="default")
        self.assertEqual(loaded["scene"], "default")
        await viewer.close()

    async def test_what_would_cost_too_much_is_refused_and_the_room_goes_on(self):
        viewer = await Viewer.open(self.server)
        grid = {"cloths": [{"rows": 1000, "columns": 1000, "width": 1, "height": 1}]}
        for scene in (grid, {"cloths": 64 * [{"rows": 128, "columns": 128}]}):
            error = await viewer.ask("load", scene=scene)
            self.assertEqual(error["code"], "too_costly", error)
            self.assertIn("particles", error["message"])
        large = {**HEAVY["cloths"][0], "rows": 160, "columns": 160}
        await viewer.ask("load", scene={**HEAVY, "cloths": [large], "solver": {"min_substeps": 1}})
        error = await viewer.ask("set", gravity=[0, -1000, 0], wind=[100, 100, 100],
                                 air_density=1000, drag=0)
        self.assertEqual(error["code"], "too_costly", error)
        self.assertIn("substeps", error["message"])
        self.assertEqual((await viewer.ask("hash"))["op"], "result")
        await viewer.close()


class Ends(SocketTest):
    def test_sigterm_is_obeyed_within_two_seconds_in_the_midst_of_ticks_and_loads(self):
        chance = random.Random(7)
        with tempfile.TemporaryDirectory() as folder:
            path = scene_file(folder, LONG_TICKS)
            for number in range(8):
                server = Server("--tick-limit", "0", "--scene", path)
                try:
                    time.sleep(chance.uniform(0.05, 0.6))
                    server.process.send_signal(signal.SIGTERM)
                    started = time.monotonic()
                    self.assertEqual(server.process.wait(timeout=PATIENCE), 0)
                    # Two seconds on a machine that does nothing else.
                    self.assertLess(time.monotonic() - started, 8)
                finally:
                    server.process.kill()
                    server.process.wait()
                    server.process.stdout.close()

    def test_readyz_says_that_a_tick_does_not_end(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = {**HEAVY, "name": "endless", "tick_rate": 1}
            scene["cloths"] = [{**HEAVY["cloths"][0], "rows": 85, "columns": 85}]
            scene["contact"] = {"self": "particles", "model": "seed", "passes": 100}
            scene["model"] = "weft"
            server = Server("--tick-limit", "0", "--scene", scene_file(folder, scene))
            try:
                last = time.monotonic() + PATIENCE
                while time.monotonic() < last:
                    status, _, body = server.get("/readyz")
                    if status == 503 and json.loads(body).get("stalled", 0) > 1:
                        break
                    time.sleep(0.1)
                self.assertEqual(status, 503, body)
                self.assertGreater(json.loads(body)["stalled"], 1)
                self.assertEqual(server.get("/healthz")[0], 200)  # below half a minute
            finally:
                server.stop()

    def test_simulate_ends_with_a_message_and_a_code_of_its_own(self):
        with tempfile.TemporaryDirectory() as folder:
            path = scene_file(folder, LONG_TICKS)
            run = subprocess.run([PROGRAM, "simulate", "--scene", path, "--ticks", "2",
                                  "--tick-limit", "0.05"], capture_output=True, text=True,
                                 timeout=PATIENCE, check=False)
            self.assertEqual(run.returncode, 4, run)
            self.assertIn("tick 1", run.stderr)
            self.assertIn("0.05 s of CPU", run.stderr)
            self.assertEqual(run.stdout, "")

    def test_simulate_tells_what_crossed_before_the_tick_that_is_given_up(self):
        scenes = subprocess.run([PROGRAM, "scenes", "--json", "hard-start-fold"], capture_output=True, text=True,
                                timeout=PATIENCE, check=True)
        # A fold that starts through itself; after six ticks a storm asks for thousands of substeps.
        storm = {**json.loads(scenes.stdout), "name": "storm", "verdict": {"strain": 0, "clear_after": 0}}
        storm["winds"] = [{"time": time, "wind": 3 * [speed]} for time, speed in ((0, 0), (0.1, 0), (0.101, 100))]
        storm["environment"]["air_density"] = 1000
        with tempfile.TemporaryDirectory() as folder:
            path = scene_file(folder, storm)
            for every, looked_at in (("1", 6), ("4", 2), ("1000", 1)):
                run = subprocess.run([PROGRAM, "simulate", "--scene", path, "--ticks", "9", "--any-cost",
                                      "--tick-limit", "0.5", "--check-every", every],
                                     capture_output=True, text=True, timeout=PATIENCE, check=False)
                self.assertEqual((run.returncode, run.stdout), (4, ""), run)
                self.assertRegex(run.stderr, "tick 7 of scene .* was given up")
                self.assertRegex(run.stderr, r"weft: [1-9]\d* crossings of cloth with cloth and 0 with objects in "
                                             rf"{looked_at} of {looked_at} ticks, from tick {min(int(every), 6)} on\n")
                self.assertIn("weft: guarantee bad_start; cloth started through itself\n", run.stderr)

    def test_simulate_refuses_what_would_cost_too_much_unless_told_otherwise(self):
        large = ("--set", "cloths[0].rows=600", "--set", "cloths[0].columns=600")
        costly = {**HEAVY, "name": "costly", "cloths": [{**HEAVY["cloths"][0], "rows": 100, "columns": 100}]}
        with tempfile.TemporaryDirectory() as folder:
            path = scene_file(folder, costly)
            for options, words in ((large, ["360000 particles", "300000"]),
                                   (("--scene", path), ["10000 particles x 20000 substeps", "150000000",
                                                        "--any-cost"])):
                run = subprocess.run([PROGRAM, "simulate", *options, "--ticks", "1"],
                                     capture_output=True, text=True, timeout=PATIENCE, check=False)
                self.assertEqual(run.returncode, 2, run)
                for word in words:
                    self.assertIn(word, run.stderr)
                self.assertEqual(run.stderr.count("\n"), 1)
                self.assertEqual(run.stdout, "")
            # Taken, it is given up as soon as it has cost as much as a tick may.
            run = subprocess.run([PROGRAM, "simulate", "--scene", path, "--ticks", "1", "--any-cost",
                                  "--tick-limit", "0.05"],
                                 capture_output=True, text=True, timeout=PATIENCE, check=False)
            self.assertEqual(run.returncode, 4, run)


if __name__ == "__main__":
    main()
