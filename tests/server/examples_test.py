"""The examples of the Python client run as they are, and what they print keeps to the laws that they are about."""

import ast
import contextlib
import io
import json
import os
import re
import subprocess
import sys
import unittest
import urllib.request
from pathlib import Path

from foreign_client import PATIENCE, Server, main

CLIENT = Path(__file__).resolve().parents[2] / "proto/python"
EXAMPLES = CLIENT / "examples"
sys.path.insert(0, str(CLIENT))


def numbers(line):
    """All that stand in it with a decimal point."""
    return [float(number) for number in re.findall(r"-?\d+\.\d+", line)]


class Examples(unittest.TestCase):
    def setUp(self):
        self.server = Server()

    def tearDown(self):
        self.assertEqual(self.server.stop(), 0)

    def lines_of(self, name, *arguments):
        """What an example prints."""
        environment = {**os.environ, "PYTHONPATH": str(CLIENT), "PYTHONDONTWRITEBYTECODE": "1"}
        done = subprocess.run([sys.executable, EXAMPLES / name, self.server.websocket, *arguments], text=True,
                              capture_output=True, timeout=200, check=False, env=environment)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return done.stdout.splitlines()

    def test_a_flag_hangs_with_its_weight_on_its_pins_and_falls_freely(self):
        hung, fell = self.lines_of("hang_and_let_go.py")
        carried, weight = numbers(hung)
        self.assertAlmostEqual(carried, weight, delta=0.02 * weight)
        _, way, closed = numbers(fell)
        self.assertAlmostEqual(way, closed, delta=0.01 * closed)

    def test_a_gripper_that_lifts_a_cloth_feels_its_weight(self):
        closed, carried, turned, opened = self.lines_of("grip_and_lift.py")
        self.assertEqual((closed, opened), ("gripping: True", "gripping: False"))
        force, weight = numbers(carried)
        self.assertAlmostEqual(force, weight, delta=0.03 * weight)
        self.assertLess(numbers(turned)[0], 1000 * 0.25 * weight)  # its lever is within the cloth

    def test_two_grippers_fold_a_towel_to_half_its_length(self):
        gripping, flat, folded, crossings = self.lines_of("fold_towel.py")
        self.assertEqual((gripping, crossings), ("gripping: True True", "crossings: 0"))
        ratio = numbers(folded)[0] / numbers(flat)[0]
        self.assertGreater(ratio, 0.48)
        self.assertLess(ratio, 0.56)

    def test_fabrics_drawn_at_random_stretch_as_the_closed_form_says_and_repeat_with_their_seed(self):
        count, _, correlation, _ = self.lines_of("random_fabrics.py")
        self.assertEqual(count, "episodes: 100")
        self.assertGreater(numbers(correlation)[0], 0.999)
        self.assertEqual(*(self.lines_of("random_fabrics.py", "5", "3") for _ in range(2)))

    def test_a_strip_sags_as_a_beam_to_1_percent(self):
        self.assertLess(abs(numbers(self.lines_of("sag_of_a_strip.py")[-1])[0]), 1)

    def test_the_notebook_shows_the_page_and_its_cells_run(self):
        notebook = json.loads((EXAMPLES / "live_page.ipynb").read_text(encoding="utf-8"))
        os.environ["WEFT_ADDRESS"] = self.server.url
        scope, shown, printed = {}, [], io.StringIO()
        with contextlib.redirect_stdout(printed):
            for cell in notebook["cells"]:
                if cell["cell_type"] == "code":
                    shown.append(self.run_cell("".join(cell["source"]), scope))
        pages = [value._repr_html_() for value in shown if hasattr(value, "_repr_html_")]
        (address,) = re.findall(r'<iframe src="([^"]+)"', "".join(pages))
        self.assertEqual(address, self.server.url)
        with urllib.request.urlopen(address, timeout=PATIENCE) as page:
            self.assertEqual(page.status, 200)
            self.assertIsNone(page.headers["X-Frame-Options"])  # it may be shown within a notebook
        moved, _ = numbers(printed.getvalue())
        self.assertGreater(moved, 0.1)

    @staticmethod
    def run_cell(source, scope):
        """As a notebook does: the value of the last line, if that is an expression, is shown."""
        body = ast.parse(source).body
        last = body.pop() if isinstance(body[-1], ast.Expr) else None
        exec(compile(ast.Module(body, []), "cell", "exec"), scope)
        return eval(compile(ast.Expression(last.value), "cell", "eval"), scope) if last else None

    def test_every_example_is_one_of_these(self):
        text = Path(__file__).read_text(encoding="utf-8")
        names = sorted(path.name for path in EXAMPLES.iterdir() if path.suffix in (".py", ".ipynb"))
        self.assertGreater(len(names), 5)
        for name in names:
            self.assertIn(f'"{name}"', text)


if __name__ == "__main__":
    main()
