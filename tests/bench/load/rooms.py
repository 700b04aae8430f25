#!/usr/bin/python3
"""Many rooms in one server: what they cost, how late their ticks begin, and what lock-step in many costs more than in one.

    ./dev build && /usr/bin/python3 tests/bench/load/rooms.py [--build build] [--seconds 10] [--runs 3]
                                     [class] [overrun] [lock-step]

`class`: 30 rooms of `default`, then 15 of a curtain of 32 x 32 particles, one viewer each (weft_load, in a process of
its own). Told are the CPU time of all ticks, of all turns (ticks, commands, news) and of the process, each a simulated
second of one room, and simulated per real time, of the slowest room and of all.
`overrun`: 10 light rooms alone, and beside one whose ticks take twice their time. Told is by how much 99 of 100 ticks of
the light ones are late at most, the best of the runs.
`lock-step`: 64 rooms of 17 x 17, each advanced by a script of its own at once, and one room advanced 64 times as far.
Told is the CPU time of the server.
"""

import argparse
import asyncio
import json
import os
import re
import subprocess
import sys
import urllib.request
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "proto/python"))

import weft  # noqa: E402  its folder is not installed

LATE = re.compile(r'weft_tick_late_seconds_bucket\{room="([^"]+)",le="([^"]+)"\} (\d+)')


class Server:
    def __init__(self, build, seconds, *options):
        self.process = subprocess.Popen(
            [build / "weft", "serve", "--port", "0", "--max-viewers", "200", "--room-idle", "0", "--rooms", "100",
             "--max-seconds", str(seconds), "--log-level", "error", *options], stdout=subprocess.PIPE, text=True)
        self.addresses = json.loads(self.process.stdout.readline())
        self.socket = self.addresses["websocket"]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait(10)

    def metrics(self):
        with urllib.request.urlopen(self.addresses["url"] + "metrics", timeout=10) as answer:
            return answer.read().decode()

    def metric(self, name, room=None):
        label = f'{{room="{room}"}}' if room else ""
        return float(re.search(f"^weft_{name}{re.escape(label)} (.*)$", self.metrics(), re.MULTILINE)[1])

    def cpu(self):
        """CPU time of the process [s]."""
        fields = Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def threads(self):
        return len(list(Path(f"/proc/{self.process.pid}/task").iterdir()))

    def memory(self):
        """Resident memory [MiB]."""
        status = Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", status)[1]) / 1024


def curtain(side):
    return [word for name in ("rows", "columns") for word in ("--set", f"cloths[0].{name}={side}")]


async def make_rooms(server, count, **options):
    async with weft.connect(server.socket) as viewer:
        for number in range(count):
            await viewer.create_room(f"room-{number}", **options)
        await viewer.pause()  # the default room, which is not measured


def look(server):
    return [server.metric("tick_cpu_seconds_total"), server.metric("cpu_seconds_total"), server.cpu(),
            server.metric("ticks_total")]


async def measure_class(o, title, rooms, options):
    with Server(o.build, o.seconds + 60, *options) as server:
        before = server.memory()
        await make_rooms(server, rooms)
        each = (server.memory() - before) / rooms
        load = subprocess.Popen([o.build / "weft_load", "--port", str(server.addresses["port"]), "--viewers", str(rooms),
                                 "--rooms", str(rooms), "--seconds", str(o.seconds + 4), "--codec", "packed"],
                                stdout=subprocess.PIPE, text=True)
        await asyncio.sleep(4)
        first, started = look(server), asyncio.get_running_loop().time()
        await asyncio.sleep(o.seconds)
        last, seconds = look(server), asyncio.get_running_loop().time() - started
        slowest = server.metric("real_time_factor")
        threads = server.threads()
        load.communicate()
    ticks, turns, process, count = (after - before for after, before in zip(last, first))
    simulated = count / 60 / rooms
    print(f"{title:28} ticks {ticks / simulated:5.2f}, turns {turns / simulated:5.2f}, process {process / simulated:5.2f} "
          f"cores a simulated second; x{simulated / seconds:.3f} of real time, slowest x{slowest:.3f}; "
          f"{each:.1f} MiB a room, {threads} threads", flush=True)


