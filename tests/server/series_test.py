"""A series is what numpy reads, tells what the summary tells, changes no bit, and can be gone on from."""

import json
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy

from foreign_client import PROGRAM, main

# Nothing here remembers what it did before a tick: no contact, no gusts, no moving object.
HAMMOCK = ("--scene", "hammock", "--set", "contact.self=none", "--set", "environment.wind=0,0,0")


def program(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=120, check=False)


def simulate(*arguments):
    return program("simulate", *arguments)


def summary(*arguments):
    return json.loads(simulate("--json", *arguments).stdout)


class Series(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def series(self, name, *arguments):
        path = self.folder / name
        result = simulate(*arguments, "--series", path)
        self.assertEqual(result.returncode, 0, result.stderr)
        return path, numpy.load(path)

    def test_the_last_record_tells_what_the_summary_tells(self):
        path = self.folder / "run.npy"
        told = summary("--scene", "flag", "--ticks", 12, "--series", path, "--series-every", 4)
        series = numpy.load(path)
        self.assertEqual(series["tick"].tolist(), [0, 4, 8, 12])
        numpy.testing.assert_allclose(series["time"], series["tick"] / 60)
        for name in ("kinetic", "stretch", "bending", "gravity"):
            self.assertAlmostEqual(series[name][-1], told["energy"][name], places=9)
        self.assertAlmostEqual(series["strain"][-1], told["strain"]["largest"], delta=1e-5)
        self.assertEqual(series["x"].shape, (4, told["particles"], 3))
        self.assertEqual(told["hash"], summary("--scene", "flag", "--ticks", 12)["hash"])

    def test_forces_of_pins_carry_a_cloth_at_rest(self):
        _, series = self.series("rest.npy", *HAMMOCK, "--set", "environment.drag=5", "--ticks", 900,
                                "--series-every", 900)
        self.assertTrue(numpy.isnan(series["pins"][0]).all())
        weight = -series["gravity"][-1] / series["x"][-1, :, 1].mean()
        numpy.testing.assert_allclose(series["pins"][-1].sum(axis=0), [0, -weight, 0], atol=0.01 * abs(weight))

    def test_what_no_damping_takes_is_the_work_in_the_energies(self):
        scene = json.loads(program("scenes", "--json", "hammock").stdout)
        scene["environment"].update(drag=0, wind=[0, 0, 0], gust_speed=0)
        scene["contact"]["self"] = "none"
        scene["cloths"][0]["fabric"].update(damping_ratio=0, bending_damping=0)
        scene["colliders"] = []
        scene["hands"] = [{"u": 0.5, "v": 0.5, "radius": 0.1, "stiffness": 60, "max_force": 50,
                           "path": [{"time": 0, "offset": [0, 0, 0]}, {"time": 10, "offset": [0, 5, 0.5]}]}]
        path = self.folder / "pulled.json"
        path.write_text(json.dumps(scene))
        _, series = self.series("pulled.npy", "--scene", path, "--ticks", 12, "--series-every", 6)
        energy = series["kinetic"] + series["stretch"] + series["bending"] + series["gravity"]
        least = numpy.abs(series["work"][1:]).min()
        self.assertGreater(least, 1e-3)
        numpy.testing.assert_allclose(numpy.diff(energy), series["work"][1:], atol=0.02 * least)

    def test_work_and_energy_of_each_stretch_of_time_add_up_to_the_runs(self):
        _, fine = self.series("fine.npy", "--scene", "flag", "--ticks", 12)
        _, coarse = self.series("coarse.npy", "--scene", "flag", "--ticks", 12, "--series-every", 6)
        numpy.testing.assert_allclose(fine["work"][1:].reshape(2, 6).sum(axis=1), coarse["work"][1:], rtol=1e-12)

    def test_a_run_cut_in_two_by_a_file_is_the_same_run(self):
        half, _ = self.series("half.npy", *HAMMOCK, "--ticks", 10)
        _, rest = self.series("rest.npy", *HAMMOCK, "--ticks", 10, "--start", half)
        _, whole = self.series("whole.npy", *HAMMOCK, "--ticks", 20)
        for name in ("x", "v"):
            numpy.testing.assert_array_equal(rest[name], whole[name][10:])
            self.assertGreater(numpy.ptp(whole[name][10:], axis=0).max(), 1e-3, "it moves")

    def test_in_double_precision_a_run_is_that_in_single_without_its_rounding(self):
        _, single = self.series("single.npy", *HAMMOCK, "--ticks", 20)
        half, _ = self.series("half.npy", *HAMMOCK, "--ticks", 10, "--double")
        _, rest = self.series("rest.npy", *HAMMOCK, "--ticks", 10, "--start", half, "--double")
        _, whole = self.series("whole.npy", *HAMMOCK, "--ticks", 20, "--double")
        self.assertEqual((single["x"].dtype, whole["x"].dtype), ("f4", "f8"))
        numpy.testing.assert_array_equal(rest["x"], whole["x"][10:])
        # The state has more digits than a float, and is where the float run is but for its rounding.
        self.assertGreater(numpy.abs(whole["x"][-1] - whole["x"][-1].astype("f4")).max(), 0)
        self.assertLess(numpy.abs(whole["x"] - single["x"]).max(), 1e-4)
        told = [summary(*HAMMOCK, "--ticks", 20, *more) for more in ((), ("--double",))]
        self.assertEqual([t["precision"] for t in told], ["single", "double"])
        self.assertAlmostEqual(told[0]["energy"]["total"], told[1]["energy"]["total"], places=4)

    def test_an_array_of_positions_starts_at_rest_and_one_with_velocities_moves(self):
        half, series = self.series("half.npy", *HAMMOCK, "--ticks", 10)
        x, v = series["x"][-1], series["v"][-1]
        for name, array, velocity in (("x.npy", x, 0 * v), ("xv.npy", numpy.hstack([x, v]).astype("f8"), v)):
            numpy.save(self.folder / name, array)
            _, begun = self.series("begun.npy", *HAMMOCK, "--ticks", 1, "--start", self.folder / name)
            free = numpy.linalg.norm(series["v"], axis=2).max(axis=0) > 0
            numpy.testing.assert_array_equal(begun["x"][0], x)
            numpy.testing.assert_array_equal(begun["v"][0][free], velocity[free])

    def test_what_is_no_start_of_this_scene_is_refused_by_name(self):
        _, series = self.series("half.npy", *HAMMOCK, "--ticks", 1)
        x = series["x"][-1].astype("f8")
        whole = (self.folder / "half.npy").read_bytes()
        infinite, far, fast = x.copy(), x.copy(), numpy.hstack([x, 0 * x])
        infinite[3, 1], far[4, 2], fast[5, 3] = numpy.inf, 2000, 101
        cases = {"text.npy": b"no such file", "empty.npy": b"", "cut.npy": whole[:-1], "header.npy": whole[:50],
                 "few.npy": x[:-1], "flat.npy": x.ravel(), "four.npy": numpy.hstack([x, x[:, :1]]),
                 "whole.npy": x.astype("i8"), "fortran.npy": numpy.asfortranarray(x), "none.npy": series[:0],
                 "infinite.npy": infinite, "far.npy": far, "fast.npy": fast, "longer.npy": whole + b"\0",
                 "point.npy": 0 * x}
        words = {"few.npy": "start.x", "infinite.npy": "start.x[3]", "far.npy": "start.x[4]", "fast.npy": "start.v[5]",
                 "point.npy": "start.x"}
        for name, content in cases.items():
            path = self.folder / name
            path.write_bytes(content) if isinstance(content, bytes) else numpy.save(path, content)
            with self.subTest(name=name):
                result = simulate(*HAMMOCK, "--ticks", 1, "--start", path)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn(f"weft: {words.get(name, '--start')} = ", result.stderr)
                self.assertIn("allowed is", result.stderr)

    def test_headers_that_promise_more_than_there_is_are_refused(self):
        header = "{'descr': %s, 'fortran_order': False, 'shape': (%s), }"
        fields = "[('x', '<f8', (%d, 3)), ('v', '<f8', (%d, 3))]"
        huge = 2**62
        for text in (header % ("'<f8'", f"{huge}, 3"), header % (fields % (huge, huge), "1,"),
                     header % (fields % (400, 400), f"{huge},"), header % (fields % (400, 400), "-1,"),
                     header % ("[('x', 3)]", "1,"), header % ("3", "1,"), "[" * 60000, "{", "{'descr': '<f8'}"):
            path = self.folder / "hostile.npy"
            path.write_bytes(b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode())
            with self.subTest(header=text[:60]):
                result = simulate(*HAMMOCK, "--ticks", 1, "--start", path)
                self.assertEqual(result.returncode, 2, result.stderr)
                self.assertIn("--start = ", result.stderr)

    def test_a_run_that_is_given_up_leaves_no_file(self):
        path = self.folder / "run.npy"
        result = simulate("--scene", "hard-stack", "--ticks", 600, "--tick-limit", 0.000001, "--series", path)
        self.assertEqual(result.returncode, 4, result.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])


if __name__ == "__main__":
    main()
