"""The commands and the script of README.md work as they are written there."""

import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import jsonschema

ROOT = Path(os.environ["WEFT_SOURCE_DIR"])
PROGRAM = os.environ["WEFT_PROGRAM"]
README = (ROOT / "README.md").read_text(encoding="utf-8")
SCHEMA = (ROOT / "server" / "scene.schema.json").read_text(encoding="utf-8")
USAGE = subprocess.run([ROOT / "dev", "help"], capture_output=True, text=True, check=True).stdout


def blocks(language):
    """The fenced blocks of a language; "" for those that name none."""
    pairs = re.findall(r"^```(\w*)\n(.*?)^```\n", README, re.MULTILINE | re.DOTALL)
    return [text for name, text in pairs if name == language]


class Readme(unittest.TestCase):
    def test_each_command_of_the_program_works(self):
        commands = [line for block in blocks("") for line in block.splitlines()
                    if line.startswith("build/weft ")]
        self.assertGreaterEqual(len(commands), 4)
        with tempfile.TemporaryDirectory() as folder:
            (scene,) = blocks("json")
            Path(folder, "my.json").write_text(scene, encoding="utf-8")
            for command in commands:
                with self.subTest(command=command):
                    text, _, target = command.partition(" > ")
                    arguments = text.split()[1:]
                    if arguments[0] == "serve":
                        arguments += ["--max-seconds", "1"]
                    result = subprocess.run([PROGRAM, *arguments], cwd=folder, timeout=120,
                                            capture_output=True, text=True)
                    self.assertEqual(result.returncode, 0, result.stderr)
                    self.assertTrue(result.stdout)
                    if "--json" in arguments:
                        json.loads(result.stdout)
                    if target:
                        Path(folder, target).write_text(result.stdout, encoding="utf-8")
                    if "--out" in arguments:
                        out = Path(folder, arguments[arguments.index("--out") + 1])
                        self.assertGreater(out.stat().st_size, 1000)

    def test_the_scene_is_valid_and_wrong_values_are_refused_as_it_says(self):
        (scene,) = blocks("json")
        jsonschema.validate(json.loads(scene), json.loads(SCHEMA))
        (refusal,) = blocks("text")
        good = '"friction": 0.5'
        self.assertEqual(scene.count(good), 1)
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "my.json").write_text(scene.replace(good, '"friction": -0.5'))
            result = subprocess.run([PROGRAM, "simulate", "--scene", "my.json"], cwd=folder,
                                    timeout=120, capture_output=True, text=True)
        self.assertEqual((result.returncode, result.stderr), (2, refusal))

    def test_the_script_works(self):
        (script,) = blocks("python")
        self.assertIn("'tick': 60", self.output_of(script))

    def test_the_script_of_the_specification_grips_lifts_and_lets_go(self):
        text = (ROOT / "proto" / "README.md").read_text(encoding="utf-8")
        (script,) = re.findall(r"^```python\n(.*?)^```\n", text, re.MULTILINE | re.DOTALL)
        closed, carried, opened = self.output_of(script).splitlines()
        self.assertEqual((closed, opened), ("gripping: True", "gripping: False"))
        self.assertGreater(float(carried.split()[-1]), 0.5)

    def output_of(self, script):
        """What a script prints, with a server of its own."""
        server = subprocess.Popen([PROGRAM, "serve", "--port", "0", "--max-seconds", "100"],
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        try:
            address = json.loads(server.stdout.readline())["websocket"]
            self.assertEqual(script.count("ws://127.0.0.1:8080/ws"), 1)
            script = script.replace("ws://127.0.0.1:8080/ws", address)
            result = subprocess.run([sys.executable, "-B", "-c", script], cwd=ROOT, timeout=60,
                                    capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stderr)
            return result.stdout
        finally:
            server.terminate()
            server.wait(timeout=20)
            server.stdout.close()

    def test_each_command_of_dev_is_one_that_it_has(self):
        words = re.findall(r"\./dev ([a-z]+)", README)
        self.assertIn("run", words)
        self.assertIn("test", words)
        for word in words:
            self.assertTrue(word == "help" or re.search(rf"^  {word}\b", USAGE, re.MULTILINE), word)

    def test_every_file_that_it_names_is_there(self):
        names = re.findall(r"`((?:core|proto|server|web|tests)/[\w./]*)`", README)
        names += re.findall(r"\]\(([\w./]+)\)", README)
        self.assertGreater(len(names), 5)
        for name in names:
            self.assertTrue((ROOT / name).exists(), name)

    def test_the_table_of_speed_and_error_is_that_of_the_measured_figures(self):
        sys.path.insert(0, str(ROOT / "tests/bench"))
        import report
        data = ROOT / "tests/bench/data"
        self.assertEqual(report.with_blocks(README, data), README)
        page = (ROOT / "tests/bench/REPORT.md").read_text(encoding="utf-8")
        self.assertEqual(report.report_text(data), page)

    def test_the_table_of_speed_and_error_tells_the_conditions_it_was_taken_under(self):
        caption = README.split("<!-- report: cost of accuracy -->")[1].split("<!-- report: end -->")[0]
        for condition in (r"drag of 0\.2/s", r"no contact", r"without drag", r"of 1\.5 s are positions to \d",
                          r"in position, .* in strain, .* in energy", r"at commit \w{7}, "):
            self.assertRegex(caption, condition)

    def test_the_script_that_measures_frames_lists_its_options_and_measures_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            script = Path(folder, "tests/bench/wire/measure.sh")
            bench = Path(folder, "build/weft_wire_bench")
            for path, text in ((script, (ROOT / "tests/bench/wire/measure.sh").read_text(encoding="utf-8")),
                               (bench, "#!/bin/sh\necho options\n")):
                path.parent.mkdir(parents=True)
                path.write_text(text, encoding="utf-8")
                path.chmod(0o755)
            result = subprocess.run([script, "--help"], capture_output=True, text=True, timeout=60,
                                    env={"PATH": "/usr/bin:/bin", "npm_config_offline": "true"})
        self.assertEqual((result.returncode, result.stdout), (0, "options\n"), result.stderr)

    def test_it_is_short(self):
        self.assertLessEqual(len(README.splitlines()), 180)

    def test_every_test_that_the_tests_page_names_is_in_its_file(self):
        page = (ROOT / "tests/README.md").read_text(encoding="utf-8")
        names = re.findall(r"`([\w./]+)`|(?<=[ ;])\"([^\"]+)\"", page)
        text, found = "", 0
        for file, name in names:
            if "/" in file:
                place = ROOT / "tests" / file
                self.assertTrue(place.exists() or file == "build/weft", file)
                text = place.read_text(encoding="utf-8") if place.is_file() else ""
            elif name:
                self.assertTrue(name in text, f"the file before it has no test of the name: {name}")
                found += 1
        self.assertGreater(found, 40)

    def test_the_table_of_the_seed_names_scenes_that_exist_and_all_of_its_scenes(self):
        section = README.split("## The seed and Weft\n")[1].split("\n## ")[0]
        rows = [[cell.strip() for cell in line.strip("|").split(" | ")]
                for line in section.splitlines() if line.startswith("| ")][1:]
        self.assertGreater(len(rows), 10)
        listed = subprocess.run([PROGRAM, "scenes", "--json"], capture_output=True, text=True,
                                check=True).stdout
        scenes = {scene["name"] for scene in json.loads(listed)["scenes"]}
        shown = set()
        for feature, places, examples in rows:
            with self.subTest(feature=feature):
                self.assertTrue(re.findall(r"`(?:core|server|web)/[\w./]+`", places))
                names = re.findall(r"`([a-z][\w-]*)`", examples)
                self.assertLessEqual(set(names), scenes)
                shown.update(names)
        self.assertEqual({name for name in scenes if name.startswith("seed-")}, shown)


if __name__ == "__main__":
    unittest.main()
