"""One hostile viewer beside three others, a quiet and a hostile part of time in turn.

    WEFT_PROGRAM=build/weft /usr/bin/python3 tests/server/hostile_viewer.py [--seconds 300] [--part 30]
                                                     [--kinds harmless scene] [--sigterm 50] [--counts]

With what changes no one's scene (moves, pins, views, hello, names, queries, camera, refused loads,
garbage) the others keep 0.9 of the ticks and frames of the quiet parts beside it, and none of them is
closed. With what does (load, set, advance, pause, speed) each of their commands is answered within one
tick and 1 s of the server's CPU time, joins work, and memory stays within 200 MB of what the scene itself
takes. The server obeys SIGTERM within 2 s at any moment. Prints a table; exit code 1 tells that something
did not hold.

--counts judges what needs no clock: closed viewers, answers, joins, exit codes. The attacker is a
process of its own with plain websockets, so that no client of the project paces it.
"""

import argparse
import asyncio
import contextlib
import itertools
import json
import os
import random
import signal
import struct
import subprocess
import sys
import time
import urllib.request

import websockets

from hostile_attacks import HARMLESS, PATIENCE, SCENE, connect, drain

PROGRAM = os.environ.get("WEFT_PROGRAM", "")
OTHERS = 3
TICK_LIMIT = 2       # of CPU time, as the server has it [s]
ANSWER_LIMIT = 1     # of CPU time beside a tick [s]
MOST_MEMORY = 200    # above that of the quiet part before [MB]
LEAST_SHARE = 0.9    # of the quiet parts' ticks and frames
TERM_LIMIT = 2       # [s]


# ---- the server ----------------------------------------------------------------------------------

