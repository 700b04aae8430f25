"""Scene files from outside: the program's validator and the published schema agree.

Every built-in scene validates with both. 100 mutated ones, of many kinds and with a fixed seed, are
refused by both, and both name the place that was changed.
"""

import copy
import json
import os
import random
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import jsonschema

PROGRAM = os.environ["WEFT_PROGRAM"]
SOURCE = Path(os.environ["WEFT_SOURCE_DIR"])
MUTATIONS = 100
SEED = 20261121


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=120)


def place(path):
    """["cloths", 0, "rows"] as cloths[0].rows"""
    text = ""
    for part in path:
        text += f"[{part}]" if isinstance(part, int) else ("." if text else "") + part
    return text


def named_by_schema(error):
    """The places that an error of the schema names."""
    here = list(error.absolute_path)
    if error.validator in ("additionalProperties", "required"):
        names = re.findall(r"'([^']+)'", error.message)
        return {place(here + [name]) for name in names}
    return {place(here)}


def places_of(node, path=()):
    """Every (path, value) of a document."""
    yield path, node
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()
    for key, value in items:
        yield from places_of(value, (*path, key))


def replaced(document, path, value):
    result = copy.deepcopy(document)
    node = result
    for part in path[:-1]:
        node = node[part]
    node[path[-1]] = value
    return result


def without(document, path):
    result = copy.deepcopy(document)
    node = result
    for part in path[:-1]:
        node = node[part]
    del node[path[-1]]
    return result


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


NUMBERS = "numbers of a vector"
TAGS = {"shape", "place", "form"}
WORDS = {"bending_model", "membrane_model", "mass_lumping", "corner", "side", "kind", "model", "preset", "self",
         "objects", "correction"}
WHOLE = {"rows", "columns", "min_substeps", "sweeps", "substeps", "passes"}


