"""What it costs a server to tell a script each tick: `advance` with all observations, one tick a call, against
`weft simulate --check-every 10000000` of the same ticks.

Both are CPU time of the whole process [ms a tick], interleaved, the median of some rounds. Usage:
observe.py [--program weft] [--ticks N] [--rounds N]
"""

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
sys.path.insert(0, str(ROOT / "proto/python"))
import weft  # noqa: E402  (found by the line above)

OBSERVED = ("positions", "velocities", "contacts", "reactions", "grippers")
HANGING = {
    "name": "hanging",
    "cloths": [{"rows": 32, "columns": 32}],
    "pins": [{"place": "corner", "corner": "top_left"}, {"place": "corner", "corner": "top_right"}],
}
ALLOWED = 0.15  # [ms] beyond `simulate`


def simulated(program, scene, ticks):
    """CPU time of a run of so many ticks [s], with what its start costs."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    # A scene that does not pass its own check ends with 3, after all its ticks.
    subprocess.run([program, "simulate", "--scene", scene, "--ticks", str(ticks), "--check-every", "10000000"],
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=300, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


class Served:
    """A server of its own with a client, for one round."""

    def __init__(self, program, scene):
        self.process = subprocess.Popen(
            [program, "serve", "--port", "0", "--scene", scene, "--paused", "--threads", "1",
             "--count-crossings", "0", "--max-messages-per-second", "1000000"],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        told = json.loads(self.process.stdout.readline())
        self.cloth = weft.open(told["websocket"])
        self.cloth.request("view", hz=0)

    def cpu(self):
        fields = Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def observe(self, ticks):
        """CPU time of so many calls [s]."""
        before = self.cpu()
        for _ in range(ticks):
            frame = self.cloth.advance(1, observe=OBSERVED)["observation"]
        assert len(frame.velocities) == len(frame.positions)
        return self.cpu() - before

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.cloth.close()
        self.process.terminate()
        self.process.wait(20)


def measure(program, scene, ticks, rounds):
    """Medians of `simulate` and of `advance` [ms a tick]."""
    rows = []
    for _ in range(rounds):
        alone = simulated(program, scene, ticks + 1) - simulated(program, scene, 1)
        with Served(program, scene) as served:
            rows.append((alone / ticks * 1000, served.observe(ticks) / ticks * 1000))
    return [statistics.median(column) for column in zip(*rows)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default=str(ROOT / "build/weft"))
    parser.add_argument("--ticks", type=int, default=600)
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    print(f"{'scene':10} {'simulate':>10} {'observed':>10} {'more':>7}  [ms CPU a tick]")
    with tempfile.TemporaryDirectory() as folder:
        hanging = Path(folder, "hanging.json")
        hanging.write_text(json.dumps(HANGING), encoding="utf-8")
        for scene in ("gripper", "default", str(hanging)):
            alone, observed = measure(options.program, scene, options.ticks, options.rounds)
            verdict = "" if observed <= alone + ALLOWED else f"  above the bar of {ALLOWED}"
            print(f"{Path(scene).stem:10} {alone:10.3f} {observed:10.3f} {observed - alone:7.3f}{verdict}", flush=True)


if __name__ == "__main__":
    main()
