"""A client of 150 lines that imports nothing of ours, against the real server."""

import sys
import unittest
from array import array
from pathlib import Path
from urllib.parse import urlsplit

import plain_client
from foreign_client import Server, main

SMALL = {
    "cloths": [{"rows": 9, "columns": 9, "width": 0.4, "height": 0.4}],
    "pins": [{"place": "corner", "corner": "top_left"}, {"place": "corner", "corner": "top_right"}],
}
SOURCE = Path(plain_client.__file__)


class PlainClient(unittest.TestCase):
    def setUp(self):
        self.server = Server("--scene", "cantilever-test", "--paused")
        address = urlsplit(self.server.url)
        self.cloth = plain_client.Weft(address.hostname, address.port)
        self.assertEqual(self.cloth.ask("load", scene=SMALL)["tick"], 0)

    def tearDown(self):
        self.cloth.socket.reader.close()
        self.cloth.socket.stream.close()
        self.assertEqual(self.server.stop(), 0)

    def test_its_frames_are_the_positions_that_a_query_tells_bit_for_bit(self):
        self.cloth.ask("set", wind=[3, 0, 0])
        answer = self.cloth.ask("advance", n=40, frames="last")
        self.assertEqual((answer["tick"], self.cloth.frame.tick), (40, 40))
        told = self.cloth.ask("query", what="positions")["data"]
        self.assertEqual(self.cloth.told["mesh"]["vertices"], len(told))
        self.assertEqual(array("f", [x for row in told for x in row]), self.cloth.frame.positions)

    def test_it_holds_the_cloth_with_a_hand_and_pulls_it_up(self):
        ask = self.cloth.ask
        ask("advance", n=30, frames="last")
        low = min(range(1, len(self.cloth.frame.positions), 3), key=self.cloth.frame.positions.__getitem__)
        height = self.cloth.frame.positions[low]
        at = list(self.cloth.frame.positions[low - 1 : low + 2])
        self.assertGreater(ask("drag", phase="start", drag=1, particle=low // 3)["grab"], 0)
        ask("drag", phase="move", drag=1, target=[at[0], at[1] + 0.3, at[2]])
        ask("advance", n=60, frames="last")
        self.assertGreater(self.cloth.frame.positions[low], height + 0.1)
        ask("drag", phase="end", drag=1)
        self.assertEqual(ask("query", what="grabs")["data"], [])

    def test_a_refusal_tells_field_limit_and_hint(self):
        with self.assertRaises(plain_client.Refused) as raised:
            self.cloth.ask("speed", speed=99)
        self.assertEqual(raised.exception.message["field"], "speed")
        self.assertEqual(raised.exception.message["limit"], {"minimum": 0.01, "maximum": 10})

    def test_it_keeps_its_frames_coming_by_its_acks(self):
        self.cloth.ask("resume")
        ticks = [self.cloth.next_frame().tick for _ in range(30)]  # more than may be in flight
        self.assertEqual(ticks, sorted(set(ticks)))

    def test_it_is_short_and_imports_nothing_of_ours(self):
        text = SOURCE.read_text(encoding="utf-8")
        self.assertLessEqual(len(text.splitlines()), 150)
        imports = [line.split()[1] for line in text.splitlines() if line.startswith(("import", "from"))]
        self.assertGreater(len(imports), 3)
        for name in imports:
            self.assertIn(name, sys.stdlib_module_names)


if __name__ == "__main__":
    main()
