"""Faces of mesh files with more than three corners, from the file to the mass of a cloth and the notch
of an object; those that cannot be cut are refused by their number."""

import json
import math
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy

from foreign_client import PROGRAM, main

L = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
SHAPES = {
    "L": L,
    "plus": [(1, 0), (2, 0), (2, 1), (3, 1), (3, 2), (2, 2), (2, 3), (1, 3), (1, 2), (0, 2), (0, 1), (1, 1)],
    "T": [(0, 2), (1, 2), (1, 0), (2, 0), (2, 2), (3, 2), (3, 3), (0, 3)],
    "hexagon": [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)],
}
CROSSED = [(0, 0), (3, 0), (0, 1), (1, 2)]
ROW = [(0, 0), (1, 0), (2, 0), (3, 0)]


def area(outline):
    return abs(sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(outline, outline[1:] + outline[:1]))) / 2


def obj(points, faces):
    return ("".join(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in points)
            + "".join("f " + " ".join(str(i + 1) for i in face) + "\n" for face in faces))


def sheet(outline, scale=0.1):
    return obj([(x * scale, 1, z * scale) for x, z in outline], [list(range(len(outline)))])


def simulate(text, cloth=True, ticks=1, extent=None):
    """The finished process and the arrays of its series; the mesh is a cloth or an object."""
    with tempfile.TemporaryDirectory(prefix="weft_faces_") as folder:
        Path(folder, "mesh.obj").write_text(text, encoding="ascii")
        scene = {"cloths": [{"form": "mesh", "mesh": {"source": "mesh.obj"}, "fabric": {"areal_density": 1}}],
                 "environment": {"gravity": [0, -1, 0]}}
        if not cloth:
            scene = {"cloths": [{"rows": 5, "columns": 5, "width": 0.08, "height": 0.08, "u": [1, 0, 0],
                                 "v": [0, 0, 1], "origin": extent or [0, 3, 0], "fabric": {"preset": "denim"}}],
                     "colliders": [{"shape": "mesh", "source": "mesh.obj"}, {"shape": "plane"}]}
        path, series = Path(folder, "scene.json"), Path(folder, "series.npy")
        path.write_text(json.dumps(scene), encoding="ascii")
        done = subprocess.run([PROGRAM, "simulate", "--scene", path, "--ticks", str(ticks), "--series", series,
                               "--json"], capture_output=True, text=True, timeout=200)
        return done, numpy.load(series) if done.returncode == 0 else None


def orders(outline):
    for first in range(len(outline)):
        for step in (1, -1):
            yield (outline[first:] + outline[:first])[::step]


def prism(outline, height, backwards):
    n = len(outline)
    points = [(x, y, z) for y in (height, 0) for x, z in outline]
    faces = [list(range(n))[::-1], list(range(n, 2 * n))]
    faces += [[i, (i + 1) % n, n + (i + 1) % n, n + i] for i in range(n)]
    return obj(points, [face[::-1] if backwards else face for face in faces])


class Faces(unittest.TestCase):
    def test_a_cloth_of_one_polygon_has_the_mass_of_its_area_in_each_order_of_its_corners(self):
        for name, outline in SHAPES.items():
            for corners in orders(outline):
                with self.subTest(name=name, corners=corners):
                    done, series = simulate(sheet(corners))
                    self.assertEqual(done.returncode, 0, done.stderr)
                    self.assertAlmostEqual(series["gravity"][0], 0.01 * area(outline), delta=1e-6 * area(outline))

    def test_a_sheet_of_hexagons_is_a_cloth(self):
        points = [(0.1 * x, 1, 0.1 * z) for z in range(5) for x in range(5)]
        faces = [[5 * z + x + k for k in (0, 1, 2, 7, 6, 5)] for z in range(4) for x in (0, 2)]
        done, series = simulate(obj(points, faces))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["triangles"], 32)
        self.assertAlmostEqual(series["gravity"][0], 0.16, delta=1e-6)

    def test_cloth_falls_to_the_ground_in_the_notch_of_a_prism(self):
        outline = [(0.4 * x, 0.4 * z) for x, z in L]
        for first in range(len(outline)):
            for backwards in (False, True):
                with self.subTest(first=first, backwards=backwards):
                    text = prism(outline[first:] + outline[:first], 0.5, backwards)
                    done, series = simulate(text, cloth=False, ticks=120, extent=[0.42, 0.6, 0.42])
                    self.assertEqual(done.returncode, 0, done.stderr)
                    self.assertLess(series["x"][-1][:, 1].max(), 0.01)

    def test_a_face_that_cannot_be_cut_is_refused_by_its_number(self):
        for cloth, where in ((True, "cloths[0].mesh.source"), (False, "colliders[0].source")):
            points = [(x * 0.1, 1, z * 0.1) for x, z in L + CROSSED]
            done, _ = simulate(obj(points, [list(range(6)), list(range(6, 10))]), cloth)
            self.assertEqual(done.returncode, 2)
            self.assertIn(f"{where} = mesh.obj: allowed is polygons whose sides do not cross "
                          "(face 2, with 4 corners, the first at (0, 1, 0))\n", done.stderr)

    def test_a_face_without_area_is_refused_in_a_cloth_and_left_out_of_an_object(self):
        points = [(x * 0.1, 1, z * 0.1) for x, z in ROW + L]
        text = obj(points, [list(range(4, 10)), list(range(4))])
        done, _ = simulate(text)
        self.assertEqual(done.returncode, 2)
        self.assertIn("cloths[0].mesh.source = mesh.obj: allowed is faces with an area "
                      "(face 2, with 4 corners, the first at (0, 1, 0))\n", done.stderr)
        done, _ = simulate(text, cloth=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("2 of its 6 triangles have no area and are left out", done.stderr)

    def test_a_face_of_very_many_corners_is_refused_and_one_of_many_is_taken(self):
        def disc(corners):
            turns = [2 * math.pi * k / corners for k in range(corners)]
            return obj([(math.cos(t), 1, math.sin(t)) for t in turns], [list(range(corners))])
        done, _ = simulate(disc(100_000))
        self.assertEqual(done.returncode, 2)
        self.assertIn("polygons of at most 4096 corners (face 1, with 100000 corners", done.stderr)
        done, _ = simulate(disc(4096), cloth=False)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_mesh_given_by_its_name_alone_is_told_how_to_give_it(self):
        with tempfile.TemporaryDirectory(prefix="weft_faces_") as folder:
            path = Path(folder, "scene.json")
            path.write_text('{"cloths": [{"form": "mesh", "mesh": "towel.obj"}]}', encoding="ascii")
            done = subprocess.run([PROGRAM, "simulate", "--scene", path], capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertIn('cloths[0].mesh = "towel.obj": allowed is an object {...} ({"source": "towel.obj"})',
                      done.stderr)


if __name__ == "__main__":
    main()
