"""The line that a failing seed prints repeats that test case with that seed alone, in a shell, from the
project's folder. It is tried with cases that fail on purpose (repeat_cases.cpp)."""

import os
import re
import subprocess
import sys
import unittest

PROGRAM = os.environ["WEFT_BUILD_DIR"] + "/weft_repeat_cases"
PLACE = os.environ["WEFT_SOURCE_DIR"]
LINE = re.compile(r"^repeat with: (.*)$", re.MULTILINE)
TRIED = re.compile(r"^tried (\d+) in (\w+)$", re.MULTILINE)
FAILED = re.compile(r"^test cases: (\d+) \| (\d+) failed$", re.MULTILINE)
# Where each case fails; it tries 1 to 5, or the seeds that stand here.
SEEDS = {"random": (7, [7]), "thrown": (3, [1, 2, 3]), "cases": (2, [1, 2, 3])}
ALL = ["plain", "comma", "commas", "brackets", "shell", "float", "double", "random", "thrown", "cases"]


def run(*command):
    clean = {name: value for name, value in os.environ.items() if name != "WEFT_SEED"}
    return subprocess.run(
        command, cwd=PLACE, env=clean, capture_output=True, text=True, timeout=100
    ).stdout


class Repeat(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.output = run(PROGRAM, "[.fails]")

    def test_each_case_fails_once_and_prints_one_line(self):
        tried = [(case, seed) for seed, case in TRIED.findall(self.output)]
        wanted = [
            (case, str(seed)) for case in ALL for seed in SEEDS.get(case, (3, range(1, 6)))[1]
        ]
        self.assertCountEqual(tried, wanted)
        self.assertEqual(len(LINE.findall(self.output)), len(ALL))

    def test_each_line_repeats_its_case_with_its_seed_alone(self):
        repeated = []
        for line in LINE.findall(self.output):
            with self.subTest(line=line):
                again = run("sh", "-c", line)
                self.assertEqual(FAILED.findall(again), [("1", "1")])
                ((seed, case),) = TRIED.findall(again)
                self.assertEqual(int(seed), SEEDS.get(case, (3,))[0])
                self.assertEqual(LINE.findall(again), [line])
                repeated.append(case)
        self.assertEqual(repeated, ALL)

    def test_a_repeated_seed_gives_the_same_numbers(self):
        (line,) = (line for line in LINE.findall(self.output) if "a number of its own" in line)
        numbers = re.compile(r"^number (.*)$", re.MULTILINE)
        self.assertEqual(numbers.findall(run("sh", "-c", line)), numbers.findall(self.output))
        other = run("sh", "-c", line.replace("WEFT_SEED=7", "WEFT_SEED=8"))
        self.assertNotEqual(numbers.findall(other), numbers.findall(self.output))

    def test_the_program_is_told_from_the_projects_folder_on(self):
        inside = os.path.relpath(PROGRAM, PLACE)
        for line in LINE.findall(self.output):
            self.assertIn(f" '{PROGRAM if inside.startswith('..') else inside}' ", line)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
