"""The hard cases: each tells a verdict, and in the full tier the one that README.md tells."""

import os
import re
import unittest
from pathlib import Path

import stability

README = (Path(__file__).resolve().parent / "README.md").read_text(encoding="utf-8")
TOLD = dict(re.findall(r"^\| (hard-[\w-]+) \| \d+ \| \W*(passes|fails)", README, re.MULTILINE))
SHORT_TICKS = 20


class Stability(unittest.TestCase):
    def test_the_table_has_each_case(self):
        self.assertEqual(list(TOLD), stability.cases())
        self.assertGreaterEqual(len(TOLD), 24)

    def test_the_section_on_other_solvers_has_each_case(self):
        section = stability.without_solvers(README)[1]
        told = re.findall(r"^\| (hard-[\w-]+) \|", section, re.MULTILINE)
        self.assertEqual(told, stability.cases())

    def test_with_implicit_the_flag_in_the_storm_goes_where_it_wants(self):
        # In long steps its particles go so far beside each other that all their ways would be cut short.
        verdict = stability.run("hard-storm", 240, ["solver.kind=implicit"])["verdict"]
        self.assertEqual(verdict["failures"], [])
        self.assertLess(verdict["lost_motion"], 0.05)

    def test_each_case_runs_and_tells_its_verdict(self):
        ticks = stability.TICKS if os.environ.get("WEFT_FULL") else SHORT_TICKS
        for name, told in TOLD.items():
            with self.subTest(case=name):
                result = stability.run(name, ticks)
                verdict = result["verdict"]
                self.assertIn(f"verdicts are those of the solver `{result['solver']}`", README)
                self.assertEqual(verdict["ticks"], ticks)
                self.assertEqual(verdict["passed"], not verdict["failures"])
                self.assertNotIn("a position is not finite", verdict["failures"])
                if ticks == stability.TICKS:
                    self.assertEqual("passes" if verdict["passed"] else "fails", told)
                elif told == "passes":
                    self.assertEqual(verdict["failures"], [])


if __name__ == "__main__":
    unittest.main()
