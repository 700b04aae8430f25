"""Laws of the comparison of two versions' contact. No verdict depends on how long anything took."""

import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import compare  # noqa: E402

PROGRAM = os.environ["WEFT_BUILD_DIR"] + "/weft_contact_bench"


def bench(*words):
    return subprocess.run([PROGRAM, *words], check=True, capture_output=True, text=True,
                          timeout=280).stdout


class Compare(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.mkdtemp()
        cls.states = cls.directory + "/hands"
        bench("record", "hands", cls.states)
        cls.runs = [json.loads(bench("count", "hands", cls.states)) for _ in range(2)]

    def test_runs_from_recorded_states_are_the_same_motion(self):
        one, other = ({key: run[key] for key in run if key != "milliseconds"} for run in self.runs)
        self.assertEqual(one, other)
        self.assertGreater(one["wanted"], 0)

    def test_each_tick_of_a_case_is_timed_and_its_crossings_are_counted(self):
        for run in self.runs:
            self.assertEqual(len(run["milliseconds"]), 30)
            self.assertTrue(all(one > 0 for one in run["milliseconds"]))
            self.assertEqual(run["crossings"], 0)

    def test_a_version_beside_itself_has_the_same_states_and_one_row_a_case(self):
        text = subprocess.run([sys.executable, compare.__file__, "--old", PROGRAM, "--new", PROGRAM,
                               "--cases", "falling,falling-alone", "--runs", "1", "--scratch",
                               self.directory], check=True, capture_output=True, text=True,
                              timeout=280).stdout
        self.assertRegex(text, r"\| falling \| .*\| 0 / 0 \| 0.0e\+00 / 0.0e\+00 \|")
        self.assertRegex(text, r"falling: contact with itself takes -?\d+ % more, before -?\d+ %")

    def test_of_each_tick_the_median_of_all_runs_counts(self):
        runs = [{"milliseconds": ticks} for ticks in ([1, 9, 3], [2, 4, 30], [50, 5, 4])]
        self.assertEqual(compare.figures(runs), {"mean": 11 / 3, "p50": 4, "p99": 4, "worst": 5})

    def test_a_critical_path_is_part_of_the_time_and_at_least_half_of_it(self):
        run = json.loads(bench("path", "hands", self.states))
        self.assertEqual(len(run["path"]), 30)
        for whole, path in zip(run["milliseconds"], run["path"], strict=True):
            self.assertTrue(whole / 2 - 1e-3 <= path <= whole)

    def test_what_is_no_recording_and_no_case_is_refused(self):
        for words in (("time", "hands", __file__), ("time", "nothing", self.states)):
            done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=20)
            self.assertEqual(done.returncode, 1)
            self.assertRegex(done.stderr, "no recording|ends too early|no case")


if __name__ == "__main__":
    unittest.main()
