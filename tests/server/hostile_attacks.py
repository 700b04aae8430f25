"""What a hostile viewer says; as a program, it says it: hostile_attacks.py URL SECONDS KIND..."""

import asyncio
import contextlib
import itertools
import json
import random
import struct
import sys
import time

import websockets

RATE = 950      # messages a second, just below the limit
SLOW_RATE = 20  # of those that cost much
PATIENCE = 30   # until something counts as never [s]

# Legal to say, and refused: by name, before the scene is built, and after.
REFUSED = ["nowhere", {"cloths": [{"rows": 1000, "columns": 1000}]}, {"cloths": [{"rows": 1}]},
           {"cloths": [{"rows": 90, "columns": 90}], "solver": {"min_substeps": 20000}},
           {"cloths": [{"rows": 5, "columns": 5}], "pins": [{"place": "particle", "particle": 25}]}]


def connect(url):
    return websockets.connect(url, subprotocols=["weft.v1"], compression=None, max_size=None,
                              ping_interval=None, open_timeout=PATIENCE, max_queue=4096)


def place(size=0.6):
    return [random.uniform(-size, size), random.uniform(0.2, 1.4), random.uniform(-size, size)]


def harmless(kind):
    """Endless messages of a kind that leaves everyone their scene."""
    if kind == "moves":
        yield {"op": "drag", "phase": "start", "particle": 0, "drag": 1, "max_force": 1e-3}
        while True:
            yield {"op": "drag", "phase": "move", "drag": 1, "target": place()}
    for k in itertools.count():
        yield {
            "pins": lambda: {"op": "pin", "particle": 5} if k % 2 == 0 else {"op": "release", "particle": 5},
            "views": lambda: {"op": "view", "hz": random.choice([0, 1, 30, 60, 240]), "forces": k % 2 == 0},
            "hello": lambda: {"op": "hello", "name": f"n{k}" + "x" * 24, "color": f"#{k % 0xffffff:06x}"},
            "queries": lambda: {"op": "query", "what": random.choice(
                ["positions", "velocities", "energies", "state", "roster", "work", "crossings"])},
            "forces": lambda: {"op": "query", "what": random.choice(["contacts", "reactions"])},
            "camera": lambda: {"op": "camera", "position": place(), "target": [0, 0, 0]},
            "refused_load": lambda: {"op": "load", "scene": random.choice(REFUSED)},
            "garbage": lambda: random.choice(["{", "[" * 5000, "x" * 60000, '{"op":"explode"}', "{}",
                                              '{"op":"speed","speed":1e999}', '{"op":"pin","particle":1e9}']),
        }[kind]()


def scene_changing(kind):
    big = {"cloths": [{"rows": 400, "columns": 400, "origin": [-0.5, 1, 0]}]}
    small = {"tick_rate": 30, "cloths": [{"rows": 7, "columns": 7, "width": 0.5, "height": 0.5,
                                          "origin": [0, 1, 0], "fabric": {"preset": "denim"}}],
             "colliders": [{"shape": "box", "center": [0, 0.15, 0], "half_extents": [0.25, 0.15, 0.25]}]}
    if kind == "advance":
        yield {"op": "load", "scene": "hard-stack"}
        while True:
            yield {"op": "pause"}
            yield {"op": "advance", "n": 100000}
    if kind == "storm":
        yield {"op": "resume"}
        while True:
            yield {"op": "set", "wind": [100, 100, 100], "air_density": 1000, "gravity": [0, -1000, 0], "drag": 0}
            yield {"op": "set", "gust_speed": 100, "gust_length": 0.01, "softness": 0.01}
            fan = {"position": [0, 1, 1], "direction": [0, 0, -1], "speed": 50, "radius": 10, "spread": 2,
                   "reach": 100}
            yield {"op": "set", "fans": [fan] * 4}
    for k in itertools.count():
        yield {
            "load": lambda: {"op": "load", "scene": random.choice([big, small, "hard-squeeze", "drop-on-bunny"])},
            "pause": lambda: {"op": random.choice(["pause", "resume", "reset", "step"])},
            "speed": lambda: {"op": "speed", "speed": random.choice([0.01, 1, 10])},
        }[kind]()


HARMLESS = ["moves", "pins", "views", "hello", "queries", "forces", "camera", "refused_load", "garbage"]
SCENE = ["load", "storm", "advance", "pause", "speed"]


async def drain(socket):
    with contextlib.suppress(websockets.ConnectionClosed):
        async for message in socket:
            if isinstance(message, bytes) and message[0] == 1:
                sequence = struct.unpack_from("<I", message, 40)[0]
                await socket.send(struct.pack("<BBHI", 4, 1, 0, sequence))


async def attack(url, kinds, seconds):
    """Says as much as it may for so long, of each kind for an equal part; comes back when closed."""
    end = time.monotonic() + seconds
    part = seconds / len(kinds)
    for number, kind in enumerate(kinds):
        until = end - seconds + (number + 1) * part
        while time.monotonic() < until:
            with contextlib.suppress(websockets.WebSocketException, OSError, asyncio.TimeoutError):
                await speak(url, kind, until)


async def speak(url, kind, until):
    messages = harmless(kind) if kind in HARMLESS else scene_changing(kind)
    rate = SLOW_RATE if kind in ("load", "storm", "advance") else RATE
    async with connect(url) as socket:
        reader = asyncio.ensure_future(drain(socket))
        begin = time.monotonic()
        for number in itertools.count():
            now = time.monotonic()
            if now >= until:
                break
            if number > (now - begin) * rate:
                await asyncio.sleep(0.002)
                continue
            message = next(messages)
            if isinstance(message, dict):
                message = json.dumps({"id": number, **message})
            await asyncio.wait_for(socket.send(message), PATIENCE)
        reader.cancel()


if __name__ == "__main__":
    random.seed(1)
    asyncio.run(attack(sys.argv[1], sys.argv[3:], float(sys.argv[2])))
