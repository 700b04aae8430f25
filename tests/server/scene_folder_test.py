"""Scenes over the socket and from the server's folder: names and meshes, never a path; files that a
stranger wrote neither stop the server nor reach its memory."""

import json
import struct
import subprocess
import tempfile
import unittest
from pathlib import Path

from foreign_client import PROGRAM, Server, SocketTest, main

FOLDER = tempfile.TemporaryDirectory(prefix="weft_folder_")
SQUARE = "v 0 1 0\nv 1 1 0\nv 1 0 0\nv 0 0 0\nf 1 4 2\nf 2 4 3\n"
# Assimp 5.2.5 counts to the end of the numbers on a list this long.
ENDLESS = (b"ply\nformat binary_little_endian 1.0\nelement vertex 4294967295\nproperty float x\n"
           b"property list uint float y\nelement face 4294967295\nend_header\n\0\0\0\0\xff\xff\xff\xff")
# A tetrahedron whose triangles face inwards, and one more without area.
INWARD = ("v 0 0 0\nv 0.2 0 0\nv 0 0.2 0\nv 0 0 0.2\n"
          "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\nf 2 3 2\n")
REPAIRS = ["model: 1 of its 5 triangles have no area and are left out",
           "model: its triangles faced inwards and are turned, so that it is solid"]
SMALL = {"cloths": [{"rows": 5, "columns": 7}], "pins": [{"place": "corner", "corner": "top_left"}]}


def fill(folder):
    (folder / "square.obj").write_text(SQUARE)
    (folder / "inward.obj").write_text(INWARD)
    (folder / "eight.stl").write_bytes(b"solid\0\0\0")
    (folder / "huge.obj").write_bytes(b"v 0 0 0\n" * (5 << 20))
    (folder / "tall.json").write_text(json.dumps({**SMALL, "description": "A small cloth."}))
    (folder / "wrong.json").write_text('{"cloths": [{"rowz": 3}]}')
    (folder / "path.json").write_text(json.dumps(
        {"cloths": [{"form": "mesh", "mesh": {"source": "../square.obj"}}]}))
    (folder / "not plain.json").write_text("{}")
    (folder / "mesh.json").write_text(json.dumps(
        {"cloths": [{"form": "mesh", "mesh": {"source": "square.obj"}}]}))


