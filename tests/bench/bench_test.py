"""Laws of the measuring program: a tiny report. No verdict depends on how long anything took."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import contact_tables  # noqa: E402
import plots  # noqa: E402
import real_time_tables  # noqa: E402
import report  # noqa: E402
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
            # A third of the smallest error that is asked for.
            self.assertLess(row["noise_of_position"], 1e-3 / 3)
            self.assertLess(row["noise_of_energy"], 1e-3 / 3)
            self.assertGreaterEqual(row["positions_to_s"], 0.75)

    def test_runge_kutta_and_extrapolated_leapfrog_are_the_same_reference(self):
        case = "--scenes", "swing", "--sizes", "16", "--budget", "100"
        kutta, leapfrog = (measure(*case, "--reference", method)
                           for method in ("runge-kutta", "extrapolation"))
        self.assertIn("Runge-Kutta", kutta["references"][0]["how"])
        self.assertIn("extrapolated", leapfrog["references"][0]["how"])
        for one, other in zip(kutta["accuracy"], leapfrog["accuracy"], strict=True):
            for key in ENVELOPE:  # within a tenth of the smallest error that is asked for
                self.assertAlmostEqual(one[key], other[key], delta=1e-4 + 1e-3 * one[key])

    def test_each_solver_has_six_different_settings_whatever_bending_asks_for(self):
        for fewest in (1, 3, 5, 8, 29, 124, 516):
            text = subprocess.run([PROGRAM, "--list-settings", "--fewest", str(fewest)], check=True,
                                  capture_output=True, text=True).stdout
            names = [line.split(" ", 1) for line in text.splitlines()]
            for solver in tables.SOLVERS:
                mine = [name for kind, name in names if kind == solver]
                self.assertGreaterEqual(len(mine), tables.WANTED_SETTINGS)
                self.assertEqual(len(mine), len(set(mine)))
                if solver == "xpbd":  # an odd number of sweeps would run as the next even one
                    self.assertEqual({int(name.split("x")[1]) % 2 for name in mine}, {0})
                if solver in ("xpbd", "relaxation"):
                    self.assertGreaterEqual(min(int(name.split("x")[0]) for name in mine), fewest)

    def test_names_of_settings_tell_what_ran(self):
        # Bending asks for more substeps here than most settings name where it asks for none.
        cells = measure("--scenes", "cantilever", "--sizes", "32", "--budget", "100")["accuracy"]
        relaxing = [cell for cell in cells if cell["solver"] in ("xpbd", "relaxation") and cell["outcome"] != "not run"]
        self.assertGreater(min(cell["substeps"] for cell in relaxing), 16)
        for cell in relaxing:
            self.assertEqual(cell["setting"], f"{cell['substeps']}x{cell['sweeps']}")
            self.assertEqual(tables.setting_name(cell, short=True), f"{cell['substeps']}×{cell['sweeps']}")
            self.assertEqual(cell["same"], 1)

    def test_settings_that_ran_as_another_one_are_merged_and_few_ones_say_why(self):
        cell = {"scene": "swing", "fabric": "soft", "n": 64, "solver": "xpbd", "damping_sweeps": 1, "sweeps": 1,
                "substeps": 30, "least_substeps": 4, "cpu_per_second": 1, "outcome": "ran", "reason": ""}
        cells = tables.distinct([cell, {**cell, "least_substeps": 30, "cpu_per_second": 3},
                                 {**cell, "least_substeps": 8, "cpu_per_second": 7},
                                 {**cell, "substeps": 40, "least_substeps": 40},
                                 {**cell, "outcome": "not run", "reason": "too dear"}])
        self.assertEqual([(c["substeps"], c["least_substeps"], c["cpu_per_second"], c["same"])
                          for c in cells if c["outcome"] == "ran"], [(30, 30, 3, 3), (40, 40, 1, 1)])
        self.assertEqual(tables.setting_name(cells[0]), "XPBD 30×1")
        self.assertIn("| XPBD | 2 | 2 that were asked for fewer than 30 substeps a tick ran with these, as its "
                      "stability needs; 1 not run: too dear |", tables.few_settings(cells))
        self.assertEqual(tables.few_settings([{**cells[0], "substeps": k} for k in range(6)]), "None.")

    def test_every_cell_of_the_report_has_six_settings_or_says_why_not(self):
        cells = tables.read(Path(__file__).parent / "data", "accuracy")
        told = tables.few_settings(cells)
        groups = {}
        for cell in cells:
            groups.setdefault((cell["scene"], cell["fabric"], cell["n"], cell["solver"]), []).append(cell)
        self.assertGreater(len(groups), 150)
        for (scene, fabric, n, solver), group in groups.items():
            ran = [cell for cell in group if cell["outcome"] != "not run"]
            self.assertTrue(all(cell["reason"] for cell in group if cell["outcome"] == "not run"))
            if ran and len(ran) < tables.WANTED_SETTINGS:
                self.assertRegex(told, rf"\| {scene} \| {fabric} \| {n}² \| {tables.NAMES[solver]} \| "
                                       rf"{len(ran)} \| \w")

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

    def test_the_error_of_xpbd_at_rest_falls_with_the_fourth_power_of_its_substeps(self):
        # A sweep leaves k dt^2/m of what the multipliers lack, and there are two of them.
        self.assertAlmostEqual(self.error("64x2") / self.error("128x2"), 2**4, delta=2)

    def test_verlet_is_within_a_thousandth_at_its_own_substeps(self):
        for run, bound in ((self.swing, 5e-3), (self.rest, 1e-3)):  # 16² crumples as it swings back
            cell = next(c for c in run["accuracy"] if c["setting"] == "x1")
            self.assertLess(cell["position"], bound)

    def test_a_run_off_by_more_than_the_way_counts_as_failed(self):
        # Rigid springs cannot sag between two edges; few sweeps sag far too much.
        failed = [c for c in self.rest["accuracy"] if c["outcome"] == "failed"]
        for cell in self.rest["accuracy"]:
            self.assertEqual(cell["outcome"] == "failed",
                             max(cell["position"], cell["mean_shape"], cell["energy"]) > 1)
        self.assertGreater(len(failed), 0)
        for cell in failed:
            self.assertRegex(cell["reason"], r"^(positions|mean shape|energy) off by \d+ %$")
            self.assertGreater(cell["cpu_per_second"], 0)
            self.assertTrue(0 < plots.height_of(cell) <= 100 * plots.HIGHEST)
        self.assertEqual(plots.height_of({"outcome": "failed", "position": 0}), 100 * plots.HIGHEST)

    def test_errors_tell_the_penetration_of_each_scene_in_which_something_is_met(self):
        cells = tables.read(Path(__file__).parent / "data", "accuracy")
        self.assertIn("penetration", tables.error_vectors(cells, "drape"))
        self.assertIn("| 0 mm |", tables.error_vectors(self.swing["accuracy"], "swing"))

    def test_a_drape_is_compared_while_it_touches_the_sphere(self):
        # The fall takes sqrt(2 h / g) = 0.032 s.
        for row in tables.read(Path(__file__).parent / "data", "references"):
            if row["scene"] == "drape" and not row["missing"]:
                self.assertGreaterEqual(row["compared_from_s"], 0.049)

    def test_what_is_above_the_budget_is_not_run_and_says_why(self):
        cells = measure("--scenes", "swing", "--sizes", "16", "--budget", "0")["accuracy"]
        self.assertGreater(len(cells), 6)
        for cell in cells:
            self.assertEqual(cell["outcome"], "not run")
            self.assertIn("CPU s, more than", cell["reason"])
        self.assertIn("CPU s, more than", tables.cost_of_accuracy(cells))

    def test_the_verdict_on_an_implicit_solver_follows_the_figures(self):
        def case(name, dearest, springs, twice=0, wall=0, implicit=0):
            return {"case": name, "kind": "scene", "seconds_looked_at": 4, "dearest_second": dearest,
                    "springs": springs, "air": 0, "contact": 1 - springs, "other": 0, "twice_the_substeps": twice,
                    "wall_two_threads": wall, "implicit": implicit, "runs": 5, "commit": "a"}

        def told(*rows):
            return real_time_tables.verdict(rows), real_time_tables.summary(rows)

        fast = case("wall", 0.9, 0.9)
        verdict, summary = told(fast)
        self.assertIn("**No**", verdict)
        self.assertIn("holds each of 1 cases", summary)
        # Springs that cost nothing would help where they take much, and not where contact does.
        verdict, summary = told(fast, case("sling", 2.5, 0.7))
        self.assertIn("**Called for** by sling", verdict)
        self.assertIn("if these cost nothing, sling would be held.", summary)
        verdict, summary = told(fast, case("bunny", 2.5, 0.1, 4.9, 1.2))
        self.assertIn("does **not** hold 1 of 2 cases in real time on one thread: bunny (2.5 CPU s a simulated "
                      "second, 1.2 s by the clock on two; contact 90 %, springs 10 %", verdict)
        self.assertIn("**No** solver of the springs would change that", verdict)
        self.assertIn("if substeps cost nothing at all, bunny would be held", verdict)
        self.assertIn("`verlet` does not hold bunny in real time: 1 of 2 cases.", summary)
        self.assertIn("none of them would be held", summary)
        self.assertNotIn("`implicit`", summary)
        # And what it takes in fact stands beside.
        for text in told(case("bunny", 2.5, 0.1, implicit=1.2)):
            self.assertIn("`implicit` holds none of them either.", text)
        for text in told(case("bunny", 2.5, 0.1, implicit=1.2), case("drape", 1.3, 0.4, implicit=0.9)):
            self.assertIn("`implicit` holds 1 of them: drape (0.9 CPU s a simulated second).", text)
        verdict, summary = told(case("a", 1.1, 0.5, 2, 0.9), case("b", 3, 0.1))
        self.assertIn("would bring b into real time", verdict)
        self.assertIn("Two threads hold a.", summary)
        self.assertIn("a would be held, the others not.", summary)

    def test_what_runs_in_real_time_is_compared_for_the_same_time_and_shared_out(self):
        directory = tempfile.mkdtemp()
        subprocess.run([PROGRAM, "--out", directory, "--quick", "--parts", "real-time"], check=True,
                       capture_output=True, timeout=300)
        rows = tables.read(directory, "real_time")
        self.assertEqual({row["kind"] for row in rows}, {"scene", "hard case", "cotton"})
        self.assertEqual({row["seconds_looked_at"] for row in rows}, {1})
        for row in rows:
            self.assertAlmostEqual(sum(row[key] for key in ("springs", "air", "contact", "other")), 1, delta=1e-3)
            self.assertGreater(row["twice_the_substeps"], 0)
            self.assertGreater(row["implicit"], 0)
        self.assertIn(f"{len(rows)} cases", real_time_tables.need_of_implicit(rows))

    def test_a_part_that_is_measured_anew_takes_the_place_of_its_cases_alone(self):
        old, new = Path(tempfile.mkdtemp()), Path(tempfile.mkdtemp())
        head = "scene,fabric,n,setting\n"
        (old / "accuracy.csv").write_text(head + "swing,soft,32,x1\nflag,soft,32,x1\nflag,soft,32,x2\n")
        (old / "machine.csv").write_text("key,value\n")
        (old / "kernels.csv").write_text("old")
        (new / "accuracy.csv").write_text(head + "flag,soft,32,x3\nflag,soft,64,x1\n")
        (new / "machine.csv").write_text("other")
        (new / "kernels.csv").write_text("new")
        report.take_in(new, old)
        self.assertEqual((old / "accuracy.csv").read_text(),
                         head + "swing,soft,32,x1\nflag,soft,32,x3\nflag,soft,64,x1\n")
        self.assertEqual((old / "machine.csv").read_text(), "key,value\n")
        self.assertEqual((old / "kernels.csv").read_text(), "new")

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
        self.assertEqual(tables.sizes_taken([cell("a", 256, 1)]), "256² at commit a, one run each.")

    def test_the_report_tells_the_drag_that_each_scene_is_run_with(self):
        # A function of cases.cpp sets what differs from the world or scene that it begins with.
        source = (Path(__file__).parent / "cases.cpp").read_text(encoding="utf-8")
        drags, begins = {}, {}
        for name, body in re.findall(r"^WorldDef (\w+)\(int.*?\{(.*?)^\}", source, re.MULTILINE | re.DOTALL):
            begins[name] = re.search(r"WorldDef def(?: = (\w+)\()?", body)[1]
            drag = re.search(r"environment\.damping = ([\d.]+);", body)
            drags[name] = float(drag[1]) if drag else drags[begins[name]]
        for scene, drag in report.DRAG.items():
            self.assertEqual(drags[scene.replace("-", "_")], drag, scene)
        data = Path(__file__).parent / "data"
        text = report.report_text(data)
        for scene in tables.unique(cell["scene"] for cell in tables.read(data, "accuracy")):
            self.assertIn(report.conditions(scene), text.split(f"## {report.SCENES[scene]}\n")[1].split("\n## ")[0])
        costs = text.split("## What an error costs\n")[1].split("\n## ")[0]
        for scene in report.COSTED:
            self.assertIn(f"{report.SCENES[scene]}: {report.conditions(scene)};", costs)

    def test_what_was_not_measured_is_not_told_as_a_figure_and_commits_are_told(self):
        self.assertEqual(report.machine_rows({"commit": "a", "load of the machine at the end": "the run was cut",
                                              "CPU seconds of all measurements": 0}),
                         [["commit", "a"], ["load of the machine at the end", "not measured: the run was cut"],
                          ["CPU seconds of all measurements", "not measured: the run was cut"]])
        self.assertEqual(report.commits([{"commit": "a"}], [{"commit": "a"}]), "")
        self.assertIn("**not of one commit** but of 2: a, b;", report.commits([{"commit": "a"}], [{"commit": "b"}]))

    def test_each_quantity_has_its_own_cheapest_setting_and_none_below_its_noise(self):
        def cell(solver, cost, position, strain, energy, outcome="ran"):
            return {"scene": "swing", "fabric": "cotton", "n": 64, "solver": solver, "outcome": outcome, "reason": "too dear",
                    "setting": "x1", "cpu_per_second": cost, "substeps": 8, "least_substeps": 8, "sweeps": 1,
                    "position": position, "strain": strain, "energy": energy}
        nothing = float("nan")  # not compared
        cells = [cell("xpbd", 1, 0.05, 7, 0.2), cell("xpbd", 2, 0.009, 1.6, 0.02),
                 cell("verlet", 3, 0.0001, 0.02, nothing), cell("verlet", 9, 0, 0, 0, "not run")]
        self.assertEqual(tables.cost_of_accuracy(cells).splitlines()[2:], [
            "| 64² | 10 % | 1 (XPBD 8×1) | 3 (verlet ×1) | 2 (XPBD 8×1) |",
            "|  | 1 % | 2 (XPBD 8×1) | none that was run | none that was run |",
            "|  | 0.1 % | 3 (verlet ×1) | – | none that was run |"])
        self.assertEqual(tables.default_errors(cells, "swing"), "0.01 % in position, 2 % in strain")
        several = tables.cost_of_accuracy(cells + [{**cells[0], "fabric": "soft"}])
        self.assertIn("| 64² | soft | 10 % | 1 (XPBD 8×1) |", several)

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