class Server:
    def __init__(self, seconds, *options):
        self.process = subprocess.Popen(
            [PROGRAM, "serve", "--port", "0", "--max-seconds", str(int(seconds)), "--log-level", "error",
             *options], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.addresses = json.loads(self.process.stdout.readline())

    def thread_times(self):
        """CPU time of each thread [s]."""
        times = {}
        folder = f"/proc/{self.process.pid}/task"
        with contextlib.suppress(OSError):
            for task in os.listdir(folder):
                with contextlib.suppress(OSError), open(f"{folder}/{task}/stat", encoding="ascii") as file:
                    fields = file.read().rsplit(")", 1)[1].split()
                    times[task] = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
        return times

    def memory(self):
        """Resident memory [MB]."""
        with contextlib.suppress(OSError), open(f"/proc/{self.process.pid}/status", encoding="ascii") as file:
            for line in file:
                if line.startswith("VmRSS"):
                    return int(line.split()[1]) / 1024
        return 0.0

    def ticks(self):
        """Ticks made since the start."""
        with urllib.request.urlopen(self.addresses["url"] + "metrics", timeout=PATIENCE) as answer:
            for line in answer.read().decode().splitlines():
                if line.startswith("weft_ticks_total"):
                    return int(float(line.split()[-1]))
        raise ValueError("the metrics name no ticks")

    def terminate(self):
        """Seconds until it has ended after SIGTERM, and its exit code; killed if it does not hear."""
        begin = time.monotonic()
        self.process.send_signal(signal.SIGTERM)
        try:
            code = self.process.wait(timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            self.process.kill()
            code = self.process.wait()
        self.process.stdout.close()
        return time.monotonic() - begin, code


def start_attacker(server, seconds, *kinds):
    script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "hostile_attacks.py")
    return subprocess.Popen([sys.executable, "-B", script, server.addresses["websocket"], str(seconds),
                             *kinds])


# ---- the others ----------------------------------------------------------------------------------

class Other:
    """A viewer that looks on, acknowledges, and asks for something four times a second."""

    def __init__(self, server):
        self.server = server
        self.frames = 0
        self.closed = False
        self.asked = self.answered = 0
        self.longest = self.longest_cpu = 0.0
        self.waiting = {}
        self.halts = 0
        self.tasks = []

    async def open(self):
        self.socket = await connect(self.server.addresses["websocket"])
        self.tasks = [asyncio.ensure_future(self.read()), asyncio.ensure_future(self.ask())]

    async def read(self):
        with contextlib.suppress(websockets.ConnectionClosed):
            async for message in self.socket:
                if isinstance(message, bytes):
                    if message[0] == 1:
                        self.frames += 1
                        sequence = struct.unpack_from("<I", message, 40)[0]
                        await self.socket.send(struct.pack("<BBHI", 4, 1, 0, sequence))
                elif '"id":"other' in message:
                    self.take_answer(json.loads(message)["id"])
                elif '"code":"halt' in message:
                    self.halts += 1
        self.closed = True

    def take_answer(self, name):
        asked, times = self.waiting.pop(name)
        self.answered += 1
        self.longest = max(self.longest, time.monotonic() - asked)
        now = self.server.thread_times()
        cpu = max((now[task] - times.get(task, 0) for task in now), default=0)
        self.longest_cpu = max(self.longest_cpu, cpu)

    async def ask(self):
        with contextlib.suppress(websockets.ConnectionClosed):
            for number in itertools.count():
                name = f"other {number}"
                self.waiting[name] = (time.monotonic(), self.server.thread_times())
                self.asked += 1
                await self.socket.send(json.dumps({"op": "hash", "id": name}))
                await asyncio.sleep(0.25)

    def start_part(self):
        self.frames = self.halts = 0
        self.longest = self.longest_cpu = 0.0

    async def close(self):
        for task in self.tasks[1:]:
            task.cancel()
        with contextlib.suppress(Exception):
            await asyncio.wait_for(self.socket.close(), 5)


async def join_once(server):
    """Whether one who comes now is let in."""
    try:
        async with connect(server.addresses["websocket"]) as socket:
            text = await asyncio.wait_for(socket.recv(), PATIENCE)
            binary = None
            while binary is None:
                message = await asyncio.wait_for(socket.recv(), PATIENCE)
                binary = message if isinstance(message, bytes) else None
            return '"welcome"' in text
    except (websockets.WebSocketException, OSError, asyncio.TimeoutError):
        return False


# ---- one attack ----------------------------------------------------------------------------------

class Part:
    """What a part of the time has shown."""

    def __init__(self, name):
        self.name = name
        self.ticks = self.memory = self.joins = self.joined = 0
        self.frames = self.closed = self.halts = 0
        self.longest = self.longest_cpu = 0.0
        self.unanswered = 0

    def row(self):
        return (f"{self.name:28} {self.ticks:6} {self.frames:7} {self.closed:6} {self.longest:8.3f} "
                f"{self.longest_cpu:8.2f} {self.unanswered:6} {self.halts:5} {self.joined:3}/{self.joins:<3} "
                f"{self.memory:7.0f}")

    HEAD = (f"{'part':28} {'ticks':>6} {'frames':>7} {'closed':>6} {'wait s':>8} {'CPU s':>8} {'no ans':>6} "
            f"{'halts':>5} {'joins':>7} {'MB':>7}")


async def measure(part, server, others, seconds):
    loop = asyncio.get_running_loop()
    for other in others:
        other.start_part()
    before = await loop.run_in_executor(None, server.ticks)
    begin = time.monotonic()
    while time.monotonic() - begin < seconds:
        part.memory = max(part.memory, server.memory())
        part.joins += 1
        part.joined += await join_once(server)
        await asyncio.sleep(min(2.0, seconds / 4))
    part.ticks = await loop.run_in_executor(None, server.ticks) - before
    part.frames = min(other.frames for other in others)
    part.closed = sum(other.closed for other in others)
    part.halts = max(other.halts for other in others)
    now = time.monotonic()
    for other in others:
        late = [now - asked for asked, _ in other.waiting.values()]
        part.longest = max([part.longest, other.longest, *late])
        part.longest_cpu = max(part.longest_cpu, other.longest_cpu)
    return part


async def set_back(server):
    """The room as it was: its scene, running, at its speed, in its own air."""
    async with connect(server.addresses["websocket"]) as socket:
        reader = asyncio.ensure_future(drain(socket))
        for message in ({"op": "load", "scene": "flag"}, {"op": "resume"}, {"op": "speed", "speed": 1}):
            await socket.send(json.dumps(message))
        await asyncio.sleep(1)
        reader.cancel()


async def answers_settle(others):
    """Waits until what was asked is answered, or never will be."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end and any(len(other.waiting) > 4 for other in others if not other.closed):
        await asyncio.sleep(0.1)
    return sum(max(0, len(other.waiting) - 4) for other in others)


async def run_kind(name, kinds, seconds, part_seconds):
    server = Server(4 * seconds + 120, "--scene", "flag")
    others = [Other(server) for _ in range(OTHERS)]
    for other in others:
        await other.open()
    await asyncio.sleep(1)
    parts = []
    count = max(2, round(seconds / part_seconds))
    for number in range(count):
        hostile = number % 2 == 1
        part = Part(f"{name}" if hostile else "quiet")
        attacker = None
        if hostile:
            # All kinds in turn; where there is little time, another one in each part.
            some = kinds if part_seconds >= 2 * len(kinds) else \
                [kinds[(number // 2 + k) % len(kinds)] for k in range(0, len(kinds), 2)]
            part.name = f"{name}: {' '.join(some)}"[:28]
            attacker = start_attacker(server, part_seconds, *some)
        await measure(part, server, others, part_seconds)
        if attacker:
            with contextlib.suppress(subprocess.TimeoutExpired):
                await asyncio.get_running_loop().run_in_executor(None, attacker.wait, PATIENCE)
            if attacker.poll() is None:
                attacker.kill()
        part.unanswered = await answers_settle(others)
        parts.append(part)
        print(part.row(), flush=True)
        if hostile and name == "scene" and server.process.poll() is None:
            with contextlib.suppress(Exception):
                await asyncio.wait_for(set_back(server), PATIENCE)
    alive = server.process.poll() is None
    for other in others:
        await other.close()
    seconds_to_end, code = server.terminate()
    return parts, alive, seconds_to_end, code


def judge(name, result, counts):
    """What did not hold, in words."""
    parts, alive, seconds_to_end, code = result
    wrong = []
    if not alive:
        wrong.append("the server ended by itself")
    if code != 0:
        wrong.append(f"exit code {code} after SIGTERM")
    if not counts and seconds_to_end > TERM_LIMIT:
        wrong.append(f"SIGTERM took {seconds_to_end:.1f} s")
    for number, part in enumerate(parts):
        if part.closed:
            wrong.append(f"{part.closed} others were closed by: {part.name}")
        if part.unanswered:
            wrong.append(f"{part.unanswered} commands of others were not answered in: {part.name}")
        if part.joined < part.joins:
            wrong.append(f"{part.joins - part.joined} joins failed in: {part.name}")
        if counts or number % 2 == 0:
            continue
        quiet = [p for p in (parts[number - 1], parts[number + 1] if number + 1 < len(parts) else None) if p]
        if part.longest_cpu > TICK_LIMIT + ANSWER_LIMIT:
            wrong.append(f"an answer took {part.longest_cpu:.1f} s of CPU time in: {part.name}")
        if part.memory > quiet[0].memory + MOST_MEMORY:
            wrong.append(f"{part.memory - quiet[0].memory:.0f} MB more in: {part.name}")
        for what in ("ticks", "frames") if name == "harmless" else ():
            usual = sum(getattr(p, what) for p in quiet) / len(quiet)
            if getattr(part, what) < LEAST_SHARE * usual:
                wrong.append(f"{getattr(part, what) / max(usual, 1):.2f} of the {what} in: {part.name}")
    return wrong


# ---- SIGTERM at any moment -----------------------------------------------------------------------

async def end_at_any_moment(times, counts):
    wrong, longest = [], 0.0
    for number in range(times):
        server = Server(120, "--scene", "flag")
        kind = SCENE[number % len(SCENE)]
        attacker = start_attacker(server, 60, kind)
        await asyncio.sleep(random.uniform(0.2, 2.5))
        attacker_alive = server.process.poll() is None
        seconds, code = server.terminate()
        attacker.kill()
        attacker.wait()
        longest = max(longest, seconds)
        if code != 0 or not attacker_alive:
            wrong.append(f"exit code {code} at SIGTERM during {kind}, after {seconds:.1f} s")
        elif not counts and seconds > TERM_LIMIT:
            wrong.append(f"SIGTERM during {kind} took {seconds:.2f} s")
    print(f"SIGTERM {times} times: longest {longest:.2f} s, {len(wrong)} wrong", flush=True)
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=300, help="of each kind of attack")
    parser.add_argument("--part", type=float, default=30, help="of a quiet or hostile part [s]")
    parser.add_argument("--kinds", nargs="+", default=["harmless", "scene"])
    parser.add_argument("--sigterm", type=int, default=50, help="how often")
    parser.add_argument("--counts", action="store_true", help="judge nothing by a clock")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    random.seed(options.seed)
    if not PROGRAM:
        sys.exit("WEFT_PROGRAM names no program")
    wrong = []
    print(Part.HEAD)
    for name in options.kinds:
        kinds = HARMLESS if name == "harmless" else SCENE
        wrong += judge(name, asyncio.run(run_kind(name, kinds, options.seconds, options.part)), options.counts)
    if options.sigterm:
        wrong += asyncio.run(end_at_any_moment(options.sigterm, options.counts))
    for each in wrong:
        print(f"FAILED  {each}")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
