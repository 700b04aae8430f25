"""Laws of what wire/measure.sh measures, on a small cloth. No verdict depends on how long anything took."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["WEFT_BUILD_DIR"] + "/weft_wire_bench"
SCRIPT = Path(__file__).parent / "wire" / "wire.mjs"


class Wire(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        subprocess.run([PROGRAM, "--out", folder.name, "--side", "24", "--frames", "20"], check=True,
                       capture_output=True, timeout=200)
        cls.rows = json.loads(Path(folder.name, "wire.json").read_text(encoding="utf-8"))
        cls.printed = subprocess.run(["node", SCRIPT, folder.name], check=True, capture_output=True, text=True,
                                     timeout=100).stdout

    def cost(self, motion, mesh, error):
        found = [row for row in self.rows
                 if (row["motion"], row["mesh"], row["error_bound"]) == (motion, mesh, error)]
        self.assertEqual(len(found), 1)
        return found[0]["packed_bytes"]

    def test_no_vertex_is_further_off_than_the_bound(self):
        for row in self.rows:
            self.assertLessEqual(row["largest_error"], row["error_bound"])
            self.assertGreater(row["largest_error"], row["error_bound"] / 3)

    def test_a_finer_bound_and_faster_motion_cost_more_and_all_less_than_16_bits(self):
        for mesh in ("grid", "mesh", "random"):
            for motion in ("gusts", "calm"):
                self.assertLess(self.cost(motion, mesh, 1e-4), self.cost(motion, mesh, 1e-5))
            for error in (1e-4, 1e-5):
                self.assertLess(self.cost("calm", mesh, error), self.cost("gusts", mesh, error))
                self.assertLess(self.cost("gusts", mesh, error), 6)

    def test_every_stream_is_decoded_in_javascript_and_printed(self):
        lines = self.printed.splitlines()
        self.assertEqual([line.split()[:2] for line in lines[2:]],
                         [[row["motion"], row["mesh"]] for row in self.rows])


if __name__ == "__main__":
    unittest.main()
