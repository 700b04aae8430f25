"""Laws of the measuring program: a tiny report. No verdict depends on how long anything took."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import contact_tables  # noqa: E402
import tables  # noqa: E402

PROGRAM = os.environ["WEFT_BUILD_DIR"] + "/weft_bench"
ENVELOPE = {"position", "strain", "energy", "momentum", "mean_shape", "penetration_m"}


def measure(*options):
    """The tables of a run, by name, and their directory."""
    directory = tempfile.mkdtemp()
    subprocess.run([PROGRAM, "--out", directory, "--quick", "--runs", "1", "--parts", "accuracy",
                    "--fabrics", "soft", *options], check=True, capture_output=True, timeout=300)
    return {name: tables.read(directory, name) for name in ("accuracy", "references", "machine")}


class Bench(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # A budget that no machine exceeds here: what runs must not depend on its speed.
        cls.swing = measure("--scenes", "swing", "--sizes", "16", "--budget", "100")
        cls.rest = measure("--scenes", "static-rest", "--sizes", "32", "--budget", "100")

    def test_the_reference_is_converged_and_a_perturbation_does_not_grow(self):
        for row in self.swing["references"] + self.rest["references"]:
            self.assertEqual(row["missing"], "")
            self.assertLess(row["self_error"], 1e-7)
            self.assertLess(row["growth_of_1um"], 10)

    def test_runge_kutta_and_extrapolated_leapfrog_are_the_same_reference(self):
        case = "--scenes", "swing", "--sizes", "16", "--budget", "100"
        kutta, leapfrog = (measure(*case, "--reference", method)
                           for method in ("runge-kutta", "extrapolation"))
        self.assertIn("Runge-Kutta", kutta["references"][0]["how"])
        self.assertIn("extrapolated", leapfrog["references"][0]["how"])
        for one, other in zip(kutta["accuracy"], leapfrog["accuracy"], strict=True):
            for key in ENVELOPE:
                self.assertAlmostEqual(one[key], other[key], delta=1e-7 + 1e-3 * one[key])

    def test_each_solver_has_at_least_six_settings(self):
        text = subprocess.run([PROGRAM, "--list-settings"], check=True, capture_output=True, text=True)
        names = [line.split(" ", 1) for line in text.stdout.splitlines()]
        for solver in tables.SOLVERS:
            self.assertGreaterEqual(len({name for kind, name in names if kind == solver}), 6)

    def test_every_cell_has_its_columns_and_every_solver_its_settings(self):
        for solver in tables.SOLVERS:
            cells = tables.of_case(self.swing["accuracy"], "swing", "soft", 16, solver)
            self.assertGreaterEqual(len(cells), 3)
            for cell in cells:
                self.assertLessEqual(ENVELOPE, set(cell))
                self.assertGreater(cell["cpu_per_second"], 0)
                self.assertGreater(cell["substeps"], 0)
        self.assertIn("compiler", [row["key"] for row in self.swing["machine"]])

    def error(self, setting):
        return next(c["position"] for c in self.rest["accuracy"] if c["setting"] == setting)

    def test_the_error_of_xpbd_falls_with_the_square_of_its_substeps(self):
        # At rest the false stretch is that of one substep's fall.
        self.assertAlmostEqual(self.error("24x1") / self.error("128x1"), (128 / 24) ** 2, delta=7)

    def test_verlet_is_within_a_thousandth_at_its_own_substeps(self):
        for run in (self.swing, self.rest):
            cell = next(c for c in run["accuracy"] if c["setting"] == "x1")
            self.assertLess(cell["position"], 1e-3)

    def test_a_run_off_by_more_than_the_way_counts_as_failed(self):
        # Rigid springs cannot sag between two edges; few sweeps sag far too much.
        failed = [c for c in self.rest["accuracy"] if c["outcome"] == "failed"]
        for cell in self.rest["accuracy"]:
            self.assertEqual(cell["outcome"] == "failed", cell["position"] > 1)
        self.assertGreater(len(failed), 0)
        self.assertTrue(all(cell["reason"] for cell in failed))

    def test_what_is_above_the_budget_is_not_run_and_says_why(self):
        cells = measure("--scenes", "swing", "--sizes", "16", "--budget", "0")["accuracy"]
        self.assertGreater(len(cells), 6)
        for cell in cells:
            self.assertEqual(cell["outcome"], "not run")
            self.assertIn("CPU s, more than", cell["reason"])
        self.assertIn("CPU s, more than", tables.cost_of_accuracy(cells))

    def test_the_verdict_on_an_implicit_solver_follows_the_figures(self):
        def verdict(slowest, share, cotton, wall=None):
            part = {"scene": "sling", "solver": "verlet", "off": "nothing", "cpu_per_second": 0.5,
                    "slowest_second": slowest, "seconds_looked_at": 4, "share_of_solver": share}
            cell = {"scene": "swing", "fabric": "cotton", "n": 128, "solver": "verlet",
                    "setting": "x1", "outcome": "ran", "cpu_per_second": cotton}
            two = {"scene": "swing, cotton, 128 x 128", "ticks": 120, "wall_s_one_thread": 4, "wall_ratio": wall}
            return tables.need_of_implicit([part], [cell], [two] if wall else []).splitlines()[0]

        self.assertIn("**No**", verdict(0.9, 1, 0.9))
        self.assertNotIn("Not in real time", verdict(0.9, 1, 0.9))
        self.assertIn("does not hold sling (2.5 CPU", verdict(2.5, 0.5, 0.9))
        self.assertIn("does not hold cotton at 128²", verdict(0.9, 1, 1.1))
        # What two threads hold by the clock is told, and what they do not.
        self.assertIn("**No**", verdict(0.9, 1, 1.1, 0.4))
        self.assertIn("(1.1 CPU s per s on one thread, 0.8 s per s by the clock on two)", verdict(0.9, 1, 1.1, 0.4))
        self.assertIn("(1.1 CPU s per s, 1.2 s by the clock on two threads)", verdict(0.9, 1, 1.1, 0.6))
        # What contact costs is no reason for another solver, but is told.
        self.assertIn("**No**", verdict(2.5, 0.1, 0.9))
        self.assertIn("sling (2.5 CPU s in its dearest second", verdict(2.5, 0.1, 0.9))

    def test_two_threads_give_the_bits_of_one_and_the_report_says_whether_they_help(self):
        directory = tempfile.mkdtemp()
        subprocess.run([PROGRAM, "--out", directory, "--quick", "--parts", "threads"], check=True,
                       capture_output=True, timeout=300)
        rows = tables.read(directory, "threads")
        self.assertGreaterEqual(len(rows), 5)
        for row in rows:
            self.assertEqual(row["same_bits"], "yes")
            self.assertTrue(0 <= row["share_in_chunks"] <= 1)
        slow = [{**row, "wall_ratio": 1.1, "same_bits": "no"} for row in rows]
        self.assertIn("one thread is the right choice", tables.threads(slow))
        self.assertIn("**no**", tables.threads(slow))
        fast = [{**rows[0], "wall_ratio": 0.6}, *slow[1:]]
        self.assertIn(f"1 of {len(rows)} ({rows[0]['scene']})", tables.threads(fast))

    def test_contact_is_measured_in_every_state_and_leaves_other_tables_alone(self):
        directory = Path(tempfile.mkdtemp())
        (directory / "accuracy.csv").write_text("old")
        subprocess.run([PROGRAM, "--out", directory, "--quick", "--parts", "contact", "contact-cases"],
                       check=True, capture_output=True, timeout=300)
        self.assertEqual((directory / "accuracy.csv").read_text(), "old")
        speed = {row["state"]: row for row in tables.read(directory, "contact")}
        self.assertEqual(list(speed), ["flat", "wrinkled", "folded", "crumpled"])
        for name, row in speed.items():
            self.assertEqual((row["missing"], row["crossings"]), ("", 0))
            self.assertGreater(row["tick_ms"], row["elastic_ms"])
            self.assertEqual(row["rows"] > 0, name in ("folded", "crumpled"))
        cases = tables.read(directory, "contact_cases")
        counts = [row["value"] for row in cases if "crossings" in row["figure"]]
        self.assertEqual(counts, [0] * 5)
        self.assertEqual([row["value"] for row in cases if "same bits" in row["figure"]], [1])
        self.assertGreaterEqual(len({row["scene"] for row in cases}), 4)

    def test_bars_of_contact_are_held_or_missed_by_the_figures(self):
        row = {"scene": "pile", "figure": "a tick", "value": 8, "unit": "ms", "wanted": "at most", "bar": 8.5,
               "runs": 5, "vectors": "AVX2", "load": "0", "commit": "x"}
        rows = [row, {**row, "value": 9}, {**row, "wanted": "at least"}, {**row, "wanted": ""}]
        self.assertEqual([contact_tables.verdict(r) for r in rows], ["held", "**missed**", "**missed**", "–"])
        self.assertIn("Of 3 bars 1 are held and 2 missed.", contact_tables.cases(rows))
        missing = {"n": 257, "state": "folded", "how": "in layers", "missing": "one tick takes 30 CPU s", **{
            key: row[key] for key in ("vectors", "load", "commit")}}
        self.assertIn("not measured: one tick takes 30 CPU s", contact_tables.speed([missing]))

    def test_sizes_and_scenes_that_were_measured_apart_name_their_commits_and_runs(self):
        def cell(commit, n, runs, scene="swing"):
            return {"commit": commit, "n": n, "timed_runs": runs, "scene": scene}
        cells = [cell("b", 64, 5), cell("b", 32, 0), cell("a", 256, 3)]
        self.assertEqual(tables.sizes_taken(cells), "32², 64² at commit b, medians of up to 5 runs; "
                                                    "256² at commit a, medians of up to 3 runs.")
        self.assertEqual(tables.sizes_taken(cells + [cell("c", 64, 4, "drape")]),
                         "32², 64² of swing at commit b, medians of up to 5 runs; "
                         "64² of drape at commit c, medians of up to 4 runs; "
                         "256² at commit a, medians of up to 3 runs.")

    def test_a_commit_is_not_taken_for_a_number(self):
        self.assertEqual([tables.number(text) for text in ("5311e71", "1.5e-05", "3e+20", "-2", "yes")],
                         ["5311e71", 1.5e-5, 3e20, -2, "yes"])

    def test_the_same_run_has_the_same_errors(self):
        again = measure("--scenes", "swing", "--sizes", "16", "--budget", "100")["accuracy"]
        for before, now in zip(self.swing["accuracy"], again, strict=True):
            for key in ENVELOPE:
                self.assertEqual(before[key], now[key])


if __name__ == "__main__":
    unittest.main()
