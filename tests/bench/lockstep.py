#!/usr/bin/python3
"""What it costs a server to step many rooms in lock-step, against as many times one room alone.

Usage: lockstep.py [--program build/weft] [--rooms 64] [--steps 50] [--repeats 3]
Prints the CPU seconds of the server (user and system) for each, and their ratio.
"""

import argparse
import json
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "proto/python"))

import numpy as np  # noqa: E402
from weft import gym  # noqa: E402

SIDE = 17  # particles of a cloth along each side
SCENE = {
    "name": "lockstep",
    "environment": {"drag": 1},
    "cloths": [{"rows": SIDE, "columns": SIDE, "width": 0.3, "height": 0.3, "origin": [-0.15, 1.3, 0], "v": [0, -1, 0]}],
    "pins": [{"place": "edge", "side": "top"}],
    "grippers": [{"name": "gripper", "center": [0, 1.05, 0], "half_extents": [0.005, 0.02, 0.04], "opening": 0.04,
                  "orientation": [0, -0.7071067811865476, 0, 0.7071067811865476]}],
}
NANOSECONDS = 1e9


def cpu_of(pid):
    """Seconds that a process has computed, all threads together."""
    times = (path.read_text(encoding="ascii").split()[0] for path in Path(f"/proc/{pid}/task").glob("*/schedstat"))
    return sum(map(int, times)) / NANOSECONDS


def cost(program, rooms, steps, blocks):
    """CPU of the server for some blocks of steps of all rooms, each from the start; not for the way back to it."""
    server = subprocess.Popen([program, "serve", "--port", "0", "--max-seconds", "600", "--log-level", "error",
                               "--rooms", str(rooms + 1), "--paused"], stdout=subprocess.PIPE, text=True)
    try:
        address = json.loads(server.stdout.readline())["websocket"]
        envs = gym.VectorClothEnv(address, rooms, scene=SCENE, limit=10**6)
        actions = np.random.default_rng(2).uniform(-1, 1, (steps, 1, 4)).astype(np.float32)
        spent = 0
        for _ in range(blocks):
            envs.reset()
            begin = cpu_of(server.pid)
            for action in actions:
                envs.step(np.repeat(action, rooms, axis=0))
            spent += cpu_of(server.pid) - begin
        envs.close()
        return spent
    finally:
        server.terminate()
        server.wait(timeout=30)
        server.stdout.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--program", default=str(ROOT / "build/weft"))
    parser.add_argument("--rooms", type=int, default=64)
    parser.add_argument("--steps", type=int, default=50)
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args()
    ratios = []
    for _ in range(options.repeats):
        alone = cost(options.program, 1, options.steps, options.rooms)
        together = cost(options.program, options.rooms, options.steps, 1)
        ratios.append(together / alone)
        print(f"{options.rooms} rooms together {together:.2f} s, as many times one alone {alone:.2f} s: "
              f"{ratios[-1]:.3f}", flush=True)
    print(f"median {statistics.median(ratios):.3f}")


if __name__ == "__main__":
    main()