class SceneFolder(SocketTest):
    options = ("--scene", "tall", "--scenes", FOLDER.name)

    @classmethod
    def setUpClass(cls):
        fill(Path(FOLDER.name))
        super().setUpClass()

    async def test_the_folder_s_good_scenes_are_listed_and_loaded_by_name(self):
        listed = json.loads(self.server.get("/api/v1/scenes")[2])["scenes"]
        names = [scene["name"] for scene in listed]
        self.assertEqual(names[0], "default")
        self.assertEqual(names[-2:], ["mesh", "tall"])
        viewer = await self.viewer()
        self.assertEqual((await viewer.ask("load", scene="mesh"))["scene"], "mesh")
        mesh = await viewer.wait_text(lambda m: m["op"] == "mesh" and m["scene"] == "mesh")
        self.assertEqual((mesh["vertices"], mesh["triangles"]), (4, 2))
        self.assertNotIn("rows", mesh["cloths"][0])

    async def test_a_scene_as_an_object_is_loaded(self):
        viewer = await self.viewer()
        scene = {"name": "mine", "cloths": [{"rows": 4, "columns": 6, "fabric": {"preset": "silk"}},
                                            {"name": "sail", "form": "mesh",
                                             "mesh": {"source": "square.obj", "position": [3, 0, 0]}}],
                 "colliders": [{"shape": "mesh", "source": "dress-form"}],
                 "pins": [{"place": "corner", "corner": "bottom_right", "cloth": "sail"}]}
        answer = await viewer.ask("load", scene=scene)
        self.assertEqual(answer["op"], "result", answer)
        self.assertEqual(answer["scene"], "mine")
        mesh = await viewer.wait_text(lambda m: m["op"] == "mesh" and m["scene"] == "mine")
        self.assertEqual([(c["name"], c["first_vertex"], c["vertices"], c["first_triangle"], c["triangles"])
                          for c in mesh["cloths"]], [("cloth", 0, 24, 0, 30), ("sail", 24, 4, 30, 2)])
        state = await viewer.wait_text(lambda m: m["op"] == "state" and m["scene"] == "mine")
        self.assertEqual(state["fabric"], "silk, default")

    async def test_a_repaired_object_is_told_to_who_is_there_and_who_comes_later(self):
        viewer = await self.viewer()
        scene = {**SMALL, "colliders": [{"name": "model", "shape": "mesh", "source": "inward.obj"}]}
        self.assertEqual((await viewer.ask("load", scene=scene))["op"], "result")
        later = await self.viewer()
        await later.wait_frame(lambda f: True)
        for each in (viewer, later):
            notices = [m for m in each.texts if m["op"] == "notice" and m["code"] == "mesh_repaired"]
            self.assertEqual([notice["message"] for notice in notices], REPAIRS)
            self.assertEqual({notice["level"] for notice in notices}, {"warning"})
        mesh = [m for m in later.texts if m["op"] == "mesh"][-1]
        self.assertEqual(mesh["colliders"][0]["triangles"], 4)
        await viewer.ask("load", scene="tall")
        last = await self.viewer()
        await last.wait_frame(lambda f: True)
        self.assertNotIn("mesh_repaired", [m.get("code") for m in last.texts])

    async def test_the_same_object_gives_the_same_hash_as_the_same_file(self):
        viewer = await self.viewer()
        hashes = []
        await viewer.ask("pause")
        for scene in ("tall", SMALL):
            self.assertEqual((await viewer.ask("load", scene=scene))["op"], "result")
            hashes.append((await viewer.ask("advance", n=60))["hash"])
        self.assertEqual(hashes[0], hashes[1])
        await viewer.ask("resume")

    async def test_the_model_of_the_seed_is_chosen_by_name(self):
        viewer = await self.viewer()
        await viewer.ask("pause")
        pinned = {"name": "one", "cloths": [{"rows": 8, "columns": 8}],
                  "pins": [{"place": "corner", "corner": "top_left"}]}
        work = {}
        for model in ("weft", "seed"):
            self.assertEqual((await viewer.ask("load", scene={**pinned, "model": model}))["op"], "result")
            await viewer.ask("advance", n=10)
            stages = (await viewer.ask("query", what="work"))["data"]
            work[model] = {stage["stage"]: stage["work"] for stage in stages}
        self.assertEqual((work["weft"]["relaxation"], work["seed"]["stretch"]), (0, 0))
        self.assertGreater(work["weft"]["stretch"], 0)
        self.assertGreater(work["seed"]["relaxation"], 0)
        answer = await viewer.ask("load", scene={**pinned, "model": "sed"})
        self.assertEqual((answer["op"], answer["field"]), ("error", "scene.model"))
        await viewer.ask("resume")

    async def test_what_is_wrong_is_named_by_its_path_and_changes_nothing(self):
        viewer = await self.viewer()
        before = (await viewer.ask("query", what="state"))["data"]["scene"]
        cloth = {"rows": 5, "columns": 5}
        table = [
            ({"cloths": [{**cloth, "fabric": {"shear": -1}}]}, "scene.cloths[0].fabric.shear"),
            ({"cloths": [{**cloth, "colour": 1}]}, "scene.cloths[0].colour"),
            ({}, "scene.cloths"),
            ({"cloths": [{"form": "mesh", "mesh": {"source": "/etc/passwd"}}]},
             "scene.cloths[0].mesh.source"),
            ({"cloths": [{"form": "mesh", "mesh": {"source": "../square.obj"}}]},
             "scene.cloths[0].mesh.source"),
            ({"cloths": [{"form": "mesh", "mesh": {"source": "eight.stl"}}]},
             "scene.cloths[0].mesh.source"),
            ({"cloths": [cloth], "pins": [{"place": "particle", "particle": 25}]}, "scene.pins[0].particle"),
        ]
        for scene, where in table:
            answer = await viewer.ask("load", scene=scene)
            self.assertEqual((answer["op"], answer.get("field")), ("error", where), answer)
        for name in ("/etc/passwd", "../tall", "tall.json", "wrong", "path"):
            self.assertEqual((await viewer.ask("load", scene=name))["op"], "error")
        self.assertEqual((await viewer.ask("query", what="state"))["data"]["scene"], before)

    async def test_the_schema_is_served(self):
        status, headers, body = self.server.get("/api/v1/scene-schema")
        self.assertEqual((status, headers["Content-Type"]), (200, "application/schema+json"))
        printed = subprocess.run([PROGRAM, "scenes", "--schema"], capture_output=True, timeout=60).stdout
        self.assertEqual(body, printed)


