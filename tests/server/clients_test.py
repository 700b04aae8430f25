"""Our own clients in Python and JavaScript against the real server: what calls tell, and loops of them at its limit."""

import json
import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

from foreign_client import Server, main

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "proto/python"))

import weft  # noqa: E402

LIMIT = 100  # messages a second
# Seconds of the limit that a loop runs through; a person may want a minute of it at 1,000.
SECONDS = float(os.environ.get("WEFT_LOOP_SECONDS", 4))
RATE = int(os.environ.get("WEFT_LOOP_LIMIT", LIMIT))

LOOP = """
import { WeftClient } from %(client)s;
import WebSocket from %(ws)s;
const weft = new WeftClient(%(url)s, { WebSocket, reconnect: false });
await weft.connect();
await weft.view({ hz: 0 });
const hashes = new Set();
for (let i = 0; i < %(calls)d; i++) hashes.add((await weft.hash()).hash);
await Promise.all([...Array(%(burst)d).keys()].map(() => weft.hash()));
weft.close();
console.log(JSON.stringify({ hashes: [...hashes] }));
process.exit(0);
"""

LAST_FRAME = """
import { WeftClient } from %(client)s;
import WebSocket from %(ws)s;
const weft = new WeftClient(%(url)s, { WebSocket, reconnect: false });
await weft.connect();
let tick = 0;
weft.on('frame', (frame) => (tick = frame.tick));
const ticks = [], frames = [];
for (const n of [10, 10, 1, 1, 7, 7, 33, 33, 3, 3]) {
  ticks.push((await weft.advance(n)).tick);
  frames.push(Number(tick));
}
weft.close();
console.log(JSON.stringify({ ticks, frames }));
process.exit(0);
"""


class Refusals(unittest.TestCase):
    def test_a_script_is_told_why_the_server_does_not_let_it_in(self):
        server = Server("--max-viewers", "1")
        try:
            with self.assertRaisesRegex(weft.ConnectionLost, "there is no such room; .*rooms"):
                weft.open(server.websocket + "/nowhere")
            with weft.open(server.websocket):
                with self.assertRaisesRegex(weft.ConnectionLost, "at most 1 viewers; try again later"):
                    weft.open(server.websocket)
        finally:
            self.assertEqual(server.stop(), 0)


class Loops(unittest.TestCase):
    def setUp(self):
        self.server = Server("--paused", "--max-messages-per-second", str(RATE))
        self.calls = int(RATE * SECONDS)

    def tearDown(self):
        self.assertEqual(self.server.stop(), 0)

    def test_a_loop_of_python_calls_runs_on_at_the_limit(self):
        with weft.open(self.server.websocket) as cloth:
            cloth.view(hz=0)
            hashes = {cloth.hash() for _ in range(self.calls)}
            self.assertEqual(len(hashes), 1)
            self.assertEqual(cloth.advance(5, frames="last")["tick"], 5)
            self.assertEqual(cloth.frame.tick, 5)

    def test_after_an_advance_the_frame_is_that_of_its_last_tick(self):
        with weft.open(self.server.websocket) as cloth:
            for n in (10, 1, 7, 33, 3):
                for _ in range(4):
                    tick = cloth.advance(n)["tick"]
                    self.assertEqual(cloth.frame.tick, tick)
        script = LAST_FRAME % {
            "client": json.dumps((ROOT / "proto/js/index.js").as_uri()),
            "ws": json.dumps((ROOT / "web/node_modules/ws/wrapper.mjs").as_uri()),
            "url": json.dumps(self.server.websocket),
        }
        done = subprocess.run(
            [shutil.which("node"), "--input-type=module", "-e", script],
            capture_output=True, text=True, timeout=200, check=False,
        )
        self.assertEqual(done.stderr, "")
        seen = json.loads(done.stdout)
        self.assertEqual(seen["frames"], seen["ticks"])

    def test_a_loop_of_javascript_calls_runs_on_at_the_limit_and_so_do_calls_at_once(self):
        client, ws = ROOT / "proto/js/index.js", ROOT / "web/node_modules/ws/wrapper.mjs"
        script = LOOP % {
            "client": json.dumps(client.as_uri()), "ws": json.dumps(ws.as_uri()),
            "url": json.dumps(self.server.websocket), "calls": self.calls,
            "burst": min(self.calls, 4 * RATE),
        }
        done = subprocess.run(
            [shutil.which("node"), "--input-type=module", "-e", script],
            capture_output=True, text=True, timeout=200, check=False,
        )
        self.assertEqual(done.stderr, "")
        self.assertEqual(len(json.loads(done.stdout)["hashes"]), 1)


if __name__ == "__main__":
    main()