class Mutator:
    """Changes one place of a scene so that it must be refused, and says where."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.kinds = [self.unknown_key, self.wrong_type, self.too_large, self.too_small, self.wrong_word,
                      self.short_vector, self.long_vector, self.text_in_vector, self.missing_tag,
                      self.not_an_object, self.not_a_list, self.fraction, self.long_name, self.null,
                      self.misspelt_key, self.no_cloth]

    def one_of(self, document, wanted):
        found = [(path, value) for path, value in places_of(document) if path and wanted(path, value)]
        return self.random.choice(found) if found else (None, None)

    def mutate(self, document):
        while True:
            kind = self.random.choice(self.kinds)
            result = kind(document)
            if result:
                return kind.__name__, *result

    def change(self, document, wanted, value):
        path, _ = self.one_of(document, wanted)
        return path and (replaced(document, path, value), place(path))

    def unknown_key(self, document):
        path, _ = self.one_of(document, lambda path, value: isinstance(value, dict))
        return replaced(document, (*path, "colour"), 3), place((*path, "colour"))

    def misspelt_key(self, document):
        path, value = self.one_of(
            document, lambda path, value: isinstance(path[-1], str) and path[-1] not in TAGS
            and path[-1] not in ("cloths", "source", "mesh"))
        wrong = path[-1] + "_"
        return replaced(without(document, path), (*path[:-1], wrong), value), place((*path[:-1], wrong))

    def wrong_type(self, document):
        return self.change(document, lambda path, value: is_number(value), "three")

    def null(self, document):
        return self.change(document, lambda path, value: is_number(value), None)

    def too_large(self, document):
        return self.change(document, lambda path, value: is_number(value), 1e12)

    def too_small(self, document):
        return self.change(document, lambda path, value: is_number(value), -1e12)

    def fraction(self, document):
        return self.change(
            document, lambda path, value: path[-1] in WHOLE, 7.5)

    def wrong_word(self, document):
        return self.change(
            document, lambda path, value: path[-1] in TAGS | WORDS, "velvet")

    def vector(self, document):
        return self.one_of(document, lambda path, value: isinstance(value, list) and value
                           and all(map(is_number, value)))

    def short_vector(self, document):
        path, value = self.vector(document)
        return replaced(document, path, value[:-1]), place(path)

    def long_vector(self, document):
        path, value = self.vector(document)
        return replaced(document, path, value + [0.5]), place(path)

    def text_in_vector(self, document):
        path, value = self.vector(document)
        k = self.random.randrange(len(value))
        return replaced(document, (*path, k), "up"), place((*path, k))

    def missing_tag(self, document):
        path, _ = self.one_of(document, lambda path, value: path[-1] in ("shape", "place", "source"))
        return path and (without(document, path), place(path))

    def not_an_object(self, document):
        return self.change(document, lambda path, value: isinstance(value, dict), 5)

    def not_a_list(self, document):
        return self.change(document, lambda path, value: isinstance(value, list), {"x": 1})

    def long_name(self, document):
        return self.change(document, lambda path, value: path[-1] == "name",
                           self.random.choice(["n" * 65, "a/b", ".hidden", ""]))

    def no_cloth(self, document):
        return replaced(document, ("cloths",), []), "cloths"


class SceneFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="weft_scenes_")
        cls.schema = json.loads(run("scenes", "--schema").stdout)
        jsonschema.Draft7Validator.check_schema(cls.schema)
        cls.judge = jsonschema.Draft7Validator(cls.schema)
        names = [scene["name"] for scene in json.loads(run("scenes", "--json").stdout)["scenes"]]
        cls.scenes = {name: json.loads(run("scenes", "--json", name).stdout) for name in names}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def simulate(self, document, *more, ticks=1):
        path = Path(self.folder.name) / "scene.json"
        path.write_text(document if isinstance(document, str) else json.dumps(document))
        return run("simulate", "--scene", path, "--ticks", ticks, "--json", *more)

    def test_the_committed_schema_is_what_the_program_prints(self):
        committed = (SOURCE / "server" / "scene.schema.json").read_text()
        self.assertEqual(committed, run("scenes", "--schema").stdout)

    def test_every_built_in_scene_validates_and_plays_as_its_file(self):
        for name, document in self.scenes.items():
            with self.subTest(scene=name):
                self.assertEqual([error.message for error in self.judge.iter_errors(document)], [])
                path = Path(self.folder.name) / "round.json"
                path.write_text(json.dumps(document))
                again = json.loads(run("scenes", "--json", path).stdout)
                self.assertEqual({**again, "name": name}, document)
                # The hard cases are slow; that nothing of them is lost is seen above.
                ticks = "3" if name.startswith("hard-") else "30"
                hashes = [json.loads(run("simulate", "--scene", scene, "--ticks", ticks, "--json").stdout)["hash"]
                          for scene in (name, path)]
                self.assertEqual(hashes[0], hashes[1])

    def test_mutated_scenes_are_refused_by_both_at_the_right_place(self):
        mutator = Mutator(SEED)
        names = sorted(self.scenes)
        seen = set()
        for number in range(MUTATIONS):
            name = names[number % len(names)]
            kind, document, where = mutator.mutate(self.scenes[name])
            seen.add(kind)
            with self.subTest(number=number, scene=name, kind=kind, where=where):
                by_schema = set().union(*map(named_by_schema, self.judge.iter_errors(document)), set())
                self.assertIn(where, by_schema)
                result = self.simulate(document)
                self.assertEqual(result.returncode, 2, result)
                self.assertEqual(result.stdout, "")
                self.assertIn(f": {where} = ", result.stderr)
                self.assertIn("allowed is", result.stderr)
        self.assertGreaterEqual(len(seen), 12)

    def test_how_a_cloth_looks_is_told_and_changes_no_tick(self):
        cloth = {"rows": 5, "columns": 5, "fabric": {"preset": "silk"}}
        dressed = {**cloth, "look": {"fabric": "denim", "color": "#2A6f97", "back": "#c0ffee"}}
        view = {"target": [0, 1, 0], "direction": [0, 3, 4], "radius": 0.5}
        hashes = []
        for document in ({"cloths": [cloth]}, {"cloths": [dressed], "view": view}):
            self.assertEqual(list(self.judge.iter_errors(document)), [])
            path = Path(self.folder.name) / "look.json"
            path.write_text(json.dumps(document))
            again = json.loads(run("scenes", "--json", path).stdout)
            self.assertEqual(again["cloths"][0].get("look"), document["cloths"][0].get("look"))
            self.assertEqual(again.get("view"), document.get("view"))
            hashes.append(json.loads(run("simulate", "--scene", path, "--ticks", "5", "--json").stdout)["hash"])
        self.assertEqual(hashes[0], hashes[1])
        for wrong in ("#12345", "#1234567", "123456#", "#12345g", "red", "", 3, None):
            with self.subTest(color=wrong):
                document = {"cloths": [{**cloth, "look": {"color": wrong}}]}
                result = self.simulate(document)
                self.assertEqual(result.returncode, 2, result)
                self.assertIn(": cloths[0].look.color = ", result.stderr)
                self.assertNotEqual(list(self.judge.iter_errors(document)), [])

    def test_what_no_schema_can_tell_is_refused_with_its_path(self):
        cloth = {"rows": 5, "columns": 5}

        def moving(keyframes, loop=False):
            motion = {"keyframes": keyframes, "loop": loop}
            return {"cloths": [cloth], "colliders": [{"shape": "sphere", "motion": motion}]}

        table = [
            ({"cloths": [{**cloth, "fabric": {"shear": 1e5}}]}, "cloths[0].fabric.shear"),
            ({"cloths": [{**cloth, "u": [0, 0, 0]}]}, "cloths[0].u"),
            ({"cloths": [{**cloth, "fabric": {"bending_length_weft": 0.02, "bending_weft": 1e-6}}]},
             "cloths[0].fabric.bending_length_weft"),
            ({"cloths": [cloth], "contact": {"self": "triangles"}}, "contact.self"),
            ({"cloths": [cloth], "contact": {"model": "seed", "correction": "fold_map", "lift": 0.03}},
             "contact.lift"),
            ({"cloths": [cloth, cloth]}, "cloths[1].name"),
            ({"cloths": [cloth, {**cloth, "name": "b", "v": [1, 0, 0]}]}, "cloths[1].v"),
            ({"cloths": [cloth], "view": {"direction": [0, 0, 0]}}, "view.direction"),
            ({"cloths": [cloth], "pins": [{"place": "particle", "particle": 25}]}, "pins[0].particle"),
            ({"cloths": [cloth], "pins": [{"place": "corner", "cloth": "sail"}]}, "pins[0].cloth"),
            ({"cloths": [cloth], "colliders": [{"shape": "plane", "normal": [0, 0, 0]}]},
             "colliders[0].normal"),
            ({"cloths": [cloth], "colliders": [{"shape": "box", "orientation": [1, 1, 0, 0]}]},
             "colliders[0].orientation"),
            (moving([{"time": 1}, {"time": 1}]), "colliders[0].motion.keyframes[1].time"),
            (moving([{}, {"time": 0.01, "offset": [1, 0, 0]}]),
             "colliders[0].motion.keyframes[1].offset"),
            (moving([{"rotation": [0, 1, 0, 1]}]), "colliders[0].motion.keyframes[0].rotation"),
            (moving([{}, {"time": 1, "offset": [1, 0, 0]}], loop=True), "colliders[0].motion.loop"),
            ({"cloths": [cloth], "grippers": [{"steps": [{}, {"time": 1, "rotation": [1, 1, 0, 0]}]}]},
             "grippers[0].steps[1].rotation"),
            ({"cloths": [cloth], "colliders": [{"shape": "mesh", "source": "none.obj"}]},
             "colliders[0].source"),
            ({"cloths": [{"form": "mesh", "mesh": {"source": "cat"}}]}, "cloths[0].mesh.source"),
        ]
        for document, where in table:
            with self.subTest(where=where):
                result = self.simulate(document)
                self.assertEqual(result.returncode, 2, result)
                self.assertIn(f": {where} = ", result.stderr)

    def test_the_steps_of_a_gripper_turn_it(self):
        def hash_of(**step):
            steps = [{"opening": 0.04}, {"time": 0.2, "opening": 0.04, **step}]
            scene = {"cloths": [{"rows": 5, "columns": 5}], "grippers": [{"steps": steps}]}
            jsonschema.validate(scene, self.schema)
            result = self.simulate(scene, ticks=60)
            self.assertEqual(result.returncode, 0, result.stderr)
            return json.loads(result.stdout)["hash"]

        stays = hash_of()
        self.assertEqual(hash_of(rotation=[0, 0, 0, 1]), stays)
        turned = hash_of(rotation=[0, 0.6, 0, 0.8])
        self.assertNotEqual(turned, stays)
        self.assertNotEqual(hash_of(rotation=[0, -0.6, 0, 0.8]), turned)

    def test_a_fabric_may_tell_its_bending_lengths_in_place_of_its_rigidities(self):
        def scene(**fabric):
            return {"cloths": [{"rows": 9, "columns": 9, "width": 0.2, "height": 0.2, "v": [0, 0, 1],
                                "fabric": {"preset": "wool", "areal_density": 0.3, **fabric}}],
                    "pins": [{"place": "edge", "side": "left", "width": 0.03}]}

        def outcome(document):
            self.assertEqual([error.message for error in self.judge.iter_errors(document)], [])
            result = self.simulate(document, ticks=30)
            self.assertEqual(result.returncode, 0, result.stderr)
            return json.loads(result.stdout)["hash"]

        rigidity = [0.3 * 9.81 * c * c * c for c in (0.03, 0.02)]  # ASTM D1388
        lengths = outcome(scene(bending_length_warp=0.03, bending_length_weft=0.02))
        self.assertEqual(lengths, outcome(scene(bending_warp=rigidity[0], bending_weft=rigidity[1])))
        self.assertEqual(outcome(scene(bending_length_warp=0.03)), outcome(scene(bending_warp=rigidity[0])))
        self.assertNotEqual(lengths, outcome(scene()))
        for wrong in ({"bending_length_warp": 0.3}, {"bending_length_warp": "2 cm"},
                      {"bending_length_warp": 0.02, "bending_warp": 1e-6}):
            with self.subTest(wrong=wrong):
                self.assertNotEqual(list(self.judge.iter_errors(scene(**wrong))), [])
                result = self.simulate(scene(**wrong))
                self.assertEqual(result.returncode, 2, result)
                self.assertIn(": cloths[0].fabric.bending_length_warp = ", result.stderr)

    def test_texts_that_are_no_scene_are_refused(self):
        deep = '{"cloths":' + "[" * 50 + "]" * 50 + "}"
        for text in ("", "[]", "{", '{"cloths":[{"rows":NaN}]}', '{"cloths":[{"rows":1e999}]}', deep,
                     '{"name":"a","name":"b","cloths":[{}]}', "\0", "{}" + " " * (1 << 20)):
            with self.subTest(text=text[:40]):
                result = self.simulate(text)
                self.assertEqual(result.returncode, 2, result)
                self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        missing = run("simulate", "--scene", "no/such.json", "--ticks", "1")
        self.assertEqual(missing.returncode, 2)
        self.assertIn("--scene = no/such.json", missing.stderr)

    def test_the_seed_s_parts_and_their_settings_are_the_same_in_a_file_and_on_the_command_line(self):
        base = {"cloths": [{"rows": 9, "columns": 9, "v": [0, 0, 1], "origin": [-0.5, 0.6, -0.5]}],
                "colliders": [{"shape": "sphere", "center": [0, 0.3, 0], "radius": 0.25}]}
        parts = {"model": "seed",
                 "solver": {"kind": "relaxation"},
                 "relaxation": {"sweeps": 7, "substeps": 3, "damping": 0.02, "compliance": 0.5},
                 "contact": {"model": "seed", "self": "triangles_and_edges",
                             "objects": "particles_and_edges", "correction": "fold_map", "lift": 0.002,
                             "fold_depth": 0.03, "passes": 2}}
        changes = []
        for name, value in parts.items():
            fields = {f"{name}.{key}": v for key, v in value.items()} if isinstance(value, dict) else \
                {name: value}
            for key, given in fields.items():
                changes += ["--set", f"{key}={given}"]
        def outcome(document, *more):
            result = self.simulate(document, *more, ticks=40)
            self.assertEqual(result.returncode, 0, result.stderr)
            return json.loads(result.stdout)
        whole = outcome({**base, **parts})
        self.assertEqual(whole["solver"], "relaxation")
        self.assertEqual(outcome(base, *changes)["hash"], whole["hash"])
        for name in ("relaxation", "contact"):  # are heeded
            rest = {key: value for key, value in parts.items() if key != name}
            self.assertNotEqual(outcome({**base, **rest})["hash"], whole["hash"])

    def test_settings_go_on_top_of_a_file(self):
        result = self.simulate({"cloths": [{"rows": 5, "columns": 5}]}, "--set", "cloth.rows=9")
        self.assertEqual(json.loads(result.stdout)["particles"], 45)


if __name__ == "__main__":
    unittest.main()