class HostileMeshes(unittest.TestCase):
    def simulate(self, source, *options):
        with tempfile.TemporaryDirectory(prefix="weft_mesh_") as folder:
            fill(Path(folder))
            (Path(folder) / "endless.ply").write_bytes(ENDLESS)
            scene = Path(folder) / "scene.json"
            scene.write_text(json.dumps({"cloths": [{"rows": 3, "columns": 3}],
                                         "colliders": [{"name": "model", "shape": "mesh", "source": source}]}))
            return subprocess.run([PROGRAM, "simulate", "--scene", scene, "--ticks", "1", *options],
                                  capture_output=True, text=True, timeout=100)

    def test_bad_mesh_files_are_refused_in_one_line(self):
        for source, what in (("endless.ply", "allowed is"), ("eight.stl", "allowed is a whole"),
                             ("huge.obj", "at most 33554432 bytes"), ("none.obj", "a file that can be read"),
                             ("scene.json", "ends in .obj"), ("/dev/zero.obj", "a file that can be read")):
            with self.subTest(source=source):
                result = self.simulate(source)
                self.assertEqual(result.returncode, 2, result)
                self.assertIn("colliders[0].source = ", result.stderr)
                self.assertIn(what, result.stderr)
                # With sanitizers the parser's own death is told first.
                told = result.stderr.rpartition("ABORTING\n")[2]
                self.assertEqual(told.count("\n"), 1, result.stderr)

    def test_a_faulty_file_of_the_folder_is_told_by_its_own_reason_as_its_path_is(self):
        with tempfile.TemporaryDirectory(prefix="weft_faulty_") as folder:
            fill(Path(folder))
            for name, content in (("curtain", {"cloths": [{"rowz": 3}]}),  # also a built-in one
                                  ("eight", {"cloths": [{"form": "mesh", "mesh": {"source": "eight.stl"}}]})):
                (Path(folder) / f"{name}.json").write_text(json.dumps(content))
            for name, what in (("wrong", "wrong.json: cloths[0].rowz = 3"), ("curtain", "curtain.json: cloths[0].rowz"),
                               ("eight", "eight.json: cloths[0].mesh.source = eight.stl: allowed is a whole")):
                with self.subTest(name=name):
                    by_path, by_name = (
                        subprocess.run([PROGRAM, "simulate", *scene, "--ticks", "1"], capture_output=True,
                                       text=True, timeout=100)
                        for scene in (("--scene", f"{folder}/{name}.json"), ("--scenes", folder, "--scene", name)))
                    self.assertEqual(by_name.returncode, 2, by_name)
                    self.assertEqual(by_name.stderr, by_path.stderr)
                    self.assertIn(what, by_name.stderr)

    def test_a_good_one_is_taken(self):
        self.assertEqual(self.simulate("square.obj").returncode, 0)

    def test_a_repaired_one_is_told_in_a_line_and_in_the_summary(self):
        result = self.simulate("inward.obj", "--json")
        self.assertEqual(result.returncode, 0, result)
        self.assertEqual(result.stderr, "".join(f"weft: {line}\n" for line in REPAIRS))
        self.assertEqual(json.loads(result.stdout)["notices"], REPAIRS)
        self.assertEqual(json.loads(self.simulate("square.obj", "--json").stdout)["notices"], [])

    def test_the_child_answers_counts_numbers_and_indices(self):
        answer = subprocess.run([PROGRAM, "mesh-child", "square.obj"], input=SQUARE.encode(),
                                capture_output=True, timeout=60).stdout
        self.assertEqual(struct.unpack_from("<cQQQQ", answer), (b"M", 4, 2, 0, 0))
        self.assertEqual(len(answer), 33 + 4 * 24 + 2 * 12)

    def test_the_child_answers_the_uv_of_corners_at_a_seam(self):
        # Two triangles of a square, whose common edge has other uv on each side.
        seam = SQUARE.split("f ")[0] + "".join(
            f"vt {u} {v}\n" for u, v in ((0, 0), (1, 0), (1, 1), (5, 5), (6, 6), (5, 6)))
        seam += "f 1/1 2/2 3/3\nf 1/4 3/5 4/6\n"
        answer = subprocess.run([PROGRAM, "mesh-child", "seam.obj"], input=seam.encode(),
                                capture_output=True, timeout=60).stdout
        self.assertEqual(struct.unpack_from("<cQQQQ", answer), (b"M", 4, 2, 4, 2))
        corners = struct.unpack("<12d", answer[-96:])
        self.assertEqual(corners, (0, 0, 1, 0, 1, 1, 5, 5, 6, 6, 5, 6))


if __name__ == "__main__":
    main()