def p99_late(server, rooms):
    """By how much 99 of 100 ticks are late at most, between the bounds of the histogram [ms]."""
    counts = {}
    for room, bound, count in LATE.findall(server.metrics()):
        if room in rooms:
            counts[float(bound)] = counts.get(float(bound), 0) + int(count)
    return counts


def percentile(first, last, share=0.99):
    below, lower = 0, 0.0
    total = last[float("inf")] - first[float("inf")]
    for bound in sorted(last):
        count = last[bound] - first[bound]
        if count >= share * total:
            inside = (share * total - below) / max(1, count - below)
            return 1000 * (lower + inside * (min(bound, 0.25) - lower)), total
        below, lower = count, bound
    return float("inf"), total


async def measure_overrun(o, overruns):
    light = {f"room-{number}" for number in range(10)}
    with Server(o.build, o.seconds + 60) as server:
        await make_rooms(server, 10)
        viewers = [await weft.connect(f"{server.socket}/{name}") for name in sorted(light)]
        for viewer in viewers:
            await viewer.view(hz=1)
        factor = 0
        if overruns:
            await viewers[0].create_room("heavy", paused=True)
            heavy = await weft.connect(f"{server.socket}/heavy")
            await heavy.load({"name": "heavy", "cloths": [{"rows": 80, "columns": 80, "width": 1, "height": 1}],
                              "contact": {"self": "none"}, "solver": {"min_substeps": 1500}})
            await heavy.view(hz=0)
            await heavy.resume()
        await asyncio.sleep(2)
        first = p99_late(server, light)
        await asyncio.sleep(o.seconds)
        last = p99_late(server, light)
        if overruns:
            factor = server.metric("room_real_time_factor", "heavy")
            await heavy.close()
        for viewer in viewers:
            await viewer.close()
    return (*percentile(first, last), factor)


async def overrun(o):
    alone = min([await measure_overrun(o, False) for _ in range(o.runs)])
    beside = min([await measure_overrun(o, True) for _ in range(o.runs)])
    print(f"10 light rooms: p99 late {alone[0]:.2f} ms alone ({alone[1]:.0f} ticks), {beside[0]:.2f} ms beside one that "
          f"overruns ({beside[1]:.0f} ticks; that one x{beside[2]:.2f}): {beside[0] - alone[0]:+.2f} ms", flush=True)


async def lock_step_run(o, rooms, ticks):
    with Server(o.build, 600, *curtain(17), "--scene", "curtain", "--paused") as server:
        async with weft.connect(server.socket) as viewer:
            for number in range(rooms):
                await viewer.create_room(f"room-{number}", paused=True)
        viewers = [await weft.connect(f"{server.socket}/room-{number}") for number in range(rooms)]
        for viewer in viewers:
            await viewer.view(hz=0)
        before = server.cpu()

        async def run(viewer):
            for _ in range(ticks // 10):
                await viewer.advance(10)
        await asyncio.gather(*map(run, viewers))
        spent = server.cpu() - before
        for viewer in viewers:
            await viewer.close()
    return spent


async def lock_step(o):
    pairs = [(await lock_step_run(o, 1, 64 * 200), await lock_step_run(o, 64, 200)) for _ in range(o.runs)]
    one, many = (sorted(times)[len(times) // 2] for times in zip(*pairs, strict=True))
    print(f"64 x 200 ticks of 17 x 17: one room {one:.2f} s of CPU, 64 rooms {many:.2f} s: {100 * (many / one - 1):+.0f} %",
          flush=True)


async def measure(o):
    what = o.what or ["class", "overrun", "lock-step"]
    if "class" in what:
        await measure_class(o, "30 rooms of default", 30, ())
        await measure_class(o, "15 rooms of 32 x 32", 15, ("--scene", "curtain", *curtain(32)))
    if "overrun" in what:
        await overrun(o)
    if "lock-step" in what:
        await lock_step(o)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", nargs="*", choices=["class", "overrun", "lock-step", []])
    parser.add_argument("--build", type=Path, default=ROOT / "build")
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--runs", type=int, default=3)
    asyncio.run(measure(parser.parse_args()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
