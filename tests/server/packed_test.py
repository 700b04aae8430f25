"""Packed frames of the real server beside float32 ones."""

import sys
import time
import unittest
from pathlib import Path

from foreign_client import Server, main

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "proto/python"))

import weft  # noqa: E402

ROUNDING = 1e-9  # of this test's own sums [m]
MESH_SCENE = {
    "name": "sheets",
    "cloths": [
        {"name": "grid", "rows": 9, "columns": 12},
        {"name": "mesh", "form": "mesh", "mesh": {"source": "loop", "position": [0, 3, 0]}},
    ],
}


def rows_of(frame):
    return [tuple(map(float, row)) for row in frame.positions]


def largest_error(frame, other):
    return max(
        sum((a - b) ** 2 for a, b in zip(row, truth)) ** 0.5
        for row, truth in zip(rows_of(frame), rows_of(other), strict=True)
    )


class Packed(unittest.TestCase):
    def setUp(self):
        self.server = Server("--paused")

    def tearDown(self):
        self.assertEqual(self.server.stop(), 0)

    def check_frames(self, plain, packed, error):
        """Both viewers see the same ticks, the second one within the bound."""
        largest, now = 0.0, plain.request("hash")["tick"]
        for tick in range(now + 1, now + 20):
            plain.step(1)
            frames = [self.frame_of(viewer, tick) for viewer in (plain, packed)]
            largest = max(largest, largest_error(*frames))
            self.assertEqual(frames[0].flags & 6, frames[1].flags & 6)
        self.assertLessEqual(largest, error + ROUNDING)
        self.assertGreater(largest, 0)

    def frame_of(self, viewer, tick):
        end = time.monotonic() + 60
        while viewer.frame is None or viewer.frame.tick != tick:
            self.assertLess(time.monotonic(), end, f"tick {tick} has not come")
            time.sleep(0.002)
        return viewer.frame

    def test_packed_frames_are_those_of_others_within_the_bound_they_asked_for(self):
        with weft.open(self.server.websocket) as plain, weft.open(self.server.websocket) as packed:
            self.assertIn("packed", packed.welcome["codecs"])
            for asked, error in ((None, 1e-4), (1e-5, 1e-5), (0.02, 1e-4)):
                answer = packed.view(codec="packed", error=asked)
                self.assertEqual((answer["codec"], answer["error"]), ("packed", error))
                self.check_frames(plain, packed, error)
            self.assertNotIn("error", packed.view(codec="f32"))
            tick = plain.request("hash")["tick"] + 1
            plain.step(1)
            self.assertEqual(largest_error(*(self.frame_of(v, tick) for v in (plain, packed))), 0)

    def test_a_scene_with_a_cloth_of_a_mesh_is_packed_too_and_a_reset_starts_anew(self):
        with weft.open(self.server.websocket) as plain, weft.open(self.server.websocket) as packed:
            packed.view(codec="packed")
            plain.load(MESH_SCENE)
            self.assertIsNotNone(plain.mesh_data.order)
            self.check_frames(plain, packed, 1e-4)
            plain.reset()
            self.check_frames(plain, packed, 1e-4)


if __name__ == "__main__":
    main()
